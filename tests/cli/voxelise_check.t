#!/bin/sh
# voxelise --check: what it says of surfaces with one thing wrong each, of volumes, and of names.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

# look ARGS...: the report with all of each surface into $T/report, messages into $T/said.
look() {
    voxelise -v --check --unit mm "$@" >"$T/report" 2>"$T/said"
    status=$?
}
# of WHAT KEY: the value in the block that begins with the line WHAT; KEY as the report has it.
of() {
    awk -v what="$1" -v key="$2" '/^[a-z]/ { on = $0 == what; next }
        on { name = substr($0, 3, 32); sub(/ *$/, "", name); if (name == key) print substr($0, 35) }' "$T/report"
}
# said NAME PATTERN
said() {
    if grep -Eq -e "$2" "$T/said"; then
        ok "$1"
    else
        not_ok "$1"
        diag_file "$T/said"
    fi
}
# numbers WHAT: what is counted of it, on one line.
numbers() {
    for key in polygons triangles vertices shells "edges of one polygon (open)" "edges of more than two" \
        "edges where facing turns" "polygons given again" "triangles without area" "pairs of triangles that cross"; do
        printf '%s ' "$(of "$1" "$key")"
    done
}

box skin 0 0 0 2 3 4 >"$T/box.obj"
look "$T/box.obj"
is "$status $(numbers 'surface skin')" "0 6 12 8 1 0 0 0 0 0 0 " "a box has nothing wrong"
is "$(of 'surface skin' box), $(of 'surface skin' area), $(of 'surface skin' encloses)" \
    "0 0 0 to 2 3 4 mm, 52 mm^2, 24 mm^3" "its box, area and volume"
is "$(of 'surface skin' bounds), $(of 'volume skin' closed), $(of 'volume skin' surfaces)" "skin, yes, skin" "its volume"
is "$(of 'surface skin' 'thinner than a voxel')" "" "without a size nothing is said of thinness"
is "$(grep -c '%sinew' "$T/report")" 0 "no model is written"
look -o "$T/o.txt" "$T/box.obj"
check "-o: the report goes there" grep -q "^surface skin" "$T/o.txt"
soup "$T/box.obj" >"$T/soup.obj"
look "$T/soup.obj"
is "$status $(numbers 'surface skin')" "0 6 12 8 1 0 0 0 0 0 0 " "a soup is welded by places"

# One thing wrong each.
sed '$d' "$T/box.obj" >"$T/open.obj"
look "$T/open.obj"
is "$status $(numbers 'surface skin')$(of 'surface skin' encloses)" "1 5 10 8 1 4 0 0 0 0 0 nothing: it is open" "a face is missing"
said "that fails as a run would" "open.obj: 4 open edges; expected every edge"
is "$(of 'volume skin' closed)" "no: 4 open edges, the first at 2mm,1.5mm,0mm" "its volume is open"
look --allow-open "$T/open.obj"
is "$status" 0 "--allow-open does not fail"
sed 's/^f -8 -6 -5 -7$/f -7 -5 -6 -8/' "$T/box.obj" >"$T/turned.obj"
look "$T/turned.obj"
is "$status $(numbers 'surface skin')$(of 'surface skin' encloses)" "0 6 12 8 1 0 0 4 0 0 0 24 mm^3" "a face is turned"
sed 's/^f -8 -6 -5 -7$/&\nf -6 -5 -7 -8/' "$T/box.obj" >"$T/again.obj"
look "$T/again.obj"
is "$status $(numbers 'surface skin')" "0 7 12 8 1 0 0 0 1 0 0 " "a face is given twice"
said "that is a warning" "warning: volume skin repeats polygons \(1 of them\): each counts once"
{
    cat "$T/box.obj"
    printf 'v 1 0 0\nf -9 -1 -9\n'
} >"$T/none.obj"
look "$T/none.obj"
is "$(of 'surface skin' triangles) $(of 'surface skin' 'triangles without area')" "13 1" "a triangle without area"
{
    box skin 0 0 0 1 1 1
    box skin 1 1 0 2 2 1
} >"$T/crowded.obj"
look "$T/crowded.obj"
is "$(of 'surface skin' 'edges of more than two')" 1 "an edge of three polygons and more"
{
    box skin 0 0 0 4 4 4
    box skin 1 1 1 2 2 2
    box skin 2 2 6 3 3 7
} >"$T/shells.obj"
look "$T/shells.obj"
is "$(of 'surface skin' shells) $(of 'surface skin' encloses)" "3 64 mm^3" "three shells: one is a hollow"
{
    box skin 0 0 0 4 4 4
    box skin 2 2 2 6 6 6.5
} >"$T/cross.obj"
look "$T/cross.obj"
is "$status" 0 "two boxes that cross"
is "$([ "$(of 'surface skin' 'pairs of triangles that cross')" -ge 6 ] && echo many)" many "their triangles cross"
said "that is a warning" "warning: surface skin crosses itself \([0-9]+ pairs of triangles\)"
is "$(of 'surface skin' encloses)" "136 mm^3 if nothing crossed" "what it encloses is not known then"
{
    box skin 0 0 0 4 4 4
    box skin 2 2 2 6 6 6
} >"$T/half.obj"
look "$T/half.obj"
is "$([ "$(of 'surface skin' 'pairs of triangles that cross')" -ge 6 ] && echo many)" many "edges that cross edges"
{
    box skin 0 0 0 4 4 4
    box skin 4 0 0 8 4 4
    box skin 4 4 4 5 5 5
} >"$T/touch.obj"
look "$T/touch.obj"
is "$(of 'surface skin' 'pairs of triangles that cross')" 0 "what touches does not cross"

