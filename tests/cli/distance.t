#!/bin/sh
# sinew distance: shapes whose distances are known, VTK's distances on the real face, properties, and what it refuses.
. "$(dirname "$0")/lib.sh"
. "$ROOT/tests/cli/boxes.sh"

# figure COLUMN REGION [FROM] of the TSV in $T/stdout.
figure() {
    awk -F '\t' -v column="$1" -v region="$2" -v from="${3:-A}" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == column || $i == column "/mm") at = i }
        NR > 1 && $1 == from && $2 == region { print $at }' "$T/stdout"
}
# measured NAME ARGS...: the TSV of it.
measured() {
    measured_name=$1
    shift
    check "$measured_name" sinew distance -q --tsv "$@"
}
# plane NAME N SIDE Z [X Y]: N x N squares in one plane, which face up.
plane() {
    awk -v name="$1" -v n="$2" -v side="$3" -v z="$4" -v x="${5:-0}" -v y="${6:-0}" 'BEGIN {
        print "g " name
        for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) printf "v %.17g %.17g %.17g\n", x + side * i / n, y + side * j / n, z
        k = (n + 1) * (n + 1)
        for (j = 0; j < n; j++) for (i = 0; i < n; i++) { a = i + j * (n + 1) - k; print "f", a, a + 1, a + n + 2, a + n + 1 } }'
}

# ---- Planes: a small one over a large one, and over one of its own size.
plane sheet 4 10 5 1 1 >"$T/small.obj"
plane floor 3 20 0 -3 -3 >"$T/floor.obj"
plane floor 4 10 0 1 1 >"$T/same.obj"
measured "a plane over a larger one" --unit mm "$T/small.obj" "$T/floor.obj"
for column in mean rms median p95 largest signed; do
    near "$(figure $column all)" 5 1e-15 "its $column"
done
is "$(figure vertices all) $(figure border all) $(grep -c . "$T/stdout")" "25 0 2" "all of its vertices count, in one row"
measured "from below" --unit mm "$T/floor.obj" "$T/small.obj"
is "$(figure vertices all) $(figure border all) $(figure largest all)" "4 12 5" "what lies beside the border is left out"
near "$(figure signed all)" -5 1e-15 "and the others are inside"
check "and is told" sh -c "sinew distance --unit mm $T/floor.obj $T/small.obj 2>&1 >$T/table | grep -c '^sinew-distance: 12 of 16 vertices of .*floor.obj have their nearest point on the border of .*small.obj and are left out'"
measured "over one of its size" --unit mm "$T/small.obj" "$T/same.obj"
is "$(figure vertices all) $(figure border all) $(figure mean all)" "9 16 5" "what lies over the border is at it"
plane sheet 1 1 5 50 50 >"$T/beside.obj"
measured "a plane beside it" --unit mm "$T/beside.obj" "$T/same.obj"
is "$(figure vertices all) $(figure border all) $(figure mean all) $(figure median all) $(figure largest all) $(figure signed all)" \
    "0 4 nan nan nan nan" "no vertex is left, and no figure"

# ---- Spheres about one middle: from each vertex of the outer one to the vertex below it; back to the faces above.
awk -v r=10 -v n=40 -v g=inner -f tests/cli/sphere.awk >"$T/inner.obj"
awk -v r=12 -v n=40 -v g=outer -f tests/cli/sphere.awk >"$T/outer.obj"
measured "spheres of 12 and 10 mm" --both --unit mm "$T/outer.obj" "$T/inner.obj"
for column in mean rms median p95 largest signed hausdorff; do
    near "$(figure $column all)" 2 1e-7 "their $column"
done
for column in mean rms median p95 largest; do
    near "$(figure $column all B)" 2 2e-3 "back: $column, as the faces of the outer one are within 12 mm"
done
near "$(figure signed all B)" -2 2e-3 "the inner one is inside"
is "$(figure hausdorff all B)" nan "the symmetric distance stands with A"

