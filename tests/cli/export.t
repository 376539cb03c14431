#!/bin/sh
# sinew export: VTU as VTK's own reader sees it, Abaqus input, OBJ; and what it says to nonsense.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

small=tests/cli/small.sinew

# array NAME FRAME: the rows of an array of the small model, as written there (frame 0: the body; 1, 2: a frame).
array() {
    awk -v name="$1" -v want="$2" '
        /^(array|frame|end)/ { on = 0 }
        /^frame/ { frame++ }
        on { print }
        $1 == "array" && $2 == name && frame + 0 == want { on = 1 }' "$small" | tr -d '"'
}

python=
for p in python3 /usr/bin/python3; do
    "$p" -c 'import vtkmodules.vtkIOXML' 2>/dev/null && python=$p && break
done

# vtk NAME WANT FILE ARGS...: what VTK reads.
vtk() {
    vtk_name=$1 vtk_want=$2
    shift 2
    if [ -z "$python" ]; then
        skip 1 "no VTK for Python (python3-vtk9): $vtk_name"
    else
        is "$("$python" tests/cli/read_vtu.py "$@" 2>&1)" "$vtk_want" "VTK reads $vtk_name"
    fi
}

# VTU of the elements.
check "a VTU" sinew export -f vtu -o "$T/a.vtu" "$small"
vtk "what there is" "12 points
2 cells
point displacement double 3
point rigid unsigned char 1
point anchor int 1
point x-heat float 1
cell lattice int 3
cell volume int 1
cell fibre float 3
cell material int 1
cell quality.j.centre double 1
cell quality.j.corner double 1
field TimeValue double 1
field volume.name string 1
field material.name string 1
field anchor.name string 1" "$T/a.vtu"
vtk "points at rest" "$(array node.position 0)" "$T/a.vtu" points
vtk "hexahedra" "$(array element.node 0 | sed 's/^/12 /')" "$T/a.vtu" cells
vtk "the last frame's displacement" "$(array node.displacement 2)" "$T/a.vtu" point displacement
vtk "rigid nodes" "$(array node.rigid 0)" "$T/a.vtu" point rigid
vtk "anchors" "$(array node.anchor 0)" "$T/a.vtu" point anchor
vtk "a user's array" "$(array x-heat 0)" "$T/a.vtu" point x-heat
vtk "volumes" "$(array element.volume 0)" "$T/a.vtu" cell volume
vtk "fibres" "$(array element.fibre 0)" "$T/a.vtu" cell fibre
vtk "materials of elements" "0
1" "$T/a.vtu" cell material
vtk "names of volumes" "$(array volume.name 0)" "$T/a.vtu" field volume.name
vtk "the time" 0.5 "$T/a.vtu" field TimeValue
check "points moved" sinew export -f vtu --deformed -o "$T/a.vtu" "$small"
if [ -n "$python" ]; then
    is "$("$python" tests/cli/read_vtu.py "$T/a.vtu" points | sed -n 3p)" "0.23 0 0.04" "the node stands where it moved to"
else
    skip 1 "no VTK for Python"
fi
check "the first frame" sinew export -f vtu --frame 0 -o "$T/a.vtu" "$small"
vtk "the first frame's displacement" "$(array node.displacement 1)" "$T/a.vtu" point displacement
check "at rest" sinew export -f vtu --frame rest -o "$T/a.vtu" "$small"
if [ -n "$python" ]; then
    is "$("$python" tests/cli/read_vtu.py "$T/a.vtu" | grep -c -e displacement -e TimeValue)" 0 "at rest there is no displacement and no time"
else
    skip 1 "no VTK for Python"
fi
is "$(sinew export -f vtu "$small" | head -c 5)" "<?xml" "to standard output"

# A body past one block of compression, and tetrahedra.
awk 'BEGIN {
    n = 60000
    print "%sinew 1 text\naxis node " n "\naxis element " n / 4 "\narray node.position f64 m node 3"
    for (i = 0; i < n; i++) print i / 8, (i * 7919) % 1009, -i
    print "array element.node i32 @node element 4"
    for (i = 0; i < n; i += 4) print i, i + 1, i + 2, i + 3
    print "end" }' >"$T/large"
