#!/bin/sh
# deform: which frame, which bytes of the OBJ change, point caches, and what it refuses.
. "$(dirname "$0")/lib.sh"

model() {
    awk -v nx=2 -v ny=2 -v nz=2 -v h=0.01 "$@" -f tests/cli/lattice.awk
}

cat >"$T/skin.obj" <<'OBJ'
# skin of a cube
mtllib skin.mtl
o skin
v 2.5 5 7.5
  v 12.5 15 17.5 0.5 0.5 0.5 # a colour
v 10 10 \
 10
v -15 30 5
vt 0.5 0.5
vn 0 0 2
vn 1 0 0

g front  side
usemtl a b
f 1/1/1 2/1/1 3/1/1
s off
f 3//2 4//2 1//2
OBJ
model -v frames=3 | sinew bind -q "$T/skin.obj" >"$T/bound" 2>/dev/null

# The field of lattice.awk, frame f, at the vertices (mm).
field() {
    awk -v f="$1" '{ sub(/\\$/, ""); if (hold != "") { $0 = hold $0; hold = "" } } /^v 10 10 $/ { hold = $0; next }
        $1 == "v" { printf "%.9g %.9g %.9g\n", $2 + f * (.1 * $2 - .2 * $3 + .3 * $4 + 1),
            $3 + f * (.05 * $2 + .1 * $3 - 2), $4 + f * (-.3 * $2 + .2 * $4) }' "$T/skin.obj"
}
# vertices FILE
vertices() {
    awk '$1 == "v" { print $2, $3, $4 }' "$1"
}
# close FILE FILE: numbers the same to 1e-6 of 50 mm.
# shellcheck disable=SC2317 # called by check
close() {
    paste "$1" "$2" | awk 'NF != 6 { exit 1 } { for (i = 1; i <= 3; i++) { d = $i - $(i + 3); if (d * d > 25e-10) exit 1 } n++ }
        END { exit n != 4 }'
}

check "the last frame" sinew deform "$T/skin.obj" -o "$T/last.obj" <"$T/bound"
vertices "$T/last.obj" >"$T/got"
field 3 >"$T/want"
check "a linear field is reproduced to 1e-6, inside and outside" close "$T/got" "$T/want"
grep -v '^ *v' "$T/skin.obj" | grep -v '^ 10' >"$T/want"
grep -v '^ *v' "$T/last.obj" >"$T/got"
check "all other lines are as they were" cmp "$T/got" "$T/want"
is "$(grep -c '^  v [^ ]* [^ ]* [^ ]* 0.5 0.5 0.5 # a colour$' "$T/last.obj")" 1 "colours and comments stay on the line"
is "$(grep '^vt' "$T/last.obj")" "vt 0.5 0.5" "texture coordinates too"

# n' = F^-T n: F = I + 3 A, whose inverse transposed takes z to the cross product of F's first two columns.
is "$(awk '$1 == "vn" { printf "%.6f %.6f %.6f ", $2, $3, $4 }' "$T/last.obj")" \
    "$(awk 'BEGIN { a = 1.3; b = -.6; c = .9; d = .15; e = 1.3; g = -.9; i = 1.6
        x = d * 0 - g * e; y = g * b - a * 0; z = a * e - d * b; l = sqrt(x * x + y * y + z * z)
        printf "%.6f %.6f %.6f ", x / l, y / l, z / l
        x = e * i - 0; y = 0 * c - b * i; z = b * 0 - e * c; l = sqrt(x * x + y * y + z * z)
        printf "%.6f %.6f %.6f ", x / l, y / l, z / l }')" "normals by F^-T, unit vectors"

