#!/bin/sh
# Text as it is in the world: a UTF-8 byte order mark before anything that is read as text; OBJ whose names are of any bytes, all the way to the
# command line and back; curves among polygons; triangles without area, which stitch what would be open.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
export SINEW_THREADS=1

# ---- a byte order mark

cp tests/cli/cube.obj "$T/cube.obj"
cube() {
    voxelise -q --unit mm -s 5 "$@"
}
cube -o "$T/cube.sinew" "$T/cube.obj" 2>"$T/said"
msds-mesh -q --nodes 3x3x3 --size 4cm,4cm,4cm >"$T/block.sinew"
msds-mesh -q --text --nodes 3x3x3 --size 4cm,4cm,4cm >"$T/block.text"
echo 'tissue E=5000 nu=0.4' >"$T/materials"
echo 'all level=0 surfaces=*' >"$T/volumes"
echo 'dermis thickness=5mm' >"$T/layers"
echo '0 gravity 0,0,-1' >"$T/script"
echo '0 .02 .02 .039 1 0 0 0' >"$T/poses"
for format in inp msh vtu; do
    sinew export -q -f $format -o "$T/mesh.$format" "$T/cube.sinew" 2>"$T/said"
done
printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nspace: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n\001\001\001\001\001\001\001\001' >"$T/nrrd"
printf 'NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n\001\001\001\001\001\001\001\001' >"$T/mha"

# takes NAME FILE COMMAND...: what the command writes, of $T/file and of standard input, is the same where the mark stands first.
takes() {
    name=$1 file=$2
    shift 2
    { printf '\357\273\277' && cat "$file"; } >"$T/marked"
    cp "$file" "$T/file"
    "$@" <"$T/file" >"$T/plain.out" 2>"$T/plain.said"
    status=$?
    cp "$T/marked" "$T/file"
    "$@" <"$T/file" >"$T/marked.out" 2>"$T/marked.said"
    if [ "$status" -eq 0 ] && [ -s "$T/plain.out" ] && cmp -s "$T/plain.out" "$T/marked.out" && cmp -s "$T/plain.said" "$T/marked.said"; then
        ok "a byte order mark before $name"
    else
        not_ok "a byte order mark before $name"
        diag_file "$T/plain.said"
        diag_file "$T/marked.said"
    fi
}
# with MODEL COMMAND...: the model is standard input.
# shellcheck disable=SC2317 # takes calls it
with() {
    model=$1
    shift
    "$@" <"$model"
}
takes "an OBJ" "$T/cube.obj" cube "$T/file"
takes "materials" "$T/materials" cube --materials "$T/file" "$T/cube.obj"
takes "volumes" "$T/volumes" cube --volumes "$T/file" "$T/cube.obj"
takes "layers" "$T/layers" cube --layers "$T/file" "$T/cube.obj"
takes "a script" "$T/script" with "$T/cube.sinew" tled-run -q -t .001 --script "$T/file"
takes "poses" "$T/poses" with "$T/block.sinew" msds-run -q --probe sphere:2cm --poses "$T/file"
takes "a model in text" "$T/block.text" sinew info
takes "Abaqus input" "$T/mesh.inp" sinew import -q --unit m "$T/file"
takes "Gmsh's MSH" "$T/mesh.msh" sinew import -q --unit m "$T/file"
takes "VTU" "$T/mesh.vtu" sinew import -q --unit m "$T/file"
takes "VTU by its option" "$T/mesh.vtu" sinew import -q --unit m -f vtu "$T/file"
takes "NRRD" "$T/nrrd" us-surface --iso 1 "$T/file"
takes "MetaImage" "$T/mha" us-surface --iso 1 "$T/file"
gzip -c "$T/nrrd" >"$T/twice"
{ printf '\357\273\277' && cat "$T/nrrd"; } | gzip -c >"$T/file"
us-surface --iso 1 "$T/file" >"$T/marked.out" 2>"$T/marked.said"
us-surface --iso 1 "$T/twice" >"$T/plain.out"
check "and within gzip" cmp "$T/plain.out" "$T/marked.out"
printf '\357\273\277\357\273\277NRRD0004\n' >"$T/file"
fails 1 "two marks are one too many" "is not a volume" us-surface --iso 1 "$T/file"