# ---- Boxes: distances from corners to faces, edges and corners; and onto the surface.
box b 0 0 0 10 10 10 >"$T/box.obj"
box in 3 4 5 6 6 6 >"$T/in.obj"
box out -1 -2 -2 11 13 14 >"$T/out.obj"
box moved 3 2 1 13 12 11 >"$T/moved.obj"
sinew distance -q --unit mm --points "$T/points" "$T/in.obj" "$T/box.obj" >"$T/table"
is "$(awk 'NR > 1 { print $1, $6 }' "$T/points" | tr '\n' ' ')" "1 -3 2 -4 3 -3 4 -4 5 -3 6 -4 7 -3 8 -4 " "a box inside: the distance to the nearest face"
sinew distance -q --unit mm --points "$T/points" "$T/out.obj" "$T/box.obj" >"$T/table"
is "$(awk 'NR > 1 { printf "%.12g ", $6 * $6 }' "$T/points")" "9 9 14 14 21 21 26 26 " "a box about it: to the corners, squared"
is "$(awk 'NR > 1 { print $7, $8, $9 }' "$T/points" | tr '\n' '/')" "0 0 0/10 0 0/0 10 0/10 10 0/0 0 10/10 0 10/0 10 10/10 10 10/" "whose places are told"
sinew distance -q --unit mm --points "$T/points" "$T/moved.obj" "$T/box.obj" >"$T/table"
is "$(awk 'NR > 1 { printf "%.12g ", $6 < 0 ? -$6 * $6 : $6 * $6 }' "$T/points")" "-1 9 4 13 1 10 5 14 " "a box moved by 3, 2 and 1"
is "$(awk 'NR == 1' "$T/points")" "$(printf 'vertex\tx/mm\ty/mm\tz/mm\tdistance/mm\tsigned/mm\tnearest.x/mm\tnearest.y/mm\tnearest.z/mm')" "the columns"
sinew distance -q --tsv --unit mm "$T/box.obj" "$T/box.obj" >"$T/stdout"
is "$(figure largest all) $(figure signed all) $(figure vertices all)" "0 0 8" "a box from itself"
soup "$T/box.obj" >"$T/soup.obj"
sinew distance -q --unit mm --points "$T/back" "$T/moved.obj" "$T/soup.obj" >"$T/table"
check "a box whose polygons have vertices of their own is the same" cmp "$T/points" "$T/back"

# ---- Weights by area: 100 mm2 at 1 mm, 1 mm2 at 3 mm.
{
    plane big 1 10 1 0 0
    plane little 1 1 3 12 12
    echo 'g wire'
    echo 'l 1 2 3'
    echo 'v 90 90 90'
} >"$T/two.obj"
measured "two planes" --unit mm "$T/two.obj" "$T/floor.obj"
near "$(figure mean all)" "$(awk 'BEGIN { printf "%.17g", 103 / 101 }')" 1e-14 "a mean by area"
near "$(figure rms all)" "$(awk 'BEGIN { printf "%.17g", sqrt(109 / 101) }')" 1e-14 "a root of the mean square"
is "$(figure median all) $(figure p95 all) $(figure largest all) $(figure vertices all)" "1 1 3 8" "quantiles by area, and the largest"
is "$(figure mean big) $(figure mean little) $(cut -f 2 "$T/stdout" | tr '\n' ' ')" "1 3 region all big little " "a row for each group of polygons"

# ---- Regions.
box zone 11 11 2 14 14 4 >"$T/zone.obj"
gzip -c "$T/zone.obj" >"$T/zone.obj.gz"
measured "regions" --unit mm --region 'one=BI*' --region "two=1.1cm,11,0,14,14,4" --region "three=$T/zone.obj" --region "four=$T/zone.obj.gz" --region 'all of it=*' \
    "$T/two.obj" "$T/floor.obj"
