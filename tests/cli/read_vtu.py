"""Reads a .vtu with VTK's own reader and prints what it found, for the tests.

read_vtu.py FILE                 its counts, and the arrays with type and columns
read_vtu.py FILE points          the points, one a line
read_vtu.py FILE cells           the cells: VTK's type, then the points
read_vtu.py FILE KIND NAME       an array of KIND (point, cell or field), one tuple a line

Numbers are as short as they read back. Exits 77 where this Python has no VTK.
"""
import struct
import sys

try:
    from vtkmodules.vtkCommonCore import vtkIdList, vtkOutputWindow, vtkStringArray
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError:
    sys.exit(77)


def number(value, kind):
    if kind == "float":
        texts = ("%.*g" % (digits, value) for digits in range(6, 10))
        return next(t for t in texts if struct.pack("f", float(t)) == struct.pack("f", value))
    text = repr(value)
    return text[:-2] if text.endswith(".0") else text


def rows(array):
    if isinstance(array, vtkStringArray):
        return [array.GetValue(i) for i in range(array.GetNumberOfValues())]
    kind = array.GetDataTypeAsString()
    return [" ".join(number(v, kind) for v in array.GetTuple(i)) for i in range(array.GetNumberOfTuples())]


def cells(grid):
    ids = vtkIdList()
    for cell in range(grid.GetNumberOfCells()):
        grid.GetCellPoints(cell, ids)
        yield " ".join(str(n) for n in [grid.GetCellType(cell)] + [ids.GetId(i) for i in range(ids.GetNumberOfIds())])


def summary(grid, data):
    yield "%d points" % grid.GetNumberOfPoints()
    yield "%d cells" % grid.GetNumberOfCells()
    for kind in ("point", "cell", "field"):
        for i in range(data[kind].GetNumberOfArrays()):
            array = data[kind].GetAbstractArray(i)
            yield "%s %s %s %d" % (kind, array.GetName(), array.GetDataTypeAsString(), array.GetNumberOfComponents())


def main(args):
    problems = []
    vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", lambda *_: problems.append("error"))
    vtkOutputWindow.GetInstance().AddObserver("WarningEvent", lambda *_: problems.append("warning"))
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(args[0])
    reader.Update()
    if problems or reader.GetErrorCode():
        sys.exit("VTK's reader found fault with " + args[0])
    grid = reader.GetOutput()
    data = {"point": grid.GetPointData(), "cell": grid.GetCellData(), "field": grid.GetFieldData()}
    if len(args) == 1:
        lines = summary(grid, data)
    elif args[1] == "points":
        lines = rows(grid.GetPoints().GetData())
    elif args[1] == "cells":
        lines = cells(grid)
    else:
        lines = rows(data[args[1]].GetAbstractArray(args[2]))
    for line in lines:
        print(line)


main(sys.argv[1:])
