"""read_meta.py FILE.nrrd FILE.mha: whether the volumes are the same, as VTK reads them."""
import sys

from vtkmodules.vtkIOImage import vtkMetaImageReader, vtkNrrdReader

both = []
for reader, path in ((vtkNrrdReader(), sys.argv[1]), (vtkMetaImageReader(), sys.argv[2])):
    reader.SetFileName(path)
    reader.Update()
    both.append(reader.GetOutput())
a, b = both
assert a.GetDimensions() == b.GetDimensions(), (a.GetDimensions(), b.GetDimensions())
assert all(abs(x - y) < 1e-9 for x, y in zip(a.GetSpacing(), b.GetSpacing())), (a.GetSpacing(), b.GetSpacing())
# what VTK's NRRD reader makes of the origin differs by version: the header is asked instead
with open(sys.argv[1], 'rb') as f:
    line = [l for l in f.read(1000).split(b'\n') if l.startswith(b'space origin')][0].decode()
origin = [float(x) for x in line.split('(')[1].strip(')').split(',')]
assert all(abs(x - y) < 1e-6 for x, y in zip(origin, b.GetOrigin())), (origin, b.GetOrigin())
x, y = a.GetPointData().GetScalars(), b.GetPointData().GetScalars()
assert x.GetNumberOfValues() == y.GetNumberOfValues()
assert all(x.GetValue(i) == y.GetValue(i) for i in range(0, x.GetNumberOfValues(), 7))
