#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Seeded errors: how many the tests of core find.

    tests/mutation/mutate.py [SEED [N]] [--resume]

Draws N errors from a seed over all folders of core, no file more than a third of its folder, compiles them in
at once, each behind a switch (tests/mutation/switch.hpp), and runs the core tests with one switched on at a
time, the quick ones first, and 60 random mechanisms, until one fails. Errors that do not compile are dropped and others drawn. Prints
what survived, by folder and place, and writes build/mutation/SEED.tsv, from which --resume goes on.
"""
import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import time
from collections import defaultdict

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WORK = os.path.join(ROOT, "build", "mutation")
RELEASE = os.path.join(ROOT, "build", "release")  # where the tests were built


# --- where errors can be put -------------------------------------------------------------------------------
def code_of(line):
    """The line with strings and its comment blanked: same columns."""
    blank = lambda m: " " * len(m.group())
    return re.sub(r"//.*", blank, re.sub(r"'(\\.|[^'\\])'|\"(\\.|[^\"\\])*\"", blank, line))


def end_of_operand(code, at, stops):
    """Where the expression that begins at `at` ends: before one of `stops` or a closing bracket, depth 0."""
    depth = 0
    while at < len(code):
        c = code[at]
        if c in "([{":
            depth += 1
        elif c in ")]}":
            if depth == 0:
                return at
            depth -= 1
        elif depth == 0 and any(code.startswith(s, at) for s in stops):
            return at
        at += 1
    return None


def begin_of_operand(code, at, stops):
    depth = 0
    while at > 0:
        c = code[at - 1]
        if c in ")]}":
            depth += 1
        elif c in "([{":
            if depth == 0:
                return at
            depth -= 1
        elif depth == 0 and any(code.endswith(s, 0, at) for s in stops):
            return at
        at -= 1
    return None


LOW = (" && ", " || ", " ? ", " : ", ";", ", ", " = ", "return ")


def sites(line):
    """All (kind, function of a number giving the changed line) of a line."""
    code, found = code_of(line), []

    def put(kind, begin, end, text):
        found.append((kind, lambda k, b=begin, e=end, t=text: line[:b] + t.replace("@", str(k)) + line[e:]))

    on, space = "unfurl_mutation::on(@)", "unfurl_mutation::"
    plain = '"' not in line and not re.search(r"\b(text|name|message|string)", code)
    for m in re.finditer(r" [-+] (?=[\w(])|(?<=[\w\])]) [-+]= ", code if plain else ""):
        put("sign", m.end(), m.end(), space + "sign(@) * ")
        put("dropped term", m.end(), m.end(), space + "keep(@) * ")
    for m in re.finditer(r"(?<=return )(?=[-\w(])|(?<= [-+*]= )|(?<=[\w\])] = )(?=[-\w(])|(?<= [-+] )(?=[\w(])", code if plain else ""):
        if re.match(r"-?(0[;,)]|true|false|nullptr|std::(nullopt|move|make|numeric)|[\w:]*\{)", code[m.end():]):
            continue
        put("factor 2", m.end(), m.end(), space + "twice(@) * ")
    for m in re.finditer(r"(?<=\b0\.5 \* )|(?<=\b2 \* )", code):
        put("factor 2", m.end(), m.end(), space + "twice(@) * ")
    for m in re.finditer(r"(?<=[\[( ])(\w+)(?=\])", code):
        put("off by one", m.end(), m.end(), " + " + space + "one(@)")
    for m in re.finditer(r"(?<= [-+] )1(?=[;\]) ,])|(?<= = )0(?=;)", code):
        put("off by one", m.start(), m.end(), f"({m.group()} + {space}one(@))")
    for m in re.finditer(r" (<=|>=|<|>|==|!=) ", code):
        begin, end = begin_of_operand(code, m.start(), LOW), end_of_operand(code, m.end(), LOW)
        if begin is None or end is None:
            continue
        while code[begin] == " ":
            begin += 1
        left, right, op = line[begin : m.start()], line[m.end() : end], m.group(1)
        if re.match(r"(if|while|for|return|auto|const|double|int|bool)\b", left):
            continue
        near = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}.get(op)
        far = {"<": ">", "<=": ">", ">": "<", ">=": "<", "==": "!=", "!=": "=="}[op]
        put("comparison", begin, end, f"({on} ? ({left} {far} {right}) : ({left} {op} {right}))")
        if near:
            put("boundary", begin, end, f"({on} ? ({left} {near} {right}) : ({left} {op} {right}))")
    for m in re.finditer(r" (&&|\|\|) ", code):
        end = end_of_operand(code, m.end(), LOW)
        if end is not None:
            right = line[m.end() : end]
            put("logic", m.end(), end, f"({on} || ({right}))" if m.group(1) == "&&" else f"(!{on} && ({right}))")
    for m in re.finditer(r"\b(if|while) \((?!const |auto )", code):
        end = end_of_operand(code, m.end(), ())
        if end is not None and "; " not in code[m.end() : end]:
            put("logic", m.end(), end, f"{on} != static_cast<bool>({line[m.end():end]})")
    for a, b in (("std::min(", "std::max("), ("std::max(", "std::min("), ("std::sin(", "std::cos("),
                 ("std::cos(", "std::sin("), (".front()", ".back()"), (".back()", ".front()"), ("std::abs(", "(")):
        at = code.find(a)
        if at < 0:
            continue
        if a[0] == ".":
            begin, end = begin_of_operand(code, at, (" ", *LOW)), at + len(a)
        else:
            begin, end = at, (end_of_operand(code, at + len(a), ()) or -2) + 1
        if begin is not None and end > 0:
            text = line[begin:end]
            put("swap", begin, end, f"({on} ? {text.replace(a, b, 1)} : {text})")
    for m in re.finditer(r"(?<=[\w>])\((\w[\w.\[\]]*), (\w[\w.\[\]]*)\)", code):
        put("swap", m.start() + 1, m.end() - 1,
            f"{on} ? {m.group(2)} : {m.group(1)}, {on} ? {m.group(1)} : {m.group(2)}")
    statement = re.match(r"^(\s+)((?!return\b|if\b|for\b|else\b|const\b|auto\b|using\b|case\b|throw\b|break\b|continue\b|delete\b)"
                         r"[\w.:\[\]()>*-]+( [-+*/|]?= .*|\(.*\)|\.\w+\(.*\)));$", code)
    if statement and "{" not in code and code.count("(") == code.count(")"):
        begin = len(statement.group(1))
        put("dropped statement", begin, len(line), f"if ({on}) {{}} else {{ {line[begin:]} }}")
    return found


def candidates():
    """{file: [(line number, kind, change)]} of core; a line is one that stands on its own."""
    found = {}
    for folder, _, files in os.walk(os.path.join(WORK, "source", "core")):
        for name in sorted(files):
            if not name.endswith(".cpp"):
                continue
            path = os.path.join(folder, name)
            lines = open(path, encoding="utf-8").read().split("\n")
            here = []
            for i, line in enumerate(lines):
                before = code_of(lines[i - 1]).rstrip() if i else ""
                code = code_of(line)
                if re.match(r"\s*(#|//|template|static_assert|case |using |namespace|struct |class )|.*constexpr", code):
                    continue
                for kind, change in sites(line):
                    if kind == "dropped statement" and not (before == "" or before[-1] in ";{})" or before.endswith("else")):
                        continue
                    here.append((i, kind, change))
            found[os.path.relpath(path, os.path.join(WORK, "source"))] = here
    return found


def draw(seed, n, dropped):
    """n errors, folder by folder in turn; one to a line; none of those in `dropped`, which did not compile."""
    dice = random.Random(seed)
    folders, chosen = defaultdict(list), []
    for path, here in sorted(candidates().items()):
        folders[path.split("/")[1]].append((path, here))
    share = {folder: 1 + -(-n // len(folders)) // 3 for folder in folders}
    used, lines = defaultdict(int), set()
    order = sorted(folders)
    while len(chosen) < n:
        before = len(chosen)
        dice.shuffle(order)
        for folder in order:
            files = [f for f in folders[folder] if f[1] and used[f[0]] < share[folder]]
            while files and len(chosen) < n:
                # A file in proportion to what can be changed in it.
                path, here = dice.choices(files, [len(h) for _, h in files])[0]
                kind = dice.choice(sorted({h[1] for h in here}))  # all kinds alike, whatever there is most of
                line, kind, change = here.pop(dice.choice([i for i, h in enumerate(here) if h[1] == kind]))
                files = [f for f in files if f[1]]
                if (path, line) in lines or (path, line, kind) in dropped:
                    continue
                lines.add((path, line))
                used[path] += 1
                chosen.append((path, line, kind, change))
                break
        if len(chosen) == before:
            break
    return chosen


# --- build and run -----------------------------------------------------------------------------------------
def run(words, **more):
    return subprocess.run(words, capture_output=True, text=True, errors="replace", **more)


def snapshot():
    """The sources, and the compiled tests of the release build, as they are now."""
    shutil.rmtree(os.path.join(WORK, "source"), ignore_errors=True)
    shutil.rmtree(os.path.join(WORK, "objects"), ignore_errors=True)
    for top in ("CMakeLists.txt", "app", "core", "render"):
        source, target = os.path.join(ROOT, top), os.path.join(WORK, "source", top)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, target)
    os.symlink(os.path.join(ROOT, "assets"), os.path.join(WORK, "source", "assets"))
    return [linked("tests/core_tests", "core_tests"), linked("tests/random/random_mechanisms", "random_mechanisms")]


def linked(target, name):
    """The command that links a test program of the release build with the mutants' library instead."""
    commands = run(["ninja", "-C", RELEASE, "-t", "commands", target]).stdout.strip().split("\n")
    link = next(c for c in commands if f" -o {target} " in c).split(" && ")[1].split()
    for i, word in enumerate(link):
        if word.endswith(".o") or word.endswith("libunfurl_ida.a"):
            link[i] = os.path.join(WORK, "objects", word)
            os.makedirs(os.path.dirname(link[i]), exist_ok=True)
            shutil.copy(os.path.join(RELEASE, word), link[i])
        elif word == "core/libunfurl_core.a":
            link[i] = os.path.join(WORK, "build", word)
        elif word == target:
            link[i] = os.path.join(WORK, name)
    return link


