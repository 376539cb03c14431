#!/bin/sh
# us-surface: surfaces of random maps of labels, which voxelise --check finds closed and of the label's volume; levels; names;
# which way triangles face; what is wrong.
. "$(dirname "$0")/lib.sh"

# map SEED CHANCE DIRECTIONS: 12 x 10 x 8 labels 1 and 2 at random, each voxel in with this chance.
map() {
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 10 8' "space directions: $3" \
        'kinds: domain domain domain' 'encoding: text' 'space origin: (-3,40,100)' 'Segment0_Name:=inner vein' 'Segment0_LabelValue:=1' ''
    awk -v seed="$1" -v chance="$2" 'BEGIN { srand(seed); for (i = 0; i < 960; i++) print rand() < chance ? 1 + (rand() < .3) : 0 }'
}

# value FILE KEY: from the report of voxelise --check, of its last block.
value() {
    sed -n "s/^ *$2  *//p" "$1" | tail -n 1 | sed 's/ mm^3//'
}

for case in '7 .1' '7 .5' '7 .9' '1 .03' '2 .1' '3 .2' '4 .3' '5 .4' '6 .5' '8 .6' '9 .7' '10 .8' '11 .9' '12 .97'; do
    seed=${case% *} chance=${case#* }
    map "$seed" "$chance" '(0.5,0,0) (0,0.7,0) (0,0,0.6)' >"$T/map.nrrd"
    voxels=$(sed '1,/^$/d' "$T/map.nrrd" | grep -c '^1$')
    check "labels at $chance" us-surface -l 'inner vein' -o "$T/vein.obj" "$T/map.nrrd"
    voxelise -v --unit mm --check "$T/vein.obj" >"$T/check" 2>&1
    is "$(value "$T/check" 'edges of one polygon (open)') $(value "$T/check" 'edges of more than two') $(value "$T/check" 'edges where facing turns') $(value "$T/check" 'triangles without area') $(value "$T/check" 'pairs of triangles that cross')" \
        "0 0 0 0 0" "it is closed, faces one way, and does not cross itself"
    near "$(value "$T/check" encloses)" "$(awk "BEGIN { print $voxels * .5 * .7 * .6 }")" .01 "it encloses what the label does"
    check "the same, filtered" us-surface -l 'inner vein' --smooth 0.3mm -o "$T/vein.obj" "$T/map.nrrd"
    voxelise -v --unit mm --check "$T/vein.obj" >"$T/check" 2>&1
    is "$(value "$T/check" 'edges of one polygon (open)') $(value "$T/check" 'edges of more than two') $(value "$T/check" 'edges where facing turns')" \
        "0 0 0" "it is closed, and faces one way"
    near "$(value "$T/check" encloses)" "$(awk "BEGIN { print $voxels * .5 * .7 * .6 }")" .01 "it encloses what the label does"
done

# outward <FILE.obj: the volume under the triangles, with its sign.
outward() {
    awk '$1 == "v" { x[++n] = $2; y[n] = $3; z[n] = $4 }
        $1 == "f" { a = $2; b = $3; c = $4
            sum += x[a] * (y[b] * z[c] - z[b] * y[c]) + y[a] * (z[b] * x[c] - x[b] * z[c]) + z[a] * (x[b] * y[c] - y[b] * x[c]) }
        END { print sum / 6 }'
}
map 3 .5 '(0.5,0,0) (0,0.7,0) (0,0,0.6)' >"$T/right.nrrd"
map 3 .5 '(0.5,0,0) (0,0.7,0) (0,0,-0.6)' >"$T/left.nrrd"
us-surface -l 1 "$T/right.nrrd" >"$T/right.obj"
us-surface -l 1 "$T/left.nrrd" >"$T/left.obj"
near "$(outward <"$T/left.obj")" "$(outward <"$T/right.obj")" 1e-4 "triangles face outward whichever way the axes turn"
is "$(outward <"$T/left.obj" | cut -c 1 | tr -d 1-9)" "" "which is out"

check "all labels" us-surface -v -l all -o "$T/all.obj" "$T/right.nrrd"
is "$(grep '^g ' "$T/all.obj" | tr '\n' ,)" "g inner_vein,g label_2," "are groups, by name or number"
is "$(sed '/^g label/,$d' "$T/all.obj" | cksum)" "$(cksum <"$T/right.obj")" "the first is as it is alone"
check "by number, in another order" us-surface -l 2,1 -o "$T/two.obj" "$T/right.nrrd"
is "$(grep '^g ' "$T/two.obj" | tr '\n' ,)" "g label_2,g inner_vein," "groups in that order"
us-surface -l 1 <"$T/right.nrrd" | cmp -s - "$T/right.obj"
is $? 0 "a volume on standard input"

# Each group is one surface.
fails 1 "a label twice" "a second surface in group 'inner_vein'; expected labels once" us-surface -l 1,2 -l 'inner vein' -o "$T/none.obj" "$T/right.nrrd"
sed 's/^Segment0_Label.*/&\nSegment1_Name:=inner_vein\nSegment1_LabelValue:=2/' "$T/right.nrrd" >"$T/same.nrrd"
fails 1 "two names that become one group" "a second surface in group 'inner_vein'; .*names that differ" us-surface -l all "$T/same.nrrd"
sed 's/^Segment0_Name.*/Segment0_Name:=vein, inner/' "$T/right.nrrd" >"$T/comma.nrrd"
check "a name with a comma in it" us-surface -l 'vein, inner' -l 2 -o "$T/comma.obj" "$T/comma.nrrd"
is "$(grep '^g ' "$T/comma.obj" | tr '\n' ,)" "g vein,_inner,g label_2," "is one label"
for list in '' ',' '1,,2' '1,'; do
    fails 2 "labels '$list'" 'expected names or numbers of labels between commas, or all' us-surface -l "$list" "$T/right.nrrd"
done

# A ball of intensities, 1 mm a voxel: radius 8 at level 100.
{
    printf '%s\n' NRRD0004 'type: float' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 24 24 24' \
        'space directions: (1,0,0) (0,1,0) (0,0,1)' 'kinds: domain domain domain' 'encoding: text' 'space origin: (0,0,0)' ''
    awk 'BEGIN { for (z = 0; z < 24; z++) for (y = 0; y < 24; y++) for (x = 0; x < 24; x++)
        print 180 - 10 * sqrt((x - 11.4) ^ 2 + (y - 11.6) ^ 2 + (z - 11.5) ^ 2) }'
} >"$T/ball.nrrd"
ball=2144.66
for how in "" "--smooth 1mm" "--taubin 20" "--smooth .5mm --taubin 5"; do
    # shellcheck disable=SC2086
    check "a ball $how" us-surface -i 100 --name ball $how -o "$T/ball.obj" "$T/ball.nrrd"
    near "$(outward <"$T/ball.obj")" $ball .06 "its volume, but for what filtering takes from a convex level"
