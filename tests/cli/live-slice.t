#!/bin/sh
# us-slice --live, --record and --replay: poses and controls through FIFOs with garbage, stalls and writers that come and go; frames that stall; ends
# of all kinds; replays under load, to the same bytes. State and bytes are looked at, never times.
. "$(dirname "$0")/lib.sh"

{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 10 8' \
        'space directions: (1,0,0) (0,1,0) (0,0,1)' 'encoding: text' 'space origin: (0,0,0)' ''
    awk 'BEGIN { for (k = 0; k < 8; k++) for (j = 0; j < 10; j++) for (i = 0; i < 12; i++) print (i * 37 + j * 91 + k * 53 + i * j * k) % 256 }'
} >"$T/v.nrrd"
sed 's/type: uint8/type: uint16/' "$T/v.nrrd" | awk 'done { print ($1 > 128); next } { print } /^$/ { done = 1 }' >"$T/labels.nrrd"
mkfifo "$T/poses" "$T/control"
cd "$T" || exit 1
VIEW="--size 60x40 --probe linear:12mm,2mm --depth 8mm"

# shellcheck disable=SC2317 # these are called by name
# until_seen N FILE PATTERN: waits until N lines of the file match; fails after 10 s.
until_seen() {
    tries=0
    while [ ! -e "$2" ] || [ "$(grep -Ec -e "$3" "$2")" -lt "$1" ]; do
        tries=$((tries + 1))
        [ "$tries" -lt 500 ] || return 1
        sleep .02
    done
}

# shellcheck disable=SC2317
# more: waits until there are ten more images in the record than there were.
more() {
    until_seen $(($(grep -c '^frame' "$1") + 10)) "$1" '^frame'
}

# ends NAME PID: the run with this number ends by itself, with status 0.
ends() {
    timeout 10 tail -s .05 --pid="$2" -f /dev/null
    wait "$2"
    is $? 0 "$1"
}

# ---- Poses and controls, no model.
# shellcheck disable=SC2086 # options
us-slice --live --rigid --poses poses --control control --labels labels.nrrd --record a.rec $VIEW -o a.ppm v.nrrd >out 2>said &
run=$!
exec 3<>poses
printf '%s\n' '0 .0055 .004 -.0005 0 0 0 1' '.1 .0055 .004 .0001 0 0 0 1' >&3
check "images begin with the first pose" until_seen 1 a.rec '^frame 0 .* pose='
check "and go on while nothing comes" more a.rec
printf '%s\n' '1 nan 0 0 0 0 0 1' 'garbage' '2 0 0 0 0 0 0 0' '.05 0 0 0 0 0 0 1' '3 0 0' '4 1 1 1 inf 0 0 1' '5 .1 .1 .1' >&3
printf '6 .0055 .0045 0 0 0 0 1\n7 .001 .002 .0' >&3
check "the pose after wrong lines is shown" until_seen 1 a.rec 'pose=0.0055,0.0045,0,0,0,0,1'
exec 3>&-
check "its writer goes away" until_seen 1 said 'the line is cut: its writer went away'
exec 3<>poses
echo '0 .0055 .005 0 0 0 0 1' >&3
check "and that of the next writer, whose times begin anew" until_seen 1 a.rec 'pose=0.0055,0.005,'
exec 4<>control
printf '%s\n' 'set gain 12' 'set tgc 0,6,-3' 'set dynamic-range 50,60' 'set depth 6mm' 'set width 9mm' 'set thickness 2mm,3' \
    'set probe curved:1cm,60,2mm' 'set width 0' 'set labels off' >&4
check "controls are taken" until_seen 1 a.rec '^set labels off'
printf '%s\n' 'set gain loud' 'set gain 500' 'set tgc 1,2,3,4,5,6,7' 'set depth 20m' 'set depth -1' 'set probe sphere:1cm' 'set thickness 0,0' \
    'set probe convex:v.nrrd' 'set size 10x10' 'set freeze maybe' 'set coupling 1mm' 'set volume 3' 'method fem' 'now contract x 1' 'set gain' >&4
