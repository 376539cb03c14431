#!/bin/sh
# tled-run --checkpoint and --restart: a run that is killed (kill -9) at any moment, and restarted, writes the same bytes as one that
# was not. A run whose output nobody reads waits: so it is killed at known places of its output, while it is at work. REPEATS says
# how often each kind is, at least once (SINEW_LONG: 40 times; else the first kind twice, so that a run is killed once more, and some kinds not at all).
. "$(dirname "$0")/lib.sh"

awk -v nx=12 -v ny=6 -v nz=5 -v h=0.0025 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/muscle.sinew"
awk -v nx=8 -v ny=6 -v nz=5 -v h=0.005 -v held=low -f tests/cli/block.awk >"$T/block.sinew"
mkdir "$T/c" "$T/d"
fast=$T
[ -w /dev/shm ] && fast=$(mktemp -d /dev/shm/sinew-XXXXXX) && trap 'rm -rf "$T" "$fast"' EXIT
c=$fast/state # nothing waits for a disk there
tries=${REPEATS:-${SINEW_LONG:+40}}
tries=${tries:-2}
[ "$tries" -ge 1 ] || tries=1
many=${SINEW_LONG:+1}

run() { # ARG...: of the model that stands in $model
    tled-run -q "$@" <"$model"
}

# killed_at BYTES ARG...: kills the run once that much of its output was read. What was saved is there.
killed_at() {
    bytes=$1
    shift
    rm -f "$T/pipe"
    mkfifo "$T/pipe"
    tled-run -q "$@" <"$model" >"$T/pipe" 2>"$T/err" &
    pid=$!
    exec 3<"$T/pipe"
    head -c "$bytes" <&3 >/dev/null
    kill -9 "$pid" 2>/dev/null
    wait "$pid" 2>/dev/null
    exec 3<&-
}

# same NAME ARG...: at $tries places; every other run is killed once more after it went on.
same() {
    name=$1
    shift
    check "$name" run "$@" -o "$T/want"
    run "$@" --checkpoint "$c" --checkpoint-every 0.02 >"$T/got"
    check "$name: checkpoints change nothing" cmp "$T/want" "$T/got"
    is "$(find "$fast" -name 'state*')" "" "$name: and are removed at the end"
    size=$(wc -c <"$T/want")
    restarts=0 good=0 before=0
    while [ "$restarts" -lt "$tries" ]; do
        restarts=$((restarts + 1))
        rm -f "$c" "$c.1" "$c.frames"
        killed_at $((size * restarts / (tries + 1))) "$@" --checkpoint "$c" --checkpoint-every 0.02
        if [ ! -e "$c" ]; then
            before=$((before + 1)) # the run itself began: frames that came were still being passed on
            continue
        fi
        if [ $((restarts % 2)) -eq 0 ]; then
            killed_at $((size * (restarts + 1) / (tries + 2))) "$@" --restart "$c" --checkpoint-every 0.01
        fi
        if run "$@" --restart "$c" -o "$T/got" 2>"$T/err" && cmp -s "$T/want" "$T/got" && [ ! -e "$c" ]; then
            good=$((good + 1))
        else
            diag "$(cat "$T/err")"
        fi
        rm -f "$T/got"
    done
    [ "$before" -lt $((tries / 4 + 1)) ] || good=none
    is "$good" $((restarts - before)) "$name: $((restarts - before)) runs that were killed go on to the same bytes"
}

cat >"$T/script" <<'SCRIPT'
0    gravity 0,0,0
0.02 gravity 0,1,-9.81
0    force 0.02,0.015,0.025 0.01 0,0,0
0.03 force 0.02,0.015,0.025 0.01 .02,.01,0
0.2  force 0.02,0.015,0.025 0.01 0,0,0
0    displace 0.035,-1,-1,1,0.001,1 -,0,0
0.04 displace 0.035,-1,-1,1,0.001,1 -,0.002,-0.003
SCRIPT
cat >"$T/poses" <<'POSES'
0 0.02 0.015 0.031 1 0 0 0
0.2 0.022 0.015 0.02 1 0 0 0
0.3 0.022 0.015 0.024 1 0 0 0
POSES

