"""Reads a volume image with VTK's own readers and prints what voxels.c prints: sizes, spacing, origin and a checksum.

read_volume.py FILE              NRRD where its name ends so, else MetaImage

Exits 77 where this Python has no VTK.
"""
import sys
import zlib

try:
    from vtkmodules.vtkIOImage import vtkMetaImageReader, vtkNrrdReader
except ImportError:
    sys.exit(77)

path = sys.argv[1]
reader = vtkNrrdReader() if path.endswith(".nrrd") else vtkMetaImageReader()
reader.SetFileName(path)
reader.Update()
image = reader.GetOutput()
voxels = bytes(memoryview(image.GetPointData().GetScalars()))
print("size", *image.GetDimensions())
print("spacing", *("%.9g" % v for v in image.GetSpacing()))
print("origin", *("%.9g" % v for v in image.GetOrigin()))
print("voxels %08x of %d bytes each" % (zlib.crc32(voxels), image.GetScalarSize()))
