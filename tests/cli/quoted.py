"""Every input's words damaged one by one: quoted.py FOLDER [all], which has block.sinew (voxels, muscle) and tets.sinew. Says each message
whose quotes hold a word that the input does not, before what was expected; at the end how many messages had quotes."""
import os, re, subprocess, sys

folder, every = sys.argv[1], len(sys.argv) > 2
os.chdir(folder)
CUBE = """v 0 0 0
v 10 0 0
v 10 10 0
v 0 10 0
v 0 0 10
v 10 0 10
v 10 10 10
v 0 10 10
g Skin_A
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""
INP = """*NODE, NSET=NAll
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
*ELEMENT, TYPE=C3D4, ELSET=EAll
1, 1, 2, 3, 4
*NSET, NSET=Held
1, 2
*NSET, NSET=More
Held, 3
*MATERIAL, NAME=MySteel
*ELASTIC
3000., 0.4
*SOLID SECTION, ELSET=EAll, MATERIAL=MySteel
*BOUNDARY
Held, 1, 3
"""
MSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
3 1 "Liver"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$EndNodes
$Elements
1
1 4 2 1 1 1 2 3 4
$EndElements
"""
VTU = """<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">
<UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1">
<Points>
<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray>
</Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray>
</Cells>
</Piece>
</UnstructuredGrid>
</VTKFile>
"""
MODEL = """%sinew 1 text
meta source.unit "mm"
prov by-hand 1 ""
axis node 4
axis element 1
array node.position f64 m node 3
0 0 0
0.1 0 0
0 0.1 0
0 0 0.1
array element.node i32 @node element 4
0 1 2 3
frame 0 0.5
array node.displacement f64 m node 3
0 0 0
0 0 0
0 0 0
0 0 -0.01
end
"""
NRRD = """NRRD0004
type: uint8
dimension: 3
space: left-posterior-superior
sizes: 3 3 3
space directions: (1,0,0) (0,1,0) (0,0,1)
space origin: (0,0,0)
space units: "mm" "mm" "mm"
kinds: domain domain domain
line skip: 0
byte skip: 0
encoding: ascii
Segment0_Name:=Vein
Segment0_LabelValue:=1

""" + "0 1 2 " * 9 + "\n"
META = """ObjectType = Image
NDims = 3
BinaryData = False
CompressedData = False
TransformMatrix = 1 0 0 0 1 0 0 0 1
Offset = 0 0 0
ElementSpacing = 1 1 1
DimSize = 3 3 3
ElementNumberOfChannels = 1
ElementType = MET_UCHAR
ElementDataFile = LOCAL
""" + "0 1 2 " * 9 + "\n"
SWEEP = """ObjectType = Image
NDims = 3
DimSize = 2 2 2
ElementSpacing = 1 1 1
ElementType = MET_UCHAR
BinaryData = False
UltrasoundImageOrientation = MF
Seq_Frame0000_ImageToReferenceTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1
Seq_Frame0000_ImageToReferenceTransformStatus = OK
Seq_Frame0000_Timestamp = 0
Seq_Frame0001_ImageToReferenceTransform = 1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1
Seq_Frame0001_ImageToReferenceTransformStatus = OK
Seq_Frame0001_Timestamp = .1
ElementDataFile = LOCAL
1 2 3 4 5 6 7 8
"""
POSES = "0 .04 .04 .05 1 0 0 0\nmethod fem\n.1 .04 .04 .045 1 0 0 0\n"
BODY = "volume move=10cm,0,1.2m turn=0,0,0.7071068,0.7071068\nsurface cube.obj unit=mm move=0,0,2mm\n"
VOLUMES = "Flesh level=0 priority=0 material=Soft surfaces=Skin_A muscle=no\n"
MATERIALS = "Soft law=neo-hookean E=3000 nu=0.49 density=1000 peak=30000\n"
LAYERS = "Upper thickness=2mm material=Soft\nLower thickness=3mm\n"
SCRIPT = "0 contract A 0\n.1 contract A .4\n0 gravity 0,0,-9.81\n.1 force 0,0,0 2cm 0,0,1\n0 displace 0,0,0,1,1,1 0,-,-\n"

