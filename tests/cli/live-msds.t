#!/bin/sh
# msds-run --live: poses through a FIFO whose writers stall, come and go, and write what is no pose; settings while it runs; its ends; what it
# records, and the replay of that, byte for byte on a busy machine.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

msds-mesh -q --text --nodes 9x9x7 --size 8cm,8cm,6cm --young 10000 --poisson 0.4 --density 1000 >"$T/block.sinew"
mkfifo "$T/poses" "$T/lines"

# start OPTIONS...: in the background, its frames in $T/live.
start() {
    rm -f "$T/record"
    msds-run --live --text --record "$T/record" "$@" <"$T/block.sinew" >"$T/live" 2>"$T/said" &
    run=$!
}

# frames FILE: how many there are.
frames() {
    grep -c '^frame ' "$1"
}

# wait_for N: until there are so many frames.
wait_for() {
    tries=0
    while [ "$(frames "$T/live")" -lt "$1" ] && [ "$tries" -lt 600 ] && kill -0 "$run" 2>/dev/null; do
        sleep 0.02
        tries=$((tries + 1))
    done
}

# more N: until there are N frames more than now.
more() {
    wait_for $(($(frames "$T/live") + $1))
}

# wait_path METHOD: until the last frame was solved so.
wait_path() {
    tries=0
    while ! tail -n 1 "$T/record" | grep -q "path=$1\$" && [ "$tries" -lt 600 ] && kill -0 "$run" 2>/dev/null; do
        sleep 0.02
        tries=$((tries + 1))
    done
}

# end SIGNAL: its status.
end() {
    kill "-$1" "$run"
    wait "$run"
    status=$?
}

# same NAME OPTIONS...: the replay has the frames that came live, while others use the processors.
same() {
    name=$1
    shift
    busy=
    for _ in 1 2 3; do
        (exec nice sh -c 'while :; do :; done') &
        busy="$busy $!"
    done
    check "$name: replayed" msds-run --text --replay "$T/record" "$@" -o "$T/again" <"$T/block.sinew"
    # shellcheck disable=SC2086 # numbers
    kill $busy
    # shellcheck disable=SC2086
    wait $busy 2>/dev/null
    sed -n '/^frame /,$p' "$T/live" >"$T/one"
    sed -n '/^frame /,$p' "$T/again" >"$T/two"
    check "$name: the same bytes, of $(frames "$T/one") frames" cmp "$T/one" "$T/two"
}

pose() {
    printf '%s .04 .04 %s 1 0 0 0\n' "$1" "$2"
}

# Stalls, jumps, garbage, writers that go and come.
start --probe sphere:2cm --poses "$T/poses" --control "$T/lines"
exec 3>"$T/poses" 4>"$T/lines"
sleep 0.1
is "$(frames "$T/live")" 0 "before the first pose there is no frame"
pose 0 .06 >&3
wait_for 1
pose .1 .058 >&3
more 8
ok "frames go on when no pose comes: $(frames "$T/live")"
{
    pose .2 .057
    echo '.3 nan .04 .057 1 0 0 0'
    echo '.3 .04 .04 .057 0 0 0 0'
    pose .1 .05
    echo '.3 .04 .04'
    echo 'hello there'
    printf '\001\377\n'
} >&3
more 2
pose .3 .03 >&3
more 3
echo 'set gravity 0,0,-5' >&4
more 2
for line in 'set gravity much' 'set colour red' 'method wrap' 'pull 1 0,0,0 1 0,0,0 1' 'set' 'set dt' 'set iterations 0'; do
    echo "$line" >&4
done
for method in fem exact warp exact-warp tissue msds; do
    echo "method $method" >&4
    wait_path "$method"
    more 2