echo 'set thickness 0' >&4
check "and those after wrong ones" until_seen 1 a.rec '^set thickness 0$'
check "with images after them" more a.rec
is "$(grep -Ec '^set (gain (loud|500)|size|volume|coupling|freeze m)|^method|^now' a.rec)" 0 "what is wrong is not recorded"
echo 'set freeze on' >&4
until_seen 1 a.rec '^set freeze on'
echo '.2 .0055 .006 0 0 0 0 1' >&3
check "a frozen image is repeated" more a.rec
is "$(sed -n '/^set freeze on/,$p' a.rec | grep '^frame' | sed 's/.*pose=//' | sort -u | wc -l | tr -d ' ')" 1 "and its pose stays"
echo 'set gain 3' >&4
check "while its gain can change" until_seen 1 a.rec '^set gain 3'
echo 'set freeze off' >&4
check "then the newest pose is shown" until_seen 1 a.rec 'pose=0.0055,0.006,'
kill -INT "$run"
ends "SIGINT is a normal end" "$run"
exec 3>&- 4>&-
is "$(tail -n 1 a.rec)" end "the record has its end"
is "$(grep -c 'the line is skipped' said)" "$(grep 'the line is skipped' said | sed 's/.*[0-9]: //' | sort -u | wc -l | tr -d ' ')" "errors are told once a kind"
is "$(grep -c 'us-slice: live: .* 5 poses, .* 23 lines skipped; writers went away: 1$' said)" 1 "and counted: $(grep 'live:' said)"
is "$(grep -c '^frame' a.rec)" "$(grep -ac '^# us-slice:' a.ppm)" "a line for each image"

# shellcheck disable=SC2317
# busy COMMAND...: while loops keep every processor busy.
busy() {
    loops=
    for loop in : : : :; do
        sh -c "while $loop; do :; done" &
        loops="$loops $!"
    done
    nice "$@"
    set -- "$?"
    # shellcheck disable=SC2086 # numbers
    kill $loops
    # shellcheck disable=SC2086 # numbers
    wait $loops 2>/dev/null
    return "$1"
}
# shellcheck disable=SC2086 # options
check "a replay, under load" busy us-slice -q --replay a.rec --rigid --labels labels.nrrd $VIEW -o b.ppm v.nrrd
check "makes the same bytes" cmp a.ppm b.ppm

# ---- kill -9: the record is whole to its last line.
# shellcheck disable=SC2086
us-slice -q --live --rigid --poses poses --record k.rec $VIEW -o 'k_%03d.pgm' v.nrrd 2>said &
run=$!
exec 3<>poses
echo '0 .0055 .004 -.0005 0 0 0 1' >&3
until_seen 5 k.rec '^frame'
kill -9 "$run"
wait "$run" 2>/dev/null
exec 3>&-
is "$(tail -c 1 k.rec | od -An -tx1 | tr -d ' ')" 0a "after kill -9 the record's last line is whole"
mkdir again
# shellcheck disable=SC2086
check "and is replayed" us-slice --replay k.rec --rigid $VIEW -o 'again/k_%03d.pgm' v.nrrd
# shellcheck disable=SC2016 # no command
is "$(grep -c 'k.rec has no `end`: its run was cut off after image' stderr)" 1 "with a warning"
same=0
for file in again/k_*.pgm; do
    cmp -s "$file" "${file#again/}" && same=$((same + 1))
done
is "$same" "$(grep -c '^frame' k.rec)" "each image is that of the run"

# ---- Frames of a model: they stall, and end.
msds-mesh -q --nodes 5x4x4 --like v.nrrd --fix zmax -o mesh.sinew
awk 'BEGIN { for (i = 0; i < 12; i++) print i / 60, .0055, .004, .0002 * i - .001, 0, 0, 0, 1 }' >press.tum
msds-run -q --method fem --probe linear:6mm,4mm --poses press.tum --text <mesh.sinew >result.sinew
line=$(grep -n '^frame 8 ' result.sinew | cut -d : -f 1)
mkfifo stream
# shellcheck disable=SC2086
us-slice --live --record m.rec --rate 100 --coupling .3mm $VIEW -o 'm_%03d.png' v.nrrd <stream >out 2>said &
run=$!
exec 5<>stream
head -n "$line" result.sinew >&5
check "a frame is shown when it is there" until_seen 1 m.rec ' of=7'
check "and again while the stream stalls" more m.rec
tail -n +$((line + 1)) result.sinew >&5
exec 5>&-
ends "the stream's end ends the run" "$run"
is "$(grep '^frame' m.rec | tail -n 1 | sed 's/.*of=//')" 11 "after its last frame"
is "$(sed -n 's/.*; \([0-9]*\) frames read, .*/\1/p' said)" 12 "every frame was read"
# shellcheck disable=SC2086
check "a replay from the stream" us-slice -q --replay m.rec $VIEW -o 'again/m_%03d.png' v.nrrd <result.sinew
same=0
for file in m_*.png; do
    cmp -s "$file" "again/$file" && same=$((same + 1))
