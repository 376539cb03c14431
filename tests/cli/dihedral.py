"""REST.obj MOVED.obj: how much the dihedral angles between neighbouring triangles of the group skin have changed. Prints how many
edges there are, and of how many the angle has changed by more than 10, 20 and 30 degrees."""
import math
import sys


def read(path):
    vertices, triangles, group = [], [], ""
    for line in open(path, encoding="utf-8"):
        word = line.split()
        if line.startswith("v "):
            vertices.append([float(x) for x in word[1:4]])
        elif line.startswith("g "):
            group = word[1]
        elif line.startswith("f ") and group == "skin":
            triangles.append([int(x.split("/")[0]) - 1 for x in word[1:4]])
    return vertices, triangles


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def minus(a, b):
    return [p - q for p, q in zip(a, b)]


def angle(x, a, b, left, right):
    """Between the normals of the triangles a b left and b a right."""
    edge = minus(x[b], x[a])
    p, q = cross(edge, minus(x[left], x[a])), cross(minus(x[right], x[a]), edge)
    return math.atan2(dot(cross(p, q), edge) / math.sqrt(dot(edge, edge)), dot(p, q))


REST, TRIANGLES = read(sys.argv[1])
MOVED, _ = read(sys.argv[2])
across = {(t[i], t[i - 2]): t[i - 1] for t in TRIANGLES for i in range(3)}
changes = []
for (a, b), left in across.items():
    if a < b and (b, a) in across:
        turned = angle(MOVED, a, b, left, across[b, a]) - angle(REST, a, b, left, across[b, a])
        changes.append(abs(math.degrees((turned + math.pi) % (2 * math.pi) - math.pi)))
print(len(changes), *(sum(c > limit for c in changes) for limit in (10, 20, 30)))
