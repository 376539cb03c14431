#!/bin/sh
# What is written is no file that is read, nor one that is written elsewhere, by whatever name or link: nothing is lost. Only -o, which
# replaces its file when all is read, may name standard input.
. "$(dirname "$0")/lib.sh"

# box NAMES X0 Y0 Z0 X1 Y1 Z1, as OBJ.
. "$ROOT/tests/cli/boxes.sh"

awk -v nx=4 -v ny=3 -v nz=3 -v h=0.005 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/model"
box ball 2 2 20 8 8 26 >"$T/ball.obj"
echo '0 contract all 0.1' >"$T/script"
echo 'm E=3000 nu=0.45' >"$T/materials"
printf '0 0.01 0.007 0.03 1 0 0 0\n1 0.01 0.007 0.03 1 0 0 0\n' >"$T/poses"
cd "$T" || exit 1
ln model hard
ln -s model soft
ln script hardscript
ln -s poses.1 dangling
mkdir sub
kept_files='model ball.obj script materials poses'
sum() {
    # shellcheck disable=SC2086 # names without blanks
    cksum $kept_files
}
sum >before

# kept NAME PATTERN COMMAND...: a usage error in one line, which says so, and all files are as they were.
kept() {
    fails 2 "$@"
    sum | cmp -s before - || not_ok "$1: a file was lost"
    [ "$(wc -l <stderr)" -eq 1 ] || not_ok "$1: one line"
}
run() { # ARG...
    tled-run -q -d cpu -n 3 "$@"
}
for name in model hard soft sub/../model "$T/model" /dev/stdin; do
    kept "--log to standard input, as $name" "^tled-run: --log '$name' would overwrite what is read on standard input; expected another file$" \
        run --log "$name" -o zz <model
done
kept "and from a link" "what is read on standard input" run --log model -o zz <hard
kept "--checkpoint there" "^tled-run: --checkpoint 'model' would overwrite what is read on standard input" run --checkpoint model -o zz <hard
ln model state.1
ln model rows.frames
kept "a file of a checkpoint there" "--checkpoint 'state.1' would overwrite what is read on standard input" run --checkpoint state -o zz <model
kept "of a restart" "--restart 'rows.frames' would overwrite what is read on standard input" run --restart rows -o zz <model
rm state.1 rows.frames
kept "--log to a script's link" "--log 'hardscript' would overwrite the file of --script 'script'" run --log hardscript --script script <model
kept "to the materials" "--log 'materials' would overwrite the file of --materials '$T/materials'" run --log materials --materials "$T/materials" <model
kept "to the poses" "--log 'poses' would overwrite the file of --poses 'sub/../poses'" run --log poses --probe sphere:1cm --poses sub/../poses <model
kept "to the probe" "--log 'ball.obj' would overwrite the file of --probe './ball.obj'" run --log ball.obj --probe convex:./ball.obj --unit mm --poses poses <model
kept "-o to the probe" "-o 'ball.obj' would overwrite the file of --probe './ball.obj'" run -o ball.obj --probe convex:./ball.obj --unit mm --poses poses <model
kept "a file of a checkpoint to the poses, which are not there" "--checkpoint 'poses.1' would overwrite the file of --poses 'dangling'" \
    run --checkpoint poses --probe sphere:1cm --poses dangling <model
kept "--log to -o, which is not there" "--log 'new' would overwrite the file of -o 'sub/../new'|-o 'sub/../new' would overwrite the file of --log 'new'" run --log new -o sub/../new <model
kept "--log to a file of the checkpoint" "--checkpoint 'new.frames' would overwrite the file of --log" run --log new.frames --checkpoint new <model
# shellcheck disable=SC2094 # that is what is refused
run --log out >>out <model 2>err
is "$? $(cat err)" "2 tled-run: --log 'out' would overwrite what goes to standard output; expected another file" "--log to standard output"
is "$(find . -name 'zz*' -o -name 'new*' -o -name 'state*')" "" "nothing is made"
kept "--log to a pipe that standard output goes to" "^tled-run: --log '/dev/stdout' would overwrite what goes to standard output; expected another file$" \
    sh -c 'tled-run -q -d cpu -n 3 --log /dev/stdout <model 2>err | cat >mixed; cat err >&2; test ! -s err || exit 2'
kept "to one that standard input comes from" "^tled-run: --log '/dev/stdin' would overwrite what is read on standard input; expected another file$" \
    sh -c 'cat model | tled-run -q -d cpu -n 3 --log /dev/stdin -o zz'
mkfifo fifo
kept "to one with a name" "^tled-run: --log 'fifo' would overwrite what is read on standard input; expected another file$" \
    sh -c 'cat model >fifo & tled-run -q -d cpu -n 3 --log fifo -o zz <fifo'
kept "to a socket" "^tled-run: --log '/dev/stdin' would overwrite what is read on standard input; expected another file$" \
    python3 -c 'import socket, subprocess, sys
