#!/bin/sh
# tled-run --text --live: lines that come through FIFOs and standard input, writers that come and go, what is wrong with them;
# records and their replays, to the same bytes; ends by signals, by a full disk, by tissue that breaks.
. "$(dirname "$0")/lib.sh"

awk -v nx=4 -v ny=4 -v nz=4 -v h=0.005 -v held=low -f tests/cli/block.awk >"$T/model"

replays() { # NAME [ARG...]: $T/record gives $T/out again, with the processor busy
    replay_name=$1
    shift
    (exec nice sh -c 'while :; do :; done') &
    busy=$!
    # shellcheck disable=SC2016 # for the inner shell
    check "$replay_name: replayed" sh -c 'model=$1 record=$2 out=$3; shift 3
        tled-run --text -q --replay "$record" "$@" <"$model" >"$out"' - "$T/model" "$T/record" "$T/again" "$@"
    kill "$busy"
    wait "$busy" 2>/dev/null
    sed -n '/^frame /,$p' "$T/out" >"$T/frames"
    sed -n '/^frame /,$p' "$T/again" >"$T/frames-again"
    check "$replay_name: the same bytes" cmp "$T/frames" "$T/frames-again"
}
frames() { # of the stream in FILE
    sinew info --get frames <"$1"
}
lines() { # PATTERN: how many lines of the record
    grep -c "$1" "$T/record"
}
live() { # [ARG...]: on the model; $T/out, $T/stderr
    rm -f "$T/record"
    tled-run --text --live --record "$T/record" "$@" <"$T/model" >"$T/out" 2>"$T/said"
}

# until_line PATTERN FILE: until the file has such a line; as long as the run goes on.
until_line() {
    tries=0
    while ! grep -q "$1" "$2" 2>/dev/null && [ "$tries" -lt 3000 ] && kill -0 "$run" 2>/dev/null; do
        sleep 0.02
        tries=$((tries + 1))
    done
}
# more N: until there are N frames more than now.
more() {
    until_line "^frame $(($(lines '^frame') + $1)) " "$T/record"
}

live -t 1.5
is $? 0 "a live run of a second and a half"
is "$(frames "$T/out")" 91 "60 frames a second, and the first"
is "$(lines '^frame')" 90 "as many in the record"

# Through a FIFO: stalls, what is wrong, a writer that leaves and one that comes.
mkfifo "$T/fifo"
rm -f "$T/record"
tled-run --text --live --record "$T/record" --control "$T/fifo" <"$T/model" >"$T/out" 2>"$T/said" &
run=$!
exec 3>"$T/fifo"
printf 'now gravity 0,0,-5\n' >&3
until_line '^now gravity 0,0,-5' "$T/record"
more 10
printf 'now gravity nan,0,0\nnow gravity 1,2\n\001\002\nnow fly 1\nnow\n0 gravity 0,0,1\nset dt 1\nnow contract m 1\n' >&3
printf 'now force 1,1,1 1mm 0,0,1\npull p 10mm,10mm,20mm 6mm 10mm,10mm,25mm x\nrelease nobody\n' >&3
printf 'now traction nothing 1,1,1\nnow displace none 1,1,1\nnow displace 0,0,0,1,1,1 -,-,-\n' >&3
exec 3>&-
# What each writer leaves, and with it that it went away, is taken before the next one comes.
while read -r last lines_; do
    more 10
    # shellcheck disable=SC2059 # a format
    printf "$lines_" >"$T/fifo"
    until_line "$last" "$T/record"
