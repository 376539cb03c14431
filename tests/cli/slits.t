#!/bin/sh
# voxelise --slits: what lies on either side of a slit narrower than a voxel is parted, by centres and by shares, on the way through all
# tools: attach, bind, runs, exports and imports. With SINEW_LONG the real face in smaller voxels too.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/cli/boxes.sh
. tests/cli/boxes.sh
export SINEW_THREADS=2

# vox ARGS...: the elements and nodes of $T/m.
vox() {
    voxelise -q --text --unit mm "$@" >"$T/m" 2>"$T/said" || diag_file "$T/said"
    echo "$(sinew info --get axis.element "$T/m") $(sinew info --get axis.node "$T/m")"
}
# slit WIDTH: 20 mm deep, in a block of 40 mm.
slit() {
    awk -v w="$1" -f tests/cli/slit.awk >"$T/slit.obj"
}
# halves WIDTH: two blocks, so far apart.
halves() {
    box skin 0 0 0 "$(echo "$1" | awk '{ print 20 - $1 / 2 }')" 40 40 >"$T/halves.obj"
    box skin "$(echo "$1" | awk '{ print 20 + $1 / 2 }')" 0 0 40 40 40 >>"$T/halves.obj"
}
# pull: the low side in x is held, the high side moves by 4 mm: the nodes that have not moved, those that have, and the gap in mm.
pull() {
    printf '0 displace -1mm,0,0,0,1,1 0,0,0\n0 displace 40mm,0,0,1,1,1 0,0,0\n0.02 displace 40mm,0,0,1,1,1 4mm,0,0\n' >"$T/script"
    tled-run -q -d cpu --text --script "$T/script" -t 0.03 <"$T/m" >"$T/r" 2>"$T/stderr" || diag_file "$T/stderr"
    awk -f tests/cli/gap.awk "$T/r"
}

# ---- the halves of a block, of 20 x 20 x 10 elements each

halves 0
is "$(vox -s 2 "$T/halves.obj") $(pull)" "8000 9261 441 8820 0.000" "the paper's rule: two blocks that touch move as one"
is "$(vox -s 2 --slits on "$T/halves.obj") $(pull | cut -d ' ' -f 1,2)" "8000 9702 4851 4851" "by centres they are parted, and the held one feels nothing"
is "$(vox -s 2 --fraction 8 "$T/halves.obj") $(pull | cut -d ' ' -f 1,2)" "8000 9702 4851 4851" "by shares too, by default"
is "$(vox -s 2 --fraction 8 --origin 1,0,0 "$T/halves.obj") $(pull | cut -d ' ' -f 1,2)" "8800 10584 5292 5292" "and where voxels are cut in two"
is "$(sinew info --get volume.count.skin "$T/m")" 8800 "which are two elements each"
voxelise --unit mm -s 2 --fraction 8 --origin 1,0,0 "$T/halves.obj" 2>&1 >"$T/m" | grep slits >"$T/said"
is "$(cat "$T/said")" "voxelise: slits are open: 882 more nodes, and 400 more elements, of voxels in several parts" "a message says so"
box skin 0 0 0 20 20 20 | sed '$d' >"$T/open.obj"
voxelise -q --unit mm -s 2 --allow-open --slits on "$T/open.obj" 2>&1 >"$T/m" | grep slits >"$T/said"
is "$(cat "$T/said")" "voxelise: warning: slits are not looked for (--slits on), as a volume of level 0 is open" "not of an open volume"
halves 0.2
is "$(vox -s 2 --slits on "$T/halves.obj") $(pull | cut -d ' ' -f 1,2)" "8000 9702 4851 4851" "apart by a tenth of a voxel, by centres"
is "$(vox -s 2 --fraction 8 "$T/halves.obj") $(pull | cut -d ' ' -f 1,2)" "8000 9702 4851 4851" "by shares"
is "$(vox -s 2 --fraction 8 --origin 1,0,0 "$T/halves.obj") $(pull | cut -d ' ' -f 1,2)" "8800 10584 5292 5292" "in two elements a voxel"
halves 2
is "$(vox -s 2 --slits on "$T/halves.obj") $(pull | cut -d ' ' -f 1,2)" "7600 9261 4410 4851" "apart by a voxel, by centres"
is "$(vox -s 2 --fraction 8 "$T/halves.obj") $(pull | cut -d ' ' -f 1,2)" "8000 9702 4851 4851" "by shares"

# Blocks with other edges, so that no polygon is given twice.
{ box skin 0 0 0 20 40 40 && box skin 20 5 5 40 35 40; } >"$T/two.obj"
is "$(vox -s 2 --slits on "$T/two.obj")" "6700 8195" "two that touch in part of a side"
{ box left 0 0 0 20 40 40 && box right 20 0 0 40 40 40; } >"$T/two.obj"
printf 'a priority=0 surfaces=left\nb priority=1 surfaces=right\n' >"$T/volumes"
is "$(vox -s 2 --slits on --volumes "$T/volumes" "$T/two.obj")" "8000 9261" "two volumes that touch are joined"
{ box left 0 0 0 19.9 40 40 && box right 20.1 0 0 40 40 40; } >"$T/two.obj"
is "$(vox -s 2 --slits on --volumes "$T/volumes" "$T/two.obj")" "8000 9702" "and parted where a tenth of a voxel is between"
is "$(vox -s 2 --fraction 4 --volumes "$T/volumes" "$T/two.obj")" "8000 9702" "by shares too"

# ---- a slit half through: 21 x 10 nodes more