done
is "$(sed -n 2p "$T/ball.obj")" "g ball" "its name"

# A label smoothed keeps its volume.
sed 's/type: float/type: uint8/' "$T/ball.nrrd" | awk 'done { print ($1 >= 100) + 0; next } { print } /^$/ { done = 1 }' >"$T/label.nrrd"
voxels=$(sed '1,/^$/d' "$T/label.nrrd" | grep -c '^1$')
for how in "" "--smooth 1mm" "--taubin 20" "--smooth 2mm --taubin 5"; do
    # shellcheck disable=SC2086
    check "a label $how" us-surface -l 1 $how -o "$T/ball.obj" "$T/label.nrrd"
    near "$(outward <"$T/ball.obj")" "$voxels" .01 "keeps its volume"
done

# A rod of 32 voxels a slice, of which many are equal after filtering: no count of samples tells its level.
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 12 30' \
        'space directions: (0.8,0,0) (0,0.8,0) (0,0,1)' 'kinds: domain domain domain' 'encoding: text' 'space origin: (0,0,0)' ''
    awk 'BEGIN { for (z = 0; z < 30; z++) for (y = 0; y < 12; y++) for (x = 0; x < 12; x++)
        print (x - 5.5) ^ 2 + (y - 5.5) ^ 2 < 11 }'
} >"$T/rod.nrrd"
voxels=$(sed '1,/^$/d' "$T/rod.nrrd" | grep -c '^1$')
for sigma in .3 .8 1.5; do
    check "a rod, filtered by $sigma mm" us-surface -q -l 1 --smooth ${sigma}mm -o "$T/rod.obj" "$T/rod.nrrd"
    near "$(outward <"$T/rod.obj")" "$(awk "BEGIN { print $voxels * .64 }")" .01 "keeps its volume"
done

fails 2 "neither" 'expected -l LABEL' us-surface "$T/ball.nrrd"
fails 2 "both" 'expected -l LABEL' us-surface -l 1 -i 5 "$T/ball.nrrd"
fails 2 "a length without a unit" 'a length without its unit' us-surface -i 100 --smooth 1 "$T/ball.nrrd"
fails 2 "no such name" "unknown label 'inner vien'; did you mean 'inner vein'" us-surface -l 'inner vien' "$T/right.nrrd"
fails 1 "no voxels" "label '9' has no voxels" us-surface -l 9 "$T/right.nrrd"
fails 1 "a level that nothing reaches" 'nothing is left' us-surface -i 1e6 -o "$T/none.obj" "$T/ball.nrrd"
check "no output is left" test ! -e "$T/none.obj"
fails 1 "labels of floats" 'not whole numbers' us-surface -l 1 "$T/ball.nrrd"
fails 1 "cut" 'cut.nrrd' us-surface -i 100 "$(head -c 3000 "$T/ball.nrrd" >"$T/cut.nrrd" && echo "$T/cut.nrrd")"
fails 1 "nothing" '0 bytes' us-surface -i 100

if [ -z "$DATA" ]; then
    skip 3 "no shared data"
    done_testing
fi
us-import -q --raw "$DATA/ultrasound/fetal-head" >"$T/head.nrrd" 2>/dev/null
check "the fetal head's surface" us-surface -v -i 90 --smooth 1.5mm -o "$T/head.obj" "$T/head.nrrd"
triangles=$(sed -n 's/.*: \([0-9]*\) triangles.*/\1/p' "$T/stderr")
if [ "$triangles" -gt 100000 ]; then ok "of $triangles triangles"; else not_ok "of $triangles triangles"; fi
voxelise -v --unit mm --check "$T/head.obj" >"$T/check" 2>&1
is "$(value "$T/check" 'edges of one polygon (open)') $(value "$T/check" 'pairs of triangles that cross')" "0 0" "is closed and does not cross itself"
done_testing