done
echo 'set probe linear:3cm,1cm' >&4
exec 3>&- 4>&-
more 3
exec 3>"$T/poses"
pose 0 .059 >&3
more 3
printf '.1 .04 .0' >&3
exec 3>&-
more 2
end INT
is "$status" 0 "it ends by SIGINT as at its input's end"
is "$(tail -n 1 "$T/live") $(tail -n 1 "$T/record")" "end end" "its output and its record are whole"
is "$(frames "$T/live")" "$(frames "$T/record")" "a line for each frame"
is "$(grep -c 'skipped, and others like it are' "$T/said")" "$(grep -c 'warning: .*\(poses\|lines\):[0-9]*: .*; the line is skipped' "$T/said")" \
    "what is wrong is told with its line"
is "$(sed -n 's/.*; \([0-9]* controls; [0-9]* lines skipped; writers went away: [0-9]*\)$/\1/p' "$T/said")" \
    "8 controls; 14 lines skipped; writers went away: 3" "and counted"
is "$(sed -n 's/^frame.*path=//p' "$T/record" | uniq | tr '\n' ' ')" "tissue fem exact warp exact-warp tissue msds " "each method was used"
is "$(awk '/^set probe/ { print $3 }' "$T/record" | tr '\n' ' ')" "sphere:2cm linear:3cm,1cm " "settings are recorded"
cp "$T/record" "$T/kept"
same "a session" --probe sphere:2cm
same "a session, without its options"
same "a session, with others" --probe sphere:1cm --method exact --dt .02 --gravity 1,2,3 --iterations 3

is "$(sinew info --get meta.probe.shape "$T/again") $(sinew info --get meta.probe.shape "$T/live")" "sphere:0.02m sphere:0.02m" \
    "the model of a replay has the probe that the run began with"

# A record that exists.
fails 1 "a record is not written over" 'kept.*--force' msds-run --live --record "$T/kept" --poses "$T/poses" <"$T/block.sinew"
check "and is as it was" cmp "$T/kept" "$T/record"

fails 1 "a record in a FIFO that nobody reads" 'poses: cannot write' msds-run --live --force --record "$T/poses" --poses "$T/poses" <"$T/block.sinew"

# Killed at any time, a record is whole to its last line, and its frames are those that came.
start --probe sphere:2cm --poses "$T/poses"
exec 3>"$T/poses"
pose 0 .057 >&3
wait_for 10
end KILL
exec 3>&-
is "$(tail -c 1 "$T/record" | od -An -c | tr -d ' ')" '\n' "killed: the record's last line is whole"
check "killed: replayed" msds-run --text --replay "$T/record" -o "$T/again" <"$T/block.sinew"
is "$(grep -c 'warning: .*ends without .end.: it was cut short' "$T/stderr") $(frames "$T/again")" "1 $(frames "$T/record")" "killed: it says so, with all frames"
bytes=$(sed -n '/^frame 8 /q;p' "$T/live" | sed -n '/^frame /,$p' | cksum)
is "$(sed -n '/^frame 8 /q;p' "$T/again" | sed -n '/^frame /,$p' | cksum)" "$bytes" "killed: the same bytes"
head -c $(($(wc -c <"$T/record") - 3)) "$T/record" >"$T/cut"
check "a record that is cut in a line" msds-run -q --text --replay "$T/cut" -o "$T/again" <"$T/block.sinew"
is "$(frames "$T/again")" $(($(frames "$T/record") - 1)) "is that of the lines before"

# Lines on standard input, behind the model, whose end is the run's; no poses: frames begin at once.
{ cat "$T/block.sinew" && echo 'set gravity 0,0,-5'; } |
    msds-run --live --text --force --record "$T/record" --control - --poses "$T/poses" >"$T/live" 2>"$T/said"
is "$? $(frames "$T/live")" "0 0" "standard input's end ends a run that a FIFO would not"