# ---- names of any bytes: a box whose upper half is a muscle in Latin-1, on a skull

awk 'function box(name, z0, z1, v) {
        v = n
        for (i = 0; i < 8; i++) print "v", i % 2 * 40, int(i / 2) % 2 * 40, i < 4 ? z0 : z1
        n += 8
        printf "g %s\n", name
        split("1 3 4 2 5 6 8 7 1 2 6 5 3 7 8 4 1 5 7 3 2 4 8 6", c, " ")
        for (i = 0; i < 6; i++) print "f", v + c[4 * i + 1], v + c[4 * i + 2], v + c[4 * i + 3], v + c[4 * i + 4] }
    BEGIN { box("skin", 0, 40); box("muscle_caf\351", 0, 30); print "g skull_\0333\\x41\nl 1 2\nl 3 4\nl 1 3\nl 2 4" }' >"$T/face.obj"
name=$(printf 'muscle_caf\351')
check "an OBJ with a name in Latin-1" voxelise -q --unit mm -s 10 -o "$T/names.sinew" "$T/face.obj"
attach -q <"$T/names.sinew" 2>"$T/said" | sinew bind -q -o "$T/bound.sinew" "$T/face.obj" 2>"$T/said"
is "$(sinew info --json "$T/bound.sinew" | grep -ac 'muscle_caf\\\\xe9')" 1 "its byte stands as \\xe9"
is "$(sinew info --get "volume.count.$name" "$T/bound.sinew")" 48 "--get takes the byte"
is "$(sinew info --get 'volume.count.muscle_caf\xe9' "$T/bound.sinew")" 48 "and what stands for it"
is "$(sinew info --get "volume.count.$(printf 'caf\351')" "$T/bound.sinew")" 48 "and the short name"
check "-c takes the byte" tled-run -q -t .002 -c "$(printf 'caf\351')=0.3" -o "$T/byte.sinew" <"$T/bound.sinew"
check "and what stands for it" tled-run -q -t .002 -c 'muscle_caf\xe9=0.3' -o "$T/text.sinew" <"$T/bound.sinew"
check "to the same end" sinew diff --only node.displacement "$T/byte.sinew" "$T/text.sinew"
is "$(sinew info --get 'volume.count.muscle_caf\xE9' "$T/bound.sinew")" 48 "in capitals too"
fails 2 "another byte is another name" "unknown muscle 'caf.xe8'.*caf.xe9" \
    tled-run -q -t .002 -c "$(printf 'caf\350')=0.3" <"$T/bound.sinew"
sed 's/muscle_caf./muscle_a,b=c/' "$T/face.obj" >"$T/comma.obj"
voxelise -q --unit mm -s 10 "$T/comma.obj" 2>"$T/said" | attach -q 2>"$T/said" | sinew bind -q -o "$T/comma.sinew" "$T/comma.obj" 2>"$T/said"
check "-c takes a name with a comma in it" tled-run -q -t .002 -c 'a\x2cb\x3dc=0.3' -o "$T/contracted.sinew" <"$T/comma.sinew"
check "sinew deform" sinew deform -q -o "$T/moved.obj" "$T/face.obj" <"$T/byte.sinew"
grep -a '^[gfl]' "$T/face.obj" >"$T/want"
grep -a '^[gfl]' "$T/moved.obj" >"$T/got"
check "writes the OBJ's own bytes" cmp "$T/want" "$T/got"
cmp -s "$T/face.obj" "$T/moved.obj"
is $? 1 "moved"
sinew export -q -f obj --surface face -o "$T/out.obj" "$T/byte.sinew" 2>"$T/said"
grep -a '^g' "$T/out.obj" >"$T/got"
grep -a '^g' "$T/face.obj" >"$T/want"
check "and so does sinew export" cmp "$T/want" "$T/got"
check "attach --rigid takes a byte" attach -q --rigid "$(printf 'skull_\0333\\x41')" -o "$T/rigid.sinew" <"$T/names.sinew"
is "$(sinew info --get node.rigid.sum "$T/rigid.sinew")" "$(sinew info --get node.rigid.sum "$T/bound.sinew")" "the same nodes"
check "and what stands for it" attach -q --rigid 'skull_\x1b3\x5cx41' -o "$T/rigid.sinew" <"$T/names.sinew"
printf 'all level=0 surfaces=skin\nm level=1 muscle=yes surfaces=muscle_caf\351\n' >"$T/volumes"
fails 1 "a file of ours is UTF-8, and says how to write a byte" ':2: word 4 is not UTF-8.*surfaces=muscle_caf.xe9$' \
    voxelise -q --unit mm -s 10 --volumes "$T/volumes" "$T/face.obj"