def write_tree(mutants):
    """The sources with all errors in them, touching only files that differ."""
    tree, by_file = os.path.join(WORK, "tree"), defaultdict(list)
    for k, (path, line, _, change) in enumerate(mutants):
        by_file[path].append((line, k, change))
    for folder, _, files in os.walk(os.path.join(WORK, "source")):
        for name in files:
            source = os.path.join(folder, name)
            path = os.path.relpath(source, os.path.join(WORK, "source"))
            lines = open(source, encoding="utf-8").read().split("\n")
            for line, k, change in by_file.get(path, []):
                lines[line] = change(k)
            text, target = "\n".join(lines), os.path.join(tree, path)
            os.makedirs(os.path.dirname(target), exist_ok=True)
            if not os.path.exists(target) or open(target, encoding="utf-8").read() != text:
                open(target, "w", encoding="utf-8").write(text)
    if not os.path.lexists(os.path.join(tree, "assets")):
        os.symlink(os.path.join(ROOT, "assets"), os.path.join(tree, "assets"))
    return tree


def build(mutants, links):
    """Compiles core and links the test programs with it; the mutants that do not compile, by the lines named."""
    tree, folder = write_tree(mutants), os.path.join(WORK, "build")
    launcher = re.findall(r"^UNFURL_CCACHE:\w+=(.*)$", open(os.path.join(RELEASE, "CMakeCache.txt")).read(), re.M)
    done = run(["cmake", "-S", tree, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DUNFURL_TESTS=OFF",
                "-DCMAKE_CXX_FLAGS_RELEASE=-O1", f"-DUNFURL_CCACHE={launcher[0]}",
                f"-DCMAKE_CXX_FLAGS=-w -include {ROOT}/tests/mutation/switch.hpp"])
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    done = run(["cmake", "--build", folder, "--target", "unfurl_core", "--", "-k", "0"])
    if done.returncode == 0:
        for link in links:
            done = run(link, cwd=RELEASE)
            if done.returncode:
                sys.exit(done.stderr)
        return set()
    bad = set()
    for path, line in re.findall(r"(core/[\w/]+\.cpp):(\d+)", done.stdout):
        bad |= {i for i, m in enumerate(mutants) if m[0] == path and m[1] == int(line) - 1}
    if not bad:
        sys.exit(done.stdout[-4000:])
    return bad


