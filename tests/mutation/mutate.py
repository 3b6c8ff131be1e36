#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Seeded errors in core: how many the tests find.

    tests/mutation/mutate.py [SEED [N]] [--only FOLDER...] [--resume | --again]

Draws N errors from a seed, as many from each folder of core, no file more than a third of its folder, and compiles
them in at once, each behind a switch (switch.hpp). Every test of core, render and the program, what others read of
its exports, and 60 random mechanisms are run once to see which errors they pass by; then an error is switched on and
the tests that pass by it are run until one fails, core's first, of these those of its own folder and the quick ones; of
the others the quickest, half a minute of each. A test that takes six times its time has failed. Errors that do not compile
are replaced by the next of the draw, as are those that cannot change a result: by the rules of EQUIVALENT, and those
of equivalent.tsv, each with its reason. Prints what survived, by folder and place, and writes build/mutation/SEED.tsv:
--resume goes on from there (also after more were argued equivalent), --again tries the survivors again with the tests
as they are now (core must be what it was).
"""
import argparse
import hashlib
import json
import multiprocessing
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import time
from collections import defaultdict

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WORK = os.path.join(ROOT, "build", "mutation")  # and the seed
RELEASE = os.path.join(ROOT, "build", "release")  # where the tests were built

ONLY = []  # folders of core; none: all

# (kind, changed line, why): errors that no test can see, because nothing that is computed depends on them.
EQUIVALENT = [
    ("dropped statement", r"\.(reserve|shrink_to_fit)\(", "only where memory comes from"),
    ("swap", r"(min|max|hypot|larger|dot|opposite|node_distance|alike|close_to|same_entry)(<[\w:]+>)?\(unfurl_mutation::on\(@\) \?", "the order says nothing"),
    ("factor 2", r"= std::numeric_limits<double>::infinity\(\), .*twice\(@\) \* -?\w+[,;]", "twice infinity"),
    ("factor 2", r"twice\(@\) \* \w+::Zero\(", "twice nothing"),
    ("sign", r"sign\(@\) \* \w+::Zero\(", "nothing, the other way round"),
    ("factor 2", r"twice\(@\) \* (\de-(0?[89]|1\d)|nothing|round_off|rounding|tiny)\b", "twice a threshold of round-off"),
    ("factor 2", r"twice\(@\) \* [\w.:\[\]]+(\(([^()]|\([^()]*\))*\))? (<|<=|>|>=|==|!=) 0[^.\w]", "twice has the same sign"),
    ("off by one", r"\bint (it|round|tries|halvings) = \(0 \+ .*; (it|round|tries|halvings) <=? ([89]|\d\d+|(most|max|fit)_\w+)\b", "a round less of those"),
    ("off by one", r"^ +double s = (0|\(0 \+ .*\)), v = (0|\(0 \+ .*\));", "written over by what is asked for, at() of a motion"),
    ("boundary", r"edge\((it|round|tries|halvings)\) <=? ([89]|\d\d+|(most|max|fit)_\w+)\b", "a round more of those"),
]
# Single ones, as (path, kind, changed line, why): found among the survivors, looked at one by one.
ARGUED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "equivalent.tsv")


# --- where errors can be put -------------------------------------------------------------------------------
def code_of(line):
    """The line with strings and its comment blanked: same columns."""
    blank = lambda m: " " * len(m.group())
    return re.sub(r"//.*", blank, re.sub(r"'(\\.|[^'\\])'|\"(\\.|[^\"\\])*\"", blank, line))


def without_raw_strings(text):
    """The text with the inside of raw strings blanked, line by line as it was."""
    return re.sub(r'R"([^(\s]*)\(.*?\)\1"', lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)


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


LOW = (" && ", " || ", " ? ", " : ", ";", ", ", " = ", " += ", " -= ", "return ")


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
            put("boundary", begin, end, f"({on} ? ({space}edge({left}) {near} {right}) : ({left} {op} {right}))")
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
    for m in re.finditer(r"(?<=[\w>])\((\w[\w.\[\]]*), (?!\1\))(\w[\w.\[\]]*)\)", code):
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
            text = open(path, encoding="utf-8").read()
            lines, here = text.split("\n"), []
            raw = [a != b for a, b in zip(lines, without_raw_strings(text).split("\n"))]
            for i, line in enumerate(lines):
                if raw[i]:
                    continue
                before = code_of(lines[i - 1]).rstrip() if i else ""
                code = code_of(line)
                if re.match(r"\s*(#|//|template|static_assert|case |using |namespace|struct |class )|.*constexpr", code):
                    continue
                for kind, change in sites(line):
                    if kind == "dropped statement" and not (before == "" or before[-1] in ";{})" or before.endswith("else")):
                        continue
                    if not any(kind == k and re.search(rule, change("@")) for k, rule, _ in EQUIVALENT):
                        here.append((i, kind, change))
            found[os.path.relpath(path, os.path.join(WORK, "source"))] = here
    return found


def in_turn(seed, folder, files, at_most):
    """The errors of a folder in the order of the seed: number, (path, line, kind, change); those that are taken,
    which is sent back, are one to a line and at most so many a file."""
    dice = random.Random(f"{seed} {folder}")
    used, lines, number = defaultdict(int), set(), 0
    while files:
        number += 1
        # A file in proportion to what can be changed in it, a kind whatever there is most of.
        path, here = dice.choices(files, [len(h) for _, h in files])[0]
        kind = dice.choice(sorted({h[1] for h in here}))
        line, kind, change = here.pop(dice.choice([i for i, h in enumerate(here) if h[1] == kind]))
        files = [f for f in files if f[1]]
        if (path, line) in lines or used[path] == at_most:
            continue
        if (yield number, (path, line, kind, change)):
            lines.add((path, line))
            used[path] += 1


def argued():
    """{(path, kind, changed line)} that were looked at and can change nothing."""
    with open(ARGUED, encoding="utf-8") as file:
        rows = [row.rstrip("\n").split("\t") for row in file if row.strip() and row[0] != "#"]
    for row in rows:
        if len(row) != 4:
            sys.exit(f"{ARGUED}: path, kind, changed line and why, not {row}")
    return {tuple(row[:3]) for row in rows}


def draw(seed, n, dropped):
    """n errors {number: (path, line, kind, change)}, as many from each folder (the first of a drawn order one more
    where n does not divide), none of those in `dropped`, which did not compile, nor of those argued equivalent. A
    number stays what it is."""
    folders, chosen, equivalent = defaultdict(list), {}, argued()
    for path, here in sorted(candidates().items()):
        if here:
            folders[path.split("/")[1]].append((path, here))
    order = sorted(folders)
    random.Random(seed).shuffle(order)
    order = [folder for folder in order if not ONLY or folder in ONLY]
    for place, folder in enumerate(order):
        quota = n // len(order) + (place < n % len(order))
        errors, taken = in_turn(seed, folder, folders[folder], -(-quota // 3)), None
        while quota > 0:
            try:
                number, mutant = errors.send(taken)
            except StopIteration:
                break
            path, _, kind, change = mutant
            taken = mutant[:3] not in dropped and (path, kind, readable(change)) not in equivalent
            if taken:
                chosen[10000 * place + number] = mutant
                quota -= 1
    return chosen


# --- build and run -----------------------------------------------------------------------------------------
def run(words, **more):
    return subprocess.run(words, capture_output=True, text=True, errors="replace", **more)


def core_files(root):
    for folder, _, files in os.walk(os.path.join(root, "core")):
        for name in files:
            yield os.path.relpath(os.path.join(folder, name), root)


def same_core():
    """Whether the sources of the draw are those of the tree."""
    source = os.path.join(WORK, "source")
    digest = lambda root: {f: hashlib.sha1(open(os.path.join(root, f), "rb").read()).digest() for f in core_files(root)}
    return os.path.exists(source) and digest(source) == digest(ROOT)


def snapshot():
    """The sources as they are now."""
    shutil.rmtree(os.path.join(WORK, "source"), ignore_errors=True)
    for top in ("CMakeLists.txt", "app", "core", "render"):
        source, target = os.path.join(ROOT, top), os.path.join(WORK, "source", top)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, target)
    os.symlink(os.path.join(ROOT, "assets"), os.path.join(WORK, "source", "assets"))


def linked(target):
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
            link[i] = os.path.join(WORK, os.path.basename(target))
    return link


def write_tree(mutants):
    """The sources with all errors in them, touching only files that differ."""
    tree, by_file = os.path.join(WORK, "tree"), defaultdict(list)
    for k, (path, line, _, change) in mutants.items():
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


def build(mutants):
    """Compiles core and links the test programs with it; the mutants that do not compile, by the lines named."""
    tree, folder = write_tree(mutants), os.path.join(WORK, "build")
    launcher = re.findall(r"^UNFURL_CCACHE:\w+=(.*)$", open(os.path.join(RELEASE, "CMakeCache.txt")).read(), re.M)
    done = run(["cmake", "-S", tree, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DUNFURL_TESTS=OFF",
                "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -D_GLIBCXX_ASSERTIONS", f"-DUNFURL_CCACHE={launcher[0]}",
                f"-DCMAKE_CXX_FLAGS=-Werror=return-local-addr -include {ROOT}/tests/mutation/switch.hpp"])
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    done = run(["cmake", "--build", folder, "--target", "unfurl_core", "--", "-k", "0"])
    if done.returncode == 0:
        shutil.rmtree(os.path.join(WORK, "objects"), ignore_errors=True)
        for target in ("unfurl", *(f"tests/{area}_tests" for area in AREAS), "tests/random/random_mechanisms"):
            done = run(linked(target), cwd=RELEASE)
            if done.returncode:
                sys.exit(done.stderr)
        return set()
    bad, errors = set(), "\n".join(line for line in done.stdout.splitlines() if "warning:" not in line)
    for path, line in re.findall(r"(core/[\w/]+\.cpp):(\d+)", errors):
        bad |= {k for k, m in mutants.items() if m[0] == path and m[1] == int(line) - 1}
    if not bad:  # the end of a statement is named, and the error stands where it begins
        for path, line in re.findall(r"(core/[\w/]+\.cpp):(\d+)", errors):
            before = [(m[1], k) for k, m in mutants.items() if m[0] == path and m[1] < int(line)]
            bad |= {max(before)[1]} if before else set()
    if not bad:
        sys.exit(done.stdout[-4000:])
    return bad


def compiled(seed, n):
    """The errors drawn from a seed, compiled in and linked."""
    known = os.path.join(WORK, "dropped")
    dropped = {tuple(error) for error in json.load(open(known))} if os.path.exists(known) else set()
    while True:
        mutants = draw(seed, n, dropped)
        bad = build(mutants)
        print(f"{len(mutants)} errors drawn, {len(bad)} do not compile", flush=True)
        if not bad:
            return mutants
        dropped |= {mutants[k][:3] for k in bad}
        json.dump(sorted(dropped), open(known, "w"))


def program_of(area):
    return os.path.join(WORK, f"{area}_tests")


def own(name):
    """A path of this worker's."""
    return os.path.join(WORK, f"{name}.{os.getpid()}")


