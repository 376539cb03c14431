"""OpenIGTLink's messages in Python's own library alone, from the specification (openigtlink.org): what tracker.py and viewer.py, and tests, speak."""
import socket
import struct
import time

HEADER = struct.Struct(">H12s20sQQQ")


def _table():
    table = []
    for byte in range(256):
        value = byte << 56
        for _ in range(8):
            value = (value << 1 ^ (0x42F0E1EBA9EA3693 if value >> 63 else 0)) & 0xFFFFFFFFFFFFFFFF
        table.append(value)
    return table


TABLE = _table()


def crc(data):
    """CRC-64 of ECMA-182."""
    value = 0
    for byte in data:
        value = (value << 8 & 0xFFFFFFFFFFFFFFFF) ^ TABLE[value >> 56 ^ byte]
    return value


def stamp(seconds):
    return int(seconds) << 32 | int(seconds % 1 * 2**32)


def message(kind, device="", content=b"", when=None, version=1, number=0, metadata=()):
    """The bytes of a message; when: s since 1970, by default now."""
    if version >= 2:
        pairs = [(key.encode(), value.encode()) for key, value in metadata]
        head = struct.pack(">H", len(pairs)) + b"".join(struct.pack(">HHI", len(k), 3, len(v)) for k, v in pairs) if pairs else b""
        data = b"".join(k + v for k, v in pairs)
        content = struct.pack(">HHII", 12, len(head), len(data), number) + content + head + data
    when = time.time() if when is None else when
    return HEADER.pack(version, kind.encode(), device.encode(), stamp(when), len(content), crc(content)) + content


class Message:
    """One that came: kind, device, seconds, version, body, number, content, metadata; came: when, by time.monotonic."""

    def __init__(self, header, body):
        self.came = time.monotonic()
        self.version, kind, device, when, _, self.sum = HEADER.unpack(header)
        self.kind, self.device, self.body = kind.rstrip(b"\0").decode(), device.rstrip(b"\0").decode(), body
        self.seconds, self.number, self.metadata, self.content = when / 2**32, 0, {}, body
        if self.version >= 2:
            self._extended()

    def _extended(self):
        size, head, data, self.number = struct.unpack_from(">HHII", self.body)
        end = len(self.body) - head - data
        self.content = self.body[size:end]
        at = end + head
        for i in range(struct.unpack_from(">H", self.body, end)[0] if head else 0):
            key, _, value = struct.unpack_from(">HHI", self.body, end + 2 + 8 * i)
            self.metadata[self.body[at:at + key].decode()] = self.body[at + key:at + key + value].decode()
            at += key + value

    def is_whole(self):
        return crc(self.body) == self.sum


def _receive(peer, size):
    parts = bytearray()
    while len(parts) < size:
        part = peer.recv(min(size - len(parts), 1 << 20))
        if not part:
            return None
        parts += part
    return bytes(parts)


def receive(peer):
    """The next message; None at the end."""
    header = _receive(peer, HEADER.size)
    body = _receive(peer, HEADER.unpack(header)[4]) if header else None
    return None if body is None else Message(header, body)


def connect(address, seconds=10):
    """A connection to HOST:PORT, for which it waits."""
    host, port = address.rsplit(":", 1)
    until = time.monotonic() + seconds
    while True:
        try:
            peer = socket.create_connection((host, int(port)))
            peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            return peer
        except OSError:
            if time.monotonic() > until:
                raise
            time.sleep(.02)


def matrix_content(matrix):
    """4 x 4, a list of rows, mm: the 3 x 4 numbers of a TRANSFORM, columns first."""
    return struct.pack(">12f", *(matrix[row][column] for column in range(4) for row in range(3)))


def matrix_of(content):
    values = struct.unpack_from(">12f", content)
    return [[values[3 * column + row] for column in range(4)] for row in range(3)] + [[0, 0, 0, 1]]


def image_of(content):
    """Size, 4 x 4 of pixels to mm (the first pixel's middle at 0 0 0), pixels."""
    _, components, scalar, _, space = struct.unpack_from(">HBBBB", content)
    if scalar != 3 or space != 1:
        raise ValueError("an image of type %d in space %d" % (scalar, space))
    size = struct.unpack_from(">3H", content, 6)
    matrix = matrix_of(content[12:60])
    for row in matrix[:3]:
        row[3] -= sum(row[k] * (size[k] - 1) / 2 for k in range(3))
    return size + (components,), matrix, content[72:]


def surface_of(content):
    """Points and triangles, as flat lists."""
    points, _, _, _, _, polygons = struct.unpack_from(">6I", content)
    position = struct.unpack_from(">%df" % (3 * points), content, 40)
    corners = struct.unpack_from(">%dI" % (4 * polygons), content, 40 + 12 * points)
    return position, [corners[i] for i in range(len(corners)) if i % 4]