is "$(cut -f 2,3,5 "$T/stdout" | tail -n +2 | tr '\t\n' ' /')" \
    "one 4 1/two 4 3/three 4 3/four 4 3/all of it 8 $(figure mean 'all of it')/" "a group, a box, a closed OBJ, all"
measured "some polygons of each" --unit mm --both --of little --to 'fl*' "$T/two.obj" "$T/floor.obj"
is "$(cut -f 1-3 "$T/stdout" | tail -n +2 | tr '\t\n' ' /')" "A all 4/B all 0/" "--of and --to"
is "$(figure border all B)" 16 "of which all lie beside"

# ---- Both ways: the same as one way and the other, and no order.
awk -v r=9 -v n=7 -f tests/cli/sphere.awk | awk '$1 == "v" { print "v", $2 + 1, $3 * 1.2, $4 + .5 * $2; next } { print }' >"$T/egg.obj"
sinew distance -q --tsv --unit mm --both "$T/egg.obj" "$T/inner.obj" >"$T/stdout"
there=$(figure hausdorff all) largest=$(figure largest all B)
tail -n +2 "$T/stdout" | cut -f 3-10 >"$T/both"
{
    sinew distance -q --tsv --unit mm "$T/egg.obj" "$T/inner.obj" | tail -n +2
    sinew distance -q --tsv --unit mm "$T/inner.obj" "$T/egg.obj" | tail -n +2
} | cut -f 3-10 >"$T/each"
check "both ways are the two ways" cmp "$T/both" "$T/each"
is "$(sinew distance -q --tsv --unit mm --both "$T/inner.obj" "$T/egg.obj" | awk 'NR == 2 { print $NF }')" "$there" "the Hausdorff distance is symmetric"
check "and the larger of two" test "$there" = "$largest" -o "$there" = "$(figure largest all)"
check "in words" sh -c "sinew distance --unit mm --both $T/egg.obj $T/inner.obj | grep -A 3 '^Symmetric Hausdorff distance, mm:' | grep -q '^  all .*$(printf %.4f "$there")'"

# ---- Units, pipes, threads.
sinew distance -q --tsv --unit mm --region 'x=-5,-5,0,5,5,9cm' "$T/egg.obj" "$T/inner.obj" >"$T/stdout"
mean=$(figure mean x)
for unit in 'um .001' 'cm 10' 'm 1000' 'in 25.4'; do
    awk -v by="${unit#* }" '{ if ($1 == "v") printf "v %.17g %.17g %.17g\n", $2 / by, $3 / by, $4 / by; else print }' "$T/egg.obj" >"$T/a"
    awk -v by="${unit#* }" '{ if ($1 == "v") printf "v %.17g %.17g %.17g\n", $2 / by, $3 / by, $4 / by; else print }' "$T/inner.obj" >"$T/b"
    sinew distance -q --tsv --unit "${unit% *}" --region "x=-5mm,-5mm,0,5mm,5mm,9cm" "$T/a" "$T/b" >"$T/stdout"
    near "$(figure mean x)" "$mean" 1e-12 "in ${unit% *}: the same mm"
done
sinew distance -q --both --unit mm --points "$T/one" --threads 1 "$T/outer.obj" "$T/egg.obj" >"$T/first"
sinew distance -q --both --unit mm --points "$T/four" --threads 4 "$T/outer.obj" "$T/egg.obj" >"$T/second"
check "any number of threads: the same points" cmp "$T/one" "$T/four"
check "and tables" cmp "$T/first" "$T/second"
gzip -c "$T/egg.obj" >"$T/egg.obj.gz"
gzip -c "$T/egg.obj" | sinew distance -q --tsv --unit mm -o "$T/piped" "$T/outer.obj" -
sinew distance -q --tsv --unit mm "$T/outer.obj" "$T/egg.obj.gz" >"$T/plain"
check "gzip, and standard input" cmp "$T/piped" "$T/plain"
# A shape turned inside out, and one of whose faces is.
awk '$1 == "f" { print $1, $5, $4, $3, $2; next } { print }' "$T/box.obj" >"$T/inward.obj"
check "what faces inward is told" sh -c "sinew distance --unit mm $T/in.obj $T/inward.obj 2>&1 >$T/table | grep -q '^sinew-distance: warning: .*inward.obj: a closed surface that faces inward: what is inside has positive signs'"
awk '$1 == "f" && !done++ { print $1, $5, $4, $3, $2; next } { print }' "$T/box.obj" >"$T/turned.obj"
check "and a face that does" sh -c "sinew distance --unit mm $T/in.obj $T/turned.obj 2>&1 >$T/table | grep -q 'turned.obj: at 4 edges two polygons face different sides'"

