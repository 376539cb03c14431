"""Meshes whose vertices are within a rounding of voxel centres, in units that doubles do not hold exactly, voxelised and
compared cell by cell with whole numbers of any size: each coordinate is the double that it is, a centre is origin + offset
+ (2 i + 1) spacing / 2 without rounding, moved by (e, e^2, e^3) with e = 2^-400, and a ray from it runs askew.
Prints one line of TAP a kind of mesh."""
import itertools
import math
import os
import random
import subprocess
import sys

BITS = 110  # every coordinate is a whole number of 2^-BITS
MOVE = 400


def whole(x):
    n, d = x.as_integer_ratio()
    assert (1 << BITS) % d == 0
    return (n << BITS) // d


def sign(x):
    return (x > 0) - (x < 0)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def inside(triangles, p, ray=(100003, 79193, -90001)):
    count = 0
    for t in triangles:
        to = [[(v[a] << (1 + 3 * MOVE)) - p[a] for a in range(3)] for v in t]
        n = cross([t[1][a] - t[0][a] for a in range(3)], [t[2][a] - t[0][a] for a in range(3)])
        if sign(dot(n, to[0])) * sign(dot(n, ray)) <= 0:
            continue
        s = [sign(dot(ray, cross(to[i], to[(i + 1) % 3]))) for i in range(3)]
        count += s[0] != 0 and s[0] == s[1] == s[2]
    return count % 2 == 1


def nudge(x, rng):
    for _ in range(rng.randrange(3)):
        x = math.nextafter(x, rng.choice((-math.inf, math.inf)))
    return x


def solid(rng, value):
    """Vertices and triangles of a closed mesh; value(axis, i) is a coordinate at or near centre i."""
    kind = rng.randrange(3)
    if kind == 0:
        v = [[value(a, rng.randrange(6)) for a in range(3)] for _ in range(4)]
        return v, [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]
    if kind == 1:  # a box; edges may be cut along either diagonal
        lo = [rng.randrange(4) for _ in range(3)]
        hi = [rng.randrange(lo[a] + 1, 6) for a in range(3)]
        ends = [[value(a, lo[a]), value(a, hi[a])] for a in range(3)]
        v = [[ends[0][i & 1], ends[1][i >> 1 & 1], ends[2][i >> 2]] for i in range(8)]
        f = []
        for q in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
            k = rng.randrange(2)
            f += [(q[k], q[k + 1], q[k + 2]), (q[k], q[k + 2], q[(k + 3) % 4])]
        return v, f
    c = [rng.randrange(2, 4) for _ in range(3)]  # an octahedron
    v = [[value(a, c[a] + (0 if a != b else s * 2)) for a in range(3)] for b in range(3) for s in (-1, 1)]
    return v, [(x, 2 + y, 4 + z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]


def write(path, v, f):
    with open(path, "w", encoding="ascii") as out:
        for p in v:
            out.write("v %r %r %r\n" % tuple(p))
        for t in f:
            out.write("f %d %d %d\n" % tuple(i + 1 for i in t))


def cells_of(path, options):
    run = subprocess.run(["voxelise", "-q", "--text", "--unit", "m", *options, path], capture_output=True, text=True,
                         check=False)
    if run.returncode:
        return set() if "no voxel has its centre inside" in run.stderr else None
    lines = run.stdout.split("\n")
    at = next(i for i, line in enumerate(lines) if line.startswith("array element.lattice "))
    rows = itertools.takewhile(lambda line: line[:1] in "-0123456789", lines[at + 1:])
    return {tuple(map(int, line.split())) for line in rows}


def reference(v, f, origin, offset, spacing, low):
    triangles = [[[whole(x) for x in v[i]] for i in t] for t in f]
    found = set()
    for cell in itertools.product(range(-1, 8), repeat=3):
        p = []
        for a in range(3):  # twice the centre, since half a spacing may not be whole
            double = 2 * whole(origin[a]) + 2 * whole(offset[a]) + (2 * (low[a] + cell[a]) + 1) * whole(spacing[a])
            p.append((double << (3 * MOVE)) + (1 << (1 + MOVE * (2 - a))))
        if inside(triangles, p):
            found.add(tuple(low[a] + cell[a] for a in range(3)))
    return found


def try_kind(rng, path, base, h, low, placed):
    spacing = [h, h * rng.choice((1, 0.7)), h]
    origin = [b * h for b in base]
    value = lambda a, i: nudge(origin[a] + (2 * (low[a] + i) + 1) * (spacing[a] / 2), rng)
    v, f = solid(rng, value)
    write(path, v, f)
    options = ["-s", ",".join(map(repr, spacing))]
    offset = [0.0] * 3
    if placed:
        options += ["--origin", ",".join(map(repr, origin))]
        return cells_of(path, options) == reference(v, f, origin, offset, spacing, low)
    for a in range(3):  # the lattice that the surface places
        least, most = min(p[a] for p in v), max(p[a] for p in v)
        cells = max(1, math.ceil((most - least) / spacing[a] - 1e-6))
        origin[a], offset[a] = least, (most - least - cells * spacing[a]) / 2
    return cells_of(path, options) == reference(v, f, origin, offset, spacing, [0, 0, 0])


def main():
    path = os.path.join(sys.argv[1], "exact.obj")
    meshes = int(sys.argv[2])
    kinds = (("tenths", (0, 0, 0), 0.1, (0, 0, 0), True), ("far", (0.3, 1e5, -1e3), 0.1, (7, -9, 0), True),
             ("far indices", (0, 0.3, 0), 1.0 / 3, (1000000, -2000000, 12345), True),
             ("micrometres in metres", (0.1, 0, -3), 1e-6, (0, 5, 0), True),
             ("placed by the surface", (0, 7.7, 1e4), 0.1, (0, 0, 0), False))
    for number, (name, base, h, low, placed) in enumerate(kinds, int(sys.argv[3])):
        rng = random.Random(number)
        wrong = sum(not try_kind(rng, path, base, h, low, placed) for _ in range(meshes))
        print("%s %d - %s: %d of %d meshes differ from whole numbers"
              % ("not ok" if wrong else "ok", number, name, wrong, meshes))


main()
