"""A stand-in for `sinew console`: it serves the page and speaks the server's side of its protocol, with toys in place of
the tools, so that the page is tested alone. `Server` is driven by the test of the same process."""
import base64
import ctypes
import ctypes.util
import hashlib
import http
import json
import math
import os
import random
import socket
import struct
import threading
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PAGE = os.path.join(ROOT, "common/console/page")
THREE = os.environ.get("THREE", "/usr/share/javascript/three")
# As strict as a server may be: nothing from elsewhere, no code or style in the page itself.
POLICY = "Content-Security-Policy: default-src 'self'; img-src 'self' blob: data:\r\n"
TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".png": "image/png"}


# ---- JPEG


class Jpeg:
    """Grey pixels as JPEG, by libturbojpeg."""

    def __init__(self):
        self.jpeg = ctypes.CDLL(ctypes.util.find_library("turbojpeg"))
        self.jpeg.tjInitCompress.restype = ctypes.c_void_p
        self.handle = ctypes.c_void_p(self.jpeg.tjInitCompress())
        self.lock = threading.Lock()

    def pack(self, pixels, columns, rows):
        grey_pixels, grey_samples = 6, 3
        to, size = ctypes.POINTER(ctypes.c_ubyte)(), ctypes.c_ulong(0)
        with self.lock:
            self.jpeg.tjCompress2(self.handle, bytes(pixels), columns, 0, rows, grey_pixels, ctypes.byref(to),
                                     ctypes.byref(size), grey_samples, 85, 0)
            packed = ctypes.string_at(to, size.value)
            self.jpeg.tjFree(to)
        return packed


# ---- surfaces


def grid(place, columns, rows, closed=False):
    """Vertices place(i, j) and triangles of a sheet; closed: its columns go round."""
    vertices = [place(i, j) for j in range(rows) for i in range(columns)]
    triangles = []
    for j in range(rows - 1):
        for i in range(columns if closed else columns - 1):
            a, b = j * columns + i, j * columns + (i + 1) % columns
            triangles += [(a, b, b + columns), (a, b + columns, a + columns)]
    return vertices, triangles


def tube(x, z, radius):
    around = 24

    def place(i, j):
        angle = 2 * math.pi * i / around
        return (x + radius * math.cos(angle), -.02 + .04 * j / 10, z + radius * math.sin(angle))

    return grid(place, around, 11, True)


def arm():
    """A half of a cylinder along y, bulging up, whose top is at z = 0."""

    def place(i, j):
        angle = math.pi * (i / 40 - .5)
        return (.06 * math.sin(angle), -.08 + .16 * j / 40, .06 * math.cos(angle) - .06)

    return grid(place, 41, 41)


def head():
    def place(i, j):
        a, b = 2 * math.pi * i / 48, math.pi * (.02 + .96 * j / 36)
        nose = .02 * math.exp(-((a - 4.712) / .2) ** 2 - ((b - 1.6) / .25) ** 2)
        r = 1 + nose / .08
        return (.07 * r * math.sin(b) * math.cos(a), .08 * r * math.sin(b) * math.sin(a), -.1 * math.cos(b))

    return grid(place, 48, 37, True)


class Mesh:
    def __init__(self, number, name, kind, colour, moves, surface):
        self.number, self.name, self.kind, self.colour, self.moves = number, name, kind, colour, moves
        self.rest, self.triangles = surface
        self.now = self.rest

    def header(self):
        return {"id": self.number, "name": self.name, "kind": self.kind, "vertices": len(self.rest),
                "triangles": len(self.triangles), "colour": self.colour, "moves": self.moves}

    def body(self):
        flat = [x for vertex in self.rest for x in vertex]
        corners = [x for triangle in self.triangles for x in triangle]
        return struct.pack(f"<{len(flat)}f", *flat) + struct.pack(f"<{len(corners)}I", *corners)

    def positions(self, values):
        low = [min(v[i] for v in self.now) for i in range(3)]
        high = [max(v[i] for v in self.now) for i in range(3)]
        half = [max(b - a, 1e-9) / 2 for a, b in zip(low, high)]
        whole = [round(32767 * (v[i] - low[i] - half[i]) / half[i]) for v in self.now for i in range(3)]
        packed = struct.pack("<II6f", self.number, len(self.now), *low, *high) + struct.pack(f"<{len(whole)}h", *whole)
        packed += b"\0" * (-len(packed) % 4)
        given = values(self) if values else None
        if not given:
            return packed + struct.pack("<ffI", 0, 0, 0)
        packed += struct.pack("<ffI", *given[:2], len(given[2])) + given[2]
        return packed + b"\0" * (-len(packed) % 4)


