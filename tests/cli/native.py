"""native.py FILE.nrrd K OUT: the native plane K of a NRRD of one byte or int16 a voxel (gzip or raw) as a pose in OUT.tum and pixels in
OUT.raw; prints the options of us-slice for it."""
import array
import gzip
import math
import re
import sys


def numbers(text):
    return [[float(x) for x in v.split(",")] for v in re.findall(r"\(([^)]*)\)", text)]


def quaternion(r):
    trace = r[0][0] + r[1][1] + r[2][2]
    sizes = [1 + 2 * r[i][i] - trace for i in range(3)] + [1 + trace]
    most = sizes.index(max(sizes))
    if most == 3:
        q = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], sizes[3]]
    else:
        i, j, k = most, (most + 1) % 3, (most + 2) % 3
        q = [0.0] * 4
        q[i], q[j], q[k], q[3] = sizes[most], r[i][j] + r[j][i], r[i][k] + r[k][i], r[k][j] - r[j][k]
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


data = open(sys.argv[1], "rb").read()
plane = int(sys.argv[2])
end = data.index(b"\n\n")
head = data[:end].decode()
body = data[end + 2:]
if re.search(r"^encoding: gzip", head, re.M):
    body = gzip.decompress(body)
size = [int(n) for n in re.search(r"^sizes: (.*)", head, re.M).group(1).split()]
axes = numbers(re.search(r"^space directions: (.*)", head, re.M).group(1))
origin = numbers(re.search(r"^space origin: (.*)", head, re.M).group(1))[0]
kind = {"uint8": "B", "int16": "h"}[re.search(r"^type: (.*)", head, re.M).group(1)]
spacing = [math.sqrt(sum(x * x for x in v)) for v in axes]
x, z = ([c / s for c in v] for v, s in zip(axes[:2], spacing))
y = [z[(i + 1) % 3] * x[(i + 2) % 3] - z[(i + 2) % 3] * x[(i + 1) % 3] for i in range(3)]
place = [(origin[a] + axes[0][a] * (size[0] - 1) / 2 - axes[1][a] / 2 + axes[2][a] * plane) / 1000 for a in range(3)]
turn = quaternion([[x[a], y[a], z[a]] for a in range(3)])
open(sys.argv[3] + ".tum", "w").write("0 " + " ".join("%.17g" % n for n in place + turn) + "\n")
count = size[0] * size[1]
voxels = array.array(kind, body)[count * plane:count * (plane + 1)]
open(sys.argv[3] + ".raw", "wb").write(bytes(voxels.tolist()))
print("--size %dx%d --width %.17gmm --depth %.17gmm" % (size[0], size[1], spacing[0] * size[0], spacing[1] * size[1]))