model=$T/muscle.sinew
same "contraction" -d cpu -c all=0.8 -t 0.4 --every 0.002
[ "$many" ] || tries=1
same "single" -d cpu --precision single -c all=0.8 -t 0.4 --every 0.002
same "to rest" -d cpu -c all=0.5 -g 0,0,-9.81 --rest 1e-6 --every 0.002
same "to a time between steps" -d cpu -c all=0.8 -t 0.2001234 --every 0.002
same "as text" -d cpu -c all=0.5 -t 0.2 --every 0.002 --text
same "gzipped" -d cpu -c all=0.5 -t 0.4 --every 0.002 -z
same "steps that are given, threads" -d cpu -c all=0.5 -t 0.4 --dt 0.0001 --every 0.002 --threads 3
if [ "$many" ]; then
    run -d cpu -c all=0.5 -t 0.1 --every 0.01 >"$T/first.sinew"
    model=$T/first.sinew
    same "going on from frames" -d cpu -c all=0.5 -t 0.3 --every 0.002
fi
model=$T/block.sinew
same "a script" -d cpu --script "$T/script" -t 0.4 --every 0.002
[ ! "$many" ] || same "a probe" -d cpu --probe sphere:1cm --poses "$T/poses" -t 0.4 --every 0.002
same "a probe, to rest" -d cpu --probe linear:1cm,5mm --poses "$T/poses" --rest 1e-5 --every 0.002

# The same on a card.
if run -d cuda -n 1 >/dev/null 2>"$T/err"; then
    model=$T/muscle.sinew
    for precision in double single; do
        same "CUDA, $precision" -d cuda --precision "$precision" -c all=0.8 -t 0.4 --every 0.002
        same "CUDA, $precision, to rest" -d cuda --precision "$precision" -c all=0.5 -g 0,0,-9.81 --rest 1e-4 --every 0.002
    done
    model=$T/block.sinew
    same "CUDA, a script" -d cuda --script "$T/script" -t 0.4 --every 0.002
    # More than what stays on a card: it marches.
    awk -v nx=60 -v ny=60 -v nz=54 -v h=0.0025 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/large.sinew"
    memory=$fast
    model=$T/large.sinew fast=$T c=$T/state # more than /dev/shm may have
    for precision in double single; do
        same "CUDA, $precision, large" -d cuda --precision "$precision" -c all=0.8 -t 0.6 --every 0.02
    done
    fast=$memory c=$memory/state
    # A card that fails in the middle of a run.
    model=$T/muscle.sinew
    rm -f "$T/got"
    run -d cuda -c all=0.8 -t 20 --every 0.1 >"$T/want"
    card=$(cd "${BUILD:-build}" && pwd)/tests/faults/wreck_card.so
    fails 1 "a card that fails" 'tled-run: CUDA: .* failed at step [0-9]+: .*(illegal|misaligned|unspecified)' env LD_PRELOAD="$card" SINEW_FAULT_WHEN="$c.1" \
        tled-run -d cuda -c all=0.8 -t 20 --every 0.1 --checkpoint "$c" --checkpoint-every 0.5 -o "$T/got" <"$model"
    check "no output" [ ! -e "$T/got" ]
    check "and the run goes on elsewhere" run -d cuda -c all=0.8 -t 20 --every 0.1 --restart "$c" -o "$T/got"
    check "to the same bytes" cmp "$T/want" "$T/got"
    rm "$T/got"
else
    skip 32 "on a card: $(sed 's/.*: //' "$T/err" | head -n 1)"
fi

# Without frames, by the clock: -o has nothing until all is there.
model=$T/muscle.sinew
run -d cpu -c all=0.8 -t 2 >"$T/want"
for _ in 1 2 3 4 5 6 7 8 9 10; do # on a busy machine a run may be through before it is killed
    rm -f "$T/got" "$c" "$c.1"
    tled-run -q -d cpu -c all=0.8 -t 2 --checkpoint "$c" --checkpoint-every 0.01 -o "$T/got" <"$model" &
    pid=$!
    until [ -e "$c.1" ] || ! kill -0 "$pid" 2>/dev/null; do
        sleep 0.01
    done
    kill -9 "$pid" 2>/dev/null
    wait "$pid" 2>/dev/null
    [ $? -ne 137 ] || break
