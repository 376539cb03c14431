"""tests/gate/coverage.py BUILD: what the tests reached of the tools' code, after `make coverage` ran them.

Reads the counters of each test, BUILD/counters/TEST, by gcov, and writes
    BUILD/branches.txt   lines and branches that no test reached, and code that no build compiles: file:line, what, source
    BUILD/map.json       for each line the tests that reach it, for `make mutate`
and a table with a row for each folder on standard output. Commands of the compiler (`make -n V=1`), by which code between
#if and #endif is judged, are read from standard input.
"""
import hashlib
import json
import os
import re
import subprocess
import sys
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor

FOLDERS = ("attach", "bind", "common", "msds", "slice", "tled", "voxelise")


def ours(path):
    return path.split("/")[0] in FOLDERS


class Reached:
    """Lines and branches by file, and whether something reached them; functions by file and first line."""

    def __init__(self):
        self.lines = defaultdict(dict)
        self.branches = defaultdict(dict)
        self.functions = defaultdict(dict)

    def add(self, document):
        """Of one object, as `gcov --json-format` says it. What several objects hold (a header) is reached if it is in one."""
        for source in document["files"]:
            path = os.path.normpath(source["file"])
            if not ours(path):
                continue
            lines, branches, functions = self.lines[path], self.branches[path], self.functions[path]
            for line in source["lines"]:
                number = line["line_number"]
                lines[number] = lines.get(number, False) or line["count"] > 0
                taken = [branch["count"] > 0 for branch in line["branches"] if not branch["throw"]]
                before = branches.get(number, [])
                if len(before) < len(taken):
                    before, taken = taken, before
                branches[number] = [a or b for a, b in zip(before, taken)] + before[len(taken):]
            for function in source["functions"]:
                key = (function["start_line"], function["demangled_name"])
                functions[key] = functions.get(key, False) or function["execution_count"] > 0


def documents(counters):
    """What gcov says of these files, .gcda or .gcno, an object each."""
    for first in range(0, len(counters), 200):
        command = ["gcov", "--json-format", "--stdout", "--branch-probabilities", *counters[first:first + 200]]
        said = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
        for line in said.stdout.decode().splitlines():
            if line.startswith("{"):
                yield json.loads(line)


def found(folder, ending, but=()):
    return sorted(os.path.join(top, name) for top, folders, names in os.walk(folder)
                  if not any(top.startswith(other) for other in but) for name in names if name.endswith(ending))


def read_test(folder):
    """A test's name, its seconds, and what it reached. gcov wants the notes of the compiler beside the counters."""
    counters = found(folder, ".gcda")
    for path in counters:
        notes = path[:-5] + ".gcno"
        if not os.path.lexists(notes):
            os.symlink(notes[len(folder):], notes)
    reached = Reached()
    for document in documents(counters):
        reached.add(document)
    with open(os.path.join(folder, "test"), encoding="utf-8") as file:
        name = file.read().strip()
    with open(os.path.join(folder, "seconds"), encoding="utf-8") as file:
        seconds = float(file.read())
    return name, seconds, reached


def union(whole, part):
    """Adds what a test reached; whole has every line and branch already."""
    for path, lines in part.lines.items():
        for number, is_reached in lines.items():
            whole.lines[path][number] = whole.lines[path].get(number, False) or is_reached
    for path, branches in part.branches.items():
        for number, taken in branches.items():
            before = whole.branches[path].get(number, [])
            taken = taken + [False] * (len(before) - len(taken))
            before = before + [False] * (len(taken) - len(before))
            whole.branches[path][number] = [a or b for a, b in zip(before, taken)]
    for path, functions in part.functions.items():
        for key, is_reached in functions.items():
            whole.functions[path][key] = whole.functions[path].get(key, False) or is_reached


# ---- code that no build compiles

def preprocessed(commands):
    """Which lines of which files the preprocessor lets through in one of the builds, and the sources that were compiled."""
    passed, sources, jobs = defaultdict(set), set(), []
    for command in sorted(set(commands)):
        match = re.match(r"(\S+ .*) -c -o \S+ (\S+\.cc?)$", command)
        if match and ours(match.group(2)):
            sources.add(match.group(2))
            flags = [flag for flag in match.group(1).split() if flag not in ("--coverage", "-MMD", "-MP")]
            jobs.append(flags + ["-E", "-dD", match.group(2)])
    with ThreadPoolExecutor(2) as pool:
        for text in pool.map(lambda job: subprocess.run(job, stdout=subprocess.PIPE, check=True).stdout, jobs):
            path, number = None, 0
            for line in text.decode(errors="replace").splitlines():
                marker = re.match(r'# (\d+) "([^"]*)"', line)
                if marker:
                    number, path = int(marker.group(1)), os.path.normpath(marker.group(2))
                    continue
                if line.strip() and path and ours(path):
                    passed[path].add(number)
                number += 1
    return passed, sources