sys.exit(subprocess.run("tled-run -q -d cpu -n 3 --log /dev/stdin -o zz".split(), stdin=socket.socketpair()[0]).returncode)'
check "-o may name standard input" sh -c 'cp model own && tled-run -q -d cpu -n 3 -o own <own && sinew info --get axis.node own'
check "devices are no files" run --log /dev/null -o /dev/null <model
check "a pipe of its own" sh -c 'tled-run -q -d cpu -n 3 --log /dev/stderr -o zz 2>&1 <model | grep -q kinetic'
check "a log by descriptor" sh -c 'tled-run -q -d cpu -n 3 --log /dev/fd/3 -o zz 3>rows <model && grep -q kinetic rows'
rm zz

# Numbered files, when it is known which they are.
box skin 2 2 2 18 13 13 >skin_0001.obj
cp skin_0001.obj skin_0000.obj
voxelise -q --unit mm -s 4 skin_0001.obj | sinew bind -q skin_0001.obj | tled-run -q -d cpu -n 30 -g 0,0,-9.81 --every 1e-3 -o film 2>err
cp film film_0001.vtu
kept_files='skin_0000.obj skin_0001.obj film film_0001.vtu'
sum >before
kept "deform" "^sinew-deform: -o 'skin_0001.obj' would overwrite what is read, './skin_0001.obj'" sinew deform --frame all -o skin_%04d.obj ./skin_0001.obj <film
kept "export" "^sinew-export: -o 'film_0001.vtu' would overwrite what is read, 'film_0001.vtu'" sinew export -f vtu --frame all -o film.pvd film_0001.vtu
cp film p0001
kept_files=p0001
sum >before
kept "render" "^sinew-render: -o 'p0001' would overwrite what is read, 'p0001'" sinew render --size 20x20 --frame all -o p%04d p0001
is "$(find . -name 'skin_*' | wc -l) $(find . -name 'p0*' | wc -l) $(find . -name '.sinew*')" "2 1 " "no file is made, and none is left"

# Slices: --cut goes to its place at each image.
cd "$ROOT" || exit 1
awk 'BEGIN { printf "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 6 6 6\nspace directions: (4,0,0) (0,4,0) (0,0,4)\nkinds: domain domain domain\nencoding: text\nspace origin: (0,0,0)\n\n"
    for (i = 0; i < 216; i++) print i }' >"$T/volume.nrrd"
echo '0 .01 .01 0 0 0 0 1' >"$T/press"
msds-mesh -q --nodes 4x4x4 --like "$T/volume.nrrd" | msds-run -q -d cpu --probe sphere:3mm --poses "$T/press" -o "$T/mesh" 2>"$T/err"
cd "$T" || exit 1
ln mesh mesh.obj
kept_files='mesh volume.nrrd'
sum >before
# shellcheck disable=SC2317 # kept runs it
slice() {
    us-slice -q --size 20x20 --depth 2cm "$@" volume.nrrd <mesh
}
kept "--cut to the model" "^us-slice: --cut 'mesh.obj' would overwrite what is read on standard input" slice --cut mesh.obj -o out.pgm
kept "--cut to the volume" "--cut 'volume.nrrd' would overwrite what is read, 'volume.nrrd'" slice --cut volume.nrrd -o out.pgm
kept "--cut to the output" "--cut 'out' would overwrite the file of -o 'out'|-o 'out' would overwrite the file of --cut 'out'" slice --cut out -o out
ln -s mesh c_0.obj
kept "a numbered cut to the model" "--cut 'c_0.obj' would overwrite what is read on standard input" slice --cut c_%d.obj -o i_%d.pgm
kept "a numbered cut to the numbered image" "--cut 'i_0.pgm' would overwrite the file of -o 'i_0.pgm'" slice --cut i_%d.pgm -o i_%01d.pgm

# Files that only an input names.
printf '%s\n' 'ObjectType = Image' 'NDims = 3' 'DimSize = 6 6 6' 'ElementType = MET_UCHAR' 'ElementSpacing = 4 4 4' \
    'ElementDataFile = vol.raw' >vol.mhd
head -c 216 mesh >vol.raw
ln vol.raw raw.link
kept_files='vol.mhd vol.raw'
sum >before
# named NAME FILE COMMAND...: that file was read, so it stays.
named() {
    name=$1 file=$2
    shift 2
    fails 1 "$name" "^[a-z-]*: $file: is a file that was read; expected another to write$" "$@"
    sum | cmp -s - before || not_ok "$name: a file was lost"
    [ "$(wc -l <stderr)" -eq 1 ] || not_ok "$name: one line"
}
named "the voxels of a header" vol.raw us-segment -q -n a --low 100 -o vol.raw vol.mhd
named "by another name" raw.link us-segment -q -n a --low 100 -o raw.link vol.mhd
check "another file" us-segment -q -n a --low 100 -o labels.nrrd vol.mhd
check "which is there" us-segment -q -n a --low 100 -o labels.nrrd vol.mhd
if have python3; then
    python3 "$ROOT/tests/cli/dicom.py" images series && rm images/expected
    kept_files='images/im00.dcm images/im07.dcm'
    sum >before
    named "an image in a folder" images/im07.dcm us-import -v -q -o images/im07.dcm images
fi
is "$(find . -name '.sinew*')" "" "none is left"

check "each its own" slice --cut d_%d.obj -o i_%d.pgm
is "$(ls d_0.obj i_0.pgm)" "d_0.obj
i_0.pgm" "both are there"
done_testing
