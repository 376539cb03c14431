#!/bin/sh
# sinew import: Abaqus input, Gmsh's MSH and VTU, as sinew export, VTK and Gmsh write them and by hand; what comes back; and what it says to
# nonsense.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

small=tests/cli/small.sinew
mesh=node.position,element.node,element.volume,volume.name,node.rigid

python=
for p in python3 /usr/bin/python3; do
    "$p" -c 'import vtkmodules.vtkIOXML' 2>/dev/null && python=$p && break
done

# There and back.
for format in inp vtu msh; do
    sinew export -f $format -o "$T/small.$format" "$small" 2>"$T/stderr"
    check "$format: what sinew export wrote" sinew import -q --unit m -o "$T/back" "$T/small.$format"
    check "$format: the same nodes, elements, volumes and rigid nodes" sinew diff --only $mesh "$small" "$T/back"
done
check "vtu: and fibres" sh -c "sinew import --unit m $T/small.vtu | sinew diff --only element.fibre $small -"
{ # with normals of the skin, those of the fibres
    awk '/^[a-z]/ && on { on = 0 } /^frame/ && !done { printf "array element.normal f32 1 element 3\n%s", rows; done = 1 }
        on { rows = rows $0 "\n" } $2 == "element.fibre" { on = 1 } !/^crc/ { print }' "$small"
} >"$T/normals"
sinew export -f vtu -o "$T/normals.vtu" "$T/normals"
check "vtu: and normals" sh -c "sinew import --unit m $T/normals.vtu | sinew diff --only element.normal,element.fibre $T/normals -"
is "$(sinew export -f model "$T/normals" | sinew export -f model --text | sinew info --get element.normal.rows)" \
    "$(sinew info --get element.fibre.rows "$small")" "a binary model has them too"
# Directions of any length, as other programs write them, become directions of length 1; sinew-model(5) takes no others.
fibre() { # X Y Z: of the voxel
    sed "s|</CellData>|<DataArray type=\"Float64\" Name=\"fibre\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 $*</DataArray>&|" \
        tests/fuzz/seeds/vtu/ascii.vtu | sinew import -q --text --unit m -
}
of() {
    fibre "$@" 2>"$T/stderr" | sed -n '/^array element.fibre/{n;p;}'
}
is "$(of 3 0 -4)" "0.600000024 0 -0.800000012" "vtu: a fibre of length 5"
is "$(of 3e300 0 4e300)" "0.600000024 0 0.800000012" "vtu: a fibre whose square is too large for a double"
is "$(of 3e-310 0 4e-310)" "0.600000024 0 0.800000012" "vtu: a fibre whose square is too small for a double"
is "$(of 0.577 0.577 0.577)" "0.577000022 0.577000022 0.577000022" "vtu: a fibre of three digits is kept"
is "$(of 0 0 0)" "0 0 0" "vtu: no fibre"
nan=$(printf '\030\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\300\177\0\0\0\0\0\0\200\077' | base64)
sed "s|</CellData>|<DataArray type=\"Float32\" Name=\"fibre\" NumberOfComponents=\"3\" format=\"binary\">$nan</DataArray>&|" \
    tests/fuzz/seeds/vtu/ascii.vtu >"$T/nan.vtu"
fails 1 "vtu: a fibre that is no direction" "14: cell 1 has fibre nan 0 1; expected a direction, or 0 0 0" sinew import --unit m "$T/nan.vtu"
check "inp: and materials, to the last digits but one" sh -c \
    "sinew import --unit m $T/small.inp | sinew diff --rel 1e-14 --only material.E,material.nu,material.density,volume.material $small -"
