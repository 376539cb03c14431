#!/bin/sh
# Every tool under valgrind's memcheck, on small inputs: no error, no block lost, and the bytes that it writes without. `make
# check-valgrind` runs this, and make check does not. Valgrind knows no AVX-512 and hides it from the tools, which choose
# their loops by the processor. What libraries do is in tests/valgrind.supp.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

have valgrind || skip_all "no valgrind"
# us-import has its own operator new, whose delete the compiler puts in line: both are taken as they are.
checked="valgrind -q --error-exitcode=99 --leak-check=full --show-leak-kinds=definite,possible --errors-for-leak-kinds=definite,possible
    --num-callers=24 --suppressions=tests/valgrind.supp --gen-suppressions=all --soname-synonyms=somalloc=nouserintercepts"
SINEW_THREADS=4
export SINEW_THREADS

# clean STATUS NAME TOOL ARGUMENTS...: reads $T/in; what the tool writes is kept in $T/NAME.
clean() {
    want=$1 name=$2 tool=$3
    shift 3
    "$tool" "$@" <"$T/in" >"$T/$name" 2>"$T/said"
    # shellcheck disable=SC2086 # words
    $checked "$SINEW_BIN/$tool" "$@" <"$T/in" >"$T/checked" 2>"$T/stderr"
    is "$? $(grep -c '^==' "$T/stderr") $(cksum <"$T/checked")" "$want 0 $(cksum <"$T/$name")" "$name"
    grep -v '^sinew\|^us-\|^msds-\|^tled-' "$T/stderr" | head -n 80 | sed 's/^/#   /'
}

{
    awk -v x=20 -v y=20 -v z=20 -v held=low -f tests/cli/box.awk
    awk -v x=10 -v y=10 -v z=10 -f tests/cli/box.awk |
        awk '/^g/ { print "g muscle_A"; next } /^f/ { print "f", $2 + 8, $3 + 8, $4 + 8, $5 + 8; next } { print }'
} >"$T/box.obj"
cp tests/cli/cube.obj "$T/cube.obj"
echo '0 .01 .01 .019 1 0 0 0' >"$T/press.tum"
printf '%s\n' 'tissue E=3000' 'upper E=6000' >"$T/materials"
echo 'upper thickness=3mm material=upper' >"$T/layers"
: >"$T/in"
voxelise -q --unit mm -s 10 --allow-open "$T/cube.obj" >"$T/tiny" 2>"$T/said"

# ---- It sees what it is there for, and no tool takes loops that it does not know.
printf '%s\n' '#include <stdio.h>' '#include <stdlib.h>' 'int main(int argc, char **argv) {' '    int *lost = malloc(64);' '    (void)argv;' \
    '    if (argc > 1 && lost[3] > 0) puts("more");' '    lost = NULL;' '    return lost != NULL;' '}' >"$T/bad.c"
if "${CC:-cc}" -O0 -o "$T/bad" "$T/bad.c" 2>"$T/said"; then
    # shellcheck disable=SC2086 # words
    fails 99 "a block that is lost is seen" 'definitely lost' $checked "$T/bad"
    # shellcheck disable=SC2086
    fails 99 "and a number that nobody set" 'uninitialised value' $checked "$T/bad" read
else
    skip 2 "no compiler"
fi
# shellcheck disable=SC2086
fails 1 "AVX-512 is hidden" "'AVX-512' is not available here" env SINEW_VECTORS=AVX-512 $checked "$SINEW_BIN/tled-run" -d cpu -n 1 <"$T/tiny"

# ---- From a surface to pictures and files.
clean 0 voxelise voxelise -q --unit mm -s 5 "$T/box.obj"
clean 0 voxelise-layers voxelise -q --unit mm -s 5 --fraction 3 --materials "$T/materials" --layers "$T/layers" "$T/box.obj"
clean 0 voxelise-check voxelise --check --unit mm -s 5 "$T/box.obj"
cp "$T/voxelise" "$T/in"
clean 0 attach attach -q --fibre field --report
cp "$T/attach" "$T/in"
clean 0 bind bind -q
cp "$T/bind" "$T/in"
for precision in double single; do
    clean 0 "tled-run-$precision" tled-run -q -d cpu --precision "$precision" -t .011 -c muscle_A=.4 --ramp 0 --every 5e-3 --log "$T/log"
