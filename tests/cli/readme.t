#!/bin/sh
# The commands of README.md, as a reader types them, one block after another in a folder with our head as face.obj: coarser and shorter,
# that is all. A block that is new here must be told of below: run, or why not.
. "$(dirname "$0")/lib.sh"

# Each block of indented lines is a file.
mkdir "$T/blocks" "$T/here" "$T/here/faces"
awk -v to="$T/blocks" '/^    / { if (!on) n++; on = 1; sub(/^    /, ""); print >sprintf("%s/%02d", to, n); next } { on = 0 }' README.md
check "there are blocks: $(find "$T/blocks" -type f | wc -l | tr -d ' ')" test "$(find "$T/blocks" -type f | wc -l)" -ge 8

cd "$T/here" || exit 1
ln -s "$ROOT/samples" samples
cp samples/arm.materials .
awk -f samples/shape.awk -f samples/head.awk >face.obj
awk -f samples/shape.awk -f samples/muscle.awk >faces/one.obj
cp faces/one.obj faces/two.obj
for surface in vein artery bone; do
    awk -v what=$surface -f samples/arm.awk >$surface.obj
done
awk -v what=labels -f samples/arm.awk >labels.nrrd
awk -v what=poses -v hz=60 -f samples/arm.awk >press.tum

# coarser FILE: its commands, for a test's patience.
coarser() {
    sed 's/-s 2\.5 /-s 8 /; s/-t 0\.5/-t 0.05/; s/--nodes 33x11x17/--nodes 13x5x7/' "$1"
}
for block in "$T/blocks"/*; do
    title="$(head -n 1 "$block" | cut -c 1-50)"
    case $title in
    'make demo '* | 'elements  '*) continue ;; # the two commands themselves; what one prints
    voxelise* | msds-mesh* | 'sinew export'* | tled-run* | 'make -C samples'*) ;;
    msds-run*)
        if ! have ffmpeg; then
            skip 1 "no ffmpeg"
            continue
        fi
        ;;
    *)
        not_ok "a block that this test does not know: $title"
        continue
        ;;
    esac
    coarser "$block" >"$T/commands"
    # make finds the tools where ours are, and is none of a make above.
    check "$title" env -u MAKEFLAGS -u MAKELEVEL sh -e "$T/commands"
    cat "$T/stdout" >>"$T/said"
    if have bash && [ "${title#make}" = "$title" ]; then
        check "the same in bash" bash -e "$T/commands"
    fi
done
for file in smile.sinew smile.obj face.png face.sinew face.log film.sinew corner.tsv film.pvd face.pc2 arm.sinew fem.sinew arm.png; do
    check "$file came out" test -s $file
done
check "film.pvd has its frames" test "$(grep -c '<DataSet' film.pvd)" -ge 4
is "$(grep -c 'not as it was' "$T/said")" 0 "two runs are the same"
is "$(wc -l <corner.tsv | tr -d ' ')" "$(($(sinew info --get frames film.sinew) + 1))" "the corner, in each frame"
is "$(cd results && echo *.moved.obj)" "one.moved.obj two.moved.obj" "a folder of models"
have ffmpeg && check "a video" test -s arm.mp4
done_testing