sinew import -q --unit m "$T/small.inp" | sinew export -f inp - 2>"$T/stderr" | sed '/^.MATERIAL/,$d' >"$T/got"
sed '/^.MATERIAL/,$d' "$T/small.inp" >"$T/want"
check "inp: out again, the same nodes, elements and sets to the byte" cmp "$T/want" "$T/got"
printf '%%sinew 1 text\naxis node 5\naxis element 2\naxis volume 1\naxis material 1\n%s\n' 'array node.position f64 m node 3
0 0 0
1 0 0
0 1 0
0 0 1
1 1 1
array element.node i32 @node element 4
0 1 2 3
1 4 2 3
array element.volume i32 @volume element 1
0
0
array volume.name str 1 volume 1
"tissue"
array volume.material i32 @material volume 1
0
array material.name str 1 material 1
"tissue"
array material.law str 1 material 1
"linear"
array material.E f64 Pa material 1
3000
array material.nu f64 1 material 1
0.45
array material.density f64 kg/m3 material 1
1000
array material.peak f64 Pa material 1
0
end' >"$T/tets"
for format in inp vtu msh; do
    sinew export -f $format -o "$T/tets.$format" "$T/tets" 2>"$T/stderr"
    check "$format: tetrahedra" sh -c \
        "sinew import -q --unit m $T/tets.$format 2>/dev/null | sinew diff --only node.position,element.node,element.volume,volume.name $T/tets -"
done
is "$(sinew import -q --text --unit m "$T/tets.inp" 2>/dev/null | grep -c '"linear"')" 1 "*ELASTIC is the linear law"

# As VTK writes it.
for style in "ascii none raw 32 little" "binary none raw 32 little" "binary zlib raw 64 little" "binary none raw 64 big" \
    "appended none raw 64 little" "appended zlib raw 32 big" "appended none base64 32 little" "appended zlib base64 64 little"; do
    if [ -z "$python" ]; then
        skip 1 "no VTK for Python (python3-vtk9): $style"
        continue
    fi
    # shellcheck disable=SC2086
    "$python" tests/cli/write_vtu.py "$T/small.vtu" "$T/style.vtu" $style
    check "VTK's $style" sh -c "sinew import -q --unit m $T/style.vtu 2>/dev/null | sinew diff --only $mesh,element.fibre $small -"
done

# As Gmsh writes it: it gives nodes other numbers.
sinew export -f model --text "$small" | awk -f tests/cli/mesh.awk | sort >"$T/want"
is "$(wc -l <"$T/want")" 6 "the mesh as lines"
for kind in "msh22" "msh41" "msh22 -bin" "msh41 -bin"; do
    if ! have gmsh; then
        skip 1 "no Gmsh (gmsh): $kind"
        continue
    fi
    # shellcheck disable=SC2086
    gmsh "$T/small.msh" -save -v 2 -o "$T/gmsh.msh" -format $kind >"$T/log" 2>&1
    sinew import -q --text --unit m "$T/gmsh.msh" 2>/dev/null | awk -f tests/cli/mesh.awk | sort >"$T/got"
    check "Gmsh's $kind" cmp "$T/want" "$T/got"
done

# By hand: two cubes of 10 mm.
cat >"$T/hand.inp" <<'END'
** a comment
*Heading
 two cubes
*Part, name=P
*NODE, NSET=All
   7,  0., 0., 0.
   2,  10, 0, 0.
   3,  10, 1.D1, 0
   4,  0, 10, 0
 105,  0, 0, 10
  12,  10, 0, 10
  13,  10, 10, 10
  14,  0, 10, 10
  21,  0, 0, 20
  22,  10, 0, 20
  23,  10, 10, 20
  24,  0, 10, 20
 999,  5, 5, 5
*Element, type=C3D8R
1, 7, 2, 3, 4, 105,
12, 13, 14
*ELEMENT, TYPE=C3D8
20, 105, 12, 13, 14, 21, 22, 23, 24
*ELEMENT, TYPE=S4
30, 7, 2, 3, 4
*End Part
*Nset, nset=Low
7, 2,
3, Upper
*NSET, NSET=Ends, GENERATE
21, 24, 1
*ELSET, ELSET=Muscle_A, GENERATE
20, 2000000000, 10
*ELSET, ELSET=Rest
1
*SOLID SECTION, ELSET=Rest, MATERIAL=Fat
*SOLID SECTION, ELSET=Muscle_A, MATERIAL="Lean"
*MATERIAL, NAME=Fat
*DENSITY
9.2E-10,
*HYPERELASTIC, NEO HOOKE
0.0005, 200.
*MATERIAL, NAME=Lean
*ELASTIC
0.003, 0.45
*EXPANSION
1e-5
*BOUNDARY
Ends, 1, 3
4, PINNED
7, 1
7, 2, 3
2, 3
END
sed '/^3, Upper/s/, Upper//' "$T/hand.inp" >"$T/ok.inp"
run="sinew import --unit mm --stress MPa --density t/mm3"
run() {
    sinew import --unit mm --stress MPa --density t/mm3 "$@"
}
run --text -o "$T/hand" "$T/ok.inp" 2>"$T/stderr"
is $? 0 "by hand"
is "$(grep -c -e ':24: elements of type S4 are not solids' -e '1 of the 13 nodes are in no element' -e 'EXPANSION is not read' \
    -e '1 node is held in one or two components only' -e 'material lean has no density' "$T/stderr")" 5 "what was left out is said"
