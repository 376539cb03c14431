"""tracker.py [ADDRESS:]PORT POSES [NAME [RATE]]: a simulated tracker. Serves the poses of a TUM file (s, m, LPS) by OpenIGTLink, as PLUS or 3D Slicer
do: TRANSFORM messages named NAME (ProbeToReference), in RAS mm, RATE (60) a second; to everyone who connects. It says where it listens, waits for the
first, sends all poses once, and ends. --lose FROM,COUNT: says for COUNT poses from the one of index FROM that the probe was not seen, as PLUS does, by
sending none. --again: from the first pose on again, until it is stopped. Writes on standard output, for each pose that it sent: the clock (time.monotonic) and the pose's index."""
import itertools
import select
import socket
import sys
import time

import igtl


def matrix_of_pose(words):
    """In RAS mm: x and y turn round, as LPS and RAS differ by half a turn about z."""
    x, y, z, qx, qy, qz, qw = (float(word) for word in words)
    rows = [[1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw), 1e3 * x],
            [2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw), 1e3 * y],
            [2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy), 1e3 * z]]
    return [[-value for value in rows[0]], [-value for value in rows[1]], rows[2], [0, 0, 0, 1]]


def read_poses(path):
    with open(path) as file:
        lines = [line.split("#")[0].split() for line in file]
    return [matrix_of_pose(words[1:]) for words in lines if len(words) == 8]


def listen(text):
    host, _, port = text.rpartition(":")
    listening = socket.create_server((host or "127.0.0.1", int(port)))
    print("listens at %s:%d" % listening.getsockname()[:2], file=sys.stderr, flush=True)
    return listening


def accept(listening, peers):
    peer = listening.accept()[0]
    peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    peers.append(peer)


def send(peers, data):
    for peer in list(peers):
        try:
            peer.sendall(data)
        except OSError:
            peers.remove(peer)


def main(arguments):
    lost = range(0)
    if arguments[:1] == ["--lose"]:
        first, count = (int(word) for word in arguments[1].split(","))
        lost, arguments = range(first, first + count), arguments[2:]
    again = arguments[:1] == ["--again"]
    arguments = arguments[1:] if again else arguments
    listening, poses = listen(arguments[0]), read_poses(arguments[1])
    name, rate = arguments[2] if len(arguments) > 2 else "ProbeToReference", float(arguments[3]) if len(arguments) > 3 else 60
    peers = []
    accept(listening, peers)
    due = time.monotonic()
    order = itertools.cycle(enumerate(poses)) if again else enumerate(poses)
    for index, matrix in order:
        while select.select([listening], [], [], max(0, due - time.monotonic()))[0]:
            accept(listening, peers)
        if index not in lost:
            sent = time.monotonic()
            send(peers, igtl.message("TRANSFORM", name, igtl.matrix_content(matrix)))
            print("%.6f %d" % (sent, index), flush=True)
        due += 1 / rate
    for peer in peers:
        peer.close()


if __name__ == "__main__":
    main(sys.argv[1:])
