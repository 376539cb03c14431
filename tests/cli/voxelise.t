#!/bin/sh
# voxelise: the numbers that must come out, the lattice, the box, units, input and output.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

# vox ARGS...: quietly, as text, into $T/m.
vox() {
    voxelise -q --text "$@" >"$T/m" 2>"$T/said"
}

# get KEY: of $T/m.
get() {
    sinew info --get "$1" <"$T/m"
}

# cells: element.lattice of $T/m as "i j k" lines.
cells() {
    awk '/^array element.lattice/ { on = 1; next } /^[a-z]/ { on = 0 } on' "$T/m"
}

# The paper's models.
awk -v r=100 -v n=48 -f tests/cli/sphere.awk >"$T/sphere.obj"
vox --unit mm -s 12.5 "$T/sphere.obj"
is "$(get axis.element) $(get axis.node)" "2176 2849" "sphere, radius 100 mm, voxel 12.5 mm (W&M table 1)"
is "$(get meta.source.unit)" mm "source.unit"
box skin 0 0 0 60 60 4.5 >"$T/block.obj"
vox --unit mm -s 1.5 "$T/block.obj"
is "$(get axis.element) $(get axis.node)" "4800 6724" "block 60 x 60 x 4.5 mm, voxel 1.5 mm"
if [ -n "$DATA" ]; then
    vox --unit mm -s 2.5 --origin -125,-125,-125 "$DATA/face/face_zyg.obj"
    is "$(get axis.element) $(get volume.count.muscle_zyg_xneg)" "24316 60" "the real face: all elements, and those of a muscle"
    cp "$T/m" "$T/face"
    vox --threads 1 --unit mm -s 2.5 --origin -125,-125,-125 "$DATA/face/face_zyg.obj"
    check "the same bytes on one thread" cmp "$T/m" "$T/face"
    vox --unit mm -s 2.5 --origin -125,-125,-125 "$DATA/face/face_all.obj"
    is "$(get axis.element) $(get axis.volume)" "24316 35" "34 muscles: no more elements, all volumes"
else
    skip 3 "no shared data"
fi

# A cube owns its low sides: corners on centres of cells of side 2.
box skin -3 -3 -3 3 3 3 >"$T/cube.obj"
vox --unit mm -s 2 --origin 0,0,0 "$T/cube.obj"
is "$(cells | head -n 1) $(cells | tail -n 1) $(get axis.element)" "-2 -2 -2 0 0 0 27" "a cube whose corners are centres owns its low sides"
vox --unit mm -s 2 --origin 1,1,1 "$T/cube.obj"
is "$(cells | head -n 1) $(cells | tail -n 1) $(get axis.element)" "-2 -2 -2 0 0 0 27" "a cube on the lattice's planes"

# The lattice: covers the used vertices, centred; slack 1e-6; at least one cell.
(
    cat "$T/cube.obj"
    echo "v 1000 1000 1000"
) >"$T/far.obj"
vox --unit mm -s 4 "$T/far.obj"
is "$(get axis.element) $(get meta.lattice.origin)" "8 -0.004 -0.004 -0.004" \
    "an unused vertex does not matter; 2 cells of 4 mm about 6 mm, centred"
vox --unit mm -s 1,2,3 "$T/cube.obj"
is "$(get axis.element) $(get axis.node)" "36 84" "voxels of 1 x 2 x 3 mm"
vox --unit mm -n 3 "$T/cube.obj"
is "$(get axis.element) $(get meta.lattice.spacing)" "27 0.002 0.002 0.002" "-n 3 cells along the longest side"
vox --unit mm -s 100 "$T/cube.obj"
is "$(get axis.element)" 1 "at least one cell"
box skin 0.1 0.1 0.1 1.1 1.1 1.1 >"$T/tenth.obj"
vox --unit m -s 0.1 "$T/tenth.obj"
is "$(get axis.element)" 1000 "a whole number of cells, but for rounding, gets no cell more"

# Units.
vox --unit mm -s 2 "$T/cube.obj"
cp "$T/m" "$T/mm"
vox --unit mm -s 0.2cm "$T/cube.obj"
check "-s 0.2cm is 2 mm" sinew diff "$T/mm" "$T/m"
vox --unit mm -s 0.002m --origin -0.3cm,-3,-0.003m "$T/cube.obj"
check "an origin in several units" sinew diff --only node.position,element.node "$T/mm" "$T/m"
vox --unit cm -s 2mm --origin -3cm,-3cm,-3cm "$T/cube.obj"
is "$(get axis.element)" 27000 "the same numbers in cm"
vox --unit MM -s 2 "$T/cube.obj"
check "the unit in any case" sinew diff "$T/mm" "$T/m"
for unit in um m in; do
    vox --unit "$unit" -s 2 "$T/cube.obj"
    is "$(get axis.element) $(get meta.source.unit)" "27 $unit" "--unit $unit"
