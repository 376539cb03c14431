"""live.py BIN SECONDS SESSIONS [NAME ...] [SEED]: long live runs, as TAP. For SECONDS each: msds-run with each method, piped to us-slice, and a face in
tled-run, at 60 poses or controls a second, with stalls, garbage, jumps, writers that come and go, and a viewer that stops reading. What is looked
at: how long each pose or control waits until it, or a newer pose, is seen; whether memory, descriptors and threads stay as many; that all that was
sent is accounted for. Then SESSIONS short runs of random methods and settings (from SEED on) are recorded, and replayed to the same bytes while
other processes keep every processor busy. With names, only these: methods, face, sessions; and msds-card, fem-card, exact-card and face-card, which
need a CUDA device. FACE=FILE: a model of voxelise | attach in place of the one that is made; SIDE=MM: the side of its voxels, 2.5 without it."""
import hashlib
import os
import random
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True  # beside the sources
from face_model import make_face, names_in
from timely import RATE, Metronome, counted, diag, ok, timely

bin, seconds, sessions = os.path.abspath(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3])
root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
METHODS = "msds", "fem", "exact", "warp", "exact-warp", "tissue"
ON_CARD = "msds", "fem", "exact"

# ---- What is sent: lines at 60 a second into a FIFO, with all that goes wrong.

class Writer(threading.Thread):
    """Sends sound lines and wrong ones, by a plan of its own; counts both, and keeps when each pose was sent."""

    def __init__(self, path, plan, sound, wrong):
        super().__init__(daemon=True)
        self.path, self.plan, self.sound, self.wrong = path, plan, sound, wrong
        self.sent = self.bad = self.closed = 0
        self.when, self.ends = {}, False  # s: of each, in their order
        self.fd = None

    def send(self, line):
        os.write(self.fd, line.encode())

    def good(self):
        key, line = self.sound(time.monotonic())
        self.when[key] = time.monotonic()
        self.send(line)
        self.sent += 1

    def leave(self):
        """Goes away, in the middle of a line or not, and comes back."""
        if self.plan.random() < .5:
            self.send("1 .02 .0")
            self.bad += 1
        os.close(self.fd)
        self.closed += 1
        time.sleep(.5)  # until it was seen
        self.fd = os.open(self.path, os.O_WRONLY)
        self.good()  # a writer's first pose may be of any time, so a wrong time is none that comes first

    def run(self):
        self.fd = os.open(self.path, os.O_WRONLY)
        self.good()
        due = time.monotonic()
        while not self.ends:
            dice = self.plan.random()
            if dice < .004:
                time.sleep(self.plan.uniform(.2, 1.5))
            elif dice < .008:
                self.leave()
            elif dice < .04:
                self.send(self.plan.choice(self.wrong))
                self.bad += 1
            elif dice < .05:
                for _ in range(20):  # a burst
                    self.good()
            else:
                self.good()
            due = max(due + 1 / RATE, time.monotonic() - .1)
            time.sleep(max(0, due - time.monotonic()))
        os.close(self.fd)


WRONG_POSES = ("nan 0 0 0 0 0 0 1\n", "1e9 nan 0 0 0 0 0 1\n", "garbage\n", "\x01\x02\x7f\n", "1 2 3\n", "1 .08 .04 0 0 0 0 0\n",
               "-1e9 .08 .04 .001 0 0 0 1\n", "1 .08 .04 inf 0 0 0 1\n", "set\n", "set nothing 1\n", "1 .08 .04 0 0 0 3 4\n", "x" * 70000 + "\n")


def probe_poses(plan):
    """A probe that is moved and pressed, and at times is lost: far away, or deep inside."""
    began = time.monotonic()

    def sound(now):
        t = now - began
        x, y, z = .08 + .02 * plan.random(), .04 + 1e-9 * plan.random(), .004 + .004 * plan.random()
        if plan.random() < .01:
            x, z = plan.choice(((.9, .1), (.08, .03), (.08, -.2)))
            x += 1e-9 * plan.random()
        return (x, y, z), "%.9f %.17g %.17g %.17g 0 0 0 1\n" % (t, x, y, z)
    return sound


