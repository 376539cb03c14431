#!/bin/sh
# sinew render: pictures against those of tests/golden (made by this script with SINEW_GOLDEN=1, and looked at), the same bytes
# for any threads, films, and what is refused.
. "$(dirname "$0")/lib.sh"

have make || skip_all "no make"
compare=${BUILD:-build}/tests/cli/compare_pictures
case $compare in /*) ;; *) compare=$ROOT/$compare ;; esac

env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -s -C samples OUT="$T" "$T/muscle.model" "$T/block.model" "$T/sphere.model" 2>"$T/made" ||
    skip_all "the samples cannot be made"
muscle=$T/muscle.sinew block=$T/block.sinew
tled-run -q -n 300 -c muscle=0.4 --every 0.01 <"$T/muscle.model" >"$muscle"
tled-run -q -n 120 --script samples/block.script <"$T/block.model" >"$block"
cat >"$T/tet.sinew" <<'END'
%sinew 1 text
axis node 5
array node.position f64 m node 3
0 0 0
1 0 0
0 1 0
0 0 1
1 1 1
axis element 2
array element.node i32 @node element 4
0 1 2 3
1 2 3 4
array x-hot f32 Pa element 1
100
250
end
END

# picture NAME ARGUMENTS...: as the golden one, and seen.
picture() {
    name=$1
    shift
    if ! sinew render "$@" -o "$T/$name.png" 2>"$T/stderr"; then
        not_ok "$name is drawn"
        diag_file "$T/stderr"
        return
    fi
    if [ -n "${SINEW_GOLDEN:-}" ]; then
        cp "$T/$name.png" "tests/golden/$name.png"
    fi
    if [ -x "$compare" ]; then
        check "$name: as it was ($("$compare" "$T/$name.png" "tests/golden/$name.png"))" \
            "$compare" "$T/$name.png" "tests/golden/$name.png"
    else
        skip 1 "no $compare: make unit builds it"
    fi
}

picture muscle --sheet rest,voxels,deformed --size 480x180 "$muscle"
picture views --sheet front,left,top --colour displacement --size 480x180 "$muscle"
picture block --show voxels --cut z=0 --colour strain --view 1,-1,2 --size 320x240 "$block"
picture block-inside --show 'surface,muscle*' --clear skin --view back --size 320x240 "$block"
picture sphere --transparent --size 320x240 --view bottom --angle 0 "$T/sphere.model"
picture tetrahedra --show voxels --colour x-hot --size 320x240 --view 2,-3,1 "$T/tet.sinew"
picture material --show voxels,rigid --colour volume --size 320x240 --camera 0.1,0.06,0.24,0,0,0 "$block"
# Two cubes, a corner of one pushed through its middle.
{
    awk -v nx=2 -v ny=1 -v nz=1 -v h=0.1 -v held=low -f tests/cli/block.awk | sed '/^end/d'
    awk 'BEGIN { print "frame 0 0\narray node.displacement f64 m node 3"
        for (n = 0; n < 12; n++) print n == 11 ? "-.06 -.06 -.06" : n == 3 ? "0 -.02 .01" : "0 0 0"
        print "end" }'
} >"$T/folded.sinew"
picture folded --show voxels --colour quality.j.corner --size 320x240 --view 1,1,2 "$T/folded.sinew"
if [ -x "$compare" ]; then
    "$compare" tests/golden/block.png tests/golden/material.png >"$T/stdout"
    is "$?" 1 "two pictures that differ are told apart"
fi

# The same bytes.
for threads in 1 2 5; do
    sinew render --threads "$threads" --sheet rest,voxels,deformed,left --size 480x240 "$muscle" >"$T/$threads.png"
done
check "2 threads draw the same bytes as 1" cmp "$T/1.png" "$T/2.png"
check "and 5" cmp "$T/1.png" "$T/5.png"
sinew render --sheet rest,voxels,deformed,left --size 480x240 <"$muscle" >"$T/piped.png"
check "and from standard input" cmp "$T/1.png" "$T/piped.png"

# In a sheet, deformed is coloured by displacement unless --colour says otherwise, and the panel of a view only where --colour is given.
# yellow OPTION...: of the left and the right half of a sheet of two panels, whether there are colours of the scale's high end.
yellow() {
    sinew render --size 200x100 --format ppm "$@" "$muscle" | tail -c 60000 | od -An -v -tu1 -w3 |
        awk '$2 > $3 + 60 && $2 > .8 * $1 { seen[(NR - 1) % 200 < 100]++ } END { print (seen[1] > 100), (seen[0] > 100) }'
}
is "$(yellow --view front --sheet front,deformed)" "0 1" "the panel of a view keeps the surfaces' colours"
is "$(yellow --view front --colour displacement --sheet front,deformed)" "1 1" "but with --colour"

# Panels that stand side by side only because of their legends: the legends end above the lower edge.
is "$(sinew render --view front --sheet rest,voxels,front,deformed --size 1280x720 --format ppm "$muscle" |
    tail -c 3840 | od -An -v -tu1 -w1 | sort -u | tr -d ' ')" 255 "a sheet has room for its legends"

# Panels of several frames: each is what --frame draws of it, with the camera of all.
# half SIDE FILE: the left or the right half of a picture of 200 x 100 pixels.
half() {
    tail -c 60000 "$2" | od -An -v -tu1 -w600 | awk -v side="$1" '{
        for (i = 1; i <= 300; i++) printf "%s ", $(i + (side == "right" ? 300 : 0)); print "" }' | tail -n +30
}
two() {
    sinew render --camera 0,0,.2,0,0,0 --colour displacement --range 0,5mm --size 200x100 --format ppm "$@" "$muscle" >"$T/two.ppm"
}
last=$(($(sinew info --get frames "$muscle") - 1))
two --sheet a=deformed:1,b=deformed:$last
half left "$T/two.ppm" >"$T/first" && half right "$T/two.ppm" >"$T/second"
check "two frames in one sheet differ" sh -c "! cmp -s '$T/first' '$T/second'"
two --sheet a=deformed,b=deformed
half right "$T/two.ppm" >"$T/whole"
check "a panel of the last frame is the panel without a frame" cmp "$T/second" "$T/whole"
two --frame 1 --sheet a=deformed,b=deformed
half left "$T/two.ppm" >"$T/whole"
check "a panel of another frame is that of --frame" cmp "$T/first" "$T/whole"
two --sheet a=deformed:1,a=front:1,a=left:1
check "a frame may be drawn in several panels" test -s "$T/two.ppm"

# Films.
frames=$(sinew info --get frames "$muscle")
check "a run of several frames: $frames" test "$frames" -ge 3
check "a file a frame" sinew render --frame all --size 160x120 -o "$T/f_%03d.png" "$muscle"
is "$(find "$T" -name 'f_*.png' | wc -l | tr -d ' ')" "$frames" "as many files"
check "a stream of frames" sinew render --frame all --size 160x120 --format ppm -o "$T/film.ppm" "$muscle"
is "$(wc -c <"$T/film.ppm" | tr -d ' ')" $((frames * (160 * 120 * 3 + 15))) "its size is that of the frames"
is "$(head -c 15 "$T/film.ppm" | tr '\n' ' ')" "P6 160 120 255 " "its head"
fails 2 "colours of a film need a scale" '--range' sinew render --frame all --colour stress -o "$T/g_%d.png" "$muscle"
fails 2 "a name without a number" 'expected one number' sinew render --frame all -o "$T/g.png" "$muscle"

# What is refused: with a reason, and the names there are.
r() {
    status=$1 pattern=$2
    shift 2
    fails "$status" "refused: $*" "$pattern" sinew render "$@" -o "$T/none.png" "$muscle"
}
r 2 "unknown view 'frnt'; did you mean 'front'\?.*three-quarter" --view frnt
r 2 'at one place' --view 0,0,0
r 2 'X,Y,Z' --view 1,2
r 2 'no such axis' --up w
r 2 'along one line' --up z --front -z
r 2 'at one place' --camera 1,1,1,1,1,1
r 2 'expected 6' --camera 1,1,1
r 1 'looks past the model' --camera 0,0,5,0,0,9
r 2 'WIDTHxHEIGHT' --size 0x100
r 2 'WIDTHxHEIGHT' --size 100
r 1 'expected a larger one' --size 12x12
r 2 '--angle' --angle -1
r 2 "^sinew-render: --show: unknown thing 'voxel'; did you mean 'voxels'\?.*rigid_end" --show voxel
r 2 "^sinew-render: --clear: unknown thing 'skin'.*muscle" --clear skin
r 2 "^sinew-render: --clear: unknown thing 'prob'; did you mean 'probe'\? expected one of: surface, voxels, muscles, probe, muscle, " --clear prob
r 1 '--clear voxels: nothing that is drawn' --clear voxels
r 1 '--clear muscle: nothing that is drawn' --show voxels --clear muscle
r 1 '--clear rigid: these are never transparent; expected surface, voxels' --show voxels,rigid --clear voxels,rigid
r 1 '--clear probe: nothing that is drawn' --show voxels --clear probe
r 2 "unknown field 'displacment'; did you mean 'displacement'\?.*stress" --colour displacment
r 1 'cannot be shown at rest' --colour strain --frame rest
r 1 'frames 1 to|frames 0 to' --frame 99
r 2 'index, last, all, rest or undeformed' --frame first
r 2 "unknown panel 'rst'; did you mean 'rest'\?.*deformed" --sheet rst
r 1 '^sinew-render: .*: --sheet PANEL:99: no such index; the model has frames' --sheet rest,deformed:99
r 2 '--sheet deformed:x: expected the index of a frame after the colon' --sheet deformed:x
r 2 '--sheet deformed:-1: expected the index' --sheet deformed:-1
r 2 '--sheet rest:1: this panel is at rest; expected no frame' --sheet rest:1
r 2 '--frame 1: panels of --sheet name frames of their own; expected no --frame' --frame 1 --sheet deformed:1
r 2 'a caption of 0 bytes; expected 1 to 119' --sheet =deformed
r 2 "unknown panel 'frnt'" --sheet a=frnt:1
r 2 'AXIS=POSITION' --cut w=0
r 1 'to leave some' --show voxels --cut +x=-1
r 2 'two numbers' --colour stress --range 1
r 2 'must be the lower' --colour stress --range 2,1
r 1 'not a length.*Pa' --colour stress --range 1mm,2mm
r 2 'for --colour' --range 0,1
r 2 'no transparency' --format ppm --transparent
r 1 'as a font' --font /dev/null
check "no file is left" test ! -e "$T/none.png"
fails 1 "no rigid nodes yet" 'no node.rigid; expected a model from attach' sinew render --show rigid "$T/tet.sinew"
fails 1 "no muscles" 'no muscles' sinew render --show muscles "$T/tet.sinew"
printf '%%sinew 1 text\nend\n' >"$T/empty"
fails 1 "an empty model" 'no element.node; expected a model from voxelise' sinew render "$T/empty"
printf '%%sinew 1 text\naxis node 0\naxis element 0\narray node.position f64 m node 3\narray element.node i32 @node element 4\nend\n' >"$T/empty"
fails 1 "a model of no elements" 'the model is empty' sinew render "$T/empty"
fails 1 "nothing on standard input" 'no model on stdin' sinew render
printf '%%sinew 1 text\nfail 3 "tled-run: diverged"\n' >"$T/failed"
sinew render <"$T/failed" >"$T/none.png" 2>"$T/stderr"
is "$?:$(wc -c <"$T/none.png" | tr -d ' '):$(wc -c <"$T/stderr" | tr -d ' ')" "3:0:0" "a failed run gives its status, no picture and no words"

# The real face, at 2.5 mm: it is drawn, and most of the picture's middle is skin.
if [ -n "$DATA" ] && [ -s "$DATA/face/face_zyg.obj" ]; then
    voxelise -q --unit mm -s 2.5 "$DATA/face/face_zyg.obj" | attach -q | sinew bind -q >"$T/face.model"
    check "the real face" sinew render --up z --view front --size 320x240 --format ppm -o "$T/face.ppm" "$T/face.model"
    middle=$(tail -c +16 "$T/face.ppm" | od -An -v -tu1 -w960 | awk 'NR == 130 { print ($481 > $483), ($481 < 255), ($1 == 255) }')
    is "$middle" "1 1 1" "skin in the middle, paper at the side"
else
    skip 2 "no shared data"
fi

done_testing