printf 'all level=0 surfaces=skin\nm level=1 muscle=yes surfaces=muscle_caf\\xe9\n' >"$T/volumes"
check "which is taken" voxelise -q --unit mm -s 10 --volumes "$T/volumes" -o "$T/planned.sinew" "$T/face.obj"

# ---- curves among polygons

{ printf 'cstype bspline\ndeg 3\n' && cat tests/cli/cube.obj && printf 'curv 0 1 1 2 3 4\nparm u 0 0 0 \\\n 1 1 1\nend\nvp 0 1\n'; } >"$T/curves.obj"
cube "$T/curves.obj" 2>"$T/said" | sinew info --get node.position.rows >"$T/got"
sinew info --get node.position.rows "$T/cube.sinew" >"$T/want"
check "free-form lines change nothing" cmp "$T/want" "$T/got"
is "$(grep -c 'curves.obj:1: free-form .* skipped, 6 lines from here on' "$T/said")" 1 "and are said once"
printf 'v 0 0 0\ncurv 0 1 1 1\n' >"$T/alone.obj"
fails 1 "curves alone are no polygons" 'no polygons' voxelise --unit mm -s 1 "$T/alone.obj"
fails 1 "and why is said" 'alone.obj:2: free-form .* skipped, 1 line' voxelise --unit mm -s 1 "$T/alone.obj"
for tool in bind deform; do
    sinew $tool -q "$T/curves.obj" <"$T/bound.sinew" 2>"$T/said" >"$T/got"
    is "$(grep -c 'free-form' "$T/said")" 1 "by sinew $tool too"
done

# ---- triangles without area: a cube whose front is cut at the middle of an edge that the bottom has whole

awk -v stitch=1 'BEGIN { print "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\nv 0 10 10\nv 5 0 0\nvn 0 0 1" }' >"$T/open.obj"
printf 'g skin\nf 1 4 3 2\nf 5 6 7 8\nf 1 9 6 5\nf 9 2 6\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n' >>"$T/open.obj"
{ cat "$T/open.obj" && echo 'f 1//1 2//1 9//1'; } >"$T/closed.obj"
fails 1 "without it the cube is open" "3 open edges" voxelise -q --unit mm -s 2 "$T/open.obj"
check "with it the cube is closed" voxelise -v --unit mm -s 2 --check -o "$T/report" "$T/closed.obj"
check "and the report says so" grep -q 'triangles without area  *1$' "$T/report"
voxelise -q --unit mm -s 2 -o "$T/box.sinew" "$T/closed.obj" 2>"$T/said"
is "$(sinew info --get axis.element "$T/box.sinew")" 125 "125 elements, by its centres"
voxelise -q --unit mm -s 4 --fraction 4 -o "$T/shares.sinew" "$T/closed.obj" 2>"$T/said"
near "$(sinew info --get element.fraction.sum "$T/shares.sinew")" 15.625 1e-6 "all of it, by shares"
sinew bind -q "$T/closed.obj" <"$T/box.sinew" 2>"$T/said" | tled-run -q -t .001 -g 0,0,-9.81 -o "$T/fell.sinew" 2>"$T/said"
check "sinew deform moves it" sinew deform -q -o "$T/got" "$T/closed.obj" <"$T/fell.sinew"
grep -i nan "$T/got" >"$T/found"
is $? 1 "without a nan, in its normals too"
done_testing