# ---- VTK's distances and signs.
python=
for p in python3 /usr/bin/python3; do
    "$p" -c 'import vtkmodules.vtkFiltersCore' 2>/dev/null && python=$p && break
done
# by_vtk NAME WANT A B: to 1e-6 mm; WANT: differing signs, vertices without one.
by_vtk() {
    if [ -z "$python" ]; then
        skip 1 "no VTK for Python (python3-vtk9): $1"
        return
    fi
    sinew distance -q --unit mm --points "$T/points" "$3" "$4" >"$T/table"
    "$python" tests/cli/vtk_distance.py "$4" "$T/points" >"$T/vtk" 2>&1
    # shellcheck disable=SC2016 # awk's
    check "$1: VTK's distances ($(cat "$T/vtk"))" awk -v want="$2" '{ seen = $3 " " $4; if ($2 == "" || $2 > 1e-6 || seen != want) exit 1 } END { exit !NR }' "$T/vtk"
}
triangles() {
    awk '$1 == "f" { for (i = 3; i < NF; i++) print "f", $2, $i, $(i + 1); next } { print }' "$1"
}
triangles "$T/egg.obj" >"$T/egg3.obj"
by_vtk "a sphere to an egg" "0 0" "$T/outer.obj" "$T/egg3.obj"
face=$DATA/face/face_zyg.obj
if [ "$DATA" ] && [ -r "$face" ]; then
    awk '$1 == "v" { printf "v %.9g %.9g %.9g\n", $2 * .999 + $3 * .02 + 1.5, $3 * .999 - $2 * .02 - 2, $4 + .7; next } { print }' "$face" >"$T/turned_face.obj"
    by_vtk "the face to the face turned" "0 0" "$face" "$T/turned_face.obj"
else
    skip 1 "no data: the face"
fi