done
check "no output of a run that was killed" [ ! -e "$T/got" ]
sinew info "$c" >"$T/info"
check "a checkpoint is a model" grep -q 'checkpoint.options' "$T/info"
check "the run goes on" run -d cpu -c all=0.8 -t 2 --restart "$c" -o "$T/got"
check "to the same bytes" cmp "$T/want" "$T/got"

# The log goes on too: the same rows, but for the clock's columns.
place='--tsv node.displacement.at.25mm,5mm,5mm'
for every in '' "--log-every 0.003 $place"; do
    rm -f "$T/log"
    # shellcheck disable=SC2086 # two words, or none
    run -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" $every >"$T/want"
    cut -f 1-18,21- "$T/log" >"$T/rows"
    # shellcheck disable=SC2086
    killed_at 500000 -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" $every --checkpoint "$c" --checkpoint-every 0.02
    check "the log of a run that was killed, ${every:-a row a look}" test "$(wc -l <"$T/log")" -lt "$(wc -l <"$T/rows")"
    # shellcheck disable=SC2086
    check "it goes on" run -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" $every --restart "$c" -o "$T/got"
    cut -f 1-18,21- "$T/log" >"$T/got_rows"
    check "to the same rows" cmp "$T/rows" "$T/got_rows"
    check "and bytes" cmp "$T/want" "$T/got"
done
killed_at 500000 -d cpu -c all=0.8 -t 0.4 --every 0.002 --checkpoint "$c" --checkpoint-every 0.02
rm -f "$T/log"
check "a run without a log goes on with one" run -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" --restart "$c" -o "$T/got"
is "$(awk 'NR == 1 { print $1, $2 } END { print $1 }' "$T/log" | tr '\n' ' ')" "time/s step 0.4 " "whose heading and last row are there"
killed_at 500000 -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" --checkpoint "$c" --checkpoint-every 0.02
head -c 500 "$T/rows" >"$T/log"
fails 1 "another log" 'log: has 500 bytes; expected the first [0-9]* of this run' \
    run -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" --restart "$c"
is "$(wc -c <"$T/log" | tr -d ' ')" 500 "stays"
yes 'This is no log.' | head -n 10000 >"$T/log"
fails 1 "another file" 'log:1: is not the heading of this run' \
    run -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" --restart "$c"
is "$(wc -l <"$T/log" | tr -d ' ')" 10000 "stays too"
killed_at 500000 -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" --checkpoint "$c" --checkpoint-every 0.02
cp "$T/log" "$T/rows"
# shellcheck disable=SC2086 # two words
fails 1 "other columns" 'log:1: is not the heading of this run' \
    run -d cpu -c all=0.8 -t 0.4 --every 0.002 --log "$T/log" $place --restart "$c"
check "leave the log as it was" cmp "$T/rows" "$T/log"
check "without it, the run goes on" run -d cpu -c all=0.8 -t 0.4 --every 0.002 --restart "$c" -o "$T/got"
check "to the same bytes" cmp "$T/want" "$T/got"

# The loss of power: at each time that something is stored, what was written since and is not is gone.
power=$(cd "${BUILD:-build}" && pwd)/tests/faults/power.so