class Test:
    """A test (or the random mechanisms, or the exports), how long it takes and which errors it passes by."""

    def __init__(self, area, folder, name):
        self.area, self.folder, self.name, self.seconds, self.reached = area, folder, name, 0.0, set()


AREAS = ("core", "render", "app")  # a program of tests each
RANDOM = Test("random", "integrators", "60 random mechanisms")
EXPORTS = Test("exports", "export", "exports: others read what was written")
MOST_OTHERS = 30.0  # s, of the tests of render and of the program


class Tests:
    def __init__(self):
        self.tests = [RANDOM, EXPORTS]
        for area in AREAS:
            listed = run([program_of(area), "--list-test-names-only", "-v", "high"]).stdout
            found = re.findall(r"^(.+)\t@(?:.*/)?tests/\w+/(\w+).*$", listed, re.M)
            if not found:
                sys.exit("no test is listed by " + program_of(area))
            self.tests += [Test(area, place, name) for name, place in found]
        known, stamp = os.path.join(WORK, "reach.json"), os.path.getmtime(program_of("core"))
        before = json.load(open(known)) if os.path.exists(known) else {}
        if before.get("stamp") != stamp:
            before = {"stamp": stamp}
        open_ones = [test for test in self.tests if test.name not in before]  # names are of one test each
        with multiprocessing.Pool(os.cpu_count()) as workers:
            kept = time.monotonic()
            for test, seen in zip(open_ones, workers.imap(self.look, open_ones)):
                before[test.name] = seen
                if time.monotonic() > kept + 20:  # writing takes longer than most tests
                    json.dump(before, open(known, "w"))
                    kept = time.monotonic()
        json.dump(before, open(known, "w"))
        for test in self.tests:
            if before[test.name] is not None:
                test.seconds, test.reached = before[test.name][0], set(before[test.name][1])
        self.tests = [t for t in self.tests if before[t.name] is not None]
        print(f"{len(self.tests)} tests, {sum(t.seconds for t in self.tests):.0f} s", flush=True)

    def look(self, test):
        """Its time and what it passes by; None where it fails as it is."""
        begin = cpu_of_children()
        if os.path.exists(own("reached")):
            os.remove(own("reached"))
        if self.run([test], -1, 600)[0]:
            print(f"left out, as it fails without any error: {test.name}", flush=True)
            return None
        seen = open(own("reached")).read().split() if os.path.exists(own("reached")) else []
        return [cpu_of_children() - begin, sorted({int(k) for k in seen})]

    def run(self, tests, k, seconds):
        """What fails of these tests with error k switched on, and how; '' if nothing."""
        if tests[0].area == RANDOM.area:
            words = [os.path.join(WORK, "random_mechanisms"), "60", "1", "43"]
        elif tests[0].area == EXPORTS.area:
            words = ["/usr/bin/python3", os.path.join(ROOT, "tests/support/check_exports.py"), os.path.join(WORK, "unfurl"),
                     os.path.join(ROOT, "build/gltf-validator")]
        else:
            with open(own("chosen"), "w", encoding="utf-8") as file:
                for test in tests:
                    file.write('"' + re.sub(r'([\\,\[\]"*])', r"\\\1", test.name) + '"\n')
            words = [program_of(tests[0].area), "--abort", "-f", own("chosen")]
        scratch = own("scratch")
        shutil.rmtree(scratch, ignore_errors=True)
        os.makedirs(scratch)

        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 1))
            if tests[0].area != EXPORTS.area:  # others reserve more than they use
                resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

        environment = {**os.environ, "UNFURL_MUTANT": str(k), "LP_NUM_THREADS": "0", "MALLOC_PERTURB_": "165",
                       "UNFURL_REACHED": own("reached"),
                       "UNFURL_TEST_PROGRAM": os.path.join(WORK, "unfurl"), "UNFURL_ASSETS": os.path.join(ROOT, "assets")}
        try:
            done = run(words, env=environment, cwd=scratch, preexec_fn=limit, timeout=20 * seconds)
        except subprocess.TimeoutExpired:
            return "no end", ""
        if done.returncode == 0:
            return "", ""
        if done.returncode in (-24, -9):  # SIGXCPU
            return "no end", ""
        names = re.findall(r"^-{70,}\n(.+)\n", done.stdout, re.M) + re.findall(r"^seed \d+: [^:]*", done.stdout, re.M)
        how = f" (signal {-done.returncode})" if done.returncode < 0 else ""
        return (names[0].strip() if names else "failed") + how, done.stdout

    def verdict(self, k, path):
        """What finds error k, '' if nothing does, and how many tests pass by it."""
        mine = path.split("/")[1]
        passing = sorted((t for t in self.tests if k in t.reached),
                         key=lambda t: (AREAS[1:].index(t.area) if t.area in AREAS[1:] else -1,
                                        t.seconds * (0.1 if t.folder == mine else 1)))
        spent = defaultdict(float)
        for test in passing:
            spent[test.area] += test.seconds
            test.late = test.area in AREAS[1:] and spent[test.area] > MOST_OTHERS
        passing = [test for test in passing if not test.late]
        limits, portion, rank = [0.3, 1, 3, 10, 30, 1e9], [], 0
        for i, test in enumerate(passing):
            portion.append(test)
            last = i + 1 == len(passing) or test.area != passing[i + 1].area
            if last or sum(t.seconds for t in portion) > limits[rank]:
                found, _ = self.run(portion, k, 10 + 6 * sum(t.seconds for t in portion))
                if found:
                    return found, len(passing)
                portion, rank = [], min(rank + 1, len(limits) - 1)
        return "", len(passing)