# ---- toys in place of cases

UPRIGHT = [0, 0, .005, 1, 0, 0, 0]  # a probe that looks down, 5 mm above


def setting(value, unit="", help_="", **more):
    return {"value": value, "unit": unit, "default": value, "help": help_, **more}


class Arm:
    kind = "ultrasound"
    up = [0, 0, 1]
    COLUMNS, ROWS = 160, 200

    def __init__(self):
        self.meshes = [Mesh(0, "skin", "skin", "#c8a58c", True, arm()), Mesh(1, "vein", "label", "#4b78c8", True, tube(-.007, -.013, .004)),
                       Mesh(2, "artery", "label", "#c8463c", True, tube(.007, -.014, .0035)), Mesh(3, "bone", "bone", "#e6dfcf", False, tube(0, -.03, .008))]
        self.pose = list(UPRIGHT)
        self.shape = "linear:4cm,1cm"
        self.source = "hand"  # what has moved the probe
        self.method = "msds"
        self.settings = {"iterations": setting("20", "", "Time steps or iterations for each 1/60 s", min=1),
                         "dt": setting("0.01", "s", "The time step of springs", min=0),
                         "mass": setting("stable", "", "The inertia of nodes", choices=["stable", "lumped"]),
                         "spring-scale": setting("auto", "m", "The stiffness of a spring divided by Young's modulus"),
                         "repulsion": setting("1", "", "The contact stiffness at a node", min=0)}
        self.image = {"gain": setting("0", "dB"), "tgc": setting("0", "dB"), "dynamic-range": setting("60,60", "dB"), "depth": setting("0.05", "m"),
                      "thickness": setting("0", "m"), "labels": setting("off"), "freeze": setting("off")}
        dice = random.Random(3)
        self.speckle = bytes(min(int(dice.expovariate(1 / 45)), 255) for _ in range(self.COLUMNS * self.ROWS))

    def depth_in(self):
        return max(-self.pose[2], 0)

    def frame(self):
        x, y, d = self.pose[0], self.pose[1], self.depth_in()
        for mesh in self.meshes[:3] if d else []:
            mesh.now = [(v[0], v[1], v[2] - .9 * d * math.exp(-((v[0] - x) / .025) ** 2 - ((v[1] - y) / .015) ** 2 + v[2] / .03)) for v in mesh.rest]
        if not d:
            for mesh in self.meshes:
                mesh.now = mesh.rest
        # Seven digits, as the test reads them.
        return {"force": [0, 0, round(900 * d, 7)], "torque": [round(.4 * d, 7), 0, 0], "contacts": 40 if d else 0, "pose": self.pose}

    def pixels(self):
        table = bytes(min(int(i * 10 ** (float(self.image["gain"]["value"]) / 20)), 255) for i in range(256))
        shift = int(self.pose[0] * 4000) % self.COLUMNS
        rows = []
        for row in range(self.ROWS):
            line = self.speckle[row * self.COLUMNS:(row + 1) * self.COLUMNS]
            line = bytearray(line[shift:] + line[:shift])
            for x, z, r in ((-.007, -.013, .004), (.007, -.014, .0035)):
                away = (row / self.ROWS * .05 + z + self.depth_in()) / (r * (1 - 20 * self.depth_in() if x < 0 else 1) + 1e-9)
                if abs(away) < 1:
                    half, middle = r * math.sqrt(1 - away * away), x - self.pose[0] + .02
                    low, high = (max(int((middle + s * half) / .04 * self.COLUMNS), 0) for s in (-1, 1))
                    line[low:high] = bytes(max(min(high, self.COLUMNS) - low, 0)) if low < self.COLUMNS else b""
            rows.append(bytes(line[:self.COLUMNS]).ljust(self.COLUMNS, b"\0"))
        return b"".join(rows).translate(table)

    def plane(self):
        """Of a probe that looks down with its columns along x; the depth is the image's."""
        step = [.04 / self.COLUMNS, float(self.image["depth"]["value"].rstrip("m")) / self.ROWS]
        if self.image["depth"]["value"].endswith("mm"):
            step[1] /= 1000
        x, y, z = self.pose[:3]
        return [x - .02 + step[0] / 2, y, z - step[1] / 2, step[0], 0, 0, 0, 0, -step[1]]

    def state(self):
        return {"tool": {"name": "msds-run", "method": self.method, "methods": ["msds", "fem", "exact", "warp", "exact-warp", "tissue"], "settings": self.settings},
                "image": {"settings": self.image}, "probe": {"shape": self.shape, "pose": self.pose, "from": self.source},
                "device": "cpu, 2 threads"}

    def take(self, verb, words):
        """None, or what is wrong."""
        if verb == "pose":
            self.pose = [float(word) for word in words]
        elif verb == "method":
            self.method = words[0]
        elif verb in ("set", "image"):
            return self.set(self.image if verb == "image" else self.settings, *words)
        else:
            return f"'{verb}'; expected method NAME, or set KEY VALUE"
        return None

    def set(self, settings, key, value):
        if key == "probe":
            self.shape = value
        elif key not in settings:
            return f"setting {key}; expected iterations"
        elif value.startswith("-") and "min" in settings[key]:
            return f"set {key} {value}; expected a number above 0"
        else:
            settings[key]["value"] = value
        return None


