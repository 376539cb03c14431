"""console_talk.py FACE CASE BIN FOLDER PAGE CASES JAW: talks to sinew console as a page does, and prints "ok NAME" or "not ok NAME: ..." a line.
FACE: a model with a muscle; CASE: a case folder; FOLDER: for records; CASES: what samples/console makes; JAW: what jaw_case.sh
makes. Asserts on states and bytes; times are only limits for what hangs."""

import atexit
import os
import signal
import subprocess
import sys
import time

from console_client import Page, decode_geometry, decode_image, decode_positions, request, upgrade

face, case, bin_folder, work, page_folder, cases, jaw = sys.argv[1:8]
LONG = 60


def ok(passed, name, remark=""):
    print(("ok " if passed else "not ok ") + name + ("" if passed else f": {remark}"), flush=True)
    return passed


class Console:
    """A console that runs, and where its page is."""

    def __init__(self, *arguments):
        self.errors = open(os.path.join(work, "errors"), "w+")
        command = [os.path.join(bin_folder, "sinew-console"), "--page", page_folder, *arguments]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self.errors, text=True)
        atexit.register(self.process.kill)  # where this program ends before it
        self.url = self.process.stdout.readline().strip()
        self.port = int(self.url.split(":")[2].split("/")[0]) if self.url else 0

    def said(self):
        self.errors.seek(0)
        return self.errors.read()

    def children(self):
        path = f"/proc/{self.process.pid}/task/{self.process.pid}/children"
        with open(path) as f:
            return [int(word) for word in f.read().split()]

    def child(self, name):
        """The process of a tool, or None."""
        for pid in self.children():
            try:
                with open(f"/proc/{pid}/comm") as f:
                    if f.read().strip() == name:
                        return pid
            except OSError:
                pass
        return None

    def end(self, how=signal.SIGINT, page=None):
        """Its status. A page that is given reads to its end, and answers the goodbye."""
        self.process.send_signal(how)
        try:
            while page:
                page.read(LONG)
        except ConnectionError:
            pass
        status = self.process.wait(timeout=LONG)
        self.process.stdout.close()
        self.errors.close()
        return status


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as f:
            return f.read().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def gone(pids):
    end = time.monotonic() + LONG
    while any(is_alive(pid) for pid in pids) and time.monotonic() < end:
        time.sleep(0.02)
    return not any(is_alive(pid) for pid in pids)


def alive(page):
    children = page.state and page.state["children"]
    return bool(children) and all(child["alive"] for child in children)


def frames(n):
    return lambda page: page.counts.get("frame", 0) >= n


def still(page):
    """Whether no frame comes for half a second, after those that were on their way."""
    end = time.monotonic() + LONG
    while time.monotonic() < end:
        before = page.frame["index"]
        page.until(lambda p: False, 0.5)
        if page.frame["index"] == before:
            return True
    return False


def largest(page):
    return max(high for _, high in decode_positions(page.binary[3])[1].values()) if 3 in page.binary else 0