class Feeder:
    """A few controls a second."""

    def __init__(self, path, lines, plan):
        self.fd, self.lines, self.plan, self.sent = os.open(path, os.O_WRONLY), lines, plan, 0

    def one(self):
        os.write(self.fd, (self.plan.choice(self.lines) + "\n").encode())
        self.sent += 1

    def close(self):
        os.close(self.fd)


# ---- What comes out.

class Viewer(threading.Thread):
    """Reads images (or all bytes), stops reading at times, and keeps a checksum and when each image came."""

    def __init__(self, stream, plan, images):
        super().__init__(daemon=True)
        self.stream, self.plan, self.images = stream, plan, images
        self.sum, self.came, self.bytes, self.away = hashlib.sha256(), [], 0, []

    def take(self, data):
        self.sum.update(data)
        self.bytes += len(data)
        return data

    def image(self):
        head = self.take(self.stream.readline())
        if not head:
            return False
        comment, size, most = (self.take(self.stream.readline()) for _ in range(3))
        columns, rows = (int(word) for word in size.split())
        self.take(self.stream.read(columns * rows))
        self.came.append(time.monotonic())
        return bool(comment and most)

    def run(self):
        while self.image() if self.images else self.take(self.stream.read1(1 << 16)):
            if self.plan and self.plan.random() < .0005:
                self.away.append(time.monotonic())
                time.sleep(1)

    def was_away(self, since, until):
        """Whether it was not reading then, or had just begun again to read what was written meanwhile."""
        return any(since < left + 1.5 and left < until for left in self.away)


def open_files(pid):
    """How many descriptors and threads it has."""
    try:
        return len(os.listdir("/proc/%d/fd" % pid)) + len(os.listdir("/proc/%d/task" % pid))
    except OSError:
        return 0


def memory(pid):
    """Bytes that the process holds; 0: it is gone."""
    try:
        with open("/proc/%d/statm" % pid) as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")
    except (OSError, IndexError):
        return 0


def frames_of(path):
    """The lines of a record's frames, each as its words; and the line that it ends with."""
    if not os.path.exists(path):
        return [], "no record"
    with open(path) as file:
        lines = file.read().split("\n")
    return [line.split() for line in lines if line.startswith("frame ")], lines[-2] if len(lines) > 1 else ""


def word(frame, key):
    for text in frame[3:]:
        if text.startswith(key + "="):
            return text[len(key) + 1:]
    return None


COUNTS = re.compile(r"(\d+) poses, (\d+) of them stale and dropped; (\d+) controls; (\d+) lines skipped; writers went away: (\d+)")


class Tool:
    def __init__(self, folder, name, command, stdin):
        self.name, self.said = name, os.path.join(folder, name + ".said")
        with open(self.said, "w") as said:
            self.process = subprocess.Popen([os.path.join(bin, command[0])] + command[1:], stdin=stdin, stdout=subprocess.PIPE, stderr=said)
        self.held, self.opened = [], []

    def look(self):
        held, opened = memory(self.process.pid), open_files(self.process.pid)
        if held and opened:
            self.held.append(held)
            self.opened.append(opened)

    def text(self):
        with open(self.said, errors="replace") as file:
            return file.read()

    def ended(self):
        try:
            self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()
        if not ok(self.process.returncode == 0, "%s ends with status 0" % self.name):
            diag("status %s\n%s" % (self.process.returncode, self.text()))

    def counts(self):
        found = COUNTS.search(self.text())
        return [int(number) for number in found.groups()] if found else [-1] * 5

    def flat(self, more=1.05):
        """Whether the last quarter of the run holds no more than the second one, but for a share and what malloc may do."""
        quarter = len(self.held) // 4
        if not ok(quarter > 0, "%s: memory was looked at %d times" % (self.name, len(self.held))):
            return
        before, after = max(self.opened[:2 * quarter]), max(self.opened[-quarter:])
        ok(after <= before, "%s: descriptors and threads stay as many: %d, then %d" % (self.name, before, after))
        before, after = (statistics.median(part) for part in (self.held[quarter:2 * quarter], self.held[-quarter:]))
        ok(after <= more * before + (2 << 20), "%s: memory stays: %.1f MB, then %.1f" % (self.name, before / 1e6, after / 1e6))


