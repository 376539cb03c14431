#!/usr/bin/python3
"""console_pictures.py CASES FOLDER: pictures of sinew console's page, half as large as the screen, into FOLDER: console_arm.png, console_patient.png and
console_head.png, of the cases that samples/console leaves in CASES."""
import base64
import os
import sys

sys.dont_write_bytecode = True
os.environ["PATH"] = os.path.abspath(os.environ.get("SINEW_BIN", "bin")) + ":" + os.environ["PATH"]

from console_live import LONG, Console, open_case  # noqa: E402, needs the path
from console_page import Page  # noqa: E402

WIDTH, HEIGHT, SCALE = 1280, 800, .5


def shoot(page, path):
    """When the view is fine: nothing moves, so the picture stays as it is."""
    page.click("#pause")
    page.until("sinew.state.paused", LONG)
    page.driver.execute_script("document.getElementById('alert').hidden = true;"
                               "document.getElementById('pace').hidden = true; sinew.view.setFineness(1); sinew.view.request()")
    page.driver.execute_async_script("const done = arguments[0]; sinew.view.drawn.push(() => done()); sinew.view.draw(1);")
    clip = {"x": 0, "y": 0, "width": WIDTH, "height": HEIGHT, "scale": SCALE}
    png = page.driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "clip": clip})["data"]
    with open(path, "wb") as to:
        to.write(base64.b64decode(png))


def tissue(page, name, folder):
    open_case(page, name)
    page.until("sinew.probe.known && sinew.image !== null", LONG)
    for depth in range(1, 9):  # small steps, as a hand makes them
        page.driver.execute_script(f"sinew.probe.change('depth', {depth})")
        page.until("sinew.probe.arrived", LONG)
    index = page.get("sinew.frame.index")
    page.until(f"sinew.frame.index > {index + 60}", LONG)
    shoot(page, os.path.join(folder, f"console_{name}.png"))


def head(page, folder):
    open_case(page, "head")
    page.driver.execute_script("sinew.state.muscles.forEach((m) => sinew.send(`now contract ${m.name} 0.4`));"
                               "sinew.face.colourBy('displacement')")
    page.until("sinew.frame.time > 0.5", LONG)
    page.click("#look-front")
    page.click("#hold-pulls")
    page.pointer(page.get("sinew.view.project(sinew.view.middle())"), [(9, -3)] * 5)
    page.until(f"sinew.state.pulls.length === 1 && sinew.frame.time > {page.get('sinew.frame.time')} + 0.2", LONG)
    shoot(page, os.path.join(folder, "console_head.png"))


def main():
    cases, folder = sys.argv[1:]
    console = Console(cases)
    page = Page(console)
    try:
        page.size(WIDTH, HEIGHT)
        page.open()
        tissue(page, "arm", folder)
        tissue(page, "patient", folder)
        head(page, folder)
    finally:
        page.driver.quit()
        console.end()


if __name__ == "__main__":
    main()
