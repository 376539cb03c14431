#!/bin/sh
# Muscles with curves of their own in tled-run: passive and active, bars that are pulled and pressed against figures by
# a script of its own, by every executor of the processor; energies; a bar that is weak on the descending limb; mixed
# elements; files of materials, and what is refused.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/cli/tissue.sh
. tests/cli/tissue.sh

# balance FILE: the worst share that a log's balance is of what was done and held.
balance() {
    awk -F '\t' 'NR > 1 { all = 0; for (i = 5; i <= 13; i++) all = all > $i * $i ? all : $i * $i
        off = off > $14 * $14 ? off : $14 * $14; most = most > all ? most : all } END { print sqrt(off / most) + 0 }' "$1"
}

# mu 5e3, K 2.5e5.
block 4 1 1 0.01 -v muscle=1 -v E=14900.6622516556 -v nu=0.490066225165563 >"$T/bar"
grep -v '^meta lattice' "$T/bar" >"$T/mesh"
blemker='-m tissue.passive=.05 -m tissue.peak=3e5'

# shellcheck disable=SC2086 # options of a material are words
{
    # pull PRESSURE LEVEL ARGS...
    pull() {
        bar "$1" >"$T/script"
        level=$2
        shift 2
        tled-run -q -d cpu --rest 1e-7 --script "$T/script" -c "all=$level" $blemker "$@" <"$T/bar" >"$T/out"
        stretched "$T/out"
    }
    read -r long wide <<X
$(pull 43658.6 0)
X
    near "$long" 1.2 1e-5 "a passive muscle is pulled by 43658.6 Pa to 1.2"
    near "$wide" 0.914693 1e-5 "and its sides"
    # cauchy PRESSURE: what an element has along the bar, as a share of the pressure by area now.
    cauchy() {
        sinew results stress <"$T/out" 2>"$T/said" >"$T/stress"
        sinew info --get element.stress.row.1 "$T/stress" | awk -v p="$1" -v w="$wide" '{ printf "%.7f", $1 * w * w / p }'
    }
    pull 43658.6 0 --results activation >/dev/null
    near "$(cauchy 43658.6)" 1 2e-5 "sinew results has that pressure as stress"
    near "$(pull -3791.05 0 | cut -d ' ' -f 1)" 0.8 1e-5 "pressed by 3791.05 Pa to .8"
    near "$(pull 169659 0.5 --results activation | cut -d ' ' -f 1)" 1.2 1e-5 "half active, pulled by 169659 Pa to 1.2"
    near "$(cauchy 169659)" 1 2e-5 "with that stress"
    near "$(pull 122209 0.5 | cut -d ' ' -f 1)" 0.8 1e-5 "half active, it lifts 122209 Pa to .8"
    bar 43658.6 >"$T/pull"
    tled-run -q -d cpu --rest 1e-7 --script "$T/pull" $blemker <"$T/bar" >"$T/out"
    near "$(stretched "$T/out" | cut -d ' ' -f 1)" 1.2 1e-5 "a muscle that is not asked to contract is as stiff"

    for model in bar mesh; do
        for precision in double single; do
            same_by_sets "1 2" $precision $model --precision $precision -n 2000 --script "$T/pull" -c all=.2 $blemker
            tled-run -q -d cpu --precision $precision --rest 1e-4 --script "$T/pull" $blemker <"$T/$model" >"$T/out"
            near "$(stretched "$T/out" | cut -d ' ' -f 1)" 1.2 1e-4 "$model, $precision: pulled to 1.2"
        done
    done

    # Energies: a muscle that pulls itself up and stretches by its end's weight.
    block 8 3 3 0.005 -v muscle=1 -v E=3000 -v nu=0.46 -v held=low >"$T/muscle"
    printf '0 force 0.04,0.0075,0.0075 0.02 0,0,0\n.05 force 0.04,0.0075,0.0075 0.02 5,0,0\n' >"$T/stretch"
    tled-run -q -d cpu -t 0.12 --dt 5e-5 -c all=0.3 -g 0,0,-9.81 --script "$T/stretch" $blemker --log "$T/log" \
        --log-every .0001 --results all <"$T/muscle" >"$T/out"
    below "$(balance "$T/log")" 1e-3 "energies balance"
    held=$(awk -F '\t' 'END { print $6 }' "$T/log")
    near "$(sinew info --get material.energy.tissue "$T/out")" "$held" 1e-8 "the material holds the log's strain energy"
    near "$(sinew info --get element.energy.mean "$T/out" | awk '{ printf "%.9g", $1 * 72 * 1.25e-7 }')" "$held" 1e-6 "so do elements"
    near "$(sinew info --get quality.hourglass "$T/out")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-6 \
        "sinew info has the same strain energy"
    tled-run -q -d cpu -t 0.12 --dt 5e-5 -m tissue.optimum=1.2 -m tissue.straight=1.1 --log "$T/log" --log-every .0001 \
        -c all=0.3 -g 0,0,-9.81 --script "$T/stretch" $blemker <"$T/muscle" >"$T/out"
    below "$(balance "$T/log")" 1e-3 "and with an optimum of 1.2"

    # Strong muscles at small steps. Their stress is that of the stretch of now, which has an energy, so that a smaller step
    # is only the more exact: no stress is kept while the tissue moves on. steps MODEL MUSCLES TIME DT...: of each run the
    # largest displacement, and what is not balanced as a share of what muscles did.
    steps() {
        model=$1
        muscles=$2
        time=$3
        shift 3
        for dt in "$@"; do
            tled-run -q -d cpu -t "$time" --dt "$dt" -c "$muscles" -m tissue.E=3000 -m tissue.nu=.46 $blemker --log "$T/log" \
                --log-every .0001 <"$model" >"$T/out" 2>"$T/said" || diag_file "$T/said"
            awk -F '\t' 'NR > 1 { off = off > $14 * $14 ? off : $14 * $14 } END { printf "%.7g %.3g\n", $15, sqrt(off) / $11 }' "$T/log"
        done
    }
    # judged NAME: displacements are the first run's to 1e-4; no balance is past 1e-3, and each is better than the one before.
    judged() {
        is "$(awk 'NR == 1 { u = $1; b = $2 } { far = $1 / u - 1; bad += far * far > 1e-8 || $2 > 1e-3 || $2 > b; b = $2 }
            END { print NR, bad + 0 }' "$T/steps")" "3 0" "$1: smaller steps move it as far, and balance better"
        diag_file "$T/steps"
    }
    steps "$T/muscle" all=1 .12 4e-5 1e-5 2.5e-6 >"$T/steps"
    judged "a block at full activation"
    if [ -n "${SINEW_LONG:-}" ] && [ -n "$DATA" ] && [ -f "$DATA/face/face_all.obj" ]; then
        voxelise -q --unit mm -s 4 --fraction 4 "$DATA/face/face_all.obj" 2>"$T/said" | attach -q >"$T/face" 2>>"$T/said"
        steps "$T/face" 'zyg*=1,ris*=1' .12 5e-5 2.5e-5 6.25e-6 >"$T/steps"
        judged "a face, four muscles at full activation"
    else
        skip 1 "SINEW_LONG is not set, or there is no face"
    fi
}