done

# A box keeps voxels whose centre is in it, low sides included. Centres at -2, 0, 2.
vox --unit mm -s 2 --box -2,-2,-2,2,2,2 "$T/cube.obj"
is "$(get axis.element) $(cells | head -n 1)" "8 0 0 0" "--box: half-open"
vox --unit mm -s 2 --box 0,-1e6,-1e6,1e6,1e6,1m "$T/cube.obj"
is "$(get axis.element) $(cells | head -n 1)" "18 1 0 0" "--box: far larger than the lattice"
fails 1 "--box off the surface" "no voxel has its centre inside.*--box" voxelise --unit mm -s 2 --box 8,8,8,9,9,9 "$T/cube.obj"

# In and out.
check "from stdin" sh -c "voxelise -q --unit mm -s 2 - <'$T/cube.obj' >'$T/m'"
check "the same model from stdin, its surface named so" sinew diff --only node.position,element.node "$T/mm" "$T/m"
is "$(sinew info <"$T/m" | grep -c '^  stdin/vertex.position')" 1 "the surface is carried: stdin"
gzip -c "$T/cube.obj" >"$T/cube.obj.gz"
vox --unit mm -s 2 "$T/cube.obj.gz"
check "gzipped, the same name" sinew diff "$T/mm" "$T/m"
check "-o, binary" voxelise -q -o "$T/binary" --unit mm -s 2 "$T/cube.obj"
check "the same model as binary" sinew diff "$T/mm" "$T/binary"
vox --unit mm -s 2 "$T/cube.obj"
is "$(sed -n '1p;$p' "$T/m" | tr '\n' ' ')" "%sinew 1 text end " "text, to its end"
is "$(voxelise --unit mm -s 2 --threads 3 "$T/cube.obj" 2>/dev/null | sinew info | sed -n 's/^  voxelise [0-9.]* //p')" \
    "--unit mm -s 2 cube.obj" "provenance: what changes the result"

# Order: k, j, i, i fastest; nodes too.
vox --unit mm -s 2 "$T/cube.obj"
is "$(cells | awk '{ n = ($3 * 3 + $2) * 3 + $1; if (n != NR - 1) bad = 1 } END { print NR, bad + 0 }')" "27 0" "elements in k, j, i order"
is "$(awk '/^array element.node/ { getline; print }' "$T/m")" "0 1 5 4 16 17 21 20" "nodes in VTK order"

# The size of all is said, and warned of beyond 3 m and below 3 mm, with the unit that it may be in.
# sized SIDE UNIT: a cube of that side in that unit; what is said of its size, and the warnings about it.
sized() {
    awk -v s="$1" '/^v / { print "v", ($2 + 10) / 20 * s, ($3 + 10) / 20 * s, ($4 + 20) / 20 * s; next } { print }' tests/cli/cube.obj >"$T/sized.obj"
    voxelise --unit "$2" -n 4 -o "$T/sized.sinew" "$T/sized.obj" 2>"$T/said" || diag "voxelise fails"
    sed -n 's/^voxelise: surfaces of //p; s/^voxelise: warning: .*sized.obj is //p' "$T/said" | tr '\n' ':'
}
is "$(sized 142 mm)" "142 x 142 x 142 mm:" "the size is said, in the OBJ's unit"
is "$(sized 142 m)" "142 x 142 x 142 m:142 x 142 x 142 m with --unit m, beyond 3 m; with --unit mm it is 0.142 x 0.142 x 0.142 m:" \
    "a face of 142 m is warned of"
is "$(sized .142 mm)" "0.142 x 0.142 x 0.142 mm:0.000142 x 0.000142 x 0.000142 m with --unit mm, below 3 mm; with --unit m it is 0.142 x 0.142 x 0.142 m:" \
    "and one of .14 mm"
is "$(sized 3 m)$(sized 3 mm)" "3 x 3 x 3 m:3 x 3 x 3 mm:" "3 m and 3 mm are not"
is "$(sized 3.001 m)" "3.001 x 3.001 x 3.001 m:3.001 x 3.001 x 3.001 m with --unit m, beyond 3 m; with --unit mm it is 0.003001 x 0.003001 x 0.003001 m:" \
    "beyond them they are"
is "$(sized 3.0000001 m)" "3 x 3 x 3 m:" "what rounding adds to 3 m is no more than 3 m"
is "$(sized 1e9 mm)" "1e+09 x 1e+09 x 1e+09 mm:1e+06 x 1e+06 x 1e+06 m with --unit mm, beyond 3 m; no other unit gives it the size of a body:" \
    "no unit helps there"
voxelise -q --unit m -n 4 -o "$T/sized.sinew" "$T/sized.obj" 2>"$T/said"
is "$(grep -c 'surfaces of' "$T/said") $(grep -c 'beyond 3 m' "$T/said")" "0 1" "-q keeps the warning"
done_testing
