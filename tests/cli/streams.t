#!/bin/sh
# Long streams in little memory, and arrays of more than 2^31 numbers. Models are generated into pipes and never stored: 200 MB of frames
# and an array of 30 MB; with SINEW_LONG 10 GB of frames and an array of 2^31 + 5000 numbers.
. "$(dirname "$0")/lib.sh"

tests=${BUILD:-build}/tests/cli
[ -x "$tests/long_stream" ] || skip_all "no $tests/long_stream (make unit)"
few_frames=8 frames=40 rows=30000000 size=3.4
if [ -n "$SINEW_LONG" ]; then
    frames=1900 rows=$((2147483648 + 5000))
elif [ -n "$SINEW_SANITIZED" ]; then
    few_frames=2 frames=6 rows=3000000 size=8
fi

awk -v r=100 -v n=24 -v g=skin -f tests/cli/sphere.awk >"$T/ball.obj"
voxelise -q --unit mm -s "$size" "$T/ball.obj" 2>"$T/said" | sinew bind -q "$T/ball.obj" | tled-run -q -d cpu -g 0,0,-1 -n 2 --every 1 -o "$T/ball" 2>>"$T/said"
voxelise -q --unit mm -s "$size" -o "$T/body" "$T/ball.obj" 2>>"$T/said"
body=$(($(wc -c <"$T/body") / 1024))
nodes=$(sinew info --get axis.node "$T/ball")
frame=$((nodes * 2 * 24 / 1024))

# peak_of FILE: KiB.
peak_of() {
    cat "$T/$1"
}

# feed FRAMES: into a pipe.
feed() {
    "$tests/long_stream" frames "$1" <"$T/ball"
}

# within WHAT MODELS: many frames take what a few take, not even a quarter of a frame more (a few, not two: buffers reach their size after
# four or five); and that is the body and two frames of each of MODELS, beside what any process takes.
within() {
    more=$(($(peak_of many) - $(peak_of few)))
    ok_if=$((more < frame / 4 + 1500 && $(peak_of many) < $2 * (body * 5 / 4 + 2 * frame) + 12000))
    [ -z "$SINEW_SANITIZED" ] || ok_if=1
    is "$ok_if" 1 "$1: $(peak_of many) KiB for $frames frames, $(peak_of few) for $few_frames, of $frame KiB each"
}

for count in $few_frames $frames; do
    which=few
    [ "$count" -eq "$few_frames" ] || which=many
    feed "$count" | "$tests/peak" "$T/$which" sinew-deform --frame last "$T/ball.obj" >"$T/$which.obj"
    is "$? $(grep -c '^v ' "$T/$which.obj")" "0 $(grep -c '^v ' "$T/ball.obj")" "deform: $count frames, $((frame * count / 1024)) MiB of them"
done
within "deform, the last" 1
check "and the last of many is not the last of a few" sh -c "! cmp -s '$T/few.obj' '$T/many.obj'"

for count in $few_frames $frames; do
    which=few
    [ "$count" -eq "$few_frames" ] || which=many
    feed "$count" | "$tests/peak" "$T/$which" sinew-deform -q --frame all --format pc2 -o "$T/$which.pc2" "$T/ball.obj"
    is "$? $(wc -c <"$T/$which.pc2")" "0 $((32 + count * 12 * $(grep -c '^v ' "$T/ball.obj")))" "deform: all of $count"
done
within "deform, all" 1

mkfifo "$T/other"
for count in $few_frames $frames; do
    which=few
    [ "$count" -eq "$few_frames" ] || which=many
    feed "$count" >"$T/other" &
    feed "$count" | "$tests/peak" "$T/$which" sinew-diff -v - "$T/other" >"$T/report" 2>"$T/stderr"
    is "$? $(grep -c "frames: $count and $count" "$T/stderr")" "0 1" "diff: $count frames beside $count"
    wait
done
within "diff" 2

# An array of more numbers than an int counts.
large() {
    "$tests/long_stream" large "$rows" "$@" <"$T/body"
}
large | "$tests/peak" "$T/used" sinew-info >"$T/info"
is "$? $(grep -c "^  x-rows  *$rows\$" "$T/info") $(grep -c '^  x-large .*0 to 250$' "$T/info")" "0 1 1" "info: an array of $rows numbers"
[ -n "$SINEW_SANITIZED" ] || check "in that array's memory: $(cat "$T/used") KiB" test "$(cat "$T/used")" -lt $((rows / 1024 + body + 40000))
is "$(large | sinew info --get x-large.sum)" "$(awk -v n="$rows" 'BEGIN { whole = int(n / 251); rest = n % 251; printf "%.0f", whole * 251 * 250 / 2 + rest * (rest - 1) / 2 }')" \
    "info: its sum"
is "$(large | sinew bind -q "$T/ball.obj" | sinew info --get x-large.sum --get axis.x-rows | tr '\n' ' ')" \
    "$(large | sinew info --get x-large.sum --get axis.x-rows | tr '\n' ' ')" "it passes through a tool that does not know it"
large | sinew export -f model | sinew export -f model | "$tests/peak" "$T/used" cksum >"$T/once"
large | sinew export -f model | cksum >"$T/again"
check "written again to the same bytes" cmp "$T/once" "$T/again"
large $((rows - 3)) >"$T/other" &
large | sinew diff - "$T/other" >"$T/report"
is "$? $(sed 's/, relative.*//' "$T/report")" "1 x-large: 1 of $rows rows differ, the first row $((rows - 3)): $(((rows - 3) % 251)) and $(((rows - 3) % 251 + 1)); largest difference 1" \
    "diff: one number near its end"
wait
check "cut in its last byte it is refused" sh -c "! '$tests/long_stream' large '$rows' <'$T/body' | head -c '$((rows + 200))' | sinew info >'$T/info' 2>'$T/stderr' && grep -q 'cut short' '$T/stderr'"
done_testing
