#!/bin/sh
# attach on a bar of 3 x 1 x 1 voxels of 10 mm written by hand, with a muscle and bones; and on the real face.
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/cli/boxes.sh
. tests/cli/boxes.sh

# bar GROUP: its first face, a square in the plane x = 2 mm, is in GROUP; a point at the bar's far end is in "Bone_b", and a
# triangle far away in "rigid_far skin".
bar() {
    cat <<SINEW
%sinew 1 text
meta source.unit "mm"
meta lattice.origin "0 0 0"
meta lattice.spacing "0.01 0.01 0.01"
axis node 16
axis element 3
axis volume 2
axis material 1
axis bar/vertex 8
axis bar/face 3
axis bar/corner 8
axis bar/group 3
axis x-lot 2
array node.position f64 m node 3
0 0 0
0.01 0 0
0.02 0 0
0.03 0 0
0 0.01 0
0.01 0.01 0
0.02 0.01 0
0.03 0.01 0
0 0 0.01
0.01 0 0.01
0.02 0 0.01
0.03 0 0.01
0 0.01 0.01
0.01 0.01 0.01
0.02 0.01 0.01
0.03 0.01 0.01
array element.node i32 @node element 8
0 1 5 4 8 9 13 12
1 2 6 5 9 10 14 13
2 3 7 6 10 11 15 14
array element.lattice i32 1 element 3
0 0 0
1 0 0
2 0 0
array element.volume i32 @volume element 1
1
1
0
array volume.name str 1 volume 1
"skin"
"muscle_a"
array volume.muscle u8 1 volume 1
0
1
array bar/vertex.position f64 m bar/vertex 3
0.002 -0.01 -0.01
0.002 0.02 -0.01
0.002 0.02 0.02
0.002 -0.01 0.02
0.03 0.001 0.001
1 0 0
1 1 0
1 0 1
array bar/face.start i64 @bar/corner bar/face 1
0
4
5
array bar/face.vertex i32 @bar/vertex bar/corner 1
0
1
2
3
4
5
6
7
array bar/face.group i32 @bar/group bar/face 1
0
1
2
array bar/group.name str 1 bar/group 1
"$1"
"Bone_b"
"rigid_far skin"
array x-heat f32 K node 1
$(seq 16)
array x-word str 1 x-lot 1
"one"
"two words"
end
SINEW
}

# values ARRAY FILE: its rows in a text model, between commas.
values() {
    awk -v name="$1" '/^array /{on = $2 == name; next} /^(crc|frame|end)/{on = 0} on' "$2" | paste -sd, -
}

bar skull >"$T/bar"
bar cheek >"$T/cheek"
check "a bar" attach --text -o "$T/out" <"$T/bar" -o "$T/out"
is "$(values node.rigid "$T/out")" 1,0,0,1,1,0,0,0,1,0,0,0,1,0,0,0 "the skull holds the end, a point its corner"
is "$(values node.anchor "$T/out")" 0,-1,-1,1,0,-1,-1,-1,0,-1,-1,-1,0,-1,-1,-1 "and each node knows which"
is "$(values anchor.name "$T/out")" '"skull","Bone_b","rigid_far"' "surfaces are named in order"
is "$(values muscle.volume "$T/out") $(values muscle.centre "$T/out")" "1 0 0.0050000000000000001 0.0050000000000000001" \
    "the contraction centre"
is "$(values element.fibre "$T/out")" "-1 0 0,-1 0 0,0 0 0" "fibres"
is "$(grep -c 'rigid_far holds no node' "$T/stderr") $(wc -l <"$T/stderr")" "1 1" "one warning: a bone out of reach"
is "$(values x-word "$T/out") $(values x-heat "$T/out")" '"one","two words" 1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16' \
    "unknown arrays pass"
is "$(sed -n 's/^\(prov attach\) [0-9.]*/\1/p' "$T/out")" 'prov attach "--strictness 0.75"' "provenance"
is "$(values muscle.fibre "$T/out")" '"field"' "the rule of its fibres, as it has no surface of its own"
attach --text -q --fibre centre <"$T/bar" >"$T/centre"
is "$(sed -n 's/^\(prov attach\) [0-9.]*/\1/p' "$T/centre") $(values element.fibre "$T/centre") $(grep -c muscle.fibre "$T/centre")" \
    'prov attach "--strictness 0.75 --fibre centre" -1 0 0,-1 0 0,0 0 0 0' "one rule for all is in the provenance, as it was before"
