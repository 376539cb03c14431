#!/bin/sh
# Fibres that resist being stretched, in tled-run: bars along their fibres against closed forms, by every executor of
# the processor; two families at an angle; what is mixed, and what is a muscle too; the energies; the stable step; what
# is refused.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/cli/tissue.sh
. tests/cli/tissue.sh

# stretched FILE: of a bar, its length and its sides, as shares of those at rest.
stretched() {
    sinew info --get node.displacement.at.0.04,0.01,0.01 "$1" |
        awk '{ printf "%.7f %.7f %.7f", 1 + $1 / 0.04, 1 + $2 / 0.01, 1 + $3 / 0.01 }'
}
# directed FILE ARRAY X Y Z: a model with such directions in all elements.
directed() {
    awk -v name="$2" -v row="$3 $4 $5" '
        /^axis element/ { n = $3 }
        $1 == "array" && $2 == name { skip = 1; next }
        $1 == "array" || $1 == "end" { skip = 0 }
        $1 == "array" && $2 == "volume.name" { print "array " name " f32 1 element 3"; for (i = 0; i < n; i++) print row }
        !skip' "$1"
}

block 4 1 1 0.01 -v muscle=1 >"$T/bar"
grep -v '^meta lattice' "$T/bar" >"$T/mesh"
rubber='-m tissue.law=mooney-rivlin -m tissue.c10=5000 -m tissue.c01=0 -m tissue.K=5e5'
hgo='-m tissue.fibre=hgo -m tissue.k1=2e4 -m tissue.k2=2'

