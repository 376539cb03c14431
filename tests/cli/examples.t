#!/bin/sh
# The EXAMPLES of every page of section 1, run as they stand there, coarser and shorter: page by page in a folder of its own, which has
# samples and the files that other pages' examples make. At the end of this file: which are not run, and why. Of a page the first two, and with
# SINEW_LONG all.
. "$(dirname "$0")/lib.sh"

# ---- The examples: a file each, as a reader sees them. Where commands stand behind a $, other lines are what they print.
mkdir "$T/examples" "$T/here"
for page in man/*.1; do
    sed -n '/^\.Sh EXAMPLES/,/^\.Sh [^E]/p' "$page" | sed 's/\\e$/\\/; s/\\e/\\/g; s/\\(dq/"/g; s/\\&//g; s/\\-/-/g' |
        awk -v to="$T/examples/$(basename "$page" .1)" '
            function begin() { name = sprintf("%s.%02d", to, ++n); printf "" >name }
            /^\.Bd -literal/ { begin(); on = 1; next }
            /^\.Ed/ { on = 0; next }
            /^\.Dl / { begin(); sub(/^\.Dl /, ""); print >name; next }
            on { print >name }'
done
for example in "$T"/examples/*; do
    grep -q '^\$ ' "$example" || continue
    awk '/^\$ / { sub(/^\$ /, ""); on = 1 } on { print } { on = on && /[\\|]$/ }' "$example" >"$T/commands" && mv "$T/commands" "$example"
done
check "there are examples: $(find "$T/examples" -type f | wc -l | tr -d ' ')" test "$(find "$T/examples" -type f | wc -l)" -ge 35
for page in man/*.1; do
    check "$page has some" test -e "$T/examples/$(basename "$page" .1).01"
done

# coarser FILE: so that a test does not take long. The head is made once.
coarser() {
    sed -E 's/-s (2\.5|5) /-s 10 /; s/-s 2,2,0\.5 /-s 6,6,1.5 /; s/-s 1\.5 /-s 3,3,1.5 /; s/-n 128 /-n 24 /; s/-t (0\.2|0\.5|1|2)( |$)/-t 0.03\2/; s/--every 0\.0[0-9]/--every 0.01/
        s/--nodes 32x16x16/--nodes 9x5x7/; s/--nodes 32x10x24/--nodes 9x5x7/; s/i <= 30/i <= 3/; s/-gt 20000/-gt 500/; s/^awk .*head\.awk > face\.obj$/test -s face.obj/
        s/awk -f (samples\/ball)/awk -v n=4 -f \1/; s/gmsh -3/gmsh -v 1 -3/
        s/^vi /sed -n 1p /; s/^less /sed -n 1p /; s/(sinew render .*)--(up|view)/\1--size 300x200 --\2/; s/ffmpeg -f/ffmpeg -v error -y -f/' "$1"
}

# ---- What pages take from the examples of others: of sinew, sinew-diff, us-import and us-segment.
cd "$T/here" || exit 1
{
    ln -s "$ROOT/samples" samples
    awk -f samples/shape.awk -f samples/head.awk >face.obj
    voxelise -q --unit mm -s 10 face.obj | attach -q | sinew bind -q >face.sinew
    tled-run -q -c zyg_left=0.4 -t 0.03 <face.sinew >smile.sinew
    mkdir patient && awk -v folder=patient -f samples/patient.awk
    us-import -q patient/ >patient.nrrd
    us-segment -q -n bone --low 210 --largest patient.nrrd >bone.nrrd && us-segment -q -n vein --low 45 --high 90 --onto bone.nrrd patient.nrrd >labels.nrrd
} >"$T/made" 2>&1
[ -s "$T/made" ] && diag_file "$T/made"
mkdir "$T/all"
cp -R . "$T/all"

# ---- What voxelise(1) prints of a check is what a check prints.
sed -n '/^\$ voxelise --check/,/^\.Ed/p' "$ROOT/man/voxelise.1" | sed '1d; $d' >"$T/printed"
voxelise --check --unit mm -s 2.5 face.obj >"$T/report" 2>/dev/null
check "voxelise(1) shows the report on the head" diff "$T/printed" "$T/report"

# ---- Those of a page in their order, with all of that in their folder.
last=
for example in "$T"/examples/*; do
    name=$(basename "$example")
    coarser "$example" >"$T/commands"
    title="$name: $(head -n 1 "$example" | cut -c 1-60)"
    if [ "${name%.*}" != "$last" ]; then
        last=${name%.*}
        rm -rf "${T:?}/here"
        cp -R "$T/all" "$T/here"
    fi
    cd "$T/here" || exit 1
    if [ ! "$SINEW_LONG" ] && [ "${name##*.}" != 01 ] && [ "${name##*.}" != 02 ]; then
        continue
    elif grep -q 'ffmpeg' "$T/commands" && ! have ffmpeg; then
        skip 1 "$name: no ffmpeg"
    elif grep -q '^gmsh' "$T/commands" && ! have gmsh; then
        skip 1 "$name: no gmsh"
    elif grep -q '^ccx' "$T/commands" && ! have ccx; then
        skip 1 "$name: no ccx"
    elif grep -q 'sweep\.igs\.mha' "$T/commands"; then
        skip 1 "$name: a tracked sweep is a recording; us-import.t makes one and runs this"
    elif grep -q 'sinew igtl-' "$T/commands"; then
        skip 1 "$name: wants another program on the line; igtl-in.t and igtl-out.t have one"
    elif grep -q 'sinew console' "$T/commands"; then
        skip 1 "$name: goes on until it is ended; console.t does so"
    else
        check "$title" sh -e "$T/commands"
    fi
done
done_testing
