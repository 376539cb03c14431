#!/bin/sh
# us-segment: thresholds, seeds, the largest part, holes, smoothing, names, several labels in a map.
. "$(dirname "$0")/lib.sh"

# 20 x 16 x 12 voxels of 2 mm: a hollow box of 100 (hole of 0), a box of 60, and a voxel of 100 alone.
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 20 16 12' \
        'space directions: (2,0,0) (0,2,0) (0,0,2)' 'kinds: domain domain domain' 'encoding: text' 'space origin: (10,20,30)' ''
    awk 'function box(a, b) { return x >= a && x < b && y >= 2 && y < 10 && z >= 2 && z < 10 }
        BEGIN { for (z = 0; z < 12; z++) for (y = 0; y < 16; y++) for (x = 0; x < 20; x++)
            print x == 18 && y == 14 && z == 10 ? 100 : x == 5 && y == 5 && z == 5 ? 0 : box(2, 8) ? 100 : box(11, 16) ? 60 : 3 }'
} >"$T/v.nrrd"

# count VALUE: voxels of this label in $T/l.nrrd.
count() {
    LC_ALL=C sed '1,/^$/d' "$T/l.nrrd" | od -A n -v -t u1 -w1 | grep -c "^ *$1\$"
}
# seg NAME OPTIONS...: segments to $T/l.nrrd.
seg() {
    tap_note=$1
    shift
    check "$tap_note" us-segment --raw -o "$T/new.nrrd" "$@" "$T/v.nrrd"
    mv "$T/new.nrrd" "$T/l.nrrd" 2>/dev/null
}

seg "above a level" -n bone --low 80
is "$(count 1)" 384 "all that is there"
is "$(grep -a '^Segment0_\(Name\|LabelValue\):=' "$T/l.nrrd" | sort | tr '\n' ' ')" "Segment0_LabelValue:=1 Segment0_Name:=bone " "its name"
is "$(grep -a '^space origin' "$T/l.nrrd")" "space origin: (10,20,30)" "its place"
seg "the largest part" -n bone --low 80 --largest
is "$(count 1)" 383 "without the voxel alone"
seg "its hole filled" -n bone --low 80 --largest --fill
is "$(count 1)" 384 "one more"
seg "from a seed in mm" -n fat --low 50 --high 70 --seed 36,26,36mm
is "$(count 1)" 320 "the box that it is in"
seg "from a seed's voxel, by tolerance" -n fat --tolerance 5 --seed-voxel 13,4,4
is "$(count 1)" 320 "the same"
seg "from two seeds" -n both --tolerance 5 --seed-voxel 13,4,4 --seed-voxel 3,3,3
is "$(count 1)" 703 "both boxes"
seg "smoothed" -n bone --low 80 --smooth 3mm
if [ "$(count 1)" -gt 250 ] && [ "$(count 1)" -lt 384 ]; then ok "corners and the voxel go: $(count 1)"; else not_ok "$(count 1)"; fi
seg "filtered before" -n bone --low 40 --filter 2mm
if [ "$(count 1)" -gt 500 ] && [ "$(count 1)" -lt 800 ]; then ok "as much is above: $(count 1)"; else not_ok "$(count 1)"; fi

seg "a first label" -n bone --low 80
cp "$T/l.nrrd" "$T/first.nrrd"
seg "a second onto it" -n fat --low 50 --high 70 --onto "$T/first.nrrd"
is "$(count 1) $(count 2)" "384 320" "both are there"
is "$(grep -a '^Segment._Name' "$T/l.nrrd" | tr '\n' ' ')" "Segment0_Name:=bone Segment1_Name:=fat " "both have names"
cp "$T/l.nrrd" "$T/first.nrrd"
seg "one that takes from them" -n bone --low 50 --onto "$T/first.nrrd"
is "$(count 1) $(count 2)" "704 0" "by its name's number"
check "to surfaces" us-surface -l all -o "$T/s.obj" "$T/first.nrrd"
is "$(grep '^g' "$T/s.obj" | tr '\n' ' ')" "g bone g fat " "whose groups are the labels"
seg "again" -n bone --low 80
us-segment --raw -q -n bone --low 80 <"$T/v.nrrd" | cmp -s - "$T/l.nrrd"
is $? 0 "the same from standard input"

# One name, one number.
fails 1 "a number that is another label's" "first.nrrd: label 1 is 'bone'; expected another --value, or that name" us-segment -n vein --value 1 --low 50 --onto "$T/first.nrrd" "$T/v.nrrd"
fails 1 "a name that has another number" "first.nrrd: label 1 is 'bone'; expected that --value, or another name" us-segment -n bone --value 7 --low 50 --onto "$T/first.nrrd" "$T/v.nrrd"
check "both as they are" us-segment -q -n bone --value 1 --low 50 --onto "$T/first.nrrd" -o "$T/l.nrrd" "$T/v.nrrd"
for name in ' vein' 'vein ' ' ' "$(printf 'a\001b')" "$(printf '\377')"; do
    fails 2 "a name that would not be read back" 'expected a name in UTF-8, without blanks' us-segment -n "$name" --low 50 "$T/v.nrrd"
done
check "a name with a blank, beyond ASCII" us-segment -q -n 'Vena Ångström' --low 50 -o "$T/l.nrrd" "$T/v.nrrd"
us-surface -l 'Vena Ångström' "$T/l.nrrd" | grep -qx 'g Vena_Ångström'
is $? 0 "is read back"

fails 2 "no intensities" 'expected --low, --high' us-segment -n x "$T/v.nrrd"
fails 2 "a tolerance without seeds" '--tolerance is relative to the intensity of a seed' us-segment -n x --tolerance 3 "$T/v.nrrd"
fails 2 "the wrong way" 'above --high' us-segment -n x --low 5 --high 3 "$T/v.nrrd"
fails 2 "a seed without a unit" 'a length without its unit' us-segment -n x --low 5 --seed 1,2,3 "$T/v.nrrd"
fails 2 "a seed outside" 'outside of the volume' us-segment -n x --low 5 --seed 1,2,3m "$T/v.nrrd"
fails 1 "a seed of another intensity" 'seed 1 has intensity 3; expected one from 50' us-segment -n x --low 50 --seed-voxel 0,0,0 "$T/v.nrrd"
fails 1 "nothing" "nothing is left of 'x'" us-segment -n x --low 200 -o "$T/none.nrrd" "$T/v.nrrd"
check "no output is left" test ! -e "$T/none.nrrd"
sed 's/^space origin.*/space origin: (11,20,30)/' "$T/v.nrrd" >"$T/moved.nrrd"
fails 1 "a map of another place" 'another size or place' us-segment -n x --low 50 --onto "$T/moved.nrrd" "$T/v.nrrd"
fails 1 "a number too large" 'label 300 in voxels of type uint8' us-segment -n x --low 50 --value 300 "$T/v.nrrd"
done_testing