# shellcheck disable=SC2086 # options of a material are words
{
    # pull NAME PRESSURE LENGTH SIDE OPTIONS...
    pull() {
        name=$1 length=$3 side=$4
        bar "$2" >"$T/script"
        shift 4
        check "$name" sh -c "tled-run -q -d cpu --rest 1e-7 --log '$T/log' --script '$T/script' $rubber $* <'$T/bar' >'$T/out'"
        near "$(stretched "$T/out" | cut -d ' ' -f 1)" "$length" 1e-5 "$name: its length"
        near "$(stretched "$T/out" | cut -d ' ' -f 2)" "$side" 1e-5 "and its sides"
    }
    pull "hgo, pressed: its fibres are slack" -7582.10 .8 1.115762 $hgo
    pull "hgo, kappa .1" 18961.8 1.2 .913519 $hgo -m tissue.kappa=.1
    # And a passive muscle, which has 41151.3 Pa at that stretch.
    pull "hgo in a passive muscle" 77272.4 1.2 .914693 $hgo -m tissue.passive=.05 -m tissue.peak=3e5
    tled-run -q -d cpu --rest 1e-7 --script "$T/script" $rubber $hgo -m tissue.passive=.05 -m tissue.peak=3e5 <"$T/mesh" >"$T/out"
    near "$(stretched "$T/out" | cut -d ' ' -f 1)" 1.2 1e-5 "without a lattice too"
    pull "hgo" 36121.1 1.2 .914693 $hgo
    near "$(awk -F '\t' 'END { print $6 / 4e-6 }' "$T/log")" "$(awk 'BEGIN {
        l = 1.2; w = .914693; j = l * w * w; x = l * l - 1
        print 5000 * ((l * l + 2 * w * w) * j ^ (-2 / 3) - 3) + 2.5e5 * (j - 1) ^ 2 + 5000 * (exp(2 * x * x) - 1) }')" 1e-5 \
        "the log's strain energy is W V"
    sinew results stress,material.energy <"$T/out" >"$T/stressed"
    near "$(sinew info --get element.stress.row.2 "$T/stressed" | cut -d ' ' -f 1)" "$(awk 'BEGIN { print 36121.1 / .914693 ^ 2 }')" 1e-4 \
        "sinew results has their stress"
    near "$(sinew info --get material.energy.tissue "$T/stressed")" "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-6 "and their energy"
    is "$(sinew info "$T/out" | grep -c 'fibre=hgo k1=20000 k2=2$')" 1 "sinew info has their keys"

    for model in bar mesh; do
        for precision in double single; do
            same_by_sets "1 2" $precision $model --precision $precision --rest 1e-4 --script "$T/script" $rubber $hgo
            near "$(stretched "$T/same" | cut -d ' ' -f 1)" 1.2 1e-4 "$model, $precision: pulled to 1.2"
        done
    done

    # Two families in the plane x y: P11 = P_yy's and P_zz's being 0, of the energy by difference quotients.
    directed "$T/bar" element.normal 0 0 1 >"$T/skin"
    bar 1500 >"$T/script"
    soft='-m tissue.E=3000 -m tissue.nu=.3 -m tissue.fibre=quadratic -m tissue.eta=2000 -m tissue.angle=30'
    tled-run -q -d cpu --rest 1e-7 --script "$T/script" $soft <"$T/skin" >"$T/out"
    is "$(stretched "$T/out" | awk '
        function w(l, y, z,   j, x) {
            j = l * y * z
            x = .75 * l * l + .25 * y * y - 1
            return mu / 2 * ((l * l + y * y + z * z) * j ^ (-2 / 3) - 3) + K / 2 * (j - 1) ^ 2 + 2 * 2000 / 2 * x * x
        }
        {
            mu = 3000 / 2.6; K = 3000 / 1.2; d = 1e-4
            x = (w($1 + d, $2, $3) - w($1 - d, $2, $3)) / (2 * d)
            y = (w($1, $2 + d, $3) - w($1, $2 - d, $3)) / (2 * d)
            z = (w($1, $2, $3 + d) - w($1, $2, $3 - d)) / (2 * d)
            print (x > 1499 && x < 1501 && y * y < 1 && z * z < 1 && $2 < $3)
        }')" 1 "two families at 30 degrees: pulled by 1500 Pa, and their plane narrows more"

    # A muscle has both. Energies balance, and sinew info has those of the log.
    awk -v nx=6 -v ny=3 -v nz=3 -v h=0.01 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/muscle"
    tled-run -q -d cpu -t 0.1 --dt 5e-5 --damping 0 --ramp 0.1 -c all=0.3 -g 0.5,0,-1 --log "$T/log" $hgo <"$T/muscle" >"$T/out"
    is "$(awk -F '\t' 'NR > 1 { off = $14 < 0 ? -$14 : $14; if (off > most) most = off; if ($6 > held) held = $6 }
        END { print (held > 0 && most < .001 * held) }' "$T/log")" 1 \
        "a muscle with passive fibres, undamped: energies balance to 1e-3"
    near "$(sinew info --get quality.hourglass "$T/out")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-6 \
        "and sinew info has the energies of the log"
    check "and sinew render its stress" \
        sh -c "sinew render -q --size 300x200 --colour stress -o '$T/picture.png' '$T/out'"

    # The stable step counts on fibres that are pulled: along x of cubes here, mu 1e4, K = 5e5, k1 2e4 from 4 k1.
    fails 1 "a longer step than is stable at rest" 'stable' sh -c "tled-run -q -d cpu --dt 0.00027 $rubber $hgo <'$T/muscle'"
    check "not with softer fibres" \
        sh -c "tled-run -q -d cpu --dt 0.000257 -n 2 $rubber -m tissue.fibre=quadratic -m tissue.eta=1 <'$T/muscle' >'$T/out'"
    fails 1 "which these fibres refuse" 'stable' \
        sh -c "tled-run -q -d cpu --dt 0.000257 -n 2 $rubber -m tissue.fibre=quadratic -m tissue.eta=8e4 <'$T/muscle' >'$T/out'"

    # What has no direction.
    directed "$T/bar" element.fibre 0 0 0 >"$T/lost"
    fails 1 "no direction at all" "volume 'muscle_all' has fibres that resist being stretched, but no element of it has a direction" \
        sh -c "tled-run -q -d cpu -n 1 $hgo <'$T/lost'"
    awk '/^1 0 0$/ && !n++ { print "0 0 0"; next } 1' "$T/bar" >"$T/lost"
    check "one without" sh -c "tled-run -d cpu -n 1 $hgo <'$T/lost' >'$T/out'"
    is "$(grep -c "1 of 4 elements of volume 'muscle_all' have no direction" "$T/stderr")" 1 "is told"
    awk -v nx=1 -v ny=1 -v nz=1 -v h=0.01 -f tests/cli/block.awk >"$T/none"
    fails 1 "no array of directions" 'the model has no element.fibre' sh -c "tled-run -q -d cpu -n 1 $hgo <'$T/none'"
    fails 1 "an angle without normals" 'at an angle' sh -c "tled-run -q -d cpu -n 1 $soft <'$T/bar'"

    # Keys.
    fails 2 "no such kind" "fibre 'hog'" sh -c "tled-run -q -n 1 -m tissue.fibre=hog <'$T/bar'"
    fails 2 "a key too few" 'fibre=hgo without k2' sh -c "tled-run -q -n 1 -m tissue.fibre=hgo -m tissue.k1=1 <'$T/bar'"
    fails 2 "a key of another kind" "'k1' is not a key of fibre=quadratic" \
        sh -c "tled-run -q -n 1 -m tissue.fibre=quadratic -m tissue.eta=1 -m tissue.k1=1 <'$T/bar'"
    fails 2 "a key without a kind" "'k1' without fibres" sh -c "tled-run -q -n 1 -m tissue.k1=1 <'$T/bar'"
    fails 2 "a dispersion past all round" 'kappa=.4' sh -c "tled-run -q -n 1 $hgo -m tissue.kappa=.4 <'$T/bar'"
    tled-run -q --text -d cpu -n 1 $hgo <"$T/bar" >"$T/out"
    tled-run -q --text -d cpu -n 1 -m tissue.fibre=none <"$T/out" >"$T/without" 2>"$T/said"
    is "$(grep -c 'material.k1\|material.fibre' "$T/without")" 0 "fibre=none drops them"
    sed '/^crc/d; s/"hgo"/"hog"/' "$T/out" >"$T/wrong"
    fails 1 "a model with another kind" "fibre 'hog'" sh -c "tled-run -q -n 1 <'$T/wrong'"
    sed '/^crc/d; /^array material.k2/,+1d' "$T/out" >"$T/wrong"
    fails 1 "a model without a key" 'material.k2' sh -c "tled-run -q -n 1 <'$T/wrong'"
    fails 1 "not for Abaqus" "fibres that resist being stretched" sinew export -f inp -o "$T/out.inp" "$T/out"
}

