"""viewer.py receive HOST:PORT FOLDER: takes all that `sinew igtl-out` sends, as 3D Slicer would, until it ends; checks every checksum; and writes into
FOLDER images.pgm, poses.tum and, of each surface, NAME.points (x y z, mm, RAS, all points of a message in one line).
viewer.py compare FOLDER IMAGES POSES [NAME=OBJ_PATTERN...]: whether what came is what was made from files. Each image is one of the stream IMAGES
(of us-slice), in its order, to the byte, and where that lies; each pose is one of the file POSES, to the digits of float32; each surface is one of the
files OBJ_PATTERN (as moved_%04d.obj, in mm and LPS), in their order, to .001 mm. Prints a line for each, and ends with status 1 where something differs.
"""
import itertools
import math
import os
import pickle
import sys

import igtl


def receive(address, folder):
    peer, messages = igtl.connect(address), []
    while True:
        message = igtl.receive(peer)
        if message is None:
            break
        messages.append(message)
    bad = sum(not message.is_whole() for message in messages)
    kinds = sorted((kind, device, sum(1 for m in messages if (m.kind, m.device) == (kind, device)))
                   for kind, device in {(m.kind, m.device) for m in messages})
    for kind, device, count in kinds:
        print("viewer: %5d %s %s" % (count, kind, device))
    with open(os.path.join(folder, "messages"), "wb") as file:
        pickle.dump(messages, file)
    print("viewer: %d messages, %d with a wrong checksum" % (len(messages), bad))
    return bad or not messages


def images_in(stream):
    """Of us-slice's stream: size, origin and axes (m, LPS), pixels."""
    while stream.readline():
        numbers = [float(word) for word in stream.readline().split()[2:11]]
        columns, rows = (int(word) for word in stream.readline().split())
        stream.readline()
        yield (columns, rows), numbers, stream.read(columns * rows)


def is_there(matrix, numbers):
    """Whether an image's matrix (pixels to mm, RAS) is what us-slice says of it: the middle of the first pixel, and what a pixel's steps are."""
    origin, column, row = numbers[0:3], numbers[3:6], numbers[6:9]
    flip = (-1, -1, 1)
    return all(abs(matrix[a][k] - flip[a] * 1e3 * vector[a]) < 1e-3 for a in range(3) for k, vector in ((0, column), (1, row), (3, origin)))


def compare_images(messages, path):
    came = [igtl.image_of(m.content) for m in messages if m.kind == "IMAGE"]
    with open(path, "rb") as stream:
        made, same = images_in(stream), 0
        for size, matrix, pixels in came:
            for made_size, numbers, made_pixels in made:
                if made_size == tuple(size[:2]) and made_pixels == pixels and is_there(matrix, numbers):
                    same += 1
                    break
    return report("images", len(came), same, "the same bytes, and in the same place")


def compare_poses(messages, path):
    from tracker import read_poses
    made = read_poses(path)
    came = [igtl.matrix_of(m.content) for m in messages if m.kind == "TRANSFORM" and m.device == "ProbeToReference"]
    places = {}
    for matrix in made:
        places.setdefault(tuple(round(matrix[a][3], 2) for a in range(3)), []).append(matrix)

    def is_one(matrix):
        near = itertools.product(*([round(matrix[a][3] + step, 2) for step in (-.005, 0, .005)] for a in range(3)))
        return any(max(abs(matrix[r][c] - m[r][c]) for r in range(3) for c in range(4)) < 1e-3 for key in near for m in places.get(key, ()))

    return report("poses", len(came), sum(is_one(matrix) for matrix in came), "one of the tracker's")


def points_of(path):
    points = []
    with open(path) as file:
        for line in file:
            if line.startswith("v "):
                x, y, z = (float(word) for word in line.split()[1:4])
                points += [-x, -y, z]
    return points


def compare_surface(messages, name, pattern):
    came = [igtl.surface_of(m.content)[0] for m in messages if m.kind == "POLYDATA" and m.device == name]
    files = itertools.takewhile(os.path.exists, (pattern % i for i in itertools.count()))
    made, same, worst = map(points_of, files), 0, 0.
    for points in came:
        for other in made:
            apart = max((abs(a - b) for a, b in zip(points, other)), default=math.inf) if len(points) == len(other) else math.inf
            if apart < 1e-3:
                same, worst = same + 1, max(worst, apart)
                break
    return report("surfaces %s" % name, len(came), same, "those of the frames, to %.0e mm" % worst)


def report(what, came, same, how):
    print("%s %s: %d received, %d are %s" % ("ok" if came == same and came else "WRONG", what, came, same, how))
    return came != same or not came


def latency(messages, poses, folder):
    """From when the tracker sent a pose until its first image was here: ms."""
    from tracker import read_poses
    made, last, took = read_poses(poses), -1, []
    with open(os.path.join(folder, "sent")) as file:
        sent = [(float(when), int(index)) for when, index in (line.split() for line in file)]
    for message in messages:
        if message.kind != "IMAGE":
            continue
        matrix = igtl.image_of(message.content)[1]
        face = matrix[2][3] - matrix[2][1] / 2  # the middle of the first pixel is half a pixel into the tissue
        when, index = next(((when, i) for when, i in reversed(sent) if when < message.came and abs(face - made[i][2][3]) < 1e-3), (0, -1))
        if index > last:
            took.append(1e3 * (message.came - when))
            last = index
    took = sorted(took[10:])
    if took:
        print("pose sent to image received: median %.1f ms, 95 %% %.1f ms, of %d poses" % (took[len(took) // 2], took[len(took) * 95 // 100], len(took)))


def compare(folder, images, poses, surfaces):
    with open(os.path.join(folder, "messages"), "rb") as file:
        messages = pickle.load(file)
    wrong = compare_images(messages, images) + compare_poses(messages, poses)
    latency(messages, poses, folder)
    return wrong + sum(compare_surface(messages, *surface.split("=", 1)) for surface in surfaces)


if __name__ == "__main__":
    verb, rest = sys.argv[1], sys.argv[2:]
    sys.exit(1 if (receive(*rest) if verb == "receive" else compare(rest[0], rest[1], rest[2], rest[3:])) else 0)