attach --text -q --fibre 'A=center' --fibre 'muscle_*,a=axis' <"$T/bar" >"$T/own"
is "$(sed -n 's/^\(prov attach\) [0-9.]*/\1/p' "$T/own") $(values muscle.fibre "$T/own")" \
    'prov attach "--strictness 0.75 --fibre A=centre --fibre muscle_*,a=axis" "axis"' "a rule for some, the last that names it"
is "$(attach -v -o "$T/x" <"$T/bar" 2>&1 | grep -c "muscle_a: fibres by the rule 'field': from end to end through")" 1 "-v tells it"
is "$(sinew info "$T/own" | awk '/muscle_a/ && /axis/' | wc -l)" 1 "sinew info too"
fails 2 "--fibre for a muscle that is not there" "fibre: unknown muscle 'zyg'.*muscle_a" attach --fibre zyg=axis -o "$T/no" <"$T/bar"
fails 2 "--fibre with a rule that is none" "fibre 'a=along': expected centre" attach --fibre a=along <"$T/bar"

check "again" attach --text -q -o "$T/again" <"$T/out"
is "$(grep -v '^prov' "$T/again" | cksum)" "$(grep -v '^prov' "$T/out" | cksum)" "changes nothing"
check "with other surfaces" attach --text -q --rigid bone_b --fibre centre -o "$T/again" <"$T/out"
is "$(values node.rigid "$T/again") $(values anchor.name "$T/again") $(values node.anchor "$T/again" | tr -d ',01-')" \
    '0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0 "Bone_b" ' "what the first left is gone"
is "$(values muscle.centre "$T/again") $(values element.fibre "$T/again")" "nan nan nan 0 0 0,0 0 0,0 0 0" \
    "a muscle that touches no bone"
is "$(attach --rigid bone_b --fibre centre <"$T/bar" 2>&1 >"$T/x")" "attach: warning: muscle_a has no rigid node, so no contraction centre and no \
fibres: it will not contract; --fibre field gives it fibres without one" "is a warning that names it, and what helps"
attach --text --rigid 'BONE*' --fibre axis <"$T/bar" >"$T/out" 2>"$T/stderr"
is "$(values element.fibre "$T/out") $(cat "$T/stderr")" "1 0 0,1 0 0,0 0 0 " \
    "along the axis it has fibres all the same, and nothing is said"
is "$(sed -n 's/^\(prov attach\) [0-9.]*/\1/p' "$T/out")" 'prov attach "--rigid BONE* --strictness 0.75 --fibre axis"' "options are in the provenance"
is "$(attach --text --strictness 1 --rigid bone_b <"$T/bar" 2>&1 | values node.rigid -)" \
    0,0,1,1,0,0,1,1,0,0,1,1,0,0,1,1 "--strictness 1 takes the whole voxel"

# End to end: held at x = 0, its free end in the middle of the bar.
check "--fibre field" attach --text --fibre field -o "$T/out" <"$T/bar"
is "$(values element.fibre "$T/out")" "-1 0 0,-1 0 0,0 0 0" "along the muscle, toward where it is held"
is "$(values attachment.muscle "$T/out") $(values attachment.nodes "$T/out") $(values attachment.centre "$T/out") $(
    values attachment.anchor "$T/out")" "0 4 0 0.0050000000000000001 0.0050000000000000001 0" "its attachment"
for threads in 1 3; do
    attach -q --fibre field --threads $threads <"$T/bar" >"$T/threads$threads"
done
check "the same bytes for any number of threads" cmp "$T/threads1" "$T/threads3"
# Muscles are laid side by side, but one of more than 32,768 elements by all threads together.
{
    box tissue 0 0 0 80 50 30
    box muscle_much 2 2 2 70 30 28
    for i in 1 2 3 4 5; do
        box "muscle_$i" 72 $((9 * i - 4)) 2 78 $((9 * i + 1)) 28
    done
    box skull 0 0 -2 80 50 1
} >"$T/boxes.obj"
voxelise -q --unit mm -s 1 "$T/boxes.obj" 2>"$T/said" >"$T/boxes"
is "$(sinew export -f model --text "$T/boxes" | awk '$1 == "array" { on = $2 == "element.volume"; next } on && $1 == 1 { n++ } END { print (n > 32768) }')" \
    1 "a muscle of many elements"
for rule in field auto; do
    for threads in 1 3 16; do
        attach -q --fibre $rule --threads $threads <"$T/boxes" >"$T/threads$threads"
    done
    check "$rule: the same bytes by three threads" cmp "$T/threads1" "$T/threads3"
    check "and by sixteen" cmp "$T/threads1" "$T/threads16"
