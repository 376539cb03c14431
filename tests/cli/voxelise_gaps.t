#!/bin/sh
# What voxels do not resolve is warned of: gaps between surfaces that elements fill, by centres and by shares, and layers thinner than a
# voxel; with count, place, and the voxel that it takes. A block with a slit says how many there must be.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/cli/boxes.sh
. tests/cli/boxes.sh
export SINEW_THREADS=2

# vox ARGS...: the elements, and what is said of gaps and layers: "COUNT PLACE WIDTH VOXEL", or "none".
vox() {
    voxelise --unit mm --slits off -o "$T/m" "$@" 2>"$T/said" || diag_file "$T/said"
    sed -n 's/^voxelise: \([0-9]*\) elements, .*/\1:/p' "$T/said" | tr '\n' ' '
    said=$(sed -n 's/^voxelise: warning: elements fill gaps between surfaces in \([0-9]*\) places\{0,1\} .* as at \([^ ]*\), where the gap is \([^ ]*\) mm wide along \(.\): .* voxels of at most \(.*\) mm separate them in half.*/\1 \2 \3 \4 \5/p' "$T/said")
    echo "${said:-none}"
}
# slit WIDTH [TURN]
slit() {
    awk -v w="$1" -v turn="${2:-0}" -v name="$3" -f tests/cli/slit.awk >"$T/slit.obj"
}

slit 2
is "$(vox -s 2 "$T/slit.obj")" "7800: none" "a slit of a voxel's width, by centres: cut, and nothing is said"
is "$(vox -s 2 --fraction 8 "$T/slit.obj")" "8000: 200 20mm,1mm,31mm 2 x 1" "by shares it is filled, all of it: 20 x 10 places"
is "$(vox -s 1 --fraction 8 "$T/slit.obj" | sed 's/.*: //')" none "voxels of the size that is asked for part it"
is "$(vox -s 2 --fraction 8 --least 0.6 "$T/slit.obj")" "7600: none" "and so does a larger --least"
slit 0.2
is "$(vox -s 2 "$T/slit.obj")" "8000: 200 20mm,1mm,31mm 0.2 x 0.2" "a slit narrower than a voxel is filled by centres too"
is "$(vox -s 2 --fraction 8 "$T/slit.obj")" "8000: 200 20mm,1mm,31mm 0.2 x 0.1" "and by shares"
slit 3
is "$(vox -s 2 --fraction 8 "$T/slit.obj")" "8000: 200 20mm,1mm,31mm 3 x 1.5" "wider than a voxel, in two halves of voxels"
is "$(vox -s 1.5 --fraction 8 "$T/slit.obj" | sed 's/.*: //')" none "where it ends within a voxel is no place"
slit 4.1
is "$(vox -s 2 --fraction 8 "$T/slit.obj")" "7600: none" "two voxels wide it stays open"
slit 0.2
is "$(vox -s 2,2,1 "$T/slit.obj")" "16000: 400 20mm,1mm,30.5mm 0.2 x 0.2 x 0.2 x 0.1" "flat voxels, all three sides"
is "$(vox -s 2 --box 0,0,0,40,20,40 --origin 0,0,0 "$T/slit.obj")" "4000: 100 20mm,1mm,31mm 0.2 x 0.2" "within a --box"
awk -v OFMT=%.12g '$1 == "v" { print "v", $4, $2 - 1e6, $3; next } { print }' "$T/slit.obj" >"$T/far.obj"
is "$(vox -s 2 "$T/far.obj")" "8000: 200 21mm,-999980mm,21mm 0.2 y 0.2" "another axis, far away"
awk '$1 == "f" { printf "f"; for (i = NF; i > 1; i--) printf " %s", $i; print ""; next } { print }' "$T/slit.obj" >"$T/inward.obj"
is "$(vox -s 2 "$T/inward.obj")" "8000: 200 20mm,1mm,31mm 0.2 x 0.2" "a surface that faces inward"
vox -s 2 --threads 1 "$T/slit.obj" >"$T/one"
vox -s 2 --threads 7 "$T/slit.obj" >"$T/seven"
check "the same for any number of threads" cmp "$T/one" "$T/seven"