class Head:
    kind = "face"
    up = [0, 0, 1]

    def __init__(self):
        self.meshes = [Mesh(0, "face", "skin", "#d2ab93", True, head()), Mesh(1, "skull", "bone", "#e6dfcf", False, tube(0, 0, .03))]
        self.levels = {name: 0 for name in ("zyg_left", "zyg_right", "frontalis_left", "frontalis_right", "orbicularis")}
        self.at = {"zyg_left": (.04, -.06, -.02), "zyg_right": (-.04, -.06, -.02), "frontalis_left": (.025, -.06, .05),
                   "frontalis_right": (-.025, -.06, .05), "orbicularis": (0, -.085, -.03)}
        self.pulls = {}
        self.gravity = [0, 0, 0]

    def frame(self):
        def moved(v):
            to = [x + .0005 * g for x, g in zip(v, self.gravity)]
            for name, level in self.levels.items():
                if level:
                    near = math.exp(-sum((a - b) ** 2 for a, b in zip(v, self.at[name])) / .02 ** 2)
                    to = [to[0] + .006 * level * near * (1 if v[0] > 0 else -1), to[1], to[2] + .008 * level * near]
            for pull in self.pulls.values():
                near = math.exp(-sum((a - b) ** 2 for a, b in zip(v, pull["point"])) / (2 * pull["radius"]) ** 2)
                share = pull["stiffness"] / (pull["stiffness"] + 60) * near
                to = [x + share * (t - p) for x, t, p in zip(to, pull["target"], pull["point"])]
            return tuple(to)

        self.meshes[0].now = [moved(v) for v in self.meshes[0].rest]
        return {}

    def state(self):
        def side(name):
            return "left" if name.endswith("left") else "right" if name.endswith("right") else "middle"

        gravity = setting(",".join(f"{x:g}" for x in self.gravity), "m/s2", "gravity")
        return {"tool": {"name": "tled-run", "settings": {"gravity": gravity}}, "muscles": [{"name": n, "side": side(n), "level": v} for n, v in self.levels.items()],
                "pulls": list(self.pulls.values()), "device": "cpu, 2 threads", "colours": ["displacement", "quality"], "probe": None}

    def take(self, verb, words):
        if verb == "now" and words[0] == "contract":
            self.levels[words[1]] = float(words[2])
        elif verb == "now" and words[0] == "gravity":
            self.gravity = [float(x) for x in words[1].split(",")]
        elif verb == "pull":
            point, target = ([float(x) for x in words[i].split(",")] for i in (1, 3))
            before = self.pulls.get(words[0], {"id": words[0], "point": point, "radius": float(words[2]), "stiffness": float(words[4])})
            self.pulls[words[0]] = {**before, "target": target}
        elif verb == "release":
            self.pulls.pop(words[0], None)
        else:
            return f"'{verb} {words[0]}'; expected now contract, now gravity, pull or release"
        return None


