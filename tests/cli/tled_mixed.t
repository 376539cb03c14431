#!/bin/sh
# Bars of two materials whose border cuts voxels, against closed forms. With nu = 0 a bar is as thin rods are: pulled by a
# stress s at its end it grows by s times the sum of its elements' lengths over their moduli.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

printf 'skin surfaces=skin material=soft\nhard level=1 surfaces=hard material=hard\n' >"$T/volumes"
printf 'soft E=3000 nu=0 density=1000\nhard E=12000 nu=0 density=1500\n' >"$T/materials"
printf 'g rigid\nv 0 -9 -9\nv 0 9 -9\nv 0 9 9\nv 0 -9 9\nf 1 2 3 4\n' >"$T/wall.obj"
printf '0 force 0.08,0.005,0.005 0.008 0.0003,0,0\n' >"$T/script" # 3 Pa on 1 cm2
# bar X Z ARGS...: $T/model, 8 x 1 x 1 voxels of 10 mm, hard from X and Z (mm) on.
bar() {
    {
        box skin 0 0 0 80 10 10
        box hard "$1" 0 "$2" 80 10 10
    } >"$T/bar.obj"
    shift 2
    voxelise -q --text --unit mm -s 10 --volumes "$T/volumes" --materials "$T/materials" "$@" "$T/bar.obj" 2>"$T/said" |
        attach -q --fibre axis --rigid-file "$T/wall.obj" >"$T/model" 2>>"$T/said"
}
# between A B S: a^(1-s) b^s.
between() {
    awk -v a="$1" -v b="$2" -v s="$3" 'BEGIN { printf "%.9g", a ^ (1 - s) * b ^ s }'
}
# pull ARGS...: how far the bar's end comes to rest, mm.
pull() {
    tled-run -q -d cpu --rest 1e-7 "$@" <"$T/model" >"$T/out"
    sinew info --get node.displacement.at.0.08,0,0 <"$T/out" | awk '{ printf "%.9g", 1000 * $1 }'
}
# rods E...: the sum over ten-millimetre elements, by 3 Pa, mm.
rods() {
    echo "$@" | awk '{ for (i = 1; i <= NF; i++) sum += 10 / $i } END { printf "%.9g", 3 * sum }'
}

# In series: the border at 43 mm leaves the fifth voxel 0.3 of the soft.
bar 43 0 --fraction 10
mixed=$(pull --script "$T/script")
near "$mixed" "$(rods 3000 3000 3000 3000 "$(between 12000 3000 0.3)" 12000 12000 12000)" 1e-3 "in series: the element's modulus lies between"
bar 43 0
whole=$(pull --script "$T/script")
near "$whole" "$(rods 3000 3000 3000 3000 12000 12000 12000 12000)" 1e-3 "whole elements"
right=$(echo "$mixed $whole" | awk '{ r = 3 * (43 / 3000 + 37 / 12000); m = $1 / r - 1; w = $2 / r - 1; print m, w, m * m < w * w }')
is "${right##* }" 1 "the mixed bar is the nearer to two rods: ${right% *} off"

# Side by side: 0.4 of every voxel is hard.
bar 0 6 --fraction 10
mixed=$(pull --script "$T/script")
near "$mixed" "$(awk -v e="$(between 3000 12000 0.4)" 'BEGIN { printf "%.9g", 3 * 80 / e }')" 1e-3 "side by side"
bar 0 6
whole=$(pull --script "$T/script")
right=$(echo "$mixed $whole" | awk '{ r = 3 * 80 / (0.6 * 3000 + 0.4 * 12000); m = $1 / r - 1; w = $2 / r - 1; print m, w, m * m < w * w }')
is "${right##* }" 1 "the mixed bar is the nearer to two rods: ${right% *} off"

# Weight: the masses of both.
bar 0 6 --fraction 10
tled-run -q -d cpu -t 0.01 -g 0,0,-9.81 --damping 0 --ramp 0 <"$T/model" >"$T/out"
near "$(sinew info --get node.velocity.at.0.08,0,0 <"$T/out" | awk '{ print $3 }')" -0.0981 0.02 "all falls as fast"

# A muscle that has 0.4 of each voxel pulls with 0.4 of its stress: -0.4 x 30 Pa against one modulus all over.
printf 'skin surfaces=skin\nmuscle_m level=1 surfaces=hard\n' >"$T/volumes"
printf 'soft E=3000 nu=0 density=1000 peak=30\n' >"$T/materials"
for high in 6 4; do # it is the second volume, and the first
    bar 0 "$high" --fraction 10
    share=$(awk -v z="$high" 'BEGIN { print 1 - z / 10 }')
    near "$(pull -c m=1)" "$(awk -v s="$share" 'BEGIN { printf "%.9g", -80 * s * 30 / 3000 }')" 0.02 "a muscle with $share of each voxel"
done
bar 0 6
fails 1 "by centres there is no such muscle" "tled-run: .*muscle_m" tled-run -q -d cpu -c m=1 --rest 1e-7 -o "$T/out" <"$T/model"

# In any of the processor's instruction sets and for any threads: the same bytes.
printf '0 gravity 0,0,-9.81\n0 contract m 0\n0.01 contract m 1\n' >"$T/script"
printf 'skin surfaces=skin material=soft\nmuscle_m level=1 surfaces=hard material=hard\n' >"$T/volumes"
printf 'soft E=3000 nu=0.4\nhard E=12000 nu=0.45 peak=3000\n' >"$T/materials"
{
    awk -v r=30 -v n=24 -v g=skin -f tests/cli/sphere.awk
    awk -v r=17 -v n=24 -v g=hard -f tests/cli/sphere.awk | awk -v from="$((2 + 23 * 48))" '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } 1'
} >"$T/ball.obj"
voxelise -q --unit mm -s 5 --volumes "$T/volumes" --materials "$T/materials" --fraction 4 "$T/ball.obj" 2>"$T/said" |
    attach -q --rigid-file "$T/wall.obj" >"$T/model" 2>>"$T/said"
for precision in double single; do
    tled-run -q -d cpu --precision $precision -t 0.02 --script "$T/script" --threads 1 <"$T/model" >"$T/one"
    tled-run -q -d cpu --precision $precision -t 0.02 --script "$T/script" --threads 3 <"$T/model" >"$T/three"
    SINEW_VECTORS=plain tled-run -q -d cpu --precision $precision -t 0.02 --script "$T/script" <"$T/model" >"$T/plain"
    check "$precision: the same bytes on three threads" cmp "$T/one" "$T/three"
    check "$precision: and without vectors" cmp "$T/one" "$T/plain"
    check "$precision: it moved" test "$(sinew info --get node.displacement.max <"$T/one" | awk '{ print ($1 > 1e-5) }')" = 1
done

done_testing
