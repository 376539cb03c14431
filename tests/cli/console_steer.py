"""console_steer.py CASE BIN FOLDER PAGE: the probe of sinew console moved by a FIFO, a 3D mouse and a tracker beside a page, and its pose sent out.
BIN has sinew-console, and stand-ins for igtl-in and igtl-out, which write down what they are told in FOLDER. Prints "ok NAME" or "not ok NAME: ..."
a line. Asserts on states and poses; times are only limits for what hangs."""

import atexit
import os
import signal
import subprocess
import sys
import time

from console_client import Page

case, bin_folder, work, page_folder = sys.argv[1:5]
LONG = 20
FAKE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "spacenavd.py")


def ok(passed, name, remark=""):
    print(("ok " if passed else "not ok ") + name + ("" if passed else f": {remark}"), flush=True)
    return passed


def path(name):
    return os.path.join(work, name)


class Console:
    def __init__(self, *arguments):
        self.errors = open(path("errors"), "w+")
        command = [os.path.join(bin_folder, "sinew-console"), "--page", page_folder, *arguments, case]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self.errors, text=True, env={**os.environ, "STAND_IN": work})
        atexit.register(self.process.kill)
        url = self.process.stdout.readline().strip()
        self.page = Page(int(url.split(":")[2].split("/")[0]))
        self.page.until(lambda p: p.frame and p.frame["pose"], LONG)

    def shows(self, pose, name):
        """A frame comes whose pose is this."""
        near = lambda p: p.frame["pose"] and all(abs(a - b) < 1e-9 for a, b in zip(p.frame["pose"], pose))
        return ok(self.page.until(near, LONG), name, f"{self.page.frame['pose']}, not {pose}")

    def is_moved_by(self, word):
        return ok(self.page.until(lambda p: p.state["probe"]["from"] == word, LONG), f"moved by: {word}", self.page.state["probe"])

    def hand(self, pose):
        self.page.send("pose " + " ".join(map(repr, pose)))

    def end(self, name):
        self.process.send_signal(signal.SIGINT)
        try:
            while True:
                self.page.read(LONG)
        except ConnectionError:
            pass
        status = self.process.wait(timeout=LONG)
        self.process.stdout.close()
        ok(status == 0, f"{name}: it ends with status 0", status)
        self.errors.seek(0)
        return self.errors.read()


def until(condition):
    end = time.monotonic() + LONG
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
    return condition()


def text_of(name):
    try:
        with open(path(name)) as f:
            return f.read()
    except OSError:
        return ""


def line(at, pose):
    return f"{at} " + " ".join(map(repr, pose)) + "\n"


def shifted(pose, x=0.0, z=0.0):
    """By x and z of the probe's own frame."""
    (a, b, c, w), v = pose[3:], (x, 0.0, z)
    cross = lambda p, q: (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])
    once = cross((a, b, c), v)
    twice = cross((a, b, c), once)
    return [p + u + 2 * (w * s + t) for p, u, s, t in zip(pose, v, once, twice)] + pose[3:]


def try_lines():
    os.mkfifo(path("fifo"))
    console = Console("--poses", path("fifo"))
    first = console.page.frame["pose"]
    console.is_moved_by("hand")
    with open(path("fifo"), "w", buffering=1) as f:
        f.write("garbage 1 2\n" + line(0, shifted(first, x=0.003)))
        console.shows(shifted(first, x=0.003), "a pose of a FIFO")
        console.is_moved_by("lines")
        ok(console.page.heard("'garbage'; expected poses alone"), "what is no pose is told", console.page.said)
        console.page.send("reset")
        console.page.frame["pose"] = None
        console.shows(shifted(first, x=0.003), "a case that begins anew has the probe where the lines have it")
    said = console.end("lines")
    ok("poses: " in said and "garbage" in said, "and on standard error", said)