# Turned by 30 degrees: lines along x meet it over 40 cos 30 of y, where it is 1 / cos 30 wide.
slit 1 30
vox -s 2 --fraction 4 "$T/slit.obj" >"$T/got"
near "$(cut -d ' ' -f 2 "$T/got")" 173.2 0.06 "a slit that is turned: each place once"
near "$(cut -d ' ' -f 4 "$T/got")" 1.1547 0.005 "and its width along the axis"
is "$(vox -s 0.5 --fraction 4 "$T/slit.obj" | sed 's/.*: //')" none "which voxels of half of that part"

# No gap is bridged: nothing is said.
awk -v r=50 -v n=24 -f tests/cli/sphere.awk >"$T/ball.obj"
for more in "" "--fraction 4"; do
    # shellcheck disable=SC2086
    is "$(vox -s 7 $more "$T/ball.obj" | sed 's/.*: //')" none "a sphere $more"
done
awk -f samples/shape.awk -f samples/head.awk >"$T/head.obj"
for more in "" "--fraction 4"; do
    # shellcheck disable=SC2086
    is "$(vox -s 4 $more "$T/head.obj" | sed 's/.*: //')" none "the head of our samples $more"
done
{ box skin 0 0 0 40 40 40 && box bone 19.9 4 4 20.1 36 36; } >"$T/bone.obj"
is "$(vox -s 2 "$T/bone.obj")" "8000: none" "bone thinner than a voxel, within tissue: its nodes are fixed"
slit 0.2 0 bone
is "$(vox -s 2 "$T/slit.obj")" "8000: none" "and walls that are bone"
{ box skin 0 0 0 20.1 40 40 && box skin 19.9 0 0 40 40 40; } >"$T/overlap.obj"
is "$(vox -s 2 "$T/overlap.obj" | sed 's/.*: //')" none "surfaces that overlap: what is inside twice is no gap"
slit 0.2
sed '$d' "$T/slit.obj" >"$T/open.obj"
is "$(vox -s 2 --allow-open "$T/open.obj" | sed 's/.*: //')" none "an open surface: what is inside is a guess"

{ cat "$T/slit.obj" && box muscle 2 2 2 8 8 8 | sed '$d'; } >"$T/open.obj"
is "$(vox -s 2 --allow-open "$T/open.obj" | sed 's/.*: //')" "200 20mm,1mm,31mm 0.2 x 0.2" "an open muscle is no concern of level 0"
vox -s 2,2,1 "$T/slit.obj" >"$T/got"
check "the area of all places: 20 x 40" grep -q "in 400 places of a voxel's width, 800 mm^2, as at" "$T/said"

# Two volumes with a gap between, or none.
printf 'a priority=0 surfaces=left\nb priority=1 surfaces=right\n' >"$T/volumes"
{ box left 0 0 0 19.9 40 40 && box right 20.1 0 0 40 40 40; } >"$T/two.obj"
is "$(vox -s 2 --volumes "$T/volumes" "$T/two.obj")" "8000: 400 20mm,1mm,21mm 0.2 x 0.2" "between two volumes"
{ box left 0 0 0 20 40 40 && box right 20 0 0 40 40 40; } >"$T/two.obj"
is "$(vox -s 2 --volumes "$T/volumes" "$T/two.obj")" "8000: none" "two that touch"
{ box left 0 0 0 20 40 40 && box right 0 0 0 40 40 40; } >"$T/two.obj"
is "$(vox -s 2 --volumes "$T/volumes" "$T/two.obj")" "8000: none" "two that overlap"
is "$(vox -s 2 --fraction 2 --volumes "$T/volumes" "$T/two.obj")" "8000: none" "by shares too"

# A curved interface, of which each side has triangles of its own: a ball within a skin's cavity.

