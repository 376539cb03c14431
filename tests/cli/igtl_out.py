"""igtl_out.py TOOL FOLDER: talks to sinew igtl-out as a client written from the specification (openigtlink.org, Documents/Protocol), which shares no code
with it. FOLDER has result.sinew, and moved.obj, what sinew deform makes of its last frame. Prints "ok NAME" or "not ok NAME: ..." a line."""

import os
import re
import select
import signal
import socket
import struct
import subprocess
import sys
import time

TOOL, FOLDER = sys.argv[1:3]


def make_table():
    table = []
    for byte in range(256):
        crc = byte << 56
        for _ in range(8):
            crc = (crc << 1 ^ (0x42F0E1EBA9EA3693 if crc >> 63 else 0)) & 0xFFFFFFFFFFFFFFFF
        table.append(crc)
    return table


TABLE = make_table()


def crc64(data):
    crc = 0
    for byte in data:
        crc = (crc << 8 & 0xFFFFFFFFFFFFFFFF) ^ TABLE[crc >> 56 ^ byte]
    return crc


def ok(good, name, why=""):
    print(f"ok {name}" if good else f"not ok {name}: {why}", flush=True)


def near(got, want, tolerance=1e-4):
    return len(got) == len(want) and all(abs(a - b) <= tolerance for a, b in zip(got, want))


class Message:
    """One message, with its checksum compared where it is short; pixels are compared with what was sent."""

    def __init__(self, head, body):
        self.version, kind, device, self.stamp, size, crc = struct.unpack(">H12s20sQQQ", head)
        self.type, self.device = kind.rstrip(b"\0").decode(), device.rstrip(b"\0").decode()
        self.sound = size == len(body) and (len(body) > 70000 or crc == crc64(body))
        self.content, self.meta, self.id = body, {}, None
        if self.version == 2:
            extended, head_size, meta_size, self.id = struct.unpack(">HHII", body[:12])
            end = len(body) - head_size - meta_size
            self.content = body[extended:end]
            self.sound &= extended == 12
            if head_size:
                self.take_meta(body[end : end + head_size], body[end + head_size :])

    def take_meta(self, head, text):
        (count,) = struct.unpack(">H", head[:2])
        at = 0
        for i in range(count):
            key, encoding, value = struct.unpack(">HHI", head[2 + 8 * i : 10 + 8 * i])
            self.sound &= encoding == 3
            self.meta[text[at : at + key].decode()] = text[at + key : at + key + value].decode()
            at += key + value
        self.sound &= at == len(text) and len(head) == 2 + 8 * count

    def matrix(self):
        """Of a TRANSFORM: 12 numbers, columns first."""
        return struct.unpack(">12f", self.content)


class Client:
    """What was passed over on the way to a message that was looked for stays, to be looked for later."""

    def __init__(self, port, buffer=None):
        self.passed = []
        self.socket = socket.socket()
        if buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
        self.socket.settimeout(10)
        self.socket.connect(("127.0.0.1", port))

    def send(self, kind, device="", content=b"", version=1, number=1):
        if version == 2:
            content = struct.pack(">HHII", 12, 0, 0, number) + content
        head = struct.pack(">H12s20sQQQ", version, kind.encode(), device.encode(), 0, len(content), crc64(content))
        self.socket.sendall(head + content)

    def bytes(self, size):
        got = b""
        while len(got) < size:
            more = self.socket.recv(size - len(got))
            if not more:
                raise EOFError
            got += more
        return got

    def next(self):
        head = self.bytes(58)
        return Message(head, self.bytes(struct.unpack(">Q", head[42:50])[0]))

    def find(self, kind, device=None, want=lambda m: True):
        """The first message of a type that was not found yet."""
        at = 0
        while True:
            if at == len(self.passed):
                self.passed.append(self.next())
            m = self.passed[at]
            if m.type == kind and device in (None, m.device) and want(m):
                return self.passed.pop(at)
            at += 1

    def all(self):
        """What comes until the connection ends."""
        try:
            while True:
                self.passed.append(self.next())
        except (EOFError, ConnectionResetError):
            return self.passed

    def quiet(self, kind, seconds=0.15):
        """Whether no message of the type comes."""
        end = time.monotonic() + seconds
        while select.select([self.socket], [], [], max(0, end - time.monotonic()))[0]:
            if self.next().type == kind:
                return False
        return True