diag_file "$T/stderr"
is "$(sinew info --get axis.node "$T/hand") $(sinew info --get axis.element "$T/hand")" "12 2" "12 nodes, 2 elements"
is "$(sinew info --get node.rigid.sum "$T/hand")" 6 "six are rigid: four by a set that was generated, one pinned, one by component"
is "$(sinew info --get volume.count.rest "$T/hand") $(sinew info --get volume.count.muscle_a "$T/hand")" "1 1" "sections are volumes"
is "$(awk '$2 == "volume.muscle" { on = 1; next } /^crc/ { on = 0 } on' "$T/hand" | tr '\n' ' ')" "0 1 " "a volume named muscle is one"
awk '$2 == "material.E" { on = 1; next } /^crc/ { on = 0 } on' "$T/hand" >"$T/E"
near "$(sed -n 1p "$T/E")" 2903.22581 1e-6 "E of C10 = 0.5 kPa, D1 = 200 / MPa"
near "$(sed -n 2p "$T/E")" 3000 1e-12 "E in MPa"
near "$(awk '$2 == "material.density" { getline; print; exit }' "$T/hand")" 920 1e-12 "density in t/mm3"
is "$(sinew info --get meta.source.unit "$T/hand")" mm "its unit is kept for bind"
near "$(awk '$2 == "node.position" { getline; getline; print $1; exit }' "$T/hand")" .01 1e-12 "lengths are in metres"
check "gzip and standard input" sh -c "gzip -c $T/ok.inp | $run -q - | sinew diff --only $mesh $T/hand -"
is "$(run -q --rigid low,ALL "$T/ok.inp" 2>/dev/null | sinew info --get node.rigid.sum -)" 12 "--rigid by names of any case"
echo 'soft E=1000
hard E=9000' >"$T/table"
check "--materials and --material" sh -c "sinew import -q --unit mm --materials $T/table --material hard $T/tets.msh | sinew info --get material.E.sum -"
printf 'FAT E=1000\nlean E=9000\n' >"$T/case"
is "$(sinew import -q --unit mm --materials "$T/case" --text "$T/ok.inp" 2>/dev/null | awk '$2 == "volume.material" { getline; print; getline; print }' | tr '\n' ' ')" \
    "0 1 " "a table's names are found whatever their case"
fails 1 "a table without the name" "unknown material 'Fat'" sinew import -q --unit mm --materials "$T/table" "$T/ok.inp"
fails 1 "a table, and nothing that says which" "no material is given for volume tissue" sinew import -q --unit mm --materials "$T/table" "$T/tets.msh"
sed 's/C3D8R$/C3D8R, ELSET=One/;/MATERIAL/,$d' "$T/ok.inp" >"$T/plain.inp"
is "$(run -q --volume other --text "$T/plain.inp" 2>/dev/null | awk '$2 == "volume.name" { on = 1; next } /^crc/ { on = 0 } on' | tr '\n' ' ')" \
    '"one" "muscle_a" ' "without sections, ELSETs are volumes"
sed '/^3 2 /d;/^2$/!b' "$T/small.msh" | sed '/PhysicalNames$/,/EndPhysicalNames/s/^3$/2/' >"$T/noname.msh"
is "$(sinew import -q --unit m --text "$T/noname.msh" 2>/dev/null | awk '$2 == "volume.name" { on = 1; next } /^crc/ { on = 0 } on' | tr '\n' ' ')" \
    '"skin" "volume2" ' "a group without a name"