# until_line PATTERN FILE: until the file has such a line.
until_line() {
    tries=0
    while ! grep -q "$1" "$2" 2>/dev/null && [ "$tries" -lt 600 ]; do
        sleep 0.02
        tries=$((tries + 1))
    done
}
rm -f "$T/record"
(
    cat "$T/block.sinew"
    echo 'set gravity 0,0,-5'
    pose 0 .06
    until_line '^frame 5 ' "$T/record"
    echo 'set gravity 0,0,-1e300'
    until_line 'path=rest' "$T/record"
    echo 'set gravity 0,0,0'
    until_line '^set gravity 0,0,0' "$T/record"
    until_line "^frame $(($(frames "$T/record") + 3)) " "$T/record"
) | msds-run --live --method msds --text --record "$T/record" --control - >"$T/live" 2>"$T/said"
is "$?" 0 "without poses frames begin at once"
check "a pose without --poses is told" grep -q 'stdin:2: a pose among the controls, when frames have begun without one; expected --poses; the line is skipped' "$T/said"
is "$(sed -n 's/^frame.*path=//p' "$T/record" | uniq | tr '\n' ' ')" "msds rest msds " "tissue that diverges is put back to rest, and goes on"
is "$(grep -c 'warning: .*no longer finite.*put back to rest, and the run goes on' "$T/said") $(grep -c 'was put back to rest [0-9]* times' "$T/said")" "1 1" "which is told once, and counted"
same "rest"

# A disk that is full: the run goes on.
rm -f "$T/record" "$T/said"
: >"$T/live"
feed_until_full() {
    cat "$T/block.sinew"
    until_line 'its record ends' "$T/said"
    until_line "^frame $(($(frames "$T/live") + 5)) " "$T/live"
}
feed_until_full | (
    ulimit -f 2
    exec msds-run --live --text --record "$T/record" --control - 2>"$T/said"
) | cat >"$T/live" # so that the limit is not that of this file
check "a full disk is told" grep -q "warning: .*record: .*its record ends after frame" "$T/said"
check "and the run goes on" test "$(frames "$T/live")" -gt "$(frames "$T/record")"
is "$(tail -c 1 "$T/record" | od -An -c | tr -d ' ') $(tail -n 1 "$T/live")" '\n end' "to its end, and the record is whole up to there"

# A skin, a body, frames that came before.
awk 'BEGIN { for (j = 0; j < 9; j++) for (i = 0; i < 9; i++) print "v", i, j, 6
    for (j = 0; j < 8; j++) for (i = 0; i < 8; i++) print "f", 9 * j + i + 1, 9 * j + i + 2, 9 * j + i + 11, 9 * j + i + 10 }' >"$T/skin.obj"
echo 'volume move=1cm,0,0' >"$T/body"
pose 0 .058 >"$T/one.tum"
cp "$T/block.sinew" "$T/rest.sinew"
msds-run -q --text --skin "$T/skin.obj" --unit cm --probe sphere:2cm --poses "$T/one.tum" <"$T/rest.sinew" >"$T/block.sinew"
start --skin "$T/skin.obj" --unit cm --body "$T/body" --probe sphere:2cm --poses "$T/poses"
exec 3>"$T/poses"
pose 0 .056 >&3
wait_for 8
end TERM
exec 3>&-
is "$status" 0 "it ends by SIGTERM"
is "$(awk '/^array probe.pose/ { getline; print $1 }' "$T/live" | sort -u | tr '\n' ' ')" "0.029999999999999999 0.040000000000000001 " "poses in a body"
sed '1,/^frame 1 /{/^frame 1 /!d;}' "$T/live" >"$T/part"
mv "$T/part" "$T/live"
check "more frames: replayed" msds-run --text --replay "$T/record" --skin "$T/skin.obj" --unit cm -o "$T/again" <"$T/block.sinew"
sed '1,/^frame 1 /{/^frame 1 /!d;}' "$T/again" >"$T/two"
check "more frames, and the skin: the same bytes" cmp "$T/live" "$T/two"
fails 1 "a record of other frames" 'record was made with skin skin, but this run has none' msds-run -q --replay "$T/record" <"$T/block.sinew"
fails 1 "a record of another model" 'kept:5: the record was made with model 0x.*, but this run has 0x' msds-run -q --replay "$T/kept" <"$T/block.sinew"
cp "$T/rest.sinew" "$T/block.sinew"

# A body without --live.
pose 0 .056 >"$T/one.tum"
msds-run -q --text --body "$T/body" --probe sphere:2cm --poses "$T/one.tum" <"$T/block.sinew" >"$T/again"
is "$(awk '/^array probe.pose/ { getline; print $1 }' "$T/again")" 0.029999999999999999 "poses of a file in a body"

