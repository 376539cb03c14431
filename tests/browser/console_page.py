#!/usr/bin/python3
"""The console's page in a real headless Chromium, before a stand-in for the server: what is done with mouse and keys
comes as lines, and what the server sends is shown. TAP. With SHOTS=FOLDER it leaves pictures of all views there."""
import ctypes.util
import os
import struct
import sys
import time

CHROMIUM = ["--headless=new", "--no-sandbox", "--hide-scrollbars", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader"]


def skip_all(why):
    print(f"1..0 # SKIP {why}")
    sys.exit(0)


try:
    from selenium import webdriver
    from selenium.common.exceptions import WebDriverException
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select
except ImportError:
    skip_all("no selenium")
from stand_in import THREE, UPRIGHT, Server

WAIT = 20  # s: for what is sure to come


class Page:
    """A browser, before the server."""

    def __init__(self, server, *options):
        chosen = webdriver.ChromeOptions()
        for option in [*CHROMIUM, *options]:
            chosen.add_argument(option)
        chosen.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.server = server
        self.driver = webdriver.Chrome(options=chosen)
        self.size(1280, 800)

    def size(self, width, height):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def open(self, words=""):
        self.driver.get(f"http://127.0.0.1:{self.server.port}/{words}")
        return self.until("sinew.connected && sinew.state !== null")

    def get(self, expression):
        return self.driver.execute_script(f"return ({expression});")

    def until(self, expression, seconds=WAIT):
        """Whether it becomes true."""
        end = time.time() + seconds
        while time.time() < end:
            try:
                if self.get(expression):
                    return True
            except WebDriverException:  # the page is not there yet
                pass
            time.sleep(.03)
        return False

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def click(self, selector):
        self.find(selector).click()

    def key(self, *keys):
        ActionChains(self.driver, duration=20).send_keys(*keys).perform()

    def slide(self, selector, presses, key=Keys.ARROW_RIGHT):
        """Presses on a slider that has the focus."""
        self.driver.execute_script("arguments[0].focus()", self.find(selector))
        self.key(*[key] * presses)

    def type(self, selector, text):
        field = self.find(selector)
        field.clear()
        field.send_keys(text, Keys.ENTER)

    def pointer(self, place, moves, modifier=None):
        """Presses at a place of the page, moves by steps, lets go."""
        if modifier:
            ActionChains(self.driver).key_down(modifier).perform()
        chain = ActionChains(self.driver, duration=30)
        chain.w3c_actions.pointer_action.move_to_location(*[round(x) for x in place])
        chain.w3c_actions.pointer_action.pointer_down()
        for x, y in moves:
            chain.w3c_actions.pointer_action.move_by(x, y)
        chain.w3c_actions.pointer_action.pointer_up()
        chain.perform()
        if modifier:
            ActionChains(self.driver).key_up(modifier).perform()

    def hold(self, place, wait):
        """Presses at a place, and lets go when wait() has returned."""
        chain = ActionChains(self.driver, duration=30)
        chain.w3c_actions.pointer_action.move_to_location(*[round(x) for x in place])
        chain.w3c_actions.pointer_action.pointer_down()
        chain.perform()
        wait()
        chain = ActionChains(self.driver)
        chain.w3c_actions.pointer_action.pointer_up()
        chain.perform()

    def wheel(self, place, by):
        x, y = [round(x) for x in place]
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", "x": x, "y": y})
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": by})

    def on_probe(self):
        """Where the probe's body is on the page: 15 mm above its face."""
        return self.get("sinew.view.project(sinew.view.probe.localToWorld(sinew.probe.at.clone().set(0, 0, -0.015)))")

    def errors(self):
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]


class Tap:
    def __init__(self):
        self.count, self.failed = 0, 0

    def check(self, name, is_so, *more):
        self.count += 1
        self.failed += not is_so
        print(f"{'ok' if is_so else 'not ok'} {self.count} - {name}", flush=True)
        for each in more if not is_so else []:
            print(f"# {each!r}", flush=True)

    def is_(self, name, got, wanted):
        self.check(name, got == wanted, got, wanted)

    def near(self, name, got, wanted, most):
        self.check(name, got is not None and abs(got - wanted) <= most, got, wanted)


def until(condition, seconds=WAIT):
    end = time.time() + seconds
    while time.time() < end:
        if condition():
            return True
        time.sleep(.02)
    return False