is "$(sinew import -q --unit m --rigid low "$T/small.msh" 2>&1 >/dev/null | grep -c "unknown physical group 'low'")" 1 "a group that is not there"

# On down the pipe.
awk -f samples/ball.awk -v n=4 | sinew import -q --unit m - >"$T/ball"
check "tled-run goes on from it" sh -c "tled-run -q -n 5 -g 0,0,-9.81 <$T/ball | sinew info --get node.displacement.max -"
check "and msds-run's meshes are left to it" sh -c "tled-run -n 5 <$T/tets 2>&1 | grep -q 'msds-run moves tetrahedra'"

# Nonsense, with its line.
bad() { # NAME PATTERN SED
    sed "$3" "$T/ok.inp" >"$T/bad.inp"
    fails 1 "inp: $1" "bad.inp:$2" run -o "$T/x" "$T/bad.inp"
}
fails 1 "inp: a set that is not there" "hand.inp:29: no set 'Upper'" run -o "$T/x" "$T/hand.inp"
bad "*INCLUDE" "2: .INCLUDE; expected all in one file" '2s/.*/*INCLUDE, INPUT=other.inp/'
bad "nodes generated" "2: .NGEN" '2s/.*/*NGEN/'
bad "wedges" "19: elements of type 'C3D6'" 's/type=C3D8R/type=C3D6/'
bad "second order" "19: elements of type 'C3D20R'; expected hexahedra" 's/type=C3D8R/type=C3D20R/'
bad "no number" "7: 'x'; expected a node's number" 's/^   2,  10/   2,  x/'
bad "no such node" "[0-9]*: no node has the number 77" 's/^1, 7,/1, 77,/'
# Numbers that stand twice, where all else is sound: side by side, far apart, at another place, in another block.
bad "a node twice" "12: a node number for the second time; expected a different number for each" "/^ *12,/p"
bad "a node once more, elsewhere" " node 12 is given twice" '/^ *14,/a12, 7, 8, 9'
# shellcheck disable=SC2016 # sed's $
bad "a node in a block of its own" " node 2 is given twice" '$a*NODE\n2, 1, 1, 1'
bad "an element twice" " element 1 is given twice; expected a different number for each" '/^1, 7, 2/{N;p;}'
bad "an element's number for another" " element 1 is given twice" 's/^20, 105/1, 105/'
bad "an element cut short" "2[0-9]: an element with 6 numbers; expected its own number and those of 8" '/^12, 13, 14$/d'
bad "inside out" "[0-9]*: element 0 is inside out" 's/^1, 7, 2, 3, 4, 105,/1, 105, 12, 13, 14, 7,/;s/^12, 13, 14$/2, 3, 4/'
bad "collapsed" "[0-9]*: element 0 has one node at two" 's/^1, 7, 2, 3, 4/1, 7, 2, 3, 3/'
bad "flat" "20: element 0 has no inside" 's/^\( *1[0-9]*, .*\), 10$/\1, 0/'
bad "hexahedra and tetrahedra" "[0-9]*: an element of 4 nodes among elements of 8" 's/TYPE=S4/TYPE=C3D4/'
bad "two sections" "37: element 1 has a section already, rest" 's/^20, 2000000000, 10/1, 20, 1/'
bad "two sections, of elements whose numbers fall" "37: element 9 has a section already, rest" 's/^1, 7,/30, 7,/;s/^20, 105,/9, 105,/;s/^1$/9/;s/^20, 2000000000, 10/9, 20, 1/'
bad "a law that is not isotropic" "[0-9]*: .ELASTIC that is not isotropic" 's/^.ELASTIC/*ELASTIC, TYPE=ENGINEERING CONSTANTS/'
bad "a law that is not read" "[0-9]*: .HYPERELASTIC of another law" 's/NEO HOOKE/POLYNOMIAL/'
bad "incompressible" "[0-9]*: C10 or D1 that is not above 0" 's/^0.0005, 200./0.0005, 0/'
bad "a nu that is none" "[0-9]*: .*nu" 's/^0.003, 0.45/0.003, 0.5/'
bad "nodes that are moved" "[0-9]*: .BOUNDARY that moves" 's/^Ends, 1, 3/Ends, 1, 3, 0.1/'
fails 1 "materials in unknown units" "the file does not say the units of its materials" sinew import -q --unit mm -o "$T/x" "$T/ok.inp"
fails 2 "no unit" "missing option --unit" sinew import "$T/ok.inp"
fails 2 "a unit that is none" "expected um, mm" sinew import --unit ell "$T/ok.inp"
fails 2 "a node set that is not there" "--rigid: unknown node set 'lows'; did you mean 'low'" run --rigid lows "$T/ok.inp"
fails 1 "no mesh" "begins like none" sinew import --unit m "$small"
fails 1 "VTK's legacy format" "legacy" sh -c "echo '# vtk DataFile' | sinew import --unit m -"
fails 1 "nothing" "empty file" sinew import --unit m /dev/null
fails 1 "no elements" "no hexahedra and no tetrahedra" sh -c "printf '*NODE\n1,0,0,0\n' | sinew import --unit m -"
badmsh() {
    sed "$3" "$T/small.msh" >"$T/bad.msh"
    fails 1 "msh: $1" "bad.msh:$2" sinew import --unit m -o "$T/x" "$T/bad.msh"
}
badmsh "another version" "2: another version" '2s/2.2/3.0/'
badmsh "a pyramid" "27: a pyramid \\(type 7\\)" 's/^1 5 2/1 7 2/'
badmsh "second order" "27: a hexahedron of second order" 's/^1 5 2/1 17 2/'
badmsh "no number" "12: y; expected a number" 's/^1 0 0 0$/1 0 y 0/'
badmsh "a node that is not there" "27: no node has the number 99" 's/^1 5 2 1 1 1/1 5 2 1 1 99/'
badmsh "too many nodes said" "[0-9]*: .EndNodes; expected a whole number" '11s/12/13/'
badmsh "too few said" "[0-9]*: more in a section" '11s/12/11/'
badmsh "a node twice" " node 3 is given twice" 's/^4 /3 /'
badmsh "a node of the last's number" " node 12 is given twice" 's/^11 \([^ ]* [^ ]* [^ ]*\)$/12 \1/'
badmsh "cut" "28: the file ends in the middle" '29,999d'
badvtu() {
    sed "$3" "$T/ascii.vtu" >"$T/bad.vtu"
    fails 1 "vtu: $1" "bad.vtu:$2" sinew import --unit m -o "$T/x" "$T/bad.vtu"
}
cat >"$T/ascii.vtu" <<'END'
<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid">
<UnstructuredGrid><!-- one voxel, and a line -->
<Piece NumberOfPoints="8" NumberOfCells="2">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1
</DataArray></Points>
<Cells>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 0 1 2 3 4 5 6 7</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">2 10</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">3 11</DataArray>
</Cells>
<PointData><DataArray type="Int8" Name="held" format="ascii">1 1 0 0 0 0 0 0</DataArray></PointData>
<CellData><DataArray type="Int32" Name="material" format="ascii">4 5</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>
END
is "$(sinew import -q --unit m --rigid held --text "$T/ascii.vtu" 2>/dev/null | sed -n '/element.node/{n;p;};/volume.name/{n;p;}' | tr '\n' ' ')" \
    '0 1 3 2 4 5 7 6 "volume5" ' "vtu: a voxel, its volume by its material, a line passed over"