done
is "$same" "$(grep -c '^frame' m.rec)" "makes each of its images"
is "$(grep -c '^set coupling 0.0003' m.rec)" 1 "with the coupling that the record has"

# With poses of its own: at rest until the first frame is there; the last controls of one FIFO for both.
# shellcheck disable=SC2086
us-slice --live --poses poses --control poses --record p.rec $VIEW -o p.pgm v.nrrd <stream >out 2>said &
run=$!
exec 5<>stream 3<>poses
first=$(grep -n '^frame' result.sinew | head -n 1 | cut -d : -f 1)
head -n "$first" result.sinew >&5
printf 'set gain 5\n0 .0055 .004 0 0 0 0 1\n' >&3
check "before the first frame, the model at rest" until_seen 3 p.rec '^frame [^=]*=[^=]*$'
tail -n +$((first + 1)) result.sinew >&5
exec 5>&-
ends "and its end" "$run"
exec 3>&-
# shellcheck disable=SC2086
check "replayed" us-slice -q --replay p.rec $VIEW -o q.pgm v.nrrd <result.sinew
check "to the same bytes" cmp p.pgm q.pgm
# shellcheck disable=SC2086
fails 1 "a stream without a frame that is named" 'ends before frame [0-9]*, which the record names' us-slice --replay p.rec $VIEW v.nrrd <mesh.sinew
# shellcheck disable=SC2086
{
    head -n "$line" result.sinew | timeout 10 us-slice -q --live $VIEW v.nrrd >out 2>said
    is "$? $(grep -c 'stdin' said)" "1 1" "a stream that is cut fails: $(cat said)"
    sed '/^frame 3/,$d' result.sinew >failed.sinew
    echo 'fail 3 "msds-run: diverged"' >>failed.sinew
    timeout 10 us-slice -q --live $VIEW v.nrrd <failed.sinew >out 2>said
    is $? 3 "a stream that says it failed ends the run with its status"
    timeout 10 us-slice --live $VIEW v.nrrd <mesh.sinew >out 2>said
    is "$? $(grep -c 'live: 0 frames' said)" "0 1" "a stream without frames has no images"
}
# A signal, with a stream that does not end; and a pose among controls, where poses are those of the frames.
# shellcheck disable=SC2086
us-slice -q --live --control control --record s.rec $VIEW -o s.pgm v.nrrd <stream >out 2>said &
run=$!
exec 5<>stream
head -n "$line" result.sinew >&5
until_seen 1 s.rec ' of=7'
echo '0 .0055 .004 0 0 0 0 1' >control
check "a pose that is not used is told" until_seen 1 said 'control:1: a pose among the controls, .*; expected --poses; the line is skipped'
kill -TERM "$run"
ends "SIGTERM ends a run whose stream does not" "$run"
exec 5>&-
is "$(tail -n 1 s.rec)" end "with its record"

# ---- Standard input.
# shellcheck disable=SC2086
{
    (cat press.tum && sleep .2) | timeout 10 us-slice -q --live --rigid --poses - --control control --record i.rec $VIEW -o i.pgm v.nrrd 2>said
    is $? 0 "the end of poses on standard input ends the run, whatever FIFOs do"
}
is "$(grep '^frame' i.rec | tail -n 1 | sed 's/.*pose=\([^ ]*\).*/\1/')" "0.0055,0.004,0.0012,0,0,0,1" "after the last pose"

# shellcheck disable=SC2086
for i in $(seq 60); do
    echo "$i .0055 .004 .00$i 0 0 0 1"
    sleep .005
done | timeout 10 us-slice -q --live --rigid --poses - --rate 20 --record fast.rec $VIEW v.nrrd >r.pgm
is "$(awk '/^frame/ { n++; if (n > 1 && $3 - last < .025) fast++; last = $3 } END { print (n > 2), fast + 0 }' fast.rec)" "1 0" \
    "there are never more than twice as many images as --rate says"