def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


# --- what came of it ---------------------------------------------------------------------------------------
def read_table(path):
    """{number: verdict} of an earlier run."""
    rows = [row.rstrip("\n").split("\t") for row in open(path, encoding="utf-8")] if os.path.exists(path) else []
    return {int(row[0]): row[4] for row in rows}


def write_table(path, mutants, results):
    with open(path + ".new", "w", encoding="utf-8") as file:
        for k, verdict in results.items():
            where, line, kind, change = mutants[k]
            file.write(f"{k}\t{where}\t{line + 1}\t{kind}\t{verdict}\t{readable(change)}\n")
    os.replace(path + ".new", path)


def readable(change):
    """The changed line, with `sign`, `keep`, `twice`, `one`, `on` where the error is."""
    return change("@").strip().replace("unfurl_mutation::", "").replace("(@)", "")


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("seed", nargs="?", type=int, default=random.SystemRandom().randrange(10**6))
    words.add_argument("n", nargs="?", type=int, default=100)
    words.add_argument("--only", nargs="+", default=[], help="folders of core")
    words.add_argument("--resume", action="store_true")
    words.add_argument("--again", action="store_true")
    given = words.parse_args()
    global WORK, ONLY
    ONLY = given.only
    table, WORK = os.path.join(WORK, f"{given.seed}.tsv"), os.path.join(WORK, str(given.seed))
    os.makedirs(WORK, exist_ok=True)
    os.nice(10)
    print(f"seed {given.seed}", flush=True)
    results = {}
    if given.resume or given.again:
        if not same_core():
            sys.exit("core is not what it was: begin anew, without --resume or --again")
        results = {k: v for k, v in read_table(table).items() if v or not given.again}
    else:
        snapshot()
        for left in (table, os.path.join(WORK, "dropped")):
            if os.path.exists(left):
                os.remove(left)
    try_all(compiled(given.seed, given.n), results, table)


def judge(task):
    tests, k, path = task
    return k, *tests.verdict(k, path)


def try_all(mutants, results, table):
    """The folders in turn, so that a run that is interrupted has looked at all of them."""
    results = {k: v for k, v in results.items() if k in mutants}  # some may be argued equivalent since
    open_ones = sorted(set(mutants) - set(results), key=lambda k: (mutants_before(mutants, k), k))
    if open_ones:
        tests = Tests()
        tasks = [(tests, k, mutants[k][0]) for k in open_ones]
        with multiprocessing.Pool(os.cpu_count()) as workers:
            for k, verdict, passing in workers.imap_unordered(judge, tasks):
                results[k] = verdict
                path, line, kind, _ = mutants[k]
                print(f"{path}:{line + 1} {kind}: {verdict or f'SURVIVES {passing} tests'}", flush=True)
                write_table(table, mutants, results)
    report(mutants, results, os.path.basename(table)[:-4])


def mutants_before(mutants, k):
    """How many of the same folder were drawn earlier: 10000 numbers are a folder's."""
    return sum(1 for other in mutants if other // 10000 == k // 10000 and other < k)


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
            print(f"survives: {path}:{line + 1}, {kind}\n    {readable(change)}")


if __name__ == "__main__":
    main()
