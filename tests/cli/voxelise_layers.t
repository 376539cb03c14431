#!/bin/sh
# voxelise --layers: volumes from the skin inward.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

# vox ARGS...: as text into $T/m, what it says into $T/said.
vox() {
    voxelise --text --unit mm "$@" >"$T/m" 2>"$T/said"
}
# counts NAMES...: elements of volumes.
counts() {
    for name; do
        printf '%s ' "$(sinew info --get "volume.count.$name" <"$T/m")"
    done
}
# rows ARRAY: of $T/m, on one line.
rows() {
    awk -v a="$1" '$1 == "array" { on = $2 == a; next } /^[a-z]/ { on = 0 } on { printf "%s ", $0 }' "$T/m"
}

box skin 0 0 0 10 10 10 >"$T/box.obj"
printf 'epidermis thickness=1 # of voxels\ndermis thickness=0.2cm material=soft\n' >"$T/layers"
printf 'tissue E=3000\nsoft E=1000\nepidermis E=9000\n' >"$T/materials"
vox -s 1 --layers "$T/layers" --materials "$T/materials" "$T/box.obj"
is "$(counts skin epidermis dermis)" "64 488 448 " "a box in shells"
is "$(rows volume.name)$(rows volume.level)$(rows volume.priority)$(rows volume.material)" \
    '"skin" "epidermis" "dermis" 0 0 0 0 1 2 0 2 1 ' "their volumes; a material of their name, or the one given"
check "what is said of one" grep -q "^  dermis  *0  soft  *448  *0  *0  *100$" "$T/said"
cp "$T/m" "$T/one"
is "$(rows element.normal | tr ' ' '\n' | paste -d, - - - | awk -F , '{ n[$1 * $1 + $2 * $2 + $3 * $3 > 0]++
    if ($1 * $1 + $2 * $2 + $3 * $3 == 1) axis++ } END { print n[0], n[1], axis }')" "64 936 936" "and their normals, those of its faces"
vox -s 1 --threads 1 --layers "$T/layers" --materials "$T/materials" "$T/box.obj"
check "the same bytes on one thread" cmp "$T/m" "$T/one"
awk '$1 == "v" { print "v", $2 + 1e6, $3 - 2e6, $4; next } { print }' "$T/box.obj" >"$T/far.obj"
vox -s 1 --layers "$T/layers" --materials "$T/materials" "$T/far.obj"
is "$(counts skin epidermis dermis)" "64 488 448 " "far away"
vox -s 1 --origin 100,100,100 --layers "$T/layers" --materials "$T/materials" "$T/box.obj"
is "$(counts skin epidermis dermis)" "64 488 448 " "cells with negative numbers"
vox -s 1,1,0.5 --layers "$T/layers" --materials "$T/materials" "$T/box.obj"
is "$(counts skin epidermis dermis)" "$((4 * 4 * 8)) $((2000 - 8 * 8 * 16)) $((8 * 8 * 16 - 4 * 4 * 8)) " "flat voxels"
vox -s 1 --origin 0,0,0 --box 0,0,0,5,10,10 --layers "$T/layers" --materials "$T/materials" "$T/box.obj"
is "$(counts skin epidermis dermis)" "32 244 224 " "a --box is no skin"

# Depth is below the skin, not the skull; muscles stay.
{
    cat "$T/box.obj"
    box skull 3 3 3 7 7 7
    box muscle_a 0 0 0 2 2 2
    box muscle_b 4 4 0 5 5 3
} >"$T/head.obj"
vox -s 1 --layers "$T/layers" --materials "$T/materials" "$T/head.obj"
is "$(counts skin epidermis dermis muscle_a muscle_b)" "0 480 445 8 3 " "a skull and muscles"
is "$(rows volume.level)" "0 0 0 1 1 " "muscles come after the layers"
awk '$1 == "f" { for (i = NF; i > 1; i--) printf "%s%s", i == NF ? "f " : " ", $i; print ""; next } { print }' "$T/box.obj" >"$T/inward.obj"
vox -s 1 --layers "$T/layers" --materials "$T/materials" "$T/inward.obj"
rows element.normal >"$T/turned"
vox -s 1 --layers "$T/layers" --materials "$T/materials" "$T/box.obj"
rows element.normal | cmp -s - "$T/turned"
is $? 0 "normals are outward, whichever way polygons are turned"

# By the distance from a sphere.
awk -v r=100 -v n=96 -f tests/cli/sphere.awk >"$T/ball.obj"
printf 'shell thickness=20\n' >"$T/shell"
vox -s 5 --layers "$T/shell" "$T/ball.obj"
near "$(counts shell | awk '{ print $1 * 125 }')" "$(awk 'BEGIN { print 4 / 3 * 3.14159265 * (1e6 - 80 ^ 3) }')" 0.01 "a ball's shell"
check "with shares" voxelise -q -o "$T/m" --unit mm -s 5 --fraction 4 --layers "$T/shell" "$T/ball.obj"
check "the model is whole" sinew info "$T/m"

# bad NAME PATTERN LINE...: a --layers file that is refused.
bad() {
    name=$1 pattern=$2
    shift 2
    printf '%s\n' "$@" >"$T/bad"
    fails 1 "$name" "^voxelise: $T/bad:$pattern" voxelise --unit mm -s 1 --layers "$T/bad" -o "$T/out" "$T/box.obj"
    [ ! -e "$T/out" ] || not_ok "$name: it left an output"
}
bad "no thickness" "1: layer 'a' has no thickness" 'a material=tissue'
bad "a thickness of 0" "2: thickness=0; expected a length above 0" '#' 'a thickness=0'
bad "no length" "1: thickness=2ft; expected a length" 'a thickness=2ft'
bad "unknown key" "1:.*'thicknes'.*thickness" 'a thicknes=1'
bad "unknown material" "1: unknown material 'tisue'.*tissue" 'a thickness=1 material=tisue'
bad "the same name" "2: layer 'A' is given twice" 'a thickness=1' 'A thickness=1'
bad "a volume's name" "1: 'Skin' is a volume" 'Skin thickness=1'
bad "no name" "1: 'thickness=1' where a layer's name" 'thickness=1'
bad "no layers" " no layers; expected lines" '# nothing'
fails 1 "no such file" "none.*No such file" voxelise --unit mm -s 1 --layers "$T/none" "$T/box.obj"
done_testing
