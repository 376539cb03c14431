"""crossing.py GROUP OBJ: how many pairs of triangles of a group cross, of those that share no vertex, and how deep the deepest do: the least
way along a normal of one of the two, or along a product of two of their edges, that parts them."""
import sys
from collections import defaultdict

import numpy as np

CELL = 3.0  # of the grid in which pairs are looked for, in the OBJ's unit


def read(path, group):
    vertices, faces, name = [], [], None
    with open(path, encoding="ascii") as stream:
        for line in stream:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                vertices.append([float(x) for x in words[1:4]])
            elif words[0] == "g":
                name = words[1]
            elif words[0] == "f" and name == group:
                corner = [int(x.split("/")[0]) - 1 for x in words[1:]]
                faces += [[corner[0], corner[k], corner[k + 1]] for k in range(1, len(corner) - 1)]
    return np.array(vertices), np.array(faces)


def pierces(start, end, triangle):
    one, other, way, away = triangle[1] - triangle[0], triangle[2] - triangle[0], end - start, start - triangle[0]
    across = np.cross(way, other)
    volume = one @ across
    if abs(volume) < 1e-14:
        return False
    turned = np.cross(away, one)
    u, v, at = away @ across / volume, way @ turned / volume, other @ turned / volume
    return u >= 0 and v >= 0 and u + v <= 1 and 0 <= at <= 1


def cross(one, other):
    return any(pierces(a[i], a[i - 2], b) for a, b in ((one, other), (other, one)) for i in range(3))


def depth(one, other):
    edges = [[t[i - 2] - t[i] for i in range(3)] for t in (one, other)]
    ways = [np.cross(e[0], e[1]) for e in edges] + [np.cross(a, b) for a in edges[0] for b in edges[1]]
    least = np.inf
    for way in ways:
        length = np.linalg.norm(way)
        if length > 1e-12:
            a, b = one @ way / length, other @ way / length
            least = min(least, a.max() - b.min(), b.max() - a.min())
    return least


def near_pairs(triangles, faces):
    low, high = triangles.min(1), triangles.max(1)
    cells, pairs = defaultdict(list), set()
    for i in range(len(faces)):
        first, last = np.floor(low[i] / CELL).astype(int), np.floor(high[i] / CELL).astype(int)
        for x in range(first[0], last[0] + 1):
            for y in range(first[1], last[1] + 1):
                for z in range(first[2], last[2] + 1):
                    cells[x, y, z].append(i)
    for inside in cells.values():
        for i, a in enumerate(inside):
            for b in inside[i + 1:]:
                if (low[a] <= high[b]).all() and (low[b] <= high[a]).all() and not set(faces[a]) & set(faces[b]):
                    pairs.add((a, b))
    return pairs


VERTICES, FACES = read(sys.argv[2], sys.argv[1])
TRIANGLES = VERTICES[FACES]
DEPTHS = [depth(TRIANGLES[a], TRIANGLES[b]) for a, b in near_pairs(TRIANGLES, FACES) if cross(TRIANGLES[a], TRIANGLES[b])]
print(len(DEPTHS), round(max(DEPTHS, default=0), 4))
