"""Reads a .pvd and every file that it names with VTK's own reader: a line for each, its time, its points and cells, and the sum of its points' displacements.
Exits 77 where this Python has no VTK."""
import os
import sys
import xml.dom.minidom

try:
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    sys.exit(77)

path = sys.argv[1]
for item in xml.dom.minidom.parse(path).getElementsByTagName("DataSet"):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(os.path.dirname(path), item.getAttribute("file")))
    reader.Update()
    grid = reader.GetOutput()
    moved = grid.GetPointData().GetArray("displacement")
    time = grid.GetFieldData().GetArray("TimeValue").GetValue(0)
    total = sum(sum(moved.GetTuple(i)) for i in range(moved.GetNumberOfTuples()))
    print("%s %g %d %d %.6g" % (item.getAttribute("timestep"), time, grid.GetNumberOfPoints(), grid.GetNumberOfCells(), total))