check "a VTU of several blocks" sinew export -f vtu -o "$T/large.vtu" "$T/large"
vtk "all of its points" "$(sed -n '5,60004p' "$T/large")" "$T/large.vtu" points
vtk "all of its tetrahedra" "$(sed -n '60006,75005s/^/10 /p' "$T/large")" "$T/large.vtu" cells

# A surface.
check "a surface" sinew export -f vtu --surface s -o "$T/s.vtu" "$small"
vtk "the surface's faces" "9 0 1 2 3
3 0 3" "$T/s.vtu" cells
vtk "its vertices at rest" "$(array s/vertex.position 0)" "$T/s.vtu" points
vtk "its groups" "$(array s/face.group 0)" "$T/s.vtu" cell group
vtk "the names of groups" "$(array s/group.name 0)" "$T/s.vtu" field s/group.name
# By equation (1): vertices 0 to 2 lie on nodes 0, 2 and 5, vertex 3 in the middle of the side between the elements.
vtk "its vertices' displacement" "0 0 0
0.03 0 0.04
0.02 0 0
0.01 0 0" "$T/s.vtu" point displacement

# Frames.
check "all frames" sinew export -f vtu --frame all -o "$T/run.pvd" "$small"
is "$(cd "$T" && echo run*)" "run.pvd run_0000.vtu run_0001.vtu" "a collection and a file a frame"
is "$(grep -c '<DataSet timestep="0" group="" part="0" file="run_0000.vtu"/>' "$T/run.pvd")" 1 "the first frame's time and file"
is "$(grep -c '<DataSet timestep="0.5" group="" part="0" file="run_0001.vtu"/>' "$T/run.pvd")" 1 "the second's"
vtk "the second frame" "$(array node.displacement 2)" "$T/run_0001.vtu" point displacement
if [ -n "$python" ]; then
    is "$("$python" tests/cli/read_pvd.py "$T/run.pvd" | tr '\n' ';')" "0 0 12 2 0;0.5 0.5 12 2 0.17;" \
        "VTK reads each file of the collection: times, points, cells, displacement"
else
    skip 1 "no VTK for Python (python3-vtk9): the collection's files"
fi
have python3 && check "the collection is XML" python3 -c "import sys, xml.dom.minidom as x; x.parse(sys.argv[1])" "$T/run.pvd"
{ sed '$d' "$small" && echo 'fail 3 "tled-run: it diverged"'; } >"$T/failed"
cat "$T"/run* >"$T/before"
sinew export -f vtu --frame all --deformed -o "$T/run.pvd" <"$T/failed" 2>"$T/stderr"
is "$?:$(cat "$T/stderr")" "3:" "a later run that fails"
cat "$T"/run* >"$T/after"
check "leaves the files of the earlier one as they were" cmp "$T/before" "$T/after"
is "$(cd "$T" && echo .sinew*)" ".sinew*" "and nothing beside them"
chmod 600 "$T/run_0000.vtu"
ln -s "$T/run_0001.vtu" "$T/link_0001.vtu"
check "a later run that goes well" sinew export -f vtu --frame all --deformed -o "$T/run.pvd" "$small"
is "$(find "$T/run_0000.vtu" -perm 600 | wc -l)" 1 "keeps the permissions of what it replaces"
is "$(cat "$T"/run* | cmp -s - "$T/before"; echo $?)" 1 "and replaces it"
check "a name that is a link" sinew export -f vtu --frame all -o "$T/link.pvd" "$small"
check "stays a link" test -L "$T/link_0001.vtu"
ln -s "$T/none_0001.vtu" "$T/to_none_0001.vtu"
check "a link to nothing yet" sinew export -f vtu --frame all -o "$T/to_none.pvd" "$small"
check "stays one, to a file now" test -L "$T/to_none_0001.vtu" -a -f "$T/none_0001.vtu"
ln -s loop_0001.vtu "$T/loop_0001.vtu"
fails 1 "links without end" "loop_0001.vtu: cannot create: Too many levels" sinew export -f vtu --frame all -o "$T/loop.pvd" "$small"
mkdir "$T/way_0001.vtu"
fails 1 "a folder in the way" "way_0001.vtu: is not a regular file" sinew export -f vtu --frame all -o "$T/way.pvd" "$small"
is "$(cd "$T" && echo way* .sinew*)" "way_0001.vtu .sinew*" "leaves nothing else"
fails 1 "all frames into a folder that is not there" "nonesuch/x.pvd: cannot create: No such file" \
    sinew export -f vtu --frame all -o "$T/nonesuch/x.pvd" "$small"