def last_line(path):
    return frames_of(path)[1]


def apart(times):
    return [after - before for before, after in zip(times, times[1:])]


def place(frame):
    """The first three numbers of a frame's pose, or None."""
    text = word(frame, "pose")
    return tuple(float(number) for number in text.split(",")[:3]) if text else None


# ---- The scenes.

def make_block(folder):
    volume, mesh = os.path.join(folder, "noise.nrrd"), os.path.join(folder, "mesh.sinew")
    with open(volume, "wb") as to:
        to.write(b"NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 64 64 64\nspace directions: (2.5,0,0) "
                 b"(0,1.25,0) (0,0,1.25)\nencoding: raw\nspace origin: (1.25,0.625,0.625)\n\n" + random.Random(1).randbytes(64 ** 3))
    for nodes, name in ("32x16x16", mesh), ("12x6x6", mesh + ".small"):
        subprocess.run([bin + "/msds-mesh", "-q", "--nodes", nodes, "--size", "16cm,8cm,8cm", "--fix", "zmax", "-o", name], check=True)
    return volume, mesh


def nodes_in(model):
    """The places of its nodes at rest, m."""
    text = subprocess.run([bin + "/attach", "-q", "--text"], stdin=open(model, "rb"), stdout=subprocess.PIPE, text=True, check=True).stdout
    lines = iter(text.split("\n"))
    count = next(int(line.split()[-1]) for line in lines if line.startswith("array node.position "))
    return [tuple(float(number) for number in next(lines).split()) for _ in range(count)]


def find_face(folder):
    """The path of a model, its muscles and materials, and the places of its nodes."""
    made = make_face(bin, root, folder, os.environ.get("SIDE", "2.5"))
    return made, names_in(bin, made, "muscle.name"), names_in(bin, made, "material.name"), nodes_in(made)


