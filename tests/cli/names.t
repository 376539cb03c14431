#!/bin/sh
# Names that an input gives: no tool opens a file outside the input's folder because the input says so, by ../, by an absolute path, or
# through a link. What is named is a FIFO that nobody writes to, and whoever opened it would wait for ever.
. "$(dirname "$0")/lib.sh"

have mkfifo || skip_all "no mkfifo"
have timeout || skip_all "no timeout"
mkdir "$T/in" "$T/out"
mkfifo "$T/out/canary"
cp tests/cli/cube.obj "$T/out/cube.obj"
ln -s ../out/canary "$T/in/link"
ln -s "$T/out/cube.obj" "$T/in/linked.obj"
cd "$T/in" || exit 1
check "whoever opens it waits" sh -c 'timeout 0.2 cat ../out/canary; [ $? -eq 124 ]'

# ignored NAME COMMAND...: it goes on as if nothing had been named.
ignored() {
    name=$1
    shift
    check "$name" timeout 180 "$@"
}
# refused NAME PATTERN COMMAND...
refused() {
    name=$1 pattern=$2
    shift 2
    fails 1 "$name" "$pattern" timeout 180 "$@"
}

for canary in ../out/canary "$T/out/canary" link; do
    # ---- OBJ: materials and textures are passed on, never read; statements that run other files are refused.
    { printf 'mtllib %s\nusemtl a\nmaplib %s\n' "$canary" "$canary" && cat "$ROOT/tests/cli/cube.obj"; } >named.obj
    ignored "OBJ, mtllib $canary: voxelise" voxelise -q --unit mm -s 5 -o model.sinew named.obj
    ignored "attach --rigid-file" sh -c 'attach -q --rigid-file named.obj <model.sinew >rigid.sinew'
    ignored "bind" sh -c 'sinew bind named.obj <rigid.sinew >bound.sinew'
    tled-run -q -d cpu -n 2 <bound.sinew >run.sinew 2>/dev/null
    ignored "deform" sh -c 'sinew deform named.obj <run.sinew >moved.obj'
    is "$(grep -c "^mtllib $canary$" moved.obj)" 1 "and the line is passed on"
    ignored "export -f obj" sinew export -f obj -o out.obj run.sinew
    ignored "render" sinew render --size 60x40 -o out.png run.sinew
    { printf 'call %s\n' "$canary" && cat "$ROOT/tests/cli/cube.obj"; } >called.obj
    refused "OBJ, call" "a statement that runs other files" voxelise -q --unit mm -s 5 called.obj
    # ---- A probe that the model names: its OBJ is not sought.
    sinew export -f model --text run.sinew | grep -v '^crc' | sed "2i meta probe.shape \"convex:$canary\"" >probed.sinew
    refused "metadata, probe.shape" "which the model does not hold" sinew render --size 60x40 --show probe -o out.png probed.sinew
    # ---- Volumes whose data are elsewhere.
    printf 'NRRD0004\ntype: uchar\ndimension: 3\nencoding: raw\nsizes: 3 3 3\ndata file: %s\n' "$canary" >a.nhdr
    printf 'NRRD0004\ntype: uchar\ndimension: 3\nencoding: raw\nsizes: 3 3 3\ndata file: LIST\n%s\n%s\n%s\n' "$canary" "$canary" "$canary" >list.nhdr
    printf '%s\n' 'ObjectType = Image' 'NDims = 3' 'DimSize = 3 3 3' 'ElementType = MET_UCHAR' 'ElementSpacing = 1 1 1' \
        "ElementDataFile = $canary" >a.mhd
    printf '%s\n' 'ObjectType = Image' 'NDims = 3' 'DimSize = 3 3 3' 'ElementType = MET_UCHAR' 'Kinds = domain domain list' \
        'Seq_Frame0000_ProbeToTrackerTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1' 'Seq_Frame0000_Timestamp = 0' \
        "ElementDataFile = $canary" >sweep.seq.mhd
    for volume in a.nhdr a.mhd; do
        for tool in 'us-import -v' 'us-segment -n a --low 1' 'us-surface -i 1' 'msds-mesh --nodes 3x3x3 --like'; do
            # shellcheck disable=SC2086 # a tool and its options
            refused "${tool%% *}, $volume: $canary" "outside its folder" $tool $volume
        done
    done
    refused "NRRD, a list of files" "LIST" us-import -v list.nhdr
    refused "a tracked sequence" "outside its folder|is not a regular file|expected" us-import sweep.seq.mhd
    # ---- Abaqus input in several files.
    for line in "*INCLUDE, INPUT=$canary" "*NODE, INPUT=$canary"; do
        printf '%s\n' "$line" >named.inp
        refused "$line" 'expected (all in one file|x, y, z written out)' sinew import --unit m -o out.sinew named.inp
    done
    # ---- A body's surfaces.
    printf 'surface %s unit=mm\n' "$canary" >body
    refused "a body that names $canary" "expected the name of a file in the folder|outside its folder" \
        sinew render --size 60x40 --body body -o out.png run.sinew
done
printf 'surface linked.obj unit=mm\n' >body
refused "a link in a body's folder to an OBJ elsewhere" "outside its folder" sinew render --size 60x40 --body body -o out.png run.sinew
cp ../out/cube.obj own.obj
printf 'surface own.obj unit=mm\n' >body
ignored "a surface in the body's folder" sinew render --size 60x40 --body body -o out.png run.sinew
# ---- The folder that the input lies in, not the one that the tool runs in.
cd "$T/out" || exit 1
printf 'abcdefghijklmnopqrstuvwxyzA' >../in/data.raw
printf 'NRRD0004\ntype: uchar\ndimension: 3\nencoding: raw\nsizes: 3 3 3\ndata file: data.raw\n' >../in/b.nhdr
ignored "data beside a header elsewhere" us-import -q -o b.nrrd ../in/b.nhdr
is "$(find "$T/in" "$T/out" -name '*.png' | grep -c .)" 1 "what was refused left no picture, and what was not has its own"
done_testing
