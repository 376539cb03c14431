#!/bin/sh
# CalculiX, run on what sinew export writes, against tled-run at rest: a cube and a ball that hang in gravity.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

have ccx || skip_all "no CalculiX (calculix-ccx)"

echo 'tissue law=neo-hookean E=3000 nu=0.45 density=1000' >"$T/materials"

# solve NAME: CalculiX on $T/NAME.sinew, with C3D8R elements.
solve() {
    check "$1: an input file" sinew export -f inp -g 0,0,-9.81 -o "$T/$1.inp" "$T/$1.sinew"
    check "$1: CalculiX takes it" sh -c "cd '$T' && ccx -i $1 >$1.log"
    check "$1: CalculiX gets to the end" sh -c "grep -q 'Job finished' '$T/$1.log' && ! grep -q '\*ERROR' '$T/$1.log'"
}
# compare NAME NODES INSIDE ARG...: that and tled-run; leaves the differences (see calculix.awk) in worst, mean, furthest and inside.
compare() {
    of=$1 moved="$2 $3"
    shift 3
    tled-run -q --text -g 0,0,-9.81 --rest 1e-6 "$@" <"$T/$of.sinew" >"$T/$of.rest"
    set -- "$of${*:+, $*}"
    awk -f tests/cli/calculix.awk "$T/$of.dat" "$T/$of.rest" >"$T/differences"
    read -r worst mean furthest inside nodes <"$T/differences"
    is "$nodes" "$moved" "$1: CalculiX and tled-run have moved the same nodes"
    diag "$1: of any node $worst, root mean square $mean, where it moved furthest $furthest, of any node inside $inside"
}

# A cube of 0.1 m, 8^3 elements, its top held.
awk -v x=0.1 -v y=0.1 -v z=0.1 -v held=top -f tests/cli/box.awk >"$T/cube.obj"
voxelise -q --unit m -s 0.0125 --materials "$T/materials" "$T/cube.obj" | attach -q >"$T/cube.sinew"
is "$(sinew info --get node.rigid.sum "$T/cube.sinew")" 81 "cube: its top is held"
solve cube
# Isotropic control is that of C3D8R; physical control is another element.
compare cube 729 343 --hourglass 0.0075
near "$worst" 0 0.005 "cube: every node within 0.5 % of the largest displacement"
near "$furthest" 0 0.001 "cube: within 0.1 % where it moves furthest"
compare cube 729 343
near "$worst" 0 0.05 "cube, physical: every node within 5 %"
near "$furthest" 0 0.015 "cube, physical: 1.5 % where it moves furthest"

# W&M's ball, radius 100 mm, voxels of 12.5 mm, held at the surface above z = 60 mm. What differs is the hourglass
# control: root mean square 2.4 % at 25 mm, 1.7 % at 20 mm, 0.9 % at 12.5 mm; single nodes at the cap's rim 4 %.
awk -v r=100 -v n=16 -v g=skin -f tests/cli/sphere.awk | awk '
    $1 == "v" { z[++n] = $4 }
    $1 == "f" { cap = 1; for (i = 2; i <= NF; i++) if (z[$i] < 60) cap = 0; print cap ? "g skull" : "g skin" }
    $1 != "g"' >"$T/ball.obj"
if [ -n "$SINEW_LONG" ]; then
    voxelise -q --unit mm -s 12.5 --materials "$T/materials" "$T/ball.obj" | attach -q >"$T/ball.sinew"
    solve ball
    compare ball 2849 1599 --hourglass 0.0075
    near "$mean" 0 0.015 "ball: 1.5 % in the mean"
    near "$furthest" 0 0.01 "ball: 1 % where it moves furthest"
    near "$inside" 0 0.02 "ball: 2 % at every node inside"
    compare ball 2849 1599
    near "$mean" 0 0.05 "ball, physical: 5 % in the mean"
    near "$furthest" 0 0.03 "ball, physical: 3 % where it moves furthest"
else
    skip 10 "CalculiX takes 7 s for the ball: SINEW_LONG is not set"
fi

done_testing