def still(page):
    """Whether five images in a row have the same pixels."""
    version, index = page.get("[sinew.imageView.version, sinew.image.index]")
    return page.until(f"sinew.image.index > {index + 5}") and page.get("sinew.imageView.version") == version


def numbers(line):
    return [float(word) for word in line.split()[1:]]


# ---- the parts


def cases(t, server, page):
    t.check("the page connects, and gets the state", page.open())
    t.is_("nothing is wrong", page.get("sinew.problem"), None)
    t.check("no case is open: the list of them is", page.get("document.getElementById('cases').open"))
    t.is_("a card each", page.get("[...document.querySelectorAll('.card')].map((c) => c.innerText.split('\\n').pop())"), ["arm", "face"])
    t.is_("the first has the focus", page.get("document.activeElement.innerText.split('\\n').pop()"), "arm")
    page.click(".card")
    t.check("a click opens it", until(lambda: server.count("open arm") == 1))
    t.check("its surfaces come", page.until("sinew.view.items.size === 4"))
    t.is_("and the list goes", page.get("document.getElementById('cases').open"), False)
    t.is_("the title is its name", page.get("document.title"), "arm – Sinew")
    t.is_("what is shown has its names", page.get("[...document.querySelectorAll('.shown label')].map((l) => l.textContent)"),
          ["skin", "vein", "artery", "bone", "probe", "image"])


def scanner(t, server, page):
    t.check("an image is shown", page.until("sinew.image !== null && sinew.imageView.layout"))
    columns, rows, wide, high, across, down = page.get(
        "((i, l) => [i.columns, i.rows, l.wide, l.high, l.across, l.down])(sinew.image, sinew.imageView.layout)")
    t.is_("of the size that was sent", [columns, rows], [160, 200])
    t.near("to scale", wide / high, .04 / .05, 1e-6)
    t.near("whose width is the array's", across, .04, 1e-9)
    t.near("and whose height is the depth", down, .05, 1e-9)
    t.check("its pixels are grey, not black", page.get("""((c) => {
        c.drawImage(sinew.imageView.pixels, 0, 0);
        return [...c.getImageData(0, 0, 160, 200).data].filter((x, i) => i % 4 < 3 && x > 40).length;
    })(Object.assign(document.createElement('canvas'), {width: 160, height: 200}).getContext('2d'))""") > 5000)
    t.near("it stands in space where its message says", page.get("sinew.view.image.material.uniforms.along.value.length()"), .04, 1e-9)
    page.slide("#slider-image-gain", 6)
    t.check("the gain is a line for us-slice", until(lambda: server.last("image gain") == "image gain 3"), server.last("image gain"))
    t.is_("as the number beside it says", page.get("document.querySelector('#slider-image-gain').nextSibling.value"), "3")
    page.slide("#tgc input:nth-child(3)", 4, Keys.ARROW_UP)
    t.check("so are the gains of the depth", until(lambda: server.last("image tgc") == "image tgc 0,0,4,0,0,0"), server.last("image tgc"))
    page.click("#tgc button")
    t.check("and flat ones", until(lambda: server.last("image tgc") == "image tgc 0,0,0,0,0,0"))
    page.slide("#slider-image-depth", 10)
    t.check("a greater depth", until(lambda: server.last("image depth") == "image depth 60mm"), server.last("image depth"))
    t.check("makes a taller image", page.until("Math.abs(sinew.imageView.layout.down - 0.06) < 1e-6"))
    page.slide("#slider-image-dynamic-range", 1, Keys.ARROW_LEFT)
    t.check("of the dynamic range the volume's own stays",
            until(lambda: server.last("image dynamic-range") == "image dynamic-range 59,60"), server.last("image dynamic-range"))
    page.click("#freeze")
    t.check("freeze", until(lambda: server.last("image freeze") == "image freeze on"))
    t.check("is seen", page.until("document.getElementById('freeze').getAttribute('aria-pressed') === 'true'"))
    page.key("f")
    t.check("and ends by a key", until(lambda: server.last("image freeze") == "image freeze off"))


def stand(server, page):
    """The probe upright over the arm, as at the beginning."""
    with server.lock:
        server.model.pose = list(UPRIGHT)
    return page.until("Math.abs(sinew.probe.held.depth + 5) < 0.01 && Math.abs(sinew.probe.at.x) < 1e-6")


