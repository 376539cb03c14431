#!/bin/sh
# tled-run: a run ends at the time that was asked, whole steps or not; steps that are cut are told of: when, how far and for what element.
. "$(dirname "$0")/lib.sh"

awk -v nx=12 -v ny=4 -v nz=4 -v h=0.0025 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/muscle.sinew"
awk -v nx=3 -v ny=2 -v nz=2 -v h=0.01 -f tests/cli/block.awk >"$T/free.sinew"
run() { # ARG...
    tled-run -d cpu -o "$T/out" "$@" <"$T/muscle.sinew"
}
frame_times() { # of the frames in $T/out, exactly
    sinew export -f model --text "$T/out" | awk '/^frame / { printf "%s ", $3 }'
}
moved() {
    sinew info --get node.displacement.max "$T/out"
}
said() { # PATTERN: how many lines
    grep -Ec -e "$1" "$T/stderr"
}

# ---- The end. What falls freely has fallen g t^2 / 2.
for case in '0.037 ' '0.0371234 ' '1e-6 ' '0.04 ' '0.037 --dt 0.0011' '0.037 --precision single'; do
    t=${case%% *}
    # shellcheck disable=SC2086 # options
    tled-run -q -d cpu -g 0,0,-9.81 --ramp 0 --damping 0 -t "$t" ${case#* } -o "$T/out" <"$T/free.sinew" 2>"$T/stderr"
    near "$(moved)" "$(awk "BEGIN { printf \"%.17g\", 9.81 / 2 * $t * $t }")" 1e-6 "after $case s it has fallen g t^2 / 2"
    is "$(frame_times | awk -v t="$t" '{ print $1 - t, NF }')" "0 1" "and the frame is of just that time"
done
check "a run to an end between two steps" run -c all=0.5 -t 0.037 --every 0.01 --log "$T/log"
is "$(said 'from 0 s, 163 steps, the last one shorter$')" 1 "says so"
is "$(frame_times)" "0 0.01 0.02 0.029999999999999999 0.036999999999999998 " "its frames: as many as asked, and the end"
is "$(tail -n 1 "$T/log" | cut -f 1-3 | tr '\t' ' ')" "0.037 163 0.000181818182" "its log ends there, by a step that was as short"
cp "$T/out" "$T/one"
check "on two threads" run -q -c all=0.5 -t 0.037 --every 0.01 --threads 2
check "the same bytes" cmp "$T/one" "$T/out"
check "a run to a whole number of steps" run -c all=0.5 -t 0.04
is "$(said 'shorter')" 0 "has none that is shorter"
check "a part of a step alone" run -t 1e-5
is "$(said 'from 0 s, 1 step, the last one shorter$')$(frame_times)" "11.0000000000000001e-05 " "is one step"
tled-run -q -d cpu -c all=0.5 -t 0.0131 <"$T/one" >"$T/out"
near "$(frame_times | awk '{ print $NF }')" 0.0501 1e-15 "a run that goes on from there ends where it is to"
whole=$(run -q -c all=0.5 -t 0.0501 && moved)
near "$(tled-run -q -d cpu -c all=0.5 -t 0.0131 <"$T/one" | sinew info --get node.displacement.max)" "$whole" 1e-3 "near where one run ends"

# ---- Multiples that lie between steps.
check "frames between steps" run -c all=0.5 -t 0.01 --every 0.003 --log "$T/log" --log-every 1e-5
is "$(said 'multiples of --every 0.003 s lie between steps: each frame is of the first step after one, up to 0.227 ms late')" 1 "are told of"
is "$(said '--log-every 1e-05 s is shorter than a step: one row is written for each step')" 1 "so are rows"
is "$(frame_times | awk '{ for (i = 2; i < NF; i++) { late = $i - 0.003 * (i - 1); n += late >= 0 && late < 0.000228 } print n, $NF }')" "3 0.01" \
    "each is as late as that at most"
check "frames on steps" run -c all=0.5 -t 0.02 --every 0.01
is "$(said multiples)" 0 "are not"
for case in '-t 0.037 --every 0.037 0' '-t 0.037 --every 0.0185 1' '-t 0.037 --every 0.05 0' '-n 20 --every 0.0123 0' '-n 80 --every 0.0123 1'; do
    # shellcheck disable=SC2086 # options
    check "${case% *}" run -c all=0.5 ${case% *}
    is "$(said multiples)" "${case##* }" "what is late is told of, and nothing else: its end is met"
done

# ---- Cuts.
check "a muscle that contracts fully" run -c all=1 -t 0.1 --log "$T/log"
is "$(said 'each step is cut')" 1 "a step that is cut is told of once"
is "$(said "^tled-run: at 0\.0[0-9]* s each step is cut into 2, of 0\.1136 ms: element [0-9]+ \(volume 'muscle_all'\) at [0-9.]+m,[0-9.]+m,[0-9.]+m has a stable step of 0\.2[0-9]* ms$")" 1 \
    "when, how far, where, and why"
element=$(sed -n 's/.*: element \([0-9]*\) .*/\1/p' "$T/stderr")
is "$(sed -n 's/.*) at \(.*\) has.*/\1/p' "$T/stderr")" \
    "$(awk -v e="$element" 'BEGIN { printf "%.4gm,%.4gm,%.4gm", .0025 * (e % 12) + .00125, .0025 * (int(e / 12) % 4) + .00125, .0025 * int(e / 48) + .00125 }')" "the place is the element's"
is "$(said 'steps were cut into up to 2: [0-9]+ steps were taken in place of 440$')" 1 "and at the end, with what it took"
at=$(sed -n 's/.*at \([0-9.]*\) s each.*/\1/p' "$T/stderr")
# shellcheck disable=SC2016 # for awk
check "the log has it from then on" awk -v at="$at" 'NR > 2 && ($3 < .0002) != ($1 > at) { exit 1 }' "$T/log"
check "with -q" run -q -c all=1 -t 0.1
is "$(grep -v 'elements are folded' "$T/stderr")" "" "nothing is said of it"
check "at once" run -c all=1 -t 0.05 --ramp 0
is "$(said 'each step is cut')" 1 "one line, however often it was tried"
is "$(said "at 0\.01 s each step is cut into (8|16|32|64), of .* ms: element [0-9]+ .* was inverted or not finite after longer steps")" 1 "says what broke"
printf '0 contract all 0\n.02 contract all 1\n.05 contract all 1\n.06 contract all 0\n.1 contract all 0\n.12 contract all 1\n' >"$T/twice"
check "a cut that ends and comes again" run --script "$T/twice" -t 0.15 -v
is "$(said 'each step is cut into 2,') $(said 'each step is cut into 2 from now on')" "1 1" "is told of once, but with -v: each time once"
check "no cut" run -c all=0.1 -t 0.1
is "$(said 'cut')" 0 "no word of it"
done_testing