def try_refusals(console):
    port = console.port
    status, head, body = request(port, "/")
    ok(status == 200 and b"<title>" in body and "nosniff" in head and "Content-Security-Policy" in head, "the page", head)
    status, head, _ = request(port, "/three/build/three.module.js")
    ok(status == 200 and "javascript" in head, "three.js, with its type", head)
    ok(request(port, "/", host="localhost:%d" % port)[0] == 200, "by the name localhost")
    for host in ("evil.example", f"evil.example:{port}", "127.0.0.1", f"127.0.0.1:{port + 1}", f"127.0.0.1:{port}.evil.example"):
        status, _, body = request(port, "/", host=host)
        ok(status == 403 and b"Host" in body, f"Host {host.replace(str(port), 'PORT')}: refused", status)
        ok(upgrade(port, host=host) == 403, "and so is its upgrade")
    ok(request(port, "/", {"Host": None})[0] in (400, 403), "no Host")
    for origin in ("http://evil.example", "null", f"https://127.0.0.1:{port}", f"http://localhost:{port}", None):
        ok(upgrade(port, origin=origin) == 403, f"Origin {str(origin).replace(str(port), 'PORT')}: refused", origin)
    ok(request(port, "/", {"Origin": "http://evil.example"})[0] == 403, "a page of another site gets nothing else either")
    ok(upgrade(port) == 101, "the page's own upgrade")
    ok(upgrade(port, path="/other") in (404, 400), "WebSockets are at /live alone")
    for method in ("POST", "PUT", "DELETE", "OPTIONS", "PROPFIND"):
        ok(request(port, "/", method=method)[0] == 405, f"{method}: refused")
    escapes = ["/../../../../etc/passwd", "/%2e%2e/%2e%2e/%2e%2e/etc/passwd", "/three/../../../../etc/passwd", "/three/..%2f..%2f..%2fetc/passwd",
               "/.git/config", "/case/../../etc/passwd", "/case/%2e%2e/picture.png", "/case/none/picture.png", "/save/../errors",
               "/save/%2e%2e%2ferrors", "/save/errors", "/three", "/three/", "//etc/passwd", "/%ff", "/a\\..\\b"]
    for path in escapes:
        status, _, body = request(port, path)
        ok(status in (400, 403, 404) and b"root:" not in body, f"{path}: not there", status)


def try_messages(console):
    page = Page(console.port)
    page.send("nonsense")
    ok(page.heard("unknown message 'nonsense'"), "nonsense is answered in words", page.said)
    page.send("x" * 5000)
    ok(page.heard("a message of 5000 bytes; expected at most 4096"), "a long message is answered", page.said)
    page.send("method fem\nset dt 1")
    ok(page.heard("control character 0x0a"), "two lines in one are not two", page.said)
    page.send("open ../../etc/passwd")
    ok(page.heard("there is no case '../../etc/passwd'"), "a case that is not in the list", page.said)
    page.send("set iterations 5")
    ok(page.heard("is for a case of ultrasound"), "what is for another kind of case", page.said)
    for name, opcode, final, data in (("bytes", 2, True, b"abc"), ("a part of a text", 1, False, b"abc"), ("what no kind has", 7, True, b"")):
        other = Page(console.port)
        other.send(data, opcode, final)
        try:
            other.until(lambda p: False, 10)
            closed = False
        except ConnectionError:
            closed = True
        ok(closed, f"{name}: ends the connection")
    other = Page(console.port)
    other.socket.sendall(b"\x81\xff" + (2**40).to_bytes(8, "big") + b"mask" + b"x" * 100)
    other.close()
    page.send("step")
    ok(page.heard("step: the case is not paused"), "the other page goes on after a giant that never comes", page.said)
    page.close()