is "$(sinew import -q --unit m --rigid held "$T/ascii.vtu" 2>/dev/null | sinew info --get node.rigid.sum -)" 2 "vtu: rigid nodes by an array"
badvtu "a wedge" "11: cell 1 is a wedge" 's/>3 11</>3 13</'
badvtu "second order" "11: cell 1 is of second order" 's/>3 11</>3 25</'
badvtu "a point that is not there" "9: cell 1 has a point 8" 's/>0 1 0 1 2 3/>0 1 8 1 2 3/'
badvtu "too few numbers" "7: array Points: no number; expected 24" '6s/1 1 1$/1 1/'
badvtu "offsets that fall" "10: cell 1 ends before" 's/>2 10</>2 1</'
badvtu "another grid" "2: a VTK file of PolyData" 's/="UnstructuredGrid"/="PolyData"/'
badvtu "no XML" "4: a malformed tag" 's/<Piece Num/<Piece = Num/'
fails 2 "vtu: no such array" "--rigid: unknown array of points 'hold'; did you mean 'held'" sinew import --unit m --rigid hold "$T/ascii.vtu"
head -c 700 "$T/small.vtu" >"$T/cut.vtu"
fails 1 "vtu: cut" "cut.vtu" sinew import --unit m -o "$T/x" "$T/cut.vtu"
is "$(cd "$T" && ls x 2>/dev/null)" "" "none of these left a file"

