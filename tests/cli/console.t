#!/bin/sh
# sinew console: who may ask for what, the conversation with a page, the tools that it runs and how they end. The page itself is tried in
# tests/browser.
. "$(dirname "$0")/lib.sh"

have python3 || skip_all "no python3"
[ -e /usr/share/javascript/three/build/three.module.js ] || skip_all "no three.js"
case ${SINEW_SANITIZED:-} in ?*) skip_all "the tools do not keep up with the clock here" ;; esac

mkdir "$T/page" "$T/empty" "$T/none" "$T/many" "$T/many/inner"
printf '<!doctype html><title>Sinew</title>\n' >"$T/page/index.html"
# shellcheck disable=SC2317 # called by name
console() {
    timeout 60 sinew-console --page "$T/page" "$@"
}

# ---- What is refused at once, in a line each.
fails 2 "nothing to open" "missing operand; expected case" console
fails 1 "what is not there" "nothing: cannot open: No such file" console "$T/nothing"
fails 1 "a folder without a case" "empty: there is no case; expected a model .* and its volume" console "$T/empty"
: >"$T/volume.nrrd"
fails 1 "a volume alone" "a volume without a model; expected the model's name before it" console "$T/volume.nrrd"
for at in 0 host.example:80 1.2.3.4.5:80 127.0.0.1:99999 '[::1:80'; do
    [ "$at" = 0 ] || fails 2 "--listen $at" "expected \[ADDRESS:\]PORT" console --listen "$at" tests/cli/small.sinew
done
fails 1 "an address of another machine" "cannot listen there: Cannot assign" console --listen 192.0.2.1:0 tests/cli/small.sinew
fails 1 "a folder that has no page" "there is no index.html" sinew-console --page "$T/none" tests/cli/small.sinew
fails 1 "a folder that has no three.js" "there is no build/three.module.js; expected three.js \(the package libjs-three\)" \
    console --three "$T/none" tests/cli/small.sinew
: >"$T/file"
fails 1 "records in a file" "cannot (make|write)" console --record "$T/file/x" tests/cli/small.sinew
while read -r status option message; do
    # shellcheck disable=SC2086 # words
    fails "$status" "$option" "$message" env SPNAV_SOCKET="$T/nothing" timeout 60 sinew-console --page "$T/page" ${option%%=*} "${option#*=}" tests/cli/small.sinew
done <<'END'
2 --poses=igtl:localhost expected igtl:HOST:PORT
2 --poses=igtl:localhost:0 expected igtl:HOST:PORT
2 --poses=igtl:localhost:18944, expected igtl:HOST:PORT
2 --poses=spnav:start=a.tum expected no start=
2 --poses=spnav:x expected mouse or joystick
1 --poses=spnav: cannot connect: No such file.*expected spacenavd
1 --poses=tests/cli/small.sinew is a regular file; expected a FIFO
2 --igtl-out=host: expected \[ADDRESS:\]PORT
2 --igtl-out=:18944 expected \[ADDRESS:\]PORT
END
fails 1 "what is no model" "no model on" console "$T/file"

# tell FILE: lines "ok NAME" and "not ok NAME: ..." as tests.
tell() {
    while read -r verdict name; do
        case $verdict in
        ok) ok "$name" ;;
        *) not_ok "${name#ok }" ;;
        esac
    done <"$1"
}

# ---- Two cases from equations.
(
    cd samples || exit 1
    make -s OUT="$T" NODES=10x8x8 "$T/case/mesh.sinew" >"$T/made" 2>&1 || exit 1
    awk -f shape.awk -f muscle.awk >"$T/muscle.obj"
    voxelise -q --unit mm -s 4 --volumes muscle.volumes --materials muscle.materials "$T/muscle.obj" |
        attach -q --fibre axis | sinew bind >"$T/muscle.sinew"
) || diag_file "$T/made"
cp "$T/case/mesh.sinew" "$T/alone.sinew"
fails 1 "a case without a volume" "alone: the case has no volume; expected .*alone.sinew and a .nrrd, .mha or .mhd beside it" console "$T/alone.sinew"
mkdir "$T/bin"
cp "$SINEW_BIN/sinew-console" "$T/bin"
fails 1 "a tool that is not there" "tled-run: there is no such tool beside sinew-console, nor on PATH" \
    env PATH=/usr/bin:/bin timeout 60 "$T/bin/sinew-console" --page "$T/page" "$T/muscle.sinew"

# ---- A face with a body around it: a cube of 20 mm that the jaw holds at its top, and teeth on the jaw.
mkdir "$T/face"
sh tests/cli/jaw_case.sh "$T/face" || not_ok "a face with a jaw"
sed 's/in=jaw/in=jam/' "$T/face/body.txt" >"$T/wrong.txt"
mkdir "$T/wrong"
cp "$T/face/mesh.sinew" "$T/face/teeth.obj" "$T/wrong"
mv "$T/wrong.txt" "$T/wrong/body.txt"
fails 1 "teeth on a body that is not there" "body.txt:2: unknown body 'jam'; did you mean 'jaw'" console "$T/wrong"

# ---- The conversation.
check "cases from equations" env NODES=12x5x9 SPACING=8 samples/console "$T/cases"
mkdir "$T/muscle"
cp "$T/muscle.sinew" "$T/muscle/mesh.sinew"
echo 'half: *=.5 # of all' >"$T/muscle/expressions.txt"
timeout 400 python3 tests/cli/console_talk.py "$T/muscle" "$T/case" "$SINEW_BIN" "$T" "$T/page" "$T/cases" "$T/face" >"$T/talk" 2>"$T/talk.err"
is "$?" 0 "it is talked to, to the end"
[ ! -s "$T/talk.err" ] || diag_file "$T/talk.err"
tell "$T/talk"

# ---- What moves the probe beside a page, with stand-ins for igtl-in and igtl-out.
mkdir "$T/steered" "$T/steering"
cp "$SINEW_BIN/sinew-console" "$T/steered"
# shellcheck disable=SC2016 # for the stand-ins
{
    printf '%s\n' '#!/bin/sh' 'echo "$*" >"$STAND_IN/in.args"' 'echo "sinew-igtl-in: connected" >&2' 'exec cat "$STAND_IN/in.fifo"' >"$T/steered/sinew-igtl-in"
    printf '%s\n' '#!/bin/sh' 'echo "$*" >"$STAND_IN/out.args"' 'exec cat "$4" >"$STAND_IN/out.lines"' >"$T/steered/sinew-igtl-out"
    printf '%s\n' '#!/bin/sh' 'echo "sinew-igtl-in: $1: no such host" >&2' 'exit 1' >"$T/steered/sinew-igtl-in.fails"
}
chmod +x "$T/steered"/sinew-igtl-*
timeout 300 python3 tests/cli/console_steer.py "$T/case" "$T/steered" "$T/steering" "$T/page" >"$T/talk" 2>"$T/talk.err"
is "$?" 0 "the probe is steered, to the end"
[ ! -s "$T/talk.err" ] || diag_file "$T/talk.err"
tell "$T/talk"

# ---- What is recorded gives the same frames on a command line: a face, tissue, and a patient with a body.
timeout 300 python3 tests/cli/console_replay.py "$SINEW_BIN" "$T/replays" "$T/page" "$T/muscle.sinew" "$T/case" "$T/cases/patient" \
    >"$T/talk" 2>"$T/talk.err"
is "$?" 0 "records are replayed, to the end"
[ ! -s "$T/talk.err" ] || diag_file "$T/talk.err"
tell "$T/talk"
done_testing