# ---- the server


class Client:
    def __init__(self, connection):
        self.connection, self.lock = connection, threading.Lock()
        self.raw = False  # it takes images that are not compressed

    def send(self, payload):
        kind = 1 if isinstance(payload, str) else 2
        data = payload.encode() if kind == 1 else payload
        size = len(data)
        head_ = bytes([0x80 | kind]) + (bytes([size]) if size < 126 else struct.pack(">BH", 126, size) if size < 65536 else struct.pack(">BQ", 127, size))
        try:
            with self.lock:
                self.connection.sendall(head_ + data)
        except OSError:
            pass

    def receive(self, reader):
        """The text of the next message; None at the end."""
        start = reader.read(2)
        if len(start) < 2 or start[0] & 15 == 8:
            return None
        size = start[1] & 127
        if size >= 126:
            size = struct.unpack(">H" if size == 126 else ">Q", reader.read(2 if size == 126 else 8))[0]
        mask = reader.read(4)
        return bytes(b ^ mask[i % 4] for i, b in enumerate(reader.read(size))).decode()


class Server:
    """Listens on 127.0.0.1. `lines`: what pages have sent. All else is called by the test."""

    def __init__(self, rate=20):
        self.jpeg = Jpeg()
        self.cases = {"arm": Arm, "face": Head}
        self.model, self.name = None, None
        self.lines, self.clients, self.children = [], [], []
        self.index, self.paused, self.recording, self.colour, self.began = 0, False, False, None, time.time()
        self.lock = threading.RLock()
        self.rate, self.running = rate, True
        self.port = 0
        self.listen()
        threading.Thread(target=self.tick, daemon=True).start()

    # -- HTTP

    def listen(self):
        self.socket = socket.create_server(("127.0.0.1", self.port))
        self.port = self.socket.getsockname()[1]
        threading.Thread(target=self.accept, args=(self.socket,), daemon=True).start()

    def accept(self, listening):
        while True:
            try:
                connection, _ = listening.accept()
            except OSError:
                return
            threading.Thread(target=self.serve, args=(connection,), daemon=True).start()

    def serve(self, connection):
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        reader = connection.makefile("rb")
        request = reader.readline().decode("latin-1").split()
        headers = {}
        for line in iter(reader.readline, b"\r\n"):
            if not line:
                break
            key, _, value = line.decode("latin-1").partition(":")
            headers[key.lower()] = value.strip()
        if len(request) > 1 and request[1].split("?")[0] == "/live":
            self.live(connection, reader, headers)
        elif len(request) > 1:
            self.file(connection, request[1].split("?")[0])
        reader.close()
        connection.close()

    def file(self, connection, path):
        if path.startswith("/three/"):
            where = os.path.join(THREE, path[len("/three/"):])
        else:
            where = os.path.join(PAGE, path.lstrip("/") or "index.html")
        try:
            body, status = open(where, "rb").read(), http.HTTPStatus.OK
        except OSError:
            body, status = b"no such file\n", http.HTTPStatus.NOT_FOUND
        kind = TYPES.get(os.path.splitext(where)[1], "text/plain")
        head_ = f"HTTP/1.1 {status.value} {status.phrase}\r\nContent-Type: {kind}\r\nContent-Length: {len(body)}\r\nCache-Control: no-store\r\n{POLICY}Connection: close\r\n\r\n"
        try:
            connection.sendall(head_.encode() + body)
        except OSError:
            pass

    # -- WebSocket

    def live(self, connection, reader, headers):
        answer = base64.b64encode(hashlib.sha1((headers["sec-websocket-key"] + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest())
        connection.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: " + answer + b"\r\n\r\n")
        client = Client(connection)
        with self.lock:
            self.clients.append(client)
            client.send(self.state())
            if self.model:
                client.send(self.geometry())
                self.send_frame([client])
        try:
            for line in iter(lambda: client.receive(reader), None):
                if line == "pixels raw":
                    client.raw = True
                elif not line.startswith("got "):
                    self.take(line)
        except (OSError, IndexError, struct.error):
            pass
        with self.lock:
            if client in self.clients:
                self.clients.remove(client)

    def everyone(self, payload):
        for client in list(self.clients):
            client.send(payload)

    def state(self):
        cases = [{"name": name, "picture": None} for name in self.cases]
        state = {"type": "state", "colour": self.colour or "own", "cases": cases, "case": self.name, "kind": self.model.kind if self.model else None, "paused": self.paused,
                 "recording": self.recording, "children": self.children, "why": None}
        return json.dumps({**state, **(self.model.state() if self.model else {})})

    def geometry(self):
        corners = [v for mesh in self.model.meshes for v in mesh.rest]
        box = [f(v[i] for v in corners) for f in (min, max) for i in range(3)]
        header = json.dumps({"meshes": [mesh.header() for mesh in self.model.meshes], "box": box, "up": self.model.up}).encode()
        return struct.pack("<II", 2, len(header)) + header + b"\0" * (-len(header) % 4) + b"".join(mesh.body() for mesh in self.model.meshes)

    def values(self, mesh):
        if self.colour != "quality":
            return None
        return 0.2, 1.0, bytes(int(255 * i / len(mesh.rest)) for i in range(len(mesh.rest)))

    def send_frame(self, to):
        frame = {"type": "frame", "index": self.index, "time": self.index / 60, "lag": 3.2, "ratio": 1.0, **self.model.frame()}
        moving = [mesh for mesh in self.model.meshes if mesh.moves]
        positions = struct.pack("<III", 3, self.index, len(moving)) + b"".join(mesh.positions(self.values) for mesh in moving)
        for client in to:
            client.send(json.dumps(frame))
            client.send(positions)
            if self.model.kind == "ultrasound":
                client.send(self.image(client.raw))

    def image(self, raw):
        size, pixels = (self.model.COLUMNS, self.model.ROWS), self.model.pixels()
        head_ = struct.pack("<IIIId9d", 4 if raw else 1, self.index, *size, self.index / 60, *self.model.plane())
        return head_ + (pixels if raw else self.jpeg.pack(pixels, *size))

    def tick(self):
        while self.running:
            time.sleep(1 / self.rate)
            with self.lock:
                if self.model and not self.paused:
                    self.index += 1
                    self.send_frame(list(self.clients))

    # -- messages

    def take(self, line):
        with self.lock:
            self.lines.append(line)
            verb, *words = line.split()
            wrong = self.do(verb, words)
            if wrong:
                self.say("error", self.model.state()["tool"]["name"] if self.model else "sinew console", wrong)
            elif verb != "pose":
                self.everyone(self.state())

    def do(self, verb, words):
        if verb == "open":
            self.open(words[0])
        elif verb == "pause":
            self.paused = words[0] == "on"
        elif verb == "record":
            self.recording = words[0] == "on"
        elif verb == "step":
            self.index += 1
            self.send_frame(list(self.clients))
        elif verb == "reset":
            self.open(self.name)
        elif verb == "colour":
            self.colour = words[0]
        elif verb == "save":
            self.everyone(json.dumps({"type": "saved", "name": f"{words[0]}-1", "url": f"/save/{words[0]}-1"}))
        elif verb != "replay":
            return self.model.take(verb, words) if self.model else f"{verb}: no case is open"
        return None

    def open(self, name):
        with self.lock:
            self.model, self.name, self.index, self.colour = self.cases[name](), name, 0, None
            self.everyone(self.state())
            self.everyone(self.geometry())
            self.send_frame(list(self.clients))

    # -- what a test does

    def say(self, level, tool, text):
        self.everyone(json.dumps({"type": "said", "level": level, "tool": tool, "text": text}))

    def tell_children(self, children):
        with self.lock:
            self.children = children
            self.everyone(self.state())

    def stop_listening(self):
        """Nobody is there any more, until listen()."""
        with self.lock:
            self.socket.shutdown(socket.SHUT_RDWR)
            self.socket.close()
            for client in self.clients:
                client.connection.shutdown(socket.SHUT_RDWR)

    def count(self, beginning):
        with self.lock:
            return sum(line.startswith(beginning) for line in self.lines)

    def last(self, beginning):
        with self.lock:
            return next((line for line in reversed(self.lines) if line.startswith(beginning)), None)


if __name__ == "__main__":
    served = Server()
    print(f"http://127.0.0.1:{served.port}/", flush=True)
    threading.Event().wait()