mkdir "$T/a & b"
check "a name with &" sinew export -f vtu --frame all -o "$T/a & b/x & y.pvd" "$small"
is "$(grep -c 'file="x &#38; y_0001.vtu"' "$T/a & b/x & y.pvd")" 1 "XML's own characters are escaped"

# Abaqus input.
check "Abaqus input" sinew export -f inp -g 0,3,-4 -o "$T/a.inp" "$small"
for line in '^12, 0.2, 0.1, 0.1$' '^\*ELEMENT, TYPE=C3D8R, ELSET=EALL$' '^2, 2, 3, 6, 5, 8, 9, 12, 11$' \
    '^\*ELSET, ELSET=V_MUSCLE_A$' '^1, 4, 7, 10$' '^RIGID, 1, 3$' '^\*MATERIAL, NAME=M_TISSUE_2$' \
    '^517.2413793103449, 0.0002$' '^EALL, GRAV, 5, 0, 0.6, -0.8$' \
    '^\*SOLID SECTION, ELSET=V_MUSCLE_A, MATERIAL=M_TISSUE_2$'; do
    check "it has $line" grep -q -- "$line" "$T/a.inp"
done
check "another element" sh -c "sinew export -f inp --element C3D8 $small | grep -q TYPE=C3D8,"
is "$(sinew export -f inp "$small" | grep -c DLOAD)" 0 "no gravity, no load"
is "$(sinew export -f inp -z "$small" | gzip -dc | head -n 1)" "*HEADING" "-z"
sed 's/^0.1 0 0$/-0.012345678901234567 1e-300 -1.2345678901234567e-05/' "$small" >"$T/long"
is "$(sinew export -f inp "$T/long" | sed -n 's/^2, //p' | sed -n 1p)" \
    "-0.01234567890123457, 1e-300, -1.2345678901235e-05" "no number is past 20 characters"
sed 's/"muscle_a"/"m\xc3\xbc 1,\*"/; s/"skin"/"M\xc3\xbc-1  "/' "$small" >"$T/names"
is "$(sinew export -f inp "$T/names" | grep -c -e '^\*ELSET, ELSET=V_M___1__$' -e '^\*ELSET, ELSET=V_M___1___2$')" 2 \
    "names are made valid and kept apart"
awk '/^axis volume 2/ { print "axis volume 3"; next }
    { print }
    /^"muscle_a"/ { print "\"none\"" }
    $1 == "array" && $2 ~ /^volume\.(level|priority|material|muscle)$/ { print 0 }' "$small" >"$T/hollow"
fails 0 "a volume without elements is named" "warning: volume none has no elements" sinew export -f inp -o "$T/a.inp" "$T/hollow"
is "$(grep -c V_NONE "$T/a.inp")" 0 "and has no section"
if have ccx; then
    sinew export -f inp -g 0,0,-9.81 -o "$T/ccx.inp" "$small"
    check "CalculiX runs it" sh -c "cd '$T' && ccx -i ccx"
    is "$(grep -c '^ *[0-9]' "$T/ccx.dat")" 12 "and prints the displacement of every node"
    awk -f tests/cli/read_frd.awk "$T/ccx.frd" >"$T/frd"
    is "$(sed -n 's/^node [0-9]* //p' "$T/frd")" "$(array node.position 0)" "it has read the same nodes"
    is "$(sed -n 's/^element [0-9]* //p' "$T/frd")" "$(array element.node 0 | awk '{ for (i = 1; i <= NF; i++) printf "%d%s", $i + 1, i < NF ? " " : "\n" }')" \
        "and the same elements"
else
    skip 4 "no CalculiX (calculix-ccx)"
fi