# A skin that the body places: where it is without a body, seen from the model; and its poses are the model's.
printf 'volume move=1cm,0,0 turn=0,0,0.70710678118654752,0.70710678118654752\nsurface skin.obj unit=cm in=volume\n' >"$T/body"
echo '0 -.03 .04 .058 0.70710678118654752 0.70710678118654752 0 0' >"$T/one.tum"
msds-run -q --text --skin "$T/skin.obj" --body "$T/body" --probe sphere:2cm --poses "$T/one.tum" <"$T/block.sinew" >"$T/placed"
pose 0 .058 >"$T/one.tum"
msds-run -q --text --skin "$T/skin.obj" --unit cm --probe sphere:2cm --poses "$T/one.tum" <"$T/block.sinew" >"$T/plain"
check "a skin lies where the body has it" sinew diff -q --abs 1e-6 "$T/plain" "$T/placed"
check "and is dented there" test "$(sinew info --get skin/vertex.displacement.max "$T/placed" | awk '{ print ($1 > 1e-4) }')" = 1

# Records that no run made.
bad() {
    sed "$2" "$T/kept" >"$T/bad"
    fails 1 "a record with $1" "$3" msds-run -q --replay "$T/bad" -o "$T/left" <"$T/block.sinew"
}
bad "another version" '1s/ 1 / 2 /' 'bad:1: version'
bad "another tool" '1s/msds-run/tled-run/' 'bad:1: is a record of tled-run; expected a record of msds-run'
bad "another device" '2s/cpu/abacus/' 'bad:2: the record was made with device abacus, but this run has cpu'
bad "a frame that is missing" '/^frame 2 /d' 'frame 3 at .* s; expected frame 2'
bad "a path that is none" '/^frame 2 /s/path=.*/path=magic/' 'expected steps=N, and path='
bad "no steps" '/^frame 2 /s/steps=[0-9]*//' 'expected steps=N, and path='
bad "a pose that is none" '/^frame 2 /s/pose=[^,]*/pose=nan/' 'expected pose=X,Y,Z'
bad "a setting that is none" 's/^set dt/set td/' "unknown setting 'td'; did you mean 'dt'"
bad "time that goes back" '/^frame 2 /s/^frame 2 [0-9.]*/frame 2 0/' 'frame 2 at 0 s; expected'
check "no output is left" test ! -e "$T/left"

# Options that do not go together.
no() {
    name=$1 pattern=$2
    shift 2
    fails 2 "$name" "$pattern" msds-run "$@" <"$T/block.sinew"
}
no "no poses" 'missing option --poses; expected --poses FILE' -q
no "live, and nothing that comes" 'live without --poses and --control' --live
no "a record of poses from a file" 'are for --live' --record "$T/new" --poses "$T/one.tum"
no "controls beside a file of poses" 'are for --live' --control "$T/lines" --poses "$T/one.tum"
no "force, and no record" 'force without --record' --live --force --poses "$T/poses"
no "a PLUS sequence live" 'transform with --live' --live --poses "$T/poses" --transform ProbeToReference
no "a comparison live" 'compare with --live' --live --poses "$T/poses" --compare
no "a replay with poses" 'replay with --live, --poses' --replay "$T/kept" --poses "$T/one.tum"
no "a record that is the output" 'would overwrite' --live --poses "$T/poses" --record "$T/new" -o "$T/new"
fails 1 "a regular file live" 'is a regular file; expected a FIFO' msds-run --live --poses "$T/one.tum" <"$T/block.sinew"
fails 1 "poses that are not there" 'nowhere: cannot open' msds-run --live --poses "$T/nowhere" <"$T/block.sinew"
fails 1 "no record" 'nowhere' msds-run --replay "$T/nowhere" <"$T/block.sinew"
fails 1 "a model for a record" 'is no record; expected' msds-run --replay "$T/rest.sinew" <"$T/block.sinew"

done_testing
