"""Writes a .vtu again by VTK's own writer: write_vtu.py FROM TO ascii|binary|appended none|zlib raw|base64 32|64 little|big. Exits 77 where this Python has no
VTK."""
import sys

try:
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter
except ImportError:
    sys.exit(77)

source, target, mode, packed, encoded, header, order = sys.argv[1:]
reader = vtkXMLUnstructuredGridReader()
reader.SetFileName(source)
reader.Update()
writer = vtkXMLUnstructuredGridWriter()
writer.SetInputData(reader.GetOutput())
writer.SetFileName(target)
{"ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary, "appended": writer.SetDataModeToAppended}[mode]()
{"none": writer.SetCompressorTypeToNone, "zlib": writer.SetCompressorTypeToZLib}[packed]()
writer.SetEncodeAppendedData(encoded == "base64")
{"32": writer.SetHeaderTypeToUInt32, "64": writer.SetHeaderTypeToUInt64}[header]()
{"little": writer.SetByteOrderToLittleEndian, "big": writer.SetByteOrderToBigEndian}[order]()
sys.exit(writer.Write() != 1)