# Gmsh.
check "MSH" sinew export -f msh --frame all -o "$T/a.msh" "$small"
is "$(sed -n '/^.Nodes/,/^.EndNodes/s/^[0-9]* \(.* .*\)$/\1/p' "$T/a.msh")" "$(array node.position 0)" "its nodes"
is "$(sed -n 's/^[0-9]* 5 2 \([0-9]*\) [0-9]* .*/\1/p' "$T/a.msh" | awk '{ print $1 - 1 }')" "$(array element.volume 0)" "its hexahedra, by volumes"
is "$(grep -c NodeData "$T/a.msh")" 4 "a frame each"
is "$(sinew export -f msh --frame rest "$small" | grep -c NodeData)" 0 "at rest there is none"
is "$(sinew export -f msh -z "$small" | gzip -dc | grep -c '^.NodeData')" 1 "the last by itself; -z"
if have gmsh; then
    printf 'Merge "%s";\nSave View[0] "%s";\nExit;\n' "$T/a.msh" "$T/a.pos" >"$T/a.geo"
    check "Gmsh reads it" sh -c "gmsh -v 3 '$T/a.geo' - >'$T/gmsh.log' 2>&1 && ! grep -i error '$T/gmsh.log'"
    # VH(places of 8 corners){three components at each corner, then those of the next frame}
    sed -n 's/^VH(\(.*\)){\(.*\)};$/\1,\2/p' "$T/a.pos" | tr ',' ' ' >"$T/pos"
    is "$(awk '{ for (c = 0; c < 8; c++) printf "%g %g %g%s", $(3 * c + 1), $(3 * c + 2), $(3 * c + 3), c < 7 ? ";" : "\n" }' "$T/pos")" \
        "$({ array node.position 0 && array element.node 0; } | awk 'NF == 3 { at[n++ + 0] = $0 } NF == 8 { for (i = 1; i <= 8; i++) printf "%s%s", at[$i], i < 8 ? ";" : "\n" }')" \
        "the same elements in the same places"
    is "$(awk '{ for (c = 0; c < 8; c++) printf "%g %g %g%s", $(49 + 3 * c), $(50 + 3 * c), $(51 + 3 * c), c < 7 ? ";" : "\n" }' "$T/pos")" \
        "$({ array node.displacement 2 && array element.node 0; } | awk 'NF == 3 { at[n++ + 0] = $0 } NF == 8 { for (i = 1; i <= 8; i++) printf "%s%s", at[$i], i < 8 ? ";" : "\n" }')" \
        "and the last frame's displacement at each corner"
    gmsh -v 2 "$T/a.msh" -save -o "$T/b.msh" -format msh22 >"$T/gmsh.log" 2>&1
    is "$(sed -n '/PhysicalNames/,/EndPhysicalNames/p' "$T/b.msh" | grep -c -e '^3 1 "skin"' -e '^3 2 "muscle_a"' -e '^0 3 "rigid"')" 3 "and the groups' names"
else
    skip 4 "no Gmsh (gmsh)"
fi
fails 2 "a surface as MSH" "msh holds the elements at rest" sinew export -f msh --surface s "$small"

# OBJ.
check "the elements' boundary" sinew export -f obj -o "$T/a.obj" "$small"
is "$(grep -c '^v' "$T/a.obj") $(grep -c '^f' "$T/a.obj") $(grep '^g' "$T/a.obj" | tr '\n' ' ')" "12 10 g skin g muscle_a " \
    "12 vertices, 10 faces, two groups"
# The volume inside (divergence theorem), in mm3: all faces point outward.
volume() {
    awk '$1 == "v" { x[++n] = $2; y[n] = $3; z[n] = $4 }
        $1 == "f" { for (i = 3; i < NF; i++) { a = $2; b = $i; c = $(i + 1)
            v += x[a] * (y[b] * z[c] - z[b] * y[c]) + y[a] * (z[b] * x[c] - x[b] * z[c]) + z[a] * (x[b] * y[c] - y[b] * x[c]) } }
        END { printf "%.6g\n", v / 6 }' "$1"
}
is "$(volume "$T/a.obj")" 2e+06 "it encloses the elements, in the model's unit"
sinew export -f obj --unit m -o "$T/a.obj" "$small"
is "$(volume "$T/a.obj")" 0.002 "in another unit"
printf '%%sinew 1 text\naxis node 4\naxis element 1\narray node.position f64 m node 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n%s\n' \
    'array element.node i32 @node element 4
