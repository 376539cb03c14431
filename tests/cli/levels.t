#!/bin/sh
# Levels of muscles in tled-run: tracks, wildcards, expressions, activation with rise and fall; alone, in scripts, on the command line,
# live and replayed, continued from a checkpoint; what a log says of them reads back as a track; nonsense is refused.
. "$(dirname "$0")/lib.sh"

# A bar of three muscles one after the other.
awk -v nx=6 -v ny=2 -v nz=2 -v h=0.004 -v held=low -v muscle=1 -f tests/cli/block.awk | awk '
    /^axis volume/ { print "axis volume 3"; next }
    /^array element.volume/ { print; for (n = 0; n < 24; n++) { getline; print int(n % 6 / 2) } next }
    /^array volume.name/ { print; getline; print "\"muscle_zyg_left\"\n\"muscle_zyg_right\"\n\"muscle_ris_left\""; next }
    /^array volume\./ { print; getline; print; print; print; next }
    { print }' >"$T/bar"
is "$(sinew info --get volume.name <"$T/bar" | tr '\n' ' ')" "muscle_zyg_left muscle_zyg_right muscle_ris_left " "a bar of three muscles"

# run OUT ARG...: its frames, without the line that has the command.
run() {
    out=$1
    shift
    tled-run -q -d cpu --text "$@" <"$T/bar" 2>"$T/said" | sed -n '/^frame /,$p' >"$out"
    [ ! -s "$T/said" ] || diag_file "$T/said"
}
same() { # NAME: the last two runs
    check "$1" cmp "$T/a" "$T/b"
}
differ() {
    if cmp -s "$T/a" "$T/b"; then not_ok "$1"; else ok "$1"; fi
}

# ---- Wildcards.
run "$T/a" -n 200 -c zyg_left=.3,zyg_right=.3,ris_left=.1
run "$T/b" -n 200 -c 'zyg_*=.3,ris_*=.1'
same "-c: the beginning of names and *"
run "$T/b" -n 200 -c 'muscle_z*=.3,muscle_r*=.1'
same "of their long names too"
printf '0 contract zyg_* 0\n.1 contract zyg_* .3\n0 contract ris* 0\n.1 contract ris* .1\n' >"$T/script"
run "$T/b" -n 200 --script "$T/script"
same "and in scripts"
run "$T/a" -n 200 -c zyg_left=.2,zyg_right=.2,ris_left=.2
run "$T/b" -n 200 -c '*=.2'
same "* alone: all muscles"

# ---- Expressions: shares of levels, sums of at most 1.
cat >"$T/x" <<'END'
# two
smile: zyg_*=.75 ris_left=.5   # with a comment
half:  zyg_left=.5
END
run "$T/a" -n 200 -c 'zyg_*=.375,ris_left=.25'
run "$T/b" -n 200 --expressions "$T/x" -c @smile=.5
same "-c @NAME: each muscle its share"
printf '0 contract @smile 0\n.1 contract @smile .5\n' >"$T/script"
run "$T/b" -n 200 --expressions "$T/x" --script "$T/script"
same "in scripts"
run "$T/a" -n 200 -c 'zyg_left=.75,zyg_right=.375,ris_left=.25'
run "$T/b" -n 200 --expressions "$T/x" -c @smile=.5,zyg_left=.125,@half=.5
same "levels of expressions, and a muscle's own, add up"
run "$T/a" -n 200 --ramp 0 -c 'zyg_left=1,zyg_right=.75,ris_left=.5'
tled-run -q -d cpu --text -n 200 --ramp 0 --expressions "$T/x" -c @smile=1,@half=1 <"$T/bar" 2>"$T/said" | sed -n '/^frame /,$p' >"$T/b"
same "to 1 at most"
is "$(cat "$T/said")" "tled-run: warning: at 0 s the levels of muscle_zyg_left add up to 1.25; what is above 1 counts as 1" "which is told once"

# ---- Tracks.
printf 'time\tzyg_*\tris_left\n0\t0\t0\n.1\t.3\t.1\n' >"$T/track"
run "$T/a" -n 200 -c 'zyg_*=.3,ris_left=.1'
run "$T/b" -n 200 --activations "$T/track"
same "a track is -c with its ramp"
printf 'time\t@smile\n0\t0\n.1\t.5\n' >"$T/track"
run "$T/a" -n 200 -c 'zyg_*=.375,ris_left=.25'
run "$T/b" -n 200 --activations "$T/track" --expressions "$T/x"
same "a column of an expression"
run "$T/b" -n 200 --activations "$T/track" --between smooth --expressions "$T/x"
differ "smooth between rows is something else"

# ---- What a log says reads back as a track, to the same bytes.
awk 'BEGIN { print "time\tzyg_left\tzyg_right\tris_left"; for (i = 0; i <= 12; i++) printf "%.2f\t%.17g\t%.17g\t%.3f\n", i / 100, (1 - cos(i / 3)) / 5, i / 37, i % 3 / 10 }' \
    >"$T/track"
