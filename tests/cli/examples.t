#!/bin/sh
# The EXAMPLES of every page of section 1, run as they stand there, on small files of the names that they use: coarser and shorter, with
# our own shapes for a patient's. Listed at the end of this file: what is not run, and why.
. "$(dirname "$0")/lib.sh"

# ---- The examples: a file each, as a reader sees them. Where commands stand behind a $, other lines are what they print.
mkdir "$T/examples" "$T/here"
for page in man/*.1; do
    sed -n '/^\.Sh EXAMPLES/,/^\.Sh [^E]/p' "$page" | sed 's/\\e$/\\/; s/\\e/\\/g; s/\\(dq/"/g; s/\\&//g; s/\\-/-/g' |
        awk -v to="$T/examples/$(basename "$page" .1)" '
            function begin() { name = sprintf("%s.%d", to, ++n); printf "" >name }
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
    check "$page has some" test -e "$T/examples/$(basename "$page" .1).1"
done

# coarser FILE: for a test's patience, and where a number is of other data than ours.
coarser() {
    sed -E 's/-s 2\.5 /-s 10 /; s/-s 2,2,0\.5 /-s 6,6,1.5 /; s/-n 128 /-n 24 /; s/-t (0\.5|1|2)( |$)/-t 0.03\2/; s/--every 0\.0[0-9]/--every 0.01/
        s/--nodes 32x16x16 --like arm/--nodes 12x10x10 --like patient/; s/--nodes 32x16x16/--nodes 9x5x7/; s/-gt 20000/-gt 500/
        s/--crop 110,40,710,560 volume.dcm/--crop 4,4,20,20 patient/; s/--seed 12,-30,41mm/--seed 9,11,0mm/; s/--tolerance 15/--tolerance 30/
        s/awk -f (samples\/ball)/awk -v n=4 -f \1/; s/gmsh -3/gmsh -v 1 -3/
        s/^vi /sed -n 1p /; s/^less /sed -n 1p /; s/(sinew render .*)--(up|view)/\1--size 300x200 --\2/; s/ffmpeg -f/ffmpeg -v error -y -f/' "$1"
}

# ---- The files that they speak of.
cd "$T/here" || exit 1
shape() {
    awk -f "$ROOT/samples/shape.awk" -f "$ROOT/samples/$1.awk"
}
arm() {
    awk -v what="$1" -v hz=10 -f "$ROOT/samples/arm.awk"
}
shape head >face.obj
shape block >block.obj
shape sphere >sphere.obj
for surface in vein artery; do
    arm $surface >$surface.obj
done
arm labels >arm.nrrd
arm labels >head.nrrd
arm labels >map.nrrd
arm poses >press.tum
cp press.tum sweep.tum
{
    mkdir patient && awk -v folder=patient -f "$ROOT/samples/patient.awk"
    us-import -q patient/ >patient.nrrd
    voxelise -q --unit mm -s 10 face.obj | attach -q | sinew bind -q >face.sinew
    tled-run -q -c zyg=0.4 -t 0.03 <face.sinew >smile.sinew
    cp face.sinew old.sinew
    cp face.sinew new.sinew
    voxelise -q --unit mm -s 5 "$ROOT/tests/cli/cube.obj" | attach -q --rigid '*' >cube.sinew
    msds-mesh -q --nodes 9x5x7 --like map.nrrd >arm.sinew
    ln -s "$ROOT/samples" samples
    msds-mesh -q --nodes 9x5x7 --size 16cm,8cm,8cm >block.sinew
    printf '%s\n' 'tissue E=10e3' 'bone   E=1e7 nu=0.3 density=1900' 'vein   E=500' >materials
    # A box of 40 mm for Gmsh, with a volume and a side of it named.
    printf '%s\n' 'SetFactory("OpenCASCADE");' 'Box(1) = {0, 0, 0, 40, 40, 40};' 'Physical Volume("liver") = {1};' \
        'Physical Surface("porta") = {1};' 'Mesh.MeshSizeMin = 20;' >liver.geo
    echo 'liver E=5000 nu=0.45' >liver.txt
    us-segment -q -n bone --low 210 --largest patient.nrrd >bone.nrrd && us-segment -q -n vein --low 45 --high 90 --onto bone.nrrd patient.nrrd >labels.nrrd
} >"$T/made" 2>&1
[ -s "$T/made" ] && diag_file "$T/made"
mkdir "$T/all"
cp -R . "$T/all"

# ---- Each in a folder of its own, with all of that in it.
number=0
for example in "$T"/examples/*; do
    name=$(basename "$example")
    coarser "$example" >"$T/commands"
    title="$name: $(head -n 1 "$example" | cut -c 1-60)"
    number=$((number + 1))
    rm -rf "${T:?}/here"
    cp -R "$T/all" "$T/here"
    cd "$T/here" || exit 1
    if grep -q 'ffmpeg' "$T/commands" && ! have ffmpeg; then
        skip 1 "$name: no ffmpeg"
    elif grep -q '^gmsh' "$T/commands" && ! have gmsh; then
        skip 1 "$name: no gmsh"
    elif grep -q '^ccx' "$T/commands" && ! have ccx; then
        skip 1 "$name: no ccx"
    elif grep -q 'sweep\.igs\.mha' "$T/commands"; then
        skip 1 "$name: a tracked sweep is a recording; us-import.t makes one and runs this"
    else
        check "$title" sh -e "$T/commands"
    fi
done
done_testing