0 1 2 3
end' >"$T/tet"
sinew export -f obj -o "$T/tet.obj" "$T/tet"
is "$(volume "$T/tet.obj") $(grep -c '^f' "$T/tet.obj")" "0.166667 4" "a tetrahedron, in metres where no unit is known"
check "a surface, moved" sinew export -f obj --surface s --deformed -o "$T/s.obj" "$small"
is "$(cat "$T/s.obj")" "v 0 0 0
v 230 0 40
v 220 100 0
v 110 50 50
g skin
f 1 2 3 4
g edge lip
l 1 4" "a surface as OBJ"
is "$(sinew export -f obj --surface s --frame rest "$small" | sed -n 2p)" "v 200 0 0" "a surface at rest"

# Nonsense; nothing is left of a file.
sed '$d' "$small" >"$T/cut"
sed '/^frame 0/,$d' "$small" >"$T/still" && echo end >>"$T/still"
printf '%%sinew 1 text\nend\n' >"$T/empty"
printf '%%sinew 1 text\naxis node 0\naxis element 0\narray node.position f64 m node 3\narray element.node i32 @node element 8\nend\n' >"$T/none"
fails 2 "no format" "missing option -f, --format; expected -f model.vtu.inp.obj.msh" sinew export "$small"
fails 2 "an unknown format" "--format 'stl': expected model\\|vtu\\|inp\\|obj" sinew export -f stl "$small"
fails 2 "a frame that is no number" "--frame 'lst': expected a frame's index" sinew export -f vtu --frame lst "$small"
fails 1 "a frame that is not there" "--frame 3: no such frame; expected one of the 2 there, of index 0 to 10\$" sinew export -f vtu --frame 3 -o "$T/x.vtu" "$small"
fails 1 "a frame where there are none" "the model has no frames" sinew export -f vtu --frame last -o "$T/x.vtu" "$T/still"
fails 1 "moved without frames" "the model has no frames" sinew export -f obj --deformed -o "$T/x.obj" "$T/still"
check "without frames the default is the rest" sinew export -f vtu -o "$T/still.vtu" "$T/still"
fails 2 "moved at rest" "--frame rest selects none" sinew export -f vtu --deformed --frame rest "$small"
fails 2 "all frames as OBJ" "sinew deform --frame all" sinew export -f obj --frame all "$small"
fails 2 "all frames without a name" "needs -o NAME.pvd" sinew export -f vtu --frame all "$small"
fails 2 "all frames into a .vtu" "needs -o NAME.pvd" sinew export -f vtu --frame all -o "$T/x.vtu" "$small"
fails 1 "all of no frames" "the model has no frames" sinew export -f vtu --frame all -o "$T/x.pvd" "$T/still"
fails 2 "a slip in a surface" "unknown surface 'S'; did you mean 's'" sinew export -f vtu --surface S -o "$T/x.vtu" "$small"
fails 2 "a surface that is not there" "unknown surface 'skull'; expected one of: s$" sinew export -f obj --surface skull -o "$T/x.obj" "$small"
fails 2 "a surface where there are none" "unknown surface 's'; there are none here" sinew export -f obj --surface s -o "$T/x.obj" "$T/empty"
sed '/^array s\/vertex.weight/,/^0 0.5/d' "$small" >"$T/free"
fails 1 "a surface that is not bound cannot move" "surface s is not bound" sinew export -f obj --surface s --deformed -o "$T/x.obj" "$T/free"
fails 2 "gravity in a VTU" "--gravity and --element are for inp" sinew export -f vtu -g 0,0,-1 "$small"
fails 2 "a frame in Abaqus input" "inp holds the model at rest" sinew export -f inp --frame 0 "$small"
fails 2 "two numbers of gravity" "--gravity '0,1'" sinew export -f inp -g 0,1 "$small"
fails 2 "a unit for SI formats" "--unit is for obj" sinew export -f vtu --unit mm "$small"
fails 2 "an unknown unit" "expected um, mm, cm, m or in" sinew export -f obj --unit furlong "$small"
fails 2 "gzip of a VTU" "-z is for model, inp, obj and msh" sinew export -f vtu -z "$small"
fails 1 "an empty model" "node.position" sinew export -f vtu -o "$T/x.vtu" "$T/empty"
fails 1 "no volumes" "element.volume|volume.name" sinew export -f inp -o "$T/x.inp" "$T/tet"
sed 's/^0.45$/0.5/' "$small" >"$T/b"
fails 1 "a material that is none" "tissue.*nu|nu.*0.5" sinew export -f inp -o "$T/x.inp" "$T/b"
sed 's/"neo-hookean"/"odgen"/' "$small" >"$T/b"
fails 1 "a law that is not known" "law" sinew export -f inp -o "$T/x.inp" "$T/b"
fails 1 "a cut stream" "cut" sinew export -f vtu -o "$T/x.vtu" "$T/cut"
fails 1 "a cut stream, all frames" "cut" sinew export -f vtu --frame all -o "$T/x.pvd" "$T/cut"
fails 1 "a folder that is not there" "nonesuch" sinew export -f vtu -o "$T/nonesuch/x.vtu" "$small"
sinew export -f vtu -o "$T/x.vtu" <"$T/failed" >"$T/stdout" 2>"$T/stderr"
is "$?" 3 "a failed stream gives its status"
is "$(cat "$T/stdout" "$T/stderr")" "" "and says nothing"
is "$(cd "$T" && echo x*)" "x*" "none of these left a file"
check "a VTU of nothing" sinew export -f vtu -o "$T/none.vtu" "$T/none"
vtk "nothing" "0 points
0 cells" "$T/none.vtu"

