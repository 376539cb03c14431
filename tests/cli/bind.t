#!/bin/sh
# bind: which element, which weights, which surface, and what it refuses.
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/cli/boxes.sh
. tests/cli/boxes.sh

model() {
    awk -v nx=2 -v ny=2 -v nz=2 -v h=0.01 "$@" -f tests/cli/lattice.awk
}
model >"$T/model"

# array FILE NAME: the rows of an array of a text model, between blanks.
array() {
    awk -v name="$2" '$1 == "array" { on = $2 == name; next } /^[a-z]/ { on = 0 } on' "$1" | tr '\n' ' '
}

# Inside the first and the last element; a tie of all eight, of four, of two; outside.
cat >"$T/dots.obj" <<'OBJ'
v 2.5 5 7.5
v 12.5 15 17.5
v 10 10 10
v 10 10 15
v 15 10 5
v -5 25 12.5
p 1 2 3 4 5 6
OBJ
check "binds an OBJ" sinew bind --text -o "$T/bound" "$T/dots.obj" <"$T/model"
is "$(cat "$T/stderr")" "" "silently, where nothing is far"
is "$(array "$T/bound" dots/vertex.element)" "0 7 0 4 1 6 " "the nearest elements; of equals the first"
is "$(array "$T/bound" dots/vertex.weight | tr ' ' '\n' | awk '{ printf "%.10g ", $1 }')" \
    "0.75 0.5 0.25 0.75 0.5 0.25 0 0 0 0 0 0.5 0.5 0 0.5 1.5 -0.5 0.75 " "weights by equation (1)"
check "provenance has the file's base name" grep -q '^prov bind [^ ]* "dots.obj"$' "$T/bound"

sinew bind --text --threads 1 "$T/dots.obj" <"$T/model" >"$T/1"
sinew bind --text --threads 5 "$T/dots.obj" <"$T/model" >"$T/2"
check "the same bytes for any number of threads" cmp "$T/1" "$T/2"

# With several threads a large model is written while its surfaces are bound, for the first time and again.
box skin 0 0 0 50 50 50 >"$T/box.obj"
voxelise -q --unit mm -s 1 "$T/box.obj" >"$T/large"
check "a large model" sinew bind -q --threads 1 -o "$T/large.bound" <"$T/large"
for from in "$T/large" "$T/large.bound"; do
    for threads in 1 2 5; do
        sinew bind -q --threads $threads <"$from" >"$T/by$threads"
    done
    check "$from: the same bytes for any number of threads" cmp "$T/by1" "$T/by2"
    check "and for five" cmp "$T/by1" "$T/by5"
done
fails 1 "what fails then" "no surface none" sinew bind --name none -o "$T/none" <"$T/large"
sinew bind --threads 2 --name none <"$T/large" 2>"$T/said" >"$T/cut"
is "$(sinew info "$T/cut" 2>&1 | grep -c 'failed: bind: the model carries no surface none') $(($(wc -c <"$T/cut") > 1000000))" "1 1" \
    "is told behind what was written"

# How vertices will move.
is "$(array "$T/bound" dots/vertex.blended)" "1 1 1 1 1 1 " "vertices move blended"
check "--motion element" sinew bind -q --text --motion element -o "$T/x" <"$T/bound"
is "$(grep -c vertex.blended "$T/x"):$(array "$T/x" dots/vertex.weight)" "0:$(array "$T/bound" dots/vertex.weight)" \
    "takes it away again, and leaves the weights"
check "and back" sinew bind -q --text -o "$T/y" <"$T/x"
is "$(array "$T/y" dots/vertex.blended)" "1 1 1 1 1 1 " "blended again"
fails 2 "another motion" "expected blended|element" sinew bind --motion rigid <"$T/bound"

# Names that begin x- are the user's, in the model and for files.
sed 's/^end$/axis x-my\/vertex 1\narray x-my\/vertex.position f32 K x-my\/vertex 1\n7\nend/' "$T/model" >"$T/mine"
cp "$T/dots.obj" "$T/x-wing.obj"
check "a user's array may be called as it likes" sinew bind --text -o "$T/both" "$T/x-wing.obj" <"$T/mine"
is "$(array "$T/both" x-my/vertex.position):$(grep -c '^array x_wing/' "$T/both")" "7 :8" \
    "it passes through, and no surface is called so"

# Which surface.
check "without an OBJ, every surface carried" sinew bind --text -o "$T/again" <"$T/bound"
is "$(cat "$T/stderr")" "bind: surface dots was bound already; the new binding replaces the old one" "and says what was bound before"
is "$(array "$T/again" dots/vertex.weight)" "$(array "$T/bound" dots/vertex.weight)" "the same weights"
check "the same OBJ again" sinew bind -q "$T/dots.obj" -o "$T/again" <"$T/bound"
sed 's/^v 10 10 15$/v 10 10 14/' "$T/dots.obj" >"$T/other.obj"
mkdir "$T/d"
cp "$T/other.obj" "$T/d/dots.obj"
fails 1 "another OBJ of that name is refused, with what differs" \
    'dots.obj:4: vertex 4 is 10 10 14, but 10 10 15 in the model.s surface dots; expected .* or --name' \
    sinew bind "$T/d/dots.obj" <"$T/bound"
