#!/bin/sh
# A stack of 64 KiB (ulimit -s): every tool works, and writes the same bytes; signals end it as ever; where there is no memory for another
# stack, one line says so.
. "$(dirname "$0")/lib.sh"

[ "${SINEW_SANITIZED:-}" ] && skip_all "sanitizers want more stack before main"
# shellcheck disable=SC3045 # skipped where a shell has none
(ulimit -s 64) 2>/dev/null || skip_all "no ulimit -s"

# small COMMAND...: with little stack.
small() {
    # shellcheck disable=SC3045
    (ulimit -s 64 && exec "$@")
}

# same NAME COMMAND...: the same bytes, from $T/in; the first run's are kept in $T/NAME.
same() {
    name=$1
    shift
    "$@" <"$T/in" >"$T/$name" 2>"$T/stderr" || diag_file "$T/stderr"
    small "$@" <"$T/in" >"$T/small" 2>"$T/stderr"
    status=$?
    cmp -s "$T/$name" "$T/small"
    is "$status $?" "0 0" "$name"
    [ "$status" -eq 0 ] || diag_file "$T/stderr"
}

SINEW_THREADS=3
export SINEW_THREADS
: >"$T/in"
{
    awk -v x=20 -v y=20 -v z=20 -v held=low -f tests/cli/box.awk
    awk -v x=10 -v y=10 -v z=10 -f tests/cli/box.awk |
        awk '/^g/ { print "g muscle_A"; next } /^f/ { print "f", $2 + 8, $3 + 8, $4 + 8, $5 + 8; next } { print }'
} >"$T/box.obj"
echo '0 .01 .01 .019 1 0 0 0' >"$T/press.tum"
same voxelise voxelise -q --unit mm -s 2.5 "$T/box.obj"
small voxelise --check --unit mm -s 2.5 "$T/box.obj" >"$T/small" 2>&1
is $? 0 "voxelise --check, by Embree"
cp "$T/voxelise" "$T/in"
same attach attach -q --fibre field
cp "$T/attach" "$T/in"
same bind bind -q
cp "$T/bind" "$T/in"
same tled-run tled-run -q -d cpu -n 20 -c muscle_A=.4 --every 1e-3
same msds-mesh msds-mesh -q
cp "$T/msds-mesh" "$T/in"
for method in msds 'fem --exact' tissue; do
    # shellcheck disable=SC2086 # words
    same msds-run msds-run -q -d cpu --method $method --probe sphere:1cm --poses "$T/press.tum"
done
cp "$T/tled-run" "$T/in"
same deform sinew deform -q "$T/box.obj"
same info sinew info
same materials sinew materials
same diff sinew diff "$T/tled-run" "$T/tled-run"
same distance sinew distance --unit mm --both "$T/box.obj" "$T/box.obj"
printf 'at vertex:1\npress 1mm .1\n' >"$T/plan"
same poses sinew poses --surface "$T/box.obj" --unit mm "$T/plan"
printf '0 0 0\n40 0 0\n0 30 0\n0 0 20\n' >"$T/points"
same register sinew register -q --unit mm "$T/points" "$T/points"
same igtl-out sinew igtl-out --listen 0 --pass
same export sinew export -f inp
small sinew igtl-in --list .01 --listen 0 >"$T/small" 2>&1
is "$? $(grep -c 'nothing has connected' "$T/small")" "1 1" "igtl-in"
same render sinew render --size 180x120 --sheet rest,voxels,deformed
same render-body sinew render --size 180x120 --show voxels,muscles,rigid --clear voxels --colour strain
cp "$T/export" "$T/in"
same import sinew import --unit m -

# ---- Volumes: NRRD, and DICOM by its own library.
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: LPS' 'sizes: 8 8 8' 'space directions: (3,0,0) (0,3,0) (0,0,3)' 'space origin: (0,0,0)' \
        'encoding: ascii' ''
    awk 'BEGIN { for (i = 0; i < 512; i++) print (i * 7) % 250 }'
} >"$T/in"
cp "$T/in" "$T/volume.nrrd"
same us-segment us-segment -q -n a --low 100
same us-surface us-surface -q -i 100
same us-import us-import -q --raw "$T/volume.nrrd"
cp "$T/msds-run" "$T/in"
same us-slice us-slice -q --size 60x50 "$T/volume.nrrd"
us-import -q tests/fuzz/seeds/dicom/deflated >"$T/large" 2>"$T/said"
status=$?
small us-import -q tests/fuzz/seeds/dicom/deflated >"$T/small" 2>"$T/said.small"
is "$? $(cksum <"$T/small") $(cat "$T/said.small")" "$status $(cksum <"$T/large") $(cat "$T/said")" "DICOM: status $status"

# ---- Ends.
same sinew sinew --version
fails 2 "wrong usage" 'expected' small sinew render --up w "$T/bind"
fails 1 "bad input" 'no model on stdin' small attach
# The least that sinew(7) names. (With less the dynamic linker itself may end by SIGSEGV, as it does any program.)
least() {
    # shellcheck disable=SC3045
    (ulimit -s 32 && exec "$@") >"$T/small" 2>&1 || echo "$? $*"
}
is "$(for tool in "$SINEW_BIN"/*; do least "$tool" --version; done
    for _ in 1 2 3 4 5 6; do least sinew render --size 64x48 -o "$T/least.png" "$T/bind"; done)" "" "32 KiB"
# A signal finds who works, and what was begun is removed.
sh -c 'ulimit -s 64 && exec "$@"' sh tled-run -q -d cpu -t 100 -o "$T/killed.sinew" <"$T/bind" 2>/dev/null &
tool=$!
sleep .3
kill -TERM "$tool"
wait "$tool" 2>/dev/null
is "$? $(find "$T" -name '.sinew*' -o -name 'killed*' | wc -l | tr -d ' ')" "143 0" "SIGTERM ends it and leaves nothing"
(small tled-run -q -d cpu -t 100 --every 1e-4 <"$T/bind" 2>/dev/null; echo $? >"$T/status") | head -c 10 >/dev/null
is "$(cat "$T/status")" 141 "a reader that goes ends it by SIGPIPE"
# shellcheck disable=SC3045
(ulimit -s 64 && ulimit -v 9000 && exec sinew-info "$T/bind") >"$T/small" 2>"$T/stderr"
is "$? $(wc -l <"$T/stderr" | tr -d ' ') $(wc -c <"$T/small" | tr -d ' ')" "1 1 0" "no memory for a stack: one line ($(cat "$T/stderr"))"
is "$(grep -c '^sinew-info: 64 KiB of stack (ulimit -s) are too few, and a thread with more cannot be started: ' "$T/stderr")" 1 "which says what is wrong"
done_testing
