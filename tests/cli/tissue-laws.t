#!/bin/sh
# Laws of tissue in tled-run: bars that are pulled and pressed against figures of a script that shares no code with
# Sinew, cubes against CalculiX, by every executor of the processor; energies, and the stable step. Neo-Hookean and
# Mooney-Rivlin tissue have tests of their own.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/cli/tissue.sh
. tests/cli/tissue.sh
# shellcheck source=tests/cli/boxes.sh
. tests/cli/boxes.sh

awk -v nx=4 -v ny=1 -v nz=1 -v h=0.01 -v muscle=1 -f tests/cli/block.awk >"$T/bar"
grep -v '^meta lattice' "$T/bar" >"$T/mesh"
awk -v nx=6 -v ny=3 -v nz=3 -v h=0.01 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/muscle"
grep -v '^meta lattice' "$T/muscle" >"$T/muscle_mesh"

# pulls MODEL PRECISION REST TOLERANCE STRETCH PRESSURE TISSUE NAME: the bar's end comes to rest there.
pulls() {
    bar "$6" >"$T/script"
    # shellcheck disable=SC2086 # options of a material are words
    tled-run -q -d cpu --precision "$2" --rest "$3" --script "$T/script" $7 <"$T/$1" >"$T/out"
    near "$(stretched "$T/out" | cut -d ' ' -f 1)" "$5" "$4" "$8, $1, $2: $6 Pa, $5 of its length"
}

# balanced LOG NAME: to 1e-3 of the work that is done.
balanced() {
    is "$(awk -F '\t' 'END { off = $14 / ($8 + $11); print (off < .001 && off > -.001) }' "$1")" 1 "$2: energies balance to 1e-3"
}

# LAW-AND-KEYS|P(1.2)|side there|P(.8)
while IFS='|' read -r law far side near; do
    # shellcheck disable=SC2046,SC2086 # options of a material are words
    {
        tissue=$(of $law)
        name=${law%% *}
        pulls bar double 1e-7 1e-5 0.8 "$near" "$tissue" "$name"
        pulls bar double 1e-7 1e-5 1.2 "$far" "$tissue" "$name"
        near "$(stretched "$T/out" | cut -d ' ' -f 2)" "$side" 1e-5 "$name: its sides"
        pulls bar single 2e-5 1e-4 1.2 "$far" "$tissue" "$name"
        pulls mesh double 1e-6 1e-5 1.2 "$far" "$tissue" "$name"
        [ "$SINEW_LONG" ] && pulls mesh single 2e-5 1e-4 1.2 "$far" "$tissue" "$name"

        # A muscle that contracts at once, gravity: energies balance to 1e-3 of the work of the muscle.
        tled-run -q -d cpu --dt 5e-5 -t 0.1 -c all=0.5 -g 0,0,-9.81 $tissue --log "$T/log" <"$T/muscle" >"$T/out"
        balanced "$T/log" "$name"
        near "$(sinew info --get quality.hourglass "$T/out")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-6 \
            "$name: and sinew info has the energies of the log"

        # The same bytes by each instruction set.
        for precision in double single; do
            for model in muscle muscle_mesh; do
                same_by_sets 2 "$name, $precision" $model --precision $precision -n 20 -c all=0.5 -g 9,2,-9.81 $tissue
            done
        done
    }
done <<'END'
yeoh c10=2500 c20=1175 c30=0 K=1e5|2710.89|.917755|-4229.39
yeoh c10=400 c20=1400 nu=.46|643.062|.924556|-1103.26
arruda-boyce mu=3e3 lock=1.4 K=1e5|2392.97|.917189|-3655.78
veronda-westmann c1=1e3 c2=3 K=1e5|2790.32|.917896|-3964.01
ogden mu1=1e3 a1=2 mu2=200 a2=-4 K=1e5|582.663|.913932|-983.689
fung c=2e3 bf=8 bt=2 bfs=4 K=1e5|6733.678|.9147474|-4182.077
END

# Parts of elements, mixed of laws that only one form has together: energies balance, sinew info finds those of the log by
# the laws themselves, and sets of instructions have the same bytes.
{
    box skin 0 0 0 38 17 20
    box hard 13 0 0 38 17 20
    box core 26 0 0 38 17 20
} >"$T/mixed.obj"
printf 'skin surfaces=skin material=skin\nhard level=1 surfaces=hard material=hard\ncore level=2 surfaces=core material=core\n' >"$T/volumes"
printf '%s\n' 'skin law=veronda-westmann c1=300 c2=3 nu=.45' 'hard law=ogden mu1=900 a1=3 mu2=300 a2=-5 nu=.45' \
    'core law=mooney-rivlin c10=400 c01=300 nu=.45' >"$T/materials"
printf 'g rigid\nv 0 -9 -9\nv 0 29 -9\nv 0 29 29\nv 0 -9 29\nf 1 2 3 4\n' >"$T/wall.obj"
voxelise -q --unit mm -s 5 --volumes "$T/volumes" --materials "$T/materials" --fraction 10 "$T/mixed.obj" 2>"$T/said" |
    attach -q --rigid-file "$T/wall.obj" -o "$T/mixed" 2>>"$T/said"
is "$(sinew info "$T/mixed" | grep -c -e 'element.fraction' -e 'element.mixture')" 2 "a model of parts of elements, and of mixed ones"
tled-run -q -d cpu --dt 2e-5 -t 0.05 --damping 0 -g 30,0,-30 --log "$T/log" <"$T/mixed" >"$T/out"
balanced "$T/log" "three laws"
near "$(sinew info --get quality.hourglass "$T/out")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-6 "and sinew info has the energies of the log"
for precision in double single; do
    same_by_sets 2 "three laws, $precision" mixed --precision $precision -n 20 -g 30,9,-30
done

# Cubes of 1 m, K 2000, stretched by 1.5 as CalculiX stretches them, by so much force. Of another volumetric energy the
# figure is to 1 %.
while IFS='|' read -r law keys deck force tolerance; do
    block 1 1 1 0.01 >"$T/one"
    { echo "$planes"; echo "0 force 0.01,0.005,0.005 0.008 ${force}e-4,0,0"; } >"$T/far"
    # shellcheck disable=SC2046,SC2086 # options of a material are words
    tled-run -q -d cpu --rest 1e-7 --script "$T/far" $(of $law $keys K=2000) <"$T/one" >"$T/out"
    near "$(sinew info --get node.displacement.at.0.01,0.01,0.01 "$T/out" | awk '{ print 1 + $1 / 0.01 }')" 1.5 "$tolerance" \
        "$law $keys, K 2000: $force Pa stretch it by 1.5"
    if have ccx; then
        near "$(calculix "${deck%%:*}" "${deck#*:}" 1.5)" "$force" 1e-6 "and CalculiX agrees"
    else
        skip 1 "no CalculiX (calculix-ccx)"
    fi
done <<'END'
yeoh|c10=5 c20=2 c30=1|YEOH:5, 2, 1, 0.001, 0, 0|17.48151|1e-5
arruda-boyce|mu=10 lock=1.7|ARRUDA-BOYCE:10, 1.7, 0.001|14.75582|1e-4
ogden|mu1=4 a1=3 mu2=1 a2=-2|OGDEN, N=2:4, 3, 1, -2, 0.001, 0|5.725990|1e-5
END

done_testing