# ---- What is refused: one line, no report, no file.
refuse() { # STATUS PATTERN ARGS...
    refuse_status=$1 refuse_pattern=$2
    shift 2
    rm -f "$T/left" "$T/points"
    fails "$refuse_status" "refused: $refuse_pattern" "^sinew-distance: .*$refuse_pattern" sinew distance -o "$T/left" --points "$T/points" "$@"
    if [ -e "$T/left" ] || [ -e "$T/points" ]; then not_ok "no file is left by it"; fi
    [ "$(grep -c '^sinew-distance' "$T/stderr")" -eq 1 ] || not_ok "one message"
}
echo 'v 1 2 3' >"$T/bare.obj"
printf 'v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n' >"$T/nan.obj"
printf 'v 0 0 0\nv 1 1e200 0\nv 0 1 0\nf 1 2 3\n' >"$T/vast.obj"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n' >"$T/broken.obj"
sed '$d' "$T/zone.obj" >"$T/open.obj"
box far 50 50 50 60 60 60 >"$T/far.obj"
refuse 2 'missing option --unit; expected --unit um|mm|cm|m|in' "$T/two.obj" "$T/floor.obj"
refuse 2 "--unit 'pc': expected um, mm, cm, m or in" --unit pc "$T/two.obj" "$T/floor.obj"
refuse 2 'missing operand; expected A.obj B.obj' --unit mm "$T/two.obj"
refuse 2 'both operands are standard input; expected one file at least' --unit mm - -
refuse 1 'none.obj: cannot open: No such file' --unit mm "$T/none.obj" "$T/two.obj"
refuse 1 'bare.obj: no polygon; expected a surface' --unit mm "$T/two.obj" "$T/bare.obj"
refuse 1 "nan.obj:2: .*'nan'" --unit mm "$T/nan.obj" "$T/two.obj"
refuse 1 'vast.obj:2: vertex 2 has the coordinate 1e\+200 mm; expected at most 1e\+100 mm' --unit mm "$T/two.obj" "$T/vast.obj"
refuse 1 'broken.obj:4: vertex 4, but the file has 3' --unit mm "$T/broken.obj" "$T/two.obj"
refuse 2 "--region 'big': expected NAME=REGION" --unit mm --region big "$T/two.obj" "$T/floor.obj"
refuse 2 "--region '=big': expected NAME=REGION" --unit mm --region =big "$T/two.obj" "$T/floor.obj"
refuse 2 "two regions are named 'a'" --unit mm --region a=big --region a=little "$T/two.obj" "$T/floor.obj"
refuse 2 "unknown group of .*two.obj 'bigg'; did you mean 'big'\? expected one of: big, little, wire" --unit mm --region a=bigg "$T/two.obj" "$T/floor.obj"
refuse 2 "--of: unknown group of .*two.obj 'littel'; did you mean 'little'" --unit mm --of littel "$T/two.obj" "$T/floor.obj"
refuse 2 "--to: unknown group of .*floor.obj 'big'; expected one of: floor" --unit mm --to big "$T/two.obj" "$T/floor.obj"
refuse 2 "unknown group of .*floor.obj 'big'" --unit mm --both --region a=big "$T/two.obj" "$T/floor.obj"
refuse 2 "group 'wire' of .*two.obj has no polygon; expected one with some" --unit mm --region a=wire "$T/two.obj" "$T/floor.obj"
refuse 2 "--of: group 'wire' of .*two.obj has no polygon; expected one with some" --unit mm --of wire "$T/two.obj" "$T/floor.obj"
refuse 2 'a=1,2,3: expected X0,Y0,Z0,X1,Y1,Z1: a box' --unit mm --region a=1,2,3 "$T/two.obj" "$T/floor.obj"
refuse 2 'the box is empty: 9 mm > 1 mm; expected the low corner first' --unit mm --region a=9,0,0,1,1,1 "$T/two.obj" "$T/floor.obj"
refuse 2 'no triangle of .*two.obj lies in the box 50,50,50,60,60,60; expected' --unit mm --region a=50,50,50,60,60,60 "$T/two.obj" "$T/floor.obj"
refuse 2 'no triangle of .*two.obj lies inside of .*far.obj; expected a closed surface around some' --unit mm --region "a=$T/far.obj" "$T/two.obj" "$T/floor.obj"
refuse 1 'open.obj is not closed: 4 open edges, the first at [0-9.]*mm,[0-9.]*mm,[0-9.]*mm; expected each edge' --unit mm --region "a=$T/open.obj" "$T/two.obj" "$T/floor.obj"
refuse 1 'bare.obj has no polygons; expected a closed surface' --unit mm --region "a=$T/bare.obj" "$T/two.obj" "$T/floor.obj"
refuse 1 'none.obj: cannot open' --unit mm --region "a=$T/none.obj" "$T/two.obj" "$T/floor.obj"
fails 2 "points on standard output" "--points '-': standard output has the table; expected a file" sinew distance --unit mm --points - "$T/two.obj" "$T/floor.obj"
cp "$T/two.obj" "$T/kept"
fails 2 "points over what is read" "^sinew-distance: --points .*two.obj" sinew distance --unit mm --points "$T/two.obj" "$T/two.obj" "$T/floor.obj"
check "which stays" cmp "$T/kept" "$T/two.obj"
done_testing