# A line that says much takes little: 2 10^9 numbers in a set, 10^9 points in a file of 300 bytes.
printf '<VTKFile type="UnstructuredGrid"><Piece NumberOfPoints="1000000000" NumberOfCells="1"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">1 2 3</DataArray>' >"$T/huge.vtu"
limit='ulimit -v 400000;'
[ -z "$SINEW_SANITIZED" ] || limit= # a sanitizer reserves much more than it takes
fails 1 "points that are not there take no memory" "too few numbers" sh -c "$limit sinew import --unit m '$T/huge.vtu'"
check "a set of two billion takes none" sh -c "$limit $run -q -o '$T/y' '$T/ok.inp' 2>/dev/null"

# Nor do many names take long: so many sets, sections, materials, groups and arrays as a file of megabytes can have.
cubes='function corners(i) { return 4 * i + 1 " " 4 * i + 2 " " 4 * i + 3 " " 4 * i + 4 " " 4 * i + 5 " " 4 * i + 6 " " 4 * i + 7 " " 4 * i + 8 }
    function node(i) { return int(i / 4) * 4 + 1 + i % 4 " " (i % 4 == 1 || i % 4 == 2) " " (i % 4 > 1) " " int(i / 4) }'
awk -v n=40000 "$cubes"' BEGIN {
    print "*NODE"
    for (i = 0; i < 4 * n + 4; i++) { line = node(i); gsub(" ", ",", line); print line }
    for (i = 0; i < n; i++) { line = corners(i); gsub(" ", ",", line); printf "*ELEMENT,TYPE=C3D8,ELSET=v_e%d\n%d,%s\n", i, i + 1, line }
    for (i = 0; i < n; i++)
        printf "*MATERIAL,NAME=m_%d\n*ELASTIC\n3000,.4\n*DENSITY\n1000\n*SOLID SECTION,ELSET=v_e%d,MATERIAL=m_%d\n*NSET,NSET=n%d\n1\n*BOUNDARY\nn%d,1,3\n", i, i, i, i, i
}' >"$T/many.inp"
awk -v n=100000 "$cubes"' BEGIN {
    print "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" 4 * n + 4
    for (i = 0; i < 4 * n + 4; i++) print node(i)
    print "$EndNodes\n$Elements\n" n
    for (i = 0; i < n; i++) print i + 1, 5, 2, i + 1, 1, corners(i)
    print "$EndElements"
}' >"$T/many.msh"
awk -v n=30000 '{ print } /<CellData>/ { for (i = 0; i < n; i++) printf "<DataArray type=\"Int8\" Name=\"a%d\" format=\"ascii\">1</DataArray>\n", i }' "$T/ascii.vtu" >"$T/many.vtu"
for format in inp msh vtu; do
    check "many names in $format take seconds" sh -c "ulimit -t 5; sinew import -q --unit m -o '$T/y' '$T/many.$format' 2>/dev/null"
done

# The size of all is said, and warned of where no body has it.
voxelise -q --unit mm -s 5 tests/cli/cube.obj 2>"$T/said" | sinew export -q -f inp -o "$T/size.inp" 2>"$T/said"
check "a mesh in metres" sinew import --unit m -o "$T/m" "$T/size.inp"
cp "$T/stderr" "$T/said"
is "$(grep -c 'a mesh of .* x .* x .* m$' "$T/said") $(grep -c 'with --unit m, b' "$T/said")" "1 0" "says its size, and is not warned of"
check "taken as one in mm" sinew import -q --unit mm --stress Pa --density kg/m3 -o "$T/m" "$T/size.inp"
cp "$T/stderr" "$T/said"
check "it is warned of" grep -q "warning: $T/size.inp is .* m with --unit mm, below 3 mm; with --unit m it is " "$T/said"
done_testing