# ---- What is refused, and kept.
refuse_bar "a share of no peak" \
    "1 tled-run: material 'tissue' has passive=0.05, a share of the peak stress, but no peak stress; expected peak=PASCAL" \
    -m tissue.passive=.05 -m tissue.peak=0
refuse_bar "a velocity of no peak" \
    "1 tled-run: material 'tissue' has vmax=10, the velocity of its muscles, but no peak stress; expected peak=PASCAL" \
    -m tissue.vmax=10 -m tissue.peak=0
refuse_bar "an optimum out of range" "2 tled-run: -m tissue: 'optimum=3' is not allowed; expected 0.5 to 2" -m tissue.optimum=3
refuse_bar "a passive stress below 0" "2 tled-run: -m tissue: 'passive=-1' is not allowed; expected 0 to 10" -m tissue.passive=-1
refuse_bar "an exponent of 0" "2 tled-run: -m tissue: 'stiffening=0' is not allowed; expected 0.1 to 20" -m tissue.stiffening=0
refuse_bar "straight when short" "2 tled-run: -m tissue: 'straight=.9' is not allowed; expected 1 to 2" -m tissue.straight=.9
printf 'tissue peak=2e5 passive=.1 optimum=0.9\n' >"$T/materials"
tled-run -q -d cpu -n 1 --materials "$T/materials" <"$T/bar" >"$T/out"
is "$(sinew info --get material.passive "$T/out") $(sinew info --get material.optimum "$T/out")" "0.1 0.9" "a file of materials has the keys"
tled-run -q -d cpu -n 1 --text -m tissue.passive=0 <"$T/bar" >"$T/out"
is "$(grep -c 'material.passive' "$T/out")" 0 "passive=0 is as none"
done_testing
