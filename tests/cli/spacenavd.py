"""A daemon that speaks spacenavd's protocol, for tests: spacenavd.py SOCKET. Each line on standard input is what it does.

motion X Y Z RX RY RZ   an event of the puck           press N, release N   one of a button
newer                   events of types that newer daemons have              half, garbage   what is no event
drop, back              goes away; is there again
At its end it prints how many bytes its clients have sent: a client that asks for protocol 1 is answered as it would be.
"""

import os
import socket
import struct
import sys

path = sys.argv[1]
heard = 0


def serve():
    if os.path.exists(path):
        os.unlink(path)
    s = socket.socket(socket.AF_UNIX)
    s.bind(path)
    s.listen(8)
    return s


def send(client, *words):
    client.sendall(struct.pack("=8i", *(list(words) + [0] * (8 - len(words)))))


def listen_to(client):
    client.setblocking(False)
    try:
        asked = client.recv(4096)
    except BlockingIOError:
        asked = b""
    client.setblocking(True)
    if len(asked) == 4 and struct.unpack("=I", asked)[0] & 0xFFFFFF00 == 0x7FAA5500:
        client.sendall(asked)
    return len(asked)


server = serve()
client, _ = server.accept()
for line in sys.stdin:
    what, *numbers = line.split()
    numbers = [int(n) for n in numbers]
    if what == "motion":
        send(client, 0, *numbers, 16)
    elif what in ("press", "release"):
        send(client, 1 if what == "press" else 2, *numbers, what == "press")
    elif what == "newer":
        for kind in range(3, 12):
            send(client, kind, 1, 2, 3, 4, 5, 6, 7)
    elif what == "half":
        client.sendall(struct.pack("=5i", 0, 350, 350, 350, 350))
    elif what == "garbage":
        client.sendall(bytes(range(200, 232)) * 3)
    elif what == "drop":
        heard += listen_to(client)
        client.close()
        client = None
        server.close()
        os.unlink(path)
    elif what == "back":
        server = serve()
        client, _ = server.accept()
if client:
    heard += listen_to(client)
    os.unlink(path)
print(heard)