class Press:
    """msds-run piped to us-slice, while it runs."""

    def __init__(self, folder, mesh, volume, seed, method, device="cpu"):
        self.folder, self.mesh, self.volume, self.method, self.device = folder, mesh, volume, method, device
        self.name = method + ("" if device == "cpu" else "-card")
        self.record, self.images = os.path.join(folder, "msds.rec"), os.path.join(folder, "slice.rec")
        plan = random.Random(seed)
        paths = [os.path.join(folder, name) for name in ("poses", "control", "knobs")]
        for path in paths:
            os.mkfifo(path)
        with open(mesh, "rb") as model:
            self.solver = Tool(folder, "msds-run", self.solve() + ["--live", "--poses", paths[0], "--control", paths[1], "--record", self.record], model)
        self.slicer = Tool(folder, "us-slice", self.slice() + ["--live", "--control", paths[2], "--record", self.images], self.solver.process.stdout)
        self.solver.process.stdout.close()
        self.viewer = Viewer(self.slicer.process.stdout, random.Random(seed + 1), True)
        self.writer = Writer(paths[0], plan, probe_poses(plan), WRONG_POSES)
        self.viewer.start()
        self.writer.start()
        self.feeders = []
        self.paths = paths

    def solve(self):
        return ["msds-run", "-d", self.device, "--method", self.method, "--probe", "linear:4cm,1cm", "--threads", "2"]

    def slice(self):
        return ["us-slice", "--depth", "6cm", "--size", "256x256", "--threads", "1", self.volume]

    def feed(self, method_lines, plan):
        """Controls for the solver and knobs for the image."""
        lines = ["set iterations %d" % n for n in (10, 20, 30)] + ["set gravity 0,0,%g" % g for g in (0, 1)] + method_lines
        knobs = ["set gain 3", "set gain 0", "set tgc 0,6", "set depth 5cm", "set depth 6cm", "set thickness 2mm,3", "set thickness 0",
                 "set dynamic-range 50,60", "set probe curved:4cm,60,1cm", "set probe linear:4cm,1cm"]
        self.feeders = [Feeder(self.paths[1], lines, plan), Feeder(self.paths[2], knobs, plan)]

    def go_on(self, for_seconds, controls):
        until = time.monotonic() + for_seconds
        while time.monotonic() < until and self.slicer.process.poll() is None:
            time.sleep(.25)
            self.solver.look()
            self.slicer.look()
            for feeder in self.feeders if controls else []:
                feeder.one()

    def end(self):
        self.writer.ends = True
        self.writer.join(10)
        for feeder in self.feeders:
            feeder.close()
        last, until = list(self.writer.when)[-1], time.monotonic() + 20
        while time.monotonic() < until and last not in {place(frame) for frame in frames_of(self.record)[0][-50:]}:
            time.sleep(.2)
        time.sleep(1)  # the controls have come too, and us-slice has the last frame
        self.solver.process.send_signal(signal.SIGINT)
        self.solver.ended()
        self.slicer.ended()
        self.viewer.join(10)
        ok(last_line(self.record) == "end" and last_line(self.images) == "end", "both records have their end")

    def accounted(self):
        poses, stale, controls, skipped, away = self.solver.counts()
        w, used = self.writer, {place(frame) for frame in frames_of(self.record)[0]}
        ok(poses == w.sent == len(used) + stale, "poses sent %d = used %d + stale %d" % (w.sent, len(used), stale))
        ok(used <= set(w.when), "no pose is in the record that was not sent")
        ok(away == w.closed + 1 + bool(self.feeders), "writers went away %d times = seen %d" % (w.closed + 1 + bool(self.feeders), away))
        ok(skipped == w.bad, "wrong lines sent %d = skipped %d" % (w.bad, skipped))
        sent = [feeder.sent for feeder in self.feeders] or [0, 0]
        ok([controls, self.slicer.counts()[2]] == sent, "controls sent %d and %d = taken" % tuple(sent))
        frames, images = frames_of(self.record)[0], frames_of(self.images)[0]
        found = re.search(r"(\d+) frames read, (\d+) of them dropped", self.slicer.text())
        read, dropped = (int(number) for number in found.groups()) if found else (-1, -1)
        shown = len({word(image, "of") for image in images})
        ok(read == len(frames) and shown + dropped == read, "frames made %d = shown %d + dropped %d" % (len(frames), shown, dropped))
        ok(len(images) == len(self.viewer.came), "images recorded %d = seen %d" % (len(images), len(self.viewer.came)))

    def behind(self, slack):
        """How long after each pose was sent an image that shows it, or a newer one, was seen."""
        order, when = {key: i for i, key in enumerate(self.writer.when)}, list(self.writer.when.values())
        frames, images = frames_of(self.record)[0], frames_of(self.images)[0]
        began, ended = [float(frame[2]) for frame in frames], [float(image[2]) for image in images]  # s: a frame's time, and an image's
        waits, shown, first, used = [], 0, {}, 0  # shown: how many of the poses are older than the image, or in it
        for i, frame in enumerate(frames):
            newest = order.get(place(frame), -1)
            first.update((pose, i) for pose in range(used, newest + 1))
            used = max(used, newest + 1)
        for j, (image, came) in enumerate(zip(images, self.viewer.came)):
            newest = order.get(place(image), -1)
            for pose in range(shown, newest + 1):
                i = first[pose]
                if 0 < i < len(frames) - 1 and j > 1 and not self.viewer.was_away(when[pose], came):
                    waits.append((came - when[pose], began[i + 1] - began[i - 1] + ended[j] - ended[j - 2]))
            shown = max(shown, newest + 1)
        ok(shown == len(when), "%s: the last pose is seen" % self.name)
        timely(self.name, waits, [apart(began), apart(ended)], slack)
        diag((self.solver.text().strip().split("\n") or [""])[-1])

    def replayed(self, load):
        """The same images from the records, made while others keep the processors busy."""
        busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(load)]
        try:
            with open(self.mesh, "rb") as model:
                first = Tool(self.folder, "replay-msds", self.solve() + ["--replay", self.record], model)
            second = Tool(self.folder, "replay-slice", self.slice() + ["--replay", self.images], first.process.stdout)
            first.process.stdout.close()
            again = Viewer(second.process.stdout, None, True)
            again.start()
            again.join(600)
        finally:
            for process in busy:
                process.kill()
                process.wait()
        first.ended()
        second.ended()
        same = again.sum.digest() == self.viewer.sum.digest() and again.bytes
        ok(same, "the replay makes the same %d images, %d bytes" % (len(again.came), again.bytes))