def try_mouse():
    socket = path("spacenavd")
    fake = subprocess.Popen([sys.executable, FAKE, socket], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)
    atexit.register(fake.kill)
    until(lambda: os.path.exists(socket))
    os.environ["SPNAV_SOCKET"] = socket
    console = Console("--poses", "spnav:joystick,reach=7mm")
    first = console.page.frame["pose"]
    time.sleep(0.2)  # what the puck did before the case began does not count
    fake.stdin.write("motion 350 0 0 0 0 0\n")
    console.shows(shifted(first, x=0.007), "the puck of a 3D mouse moves the probe from where the case begins")
    console.is_moved_by("3D mouse")
    there = shifted(first, x=-0.01, z=-0.002)
    console.hand(there)
    fake.stdin.write("motion 0 0 0 0 0 0\n")
    console.shows(there, "a hand takes it away")
    console.is_moved_by("hand")
    time.sleep(0.2)  # nor what it did before the hand's last pose
    fake.stdin.write("motion 0 -350 0 0 0 0\n")
    console.shows(shifted(there, z=0.007), "and the mouse goes on from there")
    console.is_moved_by("3D mouse")
    fake.stdin.write("drop\n")
    ok(console.page.heard("spacenavd went away"), "a daemon that goes away is told", console.page.said)
    fake.stdin.close()
    console.end("3D mouse")
    fake.wait(timeout=LONG)


def try_tracker():
    os.mkfifo(path("in.fifo"))
    console = Console("--poses", "igtl:localhost:18946,ProbeToTracker", "--igtl-out", "127.0.0.1:0")
    first = console.page.frame["pose"]
    ok(until(lambda: text_of("in.args") == "localhost:18946 --transform ProbeToTracker\n"), "igtl-in is started", text_of("in.args"))
    ok(until(lambda: text_of("out.args").startswith("--listen 127.0.0.1:0 --poses /dev/fd/3")), "and igtl-out", text_of("out.args"))
    names = {child["tool"]: child["alive"] for child in console.page.state["children"]}
    ok(names == {"msds-run": True, "us-slice": True, "sinew-igtl-in": True, "sinew-igtl-out": True}, "pages know both", names)
    ok(until(lambda: "sinew-igtl-in: connected" in text_of("errors")), "what they say is on standard error", text_of("errors"))
    with open(path("in.fifo"), "w", buffering=1) as f:
        f.write(line(1e9, shifted(first, z=0.004)))
        console.shows(shifted(first, z=0.004), "a pose of the tracker")
        console.is_moved_by("tracker")
        console.hand(first)
        console.is_moved_by("hand")
        f.write(line(2e9, shifted(first, z=0.005)))
        console.is_moved_by("tracker")  # a second later
        console.shows(shifted(first, z=0.005), "a pose that waits while a hand drags")
        f.write("nonsense\n")
        ok(console.page.heard("line 3: "), "what is wrong is told by its line", console.page.said)
    ok(console.page.heard("sinew-igtl-in ended with status 0"), "a tracker's program that ends is told", console.page.said)
    console.page.until(lambda p: {"tool": "sinew-igtl-in", "alive": False, "why": "ended with status 0"} in p.state["children"], LONG)
    ok(not next(c for c in console.page.state["children"] if c["tool"] == "sinew-igtl-in")["alive"], "and no longer alive", console.page.state["children"])
    console.hand(shifted(first, x=0.001))
    console.shows(shifted(first, x=0.001), "the hand goes on")
    console.end("tracker")
    sent = [list(map(float, words.split())) for words in text_of("out.lines").splitlines()]
    times = [row[0] for row in sent]
    ok(times == sorted(times) and all(abs(t - time.time()) < LONG for t in times), "poses are sent out with the time of the day", times)
    wanted = [first, shifted(first, z=0.004), first, shifted(first, z=0.005), shifted(first, x=0.001)]
    ok(len(sent) == 5 and all(abs(a - b) < 1e-9 for row, pose in zip(sent, wanted) for a, b in zip(row[1:], pose)),
       "all that moved it, a hand too", sent)


def try_program_that_fails():
    os.rename(os.path.join(bin_folder, "sinew-igtl-in.fails"), os.path.join(bin_folder, "sinew-igtl-in"))
    console = Console("--poses", "igtl:localhost:18946")
    ok(console.page.heard("sinew-igtl-in ended with status 1: localhost:18946: no such host"), "a tracker's program that fails is told, and why", console.page.said)
    said = console.end("a program that fails")
    ok("sinew-igtl-in ended with status 1: localhost:18946: no such host" in said, "and on standard error", said)


try_lines()
try_mouse()
try_tracker()
try_program_that_fails()