# Thousands of shells within one, a third of them solid in hollows.
awk 'function box(x, y, z, h, i) {
        for (i = 0; i < 8; i++) print "v", x + (i % 2 ? h : -h), y + (int(i / 2) % 2 ? h : -h), z + (i > 3 ? h : -h)
        print "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3"
    }
    BEGIN {
        print "g skin"
        box(50, 50, 50, 64)
        for (n = 0; n < 1000; n++) {
            x = 10 * (n % 10); y = 10 * (int(n / 10) % 10); z = 10 * int(n / 100)
            box(x, y, z, 4); box(x, y, z, 3); box(x, y, z, 2)
        }
    }' >"$T/many.obj"
look "$T/many.obj"
is "$(of 'surface skin' shells) $(of 'surface skin' encloses)" \
    "3001 1.73715e+06 mm^3" "shells in shells in shells: 128^3 - 1000 (8^3 - 6^3 + 4^3)"

# Several surfaces of a volume, and their sizes.
{
    box skin 0 0 0 10 10 10
    box skull 1 1 1 9 9 9
    box muscle_a 2 0 0 4 10 0.5
} >"$T/head.obj"
look -s 2 "$T/head.obj"
is "$(of 'surface skull' bounds) $(of 'volume skin' surfaces)" "skin skin skull" "skin and skull"
is "$(of 'volume skin' encloses) $(of 'volume skin' shells)" "488 mm^3 2" "together"
is "$(of 'volume skin' 'level, priority') $(of 'volume muscle_a' 'level, priority')" "0, 0 1, 0" "levels and priorities"
is "$(of 'surface skin' 'thinner than a voxel')" "0 % of its area" "skin alone is thick"
is "$(voxelise --check --unit mm -s 2 "$T/head.obj" 2>"$T/stderr")" \
    "                      edges  edges   edges  poly.  pairs  thin
  surface   polygons   open    > 2  turned  again  cross     %
  skin             6      0      0       0      0      0     0
  skull            6      0      0       0      0      0     0
  muscle_a         6      0      0       0      0      0    77  !

                             edges
  volume    level  priority   open    surfaces
  skin          0         0      0    skin skull
  muscle_a      1         0      0    muscle_a" "without -v: a row for each, and a mark"
is "$(voxelise --check --unit mm --allow-open "$T/open.obj" 2>"$T/stderr" | grep '!$\|! ')" "  skin        0         0      4  !  skin" \
    "an open volume is marked"
said "a flat muscle" "warning: 2 surfaces are thinner than a voxel over more than half of their area: muscle_a \([0-9.]+ %\), volume skin \([0-9.]+ %\); whether"
look -s 2,2,0.25 "$T/head.obj"
is "$(of 'surface muscle_a' 'thinner than a voxel')" "0 % of its area" "not with flat voxels"
look -s 1e-3 "$T/head.obj"
is "$(grep -c warning "$T/said")" 0 "nor with small ones"

# Names.
{
    box musle_a 0 0 0 1 1 1
    box skin 0 0 0 4 4 4
    echo "g muscle_empty"
} >"$T/names.obj"
look "$T/names.obj"
said "a name that is all but one" "warning: the name of surface musle_a begins with no known word; did you mean one that begins with muscle?"
said "a name without polygons" "warning: surface muscle_empty has no polygon"
printf 'a surfaces=skin\n' >"$T/volumes"
look --volumes "$T/volumes" "$T/names.obj"
said "a surface in no volume" "warning: .*surface 'musle_a' is in no volume"
is "$(of 'surface musle_a' bounds)" "no volume" "the report says so too"
fails 2 "a unit is needed" "an OBJ does not say its unit" voxelise --check "$T/box.obj"

if [ -n "$DATA" ]; then
    look -s 2.5 "$DATA/face/face_zyg.obj"
    is "$status $(of 'surface skin' 'edges of one polygon (open)') $(of 'surface skull' 'edges of one polygon (open)') $(of 'volume skin' 'edges of one polygon (open)')" \
        "0 302 302 0" "the real face: skin and skull are open, and closed together"
    is "$(of 'volume skin' encloses)" "379257 mm^3" "what it encloses"
else
    skip 2 "no shared data"
fi
done_testing