open("cube.obj", "w").write(CUBE)
open("right.materials", "w").write(MATERIALS)
open("right.nrrd", "w").write(NRRD)
open("none.tum", "w").write("0 0 0 0 0 0 0 1\n")
VOXELISE = ["voxelise", "-q", "--unit", "mm", "-s", "5"]
CASES = [  # name, text, command, standard input
    ("x.obj", CUBE, VOXELISE + ["x.obj"], None),
    ("x.inp", INP, ["sinew-import", "-q", "--unit", "m", "x.inp"], None),
    ("y.inp", INP, ["sinew-import", "-q", "--unit", "m", "--materials", "two.materials", "y.inp"], None),
    ("x.msh", MSH, ["sinew-import", "-q", "--unit", "m", "x.msh"], None),
    ("x.vtu", VTU, ["sinew-import", "-q", "--unit", "m", "x.vtu"], None),
    ("x.sinew", MODEL, ["sinew-info", "x.sinew"], None),
    ("x.nrrd", NRRD, ["us-surface", "-q", "-i", "1", "x.nrrd"], None),
    ("x.mha", META, ["us-surface", "-q", "-i", "1", "x.mha"], None),
    ("s.mha", SWEEP, ["us-import", "-v", "--voxel", "1mm", "s.mha"], None),
    ("x.tum", POSES, ["msds-run", "-q", "-d", "cpu", "--probe", "sphere:1cm", "--poses", "x.tum"], "tets.sinew"),
    ("x.body", BODY, ["us-slice", "-q", "--rigid", "--poses", "none.tum", "--body", "x.body", "right.nrrd"], None),
    ("x.volumes", VOLUMES, VOXELISE + ["--materials", "right.materials", "--volumes", "x.volumes", "cube.obj"], None),
    ("x.materials", MATERIALS, VOXELISE + ["--materials", "x.materials", "cube.obj"], None),
    ("y.materials", MATERIALS, ["tled-run", "-q", "-d", "cpu", "-n", "1", "--materials", "y.materials"], "block.sinew"),
    ("x.layers", LAYERS, VOXELISE + ["--materials", "right.materials", "--layers", "x.layers", "cube.obj"], None),
    ("x.script", SCRIPT, ["tled-run", "-q", "-d", "cpu", "-n", "1", "--script", "x.script"], "block.sinew"),
]
ONLY = {"y.inp": "SECTION|MATERIAL", "s.mha": "Ultrasound|Frame0001|NDims"}  # the other lines are another case's
open("two.materials", "w").write("One E=3000\nTwo E=3000\n")


def damaged(text, only):
    """Each line but those of another's shape: without it, without its last word, twice, with one more; its words in turn others."""
    lines, shapes = text.split("\n")[:-1], set()
    for i, line in enumerate(lines):
        shape = re.sub(r"[\d.]+", "0", line)
        if shape in shapes or not re.search(only, line):
            continue
        shapes.add(shape)
        around = lambda new: "\n".join(lines[:i] + new + lines[i + 1:]) + "\n"
        words = re.findall(r"\S+\s*", line)
        yield around([])
        yield around([line, line])
        yield around([line + " Extra"])
        yield around(["".join(words[:-1])])
        for k in range(min(len(words), 4 if every else 2)):
            for other in ("Zz9", "-1") if every else ("Zz9",):
                changed = re.sub(r"=[\w.+-]*", "=" + other, words[k])
                if changed == words[k]:
                    changed = re.sub(r"[\w.+-]+", other, words[k], count=1)
                yield around(["".join(words[:k] + [changed] + words[k + 1:])])


quoted = wrong = 0
for name, text, command, given in CASES:
    kinds = set()
    for bad in dict.fromkeys(damaged(text, ONLY.get(name, ""))):
        open(name, "w").write(bad)
        source = open(given) if given else subprocess.DEVNULL
        done = subprocess.run(command, stdin=source, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=20)
        said = done.stderr.decode("utf-8", "replace").strip().split("\n")[-1]
        kind = re.sub(r"[\d.]+", "0", said)
        if done.returncode != 1 or kind in kinds:
            continue
        kinds.add(kind)
        before = re.split(r"[;:] expected|; did you mean|; there is", said)[0]
        for word in re.findall(r"(?<!\w)'([^']*)'", before):
            quoted += 1
            if not word or word not in bad:
                wrong += 1
                print(f"{name}: {said}")
print(f"{quoted > (60 if every else 40) and 'many' or quoted} quotes, {wrong} wrong")