def probe(t, server, page):
    t.check("the probe stands where the frames say, 5 mm above the skin", stand(server, page), page.get("sinew.probe.held"))
    before, image, version = server.count("pose"), page.get("sinew.image.origin"), page.get("sinew.imageView.version")
    page.pointer(page.on_probe(), [(12, 3)] * 5)
    t.check("dragged, it sends poses", until(lambda: server.count("pose") > before))
    pose = numbers(server.last("pose"))
    t.near("with a quaternion of length 1", sum(q * q for q in pose[3:]), 1, 1e-9)
    t.check("elsewhere over the skin", abs(pose[0]) > .002, pose)
    x, y, z, w = pose[3:]
    face = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
    # The arm is a cylinder of 60 mm along y, whose axis is 60 mm below the origin.
    away = (pose[0] ** 2 + (pose[2] + .06) ** 2) ** .5
    t.near("its face looks along the normal", face[0] * pose[0] / away + face[2] * (pose[2] + .06) / away, -1, 2e-3)
    t.near("and is as high above the skin as before", away - .06, .005, 2e-4)
    t.check("the image follows", page.until(f"Math.abs(sinew.image.origin[0] - {image[0]}) > 0.001"))
    t.check("with other pixels, until it is still", until(lambda: page.get("sinew.imageView.version") > version and still(page)), version)
    t.check("the page did not turn the view", page.get("sinew.view.orbit.enabled"))
    sent = server.count("pose")
    page.hold(page.on_probe(), lambda: until(lambda: server.count("pose") > sent + 1))
    t.check("a hand that holds it still says so", server.count("pose") > sent + 1)
    t.is_("the page says that a hand moves it", page.get("document.getElementById('from').textContent"), "hand")
    server.model.source = "3D mouse"
    page.driver.execute_script("sinew.send('method fem')")
    t.check("or what else does", page.until("document.getElementById('from').textContent === '3D mouse'"))
    at = page.on_probe()
    page.wheel(at, -100)
    t.check("the wheel over it pushes in by half a millimetre", page.until("Math.abs(sinew.probe.held.depth + 4.5) < 0.01"), page.get("sinew.probe.held"))
    distance = page.get("sinew.view.camera.position.distanceTo(sinew.view.orbit.target)")
    page.wheel(page.get("((r) => [r.left + 20, r.bottom - 90])(document.getElementById('view').getBoundingClientRect())"), -100)
    t.check("and beside it brings the view nearer", page.until(f"sinew.view.camera.position.distanceTo(sinew.view.orbit.target) < {distance}"))
    page.click("#look-reset")
    page.pointer(page.on_probe(), [(10, 0)] * 2, Keys.SHIFT)
    t.check("with shift it rocks", page.until("Math.abs(sinew.probe.held.rock - 6) < 0.1"), page.get("sinew.probe.held"))
    page.pointer(page.on_probe(), [(0, 10)] * 2, Keys.SHIFT)
    t.check("and tilts", page.until("Math.abs(sinew.probe.held.tilt - 6) < 0.1"), page.get("sinew.probe.held"))
    page.pointer(page.on_probe(), [(10, 0)] * 2, Keys.ALT)
    t.check("with alt it turns", page.until("Math.abs(Math.abs(sinew.probe.held.turn) - 10) < 3"), page.get("sinew.probe.held"))