done

attach --report -o "$T/out" <"$T/bar" 2>"$T/stderr"
is "$(grep -v warning "$T/stderr")" "attach: 3 rigid surfaces
             nodes              without
  surface     held  primitives   a node
  skull          4           1        0
  Bone_b         1           1        0
  rigid_far      0           1        1
attach: 1 muscle
                              rigid  centre x       y       z
  muscle    elements  fibres  nodes        mm      mm      mm
  muscle_a         2  field       4    0.0000  5.0000  5.0000" "--report"
attach <"$T/bar" 2>"$T/stderr" >"$T/plain"
# Faces 1 to 3 and 5 are far away, and so are 8 to 60, each apart from the next.
{
    echo "v 500 500 500
v 510 500 500
v 500 510 500
v 12 5 5
f 1 2 3
f 3 2 1
p 1
p 4
p 2
p 4
g bone_y
p 4"
    seq 27 | sed 's/.*/p 1 4/'
} >"$T/idle.obj"
attach --report --rigid skull --rigid-file "$T/idle.obj" <"$T/bar" -o "$T/out" 2>"$T/stderr"
is "$(grep 'hold no node' "$T/stderr")" "attach: idle: these faces of idle hold no node: 1-3, 5
attach: bone_y: these faces of idle hold no node: 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30, 32, 34, 36, 38, 40, 42, 44, 46
attach: bone_y: 7 more faces hold no node; -v lists them" "the faces that hold no node"
attach -v --report --rigid skull --rigid-file "$T/idle.obj" <"$T/bar" -o "$T/out" 2>&1 |
    grep -q 'bone_y: these faces of idle hold no node: 48, 50, 52, 54, 56, 58, 60$'
is $? 0 "-v lists all"
attach -q <"$T/bar" >"$T/plain"
attach -q --report <"$T/bar" -o "$T/out"
check "--report is not in the model" cmp "$T/out" "$T/plain"

cat >"$T/plate.obj" <<'OBJ'
v 15 0 -1
v 15 10 -1
v 15 5 20
v 25 5 10
l 1 2
g lid upper
p 4
OBJ
check "--rigid-file" attach --text -q --rigid 'rigid*' --rigid-file "$T/plate.obj" -o "$T/out" <"$T/bar"
is "$(values node.rigid "$T/out") $(values anchor.name "$T/out")" \
    '0,1,1,0,0,1,1,0,0,0,1,1,0,0,1,1 "rigid_far","plate","lid"' "is in the model's unit, all of it rigid"
sed '/source.unit/d' "$T/bar" >"$T/unitless"
fails 1 "needs a unit" 'source\.unit' attach --rigid-file "$T/plate.obj" <"$T/unitless"
fails 1 "that is missing" 'none\.obj.*No such file' attach --rigid-file "$T/none.obj" -o "$T/no" <"$T/bar"
echo 'f 1 2 9' >>"$T/plate.obj"
fails 1 "that is broken" 'plate\.obj:8: ' attach --rigid-file "$T/plate.obj" -o "$T/no" <"$T/bar"
fails 2 "that is standard input" 'standard input' attach --rigid-file - <"$T/bar"

attach --rigid cheek -o "$T/out" <"$T/cheek" 2>"$T/stderr"
is "$(cat "$T/stderr")" "" "any group can be rigid"
fails 2 "a name that is not there" "unknown surface 'chek'.*cheek" attach --rigid skin,chek -o "$T/no" <"$T/cheek"
fails 2 "no name" '^attach: --rigid: .,. names no surface' attach --rigid , <"$T/bar"
sed '/^axis bar/d; /^array bar/,/^array x-heat/{/^array x-heat/!d;}' "$T/bar" >"$T/bare"
check "a model without surfaces" attach --text -o "$T/out" <"$T/bare"
is "$(grep -c 'no surface of the model is rigid' "$T/stderr") $(values node.rigid "$T/out")" \
    "1 0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0" "is said to be free"
is "$(values muscle.centre "$T/out")" "nan nan nan" "and its muscle to hang nowhere"
fails 2 "but not with --rigid" "unknown surface 'skull'" attach --rigid skull <"$T/bare"

for bad in 0 -0.5 1.5 x; do
    fails 2 "--strictness $bad" 'strictness' attach --strictness "$bad" <"$T/bar"