class Server:
    def __init__(self, *arguments, limit=None, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL):
        command = [TOOL, "--listen", "0", *arguments]
        if limit:
            command = ["sh", "-c", f'ulimit -n {limit}; exec "$@"', "sh", *command]
        self.said = b""
        self.child = subprocess.Popen(command, stdin=stdin, stdout=stdout, stderr=subprocess.PIPE)
        match = self.wait(rb"listens on 127\.0\.0\.1:(\d+)\n")
        self.port = int(match.group(1)) if match else 0

    def wait(self, pattern, seconds=10):
        """What it says on standard error that matches."""
        end = time.monotonic() + seconds
        while not re.search(pattern, self.said):
            if not select.select([self.child.stderr], [], [], max(0, end - time.monotonic()))[0]:
                return None
            more = os.read(self.child.stderr.fileno(), 65536)
            if not more:
                return re.search(pattern, self.said)
            self.said += more
        return re.search(pattern, self.said)

    def put(self, data):
        self.child.stdin.write(data)
        self.child.stdin.flush()

    def client(self, **more):
        c = Client(self.port, **more)
        self.wait(f"client 127.0.0.1:{c.socket.getsockname()[1]}: connected".encode())
        return c

    def end(self):
        """Closes its input; its status, and all that it said."""
        if self.child.stdin and not self.child.stdin.closed:
            self.child.stdin.close()
        self.said += self.child.stderr.read()
        return self.child.wait(timeout=10)


def image(plane, columns, rows, fill, channels=1, more=""):
    pixels = bytes((fill + 7 * i) % 256 for i in range(columns * rows * channels))
    numbers = " ".join(repr(x) for x in plane)
    return f"P{5 if channels == 1 else 6}\n# us-slice: {numbers}{more}\n{columns} {rows}\n255\n".encode() + pixels, pixels


# x and z of the probe are at right angles; the step to a column is .2 mm, that to a row .5 mm.
PLANE = [0.01, 0.02, 0.03, 0.0002 * 0.6, 0.0002 * 0.8, 0, 0, 0, 0.0005]


def ras(v):
    return [-1000 * v[0], -1000 * v[1], 1000 * v[2]]


def check_image(m, plane, columns, rows, pixels, channels, name):
    version, components, scalar, order, space = struct.unpack(">HBBBB", m.content[:6])
    sizes, norms = struct.unpack(">3H", m.content[6:12]), struct.unpack(">12f", m.content[12:60])
    part = struct.unpack(">6H", m.content[60:72])
    ok(m.sound and m.device == "Image_Reference" and (version, components, scalar, space) == (1, channels, 3, 1) and order in (1, 2) and m.stamp > 0,
       f"{name}: uint8, RAS, with a time stamp", [version, components, scalar, order, space, m.device])
    ok(sizes == (columns, rows, 1) and part == (0, 0, 0, columns, rows, 1), f"{name}: its size, all of it in one part", [sizes, part])
    ok(m.content[72:] == pixels, f"{name}: its pixels, to the byte")
    centre = [plane[a] + plane[3 + a] * (columns - 1) / 2 + plane[6 + a] * (rows - 1) / 2 for a in range(3)]
    ok(near(norms[9:], ras(centre)), f"{name}: its position is its centre", [norms[9:], ras(centre)])
    ok(near(norms[0:3], ras(plane[3:6])) and near(norms[3:6], ras(plane[6:9])), f"{name}: its axes, as long as a pixel", norms)
    i, j, k = norms[0:3], norms[3:6], norms[6:9]
    cross = [i[1] * j[2] - i[2] * j[1], i[2] * j[0] - i[0] * j[2], i[0] * j[1] - i[1] * j[0]]
    length = sum(x * x for x in k) ** 0.5
    ok(length > 0 and sum(a * b for a, b in zip(cross, k)) > 0.99 * length * sum(x * x for x in cross) ** 0.5, f"{name}: right-handed", norms)