def long_press(scratch, mesh, volume, method, seed, device="cpu"):
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        press, metronome = Press(folder, mesh, volume, seed, method, device), Metronome()
        press.feed([], random.Random(seed + 2))
        press.go_on(seconds, True)
        press.end()
        press.accounted()
        press.behind(metronome.slack)
        # The exact solver makes its factor meanwhile, and has room for the most contacts that there were: in the first minutes it grows.
        press.solver.flat(2 if method.startswith("exact") and seconds < 300 else 1.05)
        press.slicer.flat()
        if seconds <= 60:
            press.replayed(3)


def short_press(scratch, mesh, volume, seed):
    plan = random.Random(seed)
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        method = plan.choice(METHODS)
        press = Press(folder, plan.choice((mesh, mesh + ".small")), volume, seed, method)
        press.feed(["method " + name for name in METHODS], plan)
        press.go_on(plan.uniform(1.5, 4), True)
        press.end()
        diag("session %d, begun with %s:" % (seed, method))
        press.accounted()
        press.replayed(4)


# ---- A face, whose muscles and gravity change.

WRONG_CONTROLS = ("now\n", "now contract\n", "now contract nothing .5\n", "garbage here\n", "now gravity nan,0,0\n", "release\n", "pull a 0,0\n",
                  "\x01\x02\n", "now force\n", "x" * 70000 + "\n")


def face_controls(plan, muscles, nodes):
    pulls = {}  # by name: where each pulls at

    def pull(name):
        at = pulls.setdefault(name, plan.choice(nodes))
        to = tuple(x + .003 * (plan.random() - .5) for x in at)
        return "pull %s %.9g,%.9g,%.9g 6mm %.9g,%.9g,%.9g 5\n" % ((name,) + at + to)

    def sound():
        n = plan.random()
        if n < .5 and muscles:
            return "now contract %s %.3f\n" % (plan.choice(muscles), .3 * plan.random())
        if n < .6:
            return "now gravity 0,0,%.3f\n" % (-2 * plan.random())
        if n < .65 and pulls:
            name = plan.choice(sorted(pulls))
            del pulls[name]
            return "release %s\n" % name
        return pull("p%d" % plan.randrange(3))

    def keyed(now):
        line = sound()
        return (now, line.rstrip("\n")), line
    return keyed


class Follower(threading.Thread):
    """Watches how a record grows, which has the lines of a frame at once when the frame is solved."""

    def __init__(self, path):
        super().__init__(daemon=True)
        self.path, self.grown, self.ends = path, [], False  # (when, to what size)

    def run(self):
        size = 0
        while not self.ends:
            time.sleep(.002)
            now = os.path.getsize(self.path) if os.path.exists(self.path) else 0
            if now != size:
                size = now
                self.grown.append((time.monotonic(), size))

    def lines(self):
        """Each line with when it was seen first."""
        at, i = 0, 0
        with open(self.path, "rb") as file:
            for line in file:
                at += len(line)
                while i < len(self.grown) and self.grown[i][1] < at:
                    i += 1
                if i < len(self.grown):
                    yield line.decode().rstrip("\n"), self.grown[i][0]