done
is "$(attach -h | awk 'length > 80' | wc -l)" 0 "the usage fits 80 columns"
fails 2 "--fibre along" 'fibre.*centre\|axis\|field' attach --fibre along <"$T/bar"
fails 2 "an operand" '' attach model.sinew <"$T/bar"
fails 1 "nothing on stdin" 'sinew bind' attach
for array in element.lattice element.node element.volume node.position volume.muscle volume.name; do
    sed "/^array $array /,/^array /{/^array $array /d;/^array /!d;}" "$T/bar" >"$T/without"
    fails 1 "no $array" "${array%%.*}\.${array#*.}" attach -o "$T/no" <"$T/without"
done
sed 's/^2 0 0$/1 0 0/' "$T/bar" >"$T/twice"
check "two elements in one cell, as where a slit parts it" attach -q -o "$T/two" <"$T/twice"
sed 's/^2 0 0$/2000000000 2000000000 2000000000/' "$T/bar" >"$T/wide"
fails 1 "a lattice wider than memory" 'memory' attach -o "$T/no" <"$T/wide"
sed '/lattice.spacing/s/0.01 0.01"/0 0.01"/' "$T/bar" >"$T/flat"
fails 1 "voxels without thickness" 'lattice\.spacing' attach -o "$T/no" <"$T/flat"
sed 's/^0.002 0.02 -0.01$/nan 0.02 -0.01/' "$T/bar" >"$T/nan"
fails 1 "a vertex that is nowhere" 'stdin:51: array bar/vertex.position, row 1: nan 0.02 -0.01; expected finite numbers' attach -o "$T/no" <"$T/nan"
check "no output is left of any failure" test ! -e "$T/no"
echo 'fail 3 "voxelise: no"' >"$T/failed"
sed '$d' "$T/bar" | cat - "$T/failed" | attach -o "$T/no" 2>"$T/stderr"
is "$? $(cat "$T/stderr")" "3 " "a failure before us passes on, silently"

check "frames" attach --text -o "$T/out" <tests/cli/small.sinew
is "$(grep -c '^frame' "$T/out") $(grep -c '2 frames' "$T/stderr")" "0 1" "are dropped, and it is said"


# A cube, which has no longest axis, and whose elements are held or not.
for high in 4 18; do
    {
        box skin 0 0 0 40 40 40
        box muscle_m 10 10 10 30 30 30
        box skull 0 0 0 40 40 $high
    } >"$T/cube.obj"
    voxelise -q --unit mm -s 10 "$T/cube.obj" 2>"$T/said" >"$T/cube$high"
done
is "$(attach --fibre axis <"$T/cube4" 2>&1 >"$T/x")" "attach: warning: muscle_m has no axis that is the longest: 8 of its 8 elements have \
no fibre and will not contract; --fibre field needs no axis" "a cube has no axis, which is told with what helps"
is "$(attach --fibre field <"$T/cube4" 2>&1 >"$T/out")" "" "and does help"
is "$(tled-run -q -d cpu --ramp 0 -c m=0.1 -n 10 <"$T/out" 2>&1 | sinew info --get node.displacement.max | awk '{ print ($1 > 1e-6) }')" 1 "it contracts"
is "$(attach --strictness 1 <"$T/cube18" 2>&1 >"$T/x")" "attach: warning: muscle_m has no node that is free: it will not contract; smaller \
voxels or a lower --strictness may leave some free" "one whose nodes are all held"
is "$(attach --strictness 0.75 <"$T/cube18" 2>&1 >"$T/x")" "" "has some with a lower --strictness"

# Lines on a ball, its circles of latitude, 15 degrees apart: fibres of its shell run east. Away from the poles.
awk -v r=100 -v n=48 -f tests/cli/sphere.awk >"$T/ball.obj"
echo 'shell thickness=20' >"$T/shell"
voxelise -q --unit mm -s 10 --layers "$T/shell" "$T/ball.obj" 2>"$T/said" >"$T/ball"
awk 'BEGIN { pi = atan2(0, -1)
    for (t = -75; t <= 75; t += 15) {
        line = "l"
        for (k = 0; k < 60; k++) {
            printf "v %.9g %.9g %.9g\n", 100 * cos(t * pi / 180) * cos(k * pi / 30), 100 * cos(t * pi / 180) * sin(k * pi / 30),
                100 * sin(t * pi / 180)
            line = line " " ++n
        }
        print line, n - 59
    } }' >"$T/lines.obj"