# lose_at PLACES NAMES ARG...: power is lost at each of the places, with each choice of names that stay as they are made, by bits in the
# order of their touching; and the run goes on.
lose_at() {
    places=$1 names=$2
    shift 2
    for at in $places; do
        for kept in $names; do
            rm -f "$c" "$c.1" "$c.frames" "$T/log" "$T/got"
            LD_PRELOAD=$power SINEW_FAULT_AT=$at SINEW_FAULT_KEPT=$kept run "$@" --checkpoint "$c" -o "$T/got" 2>/dev/null
            status=$?
            how=--restart
            [ -e "$c" ] || how=--checkpoint
            # It is gone only where it was not there yet, or is not wanted any more.
            [ -e "$c" ] || [ -e "$T/got" ] || [ "$at" -le 10 ] || status=gone
            lost=$((lost + 1))
            # Its name may be kept while its folder is being stored, and then it is whole.
            if [ "$status" -eq 137 ] && { [ ! -e "$T/got" ] || cmp -s "$T/want" "$T/got"; } && run "$@" "$how" "$c" -o "$T/got" &&
                cmp -s "$T/want" "$T/got" && cut -f 1-18,21- "$T/log" | cmp -s "$T/rows" -; then
                good=$((good + 1))
            else
                echo "power $at, names $kept: status $status, $how"
            fi
        done
    done
}

put() { # ARG...: to $T/got, by $output
    if [ "$output" = -o ]; then
        run "$@" -o "$T/got"
    else
        run "$@" >"$T/got"
    fi
}

if [ -n "$SINEW_SANITIZED" ]; then
    skip 8 "sanitizers come first in the list of libraries"
elif [ ! -e "$power" ]; then
    not_ok "$power is not there: make unit builds it"
else
    set -- -d cpu -c all=0.8 -t 0.2 --every 0.002 --log "$T/log"
    run "$@" >"$T/want"
    cut -f 1-18,21- "$T/log" >"$T/rows"
    LD_PRELOAD=$power SINEW_FAULT_COUNT=$T/count run "$@" --checkpoint "$c" --checkpoint-every 0.02 -o "$T/got"
    syncs=$(cat "$T/count")
    [ "${syncs:=0}" -gt 10 ] || not_ok "$syncs times that something is stored"
    set -- "$@" --checkpoint-every 0.02
    lost=0 good=0
    if [ "$tries" -lt 40 ]; then
        lose_at '1 2 3 5 7 10' '0 8' "$@"
        lose_at "$((syncs - 1)) $syncs" '0 255' "$@"
    else
        lose_at "$(awk -v n="$syncs" 'BEGIN { while (++i <= n) print i }')" '0 1 2 3 4 5 6 7 8 15' "$@"
    fi >"$T/err" 2>&1
    is "$good" "$lost" "a loss of power, $lost times, at one of the $syncs that something is stored: the same bytes and rows"
    [ "$good" -eq "$lost" ] || diag_file "$T/err"
    # Once the run has ended, and its checkpoint is gone.
    for output in -o '>'; do
        rm -f "$T/log" "$T/got"
        LD_PRELOAD=$power SINEW_FAULT_COUNT=$T/count put "$@" --checkpoint "$c"
        for kept in 0 15 255; do
            rm -f "$c" "$c.1" "$c.frames" "$T/log" "$T/got"
            LD_PRELOAD=$power SINEW_FAULT_AT=$(($(cat "$T/count") + 1)) SINEW_FAULT_KEPT=$kept put "$@" --checkpoint "$c" 2>"$T/err"
            status=$?
            cut -f 1-18,21- "$T/log" | cmp -s - "$T/rows"
            is "$status $? $(cmp "$T/want" "$T/got" 2>&1)" '137 0 ' "a loss of power when all is done, $output, names $kept: output and log are there"
        done
    done
    is "$(find "$T" "$fast" -name '*power-*')" "" "no name of before is left"
fi

# Damage, other runs, what is missing.
killed_at 500000 -d cpu -c all=0.8 -t 0.4 --every 0.002 --checkpoint "$c" --checkpoint-every 0.02
for file in state state.1 state.frames; do
    cp "$fast/$file" "$T/d/$file"
