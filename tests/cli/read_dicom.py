"""read_dicom.py RAW.NRRD FOLDER: whether the volume is what pydicom finds in the series."""
import os
import re
import sys

import pydicom

with open(sys.argv[1], 'rb') as f:
    header, voxels = f.read().split(b'\n\n', 1)
header = dict(l.split(': ', 1) for l in header.decode().split('\n') if ': ' in l)
vectors = [[float(x) for x in v.split(',')] for v in re.findall(r'\(([^)]*)\)', header['space directions'])]
origin = [float(x) for x in header['space origin'].strip('()').split(',')]
sizes = [int(n) for n in header['sizes'].split()]

files = [pydicom.dcmread(os.path.join(sys.argv[2], n)) for n in os.listdir(sys.argv[2]) if n.endswith('.dcm')]
row, column = [[float(x) for x in files[0].ImageOrientationPatient][i:i + 3] for i in (0, 3)]
normal = [row[1] * column[2] - row[2] * column[1], row[2] * column[0] - row[0] * column[2], row[0] * column[1] - row[1] * column[0]]
files.sort(key=lambda f: sum(n * float(p) for n, p in zip(normal, f.ImagePositionPatient)))
assert sizes == [files[0].Columns, files[0].Rows, len(files)], sizes
worst = 0
for k in (0, len(files) // 2, len(files) - 1):
    for i, j in ((0, 0), (sizes[0] - 1, sizes[1] - 1)):
        here = [origin[a] + i * vectors[0][a] + j * vectors[1][a] + k * vectors[2][a] for a in range(3)]
        there = [float(files[k].ImagePositionPatient[a]) + i * row[a] * float(files[k].PixelSpacing[1]) +
                 j * column[a] * float(files[k].PixelSpacing[0]) for a in range(3)]
        worst = max(worst, max(abs(a - b) for a, b in zip(here, there)))
print('off by at most %g mm' % worst)
assert worst < 2e-3, worst # positions are written to a thousandth
size = len(files[0].PixelData)
for k, f in enumerate(files):
    assert voxels[k * size:(k + 1) * size] == f.PixelData, k
