"""console_replay.py BIN FOLDER PAGE FACE CASE...: each case in sinew console, with tools whose output is kept; what is recorded is replayed on a command
line, and must give the same frames. FACE: a model with a muscle; CASE: folders of ultrasound. Prints "ok NAME" or "not ok NAME: ..." a line."""

import os
import signal
import subprocess
import sys

from console_client import Page

bin_folder, work, page_folder, face, *cases = sys.argv[1:]
LONG = 60
KEPT = os.path.join(work, "kept")


def ok(passed, name, remark=""):
    print(("ok " if passed else "not ok ") + name + ("" if passed else f": {remark}"), flush=True)
    return passed


def make_tools(folder):
    """A console that finds tools beside it whose output is kept in KEPT/TOOL too."""
    os.makedirs(KEPT, exist_ok=True)
    for tool in ("msds-run", "tled-run", "us-slice"):
        path = os.path.join(folder, tool)
        with open(path, "w") as f:
            f.write(f"#!/bin/bash\nexec '{bin_folder}/{tool}' \"$@\" > >(exec tee '{KEPT}/{tool}')\n")
        os.chmod(path, 0o755)
    console = os.path.join(folder, "sinew-console")
    with open(os.path.join(bin_folder, "sinew-console"), "rb") as f, open(console, "wb") as to:
        to.write(f.read())
    os.chmod(console, 0o755)
    return console


def start(console, case, records):
    process = subprocess.Popen([console, "-q", "--page", page_folder, "--record", records, case], stdout=subprocess.PIPE, text=True)
    page = Page(int(process.stdout.readline().split(":")[2].split("/")[0]))
    page.until(lambda p: p.state and p.counts.get("frame", 0) > 2, LONG)
    return process, page


def reached(page, index):
    return page.until(lambda p: p.frame["index"] >= index, LONG)


def act_on_face(page):
    name = page.state["muscles"][0]["name"]
    page.send(f"now contract {name} 0.4")
    page.send("now gravity 0,0,-9.81")
    page.send("pull a 0,0,0 1 1mm,0,0 20")
    reached(page, page.frame["index"] + 15)
    page.send("release a")
    reached(page, page.frame["index"] + 5)
    for colour in ("speed", "quality", "displacement", "own"):
        page.send(f"colour {colour}")
        ok(page.until(lambda p: p.state["colour"] == colour, LONG), f"face: coloured by {colour}", page.state["colour"])
    ok(page.state["tool"]["settings"]["gravity"]["value"] == "0,0,-9.81", "face: the state keeps gravity", page.state["tool"])
    page.send("colour blue")
    ok(page.heard("colour 'blue'; expected one of own, displacement, speed, quality, stress", LONG), "face: another colour is refused", page.said)


def act_on_tissue(page, up):
    pose = page.state["probe"]["pose"]
    for i in range(12):
        pose[1] -= 0.0005 * up
        page.send("pose " + " ".join(map(repr, pose)))
        reached(page, page.frame["index"] + 1)
    ok(page.until(lambda p: all(abs(a - b) < 1e-9 for a, b in zip(p.frame["pose"], pose)), LONG), "the pose of a frame is that which was sent",
       (page.frame["pose"], pose))
    for line in ("method fem", "set iterations 30", "image gain 6", "method msds", "set probe sphere:1cm"):
        page.send(line)
        reached(page, page.frame["index"] + 3)
    ok(page.until(lambda p: p.frame["force"][1] * up > 0, LONG), "the tissue presses back", page.frame)


def same_frames(name, tool, command):
    done = subprocess.run(["sh", "-c", command + f" >'{work}/again'"], capture_output=True, text=True)
    ok(done.returncode == 0, f"{name}: its record replays", done.stderr)
    diff = subprocess.run([os.path.join(bin_folder, "sinew-diff"), f"{KEPT}/{tool}", f"{work}/again"], capture_output=True, text=True)
    frames = subprocess.run([os.path.join(bin_folder, "sinew-info"), "--get", "frames", f"{work}/again"], capture_output=True, text=True)
    ok(diff.returncode == 0 and int(frames.stdout or 0) > 20, f"{name}: to the same frames", (diff.stdout[-300:], diff.stderr, frames.stdout))


def record_of(records, name, ending):
    return os.path.join(records, f"{name}.{ending}.record")


def try_face(console, records):
    process, page = start(console, face, records)
    act_on_face(page)
    process.send_signal(signal.SIGINT)
    process.wait(LONG)
    record = record_of(records, "muscle-1", "tled")
    same_frames("face", "tled-run", f"'{bin_folder}/tled-run' -q --precision single --results activation --replay '{record}' <'{face}'")


def try_killed(console, records):
    """kill -9 of the tool, then of the console."""
    for n, which in ((2, "the tool"), (3, "the console")):
        process, page = start(console, face, records)
        reached(page, 30)
        with open(f"/proc/{process.pid}/task/{process.pid}/children") as f:
            children = f.read().split()
        os.kill(int(children[0]) if n == 2 else process.pid, signal.SIGKILL)
        if n == 2:
            ok(page.until(lambda p: not all(c["alive"] for c in p.state["children"]), LONG), "face: a tool that is killed is told of")
            process.kill()
        process.wait(LONG)
        record = record_of(records, f"muscle-{n}", "tled")
        with open(record) as f:
            text = f.read()
        ok(text.endswith("\n") and text.count("\nframe ") >= 30, f"face: kill -9 of {which} leaves whole lines", text[-100:])
        done = subprocess.run(f"'{bin_folder}/tled-run' -q --precision single --replay '{record}' <'{face}' | '{bin_folder}/sinew-info' --get frames",
                              shell=True, capture_output=True, text=True)
        ok(int(done.stdout or 0) >= 30, f"face: and after kill -9 of {which} the record replays", done.stderr)


def try_tissue(console, records, case):
    name = os.path.basename(case)
    process, page = start(console, case, records)
    act_on_tissue(page, -1)
    process.send_signal(signal.SIGINT)
    process.wait(LONG)
    body = ["body.txt", "skin.obj"] if os.path.exists(f"{case}/body.txt") else []
    skin = f"--body '{case}/body.txt' --skin '{case}/skin.obj'" if body else ""
    same_frames(name, "msds-run", f"'{bin_folder}/msds-run' -q {skin} --replay '{record_of(records, name + '-1', 'msds')}' <'{case}/mesh.sinew'")
    command = f"'{bin_folder}/us-slice' -q --replay '{record_of(records, name + '-1', 'slice')}' --labels '{case}/labels.nrrd' '{case}/volume.nrrd' <'{work}/again'"
    done = subprocess.run(["sh", "-c", command + f" | cmp - '{KEPT}/us-slice'"], capture_output=True, text=True)
    ok(done.returncode == 0, f"{name}: and the same images", done.stdout + done.stderr)


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    folder, records = os.path.join(work, "tools"), os.path.join(work, "records")
    os.makedirs(folder)
    console = make_tools(folder)
    try_face(console, records)
    try_killed(console, records)
    for case in cases:
        try_tissue(console, records, case)


main()
