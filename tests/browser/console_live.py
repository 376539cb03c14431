#!/usr/bin/python3
"""console_live.py CASE FACE JAW FOLDER: sinew console and its tools, with the page in a real headless Chromium. CASE: a folder of ultrasound; FACE: a
model with a muscle; JAW: a folder of tests/cli/jaw_case.sh; FOLDER: an empty one, for records. TAP; asserts on what the page knows and what records say, never on times."""
import os
import signal
import socket
import subprocess
import sys
import time

from console_page import Page, Select, Tap, WebDriverException, skip_all, until

LONG = 60  # s: what a busy machine may need for a tool's first frame


class Console:
    """A console that runs."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen(["sinew", "console", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        self.port = int(self.url.split(":")[2].split("/")[0])

    def child(self, name):
        """The process of a tool, or None."""
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{pid}/stat", encoding="latin-1") as stat:
                    words = stat.read().replace("(", ")").split(")")
                if words[1] == name and int(words[2].split()[1]) == self.process.pid and words[2].split()[0] != "Z":
                    return int(pid)
            except OSError:
                pass
        return None

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=LONG)
        return self.process.returncode


def open_case(page, name):
    page.driver.execute_script("document.getElementById('cases').close()")
    page.driver.execute_script(f"sinew.send('open {name}')")
    return page.until(f"sinew.state.case === '{name}' && sinew.view.items.size > 0 && sinew.frame !== null", LONG)


def ultrasound(t, page):
    t.check("a case opens", open_case(page, "case"))
    t.check("its probe stands on the skin, and its image is shown", page.until("sinew.probe.known && sinew.image !== null", LONG))
    origin = page.get("sinew.image.origin")
    page.pointer(page.on_probe(), [(6, 0)] * 5)
    pose = page.get("sinew.probe.pose()")
    t.check("dragged, the probe is where the tool has it", page.until(
        f"sinew.frame.pose.every((x, i) => Math.abs(x - {pose}[i]) < 1e-9)", LONG), page.get("sinew.frame"), pose)
    t.check("and the image elsewhere", page.until(f"Math.hypot(...sinew.image.origin.map((x, i) => x - {origin}[i])) > 1e-3", LONG))
    version = page.get("sinew.imageView.version")
    page.type("#slider-Push-in + input", "4")
    t.check("pushed in, it meets a force", page.until("Math.hypot(...sinew.frame.force) > 0.01", LONG), page.get("sinew.frame"))
    t.check("and the image is another", page.until(f"sinew.imageView.version > {version}", LONG))
    t.check("tissue moves", page.until("[...sinew.view.items.values()].some((item) => item.largestMoved() > 1e-3)", LONG))


def settings(t, page):
    for method in ("fem", "exact", "warp", "msds"):
        Select(page.find("#method")).select_by_value(method)
        t.check(f"method {method}", page.until(f"sinew.state.tool.method === '{method}'", LONG))
    frame = page.get("sinew.frame.index")
    t.check("and frames go on", page.until(f"sinew.frame.index > {frame + 5}", LONG))
    page.slide("#slider-image-gain", 20)
    t.check("the gain is the image's", page.until("sinew.state.image.settings.gain.value === '10'", LONG))
    page.driver.execute_script("sinew.send('set dt banana')")
    t.check("what a tool refuses is told in its words", page.until("sinew.said.some((s) => s.tool === 'msds-run' && s.text.includes('banana'))", LONG))
    page.click("#save-image")
    t.check("an image is saved", page.until("document.querySelector('#message-list a') !== null", LONG))
    count = page.get("fetch(document.querySelector('#message-list a').href).then((r) => r.arrayBuffer()).then((b) => new Uint8Array(b).slice(1, 4).join())")
    t.is_("as PNG", count, "80,78,71")


def several(t, console, page):
    deaf = socket.create_connection(("127.0.0.1", console.port))
    deaf.sendall((f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{console.port}\r\nOrigin: http://127.0.0.1:{console.port}\r\nUpgrade: websocket\r\n"
                  "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
    t.is_("a client that will not read is taken", deaf.recv(12), b"HTTP/1.1 101")
    first = page.driver.current_window_handle
    page.driver.switch_to.new_window("window")
    page.open()
    page.until("sinew.probe.known", LONG)
    page.type("#slider-Push-in + input", "2")
    page.until("sinew.probe.arrived", LONG)
    page.driver.close()
    page.driver.switch_to.window(first)
    t.check("a second page moves the probe of the first", page.until("Math.abs(sinew.probe.held.depth - 2) < 0.05", LONG), page.get("sinew.probe.held"))
    frame = page.get("sinew.frame.index")
    t.check("and stalls nobody", page.until(f"sinew.frame.index > {frame + 30}", LONG))
    deaf.close()
    pose = page.get("sinew.probe.pose()")
    page.open()
    t.check("a reload keeps the probe", page.until(
        f"sinew.probe.known && sinew.probe.pose().every((x, i) => Math.abs(x - {pose}[i]) < 1e-6)", LONG), page.get("sinew.probe.pose()"), pose)
    t.is_("and the gain", page.get("document.querySelector('#slider-image-gain').value"), "10")


def deaths(t, console, page):
    os.kill(console.child("us-slice"), signal.SIGKILL)
    t.check("a tool that dies is told of", page.until("document.getElementById('children').innerText.includes('us-slice has ended')", LONG),
            page.get("document.getElementById('children').innerText"))
    page.click("#restart")
    t.check("and starts again by reset", page.until("document.getElementById('children').hidden && sinew.state.children.every((c) => c.alive)", LONG))


def is_whole(path):
    with open(path) as f:
        return f.read().endswith("\nend\n")


def record(t, page, case, folder):
    """What was shown is what the record gives on a command line."""
    page.until("sinew.frame !== null && sinew.probe.known && sinew.image !== null", LONG)
    page.type("#slider-Push-in + input", "3")
    page.until("Math.hypot(...sinew.frame.force) > 0.01 && sinew.probe.arrived", LONG)
    shown = page.get("[sinew.frame.index, sinew.frame.force, document.getElementById('force').textContent]")
    open_case(page, "face")  # which closes the record
    records = sorted((n for n in os.listdir(folder) if n.startswith("case-") and n.endswith(".msds.record")), key=lambda n: int(n.split(".")[0].split("-")[1]))
    t.check("the record becomes whole", until(lambda: is_whole(f"{folder}/{records[-1]}"), LONG), records)
    done = subprocess.run(f"msds-run -q --replay '{folder}/{records[-1]}' <'{case}/mesh.sinew' | sinew info --tsv probe.force",
                          shell=True, capture_output=True, text=True)
    rows = [line.split("\t") for line in done.stdout.splitlines()[1:]]
    replayed = next(([float(x) for x in row[2:]] for row in rows if row[0] == str(shown[0])), (shown[0], rows[-1:], done.stderr))
    t.is_("the force that was shown is the record's, to the bit", shown[1], replayed)
    t.near("in its text to two decimals", float(shown[2].split()[0]), sum(x * x for x in shown[1]) ** .5, .006)


def face(t, page):
    t.check("a face opens", page.until("sinew.state.kind === 'face' && sinew.frame !== null && sinew.view.items.size > 0", LONG))
    name = page.get("sinew.state.muscles[0].name")
    page.slide(f"[id='slider-{name}']", 30)
    t.check("a slider contracts a muscle", page.until("[...sinew.view.items.values()].some((item) => item.largestMoved() > 2e-4)", LONG))
    t.check("whose level is the state's", page.until("sinew.state.muscles[0].level === 0.3", LONG), page.get("sinew.state.muscles"))
    page.click("#relax")
    page.click("#hold-pulls")
    page.click("#look-front")
    page.pointer(page.get("sinew.view.project(sinew.view.middle())"), [(0, -8)] * 5)
    t.check("a point that is dragged is pulled", page.until("sinew.state.pulls.length === 1", LONG), page.get("sinew.said.slice(-3)"))
    t.check("and follows", page.until("((p) => p && sinew.face.pointOf(p).distanceTo(p.rest) > 2e-4)([...sinew.face.pulls.values()][0])", LONG))
    page.click(".pull button")
    t.check("until it is released", page.until("sinew.state.pulls.length === 0 && sinew.face.pulls.size === 0", LONG))
    Select(page.find("#colouring")).select_by_value("quality")
    t.check("colours tell of the elements' quality", page.until("sinew.state.colour === 'quality' && sinew.view.touchable().range && "
                                                                 "sinew.view.touchable().range[1] >= 1", LONG), page.get("sinew.view.touchable().range"))
    t.check("by a legend", page.until("document.getElementById('legend-name').textContent === 'quality, J'"))
    Select(page.find("#colouring")).select_by_value("stress")
    t.check("or of von Mises' stress", page.until("sinew.state.colour === 'stress' && sinew.view.touchable().range && "
                                                  "sinew.view.touchable().range[1] >= 10", LONG), page.get("sinew.view.touchable().range"))
    t.check("with its unit", page.until("document.getElementById('legend-name').textContent === 'von Mises stress, Pa'"))
    Select(page.find("#colouring")).select_by_value("quality")
    page.type("#gy", "-9.81")
    t.check("gravity is the state's", page.until("sinew.state.tool.settings.gravity.value === '0,-9.81,0'", LONG), page.get("sinew.state.tool"))
    page.open()
    t.check("a reload keeps colours, gravity and levels", page.until(
        "document.getElementById('colouring').value === 'quality' && document.getElementById('gy').value === '-9.81' && sinew.state.kind === 'face'"
        " && sinew.view.items.size > 0 && sinew.frame !== null", LONG))
    page.click("#gravity-none")
    page.click("#pause")
    t.check("it stands still when paused", page.until("sinew.state.paused", LONG))
    time.sleep(.5)
    index = page.get("sinew.frame.index")
    page.click("#step")
    t.check("goes on by a frame at least", page.until(f"sinew.frame.index > {index}", LONG))
    page.click("#pause")
    t.check("and on", page.until(f"!sinew.state.paused && sinew.frame.index > {index + 5}", LONG))


def jaw(t, page):
    """Teeth that body.txt puts on the jaw: the page's vertices, m, and its picture."""
    t.check("a face with a jaw opens", open_case(page, "jaw"))
    at = """((item) => item && Array.from({length: 4}, (_, i) => item.placeNow(i).toArray()).flat())(sinew.view.named('teeth'))"""
    rest = page.get(at)
    t.check("its teeth are drawn", rest and abs(rest[2] - .02) < 1e-6, rest)
    near = lambda y, z: f"({at}).every((x, i) => Math.abs(x - [{','.join(map(str, rest))}][i] - [0, {y}, {z}][i % 3]) < 1e-6)"
    page.driver.execute_script("sinew.send('now move jaw 0,1mm,4mm 0,0,0,1')")
    t.check("and go where the jaw goes", page.until(near(.001, .004), LONG), page.get(at), rest)
    page.driver.execute_script("sinew.send('reset')")
    t.check("reset has them at rest", page.until(f"sinew.view.named('teeth') && {near(0, 0)}", LONG), page.get(at), rest)


def main():
    case, model, with_jaw, folder = sys.argv[1:]
    console = Console("--record", folder, case, model, with_jaw)
    page = None
    t = Tap()
    try:
        try:
            page = Page(console)
        except WebDriverException as error:
            skip_all(f"no chromium that selenium can drive: {(error.msg or '').splitlines()[0]}")
        t.check("the page connects", page.open())
        ultrasound(t, page)
        settings(t, page)
        several(t, console, page)
        deaths(t, console, page)
        record(t, page, case, folder)
        face(t, page)
        jaw(t, page)
        t.is_("no message was unreadable", page.get("sinew.problem"), None)
        tools = [console.child(name) for name in ("msds-run", "us-slice", "tled-run")]
        t.is_("^C ends the console", console.end(), 0)
        t.check("and its tools", any(tools) and until(lambda: not any(pid and os.path.exists(f"/proc/{pid}") for pid in tools)), tools)
        t.check("which the page tells", page.until("!sinew.connected"))
    finally:
        if page:
            page.driver.quit()
        console.end()
    print(f"1..{t.count}")
    return 1 if t.failed else 0


if __name__ == "__main__":
    sys.exit(main())