# Mixed of two volumes: energies add by shares. A border at 45 mm halves the fifth voxel of eight.
. tests/cli/boxes.sh
printf 'skin surfaces=skin material=soft\nhard level=1 surfaces=hard material=hard\n' >"$T/volumes"
printf 'soft E=3000 nu=0.3 density=1000\nhard E=3000 nu=0.3 density=1000 fibre=quadratic eta=6000\n' >"$T/materials"
{
    box skin 0 0 0 80 10 10
    box hard 45 0 0 80 10 10
} >"$T/mixed.obj"
voxelise -q --text --unit mm -s 10 --volumes "$T/volumes" --materials "$T/materials" --fraction 10 "$T/mixed.obj" >"$T/text"
directed "$T/text" element.fibre 1 0 0 >"$T/both"
directed "$T/both" element.mixfibre 1 0 0 >"$T/mixed"
{
    echo "$planes" | sed 's/,1 /,1 /'
    echo "0 force 0.08,0.005,0.005 0.008 0.06,0,0"
} >"$T/script"
tled-run -q -d cpu --rest 1e-7 --log "$T/log" --script "$T/script" <"$T/mixed" >"$T/out"
near "$(sinew info --get quality.hourglass "$T/out")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-5 \
    "mixed elements: sinew info has the energies of the log"
sinew results material.energy <"$T/out" >"$T/energies"
near "$(for name in soft hard; do sinew info --get material.energy.$name "$T/energies"; done | awk '{ e += $1 } END { printf "%.12g", e }')" \
    "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-6 "energies by material add up to the log's"
# By a law that does not stiffen, and by one that does, which hourglass control follows.
for other in 'E=3000' 'law=yeoh c10=500 c20=300 nu=.45'; do
    # shellcheck disable=SC2046,SC2086 # options of a material are words
    tled-run -q -d cpu --rest 1e-7 --log "$T/log" --script "$T/script" -m hard.fibre=none -m hard.law=fung -m hard.c=500 -m hard.bf=8 \
        -m hard.bt=2 -m hard.bfs=4 -m hard.nu=.3 $(printf -- '-m soft.%s ' $other) <"$T/mixed" >"$T/heart"
    near "$(sinew info --get quality.hourglass "$T/heart")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-5 \
        "the law fung mixed with $other: sinew info has the energies of the log"
    sinew results material.energy <"$T/heart" >"$T/energies"
    near "$(for name in soft hard; do sinew info --get material.energy.$name "$T/energies"; done | awk '{ e += $1 } END { printf "%.12g", e }')" \
        "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-6 "and energies by material add up to the log's"
done
for x in 0.03 0.04 0.05 0.06; do
    sinew info --get "node.displacement.at.$x,0,0" "$T/out"
done >"$T/ends"
is "$(awk '{ x[NR] = $1 } END { a = x[2] - x[1]; b = x[3] - x[2]; c = x[4] - x[3]; print (a > 1.1 * b && b > 1.05 * c && c > 0) }' "$T/ends")" 1 \
    "a mixed voxel is stretched less than one without fibres, and more than one with"

done_testing