def try_images():
    s = Server("--images", "-")
    first = s.client()
    status = first.find("STATUS")
    ok(status.sound and status.version == 1 and struct.unpack(">H", status.content[:2]) == (13,), "before anything comes, it is not ready")
    data, pixels = image(PLANE, 5, 4, 3)
    s.put(data)
    m = first.find("IMAGE")
    ok(m.version == 1, "whoever has said nothing gets header version 1", m.version)
    check_image(m, PLANE, 5, 4, pixels, 1, "grey")
    place = first.find("TRANSFORM", "ImageToReference").matrix()
    ok(near(place[9:], ras(PLANE[:3])) and near(place[3:6], ras(PLANE[6:])), "ImageToReference is of pixel 0 0", place)
    probe = first.find("TRANSFORM", "ProbeToReference").matrix()
    face = [PLANE[a] + 2 * PLANE[3 + a] - 0.5 * PLANE[6 + a] for a in range(3)]
    ok(near(probe[9:], ras(face)) and near(probe[:9], [-0.6, -0.8, 0, 0.8, -0.6, 0, 0, 0, 1]), "the probe: the middle of the face, of length 1", probe)
    ok(struct.unpack(">H", first.find("STATUS").content[:2]) == (1,), "and it is ready")
    data, pixels = image(PLANE, 4, 6, 9, 3, " fan 0.0605 0.06 0.11 60")
    s.put(data)
    check_image(first.find("IMAGE"), PLANE, 4, 6, pixels, 3, "colours")
    probe = first.find("TRANSFORM", "ProbeToReference").matrix()
    ok(near(probe[9:], ras([PLANE[a] + 1.5 * PLANE[3 + a] - (0.0005 if a == 2 else 0) for a in range(3)])), "of a fan, where its comment says", probe)
    late = s.client()
    check_image(late.find("IMAGE"), PLANE, 4, 6, pixels, 3, "a late client's newest")
    late.send("GET_STATUS", version=2)
    late.find("STATUS", want=lambda m: m.version == 2)
    s.put(image(PLANE, 5, 4, 1)[0])
    m, other = late.find("IMAGE"), first.find("IMAGE")
    ok(m.version == 2 and m.sound and m.id and m.meta == {"FrameNumber": "2"}, "who spoke header version 2 gets it: id, metadata", [m.version, m.id, m.meta])
    ok(m.content[72:] == image(PLANE, 5, 4, 1)[1], "around the same content")
    ok(other.version == 1 and other.sound and len(other.content) == 72 + 20, "the other gets version 1 still")
    try_queries(s, first)
    status = s.end()
    ok(status == 0 and b"0 frames, 3 images; 2 clients, 0 dropped" in s.said, "the end of images is the end", s.said)
    ok(first.all()[-1].type == "STATUS", "said to clients at last")