run "$T/a" -t .12 --activations "$T/track" --log "$T/log" --tsv muscle.level
is "$(head -n 1 "$T/log" | tr '\t' '\n' | grep muscle.level | tr '\n' ' ')" \
    "muscle.level.muscle_zyg_left muscle.level.muscle_zyg_right muscle.level.muscle_ris_left " "columns of levels in the log"
is "$(wc -l <"$T/log" | tr -d ' ')" 14 "a row at each check"
run "$T/b" -t .12 --activations "$T/log" --log "$T/log2" --tsv muscle.level
same "a log, read as a track"
cut -f 1,21-23 "$T/log" >"$T/1"
cut -f 1,21-23 "$T/log2" >"$T/2"
check "and its log says the same" cmp "$T/1" "$T/2"
run "$T/a" -t .12 --activations "$T/track"
same "which a log does not change"

# ---- Rise and fall.
printf '0 contract * 1\n.1 contract * 1\n.1 contract * 0\n' >"$T/script"
run "$T/a" -t .2 --script "$T/script" --rise-fall .01,.04 --log "$T/log" --tsv muscle.activation --tsv muscle.level --every .05
# shellcheck disable=SC2016 # for awk
is "$(awk -F '\t' '$1 == .01 || $1 == .02 || $1 == .05 || $1 == .1 || $1 == .12 || $1 == .15 || $1 == .2 { printf "%s %.5f %g ", $1, $21, $24 }' "$T/log")" \
    "0.01 0.61862 1 0.02 0.79776 1 0.05 0.96005 1 0.1 0.99681 0 0.12 0.46724 0 0.15 0.22327 0 0.2 0.09114 0 " \
    "activations follow a level, with the values of their closed forms"
for threads in 1 3; do
    run "$T/b" -t .2 --script "$T/script" --rise-fall .01,.04 --every .05 --threads "$threads"
    same "the same bytes, $threads threads"
done
tled-run -q -d cpu -t .1 --script "$T/script" --rise-fall .01,.04 --every .05 <"$T/bar" | tled-run -q -d cpu --text -t .1 --script "$T/script" \
    --rise-fall .01,.04 --every .05 | sed -n '/^frame /,$p' >"$T/b"
same "two runs, the second from the frames of the first, are one"
run "$T/b" -t .2 --script "$T/script" --every .05
differ "without it, levels are activations"

# A run that is killed, and goes on from its checkpoint: the state of activations is its script's.
run "$T/a" -t .2 --activations "$T/track" --rise-fall .02,.05 --every .05
tled-run -q -d cpu --text -t .2 --activations "$T/track" --rise-fall .02,.05 --every .05 --checkpoint "$T/state" --checkpoint-every .01 \
    -o "$T/full" <"$T/bar"
(ulimit -f 60; trap '' XFSZ; exec tled-run -q -d cpu --text -t .2 --activations "$T/track" --rise-fall .02,.05 --every .05 \
    --checkpoint "$T/state" --checkpoint-every .01 -o "$T/cut" <"$T/bar") >/dev/null 2>&1
if [ -s "$T/state" ]; then
    check "goes on from a checkpoint" tled-run -q -d cpu --text -t .2 --activations "$T/track" --rise-fall .02,.05 --every .05 --restart "$T/state" \
        -o "$T/whole" <"$T/bar"
    sed -n '/^frame /,$p' "$T/whole" >"$T/b"
    same "to the same bytes"
else
    not_ok "a run that was cut left its checkpoint"
fi

# ---- Live, and replayed.
rm -f "$T/record"
mkfifo "$T/fifo"
tled-run --text -q -d cpu --live -t .6 --control "$T/fifo" --record "$T/record" --expressions "$T/x" --rise-fall .02,.05 <"$T/bar" >"$T/out" 2>"$T/said" &
live=$!
{
    printf 'now contract zyg_* .5\n'
    sleep .15
    printf 'now contract @smile 1\nnow contract @frown 1\nnow contract *_x 1\n'
    sleep .15
    printf 'now contract * 0\nnow contract @smile .25\n'
    sleep .15
} >"$T/fifo"
wait "$live"
is $? 0 "a live run with wildcards and expressions"
is "$(grep -c '^now contract' "$T/record")" 4 "what is wrong is not recorded"
is "$(grep -c "unknown expression 'frown'" "$T/said")" 1 "but told"
is "$(grep -c 'levels of muscle_zyg_left add up to 1.25' "$T/said")" 1 "and levels that add up to more than 1, once"
check "the replay" tled-run --text -q -d cpu --replay "$T/record" -t .6 --expressions "$T/x" --rise-fall .02,.05 -o "$T/again" <"$T/bar"
sed -n '/^frame /,$p' "$T/out" >"$T/a"
sed -n '/^frame /,$p' "$T/again" >"$T/b"
same "has the same bytes"
fails 1 "a replay with another rise" 'the record was made with script' tled-run -q -d cpu --replay "$T/record" -t .6 --expressions "$T/x" --rise-fall .01,.05 <"$T/bar"