check "--frame N" sinew deform --frame 2 "$T/skin.obj" -o "$T/two.obj" <"$T/bound"
vertices "$T/two.obj" >"$T/got"
field 2 >"$T/want"
check "that frame" close "$T/got" "$T/want"
sinew deform --frame last "$T/skin.obj" <"$T/bound" >"$T/got"
check "--frame last is the default, and stdout as good as -o" cmp "$T/got" "$T/last.obj"
check "--frame all" sinew deform --frame all "$T/skin.obj" -o "$T/f_%04d.obj" <"$T/bound"
is "$(cd "$T" && echo f_*)" "f_0001.obj f_0002.obj f_0003.obj" "a file a frame"
check "the third is the last" cmp "$T/f_0003.obj" "$T/last.obj"
cp "$T/f_0001.obj" "$T/first.obj"
sinew deform --threads 1 "$T/skin.obj" <"$T/bound" >"$T/1"
sinew deform --threads 4 "$T/skin.obj" <"$T/bound" >"$T/2"
check "the same bytes for any number of threads" cmp "$T/1" "$T/2"

# Nothing moves: to the byte.
model -v frames=1 | awk '/^array node.displacement/ { print; zero = 1; next } /^end/ { zero = 0 } zero { print "0 -0 0"; next } { print }' |
    sinew bind -q "$T/skin.obj" >"$T/still" 2>/dev/null
sinew deform "$T/skin.obj" <"$T/still" >"$T/got"
check "no displacement: the OBJ to the byte" cmp "$T/got" "$T/skin.obj"
sed 's/$/\r/' "$T/skin.obj" >"$T/crlf.obj"
check "CR LF" sinew deform "$T/crlf.obj" -o "$T/got" <"$T/still"
check "CR LF: to the byte" cmp "$T/got" "$T/crlf.obj"
sinew deform "$T/crlf.obj" <"$T/bound" | tr -d '\r' >"$T/got"
check "CR LF: else as LF" cmp "$T/got" "$T/last.obj"
gzip -c "$T/skin.obj" >"$T/skin.obj.gz"
sinew deform "$T/skin.obj.gz" <"$T/bound" >"$T/got"
check "gzip" cmp "$T/got" "$T/last.obj"
cp "$T/skin.obj" "$T/renamed.obj"
sinew deform "$T/renamed.obj" <"$T/bound" >"$T/got"
check "an OBJ is known by its vertices, not by its name" cmp "$T/got" "$T/last.obj"

# Tetrahedra: the same linear field, so the same places and normals.
model -v frames=3 | awk -f tests/cli/tetra.awk >"$T/tet"
sinew bind -q "$T/skin.obj" <"$T/tet" 2>/dev/null >"$T/tetbound"
check "a model of tetrahedra" sinew deform "$T/skin.obj" -o "$T/tet.obj" <"$T/tetbound"
vertices "$T/tet.obj" >"$T/got"
field 3 >"$T/want"
check "a linear field is reproduced to 1e-6 by tetrahedra, inside and outside" close "$T/got" "$T/want"
is "$(awk '$1 == "vn" { printf "%.6f %.6f %.6f ", $2, $3, $4 }' "$T/tet.obj")" \
    "$(awk '$1 == "vn" { printf "%.6f %.6f %.6f ", $2, $3, $4 }' "$T/last.obj")" "normals turn with them"
check "tetrahedra and --within" sinew deform --within 5mm "$T/skin.obj" -o "$T/got" <"$T/tetbound"
is "$(vertices "$T/got" | sed -n 4p)" "-15 30 5" "a vertex outside by more stays"
is "$(vertices "$T/got" | sed -n 3p)" "$(vertices "$T/tet.obj" | sed -n 3p)" "others move"

# --within
check "--within" sinew deform --within 5mm "$T/skin.obj" -o "$T/got" <"$T/bound"
is "$(vertices "$T/got" | sed -n 4p)" "-15 30 5" "a vertex outside by more stays where it was"
is "$(vertices "$T/got" | sed -n 3p)" "$(vertices "$T/last.obj" | sed -n 3p)" "others move"
sinew deform --within 5mm "$T/skin.obj" <"$T/bound" 2>&1 >/dev/null | grep -q '1 of 4 vertices lie further than 0.005 m outside'
is $? 0 "and it is said"

