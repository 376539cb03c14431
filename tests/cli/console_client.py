"""A page's part of the conversation with sinew console, for tests: HTTP and a WebSocket over plain sockets."""

import base64
import json
import os
import socket
import struct
import time


def request(port, path, headers=None, method="GET", host=None):
    """One HTTP request: its status, its headers (a text), its body. A header whose value is None is left out."""
    lines = {"Host": host or f"127.0.0.1:{port}", "Connection": "close"}
    lines.update(headers or {})
    text = f"{method} {path} HTTP/1.1\r\n" + "".join(f"{k}: {v}\r\n" for k, v in lines.items() if v is not None) + "\r\n"
    with socket.create_connection(("127.0.0.1", port), timeout=10) as s:
        s.sendall(text.encode())
        got = b""
        while True:
            try:
                more = s.recv(65536)
            except ConnectionResetError:
                more = b""
            if not more:
                break
            got += more
            head, _, _ = got.partition(b"\r\n\r\n")
            if head.startswith(b"HTTP/1.1 101"):
                break
    head, _, body = got.partition(b"\r\n\r\n")
    status = int(head.split()[1]) if head else 0
    return status, head.decode("latin-1"), body


def upgrade(port, path="/live", origin=True, host=None, **more):
    """The status of a WebSocket's handshake. origin: True is the page's own; None: no header."""
    own = host or f"127.0.0.1:{port}"
    headers = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(),
        "Origin": f"http://{own}" if origin is True else origin,
    }
    headers.update(more)
    return request(port, path, headers, host=own)[0]


class Page:
    """A WebSocket. Texts become self.state, self.frame and self.said; of binary messages the newest of a kind is in
    self.binary, and how many came in self.counts."""

    def __init__(self, port, path="/live", buffer=None):
        self.socket = socket.socket()
        if buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
        self.socket.connect(("127.0.0.1", port))
        self.bytes = b""
        self.state, self.frame, self.said, self.saved = None, None, [], []
        self.binary, self.counts = {}, {}
        self.goodbye = None
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n".encode()
        )
        while b"\r\n\r\n" not in self.bytes:
            more = self.socket.recv(65536)
            if not more:
                raise ConnectionError("the handshake was cut short")
            self.bytes += more
        head, _, self.bytes = self.bytes.partition(b"\r\n\r\n")
        if b" 101 " not in head:
            raise ConnectionError(head.decode("latin-1").splitlines()[0])

    def send(self, text, opcode=1, final=True):
        data = text.encode() if isinstance(text, str) else text
        mask = os.urandom(4)
        n = len(data)
        head = bytes([(0x80 if final else 0) | opcode])
        if n < 126:
            head += bytes([0x80 | n])
        elif n < 65536:
            head += bytes([0xFE]) + struct.pack(">H", n)
        else:
            head += bytes([0xFF]) + struct.pack(">Q", n)
        masked = bytes(b ^ mask[i & 3] for i, b in enumerate(data))
        self.socket.sendall(head + mask + masked)

    def _need(self, n, until):
        while len(self.bytes) < n:
            left = until - time.monotonic()
            if left <= 0:
                raise TimeoutError
            self.socket.settimeout(left)
            try:
                more = self.socket.recv(1 << 20)
            except TimeoutError:
                raise TimeoutError from None
            if not more:
                raise ConnectionError("closed")
            self.bytes += more

    def read(self, seconds=10.0):
        """The next message: its opcode and bytes."""
        until = time.monotonic() + seconds
        self._need(2, until)
        n, at = self.bytes[1] & 127, 2
        if n == 126:
            self._need(4, until)
            n, at = struct.unpack(">H", self.bytes[2:4])[0], 4
        elif n == 127:
            self._need(10, until)
            n, at = struct.unpack(">Q", self.bytes[2:10])[0], 10
        self._need(at + n, until)
        opcode, data = self.bytes[0] & 15, self.bytes[at : at + n]
        self.bytes = self.bytes[at + n :]
        self._note(opcode, data)
        return opcode, data

    def _note(self, opcode, data):
        if opcode == 1:
            text = json.loads(data)
            kind = text["type"]
            self.counts[kind] = self.counts.get(kind, 0) + 1
            if kind == "said":
                self.said.append(text)
            elif kind == "saved":
                self.saved.append(text)
            else:
                setattr(self, kind, text)
        elif opcode == 2:
            kind = struct.unpack_from("<I", data)[0]
            self.binary[kind] = data
            self.counts[kind] = self.counts.get(kind, 0) + 1
        elif opcode == 8:
            self.goodbye = struct.unpack_from(">H", data)[0] if len(data) > 1 else 0
            self.send(data, opcode=8)

    def until(self, condition, seconds=10.0):
        """Reads on until condition(self); False where it does not come."""
        end = time.monotonic() + seconds
        while not condition(self):
            try:
                self.read(max(end - time.monotonic(), 0.001))
            except TimeoutError:
                return bool(condition(self))
        return True

    def heard(self, part, seconds=10.0):
        """The first thing said that has this part, or None."""
        find = lambda p: next((s for s in p.said if part in (s["tool"] or "") + ": " + s["text"]), None)
        self.until(find, seconds)
        return find(self)

    def close(self):
        self.socket.close()


def decode_geometry(data):
    """The header, and of each mesh its places and triangles."""
    length = struct.unpack_from("<I", data, 4)[0]
    header = json.loads(data[8 : 8 + length])
    at = 8 + (length + 3) // 4 * 4
    meshes = []
    for mesh in header["meshes"]:
        places = struct.unpack_from(f"<{3 * mesh['vertices']}f", data, at)
        at += 12 * mesh["vertices"]
        corners = struct.unpack_from(f"<{3 * mesh['triangles']}I", data, at)
        at += 12 * mesh["triangles"]
        meshes.append((places, corners))
    assert at == len(data), (at, len(data))
    return header, meshes


def decode_positions(data):
    """The frame, and by mesh id its places (m) and its largest value."""
    frame, count = struct.unpack_from("<II", data, 4)
    at, parts = 12, {}
    for _ in range(count):
        mesh, n = struct.unpack_from("<II", data, at)
        box = struct.unpack_from("<6f", data, at + 8)
        words = struct.unpack_from(f"<{3 * n}h", data, at + 32)
        at += 32 + (6 * n + 3) // 4 * 4
        low, high, values = struct.unpack_from("<ffI", data, at)
        at += 12 + (values + 3) // 4 * 4
        middle = [(box[a] + box[a + 3]) / 2 for a in range(3)]
        half = [(box[a + 3] - box[a]) / 2 for a in range(3)]
        parts[mesh] = ([middle[i % 3] + half[i % 3] * w / 32767 for i, w in enumerate(words)], high)
    assert at == len(data), (at, len(data))
    return frame, parts


def decode_image(data):
    """Index, columns, rows, time, the nine numbers of its plane, the JPEG."""
    index, columns, rows = struct.unpack_from("<III", data, 4)
    values = struct.unpack_from("<10d", data, 16)
    return index, columns, rows, values[0], values[1:], data[96:]
