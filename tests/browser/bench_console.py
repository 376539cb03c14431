#!/usr/bin/python3
"""bench_console.py: how long it takes from a pose that the console's page sends until that page has the pixels of its image, and how often the
view is drawn, in headless Chromium: 60 poses a second for 10 s, 512 pixels a row, 256^3 voxels of noise, springs and finite elements at
32 x 16 x 16 nodes. Prints CSV. Chromium draws by the processor here, on the processors that the tools use too."""
import os
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
BIN = os.path.abspath(os.environ.get("SINEW_BIN", "bin"))
os.environ["PATH"] = BIN + ":" + os.environ["PATH"]

from console_live import Console, open_case  # noqa: E402, needs the path
from console_page import Page  # noqa: E402

SECONDS = 10
PRESS = """
    window.drawn = sinew.view.frames;
    let i = 0;
    window.timer = setInterval(() => {
        sinew.probe.at.x = 0.08 + 1e-6 * i; // no two poses have the same place
        sinew.probe.change("depth", 3 + 3 * Math.sin(i++ / 20));
    }, 1000 / 60);
"""


def make_case(folder, nodes):
    case = os.path.join(folder, "case")
    os.mkdir(case)
    with open(os.path.join(case, "volume.nrrd"), "wb") as to:
        to.write(b"NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 256 256 256\nspace directions: (0.625,0,0) "
                 b"(0,0.3125,0) (0,0,0.3125)\nencoding: raw\nspace origin: (0.3125,0.15625,0.15625)\n\n" + os.urandom(256 ** 3))
    subprocess.run(["msds-mesh", "-q", "--nodes", nodes, "--size", "16cm,8cm,8cm", "--fix", "zmax", "-o", os.path.join(case, "mesh.sinew")], check=True)
    return case


def key(place):
    return tuple(round(x, 8) for x in place[:3])


def lags(sent, came, field):
    """ms from each pose to the first that shows it, sorted."""
    when, took = {key(each["pose"]): each["at"] for each in sent}, {}
    for each in came:
        place = key(each[field]) if each[field] else None
        if place in when and place not in took:
            took[place] = each["at"] - when[place]
    return sorted(took.values())


def row(name, method, poses, took, drawn):
    if not took:
        sys.exit(f"bench_console.py: no pose was seen in {name}")
    print(f"{name},{method},{poses},{len(took)},{took[0]:.1f},{took[len(took) // 2]:.1f},{took[len(took) * 95 // 100]:.1f},{drawn / SECONDS:.1f}", flush=True)


def measure(page, method):
    open_case(page, "case")
    page.driver.execute_script(f"sinew.send('method {method}')")
    page.until("sinew.image !== null && sinew.probe.known", 60)
    time.sleep(2)
    page.driver.execute_script("sinew.poses.length = sinew.frames.length = sinew.images.length = 0;" + PRESS)
    time.sleep(SECONDS)
    page.driver.execute_script("clearInterval(window.timer)")
    time.sleep(1)
    poses, frames, images, drawn = page.get("[sinew.poses, sinew.frames, sinew.images, sinew.view.frames - window.drawn]")
    row("pose to frame", method, len(poses), lags(poses, frames, "pose"), drawn)
    row("pose to image", method, len(poses), lags(poses, images, "face"), drawn)


def main():
    with tempfile.TemporaryDirectory() as folder:
        console = Console(make_case(folder, "32x16x16"))
        page = Page(console)
        try:
            page.open()
            print("what,method,poses,shown,least_ms,median_ms,p95_ms,drawn_a_second")
            for method in "msds", "fem":
                measure(page, method)
        finally:
            page.driver.quit()
            console.end()


if __name__ == "__main__":
    main()