def answered(name, follower, writer, viewer, slack):
    """How long after it was sent each control is in a frame: they are in the record in their order."""
    sent, waits, taken, ended = iter(writer.when.items()), [], [], []
    for line, seen in follower.lines():
        if line.startswith("frame "):
            ended.append(seen)
            waits += [(seen - when, seen - ended[-3]) for when in taken if len(ended) > 2 and not viewer.was_away(when, seen)]
            taken = []
        elif line.startswith(("now ", "pull ", "release ")):
            # Those that could not be taken are left out.
            taken += [next((when for (_, text), when in sent if text == line), 0)]
    timely(name, waits, [apart(ended)], slack)


def long_face(scratch, model, muscles, materials, nodes, for_seconds, seed, device="cpu"):
    plan, metronome, name = random.Random(seed), Metronome(), "face" + ("" if device == "cpu" else "-card")
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        path, record = os.path.join(folder, "control"), os.path.join(folder, "tled.rec")
        command = ["tled-run", "-d", device, "--precision", "single", "--threads", "2"]
        for material in materials:
            command += ["-m", material + ".nu=0.45"]
        os.mkfifo(path)
        with open(model, "rb") as file:
            tool = Tool(folder, "tled-run", command + ["--live", "--control", path, "--record", record], file)
        viewer = Viewer(tool.process.stdout, random.Random(seed + 1), False)
        writer = Writer(path, plan, face_controls(plan, muscles, nodes), WRONG_CONTROLS)
        follower = Follower(record)
        for thread in (viewer, writer, follower):
            thread.start()
        until = time.monotonic() + for_seconds
        while time.monotonic() < until and tool.process.poll() is None:
            time.sleep(.25)
            tool.look()
        writer.ends = True
        writer.join(10)
        time.sleep(1)
        tool.process.send_signal(signal.SIGINT)
        tool.ended()
        viewer.join(10)
        follower.ends = True
        follower.join()
        told = [line for line in tool.text().split("\n") if "real time" in line or "poses" in line]
        diag("\n".join(told))
        ok(len(told) == 2, "%s: the ratio of simulated to real time is told, and what came" % name)
        controls, skipped, away = tool.counts()[2:]
        ok(away == writer.closed + 1, "writers went away %d times = seen %d" % (writer.closed + 1, away))
        answered(name, follower, writer, viewer, metronome.slack)
        # A tissue that broke has lost its springs, and to release one is wrong then.
        broke = "tissue broke" in tool.text()
        ok(controls + skipped == writer.sent + writer.bad and (broke or controls == writer.sent),
           "lines sent %d and %d wrong = taken %d + skipped %d" % (writer.sent, writer.bad, controls, skipped))
        ok(last_line(record) == "end", "the record has its end")
        tool.flat()
        if for_seconds <= 60:
            with open(model, "rb") as file:
                again = Tool(folder, "replay-tled", command + ["--replay", record], file)
            second = Viewer(again.process.stdout, None, False)
            second.start()
            second.join(600)
            again.ended()
            ok(second.bytes and second.sum.digest() == viewer.sum.digest(), "the replay makes the same %d bytes" % second.bytes)


def main():
    only = [word for word in sys.argv[4:] if not word.isdigit()]
    known = set(METHODS) | {method + "-card" for method in ON_CARD} | {"face", "face-card", "sessions"}
    if set(only) - known:
        sys.exit("live.py: '%s'; expected some of %s" % ((set(only) - known).pop(), ", ".join(sorted(known))))
    first = next((int(word) for word in sys.argv[4:] if word.isdigit()), 0)
    with tempfile.TemporaryDirectory() as scratch:
        volume, mesh = make_block(scratch)
        for i, method in enumerate(METHODS):
            if not only or method in only:
                long_press(scratch, mesh, volume, method, 100 + i)
            if method in ON_CARD and method + "-card" in only:
                long_press(scratch, mesh, volume, method, 150 + i, "cuda")
        if not only or "face" in only:
            long_face(scratch, *find_face(scratch), seconds, 200)
        if "face-card" in only:
            long_face(scratch, *find_face(scratch), seconds, 250, "cuda")
        if not only or "sessions" in only:
            for seed in range(first, first + sessions):
                short_press(scratch, mesh, volume, seed)
    print("1..%d" % counted["tests"])
    return 1 if counted["failures"] else 0


sys.exit(main())