check "unless it gets a name" sinew bind --text --name two "$T/d/dots.obj" -o "$T/both" <"$T/bound"
is "$(array "$T/both" two/vertex.element)$(array "$T/both" dots/vertex.element)" "0 7 0 4 1 6 0 7 0 4 1 6 " "both"
check "--name alone takes one of them" sinew bind --name two -v -o "$T/again" <"$T/both"
is "$(grep -c vertices "$T/stderr")" 1 "only that one"
fails 1 "--name of none" 'no surface three' sinew bind --name three <"$T/both"

# Units.
awk '/^v/ { print "v", $2 / 10, $3 / 10, $4 / 10; next } { print }' "$T/dots.obj" >"$T/cm.obj"
check "--unit" sinew bind --text --unit cm "$T/cm.obj" -o "$T/cm" <"$T/model"
is "$(array "$T/cm" cm/vertex.element)" "0 7 0 4 1 6 " "the same elements"
model -v unit=none >"$T/nounit"
fails 1 "no unit at all" 'no source.unit; expected --unit' sinew bind "$T/dots.obj" <"$T/nounit"
check "a model without, an OBJ with" sinew bind --unit mm "$T/dots.obj" -o "$T/x" <"$T/nounit"
fails 2 "an unknown unit" "expected um, mm, cm, m or in" sinew bind --unit furlong "$T/dots.obj" <"$T/model"
fails 2 "a unit without an OBJ" "unit is for an OBJ" sinew bind --unit mm <"$T/bound"

# Far away.
printf 'v 5 5 5\nv 5 5 55\nv -1e6 5 5\nv 29 5 5\np 1 2 3 4\n' >"$T/far.obj"
check "far vertices are bound all the same" sinew bind --text "$T/far.obj" -o "$T/far" <"$T/model"
is "$(cut -d';' -f1 "$T/stderr")" \
    "bind: warning: surface far: 2 of 4 vertices lie further than a voxel outside the elements, the furthest 1e+06 mm" \
    "with a warning: how many, how far"
is "$(array "$T/far" far/vertex.element)" "0 4 0 1 " "to the nearest"
printf 'v 5 5 5\nv 5 9 5\nv 9 5 5\nv 900 5 5\nf 1 2 3\n' >"$T/unused.obj"
check "vertices that no face uses" sinew bind "$T/unused.obj" -o "$T/x" <"$T/model"
is "$(cat "$T/stderr")" "" "do not matter"
model -v gap=7 >"$T/gap"
check "over a gap in the elements" sinew bind -q --text "$T/dots.obj" -o "$T/x" <"$T/gap"
is "$(array "$T/x" dots/vertex.element)" "0 6 0 4 1 6 " "the nearest that there is"

# Frames and streams.
model -v frames=2 >"$T/frames"
sinew bind -q --text "$T/dots.obj" <"$T/frames" | sed -n '/^frame/,$p' | grep -v '^crc' >"$T/got"
sed -n '/^frame/,$p' "$T/frames" >"$T/want"
check "results pass through" cmp "$T/got" "$T/want"
model -v frames=1 -v ends='fail 3 "tled-run: diverged"' >"$T/failed"
sinew bind --text "$T/dots.obj" <"$T/failed" >"$T/got" 2>"$T/stderr"
is "$?:$(cat "$T/stderr"):$(tail -n 1 "$T/got")" '3::fail 3 "tled-run: diverged"' \
    "a stage before that failed: its status, no words, the failure handed on"
fails 1 "nothing on stdin" "write 'sinew bind'" sinew bind "$T/dots.obj"
model | head -n 40 >"$T/cut"
fails 1 "a model cut short" "stdin" sinew bind "$T/dots.obj" <"$T/cut"

# Models that cannot be bound to.
fails 1 "no surface" 'carries no surface; expected an OBJ: sinew bind surface.obj' sinew bind <"$T/model"
grep -v '^meta lattice.s' "$T/model" >"$T/bad"
fails 1 "no lattice" 'lattice.spacing' sinew bind "$T/dots.obj" <"$T/bad"
model -v nx=0 >"$T/bad"
fails 1 "no elements" 'has no elements' sinew bind "$T/dots.obj" <"$T/bad"
sed 's/^0.01 0 0$/0.012 0 0/' "$T/model" >"$T/bad"
fails 1 "an element that is not its cell" 'element 1 is not the box of its lattice cell 1 0 0' \
    sinew bind "$T/dots.obj" <"$T/bad"

