#!/bin/sh
# Muscles whose force depends on their velocity, in tled-run: bars that are held, pulled by a load, stretched and let go,
# against Hill's law in closed form; smaller steps; energies; every executor of the processor; frames to go on from.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/cli/tissue.sh
. tests/cli/tissue.sh

# end FILE [FRAME]: the stretch of a bar of 10 mm, in the last frame or a frame.
end() {
    sinew info --tsv node.displacement.at.0.01,0.0025,0.0025 "$1" |
        awk -v f="${2:-}" 'NR > 1 && (f == "" || $1 == f) { x = $3 } END { printf "%.9f", 1 + x / 0.01 }'
}
# nominal FILE: the stress by area at rest along a bar, Pa.
nominal() {
    wide=$(sinew info --get node.displacement.at.0.01,0.0025,0.0025 "$1" | awk '{ print 1 + $2 / 0.0025 }')
    sinew results stress <"$1" 2>"$T/said" >"$T/stress"
    sinew info --get element.stress.row.1 "$T/stress" | awk -v w="$wide" '{ printf "%.7g", $1 * w * w }'
}

# Tissue that is much softer than its muscle.
block 4 1 1 0.0025 -v muscle=1 -v E=30 -v nu=0.3 >"$T/bar"
grep -v '^meta lattice' "$T/bar" >"$T/mesh"
plain='-q -d cpu --damping 0 --ramp 0 -m tissue.peak=1e5'
hill="$plain -m tissue.vmax=10"

