#!/usr/bin/python3
"""bench_console.py [PART...]: speeds of sinew console with its page in headless Chromium, as CSV. The page draws by the processor, on the processors
that the tools use too. All times are the page's own; nothing is asked of it while it is measured. The parts, all unless some are named:

    lag         from a pose that the page sends until its image is on the screen: 60 poses a second, springs and finite elements, 32x16x16 nodes
    vertices    how often a skin of 26,082 vertices that moves is drawn
    pst         PST's Table II: four meshes, springs and finite elements, without and with surfaces of 243,224 triangles that move with the mesh
    wm [NAME=MODEL...]    W&M's Table 1 with display: models that move; without names our own sphere, muscle, block and head

Images have 512 pixels a row, of 256^3 voxels of noise. Drawn is what shows new positions. SECONDS=10 is how long each is measured; WORDS=?draw=webgl
is put behind the page's address."""
import os
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.path.abspath(os.environ.get("SINEW_BIN", "bin"))
os.environ["PATH"] = BIN + ":" + os.environ["PATH"]

from console_live import LONG, Console, open_case  # noqa: E402, needs the path
from console_page import Page  # noqa: E402

SECONDS = float(os.environ.get("SECONDS", 10))
WORDS = os.environ.get("WORDS", "")
MESHES = ("20x10x10", "24x12x12", "28x14x14", "32x16x16")
PRESS = """
    let i = 0;
    window.timer = setInterval(() => {
        sinew.probe.at.x = 0.08 + 1e-6 * i; // no two poses have the same place
        sinew.probe.change("depth", 3 + 3 * Math.sin(i++ / 20));
    }, 1000 / 60);
"""
# Muscles as in W&M's Table 1, half a second on and half a second off; else gravity, down and up.
LEVELS = {"muscle": .25, "block": .6, "face": .4, "head": .4}
MOVE = """
    const [level, muscles] = [arguments[0], sinew.state.muscles.map((m) => m.name)];
    let on = false;
    const act = () => {
        on = !on;
        if (!muscles.length) sinew.send(`now gravity 0,${on ? -9.81 : 9.81},0`);
        for (const name of muscles) sinew.send(`now contract ${name} ${on ? level : 0}`);
    };
    act();
    window.timer = setInterval(act, 500);
"""


def run(command, **more):
    subprocess.run(command, check=True, shell=isinstance(command, str), **more)


def write_volume(path):
    with open(path, "wb") as to:
        to.write(b"NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 256 256 256\nspace directions: (0.625,0,0) "
                 b"(0,0.3125,0) (0,0,0.3125)\nencoding: raw\nspace origin: (0.3125,0.15625,0.15625)\n\n" + os.urandom(256 ** 3))


def write_sheets(path, sheets):
    """OBJ in metres: (name, z, columns, rows) each, so many vertices, wavy."""
    lines, before = [], 1
    for name, z, columns, rows in sheets:
        lines.append(f"g {name}")
        for j in range(rows):
            for i in range(columns):
                lines.append(f"v {.01 + .14 * i / (columns - 1):.6f} {.005 + .07 * j / (rows - 1):.6f} {z + .004 * ((i // 8 + j // 8) % 2):.6f}")
        for j in range(rows - 1):
            for i in range(columns - 1):
                a = before + j * columns + i
                lines.append(f"f {a} {a + 1} {a + columns + 1} {a + columns}")
        before += columns * rows
    with open(path, "w") as to:
        to.write("\n".join(lines) + "\n")


def make_case(folder, name, nodes, sheets=()):
    """A case of a block of 16 x 8 x 8 cm, with surfaces bound to it."""
    case = os.path.join(folder, name)
    volume = os.path.join(folder, "volume.nrrd")
    if not os.path.exists(volume):
        write_volume(volume)
    os.mkdir(case)
    os.symlink(volume, os.path.join(case, "volume.nrrd"))
    mesh, sheet = os.path.join(case, "mesh.sinew"), os.path.join(folder, f"{name}.obj")
    if sheets:
        write_sheets(sheet, sheets)
    bind = f"| sinew bind -q --unit m '{sheet}'" if sheets else ""
    run(f"msds-mesh -q --nodes {nodes} --size 16cm,8cm,8cm --fix zmax {bind} >'{mesh}'")
    return case


def key(place):
    return tuple(round(x, 8) for x in place[:3])


def lags(sent, came, field):
    """ms from each pose to the first that shows it, sorted."""
    when, took = {key(each["pose"]): each["at"] for each in sent}, {}
    for each in came:
        place = key(each[field]) if each[field] and each["at"] is not None else None
        if place in when and place not in took:
            took[place] = each["at"] - when[place]
    return sorted(took.values())


class Measured:
    """What the page did in SECONDS of a script that goes on."""

    def __init__(self, page, script, *arguments):
        page.driver.execute_script("sinew.poses.length = sinew.frames.length = sinew.images.length = 0;"
                                   "window.drawn = sinew.view.frames; window.moved = sinew.positions;"
                                   "window.shown = sinew.imageView.version;" + script, *arguments)
        began = time.time()
        time.sleep(SECONDS)
        drawn, images, self.ratio, frames = page.get("[Math.min(sinew.view.frames - window.drawn, sinew.positions - window.moved), "
                                                     "sinew.imageView.version - window.shown, sinew.frame.ratio, sinew.frames.length]")
        took = time.time() - began
        self.drawn, self.images, self.frames = drawn / took, images / took, frames / took
        page.driver.execute_script("clearInterval(window.timer)")


