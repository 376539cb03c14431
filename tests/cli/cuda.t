#!/bin/sh
# tled-run on a card, through its command line: the choice and what is said of it; on a card, every model of the samples, one
# of all that a script can do and the real face, against the CPU in double precision. SINEW_MODELS names a folder of models to use
# instead where voxelise is not to be had.
. "$(dirname "$0")/lib.sh"

awk -v nx=12 -v ny=9 -v nz=7 -v h=0.005 -v held=low -f tests/cli/block.awk >"$T/block.sinew"
awk -v nx=12 -v ny=6 -v nz=5 -v h=0.0025 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/muscle.sinew"
awk -v nx=12 -v ny=6 -v nz=5 -v h=0.0025 -v held=low -v muscle=1 -v cut=sides -v moments=1 -f tests/cli/block.awk >"$T/cut.sinew"
run() { # FILE ARG...
    from=$1
    shift
    tled-run "$@" <"$from"
}

# ---- The choice.
if ! tled-run -q -d cuda -n 1 <"$T/block.sinew" >"$T/out" 2>"$T/err"; then
    run "$T/block.sinew" -n 1 >"$T/auto" 2>"$T/said"
    is $? 0 "-d auto takes the CPU"
    if grep -q 'this build has no CUDA' "$T/err"; then
        why='this build has no CUDA back end; have: cpu$'
    else
        why='the cuda back end cannot be used here: [a-z]'
        check "-d auto says what it took, and why" grep -q ' cpu (cuda: ' "$T/said"
    fi
    fails 1 "-d cuda fails, and says why" "$why" run "$T/block.sinew" -d cuda -n 1
    is "$(wc -l <"$T/stderr" | tr -d ' ')" 1 "in one line"
    skip 1 "the rest: $(sed 's/.*: //' "$T/err" | head -n 1)"
    done_testing
fi
run "$T/block.sinew" -n 1 >"$T/out" 2>"$T/err"
check "-d auto takes the card, and says so" grep -q 'held; cuda, double' "$T/err"
sinew info <"$T/out" >"$T/info"
check "what ran is in provenance" grep -q '\[cuda double,' "$T/info"

# ---- Against the CPU.
same() { # NAME FILE ARG...: 10,000 steps; single precision there to 1e-4 of the largest displacement of double here
    name=$1 file=$2
    shift 2
    run "$file" -q -d cpu -n 10000 "$@" >"$T/cpu"
    most=$(sinew info --get node.displacement.max <"$T/cpu")
    near "$(awk -v m="$most" 'BEGIN { print (m > 1e-5) }')" 1 0 "$name moves: $most m"
    for precision in single double; do
        run "$file" -q -d cuda --precision "$precision" -n 10000 "$@" >"$T/cuda"
        check "$name: $precision there, double here, to 1e-4" sinew diff --only node.displacement \
            --abs "$(awk -v m="$most" 'BEGIN { print 1e-4 * m }')" "$T/cpu" "$T/cuda"
        diag "$(sinew diff --only node.displacement "$T/cpu" "$T/cuda" | tail -n 1)"
    done
}
cat >"$T/script" <<'SCRIPT'
0    gravity 0,0,0
0.02 gravity 0,1,-9.81
0    force 0.06,0.045,0.035 0.02 0,0,0
0.03 force 0.06,0.045,0.035 0.02 .002,.001,0
0    displace 0.055,-1,-1,1,0.001,1 -,0,0
0.04 displace 0.055,-1,-1,1,0.001,1 -,0.002,-0.003
SCRIPT
same "a script" "$T/block.sinew" --script "$T/script"
same "a muscle" "$T/muscle.sinew" -c all=0.5 -g 0,0,-9.81
same "cut elements" "$T/cut.sinew" -c all=0.5 -g 0,0,-9.81
run "$T/cut.sinew" -q -d cpu -n 500 -c all=0.1 -g 0,0,-9.81 >"$T/cpu"
run "$T/cut.sinew" -q -d cuda -n 500 -c all=0.1 -g 0,0,-9.81 >"$T/cuda"
check "and the CPU's bytes" sinew diff --only node.displacement,node.velocity "$T/cpu" "$T/cuda"
# ---- Nodes that slide on a ball: bytes, logs, runs to rest and in two parts.
awk -v nx=12 -v ny=12 -v nz=4 -v h=0.0025 -f tests/cli/block.awk | awk -v nx=12 -v ny=12 -v h=0.0025 -v R=.08 -v lifts=1 -f tests/cli/slide.awk >"$T/slides.sinew"
same "nodes that slide" "$T/slides.sinew" -g .4,.2,-9.81
printf '0 gravity .4,.2,-9.81\n0 displace -1,-1,-1,.0001,1,1 0,0,0\n' >"$T/side"
for device in cpu cuda; do
    run "$T/slides.sinew" -q -d $device -n 2000 -g .4,.2,-9.81 --friction .3 --log-every .01 --log "$T/slid.$device.log" >"$T/slid.$device"
    run "$T/slides.sinew" -q -d $device -n 1000 -g .4,.2,-9.81 --friction .3 | tled-run -q -d $device -n 1000 -g .4,.2,-9.81 --friction .3 >"$T/parts.$device"
    run "$T/slides.sinew" -q -d $device --script "$T/side" >"$T/rests.$device"
