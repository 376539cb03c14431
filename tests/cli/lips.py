"""Of a bound model of the real face in text, on standard input: on which lip vertices of the mouth are bound. A vertex of the upper lip
faces down, one of the lower lip up; an element is of the lip that it hangs together with by faces, in front of the teeth and within
18.5 mm of the middle. Prints how many are bound to their own lip, and how many to the other."""
import sys


def read(stream):
    arrays, meta, name = {}, {}, None
    for line in stream:
        if line[0].isalpha():
            word = line.split(maxsplit=2)
            name = word[1] if word[0] == "array" else None
            if name:
                arrays[name] = []
            elif word[0] == "meta":
                meta[word[1]] = word[2].strip().strip('"')
        elif name:
            arrays[name].append(line.split())
    return arrays, meta


def numbers(rows, kind):
    return [[kind(x) for x in row] for row in rows]


ARRAYS, META = read(sys.stdin)
ORIGIN = [float(x) for x in META["lattice.origin"].split()]
SIDE = float(META["lattice.spacing"].split()[0])
NODES = numbers(ARRAYS["element.node"], int)
MIDDLE = [[o + (c + .5) * SIDE for o, c in zip(ORIGIN, cell)] for cell in numbers(ARRAYS["element.lattice"], int)]
FACES = (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7), (0, 3, 7, 4), (1, 2, 6, 5)
above = {}


def root(element):
    while above[element] != element:
        above[element] = above[above[element]]
        element = above[element]
    return element


def join_elements():
    first = {}
    for element, (x, y, z) in enumerate(MIDDLE):
        if abs(x) > .0185 or y < .06 or not -.095 < z < -.07:
            continue
        above[element] = element
        for face in FACES:
            key = tuple(sorted(NODES[element][i] for i in face))
            above[root(element)] = root(first.setdefault(key, element))


def normals(surface, position):
    sums = [[0, 0, 0] for _ in position]
    start = [int(row[0]) for row in ARRAYS[surface + "/face.start"]]
    vertex = [int(row[0]) for row in ARRAYS[surface + "/face.vertex"]]
    group = [int(row[0]) for row in ARRAYS[surface + "/face.group"]]
    skin = [row[0].strip('"') for row in ARRAYS[surface + "/group.name"]].index("skin")
    for face, (begin, end) in enumerate(zip(start, start[1:] + [len(vertex)])):
        p, q, r = (position[v] for v in vertex[begin:begin + 3])
        u, w = [b - a for a, b in zip(p, q)], [b - a for a, b in zip(p, r)]
        for v in vertex[begin:end] if group[face] == skin else []:
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                sums[v][i] += u[j] * w[k] - u[k] * w[j]
    return sums


def count(surface):
    position = numbers(ARRAYS[surface + "/vertex.position"], float)
    element = [int(row[0]) for row in ARRAYS[surface + "/vertex.element"]]
    upper = {root(e) for e in above if MIDDLE[e][2] > -.07 - SIDE}
    lower = {root(e) for e in above if MIDDLE[e][2] < -.095 + SIDE}
    own = other = 0
    for v, normal in enumerate(normals(surface, position)):
        x, y, z = position[v]
        if abs(x) > .018 or y < .062 or not -.087 < z < -.077 or element[v] not in above:
            continue
        if 2 * abs(normal[2]) <= sum(n * n for n in normal) ** .5:
            continue
        right = root(element[v]) in (lower if normal[2] > 0 else upper)
        wrong = root(element[v]) in (upper if normal[2] > 0 else lower)
        own += right and not wrong
        other += wrong
    return own, other


join_elements()
print(*count(META["slits.surface"]))