def open_tissue(page, name, method):
    open_case(page, name)
    page.driver.execute_script(f"sinew.send('method {method}')")
    page.until(f"sinew.image !== null && sinew.probe.known && sinew.state.tool.method === '{method}'", LONG)
    page.driver.execute_script("sinew.probe.change('depth', 1)")
    page.until("sinew.probe.arrived", LONG)


def measure_lag(page, folder):
    print("what,method,poses,shown,least_ms,median_ms,p95_ms,drawn_a_second")
    for method in "msds", "fem":
        open_tissue(page, "32x16x16", method)
        is_ = Measured(page, PRESS)
        time.sleep(1)
        poses, frames, images = page.get("[sinew.poses, sinew.frames, sinew.images]")
        for what, came, field in (("pose to frame", frames, "pose"), ("pose to image", images, "face")):
            took = lags(poses, came, field)
            if not took:
                sys.exit(f"bench_console.py: no pose was seen in {what}")
            print(f"{what},{method},{len(poses)},{len(took)},{took[0]:.1f},{took[len(took) // 2]:.1f},{took[len(took) * 95 // 100]:.1f},{is_.drawn:.1f}",
                  flush=True)


def measure_vertices(page, folder):
    print("what,vertices,frames_a_second,images_a_second,drawn_a_second")
    open_tissue(page, "skin", "msds")
    vertices = page.get("sinew.view.named('skin').count")
    is_ = Measured(page, PRESS)
    print(f"a skin that moves,{vertices},{is_.frames:.1f},{is_.images:.1f},{is_.drawn:.1f}", flush=True)


def measure_pst(page, folder):
    print("mesh,surfaces,method,triangles,frames_a_second,images_a_second,drawn_a_second")
    for nodes in MESHES:
        for surfaces, name in (("without", nodes), ("with", f"{nodes}-surfaces")):
            for method in "msds", "fem":
                open_tissue(page, name, method)
                triangles = page.get("[...sinew.view.items.values()].filter((i) => i.kind === 'label').reduce((n, i) => n + i.triangles.length / 3, 0)")
                is_ = Measured(page, PRESS)
                print(f"{nodes},{surfaces},{method},{triangles if surfaces == 'with' else 0},{is_.frames:.1f},{is_.images:.1f},{is_.drawn:.1f}", flush=True)


def measure_wm(page, models):
    print("model,vertices,real_time,frames_a_second,drawn_a_second")
    for name in models:
        open_case(page, name)
        page.until("sinew.frame.ratio !== null", LONG)
        is_ = Measured(page, MOVE, LEVELS.get(name, 0))
        vertices = page.get("sinew.view.touchable().count")
        print(f"{name},{vertices},{is_.ratio:.3g},{is_.frames:.1f},{is_.drawn:.1f}", flush=True)


def make_models(folder):
    """Our own, as samples/Makefile makes them."""
    names = ("sphere", "muscle", "block", "head")
    environment = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    run(["make", "-s", "-C", os.path.join(ROOT, "samples"), f"OUT={folder}/made", f"SINEW_BIN={BIN}", *(f"{folder}/made/{name}.model" for name in names)],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    return {name: f"{folder}/made/{name}.model" for name in names}


def cases_of(part, folder, models):
    """The operands of the console: what the part opens."""
    isosurfaces = (("vein", .02, 350, 349), ("artery", .04, 17, 11))  # 243,224 triangles
    if part == "wm":
        links = os.path.join(folder, "wm")
        os.mkdir(links)
        for name, path in models.items():
            os.symlink(os.path.abspath(path), os.path.join(links, f"{name}.model"))
        return [os.path.join(links, f"{name}.model") for name in models]
    if part == "lag":
        return [make_case(folder, "32x16x16", "32x16x16"), make_case(folder, "other", "5x5x5")]
    if part == "vertices":
        return [make_case(folder, "skin", "20x10x10", (("skin", .001, 162, 161),)), make_case(folder, "other", "5x5x5")]
    return [make_case(folder, name + ending, name, sheets) for name in MESHES for ending, sheets in (("", ()), ("-surfaces", isosurfaces))]


def measure(part, models):
    with tempfile.TemporaryDirectory() as folder:
        models = models or (make_models(folder) if part == "wm" else {})
        console = Console(*cases_of(part, folder, models))
        page = Page(console)
        try:
            page.open(WORDS)
            {"lag": measure_lag, "vertices": measure_vertices, "pst": measure_pst, "wm": measure_wm}[part](page, list(models))
        finally:
            page.driver.quit()
            console.end()


def main():
    parts = [word for word in sys.argv[1:] if "=" not in word] or ["lag", "vertices", "pst", "wm"]
    models = dict(word.split("=", 1) for word in sys.argv[1:] if "=" in word)
    for part in parts:
        if part not in ("lag", "vertices", "pst", "wm"):
            sys.exit(f"bench_console.py: no part '{part}'; expected lag, vertices, pst or wm")
        measure(part, models)


if __name__ == "__main__":
    main()