done
# shellcheck disable=SC2317 # reached through check and fails
back() {
    for file in state state.1 state.frames; do
        cp "$T/d/$file" "$fast/$file"
    done
}
# shellcheck disable=SC2317
again() { # ARG...: after which all is as before
    run -d cpu --every 0.002 --restart "$c" "$@" >"$T/got" 2>"$T/err2"
    status=$?
    cat "$T/err2" >&2
    back
    return "$status"
}
run -d cpu -c all=0.8 -t 0.4 --every 0.002 >"$T/want"
head -c 3000 "$T/d/state" >"$c"
check "a checkpoint that is cut" again -c all=0.8 -t 0.4
sed -i '/elements are folded/d' "$T/err2" # as they are in the whole run too
is "$(wc -l <"$T/err2" | tr -d ' ')" 1 "is told of in one line"
is "$(sed -E 's,/[^ ]*/,,g; s,[0-9.]+ s$,T s,' "$T/err2")" "tled-run: warning: state: the model is cut short; expected \`end\` (did the tool before this one stop early?); the run goes on from the checkpoint before it, state.1, at T s" "which says what is wrong and what was taken"
check "and the result is the same" cmp "$T/want" "$T/got"
rm "$c"
check "one that is missing is like it" again -c all=0.8 -t 0.4
check "and the result is the same" cmp "$T/want" "$T/got"
head -c 3000 "$T/d/state" >"$c"
head -c 3000 "$T/d/state" >"$c.1"
fails 1 "both damaged is an end" 'state: the model is cut short.*; and .*state.1: the model is cut short' again -c all=0.8 -t 0.4
check "both stay" cmp "$T/d/state" "$c"
fails 1 "other options are refused" "state: was saved by a run with other options, '-t 0.4'; expected '-t 0.5'" again -c all=0.8 -t 0.5
fails 1 "so are other frames" "--every differs" again -c all=0.8 -t 0.4 --every 0.003
fails 1 "so is another precision" "'\[cpu double,'; expected '\[cpu single,'" again -c all=0.8 -t 0.4 --precision single
killed_at 500000 -d cpu -c all=0.8 -m tissue.nu=0.49 -t 0.4 --every 0.002 --checkpoint "$T/old" --checkpoint-every 0.02
sinew export -f model --text "$T/old" | sed '/^crc/d; s/^\(meta checkpoint.options "\)[0-9.]* /\10.1.0 /' >"$T/cut" && mv "$T/cut" "$T/old"
fails 1 "so is one of another version" 'old: was written by version 0\.1\.0, and this is version [0-9.]*; expected a checkpoint of this version' \
    run -d cpu -c all=0.8 -m tissue.nu=0.49 -t 0.4 --every 0.002 --restart "$T/old"
rm -f "$T"/old*
killed_at 500000 -d cpu -c all=0.8 -t 0.4 --every 0.002 --checkpoint "$T/old" --checkpoint-every 0.02
fails 1 "another --hourglass is not" "was saved by a run with other options, '--hourglass physical'; expected '--hourglass isotropic:0.008'" \
    run -d cpu -c all=0.8 -t 0.4 --every 0.002 --hourglass 0.008 --restart "$T/old"
rm -f "$T"/old*
killed_at 500000 -d cpu -c all=0.8 -t 0.4 --every 0.002 --hourglass 0.0075 --checkpoint "$T/old" --checkpoint-every 0.02
check "the same by its other name goes on" run -d cpu -c all=0.8 -t 0.4 --every 0.002 --hourglass isotropic --restart "$T/old" -o "$T/got"
run -d cpu -c all=0.8 -t 0.4 --every 0.002 --hourglass isotropic:0.0075 >"$T/whole"
check "to the same bytes" cmp "$T/whole" "$T/got"
rm -f "$T"/old*
sed 's/30000/30001/' "$T/muscle.sinew" >"$T/other.sinew"
model=$T/other.sinew
fails 1 "so is another model" 'array material.peak differs' again -c all=0.8 -t 0.4
model=$T/muscle.sinew
fails 1 "a run that begins anew where one is" 'state: exists already; expected --restart' \
    run -d cpu -c all=0.8 -t 0.4 --checkpoint "$c"