def try_queries(s, c):
    c.send("GET_IMAGE", "Image_Reference")
    ok(len(c.find("IMAGE").content) == 72 + 20, "GET_IMAGE: the newest once more")
    for suffix in ("TRANS", "TRANSFOR"):
        c.send(f"GET_{suffix}", "ImageToReference")
        ok(c.find("TRANSFORM", "ImageToReference").sound, f"GET_{suffix}")
    c.send("GET_TRANS", "Nothing")
    ok(c.find("TRANSFORM", "Nothing").content == b"", "what is not there: no body, the name that was asked for")
    c.send("GET_POLYDATA")
    ok(c.find("POLYDATA").content == b"", "what has not come: no body")
    c.send("GET_CAPABIL", "x")
    types = c.find("CAPABILITY", "x").content
    ok(len(types) % 12 == 0 and b"IMAGE\0\0\0\0\0\0\0" in types and b"GET_CAPABIL\0" in types, "GET_CAPABIL", types)
    c.send("GET_TDATA", "t")
    ok(c.find("RTS_TDATA", "t").content == b"\1", "what is not served: RTS_ with an error")
    c.send("STP_IMAGE", "Image_Reference")
    ok(c.find("RTS_IMAGE", "Image_Reference").content == b"\0", "STP_IMAGE is answered")
    c.send("STP_POLYDATA")
    ok(c.find("RTS_POLYDATA").content == b"\0", "and of a type that may come later")
    c.send("STP_IMAGE", "Image_Other")
    ok(c.find("RTS_IMAGE", "Image_Other").content == b"\1", "of a device that is not there, with an error")


def try_flow():
    s = Server("--images", "-")
    c = s.client()
    c.send("STP_IMAGE")
    c.find("RTS_IMAGE")
    s.put(image(PLANE, 5, 4, 1)[0])
    ok(c.quiet("IMAGE"), "after STP_IMAGE none comes")
    c.send("STT_IMAGE", "", struct.pack(">I", 100))
    c.find("RTS_IMAGE")
    ok(c.find("IMAGE").content[72:] == image(PLANE, 5, 4, 1)[1], "after STT_IMAGE the newest does")
    begin = time.monotonic()
    for fill in range(2, 40):
        s.put(image(PLANE, 5, 4, fill)[0])
    m = c.find("IMAGE", want=lambda m: m.content[72] == 39)
    ok(time.monotonic() - begin > 0.09 and m.sound, "at most one in 100 ms, and the last of them comes", time.monotonic() - begin)
    ok(s.end() == 0 and int(re.search(rb"(\d+) left out", s.said).group(1)) >= 30, "those between are counted", s.said)


def command(c, name, xml, number):
    text = xml.encode()
    c.send("COMMAND", "Slicer", struct.pack(">I128sHI", number, name.encode(), 3, len(text)) + text, version=2, number=number)
    m = c.find("RTS_COMMAND")
    got, said, encoding, size = struct.unpack(">I128sHI", m.content[:138])
    good = m.sound and m.device == "Slicer" and m.version == 2 and got == number and encoding == 3 and said.rstrip(b"\0").decode() == name
    ok(good and size == len(m.content) - 138, f"{name} {number} is answered", [m.device, got, said])
    return m.content[138:].decode(), m.meta


def parameters(verb, *pairs):
    inner = "".join(f'<Parameter Name="{n}"{f" Value={chr(34)}{v}{chr(34)}" if v else ""} />' for n, v in pairs)
    return f'<Command Name="{verb}" UsDeviceId="VideoDevice">{inner}</Command>'