# Tetrahedra: the one that holds the vertex, of several the first, else the nearest; barycentric weights.
cat >"$T/tet" <<'SINEW'
%sinew 1 text
meta source.unit "mm"
axis node 5
axis element 2
array node.position f64 m node 3
0 0 0
0.01 0 0
0 0.01 0
0 0 0.01
0.01 0.01 0.01
array element.node i32 @node element 4
0 1 2 3
4 3 2 1
end
SINEW
printf 'v 1 2 3\nv 0 0 0\nv 5 5 5\nv 4 4 2\nv -2 2 2\nv 30 30 30\np 1 2 3 4 5 6\n' >"$T/in.obj"
check "a model of tetrahedra" sinew bind --text "$T/in.obj" -o "$T/bound" <"$T/tet"
is "$(array "$T/bound" in/vertex.element)" "0 0 1 0 0 1 " "which each vertex is in, or nearest to"
is "$(array "$T/bound" in/vertex.weight | tr ' ' '\n' | awk '{ printf "%.10g ", ($1 * $1 < 1e-24 ? 0 : $1) }')" \
    "0.4 0.1 0.2 0.3 1 0 0 0 0.25 0.25 0.25 0.25 0 0.4 0.4 0.2 0.8 -0.2 0.2 0.2 4 -1 -1 -1 " "weights that sum to 1"
is "$(cut -d';' -f1 "$T/stderr")" \
    "bind: warning: surface in: 1 of 6 vertices lie further than an element outside the elements, the furthest 34.64 mm" \
    "who is far"
is "$(grep -c vertex.blended "$T/bound")" 0 "whose vertices move with their own element"
sed 's/^array in\/vertex.weight/array in\/vertex.blended u8 1 in\/vertex 1\n0\n0\n0\n0\n0\n0\n&/; /^crc/d' "$T/bound" | sed '/^frame/,$d' >"$T/bad"
grep -q '^end' "$T/bad" || echo end >>"$T/bad"
fails 1 "as nothing is blended there" 'in/vertex.blended: the elements are tetrahedra; expected the voxels' \
    sinew deform --frame rest -o "$T/none" "$T/in.obj" <"$T/bad"
sed 's/^0 1 2 3$/0 1 2 2/' "$T/tet" >"$T/flat"
check "one without a volume" sinew bind --text "$T/in.obj" -o "$T/bound" <"$T/flat"
is "$(array "$T/bound" in/vertex.element)$(grep -c '1 of the tetrahedra have no volume' "$T/stderr")" "1 1 1 1 1 1 1" \
    "is passed over, and it is said"
sed 's/^0 1 2 3$/0 1 2 2/; s/^4 3 2 1$/4 4 4 4/' "$T/tet" >"$T/flat"
fails 1 "none with a volume" 'no tetrahedron of the model has a volume' sinew bind -o "$T/none" "$T/in.obj" <"$T/flat"
sed 's/^0 0 0.01$/0 0 nan/' "$T/tet" >"$T/nan"
fails 1 "a node that is nowhere" 'stdin:9: array node.position, row 3: 0 0 nan; expected finite numbers' sinew bind -o "$T/none" "$T/in.obj" <"$T/nan"

# Several files.
check "several files" sinew bind --text "$T/dots.obj" "$T/far.obj" -o "$T/both" <"$T/model"
is "$(array "$T/both" dots/vertex.element)$(array "$T/both" far/vertex.element)" "0 7 0 4 1 6 0 4 0 1 " "are surfaces each"
sinew bind -q "$T/dots.obj" <"$T/model" 2>/dev/null | sinew bind -q --text "$T/far.obj" 2>/dev/null | grep -v ^prov >"$T/one"
grep -v ^prov "$T/both" >"$T/two"
check "as one after the other" cmp "$T/one" "$T/two"
fails 1 "two of one name" 'd/dots.obj: would be named surface dots, as .*/dots.obj is' \
    sinew bind "$T/dots.obj" "$T/d/dots.obj" -o "$T/none" <"$T/model"
fails 2 "two files and one name" 'name names one surface, but 2 files' sinew bind --name x "$T/dots.obj" "$T/far.obj" <"$T/model"

# The command line.
fails 2 "an OBJ on stdin" "'-': the model comes on standard input" sinew bind - <"$T/model"
fails 2 "a name that is the user's" "not x- first" sinew bind --name x-a "$T/dots.obj" <"$T/model"
fails 2 "a name with a slash" "expected at most 200 letters" sinew bind --name a/b "$T/dots.obj" <"$T/model"
fails 2 "an unknown option" "no option --colour" sinew bind --colour x "$T/dots.obj" <"$T/model"
fails 1 "a bad surface leaves no file" "no vertices" sinew bind -o "$T/none" /dev/null <"$T/model"
[ ! -e "$T/none" ]
is $? 0 "none"
done_testing
