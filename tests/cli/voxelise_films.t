#!/bin/sh
# voxelise --layers --mixed laminate: layers thinner than a voxel, of their own volume and as stiff as they are, stretched and bent,
# wherever the skin lies in the lattice; and films that are volumes, at the skin.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh
. tests/cli/hollow.sh
. tests/cli/film.sh

# within_10 NAME SHARE...: all within 10 % of 1.
within_10() {
    name=$1
    shift
    check "$name ($*)" awk -v got="$*" 'BEGIN { n = split(got, g, " "); for (i = 1; i <= n; i++) bad += !(g[i] > 0.9 && g[i] < 1.1); exit !(n && !bad) }'
}

# ---- volumes: shares add up to them, whatever parts of samples a layer has

worst() {
    awk -v want="$1" '{ off = $1 / want - 1; if (off < 0) off = -off; if (off > most) most = off } END { print most + 0 }'
}
for turn in 0 20; do
    for film in 2 5; do
        slab "$turn" "$film:20"
        for origin in 0,0,0 0,0,3 4,0,6 2,0,8.5; do
            voxelise -q --text --unit mm -s 10 --origin "$origin" --layers "$T/slab.layers" --fraction 8 --mixed laminate "$T/slab.obj" >"$T/m" 2>"$T/said"
            layer_volume layer1
        done >"$T/volumes"
        off=$(worst "$(awk -v t="$film" 'BEGIN { print t * 1.6 }')" <"$T/volumes")
        check "turned by $turn degrees, of .$film voxels: its volume at four places, within 1 % ($off)" test "$(echo "$off" | awk '{ print ($1 < 0.01) }')" = 1
    done
done
is "$(cat "$T/said")" "" "no word of stripes"
slab 20 5:20
for threads in 1 3; do
    voxelise -q --unit mm -s 10 --threads "$threads" --layers "$T/slab.layers" --fraction 8 --mixed laminate "$T/slab.obj" >"$T/by$threads" 2>"$T/said"
done
check "the same bytes on three threads" cmp "$T/by1" "$T/by3"

# ---- composite beams

origins="4,0,6" films=2
[ -z "${SINEW_LONG-}" ] || origins="0,0,0 0,0,3 4,0,6 2,0,8.5" films="2 5"
for turn in 0 20; do
    for film in $films; do
        slab "$turn" "$film:20"
        for origin in $origins; do
            # shellcheck disable=SC2046 # numbers
            within_10 "turned by $turn degrees, .$film voxels at $origin: stretched and bent" $(slab_energies "$turn" "$origin" --fraction 8 --mixed laminate)
        done
    done
done
slab 20 1:20 4:5
# shellcheck disable=SC2046
within_10 "three layers in a voxel" $(slab_energies 20 2,0,8.5 --fraction 8 --mixed laminate)

# A beam of two voxels and a film of a fifth of one, bent at its end: EI is 2.61 times the bare beam's; the film as a layer and as a volume.
awk 'BEGIN { for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++) print "v", 160 * i, 20 * j, 20 * k
    print "g rigid_sides\nf 1 3 4 2\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\ng skin\nf 5 6 8 7" }' >"$T/beam.obj"
{
    box skin 0 0 0 160 20 20
    box film -1 -1 18 161 21 21
} >"$T/film.obj"
printf 'skin surfaces=skin material=soft\nfilm level=1 surfaces=film material=film\n' >"$T/film.volumes"
printf 'film thickness=2mm\n' >"$T/layers"
printf 'soft E=3000 nu=0.3\nfilm E=60000 nu=0.3\n' >"$T/materials"
printf 'g rigid\nv 0 -9 -9\nv 0 9 -9\nv 0 9 30\nv 0 -9 30\nf 1 2 3 4\n' >"$T/wall.obj"
printf '0 displace -1mm,-99mm,-99mm,1mm,99mm,99mm 0,0,0\n0 force 0.16,0.01,0.01 0.02 0,0,-0.00001\n' >"$T/script"
# bend ARGS...: how far it sinks.
bend() {
    voxelise -q --unit mm -s 10 --origin 0,0,4 --fraction 8 --materials "$T/materials" "$@" 2>"$T/said" |
        tled-run -q -d cpu --rest 1e-6 --script "$T/script" >"$T/out"
    sinew info --get node.displacement.at.0.1,0.01,0.01 <"$T/out" | awk '{ print $3 }'
}
bare=$(bend "$T/beam.obj")
for how in layer volume; do
    case $how in
    layer) film=$(bend --mixed laminate --layers "$T/layers" "$T/beam.obj") ;;
    volume) film=$(bend --mixed laminate --volumes "$T/film.volumes" "$T/film.obj") ;;
    esac
    near "$(echo "$bare $film" | awk '{ printf "%.6g", $1 / $2 }')" 2.61 0.1 "a $how stiffens a beam that the lattice cuts as it should"
done

# ---- a tube under pressure within a stiff skin (Lame's solution of two layers)