check "loses nothing" cmp "$T/d/state" "$c"
fails 2 "another file to go on in" 'expected the same file' run -c all=0.8 -t 0.4 --checkpoint "$c" --restart "$T/none"
fails 2 "the output's name" "-o '.*out' would overwrite the file of --checkpoint" run -c all=0.8 -t 0.4 --checkpoint "$T/out" -o "$T/out"
ln -s "$T/out.frames" "$T/link"
fails 2 "by another name" "--checkpoint '.*out.1' would overwrite the file of -o" run -c all=0.8 -t 0.4 --checkpoint "$T/out" -o "$T/c/../out.1"
fails 2 "by a link" "--restart '.*out.frames' would overwrite the file of -o" run -c all=0.8 -t 0.4 --restart "$T/out" -o "$T/link"
fails 2 "the log's name" "--checkpoint '.*out.frames' would overwrite the file of --log" run -c all=0.8 -t 0.4 --checkpoint "$T/out" --log "$T/out.frames"
fails 2 "a log that is the output" "--log '.*' would overwrite the file of -o" run -c all=0.8 -t 0.4 --log "$T/out" -o "$T/out"
is "$(find "$T" -name 'out*')" "" "and nothing is made"
fails 2 "no file for --checkpoint-every" 'without --checkpoint' run -c all=0.8 -t 0.4 --checkpoint-every 1
fails 1 "nothing to restart from" 'none: cannot open: No such file' run -c all=0.8 -t 0.4 --restart "$T/none"
fails 1 "no folder to save in" 'state.frames: cannot create: No such file' run -c all=0.8 -t 0.4 --checkpoint "$T/none/state"

# A full disk ends the run, and what was saved stays.
rm -f "$c" "$c.1" "$c.frames"
if (ulimit -f 1000) 2>/dev/null; then
    # shellcheck disable=SC2016 # for the inner shell
    fails 1 "a disk that is full" 'cannot write: File too large' sh -c '
        ulimit -f 300; tled-run -d cpu -c all=0.8 -t 0.4 --every 0.002 --checkpoint "$1" --checkpoint-every 0.01 <"$2" >/dev/null' \
        - "$c" "$model"
    is "$(sed -n -E 's/.* (s is saved; .*)/\1/p' "$T/stderr")" "s is saved; --restart goes on from there" "it says what is saved"
    run -d cpu -c all=0.8 -t 0.4 --every 0.002 --restart "$c" >"$T/got"
    check "and the run goes on once there is room" cmp "$T/want" "$T/got"
else
    skip 3 "no limit on the size of files"
fi

# A folder that goes away while the run is at work: the end, and what was saved is what can be gone on from.
mkdir "$fast/here"
rm -f "$T/got"
run -d cpu -c all=0.8 -t 20 --checkpoint "$fast/here/state" --checkpoint-every 0.001 -o "$T/got" 2>"$T/err" &
pid=$!
until [ -e "$fast/here/state.1" ] || ! kill -0 "$pid" 2>/dev/null; do
    sleep 0.01
done
mv "$fast/here" "$fast/there"
wait "$pid"
# Which of its steps finds out depends on the moment.
is "$? $(grep -c "here/state[.a-z0-9]*: .*cannot .*: No such file" "$T/err")" "1 1" "a folder that goes away ends the run"
check "no output" [ ! -e "$T/got" ]
check "what was saved is whole" sinew info -o "$T/info" "$fast/there/state"

# As make has it: killed again and again, each time a little later, until it is through.
cat >"$T/Makefile" <<'MAKE'
smile.sinew: muscle.sinew
	tled-run -q -d cpu -c all=0.8 -t $(T) $(if $(wildcard state),--restart,--checkpoint) state --checkpoint-every 0.01 -o $@ <$<
MAKE
killed=0 seconds=${many:+4}
seconds=${seconds:-1.5}
while ! sh -c 'cd "$1" && timeout -s KILL "$2" make -s T="$3" smile.sinew' - "$T" "$(awk -v n="$killed" 'BEGIN { print 0.25 * 1.05 ^ n }')" "$seconds" >"$T/out" 2>&1 &&
    [ "$killed" -lt 100 ]; do
    killed=$((killed + 1))
done
run -d cpu -c all=0.8 -t "$seconds" >"$T/want"
check "make, killed $killed times" cmp "$T/want" "$T/smile.sinew"
done_testing