# Bone: the vertices of a rigid surface move with a node that it holds, and their normals do not turn.
cat >"$T/bone.obj" <<'OBJ'
vn 0 0 1
vn 0 0 1
v 2.5 2 2
v 2.5 8 2
v 19 2 2
v 2.5 2 3
g skin
f 4//1 2//1 3//1
g upper SKULL
f 1//2 2//2 3//2
OBJ
model -v frames=1 -v bone=skull | sinew bind "$T/bone.obj" | sinew deform -o "$T/got" "$T/bone.obj"
is "$(vertices "$T/got" | tr '\n' ',')" "3.5 0 2,1.5 7 2,20 0 2,4.25 0.325 2.85," \
    "bone's vertices move with the nearest node that bone holds, others with their element"
is "$(sed -n 2p "$T/got")" "vn 0 0 1" "bone's normals stay"
is "$(sed -n 1p "$T/got" | cut -c 1-4)" "vn 0" "others turn"

# Point caches
check "a point cache" sinew deform --format pc2 "$T/skin.obj" -o "$T/skin.pc2" <"$T/bound"
is "$(head -c 12 "$T/skin.pc2" | tr '\0' '.')" "POINTCACHE2." "its magic"
is "$(od -An -t d4 -j 12 -N 8 "$T/skin.pc2" | tr -s ' ')" " 1 4" "version 1, 4 points"
is "$(od -An -t f4 -j 20 -N 8 "$T/skin.pc2" | tr -s ' ')" " 1 1" "first frame 1, a frame a sample"
is "$(od -An -t d4 -j 28 -N 4 "$T/skin.pc2" | tr -d ' ')" 3 "3 samples"
is "$(wc -c <"$T/skin.pc2" | tr -d ' ')" $((32 + 3 * 4 * 12)) "its size"
for f in 1 2 3; do
    od -An -v -t f4 -w12 -j $((32 + (f - 1) * 48)) -N 48 "$T/skin.pc2" >"$T/got"
    vertices "$T/f_000$f.obj" >"$T/want"
    check "sample $f is frame $f" close "$T/got" "$T/want"
done
check "one frame as a point cache" sinew deform --format pc2 --frame 2 "$T/skin.obj" -o "$T/two.pc2" <"$T/bound"
is "$(od -An -t f4 -j 20 -N 4 "$T/two.pc2" | tr -d ' ')$(od -An -t d4 -j 28 -N 4 "$T/two.pc2" | tr -d ' ')" 21 "its frame"
fails 2 "a point cache on stdout" "expected -o with a file" sinew deform --format pc2 "$T/skin.obj" <"$T/bound"
fails 1 "a point cache into a device" "not a regular file" sinew deform --format pc2 "$T/skin.obj" -o /dev/null <"$T/bound"
model -v frames=3 | sinew bind -q --text "$T/skin.obj" 2>/dev/null | sed 's/^frame 3/frame 7/' >"$T/uneven"
fails 1 "frames of no one step" "frame 7 comes after 2, but the step was 1" \
    sinew deform --format pc2 "$T/skin.obj" -o "$T/uneven.pc2" <"$T/uneven"
[ ! -e "$T/uneven.pc2" ]
is $? 0 "and no file left"

# Not the OBJ that was bound
sed 's/^v -15 30 5/v -15 30 6/' "$T/skin.obj" >"$T/d.obj"
fails 1 "another OBJ: the vertex and its line" \
    'd.obj:8: vertex 4 is -15 30 6, but -15 30 5 in the model.s surface skin; expected the same OBJ' \
    sinew deform "$T/d.obj" <"$T/bound"