def try_face(console):
    page = Page(console.port)
    ok(page.until(lambda p: p.state and 2 in p.binary and frames(3)(p), LONG), "a state, the meshes, and frames come", page.counts)
    state = page.state
    ok(state["kind"] == "face" and state["case"] == "muscle" and state["tool"]["name"] == "tled-run", "it is a face", state)
    ok([m["level"] for m in state["muscles"]] == [0, 0], "its muscle and its expression are at rest", state["muscles"])
    ok((state["muscles"][1]["name"], state["muscles"][1]["side"]) == ("@half", "expression"), "which has a slider too", state["muscles"])
    header, meshes = decode_geometry(page.binary[2])
    ok([m["kind"] for m in header["meshes"]].count("mesh") + [m["kind"] for m in header["meshes"]].count("skin") >= 1, "meshes have kinds", header)
    ok(all(max(corners) < len(places) // 3 for places, corners in meshes), "and their triangles' corners are there")
    ok(page.until(lambda p: 3 in p.binary, LONG), "positions come")
    _, parts = decode_positions(page.binary[3])
    rest = {m["id"]: meshes[i][0] for i, m in enumerate(header["meshes"])}
    off = max(abs(a - b) for i, (places, _) in parts.items() for a, b in zip(places, rest[i]))
    ok(off < 1e-5, "which are those at rest, to 16 bits", off)
    name = state["muscles"][0]["name"]
    page.send(f"now contract {name} 0.5")
    ok(page.until(lambda p: largest(p) > 1e-5, LONG), "a muscle moves it", largest(page))
    ok(page.state["muscles"][0]["level"] == 0.5, "and the state has its level", page.state["muscles"])
    page.send("now contract @half 0.25")
    ok(page.until(lambda p: p.state["muscles"][1]["level"] == 0.25, LONG), "and so has an expression", page.state["muscles"])
    page.send("now contract @half 0")
    other = Page(console.port)
    ok(other.until(lambda p: p.state and p.state["muscles"][0]["level"] == 0.5 and 2 in p.binary, LONG), "a page that comes later has the same state")
    page.send("pull a 0,0,0 1 1mm,0,0 20")
    ok(other.until(lambda p: p.state["pulls"], LONG), "both have the point that is pulled")
    ok(other.state["pulls"] == [{"id": "a", "point": [0, 0, 0], "radius": 1, "target": [0.001, 0, 0], "stiffness": 20}], "as numbers", other.state["pulls"])
    page.send("release a")
    ok(other.until(lambda p: not p.state["pulls"], LONG), "and its release")
    page.send("now nonsense 1")
    ok(other.heard("tled-run: unknown verb 'nonsense'", LONG), "what the tool says is heard by both", other.said)
    page.send("pause on")
    ok(page.until(lambda p: p.state["paused"], LONG), "it is paused")
    ok(still(page), "soon no frame comes")
    before = page.frame["index"]
    page.send("step")
    ok(page.until(lambda p: p.frame["index"] > before, LONG), "a step is one")
    page.send("pause off")
    ok(page.until(lambda p: p.frame["index"] > before + 5, LONG), "and goes on")
    page.send("save model")
    ok(page.until(lambda p: p.saved, LONG), "it is saved")
    status, _, body = request(console.port, page.saved[0]["url"])
    with open(os.path.join(work, "saved.sinew"), "wb") as f:
        f.write(body)
    info = subprocess.run([os.path.join(bin_folder, "sinew-info"), os.path.join(work, "saved.sinew"), "--get", "frames"], capture_output=True, text=True)
    ok(status == 200 and info.stdout.strip() == "1", "as a model of one frame", info.stderr)
    child = console.child("tled-run")
    os.kill(child, signal.SIGKILL)
    ok(page.heard("tled-run was killed by signal 9", LONG), "a tool that dies is told of", page.said)
    ok(page.until(lambda p: not alive(p), LONG) and "killed by signal 9" in (page.state["why"] or ""), "and the state says so", page.state)
    page.send("reset")
    ok(page.until(alive, LONG) and page.until(frames(page.counts["frame"] + 2), LONG), "reset begins it anew")
    ok(page.state["muscles"][0]["level"] == 0 and page.state["why"] is None, "from rest", page.state)
    page.close()
    other.close()


def try_stalled(console):
    """A client that does not read, and one that does."""
    stalled = Page(console.port, buffer=4096)
    page = Page(console.port)
    page.until(lambda p: p.state, LONG)
    before = page.counts.get("frame", 0)
    ok(page.until(frames(before + 60), LONG), "a client that does not read stalls no other", page.counts)
    with open(f"/proc/{console.process.pid}/statm") as f:
        ok(int(f.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") < 400e6, "nor does it fill memory")
    newest = page.frame["index"]
    ok(stalled.until(lambda p: p.frame and p.frame["index"] >= newest, LONG), "when it reads again it gets to the newest frame")
    many = [Page(console.port) for _ in range(6)]
    ok(upgrade(console.port) != 101, "nine clients are too many")
    for each in [*many, stalled, page]:
        each.close()
    again = None
    end = time.monotonic() + LONG
    while not again and time.monotonic() < end:
        try:
            again = Page(console.port)
        except ConnectionError:
            time.sleep(0.05)
    ok(again is not None, "places become free")
    again.close()


def try_ends(case_or_face):
    for how, status, name in ((signal.SIGINT, 0, "^C"), (signal.SIGTERM, 0, "SIGTERM"), (signal.SIGKILL, -9, "kill -9")):
        console = Console(case_or_face)
        page = Page(console.port)
        page.until(alive, LONG)
        children = console.children()
        got = console.end(how, page)
        ok(got == status and page.goodbye == (None if how == signal.SIGKILL else 1001), f"{name}: status {status}, and the page is told", (got, page.goodbye))
        ok(children and gone(children), f"{name}: no child is left", children)
        page.close()


def try_token():
    console = Console("--listen", "0.0.0.0:0", face)
    token = console.url.partition("?token=")[2]
    ok(len(token) == 32, "for other machines the address has a token", console.url)
    ok(request(console.port, "/")[0] == 403 and request(console.port, f"/?token={token[:-1]}x")[0] == 403, "the page without it, or with another")
    ok(upgrade(console.port) == 403, "nor WebSockets")
    ok(request(console.port, f"/?token={token}")[0] == 200 and upgrade(console.port, f"/live?token={token}") == 101, "both with it")
    ok(upgrade(console.port, f"/live?token={token}", host="lab.example:80") == 101, "by any name")
    console.end()


def try_ultrasound():
    records = os.path.join(work, "records")
    console = Console("--record", records, case)
    page = Page(console.port)
    ok(page.until(lambda p: p.state and 1 in p.binary and 2 in p.binary and frames(3)(p), LONG), "state, meshes, frames, images", page.counts)
    ok(page.state["kind"] == "ultrasound" and page.state["recording"] is True, "it is ultrasound, and recorded", page.state)
    header, _ = decode_geometry(page.binary[2])
    ok({"bone", "vein", "artery", "skin"} <= {m["name"] for m in header["meshes"]} and header["up"] == [0, -1, 0], "labels and skin, and what is up", header)
    index, columns, rows, _, plane, jpeg = decode_image(page.binary[1])
    ok(columns == 512 and rows > 0 and jpeg[:2] == b"\xff\xd8" and jpeg[-2:] == b"\xff\xd9", "an image is a JPEG", (columns, rows))
    ok(abs(sum(x * x for x in plane[3:6]) ** 0.5 - 0.04 / columns) < 1e-9, "whose place is told", plane)
    page.send("pixels raw")
    ok(page.until(lambda p: 4 in p.binary, LONG), "or its pixels where the page wants them", page.counts)
    _, columns, rows, _, _, pixels = decode_image(page.binary[4])
    ok(len(pixels) in (columns * rows, 3 * columns * rows), "a byte each, or three", (columns, rows, len(pixels)))
    page.send("got image")
    images = page.counts[4]
    page.until(frames(page.counts["frame"] + 20), LONG)
    # One may have been on its way; the next was not waited for.
    ok(images <= page.counts[4] <= images + 3, "a page that says what it is done with gets no more images", (images, page.counts[4]))
    ok(not page.heard("expected", 0.01), "which are no lines for a tool", page.said)
    images = page.counts[4]
    page.send("got image")
    ok(page.until(lambda p: p.counts[4] > images, LONG), "until it says so again", page.counts)
    pose = page.state["probe"]["pose"]
    for i in range(20):
        pose[1] += 0.0004
        page.send("pose " + " ".join(map(repr, pose)))
        page.until(lambda p: False, 0.02)
    reached = lambda p: p.frame and abs(p.frame["pose"][1] - pose[1]) < 1e-9 and p.frame["force"][1] < 0
    ok(page.until(reached, LONG), "the probe presses, and the tissue presses back", page.frame)
    ok(page.frame["lag"] is not None and page.frame["lag"] > 0, "the lag is told", page.frame)
    ok(largest(page) > 1e-4, "the skin is dented", largest(page))
    page.send("method fem")
    ok(page.until(lambda p: p.state["tool"]["method"] == "fem", LONG), "the method changes")
    page.send("image gain 12")
    ok(page.until(lambda p: p.state["image"]["settings"]["gain"]["value"] == "12", LONG), "and the gain")
    page.send("set probe sphere:1cm")
    ok(page.until(lambda p: p.state["probe"]["shape"] == "sphere:1cm", LONG), "and the probe")
    page.send("image gain loud")
    ok(page.heard("us-slice: gain", LONG), "us-slice says what it does not take", page.said)
    page.send("save image")
    ok(page.until(lambda p: p.saved, LONG), "an image is saved")
    status, _, body = request(console.port, page.saved[0]["url"])
    ok(status == 200 and body[:8] == b"\x89PNG\r\n\x1a\n", "as PNG")
    saved = body
    page.until(frames(page.counts["frame"] + 5), LONG)
    page.send("replay")
    ok(page.until(lambda p: p.state["replaying"], LONG), "what was recorded is shown again")
    ok(page.heard("us-slice ended with status 0", LONG), "to its end", page.said[-3:])
    page.send("method msds")
    ok(page.heard("a record is shown; expected reset", LONG), "nothing is changed in it", page.said[-3:])
    page.send("record off")
    ok(page.until(lambda p: p.state["recording"] is False and alive(p), LONG), "a run that is not recorded", page.state)
    page.until(frames(page.counts["frame"] + 2), LONG)
    ok(console.end(page=page) == 0, "it ends")
    names = sorted(os.listdir(records))
    ok([n for n in names if n.endswith(".record")] == ["case-1.msds.record", "case-1.slice.record"], "two records are there", names)
    for name in names:
        if name.endswith(".record"):
            with open(os.path.join(records, name)) as f:
                ok(f.read().endswith("\nend\n"), f"{name} is whole")
    replay = (
        f"'{bin_folder}/msds-run' -q --replay '{records}/case-1.msds.record' <'{case}/mesh.sinew' | tee '{work}/replayed.sinew' |"
        f" '{bin_folder}/us-slice' -q --replay '{records}/case-1.slice.record' --labels '{case}/labels.nrrd' -o '{work}/replayed/%05d.png' '{case}/volume.nrrd'"
    )
    os.mkdir(os.path.join(work, "replayed"))
    done = subprocess.run(["sh", "-c", replay], capture_output=True, text=True)
    ok(done.returncode == 0, "the records replay on a command line", done.stderr)
    same = 0
    for name in os.listdir(os.path.join(work, "replayed")):
        with open(os.path.join(work, "replayed", name), "rb") as f:
            same += f.read() == saved
    ok(same > 0, "and one of the images is that which was saved, to the byte")
    page.close()
    console = Console("--record", records, case)
    page = Page(console.port)
    page.until(lambda p: 1 in p.binary and frames(5)(p), LONG)
    os.kill(console.child("us-slice"), signal.SIGKILL)
    ok(page.heard("us-slice was killed by signal 9", LONG), "us-slice that dies is told of")
    ok(page.until(frames(page.counts["frame"] + 10), LONG), "and the tissue goes on")
    children = console.children()
    console.end(signal.SIGKILL)
    ok(gone(children), "no child is left after kill -9")
    with open(os.path.join(records, "case-2.msds.record")) as f:
        text = f.read()
    ok(text.endswith("\n") and text.count("\nframe ") > 5, "whose record is whole to its last line", text[-200:])
    page.close()


def try_cases():
    console = Console(cases)
    page = Page(console.port)
    page.until(lambda p: p.state, LONG)
    ok([c["name"] for c in page.state["cases"]] == ["arm", "head", "patient"] and page.state["case"] is None, "of several cases none is open", page.state)
    for each in page.state["cases"]:
        status, head, body = request(console.port, each["picture"])
        ok(status == 200 and "image/png" in head and body[:4] == b"\x89PNG", f"{each['name']}: has a picture")
    page.send("pose 0 0 0 0 0 0 1")
    ok(page.heard("no case is open; expected open CASE first", LONG), "before that there is nothing to move", page.said)
    for name, kind in (("head", "face"), ("arm", "ultrasound"), ("patient", "ultrasound")):
        before = console.children()
        page.binary.clear()
        page.send(f"open {name}")
        ok(page.until(lambda p: p.state["case"] == name and alive(p) and 2 in p.binary and 3 in p.binary, LONG), f"{name}: is opened", page.state)
        ok(page.state["kind"] == kind and gone(before), f"{name}: {kind}, and the tools of before have ended", page.state["kind"])
    page.send("reset")
    ok(page.until(lambda p: p.state["case"] == "patient" and alive(p) and 1 in p.binary, LONG), "the last one anew")
    console.end(page=page)
    page.close()


def try_jaw():
    """A surface of body.txt goes with the rigid body that it is in, as frames have it."""
    console = Console(jaw)
    page = Page(console.port)
    ok(page.until(lambda p: p.state and 2 in p.binary and 3 in p.binary, LONG), "jaw: a face with a body around it opens", page.counts)
    header, meshes = decode_geometry(page.binary[2])
    teeth = next((m for m in header["meshes"] if m["name"] == "teeth"), None)
    if not ok(teeth and teeth["moves"] and teeth["vertices"] == 4, "jaw: its teeth are drawn, and move", header):
        return
    rest = [0.005, 0.005, 0.02, 0.015, 0.005, 0.02, 0.015, 0.015, 0.02, 0.005, 0.015, 0.02]
    off = lambda p, to: max(abs(a - b) for a, b in zip(decode_positions(p.binary[3])[1][teeth["id"]][0], to))
    ok(max(abs(a - b) for a, b in zip(meshes[teeth["id"]][0], rest)) < 1e-7 and off(page, rest) < 1e-6, "jaw: where body.txt has them, at rest", rest)
    page.send("now move jaw 0,0,4mm 0,0,0,1")
    up = [x + 0.004 * (i % 3 == 2) for i, x in enumerate(rest)]
    ok(page.until(lambda p: off(p, up) < 1e-6, LONG), "jaw: they go where the jaw goes", decode_positions(page.binary[3]))
    # By a right angle about z, through the corner at 5 mm, 5 mm: x, y -> -y, x.
    page.send("now move jaw 0,0,4mm 0,0,0.70710678118654757,0.70710678118654757 about 5mm,5mm,20mm")
    turned = [[0.005 - (up[i + 1] - 0.005), 0.005 + (up[i] - 0.005), up[i + 2]] for i in range(0, 12, 3)]
    turned = [x for place in turned for x in place]
    ok(page.until(lambda p: off(p, turned) < 1e-6, LONG), "jaw: and turn with it", (decode_positions(page.binary[3]), turned))
    page.send("now move jam 0,0,0 0,0,0,1")
    ok(page.heard("unknown body 'jam'", LONG), "jaw: a body that is not there is told of", page.said)
    page.send("save model")
    ok(page.until(lambda p: p.saved, LONG), "jaw: it is saved")
    with open(os.path.join(work, "jaw.sinew"), "wb") as f:
        f.write(request(console.port, page.saved[0]["url"])[2])
    info = subprocess.run([os.path.join(bin_folder, "sinew-info"), os.path.join(work, "jaw.sinew"), "--get", "body.pose.jaw"], capture_output=True, text=True)
    pose = [float(x) for x in info.stdout.split()]
    # A place x goes to turn(x) + move: move = c + t - turn(c), with c = (5, 5, 20) mm.
    want = [0.01, 0, 0.004, 0, 0, 0.5**0.5, 0.5**0.5]
    ok(len(pose) == 7 and max(abs(a - b) for a, b in zip(pose, want)) < 1e-6, "jaw: and the model has the jaw there", info.stdout + info.stderr)
    page.send("reset")
    ok(page.until(lambda p: alive(p) and off(p, rest) < 1e-6, LONG), "jaw: reset has them at rest", decode_positions(page.binary[3]))
    ok(console.end(page=page) == 0, "jaw: it ends")
    page.close()


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    console = Console(face)
    if not ok(console.port > 0, "the console prints its address", console.said()):
        return
    try_refusals(console)
    try_messages(console)
    try_face(console)
    try_stalled(console)
    taken = subprocess.run([os.path.join(bin_folder, "sinew-console"), "--page", page_folder, "--listen", str(console.port), face],
                           capture_output=True, text=True, stdin=subprocess.DEVNULL)
    ok(taken.returncode == 1 and "cannot listen there: Address already in use" in taken.stderr, "a port that is taken", taken.stderr)
    children = console.children()
    ok(console.end() == 0 and gone(children), "^C ends all")
    try_ends(face)
    try_token()
    try_ultrasound()
    try_cases()
    try_jaw()


main()
