"""Compares what `sinew distance --points` wrote with VTK's own distance from each of its vertices to an OBJ of triangles (mm):
prints how many vertices, the largest difference of distances, how many signs differ, and how many have none. For the tests. Exits 77
where this Python has no VTK.
"""
import sys

try:
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance
except ImportError:
    sys.exit(77)

points, cells = vtkPoints(), vtkCellArray()
points.SetDataTypeToDouble()
for line in open(sys.argv[1], encoding="utf-8"):
    word = line.split()
    if word and word[0] == "v":
        points.InsertNextPoint(*map(float, word[1:4]))
    elif word and word[0] == "f":
        cells.InsertNextCell(len(word) - 1)
        for corner in word[1:]:
            cells.InsertCellPoint(int(corner.split("/")[0]) - 1)
surface = vtkPolyData()
surface.SetPoints(points)
surface.SetPolys(cells)
vtk = vtkImplicitPolyDataDistance()
vtk.SetInput(surface)

count = other = none = 0
largest = 0.0
for line in list(open(sys.argv[2], encoding="utf-8"))[1:]:
    value = line.split("\t")
    signed = vtk.EvaluateFunction([float(x) for x in value[1:4]])
    count += 1
    largest = max(largest, abs(abs(signed) - float(value[4])))
    if value[5] == "nan":
        none += 1
    elif abs(signed) > 1e-6 and (signed > 0) != (float(value[5]) > 0):
        other += 1
print(count, f"{largest:.3g}", other, none)