def try_commands():
    fifo = os.path.join(FOLDER, "control")
    os.mkfifo(fifo)
    s = Server("--images", "-", "--control", fifo)
    c = s.client()
    text, meta = command(c, "SetUsParameter", parameters("SetUsParameter", ("DepthMm", "65.5"), ("GainPercent", "60")), 7)
    want = '<CommandReply><Parameter Name="DepthMm" Success="true"/><Parameter Name="GainPercent" Success="true"/></CommandReply>'
    ok(text == want and meta == {"DepthMm": "SUCCESS", "GainPercent": "SUCCESS", "Status": "SUCCESS"}, "in the form of PLUS", [text, meta])
    command(c, "SetUsParameter", parameters("SetUsParameter", ("DynRangeDb", "50"), ("TimeGainCompensation", "0 3 -6.5")), 8)
    with open(fifo, "rb") as control:
        lines = b"set depth 65.5mm\nset gain 6\nset dynamic-range 50\nset tgc 0,3,-6.5\n"
        got = control.read(len(lines))
        ok(got == lines, "what was set before anyone read is in us-slice's control", got)
        for name, value, why in (("FrequencyMhz", "5", "as they were recorded"), ("DepthMm", "-3", "of 0.001 to 10000"), ("DepthMm", "5 6", "a number"),
                                 ("GainPercent", "101", "0 to 100"), ("Nonsense", "1", "Invalid parameter Nonsense"), ("DepthMm", "nan", "a number")):
            text, meta = command(c, "SetUsParameter", parameters("SetUsParameter", (name, value)), 9)
            ok(f'<Parameter Name="{name}" Success="false"/>' in text and meta["Status"] == "FAIL" and why in meta["Error"], f"{name} {value}: {meta['Error']}")
        command(c, "SetUsParameter", parameters("SetUsParameter", ("GainPercent", "50")), 10)
        got = os.read(control.fileno(), 100)
        ok(got == b"set gain 0\n", "what is refused is not", got)
    command(c, "SetUsParameter", parameters("SetUsParameter", ("GainPercent", "55")), 11)
    with open(fifo, "rb") as control:
        got = control.readline()
        ok(got == b"set gain 3\n", "and after its reader has gone, for the next", got)
    text, meta = command(c, "GetUsParameter", parameters("GetUsParameter", ("DepthMm", ""), ("DynRangeDb", ""), ("FrequencyMhz", "")), 12)
    ok('<Parameter Name="DepthMm" Success="true" Value="65.5"/>' in text and '"FrequencyMhz" Success="false"/>' in text, "GetUsParameter", text)
    ok(meta["DepthMm"] == "65.5" and meta["DynRangeDb"] == "50" and meta["Status"] == "FAIL", "with metadata", meta)
    for name, want in (("RequestChannelIDs", "VideoStream"), ("RequestDeviceIDs", "VideoDevice"), ("Version", "sinew ")):
        text, meta = command(c, name, f'<Command Name="{name}"/>', 13)
        ok(want in text and meta["Message"].startswith(want) and meta["Status"] == "SUCCESS", f"{name}: {meta.get('Message')}", text)
    text, meta = command(c, "Explode", "<Command/>", 14)
    ok(meta == {"Status": "FAIL", "Error": "Unknown command name: Explode."}, "a command that there is not", meta)
    text, meta = command(c, "Broken", "<Command Name=", 15)
    ok(meta["Status"] == "FAIL", "one that is no XML", meta)
    old = s.client()
    xml = parameters("GetUsParameter", ("DepthMm", "")).encode()
    old.send("STRING", "CMD_5", struct.pack(">HH", 3, len(xml)) + xml)
    m = old.find("STRING", "ACK_5")
    ok(m.version == 1 and b'Status="SUCCESS"' in m.content and b"Value=&quot;65.5&quot;" in m.content, "and as old clients send them", m.content)
    s.put(image(PLANE, 5, 4, 1)[0])
    ok(s.end() == 0, "the end", s.said)


def try_slow():
    s = Server("--images", "-")
    slow, fast = s.client(buffer=16384), s.client()
    big = [image(PLANE, 512, 256, 0)[0][:-1] + bytes([n]) for n in range(30)]
    seen = 0
    for data in big:
        s.put(data)
        m = fast.find("IMAGE")
        seen += m.content[-1:] == data[-1:] and m.sound
    ok(seen == len(big), "while a client does not read, another gets each image", seen)
    s.child.stdin.close()
    got = [m for m in slow.all() if m.type == "IMAGE"]
    ok(0 < len(got) < 30 and got[-1].content[-1] == 29 and all(len(m.content) == 72 + 512 * 256 for m in got),
       "that one gets whole images, fewer, and the last at the end", [len(got), got[-1].content[-1] if got else None])
    ok([m.content[-1] for m in got] == sorted(m.content[-1] for m in got), "in their order")
    ok(s.end() == 0, "which is in order", s.said)