for w in 0 0.2 2; do
    slit "$w"
    [ "$w" = 2 ] || is "$(vox -s 2 --slits on "$T/slit.obj")" "8000 9471" "a slit of $w mm, by centres"
    is "$(vox -s 2 --fraction 8 "$T/slit.obj")" "8000 9471" "a slit of $w mm, by shares"
    check "it opens by more than 3 mm" awk -v gap="$(pull | cut -d ' ' -f 3)" 'BEGIN { exit !(gap > 3 && gap < 4.5) }'
    vox -s 2 --fraction 8 --slits off "$T/slit.obj" >"$T/got"
    is "$(cat "$T/got")" "8000 9261" "--slits off: closed"
done
check "and said" grep -q "elements fill gaps between surfaces in 200 places" "$T/said"
slit 0.2
is "$(vox -s 2 --fraction 8 --origin 1,0,1 "$T/slit.obj")" "9020 10626" "in the middle of voxels: those that it goes through are two elements"
check "no node is in more than 8 elements" tled-run -q -d cpu -t 1e-4 -o "$T/r" <"$T/m"
cp "$T/m" "$T/one"
vox -s 2 --fraction 8 --origin 1,0,1 --threads 7 "$T/slit.obj" >"$T/got"
check "the same for any number of threads" cmp "$T/one" "$T/m"

# What has no slit is the same.
awk -v r=50 -v n=24 -f tests/cli/sphere.awk >"$T/ball.obj"
awk -f samples/shape.awk -f samples/head.awk >"$T/head.obj"
for shape in "ball 7 --fraction 4" "ball 7 --fraction 8 --least .3" "ball 7" "head 4"; do
    case $shape in *least* | 'ball 7') [ "$SINEW_LONG" ] || continue ;; esac
    # shellcheck disable=SC2086 # words
    set -- $shape
    name=$1 size=$2
    shift 2
    vox -s "$size" "$@" --slits on "$T/$name.obj" >"$T/got"
    grep -v '^prov' "$T/m" >"$T/on"
    vox -s "$size" "$@" --slits off "$T/$name.obj" >"$T/got"
    grep -v '^prov' "$T/m" >"$T/off"
    check "no slit is in: $shape" cmp "$T/on" "$T/off"
done
fails 2 "a word that --slits does not know" "expected on.off" voxelise --unit mm -s 2 --slits maybe "$T/ball.obj"

# ---- through other tools

slit 0.2
vox -s 2 --fraction 8 --origin 1,0,1 "$T/slit.obj" >"$T/got"
sinew bind -q --text <"$T/m" >"$T/bound" 2>"$T/stderr"
# Vertices 4 and 5, 12 and 13 of the OBJ are on the wall of the high half, 6 to 8 and 14 to 16 on that of the low one.
tled-run -q -d cpu --text --script "$T/script" -t 0.03 <"$T/bound" 2>"$T/stderr" >"$T/r"
sinew deform -q "$T/slit.obj" <"$T/r" >"$T/out.obj" 2>"$T/stderr" || diag_file "$T/stderr"
awk '$1 == "v" { n++; x[n] = $2 } END { print (x[4] - x[7] > 3), (x[12] - x[15] > 3) }' "$T/out.obj" >"$T/got"
is "$(cat "$T/got")" "1 1" "each wall of the slit moves with its own half"
check "attach takes it" attach -q -o "$T/a" <"$T/m"
check "sinew info" sinew info "$T/m"
for format in inp msh vtu; do
    check "to $format" sinew export -q -f "$format" -o "$T/e.$format" "$T/m"
    sinew import -q --unit m "$T/e.$format" >"$T/i" 2>"$T/stderr" || diag_file "$T/stderr"
    is "$(sinew info --get axis.element "$T/i") $(sinew info --get axis.node "$T/i")" "9020 10626" "and from $format: all nodes and elements"
done
sinew export -q -f model <"$T/m" >"$T/b" 2>"$T/stderr" || diag_file "$T/stderr"
check "binary and text" sinew diff "$T/m" "$T/b"

# ---- the real face: lips that stand 3 mm apart in the middle and touch at the corners of the mouth

mouth() {
    voxelise -q --text --unit mm --origin -125,-125,-125 "$@" "$DATA/face/face_zyg.obj" 2>"$T/said" |
        awk -v half=20 -f tests/cli/mouth.awk
}
if [ -z "$DATA" ]; then
    skip 7 "no shared data"
else
    is "$(mouth -s 2.5)" "6 16 -18.75 -8.75 16.25 8.75 -11.25 18.75 11.25 -16.25 -13.75 13.75" "the mouth by the paper's rule"
    is "$(mouth -s 2.5 --slits on)" "16 16" "slits open: all slices, by centres"
    is "$(mouth -s 2.5 --fraction 8)" "16 16" "and by shares"
    if [ "$SINEW_LONG" ]; then
        is "$(mouth -s 1.25 --slits on)" "32 32" "in voxels of half the size"
        is "$(mouth -s 1.25 --fraction 8)" "32 32" "by shares too"
    else
        skip 2 "voxels of half the size take seconds: SINEW_LONG is not set"
    fi
    for how in "--slits on" "--fraction 8"; do
        # shellcheck disable=SC2086 # words
        voxelise -q --text --unit mm --origin -125,-125,-125 -s 2.5 $how "$DATA/face/face_zyg.obj" 2>"$T/said" | sinew bind -q --text |
            python3 tests/cli/lips.py >"$T/got"
        is "$(cat "$T/got")" "230 0" "each lip's vertices are on their own lip: $how"
    done
fi
done_testing
