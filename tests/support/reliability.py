#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of docs/reliability.md, from what the last runs left in build/: `./dev reliability`."""
import glob
import os
import re
from collections import defaultdict


def text_of(path):
    return open(path, encoding="utf-8", errors="replace").read() if os.path.exists(path) else ""


def tests():
    found = re.findall(r"(\d+) tests failed out of (\d+)", text_of("build/tests.log"))
    if found:
        failed, count = map(int, found[-1])
        yield "tests (`./dev test`)", count, count - failed, "closed forms, quadrature, published references, invariants"


def random_mechanisms():
    found = re.findall(r"(\d+) random mechanisms from seed (\d+): (\d+) agree.*?, (\d+) set aside, (\d+) failed", text_of("build/random.log"))
    if found:
        count, first, agree, aside, _ = map(int, found[-1])
        yield (f"random mechanisms (`./dev random {count} {first}`)", count - aside, agree,
               f"an independent solver, lengths, energy, momentum, another frame; {aside} more set aside")


def fuzz():
    for path in sorted(glob.glob("build/fuzz/*.log")):
        runs = re.findall(r"number_of_executed_units:\s*(\d+)", text_of(path))
        name = os.path.basename(path)[:-4]
        clean = 0 if glob.glob(f"build/fuzz/found_{name}_*") else 1
        if runs:
            count = int(runs[-1])
            yield f"fuzzed inputs, {name} (`./dev fuzz`)", count, count if clean else count - 1, "no memory error, no undefined behaviour, no exception that gets out"


def drawn():
    """The seed of the last drawn errors and their rows: number, path, line, kind, what found it, changed line."""
    tables = sorted(glob.glob("build/mutation/*.tsv"), key=os.path.getmtime)
    if not tables:
        return "", []
    rows = [line.rstrip("\n").split("\t") for line in open(tables[-1], encoding="utf-8")]
    return os.path.basename(tables[-1])[:-4], rows


def mutants():
    seed, rows = drawn()
    folders = defaultdict(lambda: [0, 0])
    for row in rows:
        folders[row[1].split("/")[1]][0] += 1
        folders[row[1].split("/")[1]][1] += row[4] != ""
    places = ", ".join(f"{name} {found} of {count}" for name, (count, found) in sorted(folders.items()))
    if rows:
        yield f"errors seeded in core (`./dev mutate {seed} {len(rows)}`)", len(rows), sum(f for _, f in folders.values()), f"found by its tests: {places}"


print("| what | tried | passed | how it is judged |\n|---|---:|---:|---|")
for source in (tests, random_mechanisms, fuzz, mutants):
    for what, tried, passed, how in source():
        print(f"| {what} | {tried} | {passed} | {how} |")
survivors = [row for row in drawn()[1] if row[4] == ""]
if survivors:
    print("\nErrors that the tests did not find (`sign`, `keep`, `twice`, `one`, `on`: where they are):\n")
for row in survivors:
    print(f"- `{row[1]}:{row[2]}`, {row[3]}: `{row[5]}`")