# The model itself, in either encoding.
check "text" sinew export -f model --text -o "$T/text" "$small"
check "text becomes binary" sinew export -f model -o "$T/binary" "$T/text"
is "$(head -c 6 "$T/binary" | tail -c 5)" sinew "which it is"
check "binary becomes text" sinew export -f model --text -o "$T/again" "$T/binary"
check "text -> binary -> text: the same bytes" cmp "$T/text" "$T/again"
is "$(grep -c '^prov' "$T/again")" "$(grep -c '^prov' "$small")" "no provenance is added"
sinew export -f model -z <"$T/text" | sinew export -f model - >"$T/back"
check "binary -> gzip -> binary: the same bytes" cmp "$T/binary" "$T/back"
check "and the same model as that written by hand" sinew diff "$small" "$T/binary"
fails 2 "text of another format" "--text is for model" sinew export -f obj --text "$small"
fails 2 "a frame of the whole" "frame is for vtu, obj and msh" sinew export -f model --frame 0 "$small"
head -n 150 "$T/text" >"$T/cut"
fails 1 "a model that is cut" "cut short" sinew export -f model -o "$T/gone" "$T/cut"
[ ! -e "$T/gone" ]
is $? 0 "leaves no file"
sinew export -f model --text <"$T/cut" 2>/dev/null | tail -n 1 | grep -q '^fail 1 "sinew-export: '
is $? 0 "and in a pipe it ends with fail"

# What is no number or no element does not go out.
sed 's/^0.03 0 0.04$/nan 0 0/' "$small" >"$T/nan"
for format in model vtu obj; do
    fails 1 "$format: a displacement that is nan" "nan:174: array node.displacement, row 2: nan 0 0; expected finite numbers" \
        sinew export -f "$format" -o "$T/none" "$T/nan"
done
sed 's/^0.1 0.1 0.1$/0.1 inf 0.1/' "$small" >"$T/inf"
for format in vtu obj inp; do
    fails 1 "$format: a node that is nowhere" "inf:29: array node.position, row 10: 0.1 inf 0.1; expected finite numbers" \
        sinew export -f "$format" -o "$T/none" "$T/inf"
done
sed 's/^0 1 4 3 6 7 10 9$/0 0 0 0 0 0 0 0/' "$small" >"$T/flat"
fails 1 "an element of one node" "element.node, row 0 has 1 different node; expected 4 or more" \
    sinew export -f inp "$T/flat"
sed 's/^6000$/-1/' "$small" >"$T/soft"
fails 1 "a material that is none, on standard output" "soft:94: array material.E, row 1: -1; expected 0.001 to 1e12 Pa" sinew export -f inp "$T/soft"
is "$(wc -c <"$T/stdout")" 0 "nothing is written before that is known"
is "$(sinew export -f vtu -v -o "$T/v.vtu" "$small" 2>&1)" \
    "sinew-export: 12 points and 2 cells, at rest, with frame 10" "-v says what was written"

done_testing