done
check "and the CPU's bytes" sinew diff --only node.displacement,node.velocity "$T/slid.cpu" "$T/slid.cuda"
check "in two parts as well" sinew diff --only node.displacement,node.velocity "$T/parts.cpu" "$T/parts.cuda"
check "and at rest" sinew diff --only node.displacement --abs 1e-8 "$T/rests.cpu" "$T/rests.cuda"
# ---- A probe on nodes that slide, and a convex one.
awk 'BEGIN { for (i = 0; i <= 20; i++) printf "%.3f .016 .014 %.5f 1 0 0 0\n", i / 200, .0101 - i * 5e-5 }' >"$T/press.tum"
cp tests/cli/cube.obj "$T"
same "a probe" "$T/slides.sinew" -g .4,.2,-9.81 --probe curved:2cm,60,8mm --poses "$T/press.tum"
same "a convex probe" "$T/slides.sinew" -g .4,.2,-9.81 --unit mm --probe "convex:$T/cube.obj" --poses "$T/press.tum"
for device in cpu cuda; do
    run "$T/slides.sinew" -q -d $device -n 1000 -g .4,.2,-9.81 --friction .3 --probe sphere:1cm --poses "$T/press.tum" --every .01 >"$T/pressed.$device"
done
check "in double the CPU's numbers but for rounding, and what presses" sinew diff --abs 1e-9 "$T/pressed.cpu" "$T/pressed.cuda"
logged() { # NAME ARG...: the CPU's log in columns 1 to 13, and how many elements of muscles fall
    name=$1
    shift
    for device in cpu cuda; do
        run "$T/muscle.sinew" -q -d $device -c all=0.5 -t .2 "$@" --log-every .001 --log "$T/log.$device" >"$T/logged.$device"
    done
    run "$T/muscle.sinew" -q -d cuda -c all=0.5 -t .2 "$@" | cmp - "$T/logged.cuda"
    is $? 0 "$name: a log leaves the result as it is"
    is "$(awk -F '\t' 'FNR == 1 { for (i = 1; i <= NF; i++) if ($i == "muscles.falling") falling = i }
        NR == FNR { for (i = 1; i <= 13; i++) there[FNR, i] = $i; fell[FNR] = $falling; next }
        FNR == 1 { next }
        { for (i = 1; i <= 13; i++) { off = $i - there[FNR, i]; if (i != 4 && off * off > 1e-12 * $11 * $11 + 1e-24) print FNR, i } }
        $falling != fell[FNR] { print FNR, "falling" }
        END { if (FNR != 202) print FNR }' "$T/log.cpu" "$T/log.cuda")" "" "$name: and says what the CPU's says"
}
logged "a muscle"
hgo='-m tissue.fibre=hgo -m tissue.k1=2e4 -m tissue.k2=2'
# shellcheck disable=SC2086 # options of a material are words
{
    same "fibres that resist being stretched" "$T/muscle.sinew" -g 0,2,-9.81 -m tissue.fibre=quadratic -m tissue.eta=2e4
    same "the law fung" "$T/muscle.sinew" -g 0,2,-9.81 -m tissue.law=fung -m tissue.c=500 -m tissue.bf=8 -m tissue.bt=2 -m tissue.bfs=4 -m tissue.nu=.45
    same "a passive muscle with fibres" "$T/muscle.sinew" -c all=0.5 -g 0,0,-9.81 $hgo -m tissue.passive=0.05 -m tissue.optimum=0.9
    logged "a passive muscle with fibres" $hgo -m tissue.passive=0.05 -m tissue.optimum=0.9
    same "a muscle with vmax" "$T/muscle.sinew" -c all=0.5 -g 0,0,-9.81 -m tissue.vmax=10
    logged "a muscle with vmax" -m tissue.vmax=10
    run "$T/muscle.sinew" -q -d cpu -n 500 -c all=0.5 $hgo -m tissue.kappa=.1 >"$T/cpu"
    run "$T/muscle.sinew" -q -d cuda -n 500 -c all=0.5 $hgo -m tissue.kappa=.1 >"$T/cuda"
    check "and the CPU's bytes" sinew diff --only node.displacement,node.velocity "$T/cpu" "$T/cuda"
}
# Hertz: see tests/cli/tled-probe.t.
hertz() { # WHAT OPTION...
    what=$1
    shift
    awk -v W=60 -v H=20 -v R=120 -v D=.3 -v what="$what" "$@" -f tests/cli/hertz.awk
}
hertz poses >"$T/layer.tum"
hertz script -v still=1 >"$T/layer.script"
if [ -z "$SINEW_MODELS" ] && have voxelise; then
    SINEW_MODELS=$T
    hertz layer >"$T/layer.obj"
    voxelise -q --unit mm -s 2 "$T/layer.obj" | attach -q >"$T/layer.model"
    make -s -C samples OUT="$T" SINEW_BIN="$SINEW_BIN" "$T/sphere.model" "$T/muscle.model" "$T/block.model" "$T/head.model"
    [ -z "$DATA" ] || voxelise -q --unit mm -s 2.5 "$DATA/face/face_zyg.obj" | attach -q >"$T/face_2.5.model"