done <<'END'
^pull.*,26mm pull p 10mm,10mm,20mm 6mm 10mm,10mm,25mm 5\npull p 10mm,10mm,20mm 6mm 12mm,10mm,26mm 5\n
^now.pull.q pull p 10mm,10mm,20mm 4mm 12mm,10mm,26mm 5\nnow force 0,0,20mm 6mm .01,0,0\nnow pull q 0,0,20mm 6mm 0,1mm,2cm 2\n
^now.displace release p\nnow release q\nnow force 0,0,20mm 6mm 0,0,0\nnow displace 0,0,0,1,1,0 0,1mm,-\n
^now.pull.r now displace 0,0,0,1,1,0 0,2mm,-\nnow gravity 0,0,0\nnow pull r 0,0,20mm 6mm 0,1mm,2cm 2\n
END
more 20
kill -INT "$run"
wait "$run"
is $? 0 "controls through a FIFO, to SIGINT"
is "$(frames "$T/out")" "$(($(lines '^frame') + 1))" "each frame is in the record"
is "$(tail -n 1 "$T/record")" end "which is whole"
is "$(lines '^now\|^pull\|^release')" 13 "with the lines that were taken"
check "what is wrong is counted" grep -q ' 13 controls; 14 lines skipped; writers went away: 5' "$T/said"
check "and told" grep -q "fifo:[0-9]*: 'nan,0,0'; expected X,Y,Z in m/s2; the line is skipped" "$T/said"
check "with what was expected" grep -q "'0'; expected now VERB ..., pull ID ..., release ID, or a pose" "$T/said"
check "as in a script" grep -q "no node lies within 0.001 m of 1,1,1" "$T/said"
u=$(sinew info --get node.displacement.at.0,0.02,0 <"$T/out")
is "$u" "0 0.002 0" "rigid nodes were carried along"
replays "controls"

# What differs is told, by its name.
fails 1 "another rate" 'record:[0-9]*: the record was made with rate 60, but this run has 50' \
    sh -c "tled-run --text -q --replay '$T/record' --rate 50 <'$T/model'"
fails 1 "another precision" 'made with precision double, but this run has single' \
    sh -c "tled-run --text -q --replay '$T/record' --precision single <'$T/model'"
fails 1 "another start of the script" 'made with script 0x[0-9a-f]*, but' \
    sh -c "tled-run --text -q --replay '$T/record' -g 0,0,-1 <'$T/model'"
sed '/^array material.E/{n;s/.*/3001/;}' "$T/model" >"$T/other"
fails 1 "another model" 'made with model 0x[0-9a-f]*, but' sh -c "tled-run --text -q --replay '$T/record' <'$T/other'"
sed 's/ steps=[0-9]*/ steps=7/' "$T/record" >"$T/odd"
fails 1 "other steps" 'took [0-9]* steps, but 7 as it was recorded' sh -c "tled-run --text -q --replay '$T/odd' <'$T/model'"
check "a part of it" sh -c "tled-run --text -q --replay '$T/record' -t .1 <'$T/model' >'$T/again' 2>'$T/said'"
is "$(frames "$T/again")" 7 "has its frames up to that time"
is "$(cat "$T/said")" '' "and nothing is wrong with the record"
sed 's/^now gravity.*/now gravity 0,0/' "$T/record" >"$T/odd"
fails 1 "a line of a record that is wrong" "odd:[0-9]*: '0,0'; expected X,Y,Z" \
    sh -c "tled-run --text -q --replay '$T/odd' <'$T/model'"

# From standard input after the model, whose end ends the run.
rm -f "$T/record"
run=$$ # which goes on
{ cat "$T/model"; printf 'now gravity 0,0,-3\n'; until_line '^now' "$T/record"; more 10; printf 'now gravity 0,0,-4\n'; } |
    tled-run --text -q --live --control - --record "$T/record" >"$T/out"
is $? 0 "controls after the model"
is "$(lines '^now')" 2 "both are taken"
replays "standard input"

# A script acts too, until a line says otherwise.
printf '0 gravity 0,0,0\n.1 gravity 0,0,-5\n1 gravity 0,0,-50\n' >"$T/script"
live --script "$T/script" --precision single -t .3
is $? 0 "a script in a live run"
replays "a script" --script "$T/script" --precision single

# Nodes that slide on a bone which moves; skin that touches itself.
mv "$T/model" "$T/plain"
awk -v E=30000 -v nx=8 -v ny=8 -v nz=3 -v h=.0025 -f tests/cli/block.awk |
    awk -v nx=8 -v ny=8 -v h=.0025 -v R=.05 -f tests/cli/slide.awk | awk -v body=plate -f tests/cli/slide.awk >"$T/model"
