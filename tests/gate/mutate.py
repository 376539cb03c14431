"""tests/gate/mutate.py BUILD FOLDER COUNT SEED [ONLY]: breaks the code on purpose, one edit at a time, and tells which edits
no test notices. BUILD has the coverage of `make coverage`; FOLDER is all, a folder or a file; ONLY is a list as 3,17.

Works in copies of the checkout in BUILD/mutate. Each edit is drawn by SEED from the lines that tests reach, and built. It is
dropped, and another drawn, where the compiler refuses it or makes the same code of it. Then the test files that reach the line
run, the shortest first, until one fails or takes too long, within tests/gate/sandbox.
"""
import difflib
import filecmp
import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

from mutations import mutations

SLOTS = 2
LARGEST_HEADER = 8  # objects: where more hold a header, it is not seen whether the compiler makes the same of an edit
MAKE_FLAGS = ("CC=gcc", "CUDA=no", "BUILD=build", "BIN=bin", "CFLAGS=-O1", "WERROR=")
SHARED = os.path.abspath(os.environ.get("SINEW_SHARED", "../shared"))
ENVIRONMENT = {**{name: os.environ[name] for name in ("PATH", "HOME") if name in os.environ}, "SINEW_BIN": "bin", "BUILD": "build",
               "CC": "gcc", "CUDA": "no", "MAKE": "make", "SINEW_SHARED": SHARED}
SANDBOX = os.path.abspath("tests/gate/sandbox")
say_lock = threading.Lock()


def say(*words):
    with say_lock:
        print(*words, flush=True)


def fail(text):
    sys.exit(f"mutate: {text}")


# ---- copies of the checkout

def make(folder, *targets, jobs=1):
    """Builds in a copy; whether that went well, and what was said."""
    command = ["make", "--no-print-directory", "-s", f"-j{jobs}", *MAKE_FLAGS, *targets]
    environment = {**ENVIRONMENT, "CCACHE_NOHASHDIR": "1", "CCACHE_BASEDIR": folder}
    done = subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return done.returncode == 0, done.stdout.decode(errors="replace")


def differs(a, b):
    x, y = os.lstat(a), os.lstat(b)
    return x.st_mtime_ns != y.st_mtime_ns or x.st_size != y.st_size or x.st_mode != y.st_mode


def put(source, target):
    os.makedirs(os.path.dirname(target), exist_ok=True)
    if os.path.lexists(target):
        os.unlink(target)
    shutil.copy2(source, target, follow_symlinks=False)


def files_of(folder):
    """The paths of files, and of links whatever they lead to: nothing is to be written through one that a broken program made."""
    return {os.path.relpath(os.path.join(top, name), folder) for top, folders, names in os.walk(folder)
            for name in names + [name for name in folders if os.path.islink(os.path.join(top, name))]}


def restore(base, slot):
    """Makes a copy the same as the base: what was not touched stays."""
    wanted = files_of(base)
    for path in (files_of(slot) if os.path.isdir(slot) else set()) - wanted:
        os.unlink(os.path.join(slot, path))
    for path in wanted:
        source, target = os.path.join(base, path), os.path.join(slot, path)
        if not os.path.lexists(target) or differs(source, target):
            put(source, target)