fi
[ -e "$SINEW_MODELS/face_2.5.model" ] || skip 1 "no real face here"
for model in "$SINEW_MODELS"/*.model; do
    case ${model##*/} in
    layer*)
        for precision in single double; do
            run "$model" -q -d cuda --text --precision $precision -m tissue.nu=.45 --script "$T/layer.script" --probe sphere:120mm --poses "$T/layer.tum" \
                --repulsion 4 --damping 200 -t .13 >"$T/pressed" 2>/dev/null
            near "$(awk -v want="$(hertz force -v E=3000 -v nu=.45)" '/^array/ { what = $2; next } what == "probe.force" { print $3 / want; exit }' "$T/pressed")" 1 .03 \
                "a ball presses as the bonded layer's formula says, $precision"
        done
        continue
        ;;
    sphere*) set -- -g 0,-9.81,0 ;;
    muscle*) set -- -c muscle=0.4 ;;
    block*) set -- --script samples/block.script ;;
    head*) set -- -c zyg_left=0.4,zyg_right=0.4 ;;
    face*) set -- -c zyg_xneg=0.4,zyg_xpos=0.2 ;;
    *) continue ;;
    esac
    same "${model##*/}" "$model" "$@"
done

# ---- Frames, and going on.
run "$T/muscle.sinew" -q -d cuda -c all=0.5 -t 0.5 --every 0.0166666666666666667 >"$T/a"
run "$T/muscle.sinew" -q -d cpu -c all=0.5 -t 0.5 --every 0.0166666666666666667 >"$T/b"
check "frames are the CPU's" sinew diff --abs 1e-9 "$T/a" "$T/b"
run "$T/muscle.sinew" -q -d cuda -c all=0.5 -t 0.25 | tled-run -q -d cuda -c all=0.5 -t 0.25 | sinew info --get node.displacement.max >"$T/in_two"
is "$(cat "$T/in_two")" "$(sinew info --get node.displacement.max <"$T/a")" "a run in two parts"
run "$T/muscle.sinew" -q -d cuda --precision single -c all=0.5 -t 0.25 --every 0.01 >"$T/first"
different=0
for _ in 1 2 3 4 5; do
    run "$T/muscle.sinew" -q -d cuda --precision single -c all=0.5 -t 0.25 --every 0.01 | cmp -s - "$T/first" || different=1
done
is "$different" 0 "the same bytes, run after run"
fails 3 "a step too large diverges, with its element" 'diverged at step [0-9]+, .* element [0-9]+ \(volume .muscle_all.\)' \
    run "$T/muscle.sinew" -d cuda -c all=1 --ramp 0.01 --dt 0.00019 -t 1
done_testing