# facets SECOND NAME FORMAT FILE: an OBJ's quadrangles as triangles from the first corner or the second; a bump makes them warped.
facets() {
    awk -v second="$1" -v name="$2" -v format="$3" '$1 == "v" {
            r = 1 + .02 * sin($2 / 4) * sin($3 / 5 + $4 / 6)
            printf "v %." format " %." format " %." format "\n", $2 * r, $3 * r, $4 * r }
        $1 == "g" { print "g", name }
        $1 == "f" { for (i = 2; i <= NF; i++) c[i - 2] = $i
            if (NF == 4) print "f", c[0], c[1], c[2]
            else if (second) print "f", c[1], c[2], c[3] "\nf", c[3], c[0], c[1]
            else print "f", c[0], c[1], c[2] "\nf", c[2], c[3], c[0] }' "$4"
}
# touching ORGAN.obj: within a box whose cavity is the ball of 24 bands.
touching() {
    box outer -40 -40 -40 40 40 40
    facets 0 cavity 9g "$T/ball24.obj" | awk '$1 == "f" { print "f", $4 + 8, $3 + 8, $2 + 8; next } { print }'
    awk -v n="$((8 + $(grep -c '^v ' "$T/ball24.obj")))" '$1 == "f" { print "f", $2 + n, $3 + n, $4 + n; next } { print }' "$1"
}
printf 'skin priority=0 surfaces=outer,cavity\norgan priority=1 surfaces=organ\n' >"$T/volumes"
for n in 24 32; do
    awk -v r=25 -v n=$n -f tests/cli/sphere.awk >"$T/ball$n.obj"
done
for how in "1 9g 24 cut the other way" "1 6g 24 and rounded" "1 3f 24 and rounded to a micrometre" "0 9g 32 with other vertices"; do
    # shellcheck disable=SC2086
    set -- $how
    facets "$1" organ "$2" "$T/ball$3.obj" >"$T/organ.obj"
    touching "$T/organ.obj" >"$T/touching.obj"
    shift 3
    is "$(vox -s 2.5 --volumes "$T/volumes" "$T/touching.obj" | sed "s/.*: //")" none "a curved interface $*: it touches"
done

# Many gaps on one line, as between thin plates: eight times as many take eight times as long, and not sixty-four.

# filled PLATES TIMES: gaps between so many plates, so often; a processor's seconds in all.
filled() {
    (for _ in $(seq "$2"); do
        SINEW_THREADS=1 voxelise -q --unit mm -s 1 --fraction 2 --slits off -o "$T/m" "$T/plates$1.obj" 2>"$T/said" || exit
    done && times) | tail -n 1 | sed 's/m/ /; s/s .*//' | awk '{ print 60 * $1 + $2 }'
}
for plates in 2000 16000; do
    awk -v n=$plates -f tests/cli/plates.awk >"$T/plates$plates.obj"
done
# In turn, and again where others' work was in the way. (Few are filled eight times: what took 10 ms would be told to the nearest 10.)
for _ in 1 2 3 4 5; do
    few=$(filled 2000 8)
    check "gaps between thin plates are filled" grep -q "elements fill gaps" "$T/said"
    many=$(filled 16000 1)
    awk -v few="$few" -v many="$many" 'BEGIN { exit !(many > 0 && many < 5 * few) }' && break
done
check "between eight times the plates as fast: $few s for eight times few, then $many s" \
    awk -v few="$few" -v many="$many" 'BEGIN { exit !(many > 0 && many < 5 * few) }'

# ---- layers

# layers ARGS...: what is said of layers.
layers() {
    voxelise -q --unit mm -o "$T/m" "$@" 2>"$T/said" || diag_file "$T/said"
    sed -n 's/^voxelise: warning: layer //p' "$T/said"
}
box skin 0 0 0 10 10 10 >"$T/box.obj"
echo 'a thickness=1' >"$T/layers"
is "$(layers -s 1 --layers "$T/layers" "$T/box.obj")" "" "a layer as thick as a voxel"
is "$(layers -s 1.25 --layers "$T/layers" "$T/box.obj")" \
    "a is 1 mm thick, less than a voxel of 1.25 mm: it has 296 elements (57.8 % of all), in stripes where voxel centres happen to lie in it, the first at 0.625mm,0.625mm,0.625mm; voxels of at most 1 mm resolve it" \
    "one that is thinner"
