#!/bin/sh
# Mooney-Rivlin tissue in tled-run: blocks that are pulled and pressed against closed forms and CalculiX, by every
# executor of the processor; beside neo-Hookean tissue, in mixed elements, with a muscle; its energies; its stable step.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh
# shellcheck source=tests/cli/tissue.sh
. tests/cli/tissue.sh

# rubber C10 C01 K: options for such tissue.
rubber() {
    echo "-m tissue.law=mooney-rivlin -m tissue.c10=$1 -m tissue.c01=$2 -m tissue.K=$3"
}
block 4 1 1 0.01 >"$T/bar"
grep -v '^meta lattice' "$T/bar" >"$T/mesh"
tissue=$(rubber 2500 500 1e5)
bar 2882.59 >"$T/pull"
bar -4677.80 >"$T/press"

# shellcheck disable=SC2046,SC2086 # options of a material are words
{
    check "pressed" sh -c "tled-run -q -d cpu --rest 1e-7 --script '$T/press' $tissue <'$T/bar' >'$T/out'"
    read -r long wide <<X
$(stretched "$T/out")
X
    near "$long" 0.8 1e-5 "pressed by 4677.80 Pa to .8"
    check "pulled" sh -c "tled-run -q -d cpu --rest 1e-7 --log '$T/log' --script '$T/pull' $tissue <'$T/bar' >'$T/out'"
    read -r long wide <<X
$(stretched "$T/out")
X
    near "$long" 1.2 1e-5 "pulled by 2882.59 Pa to 1.2"
    near "$wide" 0.918060 1e-5 "and its sides"

    near "$(awk -F '\t' 'END { print $6 / 4e-6 }' "$T/log")" "$(awk 'BEGIN {
        l = 1.2; w = .918060; j = l * w * w; i1 = l * l + 2 * w * w; i2 = 2 * l * l * w * w + w ^ 4
        print 2500 * (i1 * j ^ (-2 / 3) - 3) + 500 * (i2 * j ^ (-4 / 3) - 3) + 5e4 * (j - 1) ^ 2 }')" 1e-4 \
        "the log's strain energy is W V"

    for model in bar mesh; do
        for precision in double single; do
            same_by_sets "1 2" $precision $model --precision $precision --rest 1e-4 --script "$T/pull" $tissue
            near "$(stretched "$T/same" | cut -d ' ' -f 1)" 1.2 1e-4 "$model, $precision: pulled to 1.2"
        done
    done

    # Nearly incompressible, far: CalculiX gives 9.127662 N on 1 m2.
    block 1 1 1 0.01 >"$T/one"
    { echo "$planes"; echo "0 force 0.01,0.005,0.005 0.008 9.127662e-4,0,0"; } >"$T/far"
    tled-run -q -d cpu --rest 1e-7 --script "$T/far" $(rubber 3 2 2000) <"$T/one" >"$T/out"
    near "$(sinew info --get node.displacement.at.0.01,0.01,0.01 "$T/out" | awk '{ print 1 + $1 / 0.01 }')" 1.5 1e-5 \
        "c10 3, c01 2, K 2000: 9.127662 Pa stretch it by 1.5"
    if have ccx; then
        near "$(calculix MOONEY-RIVLIN "3, 2, 0.001" 1.5)" 9.127662 1e-6 "and CalculiX agrees"
    else
        skip 1 "no CalculiX (calculix-ccx)"
    fi

    # Without c01 it is neo-Hookean of mu = 2 c10.
    mu=$(awk 'BEGIN { printf "%.17g", 3000 / 2.9 / 2 }')
    awk -v nx=6 -v ny=3 -v nz=3 -v h=0.01 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/muscle"
    tled-run -q -d cpu -t 0.1 -c all=0.5 -g 0,0,-9.81 <"$T/muscle" >"$T/out"
    tled-run -q -d cpu -t 0.1 -c all=0.5 -g 0,0,-9.81 $(rubber "$mu" 0 10000) <"$T/muscle" >"$T/same"
    near "$(sinew info --get node.displacement.at.0.06,0.03,0.03 "$T/same" | cut -d ' ' -f 1)" \
        "$(sinew info --get node.displacement.at.0.06,0.03,0.03 "$T/out" | cut -d ' ' -f 1)" 1e-8 \
        "a muscle in tissue without c01 shortens as one in neo-Hookean tissue"
    tled-run -q -d cpu -t 0.1 -c all=0.5 -g 0,0,-9.81 $tissue --log "$T/log" <"$T/muscle" >"$T/out"
    is "$(awk -F '\t' 'END { off = $14 / $11; print (off < .01 && off > -.01) }' "$T/log")" 1 \
        "a muscle in Mooney-Rivlin tissue: energies balance to 1 %"
    near "$(sinew info --get quality.hourglass "$T/out")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-6 \
        "and sinew info has the energies of the log"

    # The stable step, at rest and deformed.
    fails 1 "a longer step than is stable at rest" 'stable' sh -c "tled-run -q -d cpu --dt 0.000578 $tissue <'$T/muscle'"
    check "nine tenths of it" sh -c "tled-run -d cpu --dt 0.00052 -t 0.3 -g 0,0,-1 $tissue <'$T/muscle' >'$T/out'"
    printf '0 displace 0.06,-1,-1,1,1,1 0,0,0\n0.2 displace 0.06,-1,-1,1,1,1 -0.025,0,0\n' >"$T/script"
    fails 3 "pressed until that is too long" 'has a stable step of 0.5[0-9]* ms now, below the step of 0.52 ms' \
        sh -c "tled-run -q -d cpu --dt 0.00052 -t 0.3 --script '$T/script' $tissue <'$T/muscle' >'$T/out'"
    check "which is cut by itself" \
        sh -c "tled-run -q -d cpu -t 0.3 --script '$T/script' $tissue <'$T/muscle' >'$T/out'"
}

# Elements mixed of Mooney-Rivlin and neo-Hookean tissue: where strains are small, as of two that are neo-Hookean.
printf 'skin surfaces=skin material=soft\nhard level=1 surfaces=hard material=hard\n' >"$T/volumes"
printf 'g rigid\nv 0 -9 -9\nv 0 9 -9\nv 0 9 9\nv 0 -9 9\nf 1 2 3 4\n' >"$T/wall.obj"
printf '0 force 0.08,0.005,0.005 0.008 0.00003,0,0\n' >"$T/script"
# pull LAW-AND-KEYS...: how far the end of a bar comes to rest, mm, whose border at 43 mm leaves the fifth voxel .3 of the soft.
pull() {
    printf 'soft %s density=1000\nhard E=12000 nu=0 density=1500\n' "$*" >"$T/materials"
    {
        box skin 0 0 0 80 10 10
        box hard 43 0 0 80 10 10
    } >"$T/mixed.obj"
    voxelise -q --unit mm -s 10 --volumes "$T/volumes" --materials "$T/materials" --fraction 10 "$T/mixed.obj" \
        2>"$T/said" | attach -q --fibre axis --rigid-file "$T/wall.obj" 2>>"$T/said" |
        tled-run -q -d cpu --rest 1e-7 --script "$T/script" --log "$T/log" >"$T/mixed"
    sinew info --get node.displacement.at.0.08,0,0 "$T/mixed" | awk '{ printf "%.9g", 1000 * $1 }'
}
one=$(pull E=3000 nu=0)
near "$(pull law=mooney-rivlin c10=500 c01=250 nu=0)" "$one" 1e-3 "a mixed element lies between its two laws"
near "$(sinew info --get quality.hourglass "$T/mixed")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-5 \
    "and sinew info has its energies"

done_testing