done
clean 0 tled-run-probe tled-run -q -d cpu -t 5e-3 --probe "convex:$T/cube.obj" --unit mm --poses "$T/press.tum" --ramp 0
clean 0 tled-run-rest tled-run -q -d cpu --rest .01 -g 0,0,-9.81 --checkpoint "$T/state"
cp "$T/tled-run-double" "$T/in"
clean 0 sinew-deform sinew-deform -q "$T/box.obj"
clean 0 sinew-info sinew-info --json
clean 1 sinew-diff sinew-diff "$T/tled-run-double" "$T/tled-run-single"
clean 0 sinew-distance sinew-distance -q --unit mm --both --points "$T/points" --region "all=$T/box.obj" "$T/box.obj" "$T/cube.obj"
printf 'at surface:0,0,0\npress 1 .1\nmove vertex:1 into x columns y .1\n' >"$T/in"
clean 0 sinew-poses sinew-poses -q --unit mm --surface "$T/box.obj"
printf 'a 0 0 0\nb 40 0 0\nc 0 30 0\nd 0 0 20\n' >"$T/picked"
clean 0 sinew-register sinew-register -q --unit mm --format tfm --residuals "$T/left" "$T/picked" "$T/picked"
cp "$T/tled-run-double" "$T/in"
clean 0 sinew-igtl-out sinew-igtl-out -q --listen 0 --pass
for format in vtu inp msh obj 'model --text'; do
    # shellcheck disable=SC2086 # words
    clean 0 "sinew-export-${format%% *}" sinew-export -f $format
done
clean 0 sinew-render sinew-render --size 200x140 --sheet rest,voxels,deformed --colour strain
cp "$T/tled-run-probe" "$T/in"
clean 0 sinew-render-probe sinew-render --size 120x80 --show voxels,rigid,probe --clear probe
for format in inp msh vtu; do
    cp "$T/sinew-export-$format" "$T/in"
    clean 0 "sinew-import-$format" sinew-import -q --unit m -
done

# ---- Tetrahedra under a probe.
cp "$T/bind" "$T/in"
clean 0 msds-mesh msds-mesh -q
cp "$T/msds-mesh" "$T/in"
for method in msds fem 'fem --exact' 'fem --exact --warp'; do
    # shellcheck disable=SC2086 # words
    clean 0 "msds-run-$(echo "$method" | tr -d ' ')" msds-run -q -d cpu --method $method --probe linear:1cm,5mm --poses "$T/press.tum"
done
clean 0 msds-run-skin msds-run -q -d cpu --skin "$T/cube.obj" --unit mm --probe sphere:1cm --poses "$T/press.tum"

# ---- Volumes.
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: LPS' 'sizes: 8 8 8' 'space directions: (3,0,0) (0,3,0) (0,0,3)' \
        'space origin: (0,0,0)' 'encoding: ascii' ''
    awk 'BEGIN { for (i = 0; i < 512; i++) print (i * 7) % 250 }'
} >"$T/volume.nrrd"
cp "$T/volume.nrrd" "$T/in"
clean 0 us-segment us-segment -q -n a --low 100 --smooth 2mm --fill
clean 0 us-surface us-surface -q -i 100 --smooth 2mm --taubin 2
cp "$T/us-segment" "$T/in"
clean 0 us-surface-labels us-surface -q -l all
clean 0 us-import us-import -q "$T/volume.nrrd"
clean 0 us-import-dicom us-import -q tests/fuzz/seeds/dicom/deflated
cp "$T/msds-run-msds" "$T/in"
clean 0 us-slice us-slice -q --size 60x50 --labels "$T/us-segment" "$T/volume.nrrd"

# ---- Poses of a program that sends them.
: >"$T/in"
cat >"$T/sends" <<'END'
import socket, struct, sys
listening = socket.create_server(('127.0.0.1', 0))
print(listening.getsockname()[1], flush=True)
for _ in range(2):
    peer = listening.accept()[0]
    peer.sendall(struct.pack('>H12s20sQQQ', 1, b'STRING', b'Log', 0, 4, 0) + struct.pack('>HH', 3, 0))  # its checksum is not 0
    while peer.recv(1000):
        pass
    peer.close()
END
python3 "$T/sends" >"$T/port" &
while [ ! -s "$T/port" ]; do sleep .05; done
clean 0 sinew-igtl-in sinew-igtl-in -q --list 2 "127.0.0.1:$(cat "$T/port")"
wait

# ---- What is refused is let go of too.
: >"$T/in"
clean 1 nothing attach
head -c 3000 "$T/bind" >"$T/in"
for tool in attach bind tled-run sinew-info sinew-render; do
    clean 1 "cut-$tool" "$tool"
done
cp "$T/bind" "$T/in"
clean 2 no-muscle tled-run -d cpu -c none=1
head -c 300 "$T/volume.nrrd" >"$T/cut.nrrd"
clean 1 cut-us-surface us-surface -i 1 "$T/cut.nrrd"
head -c 250 tests/fuzz/seeds/dicom/deflated >"$T/cut.dcm"
clean 1 cut-us-import us-import "$T/cut.dcm"
sed '$d' "$T/box.obj" >"$T/open.obj"
clean 1 open voxelise --unit mm -s 5 "$T/open.obj"
done_testing