check "--fibre-lines" attach --text -q --fibre-lines "$T/lines.obj" -o "$T/out" <"$T/ball"
is "$(sed -n 's/^\(prov attach\) [0-9.]*/\1/p' "$T/out")" 'prov attach "--strictness 0.75 --fibre-lines lines.obj"' "is in the provenance"
is "$(awk '$1 == "array" { on = $2; r = 0; next } /^(crc|axis|end)/ { on = "" }
    on == "node.position" { p[r++] = $0 } on == "element.node" { n[r++] = $0 } on == "element.normal" { up[r++] = $0 }
    on == "element.fibre" {
        split($0, f); split(up[r], m); split(n[r++], c); x = y = z = 0
        if (!(m[1] || m[2] || m[3])) { inner += f[1] || f[2] || f[3]; next }
        for (i = 1; i <= 8; i++) { split(p[c[i]], q); x += q[1]; y += q[2]; z += q[3] }
        l = sqrt(x * x + y * y); east = (f[2] * x - f[1] * y) / l; out = f[1] * m[1] + f[2] * m[2] + f[3] * m[3]
        radial = (m[1] * x + m[2] * y + m[3] * z) / sqrt(l * l + z * z)
        if (l > .3 * sqrt(l * l + z * z) && east * east < .9995) off++
        if (out * out > 1e-12) tilted++
        if (radial < .9995) wrong++
        shell++
    } END { print (shell > 2000), inner + 0, off + 0, tilted + 0, wrong + 0 }' "$T/out")" "1 0 0 0 0" \
    "to 1.3 degrees, in the plane across the normal, which is that of the ball; nothing inside"
attach --text -q --threads 1 --fibre-lines "$T/lines.obj" -o "$T/one" <"$T/ball"
check "the same bytes on one thread" cmp "$T/out" "$T/one"
check "--fibre-lines-in" attach --text -q --fibre-lines "$T/lines.obj" --fibre-lines-in 'Sh*' -o "$T/out" <"$T/ball"
sinew diff --only element.fibre "$T/out" "$T/one" >"$T/said"
is $? 0 "names volumes, here the same"
fails 2 "a model without layers" 'no layers of skin .element.normal.' attach --fibre-lines "$T/lines.obj" -o "$T/no" <"$T/cube4"
fails 2 "lines in a muscle" 'muscle_m is a muscle' attach --fibre-lines "$T/lines.obj" --fibre-lines-in 'muscle*' -o "$T/no" <"$T/cube4"
fails 2 "lines in a volume that is none" "unknown volume 'shel'.*shell" attach --fibre-lines "$T/lines.obj" --fibre-lines-in shel -o "$T/no" <"$T/ball"
fails 1 "a file without lines" 'ball.obj: no lines; expected' attach --fibre-lines "$T/ball.obj" -o "$T/no" <"$T/ball"
fails 2 "volumes without lines" 'needs --fibre-lines' attach --fibre-lines-in shell <"$T/ball"
fails 2 "lines from standard input" 'standard input' attach --fibre-lines - <"$T/ball"

if [ ! "$DATA" ]; then
    skip 13 "no shared data"
    done_testing
fi
# The counts are those of every voxel tried against every triangle, once, at this size (a smaller size is in test_attach).
voxelise -q --unit mm -s 2.5 --origin -125,-125,-125 "$DATA/face/face_zyg.obj" >"$T/face"
check "the real face" attach --text --report -o "$T/out" <"$T/face"
is "$(awk '/^  (muscle_|skull)/ { $1 = $1; print }' "$T/stderr")" "skull 6870 1800 0
muscle_zyg_xneg 60 shape 28 -49.464 40.714 -37.321
muscle_zyg_xpos 60 shape 27 49.259 40.556 -37.407" "what is held"
# fibres FILE: for each volume its elements, how many have a unit fibre, and whether those go outward and up on the whole.
fibres() {
    awk '/^array /{ name = $2; row = 0; next } /^(crc|end)/{ name = "" }
        name == "element.volume"{ volume[row++] = $1 }
        name == "element.fibre"{ v = volume[row++]; n[v]++; x[v] += $1; z[v] += $3
            length2 = $1 * $1 + $2 * $2 + $3 * $3; if (length2 > 0.999999 && length2 < 1.000001) unit[v]++ }
        END { for (v = 0; v < 3; v++)
            print n[v], unit[v] + 0, (x[v] < 0 ? "right" : x[v] > 0 ? "left" : "-"), (z[v] > 0.7 * n[v] ? "up" : "-") }' \
        "$1" | paste -sd,
}
is "$(fibres "$T/out")" "24196 0 - -,60 60 right up,60 60 left up" "every muscle element has a fibre, up the cheek"
attach --text -q --fibre axis -o "$T/out" <"$T/face"
is "$(fibres "$T/out")" "24196 0 - -,60 60 right up,60 60 left up" "--fibre axis too"
is "$(values element.fibre "$T/out" | tr , '\n' | sort -u | sed 's/^-//' | sort -u | wc -l)" 2 "one axis, mirrored"
attach -q -o "$T/once" <"$T/face"
attach -q -z <"$T/face" | attach -q --text | attach -q | sinew diff - "$T/once"
is $? 0 "thrice is once"
# Nodes that are nowhere, elements that enclose nothing.
small=$ROOT/tests/cli/small.sinew
sed 's/^0.1 0.1 0.1$/0.1 nan 0.1/' "$small" >"$T/nan"
fails 1 "a node that is nowhere" "^attach: stdin:29: array node.position, row 10: 0.1 nan 0.1; expected finite numbers" attach -o "$T/none" <"$T/nan"
sed 's/^0 1 4 3 6 7 10 9$/0 0 0 0 0 0 0 0/' "$small" >"$T/flat"
fails 1 "an element of one node" "^attach: element.node, row 0 has 1 different node; expected 4 or more" \
    attach -o "$T/none" <"$T/flat"