# layered_tube H: hollow.sh's, with a skin outside alone.
layered_tube() {
    tube "$1" | awk '/^g skin_in/ { print "g rigid_in"; next }
        /^g / { outer = 1; next }
        outer && /^f/ { group = ++n <= 3 * 512 && n % 3 == 1 ? "skin" : "rigid_sides"; if (group != was) print "g " group; was = group }
        { print }'
}
# tube_error H THICKNESS RATIO: the root mean square of the displacement's error, in parts of it.
tube_error() {
    layered_tube "$1" >"$T/tube.obj"
    {
        echo "0 pressure tube:rigid_in 3e-4"
        planes tube "$1"
    } >"$T/script"
    echo "film thickness=$2mm" >"$T/layers"
    awk -v r="$3" 'BEGIN { print "tissue E=3000 nu=0.45\nfilm nu=0.45 E=" 3000 * r }' >"$T/materials"
    voxelise -q --text --unit mm -s "$1" --origin 0,0,0 --layers "$T/layers" --materials "$T/materials" --fraction 8 --mixed laminate "$T/tube.obj" 2>"$T/said" |
        sinew bind -q >"$T/model" 2>>"$T/said"
    tled-run -q -d cpu --text --rest 1e-6 --script "$T/script" -o "$T/out" <"$T/model" 2>"$T/said" || diag_file "$T/said"
    awk -v times="$3" -v film="$2" '
        BEGIN {
            a = 0.0113; b = 0.02; c = b - film / 1000; p = 3e-4; mu = 3000 / 2.9; M = 10000 + mu / 3 # lambda + mu
            g = mu * c / (M * b ^ 2) + 1 / c; k = 2 * mu * times * (1 / b ^ 2 - 1 / c ^ 2) / g # the film as a spring
            t = (2 * mu / c ^ 2 + k / c) / (2 * M - k * c); B = -p / (2 * M * t - 2 * mu / a ^ 2); A = t * B
            B2 = (A * c + B / c) / g; A2 = mu * B2 / (M * b ^ 2)
        }
        $1 == "array" { on = $2; n = 0; next }
        /^[a-z]/ { on = "" }
        on == "node.position" { x[n] = $1; y[n++] = $2 }
        on == "node.displacement" {
            r = sqrt(x[n] ^ 2 + y[n] ^ 2)
            if (r > a && r < b) { u = r < c ? A * r + B / r : A2 * r + B2 / r; off += ($1 - u * x[n] / r) ^ 2 + ($2 - u * y[n] / r) ^ 2; all += u ^ 2 }
            n++
        }
        END { printf "%.9g", all ? sqrt(off / all) : 1 }' "$T/out"
}
below "$(tube_error 2.5 0.5 20)" .03 1 "a film of a fifth of a voxel, 20 times as stiff, on a tube of 8"
if [ -n "${SINEW_LONG-}" ]; then
    below "$(tube_error 2.5 1.25 20)" .03 1 "of half a voxel"
    below "$(tube_error 2.5 0.5 0.1)" .03 1 "a tenth as stiff"
    below "$(tube_error 1.25 0.25 20)" .01 1 "a fifth of a voxel on a tube of 16"
fi

# ---- refused

slab 0 5:20
voxelise -q --text --unit mm -s 10 --layers "$T/slab.layers" --fraction 8 --mixed laminate "$T/slab.obj" >"$T/m" 2>"$T/said"
first=$(rows border.element | head -n 1)
grep -v '^crc' "$T/m" | awk -v e="$first" '$1 == "axis" && $2 == "cut" { print $1, $2, $3 - 1; next }
    $1 == "array" { on = $2; row = -1 } { row++ }
    on == "cut.element" && $0 == e { drop = row; next } on == "cut.moments" && row == drop { next } { print }' >"$T/bad"
fails 1 "a border in what is neither whole nor cut" "has element.fraction 0.75 and no row of cut.element; expected" sh -c "tled-run -q -t 0.01 -g 0,0,-9.81 <'$T/bad'"
grep -v '^crc' "$T/m" | awk '$1 == "array" { on = $2; row = -1 } { row++ } on == "border.moments" && row == 1 { print 0, 0, 9, 0, 0, 0; next } { print }' >"$T/bad"
fails 1 "a part outside of its element" "border.moments, row 0: 0 0 9 0 0 0; expected -1 to 1" sh -c "tled-run -q -t 0.01 -g 0,0,-9.81 <'$T/bad'"
sed 's/^-\{0,1\}0 -\{0,1\}0 -\{0,1\}1$/0 0 0/; /^crc/d' "$T/m" >"$T/bad"
fails 1 "a cut border of no direction" "border.normal, row 0 is 0 0 0" sh -c "tled-run -q -t 0.01 -g 0,0,-9.81 <'$T/bad'"
fails 2 "laminates without --fraction" "--mixed is for --fraction" voxelise --unit mm -s 10 --mixed laminate --layers "$T/slab.layers" "$T/slab.obj"

# ---- energies, what else reads such models, and the same bytes

slab 20 5:20
voxelise -q --unit mm -s 10 --layers "$T/slab.layers" --materials "$T/slab.materials" --fraction 8 --mixed laminate "$T/slab.obj" >"$T/model" 2>"$T/said"
printf '0 displace -1,-1,-1,0,1,1 0,0,0\n0 gravity 0,0,-9.81\n' >"$T/script"
tled-run -q -d cpu -t 0.05 --script "$T/script" --damping 0 --log "$T/log" --threads 1 <"$T/model" >"$T/one"
tled-run -q -d cpu -t 0.05 --script "$T/script" --damping 0 --threads 3 <"$T/model" >"$T/three"
SINEW_VECTORS=plain tled-run -q -d cpu -t 0.05 --script "$T/script" --damping 0 <"$T/model" >"$T/plain"
check "the same bytes on three threads" cmp "$T/one" "$T/three"
check "and without vectors" cmp "$T/one" "$T/plain"
near "$(awk -F '\t' 'END { printf "%.9g", 1 + $14 / $8 }' "$T/log")" 1 2e-3 "energies balance"
near "$(sinew results -q --text material.energy <"$T/one" |
    awk '$1 == "frame" { sum = 0 } $1 == "array" { on = $2 == "material.energy"; next } /^[^-+0-9.]/ { on = 0 } on { sum += $1 } END { printf "%.9g", sum }')" \
    "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-5 "sinew results has those of the log"
near "$(sinew info --get quality.hourglass "$T/one")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-6 "and sinew info too"
done_testing