printf '%s\n' 'now gravity 0,0,-5' 'now move plate 1mm,0,2mm 0,0,0,1' 'now displace 12mm,9mm,-1mm,13mm,11mm,1mm -,.2mm,-' >"$T/lines"
live_lines() {
    rm -f "$T/record"
    cat "$T/model" "$T/lines" | tled-run --text -q --live -t .3 --control - --record "$T/record" >"$T/out" 2>/dev/null
}
live_lines
is "$(lines '^now')" 3 "lines that move bone and nodes that slide"
replays "nodes that slide"
awk -v boxes='slit 0,40,0,40,-20,0,8,8; slit 0,40,0,40,5,25,8,8' -f tests/cli/boxes.awk >"$T/slit.obj"
voxelise --text -q --unit mm -s 4 --fraction 4 "$T/slit.obj" 2>/dev/null | sinew bind --text -q --self-contact slit >"$T/model"
printf '%s\n' 'now displace -9mm,-9mm,-30mm,49mm,49mm,-17mm 0,0,0' 'now displace -9mm,-9mm,22mm,49mm,49mm,35mm 0,0,-7mm' >"$T/lines"
live_lines
is "$(lines '^now')" 2 "lines that close a slit"
replays "skin that touches"
mv "$T/plain" "$T/model"

# A probe: the newest pose; its frame's is the one that is recorded.
printf 'volume move=0,0,1cm\n' >"$T/body"
rm -f "$T/record"
tled-run --text -q --live --probe sphere:1cm --poses "$T/fifo" --body "$T/body" --record "$T/record" <"$T/model" >"$T/out" 2>"$T/said" &
run=$!
(
    exec 3>"$T/fifo"
    for z in 40 38 nan 36; do
        for i in 1 2 3 4 5 6 7 8; do printf '%s 0.01 0.01 %se-3 1 0 0 0\n' "$i" "$z"; done >&3
        more 6
        printf '9 0 0 0 0 0 0 0\n0 1 2\n' >&3
        exec 3>&-
        exec 3>"$T/fifo"
    done
    printf '20 0.01 0.01 0.035 1 0 0 0\n' >&3
    until_line 'pose=0.01,0.01,0.025' "$T/record"
    more 3
)
kill -INT "$run"
wait "$run"
is $? 0 "a probe that comes live, ended by ^C"
is "$(sinew info --get probe.pose <"$T/out" | cut -d ' ' -f 1-3)" "0.01 0.01 0.025" "relative to the body"
check "and in the record" grep -q 'pose=0.01,0.01,0.025' "$T/record"
replays "a probe" --probe sphere:1cm

fails 1 "another ramp of its force" 'made with ramp 0.1, but this run has 0.2' \
    sh -c "tled-run --text -q --replay '$T/record' --probe sphere:1cm --ramp .2 <'$T/model'"

# A pose where there is no probe, and names that differ in what a record might write alike.
rm -f "$T/record"
run=$$
{
    cat "$T/model"
    printf '0 0.01 0.01 0.03 0 0 0 1\npull a#b 10mm,10mm,20mm 6mm 10mm,10mm,25mm 5\npull a_b 10mm,10mm,20mm 6mm 10mm,10mm,15mm 5\n'
    until_line '^pull a_b' "$T/record"
    more 5
    printf 'release a#b # no more\n'
    until_line '^release' "$T/record"
    more 5
} | tled-run --text --live --control - --record "$T/record" >"$T/out" 2>"$T/said"
is $? 0 "names with a # in them"
check "a pose without a probe is told" grep -q 'stdin:1: a pose, but there is no probe; expected --probe and --poses; the line is skipped' "$T/said"
check "and counted" grep -q ': 0 poses, 0 of them stale and dropped; 3 controls; 1 lines skipped' "$T/said"
replays "names with a # in them"

# ^C ends the stream well; a second run may not write over the record.
rm -f "$T/record"
tled-run --text -q --live --record "$T/record" -o "$T/out" <"$T/model" &
run=$!
until_line '^frame 20 ' "$T/record"
kill -TERM "$run"
wait "$run"
is $? 0 "SIGTERM is a normal end"
check "the output is there" test -s "$T/out"
replays "until it was told to end"
fails 1 "a record that is there" 'record: exists; expected the name of a new file, or --force' \
    sh -c "tled-run --text -q --live -t .1 --record '$T/record' <'$T/model'"
check "it is as it was" grep -q '^end$' "$T/record"
check "--force writes over it" sh -c "tled-run --text -q --live -t .1 --record '$T/record' --force <'$T/model' >'$T/out'"
is "$(lines '^frame')" 6 "a tenth of a second"