echo 'v 1 2 3' >>"$T/d.obj"
fails 1 "another OBJ: the count" "d.obj: 5 vertices, but the model's surface skin has 4" sinew deform "$T/d.obj" <"$T/bound"
fails 1 "another unit" "vertex 1 is 2.5 5 7.5, but" sinew deform --unit cm "$T/skin.obj" <"$T/bound"
model -v frames=1 >"$T/unbound"
fails 1 "no surface" "carries no surface; expected a model from sinew bind" sinew deform "$T/skin.obj" <"$T/unbound"

# Frames that are not there, and streams that end badly
model | sinew bind -q "$T/skin.obj" >"$T/noframes" 2>/dev/null
fails 1 "no frames" "no frames; expected results, from tled-run" sinew deform "$T/skin.obj" <"$T/noframes"
fails 1 "no such frame" "--frame 9: no such frame; expected one of the 3 there, of index [0-9]+ to 3\$" sinew deform --frame 9 "$T/skin.obj" <"$T/bound"
model -v frames=1 | sed 's/node.displacement f64 m /node.velocity f64 m\/s /' |
    sinew bind -q "$T/skin.obj" >"$T/velocity" 2>/dev/null
fails 1 "no displacement" "frame 1 has no node.displacement" sinew deform "$T/skin.obj" <"$T/velocity"
model -v frames=1 | sinew bind -q --text "$T/skin.obj" | sed '/^crc/d' >"$T/moved.txt"
for number in nan 1.7e308; do
    awk -v x=$number '/^array node.displacement/ { print; getline; print x, 0, 0; next } { print }' "$T/moved.txt" >"$T/$number"
done
fails 1 "a displacement that is no number" "array node.displacement, row 0: nan 0 0; expected finite numbers" \
    sinew deform "$T/skin.obj" <"$T/nan"
fails 1 "one that is beyond numbers" "frame 1 moves vertex 0 \\(element 0\\) to a place that is not finite" \
    sinew deform "$T/skin.obj" <"$T/1.7e308"
model -v frames=2 -v ends='fail 3 "tled-run: diverged"' | sinew bind -q "$T/skin.obj" >"$T/failed" 2>/dev/null
sinew deform --frame all "$T/skin.obj" -o "$T/g_%d.obj" <"$T/failed" 2>"$T/stderr"
is "$?:$(cat "$T/stderr"):$(cd "$T" && echo g_* .sinew*)" "3::g_* .sinew*" "a run that failed: its status, no words, no files"
sinew deform --frame all "$T/skin.obj" -o "$T/f_%04d.obj" <"$T/failed" 2>/dev/null
is "$?" 3 "a run that failed, where an earlier one wrote"
check "leaves the earlier files as they were" cmp "$T/f_0001.obj" "$T/first.obj"
is "$(cd "$T" && echo f_*)" "f_0001.obj f_0002.obj f_0003.obj" "all of them"
sinew deform "$T/skin.obj" <"$T/failed" >"$T/got" 2>"$T/stderr"
is "$?:$(cat "$T/stderr"):$(cat "$T/got")" "3::" "nothing on stdout"
head -c 2000 "$T/bound" >"$T/cut"
fails 1 "a model cut short" "stdin: " sinew deform "$T/skin.obj" -o "$T/none" <"$T/cut"
[ ! -e "$T/none" ]
is $? 0 "and no file left"

# The command line
fails 2 "--frame all without -o" "expected -o with %04d" sinew deform --frame all "$T/skin.obj" <"$T/bound"
for pattern in f.obj f_%s.obj f_%d_%d.obj f_%d%%.obj; do
    fails 2 "--frame all, -o $pattern" "expected one number" \
        sinew deform --frame all "$T/skin.obj" -o "$T/$pattern" <"$T/bound"