def compiled(seed, n):
    dropped, links = set(), snapshot()
    while True:
        mutants = draw(seed, n, dropped)
        bad = build(mutants, links)
        print(f"{len(mutants)} errors drawn, {len(bad)} do not compile", flush=True)
        if not bad:
            return mutants
        dropped |= {mutants[i][:3] for i in bad}


class Tests:
    """The core tests in portions, quick ones first: most errors are found by the first."""

    def __init__(self):
        self.program = os.path.join(WORK, "core_tests")
        begin = time.time()
        done = run([self.program, "-d", "yes"], env=self.environment(-1), cwd=ROOT)
        if done.returncode:
            sys.exit("the tests fail without any error switched on:\n" + done.stdout[-3000:])
        self.whole = time.time() - begin
        times = [(float(t), name) for t, name in re.findall(r"^(\d+\.\d+) s: (.+)$", done.stdout, re.M)]
        times.sort()
        self.portions, spent, portion = [], 0.0, []
        limits = [0.02, 0.08, 0.2, 0.4, 2.0]
        total = sum(t for t, _ in times)
        for t, name in times:
            spent += t
            portion.append(name)
            if spent > limits[len(self.portions)] * total:
                self.portions.append(portion)
                portion = []
        if portion:
            self.portions.append(portion)
        for i, names in enumerate(self.portions):
            with open(os.path.join(WORK, f"portion_{i}"), "w", encoding="utf-8") as file:
                for name in names:
                    file.write('"' + re.sub(r'([\\,\[\]"*])', r"\\\1", name) + '"\n')
        self.commands = [[self.program, "--abort", "-f", os.path.join(WORK, f"portion_{i}")] for i in range(len(self.portions))]
        self.commands.insert(2, [os.path.join(WORK, "random_mechanisms"), "60", "1", "43"])
        print(f"{len(times)} tests, {self.whole:.0f} s, and 60 random mechanisms", flush=True)

    @staticmethod
    def environment(k):
        return {**os.environ, "UNFURL_MUTANT": str(k), "LP_NUM_THREADS": "0"}

    def verdict(self, k):
        """What finds error k; empty: nothing."""
        for words in self.commands:
            try:
                done = run(words, env=self.environment(k), cwd=WORK, timeout=60 + 5 * self.whole)
            except subprocess.TimeoutExpired:
                return "no end"
            if done.returncode == 0:
                continue
            if done.returncode < 0:
                return f"signal {-done.returncode}"
            names = re.findall(r"^-{70,}\n(.+)\n", done.stdout, re.M) + re.findall(r"^seed \d+: [^:]*", done.stdout, re.M)
            return names[0].strip() if names else "failed"
        return ""


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("seed", nargs="?", type=int, default=random.SystemRandom().randrange(10**6))
    words.add_argument("n", nargs="?", type=int, default=100)
    words.add_argument("--resume", action="store_true")
    given = words.parse_args()
    os.makedirs(WORK, exist_ok=True)
    print(f"seed {given.seed}", flush=True)
    mutants = compiled(given.seed, given.n)
    tests, table = Tests(), os.path.join(WORK, f"{given.seed}.tsv")
    results = {}
    if given.resume and os.path.exists(table):
        results = {int(row.split("\t")[0]): row.rstrip("\n").split("\t")[4] for row in open(table, encoding="utf-8")}
    with open(table, "w" if not results else "a", encoding="utf-8") as file:
        for k, (path, line, kind, _) in enumerate(mutants):
            if k in results:
                continue
            results[k] = tests.verdict(k)
            print(f"{k:3d} {path}:{line + 1} {kind}: {results[k] or 'SURVIVES'}", flush=True)
            file.write(f"{k}\t{path}\t{line + 1}\t{kind}\t{results[k]}\n")
            file.flush()
    report(mutants, results, given.seed)


def report(mutants, results, seed):
    killed, all_of = defaultdict(int), defaultdict(int)
    for k, verdict in results.items():
        folder = mutants[k][0].split("/")[1]
        all_of[folder] += 1
        killed[folder] += verdict != ""
    print(f"\nseed {seed}: {sum(killed.values())} of {len(results)} errors found")
    for folder in sorted(all_of):
        print(f"  {folder:14s} {killed[folder]:3d} of {all_of[folder]}")
    for k, verdict in results.items():
        if verdict == "":
            path, line, kind, change = mutants[k]
            print(f"survives: {path}:{line + 1}, {kind}\n    {change(k).strip()}")


if __name__ == "__main__":
    main()