def try_many():
    s = Server("--images", "-")
    clients = [s.client() for _ in range(100)]
    clients[50].send("STP_IMAGE")
    clients[7].socket.sendall(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n" + b"x" * 100)
    ok(s.wait(rb"no OpenIGTLink: the version of a header is 18245; expected 1 or 2; it is dropped") is not None, "garbage: its client is dropped, in a line")
    clients[8].send("GET_IMAGE", content=b"abc")
    clients[9].socket.sendall(struct.pack(">H12s20sQQQ", 1, b"COMMAND", b"", 0, 2**63, 0))
    clients[10].socket.sendall(struct.pack(">H12s20sQQQ", 1, b"GET_IMAGE", b"", 0, 4, 1) + b"abcd")
    clients[11].socket.sendall(struct.pack(">H12s20sQQQ", 1, b"GET_IMAGE", b"", 0, 400, 1) + b"abcd")
    clients[11].socket.shutdown(socket.SHUT_WR)
    clients[12].socket.sendall(struct.pack(">H12s20sQQQ", 1, b"POLYDATA", b"", 0, 5, 1) + b"abcde")
    ok(s.wait(rb"a body of 9223372036854775808 bytes; .*; it is dropped") is not None, "a body of 2^63 bytes")
    ok(s.wait(rb"the checksum is .*; it is dropped") is not None, "a wrong checksum")
    ok(s.wait(rb"went away within a message; it is dropped") is not None, "half a message")
    clients[13].socket.close()
    data, pixels = image(PLANE, 5, 4, 3)
    s.put(data)
    s.child.stdin.close()
    got = [[m for m in c.all() if m.type == "IMAGE"] for i, c in enumerate(clients) if i not in (7, 9, 10, 11, 13, 50)]
    ok(len(got) == 94 and all(g and g[-1].content[72:] == pixels and g[-1].sound for g in got), "all others of 100 get the image", [len(g) for g in got])
    ok(s.end() == 0 and b"100 clients, 4 dropped" in s.said, "and are counted", s.said)
    ok(s.said.count(b"it is dropped") == 4, "a line each", s.said)
    s = Server("--images", "-", limit=40)
    clients = [s.client() for _ in range(8)]
    more = Client(s.port).all()
    ok([m.type for m in more] == ["STATUS"] and b"8 clients are served" in more[0].content, "one more than there are descriptors for is told why", more)
    clients.pop().socket.close()
    ok(s.wait(rb"is refused: 8 clients are served") is not None, "and so is who serves")
    s.put(data)
    ok(clients[0].find("IMAGE").sound, "while the others are served")
    s.child.send_signal(signal.SIGTERM)
    ok(s.child.wait(timeout=10) == 0, "SIGTERM ends it, though its input goes on")
    s.end()


def try_model():
    path = os.path.join(FOLDER, "result.sinew")
    with open(path, "rb") as f:
        data = f.read()
    with open(os.path.join(FOLDER, "moved.obj"), encoding="ascii") as f:
        moved = [[float(x) for x in line.split()[1:4]] for line in f if line.startswith("v ")]
    s = Server("--pass", stdout=subprocess.PIPE)
    c = s.client()
    s.put(data)
    s.child.stdin.close()
    passed = s.child.stdout.read()
    got = c.all()
    ok(passed == data, "the model is passed on to the byte", [len(passed), len(data)])
    ok(s.end() == 0 and b"12 frames, 0 images" in s.said, "all frames were read", s.said)
    last = {(m.type, m.device): m for m in got}
    ok(all(m.sound for m in got), "every checksum is right")
    surface = last["POLYDATA", "tri"].content
    counts = struct.unpack(">10I", surface[:40])
    points = struct.unpack(">12f", surface[40:88])
    ok(counts == (4, 0, 0, 0, 0, 2, 32, 0, 0, 0) and len(surface) == 40 + 48 + 32, "POLYDATA: points and triangles", counts)
    want = [x for v in moved for x in (-v[0], -v[1], v[2])]
    ok(near(points, want, 2e-5), "where sinew deform has them, in RAS, mm", [points, want])
    triangles = struct.unpack(">8I", surface[88:])
    ok(triangles[0] == triangles[4] == 3 and {frozenset(triangles[1:4]), frozenset(triangles[5:8])} in
       ({frozenset((0, 1, 2)), frozenset((0, 2, 3))}, {frozenset((0, 1, 3)), frozenset((1, 2, 3))}), "a face of four corners, cut", triangles)
    force, said = last["SENSOR", "ProbeForce"].content, last["STRING", "ProbeForce"].content
    ok(force[:10] == bytes([3, 0]) + bytes.fromhex("02c4000000000000"), "SENSOR: three numbers, in newton", force[:10].hex())
    texts = [float(x) for x in re.search(rb"force (\S+) (\S+) (\S+) N", said).groups()]
    with open(path, encoding="ascii") as f:
        lines = f.read().split("\n")
    own = [float(x) for x in lines[max(i for i, line in enumerate(lines) if line.startswith("array probe.force")) + 1].split()]
    ok(near(struct.unpack(">3d", force[10:]), [-own[0], -own[1], own[2]], 1e-12) and near(texts, [-own[0], -own[1], own[2]], 1e-4) and any(own),
       "the frame's force, in RAS; and as text", [own, said])
    probe = last["TRANSFORM", "ProbeToReference"].matrix()
    ok(near(probe, [-1, 0, 0, 0, -1, 0, 0, 0, 1, -5.5, -4, 1.2]), "ProbeToReference: the frame's pose", probe)
    s = Server()
    s.put(data[: data.index(b"frame 3 ")] + b'fail 3 "msds-run: diverged"\n')
    ok(s.end() == 3 and b"diverged" not in s.said, "a stream that says it failed ends it with its status", s.said)
    s = Server()
    s.put(data[: data.index(b"frame 3 ") + 200])
    ok(s.end() == 1 and s.said.count(b"stdin") == 1, "one that is cut: a line, status 1", s.said)


def try_poses():
    s = Server("--poses", "-")
    c = s.client()
    s.put(b"0 .001 .002 .003 0 0 .70710678 .70710678\nset gain 3\n")
    probe = c.find("TRANSFORM", "ProbeToReference").matrix()
    ok(near(probe, [0, -1, 0, 1, 0, 0, 0, 0, 1, -1, -2, 3]), "poses of lines: the probe's own axes stay its own", probe)
    ok(s.wait(rb"stdin:2: 'set' is no pose") is not None, "what is none is told")
    ok(s.end() == 0 and b"1 poses" in s.said, "their end is the end", s.said)


def try_rest():
    s = Server("--images", "-")
    taken = subprocess.run([TOOL, "--listen", str(s.port), "--images", "-"], input=b"", capture_output=True, timeout=10, check=False)
    ok(taken.returncode == 1 and taken.stderr.count(b"\n") == 1 and b"cannot listen" in taken.stderr, f"a port that is taken: {taken.stderr.decode().strip()}")
    for n in range(200):
        s.put(image(PLANE, 64, 64, n)[0])
    ok(s.end() == 0 and b"200 images; 0 clients" in s.said, "without a client, images are read all the same", s.said)
    s = Server("--images", "-")
    s.put(b"P5\n3 3\n255\n123456789")
    ok(s.end() == 1 and b"image 0 does not say where it lies" in s.said, "an image without a place", s.said)
    s = Server("--images", "-")
    ok(s.end() == 1 and b"no image" in s.said, "no image at all", s.said)


for part in (try_images, try_flow, try_commands, try_slow, try_many, try_model, try_poses, try_rest):
    try:
        part()
    except (OSError, EOFError, subprocess.TimeoutExpired, KeyError, IndexError, AttributeError, struct.error) as wrong:
        ok(False, part.__name__, repr(wrong))