printf 'a thickness=1.2\nb thickness=1.1\nc thickness=1.1\n' >"$T/layers"
is "$(layers -s 1.1 --layers "$T/layers" "$T/box.obj")" "" "layers as thick as a voxel below another"
printf 'a thickness=0.1\nb thickness=2\nc thickness=0.3\n' >"$T/layers"
layers -s 1 --layers "$T/layers" "$T/box.obj" >"$T/got"
is "$(wc -l <"$T/got") $(grep -c '^a is 0.1 mm thick, .* no voxel centre is in it, .*at most 0.1 mm resolve' "$T/got") $(grep -c '^c is 0.3 mm' "$T/got")" \
    "2 1 1" "one without an element, and one below another"
is "$(grep -c 'a has no voxel' "$T/said")" 0 "which is said once"
echo 'a thickness=0.7' >"$T/layers"
layers -s 1,1,0.5 --layers "$T/layers" "$T/box.obj" >"$T/got"
check "flat voxels: by their longest side" grep -q 'less than a voxel of 1 mm' "$T/got"

# By shares there are no stripes: what is said is what else is not right.
echo 'a thickness=0.7' >"$T/layers"
is "$(layers -s 1 --fraction 4 --layers "$T/layers" "$T/box.obj" | grep -c '^a is 0.7 mm thick, .*too soft along itself, which --mixed laminate mends')" 1 "by shares, with moduli between"
is "$(layers -s 1 --fraction 4 --mixed laminate --layers "$T/layers" "$T/box.obj")" "" "as laminates it is as it should be"
echo 'a thickness=0.1' >"$T/layers"
is "$(layers -s 1 --fraction 4 --mixed laminate --layers "$T/layers" "$T/box.obj" | grep -c 'less than half as thick as samples')" 1 "less than half as thick as samples are apart"
printf 'a thickness=0.5\nb thickness=0.3 material=b\n' >"$T/layers"
printf 'tissue E=3000\na E=9000\nb E=5000\n' >"$T/materials"
is "$(layers -s 1 --fraction 8 --mixed laminate --layers "$T/layers" --materials "$T/materials" "$T/box.obj" | grep -c '^b is 0.3 mm thick, .* elements of three layers and more')" 1 \
    "three layers in one voxel"
printf 'a thickness=0.6\nb thickness=0.05 material=b\nc thickness=1.2\n' >"$T/layers"
is "$(layers -s 1 --fraction 8 --layers "$T/layers" --materials "$T/materials" "$T/box.obj" | grep -c '^b is 0.05 mm thick, .* it has no element, as two other volumes')" 1 "one that two others leave no element"
printf 'a thickness=0.1\nb thickness=1.1 material=b\n' >"$T/layers"
awk -v r=6 -v n=24 -v g=skin -f tests/cli/sphere.awk >"$T/ball.obj"
is "$(layers -s 1 --fraction 8 --mixed laminate --layers "$T/layers" --materials "$T/materials" "$T/ball.obj" | grep -c '^b is 1.1 mm thick, and .* elements of three layers and more')" 1 \
    "a layer thicker than a voxel may lie in one with two others, too"

# ---- the real face: lips that stand 3 mm apart in the middle and touch at the corners of the mouth

if [ -z "$DATA" ]; then
    skip 4 "no shared data"
else
    face=$DATA/face/face_zyg.obj
    vox -s 2.5 --origin -125,-125,-125 "$face" >"$T/centres"
    vox -s 2.5 --origin -125,-125,-125 --fraction 4 "$face" >"$T/shares"
    is "$(cut -d ' ' -f 1 "$T/centres")" "24316:" "the face by centres"
    check "its lips are joined near the corners of the mouth" test "$(cut -d ' ' -f 2 "$T/centres")" -gt 5
    check "and in more places by shares" test "$(cut -d ' ' -f 2 "$T/shares")" -gt "$((2 * $(cut -d ' ' -f 2 "$T/centres")))"
    # shellcheck disable=SC2016 # awk's
    check "between the lips" awk -F '[ ,m]+' '{ exit !($4 > 60 && $4 < 80 && $5 < -78 && $5 > -86) }' "$T/shares"
fi
done_testing
