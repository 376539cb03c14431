"""Prints VTK's own Jacobian of each cell of a .vtu that has been moved: of a hexahedron the smallest volume of the edges at its corners
and of those in its middle, m3; of a tetrahedron six times its volume. For the tests. Exits 77 where this Python has no VTK.
"""
import sys

try:
    from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    sys.exit(77)

reader = vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
measure = vtkMeshQuality()
measure.SetInputConnection(reader.GetOutputPort())
measure.SetHexQualityMeasureToJacobian()
measure.SetTetQualityMeasureToJacobian()
measure.Update()
quality = measure.GetOutput().GetCellData().GetArray("Quality")
for i in range(quality.GetNumberOfTuples()):
    print(repr(quality.GetValue(i)))