def probe_by_keys(t, server, page):
    stand(server, page)
    page.driver.execute_script("document.getElementById('view').focus()")
    for key, name, value in (("s", "tilt", 2), ("d", "rock", 2), ("e", "turn", 3)):
        page.key(key)
        t.check(f"{key} changes its {name}", page.until(f"Math.abs(sinew.probe.held.{name} - {value}) < 0.01"), page.get("sinew.probe.held"))
    page.key(Keys.HOME)
    t.check("Home straightens it", page.until("sinew.probe.held.tilt === 0 && sinew.probe.held.rock === 0 && sinew.probe.held.turn === 0"))
    x = page.get("sinew.probe.at.x")
    page.key(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
    t.check("arrows move it over the skin, to the right as it is seen", page.until(f"sinew.probe.at.x > {x} + 0.001"), page.get("sinew.probe.at"))
    page.key(Keys.PAGE_DOWN, Keys.PAGE_DOWN)
    t.check("Page Down pushes it in", page.until("Math.abs(sinew.probe.held.depth + 4) < 0.01"), page.get("sinew.probe.held"))
    page.slide("#slider-Tilt", 5)
    t.check("a slider tilts it too", page.until("Math.abs(sinew.probe.held.tilt - 2.5) < 0.01"), page.get("sinew.probe.held"))
    page.type("#slider-Push-in + input", "6")
    t.check("a number pushes it in", page.until("Math.abs(sinew.probe.held.depth - 6) < 0.01"), page.get("sinew.probe.held"))
    page.type(".place input", "4.5")
    t.check("a number moves it", until(lambda: abs(numbers(server.last("pose"))[0] - .0045) < 1e-8), server.last("pose"))
    page.type(".place input", "0")


def forces(t, server, page):
    page.driver.execute_script("sinew.probe.straighten(); sinew.probe.change('depth', 6)")
    t.check("a probe that presses meets a force", page.until("sinew.frame.force[2] > 3"), page.get("sinew.frame"))
    shown = page.get("[document.getElementById('force').textContent, Math.hypot(...sinew.frame.force)]")
    t.near("that is told", float(shown[0].split()[0]), shown[1], .01)
    t.check("in newtons, and drawn", shown[0].endswith(" N") and page.get("document.getElementById('force-chart').width") > 100)
    t.check("the skin is tinted where it touches", page.until("[...sinew.view.items.values()][0].material.uniforms.probe_kind.value === 2"))
    vein = "[...sinew.view.items.values()][1]"
    t.check("the vein gives way", page.until(f"{vein}.largestMoved() > 2e-4"))
    Select(page.find("#shape")).select_by_value("sphere:2cm")
    t.check("another shape is a line", until(lambda: server.last("set probe") == "set probe sphere:2cm"))
    t.check("and is drawn", page.until("sinew.view.shape && sinew.view.shape.kind === 'sphere' && sinew.view.shape.radius === 0.02"))
    Select(page.find("#shape")).select_by_value("linear:4cm,1cm")
    page.until("sinew.view.shape.kind === 'linear'")


def method(t, server, page):
    Select(page.find("#method")).select_by_value("exact")
    t.check("a method is a line", until(lambda: server.last("method") == "method exact"))
    page.click("#open-parameters")
    t.check("parameters are a dialog", page.get("document.getElementById('parameters').open"))
    row = page.get("[...document.querySelectorAll('.parameter')].map((p) => p.innerText).join('|')")
    t.check("with units and defaults", "dt" in row and "default 0.01" in row and "time step of springs" in row.lower(), row)
    page.type("#set-dt", "0.02")
    t.check("a value is a line", until(lambda: server.last("set dt") == "set dt 0.02"))
    t.check("what differs from its default is seen", page.until("document.querySelector('#set-dt').classList.contains('changed')"))
    Select(page.find("#set-mass")).select_by_value("lumped")
    t.check("so is a choice", until(lambda: server.last("set mass") == "set mass lumped"))
    page.type("#set-dt", "-1")
    t.check("an error comes in the tool's words",
            page.until("document.getElementById('alert-text').textContent === 'msds-run set dt -1; expected a number above 0'"),
            page.get("document.getElementById('alert-text').textContent"))
    page.key(Keys.ESCAPE)
    t.check("Escape closes the dialog", page.until("!document.getElementById('parameters').open"))
    page.click("#dismiss")
    t.check("the error goes when it is told to", not page.find("#alert").is_displayed())
    page.click("#open-messages")
    t.check("and stays in the list", "expected a number above 0" in page.find("#message-list").text)
    page.key(Keys.ESCAPE)


def shown(t, server, page):
    page.key("0")
    opaque = page.find("#patient").screenshot_as_base64
    page.click("#show-skin")
    t.is_("the skin is hidden", page.get("sinew.view.named('skin').solid.visible"), False)
    t.check("which is seen", until(lambda: page.find("#patient").screenshot_as_base64 != opaque))
    page.click("#show-skin")
    page.slide(".shown input[type=range]", 3, Keys.ARROW_RIGHT)
    t.near("or more solid", page.get("sinew.view.named('skin').opacity"), .55, 1e-9)
    page.click("#show-vein")
    page.click("#look-front")
    away = page.get("((d) => [d.x, d.y, d.z])(sinew.view.camera.position.clone().sub(sinew.view.middle()).normalize())")
    t.near("the front is seen from -y", away[1], -1, 1e-3)
    page.key("+")
    page.driver.execute_script("document.activeElement.blur()")
    page.key("5")
    t.near("a key looks from above", page.get("sinew.view.camera.position.clone().sub(sinew.view.middle()).normalize().z"), 1, 1e-3)
    before = page.get("sinew.view.camera.position.x")
    page.click("#look-front")
    page.pointer(page.get("((r) => [r.left + 30, r.bottom - 120])(document.getElementById('view').getBoundingClientRect())"), [(20, 0)] * 5)
    t.check("dragging beside the probe turns the view", page.until(f"Math.abs(sinew.view.camera.position.x - {before}) > 0.01"))


def session(t, server, page):
    for button, line in (("#pause", "pause on"), ("#step", "step"), ("#pause", "pause off"), ("#record", "record on"), ("#record", "record off"),
                         ("#save-image", "save image"), ("#save-model", "save model"), ("#replay", "replay")):
        count = server.count(line)
        page.until(f"!document.querySelector('{button}').disabled")
        page.click(button)
        t.check(f"{line}", until(lambda line=line, count=count: server.count(line) == count + 1))
        page.until(f"document.getElementById('pause').textContent === '{'Go on' if line in ('pause on', 'step') else 'Pause'}'")
        if line.startswith("record"):
            page.until(f"document.getElementById('record').getAttribute('aria-pressed') === '{str(line == 'record on').lower()}'")
    t.check("what was saved can be fetched", page.until("document.querySelector('#message-list a') !== null"))
    server.tell_children([{"tool": "us-slice", "alive": False, "why": "killed by signal 9"}])
    t.check("a tool that died is told of", page.until("document.getElementById('children').innerText === 'us-slice has ended: killed by signal 9'"))
    server.tell_children([])
    t.check("until it runs again", page.until("document.getElementById('children').hidden"))


def reload(t, server, page):
    page.driver.execute_script("sinew.probe.straighten(); sinew.probe.change('tilt', 7); sinew.probe.change('turn', 20); sinew.probe.change('depth', 3)")
    pose = page.get("sinew.probe.pose()")
    page.until(f"Math.abs(sinew.frame.pose[3] - {pose[3]}) < 1e-9")
    page.open()
    t.check("after a reload the probe is as it was held",
            page.until("sinew.probe.known && Math.abs(sinew.probe.held.tilt - 7) < 0.01 && Math.abs(sinew.probe.held.turn - 20) < 0.01"
                       " && Math.abs(sinew.probe.held.depth - 3) < 0.05"), page.get("sinew.probe.held"))
    t.is_("the gain too", page.get("document.querySelector('#slider-image-gain').value"), "3")
    t.is_("the method too", page.get("document.getElementById('method').value"), "exact")
    t.check("and what is shown", page.until("sinew.view.items.size === 4 && !sinew.view.named('vein').visible"
                                            " && Math.abs(sinew.view.named('skin').opacity - 0.55) < 1e-9"))


def two(t, server, page):
    first = page.driver.current_window_handle
    page.driver.switch_to.new_window("window")
    page.size(1280, 800)
    page.open()
    page.until("sinew.probe.known")
    page.driver.execute_script("sinew.probe.straighten(); sinew.probe.change('depth', 8)")
    page.until("sinew.frame.pose && Math.abs(sinew.probe.held.depth - 8) < 0.01 && sinew.frame.force[2] > 6")
    page.driver.close()
    page.driver.switch_to.window(first)
    t.check("what a second page does is seen in the first", page.until("Math.abs(sinew.probe.held.depth - 8) < 0.05"), page.get("sinew.probe.held"))
    page.driver.execute_script("sinew.probe.straighten(); sinew.probe.change('depth', -5)")


def busy(t, server, page):
    """A page that is busy for two seconds shows the newest then: what came meanwhile is not shown one by one."""
    before = page.driver.execute_script("const before = sinew.frame.index; sinew.frames.length = 0;"
                                        "const end = performance.now() + 2000; while (performance.now() < end); return before;")
    index = server.index
    t.check("a page that was busy shows the newest frame", page.until(f"sinew.frame.index >= {index}"))
    shown_, last = page.get("[sinew.frames.length, sinew.frame.index]")
    t.check("and leaves out what came meanwhile", last - before - shown_ > 10, shown_, before, last)


def trouble(t, server, page):
    server.everyone(b"\x09\0\0\0")
    t.check("a message of an unknown kind is told", page.until("(sinew.problem || '').includes('kind 9')"))
    server.everyone('{"type": "frame", ')
    t.check("so is half a text", page.until("!(sinew.problem || '').includes('kind 9')"))
    server.everyone(struct.pack("<IIIId9d", 1, 0, 8, 8, 0, *[0] * 9) + b"no picture")
    t.check("so is an image that is none", page.until("(sinew.problem || '').includes('an image that this browser cannot read')"), page.get("sinew.problem"))
    frame = page.get("sinew.frame.index")
    t.check("and all goes on", page.until(f"sinew.frame.index > {frame} && sinew.image.index > {frame}"))
    page.driver.execute_script("document.getElementById('dismiss').click()")
    server.stop_listening()
    t.check("a server that went away is told of", page.until("!sinew.connected") and until(page.find("#connection").is_displayed))
    server.listen()
    t.check("and found again", page.until("sinew.connected") and page.until("!document.body.classList.contains('offline')"))


def face(t, server, page):
    page.click("#case")
    page.click(".card:nth-child(2)")
    t.check("a face opens", page.until("sinew.state.kind === 'face' && sinew.view.items.size === 2"))
    t.is_("its muscles are in groups", page.get("[...document.querySelectorAll('legend')].map((l) => l.textContent)"), ["left", "right", "middle"])
    t.is_("no image is shown", page.find("#scanner").is_displayed(), False)
    t.check("the skin hides the bone", page.get("sinew.view.named('face').opacity === 1"))
    page.slide("#slider-zyg_left", 30)
    t.check("a slider is a muscle's level", until(lambda: server.last("now contract zyg_left") == "now contract zyg_left 0.3"), server.last("now"))
    item = "sinew.view.named('face')"
    t.check("and the face moves", page.until(f"{item}.largestMoved() > 1e-3"))
    t.is_("the other side does not", server.count("now contract zyg_right"), 0)
    page.click("#both-sides")
    page.slide("#slider-zyg_left", 10)
    t.check("unless both are asked for", until(lambda: server.last("now contract zyg_right") == "now contract zyg_right 0.4"), server.last("now contract zyg_right"))
    t.check("whose slider goes along", page.until("document.querySelector('#slider-zyg_right').value === '40'"))
    page.click("#relax")
    t.check("all relax", until(lambda: server.last("now contract zyg_left") == "now contract zyg_left 0"))
    page.click("#gravity-down")
    t.check("gravity is a line", until(lambda: server.last("now gravity") == "now gravity 0,0,-9.81"), server.last("now gravity"))
    page.click("#gravity-none")


def pulls(t, server, page):
    page.click("#look-front")
    item = "sinew.view.named('face')"
    nose = page.get("sinew.view.project(" + item + ".placeNow(12 + 18 * 48 + 24))")
    before = page.get(f"((p) => [p.x, p.y, p.z])({item}.placeNow(12 + 18 * 48 + 24))")
    page.click("#hold-pulls")
    page.pointer(nose, [(15, 0)] * 4)
    t.check("a point that is dragged is pulled", until(lambda: server.count("pull pull1 ") > 1), server.last("pull"))
    words = server.last("pull pull1").split()
    point, target = ([float(x) for x in words[i].split(",")] for i in (2, 4))
    t.is_("with the radius and stiffness that were set", [float(words[3]), float(words[5])], [.006, 60])
    t.check("from the point that was touched", sum((a - b) ** 2 for a, b in zip(point, before)) ** .5 < .02, point, before)
    t.check("towards the hand, to the right", target[0] - point[0] > .005, target)
    t.check("the tissue follows", page.until("sinew.face.pointOf([...sinew.face.pulls.values()][0]).x > " + str(point[0] + .001)))
    force = page.get("[...sinew.face.pulls.values()].map((p) => [p.label.textContent, p.force])[0]")
    t.near("the force is told", float(force[0].split()[0]), force[1], .06)
    t.check("and its line is drawn", page.until("[...sinew.face.pulls.values()][0].rod.scale.y > 0.001"))
    page.open()
    t.check("after a reload it is still there", page.until("sinew.face.pulls.has('pull1')"))
    page.click(".pull button")
    t.check("until it is released", until(lambda: server.count("release pull1") == 1) and page.until("sinew.face.pulls.size === 0"))
    page.click("#look-front")
    page.pointer(page.get("sinew.view.project(" + item + ".placeNow(12 + 18 * 48 + 24))"), [(10, 0)] * 3)
    t.check("a pull that is not held ends with the hand", until(lambda: server.count("release") == 2) and page.until("sinew.face.pulls.size === 0"))
    page.click("#drag-turns")
    camera, count = page.get("sinew.view.camera.position.x"), server.count("pull")
    page.pointer(nose, [(15, 0)] * 4)
    t.check("dragging turns the view where that is asked for", page.until(f"Math.abs(sinew.view.camera.position.x - {camera}) > 0.01"))
    t.is_("and pulls at nothing", server.count("pull"), count)
    page.click("#drag-turns")


def colours(t, server, page):
    page.slide("#slider-zyg_left", 50)
    Select(page.find("#colouring")).select_by_value("displacement")
    t.check("colours tell of displacements", page.until("sinew.view.named('face').material.uniforms.colouring.value === 1"))
    t.check("by a legend, in mm", page.until("document.getElementById('legend-name').textContent === 'displacement, mm'"))
    t.check("whose end is beyond the largest", page.until(
        "Number(document.getElementById('legend-high').textContent) >= 1000 * sinew.view.named('face').largestMoved()"))
    t.is_("bone keeps its own", page.get("sinew.view.named('skull').material.uniforms.colouring.value"), 0)
    Select(page.find("#colouring")).select_by_value("quality")
    t.check("or of what frames carry", until(lambda: server.last("colour") == "colour quality") and
            page.until("sinew.view.named('face').material.uniforms.colouring.value === 2"))
    t.check("whose ends are the frames'", page.until("document.getElementById('legend-low').textContent === '0.20' && "
                                                     "document.getElementById('legend-high').textContent === '1.00'"),
            page.get("document.getElementById('legend').innerText"))
    for line, button in (("pause on", "#pause"), ("step", "#step"), ("reset", "#restart")):
        count = server.count(line)
        page.until(f"!document.querySelector('{button}').disabled")
        page.click(button)
        t.check(f"{line}, of a face", until(lambda line=line, count=count: server.count(line) == count + 1))
    page.click("#pause")
    t.check("real time and the device are told", page.until("document.getElementById('pace').textContent.includes('real time × 1.0')")
            and page.get("document.getElementById('device').textContent") == "cpu, 2 threads")


def looks(t, server, page):
    nameless = """[...document.querySelectorAll('button, input, select')].filter((e) =>
        !(e.title || e.closest('[title]')) || !(e.innerText || e.getAttribute('aria-label') || e.labels && e.labels.length)).map((e) => e.outerHTML)"""
    for name in ("arm", "face"):
        server.open(name)
        page.until(f"sinew.state.case === '{name}' && sinew.view.items.size > 1")
        t.is_(f"{name}: every control has a name and a tooltip", page.get(nameless), [])
        for width, height in ((1280, 800), (3840, 2160), (420, 900)):
            page.size(width, height)
            t.check(f"{name}, {width} x {height}: nothing is wider than the screen",
                    page.until("document.documentElement.scrollWidth <= innerWidth"), page.get("document.documentElement.scrollWidth"))
            small = page.get("""[...document.querySelectorAll('button, select')].filter((e) => e.offsetParent && e.offsetHeight < 34)
                .map((e) => e.outerHTML)""")
            t.is_(f"{name}, {width} x {height}: targets are large", small, [])
        page.size(1280, 800)
        t.check(f"{name}: at 1280 x 800 the page does not scroll", page.until("document.documentElement.scrollHeight <= innerHeight"))


def without_webgl(t, server):
    page = Page(server, "--disable-3d-apis")
    try:
        server.open("arm")
        page.open()
        t.check("without WebGL 2 a line says so", page.until("(sinew.problem || '').includes('no WebGL 2')"), page.get("sinew.problem"))
        t.check("where the patient would be", "WebGL 2" in page.find("#no-view").text)
        t.check("and the image is shown all the same", page.until("sinew.image !== null && sinew.imageView.layout"))
    finally:
        page.driver.quit()


def drawn(page):
    """Half as large a picture of the view, as bytes of its colours."""
    return page.get("""(() => {
        const to = document.createElement('canvas').getContext('2d');
        [to.canvas.width, to.canvas.height] = [264, 370];
        sinew.view.draw(1);
        to.drawImage(sinew.view.canvas, 0, 0, 264, 370);
        return [...to.getImageData(0, 0, 264, 370).data].filter((_, i) => i % 4 < 3);
    })()""")


def processor(t, server, page):
    """Both ways of drawing show the same: raster.js, and three.js with WebGL."""
    for kind in "arm", "face":
        server.open(kind)
        pictures = []
        for way in "processor", "webgl":
            page.open(f"?draw={way}")
            page.until("sinew.view.items.size > 1 && sinew.frame")
            if kind == "arm":
                page.until("sinew.image !== null && sinew.probe.known")
                page.driver.execute_script("sinew.probe.change('depth', 5)")
                page.until("sinew.probe.arrived")
            else:
                server.model.levels.update(zyg_left=.8, zyg_right=.8)
                page.driver.execute_script("sinew.face.colourBy('displacement'); document.getElementById('look-front').click()")
                page.until("[...sinew.view.items.values()].some((item) => item.largestMoved() > 1e-3)")
            server.paused = True
            page.until("!sinew.view.asked")
            time.sleep(.3)
            t.is_(f"{kind}: {way} draws", page.get("Boolean(sinew.view.raster)"), way == "processor")
            pictures.append(drawn(page))
            server.paused = False
        apart = sorted(abs(a - b) for a, b in zip(*pictures))
        t.check(f"{kind}: both draw something", len(set(pictures[0])) > 50 and len(set(pictures[1])) > 50)
        t.check(f"{kind}: and the same", sum(apart) / len(apart) < 2.5 and apart[len(apart) * 97 // 100] < 16,
                sum(apart) / len(apart), [apart[len(apart) * part // 100] for part in (50, 90, 95, 97, 99)])


def compressed(t, server, page):
    server.open("arm")
    page.open("?pixels=jpeg")
    t.check("images that are compressed are shown too", page.until("sinew.image !== null && sinew.imageView.version > 0 && sinew.imageView.raw === null"))
    page.open()
    t.check("by default they are not", page.until("sinew.image !== null && sinew.imageView.version > 0 && sinew.imageView.raw !== null"))


def shots(server, page, folder):
    """Pictures of all views, at three sizes."""
    os.makedirs(folder, exist_ok=True)
    sizes = ((1280, 800), (3840, 2160), (420, 900))

    def shoot(name, width, height):
        page.size(width, height)
        time.sleep(3 if width > 3000 else 1)
        page.driver.save_screenshot(f"{folder}/{name}_{width}.png")

    def dialogs(kind, names):
        for name in names:
            page.driver.execute_script(f"document.getElementById('{name}').showModal()")
            for size in sizes:
                shoot(f"{kind}_{name}", *size)
            page.driver.execute_script(f"document.getElementById('{name}').close()")

    for kind in ("arm", "face"):
        server.open(kind)
        page.open()
        page.until("sinew.view.items.size > 1 && sinew.frame")
        if kind == "arm":
            page.driver.execute_script("sinew.probe.change('tilt', 8); sinew.probe.change('depth', 5)")
        else:
            server.model.levels.update(zyg_left=.8, zyg_right=.8)
            server.take("pull a -.03,-.065,.03 .006 -.05,-.09,.04 60")
            page.driver.execute_script("sinew.face.colourBy('displacement'); document.getElementById('look-front').click()")
        for size in sizes:
            shoot(kind, *size)
        page.driver.execute_script("document.querySelector('aside').scrollIntoView()")
        shoot(f"{kind}_below", 420, 900)
        dialogs(kind, ["cases", "parameters", "messages", "keys"] if kind == "arm" else ["keys"])
    page.size(1280, 800)
    server.say("error", "msds-run", "set dt -1: expected a number above 0")
    server.tell_children([{"tool": "us-slice", "alive": False, "why": "killed by signal 9"}])
    shoot("trouble", 1280, 800)


def main():
    if not ctypes.util.find_library("turbojpeg"):
        skip_all("no libturbojpeg")
    if not os.path.exists(os.path.join(THREE, "examples/jsm/controls/OrbitControls.js")):
        skip_all("no three.js")
    server = Server()
    try:
        page = Page(server)
    except WebDriverException as error:
        skip_all(f"no chromium that selenium can drive: {(error.msg or '').splitlines()[0]}")
    t = Tap()
    try:
        if os.environ.get("SHOTS"):
            shots(server, page, os.environ["SHOTS"])
        else:
            for part in (cases, scanner, probe, probe_by_keys, forces, method, shown, session, reload, two, busy, trouble, face, pulls, colours, processor, compressed, looks):
                began = time.time()
                part(t, server, page)
                print(f"# {part.__name__}: {time.time() - began:.1f} s", flush=True)
            # The connection that was cut is the one error that may be.
            errors = [error for error in page.errors() if "/live" not in error]
            t.is_("the browser has nothing to complain of", errors, [])
            without_webgl(t, server)
    finally:
        page.driver.quit()
    print(f"1..{t.count}")
    return 1 if t.failed else 0


if __name__ == "__main__":
    sys.exit(main())