# shellcheck disable=SC2086 # options are words
{
    # ---- Held at its ends.
    printf '%s\n0 displace 0.009,-1,-1,1,1,1 0,-,-\n.05 displace 0.009,-1,-1,1,1,1 -0.001,-,-\n' "$planes" >"$T/held"
    tled-run $hill -t .3 --script "$T/held" -c all=.7 <"$T/bar" >"$T/out"
    near "$(nominal "$T/out")" 67200 1e-3 "held at .9 it has the stress of a muscle that does not move, .7 of 96 % of the peak"

    # ---- Loads: level and load come up together, so that the muscle holds it; then the load falls within 4 ms.
    # load SHARE ARGS...: 12 ms more, frames each ms.
    load() {
        share=$1
        shift
        awk -v s="$share" -v p="$planes" 'BEGIN { print p
            print "0 force 0.01,0.00125,0.00125 0.002 0,0,0\n.1 force 0.01,0.00125,0.00125 0.002 .625,0,0"
            print ".15 force 0.01,0.00125,0.00125 0.002 .625,0,0\n.154 force 0.01,0.00125,0.00125 0.002 " s * .625 ",0,0" }' >"$T/load"
        tled-run $hill --ramp .1 -t .166 --every .001 --script "$T/load" -c all=1 "$@" <"$T/bar" >"$T/out"
    }
    # shortens: w over the last 6 ms, as a share of what the law has for the load and f at the middle.
    shortens() {
        awk -v a="$(end "$T/out" 160)" -v b="$(end "$T/out" 166)" -v s="$share" 'BEGIN {
            l = (a + b) / 2; v = s / (1 - 4 * (1 - l) * (1 - l)); printf "%.5f", (b - a) / .006 / 10 / ((v - 1) / (1 + 4 * v)) }'
    }
    for share in .2 .5 .8; do
        load $share
        near "$(shortens)" 1 0.005 "against $share of the peak it shortens as Hill's law has it"
    done

    # ---- Quick release: before the muscle shortens the spring does.
    near "$(end "$T/out" 150)" 1.04 0.0015 "a muscle that holds its peak has a spring that is .04 long"
    # In .5 ms the spring alone gives .25 or .5 of the peak s away; in the mean over s, w is -0.0289 and -0.0693 meanwhile.
    printf '%s\n0 displace 0.009,-1,-1,1,1,1 0,-,-\n.12 displace 0.009,-1,-1,1,1,1 0,-,-\n.1205 displace 0.009,-1,-1,1,1,1 -0.0001,-,-\n' \
        "$planes" >"$T/release"
    for case in '.04 75362' '.02 51732'; do
        # shellcheck disable=SC2086
        set -- $case
        tled-run $hill -m tissue.density=10 -m tissue.series="$1" -t .1205 --every .1205 --script "$T/release" -c all=1 <"$T/bar" >"$T/out"
        near "$(nominal "$T/out")" "$2" 0.005 "let go by .01 of its length, with a spring of $1"
    done

    # ---- Stretched at a constant velocity.
    for case in '.05 1.222222' '.25 1.344828' '1 1.384615'; do
        # shellcheck disable=SC2086
        set -- $case
        awk -v w="$1" -v p="$planes" 'BEGIN { print p; t = .06 / w / 10
            print "0 displace 0.009,-1,-1,1,1,1 -0.0005,-,-\n.15 displace 0.009,-1,-1,1,1,1 -0.0005,-,-"
            print .15 + t " displace 0.009,-1,-1,1,1,1 0.0001,-,-" }' >"$T/pull"
        tled-run $hill -t "$(awk -v w="$1" 'BEGIN { print .15 + .05 / w / 10 }')" --script "$T/pull" -c all=1 <"$T/bar" >"$T/out"
        near "$(nominal "$T/out" | awk '{ print $1 / 1e5 }')" "$2" 0.015 "stretched by w = $1 it pulls with $2"
    done

    # ---- Any stable step: that of the spring, h / sqrt(k / density), is 50 us.
    for dt in 4.7e-5 1e-5 5e-6; do
        load .5 --dt $dt
        end "$T/out"
        echo
    done >"$T/ends"
    is "$(awk '{ x[NR] = $1 } END { a = x[2] - x[3]; b = x[1] - x[3]; print (a * a < 1e-10), (b * b < 1e-7), NR }' "$T/ends")" "1 1 3" \
        "half the step: the same length; nearly the longest that is stable: to 3e-4"
    diag_file "$T/ends"

    # ---- The same bytes everywhere.
    for model in bar mesh; do
        for precision in double single; do
            same_by_sets "1 2" $precision $model --precision $precision -n 2000 --script "$T/load" -c all=.6 $hill
        done
    done

    # ---- Energies, and strong muscles at small steps.
    block 8 3 3 0.005 -v muscle=1 -v E=3000 -v nu=0.46 -v held=low >"$T/muscle"
    for dt in 1e-5 2.5e-6; do
        tled-run -q -d cpu -t 0.08 --dt $dt -c all=1 -g 0,0,-9.81 -m tissue.peak=3e5 -m tissue.passive=.05 -m tissue.vmax=10 \
            --log "$T/log" --log-every .0001 <"$T/muscle" >"$T/out"
        awk -F '\t' 'NR > 1 { off = off > $14 * $14 ? off : $14 * $14 } END { printf "%.7g %.3g\n", $15, sqrt(off) / $11 }' "$T/log"
    done >"$T/steps"
    diag_file "$T/steps"
    is "$(awk 'NR == 1 { u = $1 } { far = $1 / u - 1; bad += far * far > 1e-6 || $2 > 1e-3 } END { print NR, bad + 0 }' "$T/steps")" "2 0" \
        "a block at full activation: smaller steps move it as far, and energies balance"

    # ---- In slow motion as without.
    slow='-q -d cpu --ramp .5 -t .6 -c all=.3 -m tissue.peak=1e5 -m tissue.passive=.05'
    tled-run $slow <"$T/muscle" >"$T/without"
    tled-run $slow -m tissue.vmax=10 <"$T/muscle" >"$T/with"
    near "$(sinew info --get node.displacement.max "$T/with")" "$(sinew info --get node.displacement.max "$T/without")" 0.01 \
        "moved slowly it is as without vmax"

    # ---- To go on from frames.
    go="-q -d cpu --damping 0 --ramp .1 --dt 1e-5 --script $T/load -c all=1 --every .02"
    hill='-m tissue.peak=1e5 -m tissue.vmax=10'
    tled-run $go $hill -t .08 <"$T/bar" >"$T/whole"
    tled-run $go $hill -t .04 <"$T/bar" >"$T/part"
    tled-run $go -t .04 <"$T/part" >"$T/parts"
    is "$(sinew diff "$T/whole" "$T/parts" >"$T/said" 2>&1; echo $?)" 0 "a run goes on from the contractile elements of its frames"
    diag_file "$T/said"
    tled-run $go -m tissue.peak=1e5 -t .04 <"$T/bar" >"$T/part"
    tled-run $go $hill -t .0002 --every .0001 <"$T/part" 2>"$T/said" >"$T/out"
    is "$(grep -c 'has no element.contractile: the run begins with muscles as strong as if they had not moved' "$T/said")" 1 \
        "from other frames it says so"
    near "$(end "$T/out")" "$(end "$T/part")" 0.001 "and goes on without a jump"
    is "$(grep -ac 'element.contractile' "$T/without")" 0 "models without vmax have none"
}

# ---- What is refused, and kept.
refuse_bar "a velocity below 0" "2 tled-run: -m tissue: 'vmax=-1' is not allowed; expected 0 to 1000 1/s" -m tissue.vmax=-1
refuse_bar "a spring that does not give" "2 tled-run: -m tissue: 'series=0' is not allowed; expected 0.001 to 1" -m tissue.series=0
tled-run -q -d cpu -n 1 --text -m tissue.vmax=0 <"$T/bar" >"$T/out"
is "$(grep -c 'material.vmax' "$T/out")" 0 "vmax=0 is as none"
done_testing
