"""live.py BIN SECONDS SESSIONS [METHOD|face|sessions ...] [SEED]: long live runs, as TAP. For SECONDS each: msds-run with each method, piped to us-slice, and a face in tled-run,
at 60 poses or controls a second, with stalls, garbage, jumps, writers that come and go, and a viewer that stops reading. What is looked at: how far
images are behind the poses, whether memory stays flat, and that all that was sent is accounted for. Then SESSIONS short runs of random methods and
settings (from SEED on) are recorded, and replayed to the same bytes while other processes keep every processor busy. With names, only these."""
import hashlib
import os
import random
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

bin, seconds, sessions = os.path.abspath(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3])
root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
RATE, SLACK = 60, .25  # Hz; s: what a busy machine may add to any delay
METHODS = "msds", "fem", "exact", "warp", "exact-warp"
tests = failures = 0


def ok(passed, name):
    global tests, failures
    tests += 1
    failures += not passed
    print("%sok %d - %s" % ("" if passed else "not ", tests, name), flush=True)
    return passed


def diag(text):
    print("".join("# %s\n" % line for line in text.rstrip().split("\n")), end="", flush=True)


# ---- What is sent: lines at 60 a second into a FIFO, with all that goes wrong.

class Writer(threading.Thread):
    """Sends sound lines and wrong ones, by a plan of its own; counts both, and keeps when each pose was sent."""

    def __init__(self, path, plan, sound, wrong):
        super().__init__(daemon=True)
        self.path, self.plan, self.sound, self.wrong = path, plan, sound, wrong
        self.sent = self.bad = self.closed = 0
        self.when, self.ends = {}, False
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
        self.sum, self.came, self.bytes = hashlib.sha256(), [], 0

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
                time.sleep(1)


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
        self.held = []

    def look(self):
        self.held.append(memory(self.process.pid))

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
        quarter = max(1, len(self.held) // 4)
        before, after = (statistics.median(part) for part in (self.held[quarter:2 * quarter], self.held[-quarter:]))
        ok(after <= more * before + (2 << 20), "%s: memory stays: %.1f MB, then %.1f" % (self.name, before / 1e6, after / 1e6))


def last_line(path):
    return frames_of(path)[1]


# ---- The scenes.

def make_block(folder):
    volume, mesh = os.path.join(folder, "noise.nrrd"), os.path.join(folder, "mesh.sinew")
    with open(volume, "wb") as to:
        to.write(b"NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 64 64 64\nspace directions: (2.5,0,0) "
                 b"(0,1.25,0) (0,0,1.25)\nencoding: raw\nspace origin: (1.25,0.625,0.625)\n\n" + random.Random(1).randbytes(64 ** 3))
    for nodes, name in ("32x16x16", mesh), ("12x6x6", mesh + ".small"):
        subprocess.run([bin + "/msds-mesh", "-q", "--nodes", nodes, "--size", "16cm,8cm,8cm", "--fix", "zmax", "-o", name], check=True)
    return volume, mesh


def names_in(model, key):
    return subprocess.run([bin + "/sinew-info", "--get", key, model], stdout=subprocess.PIPE, text=True, check=True).stdout.split()


def nodes_in(model):
    """The places of its nodes at rest, m."""
    text = subprocess.run([bin + "/attach", "-q", "--text"], stdin=open(model, "rb"), stdout=subprocess.PIPE, text=True, check=True).stdout
    lines = iter(text.split("\n"))
    count = next(int(line.split()[-1]) for line in lines if line.startswith("array node.position "))
    return [tuple(float(number) for number in next(lines).split()) for _ in range(count)]


def make_face(folder):
    """The real face where its data are there, at 2.5 mm; else the head of samples."""
    shared = os.environ.get("SINEW_SHARED", os.path.join(root, "..", "shared"))
    face, obj = os.path.join(shared, "data", "face", "face_zyg.obj"), os.path.join(folder, "face.obj")
    side, made = "2.5", os.path.join(folder, "face.sinew")
    if os.path.exists(face):
        shutil.copy(face, obj)
    else:
        with open(obj, "wb") as to:
            subprocess.run(["awk", "-f", "samples/shape.awk", "-f", "samples/head.awk"], cwd=root, stdout=to, check=True)
    subprocess.run("%s/voxelise -q --unit mm -s %s %s | %s/attach -q -o %s" % (bin, side, obj, bin, made), shell=True, check=True)
    return made, names_in(made, "muscle.name"), names_in(made, "material.name"), nodes_in(made)


class Press:
    """msds-run piped to us-slice, while it runs."""

    def __init__(self, folder, mesh, volume, seed, method):
        self.folder, self.mesh, self.volume, self.method = folder, mesh, volume, method
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
        return ["msds-run", "--method", self.method, "--probe", "linear:4cm,1cm", "--threads", "2"]

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
        time.sleep(1)  # what was sent has come
        self.solver.process.send_signal(signal.SIGINT)
        self.solver.ended()
        self.slicer.ended()
        self.viewer.join(10)
        ok(last_line(self.record) == "end" and last_line(self.images) == "end", "both records have their end")

    def accounted(self):
        poses, stale, controls, skipped, away = self.solver.counts()
        w = self.writer
        ok(poses == w.sent and 0 <= stale <= poses, "poses sent %d = taken %d + stale %d" % (w.sent, poses - stale, stale))
        ok(skipped == w.bad, "wrong lines sent %d = skipped %d" % (w.bad, skipped))
        sent = [feeder.sent for feeder in self.feeders] or [0, 0]
        ok([controls, self.slicer.counts()[2]] == sent, "controls sent %d and %d = taken" % tuple(sent))
        frames, images = frames_of(self.record)[0], frames_of(self.images)[0]
        found = re.search(r"(\d+) frames read, (\d+) of them dropped", self.slicer.text())
        read, dropped = (int(number) for number in found.groups()) if found else (-1, -1)
        shown = len({word(image, "of") for image in images})
        ok(read == len(frames) and shown + dropped == read, "frames made %d = shown %d + dropped %d" % (len(frames), shown, dropped))
        ok(len(images) == len(self.viewer.came), "images recorded %d = seen %d" % (len(images), len(self.viewer.came)))

    def behind(self):
        """How long after its pose was sent an image that shows it first was seen; and how long images with new frames are apart."""
        images, lags, apart, last, seen = frames_of(self.images)[0], [], [], None, set()
        for image, came in zip(images, self.viewer.came):
            key = tuple(float(number) for number in word(image, "pose").split(",")[:3])
            if key in seen:
                continue
            seen.add(key)
            if key in self.writer.when:
                lags.append(came - self.writer.when[key])
            if last is not None:
                apart.append(came - last)
            last = came
        if not ok(len(lags) > 10, "images show poses: %d" % len(lags)):
            return
        frame = max(1 / RATE, statistics.median(apart))
        quarter = max(1, len(lags) // 4)
        first, late = statistics.median(lags[:quarter]), statistics.median(lags[-quarter:])
        middle, most = statistics.median(lags), sorted(lags)[len(lags) * 95 // 100]
        diag("%s: pose to image, ms: median %.1f, 95 %% %.1f, largest %.1f; a frame in %.1f; %s" %
             (self.method, 1e3 * middle, 1e3 * most, 1e3 * max(lags), 1e3 * frame, (self.solver.text().strip().split("\n") or [""])[-1]))
        ok(middle <= 2 * frame + SLACK, "the image is within one frame's time of the newest pose")
        ok(late <= 2 * first + SLACK, "and stays so")

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


def long_press(scratch, mesh, volume, method, seed):
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        press = Press(folder, mesh, volume, seed, method)
        press.feed([], random.Random(seed + 2))
        press.go_on(seconds, True)
        press.end()
        press.accounted()
        press.behind()
        # The exact solver has room for the most contacts that there were: it grows when the probe is deeper than ever.
        press.solver.flat(1.3 if method.startswith("exact") else 1.05)
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

    def sound(now):
        n = plan.random()
        if n < .5 and muscles:
            return now, "now contract %s %.3f\n" % (plan.choice(muscles), .3 * plan.random())
        if n < .6:
            return now, "now gravity 0,0,%.3f\n" % (-2 * plan.random())
        if n < .65 and pulls:
            name = plan.choice(sorted(pulls))
            del pulls[name]
            return now, "release %s\n" % name
        return now, pull("p%d" % plan.randrange(3))
    return sound


def long_face(scratch, model, muscles, materials, nodes, for_seconds, seed):
    plan = random.Random(seed)
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        path, record = os.path.join(folder, "control"), os.path.join(folder, "tled.rec")
        command = ["tled-run", "--precision", "single", "--threads", "2"]
        for material in materials:
            command += ["-m", material + ".nu=0.45"]
        os.mkfifo(path)
        with open(model, "rb") as file:
            tool = Tool(folder, "tled-run", command + ["--live", "--control", path, "--record", record], file)
        viewer = Viewer(tool.process.stdout, random.Random(seed + 1), False)
        writer = Writer(path, plan, face_controls(plan, muscles, nodes), WRONG_CONTROLS)
        viewer.start()
        writer.start()
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
        diag("\n".join(line for line in tool.text().split("\n") if "real time" in line or "poses" in line))
        controls, skipped = tool.counts()[2:4]
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
    first = next((int(word) for word in sys.argv[4:] if word.isdigit()), 0)
    with tempfile.TemporaryDirectory() as scratch:
        volume, mesh = make_block(scratch)
        for i, method in enumerate(METHODS):
            if not only or method in only:
                long_press(scratch, mesh, volume, method, 100 + i)
        if not only or "face" in only:
            long_face(scratch, *make_face(scratch), seconds, 200)
        if not only or "sessions" in only:
            for seed in range(first, first + sessions):
                short_press(scratch, mesh, volume, seed)
    print("1..%d" % tests)
    return 1 if failures else 0


sys.exit(main())