# ---- Records: existing ones, full disks, those of something else.
# shellcheck disable=SC2317
# slice OPTIONS...: a live run of a few poses.
slice() {
    # shellcheck disable=SC2086
    (cat press.tum && sleep .2) | timeout 10 us-slice --live --rigid --poses - $VIEW "$@" v.nrrd >r.pgm
}
fails 1 "a record that exists" 'i.rec: exists; expected the name of a new file, or --force' slice --record i.rec
check "is written over with --force" slice --record i.rec --force
is "$(tail -n 1 i.rec)" end "whole"
rm -f said
# shellcheck disable=SC2086
(cat press.tum && until_seen 1 said 'its record ends') | {
    ulimit -f 4
    timeout 10 us-slice --live --rigid --poses - --rate 200 $VIEW --record full.rec v.nrrd 2>said
    echo $? >status
} | cat >r.pgm
is "$(cat status)" 0 "a full disk does not end the run"
is "$(grep -c 'full.rec: cannot write the record: File too large; the run goes on, and its record ends after frame' said)" 1 "but is told"
is "$(tail -n 1 full.rec | cut -d ' ' -f 1)" frame "its last line is whole"
# shellcheck disable=SC2086
us-slice -q --replay full.rec --rigid $VIEW v.nrrd >f.pgm 2>said
check "and what it has is replayed" cmp -n "$(wc -c <f.pgm)" f.pgm r.pgm
# wrong NAME PATTERN OPTIONS...: a replay that is refused.
wrong() {
    title=$1 pattern=$2
    shift 2
    fails 1 "$title" "$pattern" us-slice --replay i.rec --rigid "$@"
}
wrong "another size" 'made with size 60x40, but this run has 60x41' --size 60x41 --depth 8mm --probe linear:12mm,2mm v.nrrd
# shellcheck disable=SC2086
{
    wrong "another method" 'made with method spans, but this run has paper' $VIEW --method paper v.nrrd
    wrong "another volume" 'made with volume 0x' $VIEW labels.nrrd
    wrong "labels" 'made with labels none, but' $VIEW --labels labels.nrrd v.nrrd
    sed 's/^frame 0 .*/frame 0 0 of=3/' i.rec >bad.rec
    fails 1 "a frame without a pose" 'bad.rec:[0-9]*: a frame without pose=' us-slice -q --replay bad.rec --rigid $VIEW v.nrrd
    sed 's/^set gain 0/set gain loud/' i.rec >bad.rec
    fails 1 "a wrong setting in a record" "bad.rec:[0-9]*: gain 'loud': expected a number" us-slice -q --replay bad.rec --rigid $VIEW v.nrrd
    fails 1 "a volume as a record" 'is no record; expected' us-slice -q --replay v.nrrd --rigid $VIEW v.nrrd
}

# ---- What nobody means.
live="us-slice --live --rigid"
# shellcheck disable=SC2086
{
    fails 2 "live and a replay" '--live with --replay' $live --replay a.rec v.nrrd
    fails 2 "controls that are not live" 'for --live' us-slice --rigid --poses press.tum --control control v.nrrd
    fails 2 "a record that is not live" 'for --live' us-slice --rigid --poses press.tum --record x.rec v.nrrd
    fails 2 "a rate that is not live" 'for --live' us-slice --rigid --poses press.tum --rate 30 v.nrrd
    fails 2 "no images a second" "--rate '0': expected a number from 1 to 1000" $live --poses poses --rate 0 v.nrrd
    fails 2 "force without a record" '--force without --record' us-slice --force --rigid --poses press.tum v.nrrd
    fails 2 "no poses" '--rigid without --poses' $live v.nrrd
    fails 2 "a transform" '--transform with --live' $live --poses poses --transform ProbeToReference v.nrrd
    fails 2 "poses where the model is" 'standard input holds the model' us-slice --live --poses - v.nrrd
    fails 2 "poses and a replay" '--poses with --replay' us-slice --rigid --replay a.rec --poses poses v.nrrd
    fails 1 "poses of a file" 'press.tum: is a regular file; expected a FIFO' $live --poses press.tum v.nrrd
    fails 1 "poses of a folder" 'is a folder' $live --poses . v.nrrd
    fails 1 "poses of nothing" 'none: cannot open' $live --poses none v.nrrd
    fails 2 "a record over the volume" 'would overwrite' $live --poses poses --record v.nrrd --force v.nrrd
}
cd "$ROOT" || exit 1
done_testing