# Of 34 muscles 14 touch no bone. A field gives them fibres too, and they contract: nothing is to be warned of.
voxelise -q --unit mm -s 2.5 "$DATA/face/face_all.obj" >"$T/face"
attach --fibre centre -o "$T/centre" <"$T/face" 2>"$T/stderr"
is "$(grep -c '^attach: warning: 14 muscles have no rigid node, .*: muscle_buc_xneg, .*; --fibre field gives them fibres' "$T/stderr") $(
    wc -l <"$T/stderr" | tr -d ' ')" "1 1" "muscles without bone, to their centres: one warning of all, with what helps"
attach --report --fibre centre -o "$T/centre" <"$T/face" 2>"$T/stderr"
is "$(awk '/^  muscle_/ && $3 == "none" && $4 == 0 && /!$/' "$T/stderr" | wc -l | tr -d ' ') $(grep -c '!$' "$T/stderr") $(
    awk 'length > 80 && !/warning/' "$T/stderr")" "14 14 " "they are marked in the report, which fits 80 columns"
check "along fields" attach --report --fibre field -o "$T/field" <"$T/face"
is "$(grep -c -e warning -e '!$' "$T/stderr") $(awk '/^  muscle_/ { print $3 }' "$T/stderr" | LC_ALL=C sort | uniq -c | tr -s ' \n' ' ')" \
    "0  32 field 2 field, " "none, for all contract"
for threads in 1 3 16; do
    attach --rigid 'skull*,muscle_b*,muscle_z*,skin' --threads $threads --report -o "$T/rigid$threads" <"$T/face" 2>"$T/report$threads"
done
check "many rigid surfaces: the same nodes by three threads" cmp "$T/rigid1" "$T/rigid3"
check "and by sixteen" cmp "$T/rigid1" "$T/rigid16"
check "and the same counts of what each holds" cmp "$T/report1" "$T/report16"
check "by default" attach --report -o "$T/all" <"$T/face"
is "$(grep -c -e warning -e '!$' "$T/stderr") $(awk '/^  muscle_/ { print $3 }' "$T/stderr" | LC_ALL=C sort | uniq -c | tr -s ' \n' ' ')" \
    "0  8 round 26 shape " "all 34 have fibres, the quarters of the sphincter as such"
is "$(sinew export -f model --text "$T/all" | awk '$1 == "array" { on = $2; row = 0; next } /^(crc|axis|end)/ { on = "" }
    on == "volume.muscle" { muscle[row++] = $1 } on == "element.volume" { of[row++] = $1 }
    on == "element.fibre" { fibre[row++] = $1 * $1 + $2 * $2 + $3 * $3 }
    END { for (i in fibre) if (muscle[of[i]]) { n++; unit += fibre[i] > .999 && fibre[i] < 1.001 } else other += fibre[i]
        print n - unit, other }')" "0 0" "each element of a muscle, and no other"
is "$(tled-run -q -d cpu --ramp 0 -n 10 -c buc_xneg=0.3 <"$T/field" | sinew info --get node.displacement.max |
    awk '{ print ($1 > 1e-5) }')" 1 "as such a one does"
done_testing