# kill -9: whole to the last line.
rm -f "$T/record"
tled-run --text -q --live --record "$T/record" <"$T/model" >/dev/null &
run=$!
until_line '^frame 20 ' "$T/record"
kill -KILL "$run"
wait "$run" 2>/dev/null
check "killed: no end" sh -c "! grep -q '^end' '$T/record'"
is "$(tail -c 1 "$T/record" | od -An -c | tr -d ' ')" '\n' "but whole lines"
check "which are replayed" sh -c "tled-run --text -q --replay '$T/record' <'$T/model' >'$T/out' 2>'$T/said'"
check "with a word of it" grep -q 'the record was cut short' "$T/said"
is "$(frames "$T/out")" "$(($(lines '^frame') + 1))" "all frames"

# A full disk: told once, the run goes on.
rm -f "$T/record"
(
    ulimit -f 2
    tled-run --text --live -t 1 --record "$T/record" <"$T/model" 2>"$T/said" >/dev/null
)
is $? 0 "the record's disk is full: the run goes on"
is "$(grep -c 'cannot write the record' "$T/said")" 1 "and says so once"
check "what is written can be replayed" sh -c "tled-run --text -q --replay '$T/record' <'$T/model' >'$T/out' 2>'$T/said'"
is "$(frames "$T/out")" "$(($(lines '^frame') + 1))" "to its last frame"

# Tissue that breaks: back to the last sound state, and on.
printf 'now displace 0,0,20mm,1,1,20mm 0,0,-3cm\npull p 10mm,10mm,10mm 6mm 10mm,10mm,30cm 1000\n' |
    cat "$T/model" - >"$T/both"
run=$$
rm -f "$T/record"
{
    cat "$T/both"
    until_line 'path=cpu-restored' "$T/record"
    printf 'now displace 0,0,20mm,1,1,20mm 0,0,-2mm\n'
    until_line '^now displace 0,0,20mm,1,1,20mm 0,0,-2mm' "$T/record"
    more 10
} |
    tled-run --text --live --control - --record "$T/record" >"$T/out" 2>"$T/said"
status=$?
check "tissue that breaks is told" grep -q 'the tissue broke: .*; it goes on from its last sound state, at rest' "$T/said"
is "$status" 0 "and the run goes on"
check "in the record too" grep -q 'path=cpu-restored' "$T/record"
replays "broken tissue"

# What no line has set goes on breaking it: that ends the run.
fails 3 "gravity beyond all bounds" 'diverged at step 1, ' \
    sh -c "tled-run --text -q --live -t 1 -g 0,0,-1e9 --ramp 0 <'$T/model'"

# Nonsense.
fails 2 "--live and --replay" 'expected one of them' sh -c "tled-run --text --live --replay '$T/record' <'$T/model'"
fails 2 "--control alone" '--control without --live' sh -c "tled-run --control x <'$T/model'"
fails 2 "--record alone" '--record without --live' sh -c "tled-run --record x <'$T/model'"
fails 2 "--rate alone" '--rate without --live' sh -c "tled-run --rate 5 <'$T/model'"
fails 2 "--force alone" '--force without --record' sh -c "tled-run --text --live --force <'$T/model'"
fails 2 "--body alone" '--body without --poses' sh -c "tled-run --text --live --body x <'$T/model'"
fails 2 "--rest" '--rest with --live' sh -c "tled-run --text --live --rest 1e-3 <'$T/model'"
fails 2 "--every" '--every with --live' sh -c "tled-run --text --live --every .1 <'$T/model'"
fails 2 "--log" '--log with --live' sh -c "tled-run --text --live --log x <'$T/model'"
fails 2 "--checkpoint" '--checkpoint with --live' sh -c "tled-run --text --live --checkpoint x <'$T/model'"
fails 2 "poses with a replay" '--replay with --poses' sh -c "tled-run --replay x --poses y --probe sphere:1 <'$T/model'"
fails 2 "one FIFO for both" 'are both' \
    sh -c "tled-run --text --live --probe sphere:1cm --poses '$T/fifo' --control '$T/fifo' <'$T/model'"
fails 1 "a file for controls" 'regular file' sh -c "tled-run --text -q --live --control '$T/script' <'$T/model'"
fails 1 "no such record" 'No such file' sh -c "tled-run --text -q --replay '$T/none' <'$T/model'"
fails 1 "what is no record" 'is no record' sh -c "tled-run --text -q --replay '$T/script' <'$T/model'"
done_testing