# ---- Nonsense.
refuse() { # STATUS MESSAGE NAME ARG...
    status=$1 message=$2 name=$3
    shift 3
    fails "$status" "$name" "$message" tled-run -q -d cpu -n 1 "$@" <"$T/bar"
}
track() { # MESSAGE TEXT [ARG...]
    message=$1
    # shellcheck disable=SC2059 # a text with escapes
    printf "$2" >"$T/bad"
    shift 2
    refuse 1 "$message" "track: $message" --activations "$T/bad" --expressions "$T/x" "$@"
}
track "bad: expected a header first" ''
track "bad:1: expected a header first: time, and a column a muscle" 'seconds\tzyg_left\n'
track 'bad:1: expected a header first' 'time\n0\n'
track 'bad: has no rows' 'time\tzyg_left\n# nothing\n'
track 'bad:3: time 0.5 s comes after 0.5 s; expected times that rise' 'time\tzyg_left\n.5\t0\n.5\t1\n'
track "bad:2: '-1' is not a time" 'time\tzyg_left\n-1\t0\n'
track "bad:2: level '1.1' of zyg_left; expected a number from 0 to 1" 'time\tzyg_left\n0\t1.1\n'
track "bad:2: level '' of zyg_left" 'time\tzyg_left\n0\t\n'
track 'bad:2: 3 columns; expected 2' 'time\tzyg_left\n0\t0\t0\n'
track "bad:1: unknown muscle 'zyg_leftt'; did you mean 'zyg_left'" 'time\tzyg_leftt\n0\t0\n'
track "bad:1: unknown muscle 'lip_\\*'" 'time\tlip_*\n0\t0\n'
track "bad:1: 'zyg_left' has two columns" 'time\tzyg_*\tzyg_left\n0\t0\t0\n'
track "bad:1: unknown expression 'smil'; did you mean 'smile'" 'time\t@smil\n0\t0\n'
track 'bad:1: has columns muscle.level.NAME and muscle.activation.NAME' 'time/s\tmuscle.level.zyg_left\tmuscle.activation.zyg_left\n0\t0\t0\n'
printf 'time\tzyg_left\n0\t0\n' >"$T/track"
printf '0 contract zyg_left 1\n' >"$T/script"
refuse 1 "track:1: 'zyg_left' is driven by $T/script too" "a track and a script" --activations "$T/track" --script "$T/script"
refuse 2 "-c: muscle 'zyg_left' is contracted by $T/track too" "a track and -c" --activations "$T/track" -c zyg_left=1
refuse 1 "muscle 'muscle_zyg_left' is driven by -c, as '@smile', and by $T/track" "a track and an expression of -c" --activations "$T/track" \
    --expressions "$T/x" -c @smile=1
refuse 2 "-c: muscle 'muscle_zyg_left' is given twice" "a name and a wildcard that has it" -c 'zyg_left=.1,zyg_*=.2'
refuse 2 "-c: expression '@smile', but no file of expressions" "no expressions" -c @smile=1
refuse 2 "-c: unknown expression 'smlie'; did you mean 'smile'" "an unknown expression" --expressions "$T/x" -c @smlie=1
refuse 2 '--rise-fall 0,0.04; expected two times' "no rise" --rise-fall 0,.04
refuse 2 '--rise-fall' "one time" --rise-fall .04
refuse 2 '--between without --activations' "--between alone" --between smooth
expressions() { # MESSAGE TEXT
    # shellcheck disable=SC2059 # a text with escapes
    printf "$2" >"$T/bad"
    refuse 1 "$1" "expressions: $1" --expressions "$T/bad"
}
expressions 'bad: nothing in it' '# nothing\n'
expressions "bad:1: 'smile' names no muscle" 'smile:\n'
expressions "bad:2: unknown muscle 'lip'" 'a: zyg_*=1\nb: lip=1\n'
expressions "bad:1: 'smile'; expected NAME: MUSCLE=LEVEL" 'smile zyg_left=1\n'
expressions "bad:1: level '2' of zyg_left" 'smile: zyg_left=2\n'
expressions "bad:1: 'zyg_left'; expected MUSCLE=LEVEL" 'smile: zyg_left\n'
expressions "bad:2: 'a' is an expression of line 1 already" 'a: zyg_left=1\na: zyg_right=1\n'
expressions "bad:1: muscle 'muscle_zyg_left' is named twice in 'a'" 'a: zyg_left=1 zyg_*=1\n'
expressions "bad:1: name 'a=b'" 'a=b: zyg_left=1\n'

done_testing
