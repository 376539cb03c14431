#!/bin/sh
# Runs to rest that begin from a coarser model's rest: by closed forms, and beside runs that begin from the beginning,
# whose rest they share to what the tolerance leaves.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

printf 'soft E=3000 nu=0 density=1000\nhard E=12000 nu=0 density=1500\n' >"$T/materials"
printf 'g rigid\nv 0 -9 -9\nv 0 39 -9\nv 0 39 39\nv 0 -9 39\nf 1 2 3 4\n' >"$T/wall.obj"
# bar X: $T/model, 80 x 30 x 30 mm in voxels of 2.5 mm, held at its low end; hard from X mm on, if that is given.
bar() {
    {
        echo 'skin surfaces=skin material=soft'
        [ -z "$1" ] || echo 'hard level=1 surfaces=hard material=hard'
    } >"$T/volumes"
    {
        box skin 0 0 0 80 30 30
        [ -z "$1" ] || box hard "$1" 0 0 80 30 30
    } >"$T/bar.obj"
    voxelise -q --unit mm -s 2.5 --volumes "$T/volumes" --materials "$T/materials" "$T/bar.obj" 2>"$T/said" |
        attach -q --fibre axis --rigid-file "$T/wall.obj" >"$T/model" 2>>"$T/said"
}
# rests NAME ARGS...: $T/NAME; what was said, $T/NAME.said.
rests() {
    into=$1
    shift
    tled-run -v -d cpu "$@" <"$T/model" >"$T/$into" 2>"$T/$into.said" || diag_file "$T/$into.said"
}
# end NAME: how far the bar's end has come, mm.
end() {
    sinew info --get node.displacement.at.0.08,0,0 <"$T/$1" | awk '{ printf "%.9g", 1000 * $1 }'
}
# steps NAME: how many it took.
steps() {
    sed -n 's/.*at rest at .*, after \([0-9]*\) steps.*/\1/p' "$T/$1.said"
}
# same NAME MM: both rests are that close.
same() {
    sinew diff --only node.displacement --abs node.displacement="$2mm" "$T/begun" "$T/direct" >"$T/diff" 2>&1
    is $? 0 "$1: both rests are within $2 mm"
}
# both NAME MM ARGS...
both() {
    name=$1 within=$2
    shift 2
    rests begun "$@"
    rests direct --coarse no "$@"
    grep -q 'begins from the rest of' "$T/begun.said"
    is $? 0 "$name: it begins from a coarser model"
    same "$name" "$within"
    [ "$(steps begun)" -lt "$(steps direct)" ]
    is $? 0 "$name: it takes $(steps begun) steps for $(steps direct)"
}

# By its own weight along x: rho g L^2 / 2E = 0.0533 mm, of strains below 0.0014.
bar ''
both "own weight" 2e-6 --rest 1e-5 -g 0.05,0,0
near "$(end begun)" 0.0533333 2e-3 "own weight: rho g L^2 / 2E"
rests other --threads 2 --rest 1e-5 -g 0.05,0,0
rests begun --threads 1 --rest 1e-5 -g 0.05,0,0
sinew diff --only node.displacement,node.velocity "$T/begun" "$T/other" >"$T/diff"
is $? 0 "the same bytes for any number of threads"
rests other --precision single --rest 1e-5 -g 0.05,0,0
near "$(end other)" 0.0533333 2e-3 "and in single precision"

# The low end held, the high one displaced, with nu = 0: every plane goes by its share.
printf '0 displace 0.08,0,0,0.08,0.03,0.03 0,0,0\n0.05 displace 0.08,0,0,0.08,0.03,0.03 0.0002,0,0\n' >"$T/script"
both "stretched" 1e-5 --rest 1e-5 --script "$T/script"
near "$(sinew info --get node.displacement.at.0.02,0.01,0.01 <"$T/begun" | awk '{ print 1000 * $1 }')" 0.05 2e-4 "stretched evenly: a quarter of the way at a quarter of the length"

# A force on the nodes of the end, and two materials whose border the coarser model's elements have in them.
bar 42.5
printf '0 force 0.08,0.015,0.015 0.03 0,0,0\n0.05 force 0.08,0.015,0.015 0.03 0.0005,0.0001,0\n' >"$T/script"
both "pushed, of two materials" 1e-4 --rest 1e-5 --script "$T/script"

# Its bend is slow, and coarser models have it.
[ $((5 * $(steps begun))) -lt "$(steps direct)" ]
is $? 0 "pushed, of two materials: five times fewer steps"
grep -q 'coarser models corrected it [1-9]' "$T/begun.said"
is $? 0 "and it says how often it was corrected"
grep -q 'corrected' "$T/direct.said"
is $? 1 "--coarse no: never"

# What has no coarser model, or shows how it comes to rest, runs as without.
rests begun --rest 1e-3 -g 1,0,0 --every 0.1
rests direct --rest 1e-3 -g 1,0,0 --every 0.1 --coarse no
sinew diff --only node.displacement,node.velocity "$T/begun" "$T/direct" >"$T/diff"
is $? 0 "with --every it begins from the beginning"
tled-run --coarse yes <"$T/model" >"$T/out" 2>"$T/said"
is $? 2 "--coarse yes is refused"
grep -q "coarse" "$T/said"
is $? 0 "and said what was wrong"

# A part that nothing holds: what nothing pushes stays there, but a coarser model of it might not.
box skin 140 0 0 145 5 5 >>"$T/bar.obj"
voxelise -q --unit mm -s 2.5 --volumes "$T/volumes" --materials "$T/materials" "$T/bar.obj" 2>"$T/said" |
    attach -q --fibre axis --rigid-file "$T/wall.obj" >"$T/model" 2>>"$T/said"
rests loose --rest 1e-3 --script "$T/script"
grep -q 'no coarser model: nothing holds a part of it' "$T/loose.said"
is $? 0 "a part that nothing holds: it begins from no coarser model, and says why"
[ -n "$(steps loose)" ]
is $? 0 "and comes to rest"
bar 42.5

# A stream whose nodes are told to be elsewhere in the lattice than their elements.
voxelise -q --unit mm -s 2.5 --volumes "$T/volumes" --materials "$T/materials" "$T/bar.obj" 2>"$T/said" |
    attach -q --text --fibre axis --rigid-file "$T/wall.obj" 2>>"$T/said" |
    awk '/^array node.lattice/ { print; getline; $0 = "7000000 0 0"; is = 1 } is && /^crc/ { is = 0; next } { print }' >"$T/model"
rests off --rest 1e-3 -g 0.05,0,0
grep -q 'no coarser model: nodes that are off the lattice' "$T/off.said"
is $? 0 "nodes off the lattice: it begins from none, and says why"
[ -n "$(steps off)" ]
is $? 0 "and comes to rest"

if [ -n "$DATA" ] && [ -s "$DATA/face/face_zyg.obj" ]; then
    voxelise -q --unit mm --origin -125,-125,-125 -s 4 "$DATA/face/face_zyg.obj" 2>"$T/said" | attach -q >"$T/model" 2>>"$T/said"
    both "the real face, smiling" 2e-3 --rest 1e-4 -m tissue.nu=0.45 -c zyg_xneg=0.1,zyg_xpos=0.1
else
    skip "no real face" 3
fi

done_testing
