"""The plane of an image of us-slice (PGM) resliced by VTK from a NRRD of one byte or int16 a voxel, gzip or raw; prints the mean and the
largest difference in grey levels, and how many pixels of each are not black. (Debian's VTK comes without numpy.)"""
import array
import gzip
import re
import sys

from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkIOImage import vtkImageImport
from vtkmodules.vtkImagingCore import vtkImageReslice


def cross(a, b):
    return [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def read_nrrd(path):
    data = open(path, "rb").read()
    end = data.index(b"\n\n")
    head = data[:end].decode()
    body = data[end + 2:]
    if re.search(r"^encoding: gzip", head, re.M):
        body = gzip.decompress(body)
    size = [int(n) for n in re.search(r"^sizes: (.*)", head, re.M).group(1).split()]
    kind = {"uint8": "B", "int16": "h"}[re.search(r"^type: (.*)", head, re.M).group(1)]

    def vectors(key):
        text = re.search("^space " + key + ": (.*)", head, re.M).group(1)
        return [[float(x) for x in v.split(",")] for v in re.findall(r"\(([^)]*)\)", text)]

    return array.array(kind, body), size, vectors("directions"), vectors("origin")[0]


def read_pgm(path):
    _, comment, sides, _, body = open(path, "rb").read().split(b"\n", 4)
    place = [1e3 * float(x) for x in comment.decode().split(":")[1].split()]
    columns, rows = (int(n) for n in sides.split())
    return body, columns, rows, place[0:3], place[3:6], place[6:9]


def as_image(voxels, size):
    importer = vtkImageImport()
    text = array.array("d", voxels).tobytes()
    importer.CopyImportVoidPointer(text, len(text))
    importer.SetDataScalarTypeToDouble()
    importer.SetNumberOfScalarComponents(1)
    importer.SetWholeExtent(0, size[0] - 1, 0, size[1] - 1, 0, size[2] - 1)
    importer.SetDataExtentToWholeExtent()
    return importer


voxels, size, axes, origin = read_nrrd(sys.argv[1])
image, columns, rows, corner, column, row = read_pgm(sys.argv[2])
six = dot(axes[0], cross(axes[1], axes[2]))


def to_voxels(v):
    return [dot(v, cross(axes[(i + 1) % 3], axes[(i + 2) % 3])) / six for i in range(3)]


u, v = to_voxels(column), to_voxels(row)
start = to_voxels([a - b for a, b in zip(corner, origin)])
matrix = vtkMatrix4x4()
for j, axis in enumerate((u, v, cross(u, v), start)):
    for i in range(3):
        matrix.SetElement(i, j, axis[i])
source = as_image(voxels, size)
reslice = vtkImageReslice()
reslice.SetInputConnection(source.GetOutputPort())
reslice.SetResliceAxes(matrix)
reslice.SetOutputDimensionality(2)
reslice.SetOutputSpacing(1, 1, 1)
reslice.SetOutputOrigin(0, 0, 0)
reslice.SetOutputExtent(0, columns - 1, 0, rows - 1, 0, 0)
reslice.SetInterpolationModeToLinear()
reslice.SetBackgroundLevel(0)
reslice.Update()
theirs = memoryview(reslice.GetOutput().GetPointData().GetScalars()).cast("B").cast("d").tolist()
off = [abs(a - b) for a, b in zip(theirs, image)]
print("%.4f %.4f %d %d" % (sum(off) / len(off), max(off), sum(p > 0 for p in image), sum(p >= .5 for p in theirs)))