def build_base(base):
    """A build of the checkout as it is, with -O1 and without CUDA."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], stdout=subprocess.PIPE, check=False)
    paths = {path for path in listed.stdout.decode().split("\0") if path and os.path.lexists(path)}
    if listed.returncode or not paths:
        fail("git does not list the files of this checkout, which are to be copied")
    for path in files_of(base) if os.path.isdir(base) else ():
        if path.split("/")[0] not in ("build", "bin") and path not in paths:
            os.unlink(os.path.join(base, path))
    for path in sorted(paths):
        target = os.path.join(base, path)
        if not os.path.lexists(target) or differs(path, target):
            put(path, target)
    done, said = make(base, "all", "unit", jobs=SLOTS)
    if not done:
        fail(f"the code as it is does not build:\n{said[-2000:]}")


# ---- choosing

class Mutant:
    def __init__(self, path, text, mutation):
        self.path, self.mutation = path, mutation
        self.text = text[:mutation.start] + mutation.new + text[mutation.end:]
        self.diff = "\n".join(difflib.unified_diff(text.split("\n"), self.text.split("\n"), path, path, lineterm="", n=0))
        self.number, self.verdict, self.by, self.seconds = 0, "", "", 0.0

    def name(self):
        return f"{self.path}:{self.mutation.line} ({self.mutation.kind})"


class Drawer:
    """Draws mutants of a folder: a line by lot, then a kind of edit on it, then an edit; no line twice."""

    def __init__(self, folder, paths, reached, seed):
        self.lot = random.Random(f"{seed} {folder}")
        self.by_line = []
        for path in sorted(paths):
            with open(path, encoding="utf-8") as file:
                text = file.read()
            lines = {}
            for mutation in mutations(text, reached[path]):
                lines.setdefault(mutation.line, []).append(mutation)
            self.by_line += [(path, text, lines[line]) for line in sorted(lines)]
        self.size = len(self.by_line)
        self.lot.shuffle(self.by_line)

    def draw(self):
        if not self.by_line:
            return None
        path, text, choices = self.by_line.pop()
        kind = self.lot.choice(sorted({mutation.kind for mutation in choices}))
        return Mutant(path, text, self.lot.choice([mutation for mutation in choices if mutation.kind == kind]))


def shares(sizes, count):
    """How many of each folder, by size: at least one of each where there are as many."""
    whole = sum(sizes.values())
    exact = {name: count * size / whole for name, size in sizes.items()}
    result = {name: max(1, int(exact[name])) for name in sizes}
    for name in sorted(sizes, key=lambda name: (int(exact[name]) - exact[name], name)):
        result[name] += sum(result.values()) < count
    while sum(result.values()) > max(count, len(sizes)):
        result[max(result, key=lambda name: (result[name], name))] -= 1
    return result


def objects_with(base, path):
    """The objects that are compiled from a file, by what the compiler noted."""
    found = []
    for top, _, names in os.walk(os.path.join(base, "build")):
        for name in names:
            if name.endswith(".d"):
                with open(os.path.join(top, name), encoding="utf-8") as file:
                    if re.search(rf"(^|\s){re.escape(path)}(\s|$)", file.read()):
                        found.append(os.path.relpath(os.path.join(top, name[:-2] + ".o"), base))
    return sorted(path for path in found if os.path.exists(os.path.join(base, path)))


def is_new(mutant, base, slot):
    """Whether the compiler takes it and makes other code of it."""
    restore(base, slot)
    with open(os.path.join(slot, mutant.path), "w", encoding="utf-8") as file:
        file.write(mutant.text)
    objects = objects_with(base, mutant.path)
    many = len(objects) > LARGEST_HEADER
    done, _ = make(slot, *(objects[:1] if many else objects))
    if not done:
        return False, "is not C"
    same = not many and all(filecmp.cmp(os.path.join(base, path), os.path.join(slot, path), shallow=False) for path in objects)
    return not same, "is the same to the compiler"


def choose(cover, folder, count, seed, base, slot):
    reached = {path: {int(line) for line in entry["lines"]} for path, entry in cover["files"].items()
               if path.endswith((".c", ".h")) and (folder == "all" or path == folder or path.startswith(folder.rstrip("/") + "/"))}
    if not any(reached.values()):
        fail(f"FOLDER is '{folder}', of which no test reaches a line; expected all, or a folder or file such as tled or common/base/num.c")
    folders = {}
    for path in reached:
        folders.setdefault(os.path.dirname(path), []).append(path)
    drawers = {name: Drawer(name, paths, reached, seed) for name, paths in folders.items()}
    drawers = {name: drawer for name, drawer in drawers.items() if drawer.size}
    chosen, dropped = [], {}
    for name, share in sorted(shares({name: drawer.size for name, drawer in drawers.items()}, count).items()):
        taken = 0
        while taken < share:
            mutant = drawers[name].draw()
            if not mutant:
                break
            new, why = is_new(mutant, base, slot)
            if new:
                taken += 1
                chosen.append(mutant)
                mutant.number = len(chosen)
            else:
                dropped[why] = dropped.get(why, 0) + 1
    return chosen, dropped


# ---- trying

class Bench:
    """Runs tests, and remembers which of them pass on the code as it is."""

    def __init__(self, base, cover):
        self.base, self.cover = base, cover
        self.cpu = {}
        for name, seconds in zip(cover["tests"], cover["seconds"]):
            self.cpu[self.program(name)] = seconds
        self.sound, self.lock = {}, threading.Lock()
        self.running, self.ended = set(), False

    @staticmethod
    def program(name):
        """A test file as a copy has it."""
        return name if name.endswith(".t") else re.sub(r"^.*/(tests/unit/)", r"build/\1", name)

    def reaching(self, mutant):
        numbers = self.cover["files"][mutant.path]["lines"][str(mutant.mutation.line)]
        names = [self.program(self.cover["tests"][number]) for number in numbers]
        return sorted(names, key=lambda name: (name.endswith(".t"), self.cpu[name], name))

    def run(self, slot, test):
        """How a test ends: '' where it passes, else what was wrong."""
        cpu = int(10 + 4 * self.cpu.get(test, 30))
        environment = {**ENVIRONMENT, "CPU_SECONDS": str(cpu)}
        if "emulated" not in test:  # whose sanitizer reserves terabytes
            environment["MEMORY_KIB"] = str(8 << 20)
        wall = time.monotonic() + 60 + 12 * cpu
        command = [SANDBOX, slot, *(["sh"] if test.endswith(".t") else []), test]
        process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.DEVNULL, text=True, errors="replace")
        self.running.add(process)
        if self.ended:
            process.kill()
        timer = threading.Timer(wall - time.monotonic(), process.kill)
        timer.start()
        wrong = ""
        for line in process.stdout:
            if line.startswith("not ok"):
                wrong = line.strip()
                process.kill()
                break
        status = process.wait()
        timer.cancel()
        self.running.discard(process)
        if self.ended:
            raise KeyboardInterrupt
        if status == 125:
            fail("tests/gate/sandbox cannot be had here; it wants Linux's namespaces, and root")
        if not wrong and status:
            wrong = "time limit" if time.monotonic() > wall or status in (-9, 137, 152) else f"status {status}"
        return wrong

    def stop(self):
        """Ends what runs, and with it all that it started."""
        self.ended = True
        for process in list(self.running):
            process.kill()

    def is_sound(self, test):
        with self.lock:
            if test not in self.sound:
                self.sound[test] = not self.run(self.base, test)
                if not self.sound[test]:
                    say(f"note: {test} fails on the code as it is, in a copy, and is left out")
            return self.sound[test]

    def try_one(self, mutant, slot, tests):
        began = time.monotonic()
        restore(self.base, slot)
        with open(os.path.join(slot, mutant.path), "w", encoding="utf-8") as file:
            file.write(mutant.text)
        units = [test for test in tests if not test.endswith(".t")]
        groups = [units[at:at + 6] for at in range(0, len(units), 6)] + [[test for test in tests if test.endswith(".t")]]
        mutant.verdict = "survived"
        for group in groups:
            if not group:
                continue
            done, said = make(slot, *(["cli-programs"] if group[0].endswith(".t") else group))
            if not done:
                fail(f"mutant {mutant.number}, {mutant.name()}, does not build:\n{said[-2000:]}")
            for test in group:
                if self.sound.get(test) is False:
                    continue
                wrong = self.run(slot, test)
                if wrong and self.is_sound(test):
                    mutant.verdict, mutant.by = "killed", f"{os.path.basename(test)}: {wrong}"
                    break
            if mutant.verdict == "killed":
                break
        mutant.seconds = time.monotonic() - began
        restore(self.base, slot)
        by = f", by {mutant.by}" if mutant.by else f" {len(tests)} test files"
        say(f"{mutant.verdict:8} {mutant.number:3} {mutant.name()}{by} ({mutant.seconds:.0f} s)")
        if mutant.verdict == "survived":
            say(mutant.diff)


def tell(chosen, dropped, command):
    survivors = [mutant for mutant in chosen if mutant.verdict == "survived"]
    say(f"\n{command}")
    by_folder = {}
    for mutant in chosen:
        counts = by_folder.setdefault(os.path.dirname(mutant.path), [0, 0])
        counts[0] += 1
        counts[1] += mutant.verdict == "killed"
    for name in sorted(by_folder):
        say(f"{name:16} {by_folder[name][1]:3} of {by_folder[name][0]:3} killed")
    for why, count in sorted(dropped.items()):
        say(f"drawn and dropped: {count}, each {why}")
    say(f"{len(chosen)} mutants, {len(chosen) - len(survivors)} killed, {len(survivors)} survived")
    for mutant in survivors:
        say(f"\nsurvivor {mutant.number}: {mutant.name()}\n{mutant.diff}")


def read_cover(build):
    path = os.path.join(build, "coverage", "map.json")
    if not os.path.exists(path):
        fail(f"there is no {path}; run `make coverage` first")
    with open(path, encoding="utf-8") as file:
        cover = json.load(file)
    for source, entry in sorted(cover["files"].items()):
        with open(source, "rb") as file:
            if hashlib.sha256(file.read()).hexdigest() != entry["sha256"]:
                fail(f"{source} is not what `make coverage` saw; run it again")
    return cover


def main():
    build, folder, count, seed = sys.argv[1:5]
    signal.signal(signal.SIGQUIT, signal.SIG_DFL)  # a shell ignores it, and SIGINT, for what it runs in the background;
    signal.signal(signal.SIGINT, signal.default_int_handler)  # tests want the default actions
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    only = sys.argv[5] if sys.argv[5:] else ""
    if not re.fullmatch(r"(\d+(,\d+)*)?", only):
        fail(f"ONLY is '{only}'; expected numbers of mutants, as 3,17")
    if not re.fullmatch(r"[1-9]\d*", count) or not re.fullmatch(r"\d+", seed):
        fail(f"N is '{count}' and SEED '{seed}'; expected a number of mutants and a seed, whole numbers")
    cover = read_cover(build)
    work = os.path.abspath(os.path.join(build, "mutate"))
    base, slots = os.path.join(work, "base"), [os.path.join(work, f"slot{number}") for number in range(SLOTS)]
    build_base(base)
    chosen, dropped = choose(cover, folder, int(count), seed, base, slots[0])
    bench = Bench(base, cover)
    chosen = [mutant for mutant in chosen if not only or str(mutant.number) in only.split(",")]
    free = list(slots)

    def try_next(mutant):
        slot = free.pop()
        try:
            bench.try_one(mutant, slot, bench.reaching(mutant))
        finally:
            free.append(slot)

    with ThreadPoolExecutor(SLOTS) as pool:
        try:
            for result in [pool.submit(try_next, mutant) for mutant in chosen]:
                result.result()
        except BaseException:
            bench.stop()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    tell(chosen, dropped, f"make mutate FOLDER={folder} N={count} SEED={seed}")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("mutate: interrupted; the checkout is as it was")