def blocks(path):
    """The parts of a file between #if, #elif, #else and #endif: the condition, and the lines of code within."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"/\*.*?\*/", lambda comment: "\n" * comment.group().count("\n"), text, flags=re.S)
    open_blocks, result = [], []
    for number, line in enumerate(text.split("\n"), 1):
        directive = re.match(r"\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b(.*)", line)
        if directive:
            if directive.group(1) in ("elif", "else", "endif"):
                result.append(open_blocks.pop())
            if directive.group(1) != "endif":
                open_blocks.append((number, line.strip(), []))
        elif line.split("//")[0].strip() and not re.match(r"\s*#\s*(undef|include|pragma|error)", line):
            for block in open_blocks:
                block[2].append(number)
    return [block for block in result if block[2]]


def never_compiled(passed, sources):
    """(file, first line, last line, why), of code that no build has."""
    result = []
    for path in sorted(set(passed) | sources):
        for start, condition, lines in blocks(path):
            if not passed[path].intersection(lines):
                result.append((path, lines[0], lines[-1], f"line {start} has {condition}"))
    for folder in FOLDERS:
        for path in found(folder, ".c"):
            if path not in sources:
                result.append((path, 1, 1, "no build compiles the file"))
    return result


# ---- reports

def percent(part, whole):
    return f"{100 * part / whole:5.1f}" if whole else "    -"


def print_table(whole):
    sums = defaultdict(lambda: [0] * 6)
    for path in whole.lines:
        counts = [sum(whole.lines[path].values()), len(whole.lines[path]),
                  sum(sum(taken) for taken in whole.branches[path].values()),
                  sum(len(taken) for taken in whole.branches[path].values()),
                  sum(whole.functions[path].values()), len(whole.functions[path])]
        for name in (os.path.dirname(path), "all"):
            sums[name] = [a + b for a, b in zip(sums[name], counts)]
    print("| folder | lines reached | of | % | branches reached | of | % | functions reached | of | % |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|")
    for name in sorted(sums, key=lambda name: (name == "all", name)):
        c = sums[name]
        print(f"| {name:14} | {c[0]:6} | {c[1]:6} | {percent(*c[0:2])} | {c[2]:6} | {c[3]:6} | {percent(*c[2:4])} "
              f"| {c[4]:5} | {c[5]:5} | {percent(*c[4:6])} |")


def write_branches(file, whole, inactive):
    """One line for each thing that no test reached, in the order of the files."""
    entries = defaultdict(list)
    for path, first, last, why in inactive:
        entries[path].append((first, f"never compiled, up to line {last}: {why}" if last > first else f"never compiled: {why}"))
    for path in whole.lines:
        for (line, name), is_reached in whole.functions[path].items():
            if not is_reached:
                entries[path].append((line, f"function never called: {name}"))
        for line, is_reached in whole.lines[path].items():
            taken = whole.branches[path].get(line, [])
            if not is_reached:
                entries[path].append((line, "line never reached"))
            elif not all(taken):
                entries[path].append((line, f"{len(taken) - sum(taken)} of {len(taken)} branches never reached"))
    for path in sorted(entries):
        with open(path, encoding="utf-8") as source:
            text = source.read().split("\n")
        for line, what in sorted(entries[path]):
            file.write(f"{path}:{line}: {what}: {text[line - 1].strip()}\n")


def map_of(tests):
    """For each file its fingerprint, and for each line that is reached the numbers of the tests that reach it."""
    files = {}
    for index, (_, _, reached) in enumerate(tests):
        for path, lines in reached.lines.items():
            entry = files.setdefault(path, {"sha256": fingerprint(path), "lines": defaultdict(list)})
            for number, is_reached in lines.items():
                if is_reached:
                    entry["lines"][number].append(index)
    return {"tests": [name for name, _, _ in tests], "seconds": [seconds for _, seconds, _ in tests], "files": files}


def fingerprint(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def main():
    build = sys.argv[1]
    counters = os.path.join(build, "counters")
    names = sorted(os.listdir(counters)) if os.path.isdir(counters) else []
    folders = [os.path.abspath(os.path.join(counters, name)) for name in names]
    folders = [folder for folder in folders if os.path.exists(os.path.join(folder, "seconds"))]
    if not folders:
        sys.exit(f"coverage: no counters in {counters}; expected those of the tests, by `make coverage`")
    whole = Reached()
    for document in documents(found(build, ".gcno", (counters, os.path.join(build, "tests")))):
        whole.add(document)
    with ThreadPoolExecutor(2) as pool:
        tests = list(pool.map(read_test, folders))
    for _, _, reached in tests:
        union(whole, reached)
    inactive = never_compiled(*preprocessed(sys.stdin.read().splitlines()))
    with open(os.path.join(build, "map.json"), "w", encoding="utf-8") as file:
        json.dump(map_of(tests), file)
    with open(os.path.join(build, "branches.txt"), "w", encoding="utf-8") as file:
        write_branches(file, whole, inactive)
    print_table(whole)


if __name__ == "__main__":
    main()