done
fails 2 "--frame first" "expected a frame's index, last, all, rest or undeformed" sinew deform --frame first "$T/skin.obj" <"$T/bound"
fails 2 "--within below 0" "expected 0 or more" sinew deform --within -1mm "$T/skin.obj" <"$T/bound"
fails 2 "--within of no length" "within" sinew deform --within far "$T/skin.obj" <"$T/bound"
fails 2 "no OBJ" "missing operand" sinew deform <"$T/bound"
fails 2 "an OBJ on stdin" "the model comes on standard input" sinew deform - <"$T/bound"
fails 2 "an unknown format" "obj\\|pc2" sinew deform --format fbx "$T/skin.obj" <"$T/bound"
fails 2 "a numbered name of one frame" "-o '.*x_%04d.obj': a number in the name is for --frame all" \
    sinew deform --frame 1 -o "$T/x_%04d.obj" "$T/skin.obj" <"$T/bound"
fails 2 "a numbered name of a point cache" "is for --frame all and OBJ" \
    sinew deform --format pc2 -o "$T/x_%d.pc2" "$T/skin.obj" <"$T/bound"

# Blended, or by the element alone: two voxels side by side, of which the nodes at the far end go up by 10 mm, and 4 vertices, one of them outside.
awk -v nx=2 -v ny=1 -v nz=1 -v h=0.01 -v frames=1 -f tests/cli/lattice.awk | awk '/^array node.position/ { rest = 1; n = 0; print; next }
    /^array node.displacement/ { moved = 1; i = 0; print; next } /^[a-z]/ { rest = moved = 0 } rest { x[n++] = $1 }
    moved { print 0, 0, (x[i++] > .015 ? .01 : 0); next } { print }' >"$T/end"
printf 'v 2 5 5\nv 10 5 5\nv 18 5 5\nv 22 5 5\np 1 2 3 4\n' >"$T/four.obj"
sinew bind -q --motion element "$T/four.obj" <"$T/end" | sinew deform -q "$T/four.obj" >"$T/got"
is "$(awk '$1 == "v" { printf "%.9g ", $4 - 5 }' "$T/got")" "0 0 8 12 " "by the element alone, trilinear"
# Maps at x = 0, 10, 20 mm: (0, slope 0), (2.5 + .5 * 0 = 2.5, slope .5), (10, slope 1); the last has y = 20 mm.
sinew bind -q "$T/four.obj" <"$T/end" | sinew deform -q "$T/four.obj" >"$T/got"
is "$(awk '$1 == "v" { printf "%.9g ", $4 - 5 }' "$T/got")" "-0.3 2.5 7.7 12 " "blended: the maps of nodes"

# The real face, whose nodes move by up to .5 mm, each as it happens: the skin has fewer and lower ridges when it is blended.
if [ -z "$DATA" ]; then
    skip 2 "no shared data"
else
    F=$DATA/face/face_zyg.obj
    voxelise -q --unit mm -s 2.5 --fraction 4 "$F" | sinew bind -q --text >"$T/face" 2>/dev/null
    awk '/^axis node / { n = $3 } /^end/ { print "frame 1 0.01\narray node.displacement f64 m node 3"
        for (i = 0; i < 3 * n; i++) { r = (r * 16807 + 12345) % 2147483647; printf "%.9f%s", 1e-3 * (r / 2147483647 - .5), i % 3 < 2 ? " " : "\n" }
        print } !/^end/' "$T/face" >"$T/rough"
    sinew deform -q "$F" <"$T/rough" >"$T/blended.obj"
    sinew bind -q --motion element <"$T/rough" 2>/dev/null | sinew deform -q "$F" >"$T/element.obj"
    python3 tests/cli/dihedral.py "$F" "$T/element.obj" >"$T/one"
    python3 tests/cli/dihedral.py "$F" "$T/blended.obj" >"$T/two"
    is "$(awk '{ print ($1 == 11775 || $1 > 11000), ($2 > 300) }' "$T/one")" "1 1" "rough nodes make ridges by the element alone"
    is "$(paste -d ' ' "$T/one" "$T/two" | awk '{ print ($6 < $2 / 5), ($7 <= $3 / 5) }')" "1 1" "and a fifth of them at most blended"
fi
done_testing
