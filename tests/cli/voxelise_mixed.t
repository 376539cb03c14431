#!/bin/sh
# voxelise --mixed laminate: borders in elements of two volumes, and what they do in tled-run against closed forms.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh
. tests/cli/inclusion.sh

# ---- borders

# Two halves of a bar: a border across x in the fifth voxel, of which .3 is soft.
printf 'skin surfaces=skin material=soft\nhard level=1 surfaces=hard material=hard\n' >"$T/volumes"
printf 'soft E=3000 nu=0 density=1000\nhard E=12000 nu=0 density=1500\n' >"$T/materials"
printf 'g rigid\nv 0 -9 -9\nv 0 9 -9\nv 0 9 30\nv 0 -9 30\nf 1 2 3 4\n' >"$T/wall.obj"
# bar HEIGHT X0 Z0 Z1 ARGS...: 8 voxels of 10 mm along x, hard from X0 and between Z0 and Z1.
bar() {
    {
        box skin 0 0 0 80 10 "$1"
        box hard "$2" 0 "$3" 80 10 "$4"
    } >"$T/bar.obj"
    shift 4
    voxelise -q --text --unit mm -s 10 --volumes "$T/volumes" --materials "$T/materials" "$@" "$T/bar.obj" >"$T/m" 2>"$T/said"
}
bar 10 43 0 10 --fraction 10 --mixed laminate
is "$(rows border.element) $(rows border.normal) $(rows border.moments | awk '{ print $1 + 0.7 < 1e-6, $2, $3, $4, $5, $6 }')" "4 -1 0 0 1 0 0 0 0 0" "the border across a bar, towards its second volume"
bar 10 43 0 10 --fraction 10
is "$(grep -c '^array border' "$T/m")" 0 "none by default"
cp "$T/m" "$T/default"
bar 10 43 0 10 --fraction 10 --mixed between
is "$(grep -v '^prov' "$T/m" | cksum)" "$(grep -v '^prov' "$T/default" | cksum)" "--mixed between is the default"
bar 10 0 4 6 --fraction 10 --mixed laminate
is "$(grep -c '^array border' "$T/m") $(rows element.mix | sort | uniq -c | tr -s ' ')" "0  8 1" "a band through the middle of voxels has two borders, and none is written"
# A ball in a ball: normals point along the radius.
{
    awk -v r=20 -v n=48 -v g=skin -f tests/cli/sphere.awk
    awk -v r=11 -v n=48 -v g=hard -f tests/cli/sphere.awk | awk -v from="$((2 + 47 * 96))" '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } 1'
} >"$T/ball.obj"
vox -s 2.5 --volumes "$T/volumes" --materials "$T/materials" --fraction 8 --mixed laminate --threads 1 "$T/ball.obj"
cp "$T/m" "$T/one"
vox -s 2.5 --volumes "$T/volumes" --materials "$T/materials" --fraction 8 --mixed laminate --threads 3 "$T/ball.obj"
check "the same bytes on three threads" cmp "$T/m" "$T/one"
worst=$(awk '$1 == "array" { on = $2; k = 0; next } /^[^-+0-9]/ { on = "" }
    on == "element.lattice" { for (a = 1; a < 4; a++) at[k, a] = $a + 0.5 - 8; k++ }
    on == "element.volume" { of[k++] = $1 }
    on == "border.element" { e[k++] = $1; count = k }
    on == "border.normal" { for (a = 1; a < 4; a++) n[k, a] = $a; k++ }
    END { for (i = 0; i < count; i++) { d = l = 0
        for (a = 1; a < 4; a++) { d += n[i, a] * at[e[i], a]; l += at[e[i], a] ^ 2 }
        c = (of[e[i]] == 1 ? 1 : -1) * d / sqrt(l); if (!i || c < least) least = c } print count, least }' "$T/m")
is "$(echo "$worst" | awk '{ print ($1 > 150), ($2 > 0.96) }')" "1 1" "normals of a ball are along its radius, within 16 degrees (borders, least cosine: $worst)"
is "$(msds-mesh <"$T/one" 2>"$T/said" | sinew info | grep -c 'element.node\|border')" 1 "tetrahedra have none"
fails 2 "--mixed without --fraction" "--mixed is for --fraction" voxelise --unit mm -s 1 --mixed laminate "$T/bar.obj"
fails 2 "--mixed of another kind" "--mixed 'middle'" voxelise --unit mm -s 1 --fraction 2 --mixed middle "$T/bar.obj"

# ---- refused

bar 10 43 0 10 --fraction 10 --mixed laminate
sed 's/^-1 0 0$/0 0 0/; /^crc/d' "$T/m" >"$T/bad"
fails 1 "no direction" "border.normal, row 0 is 0 0 0; expected a direction" sh -c "tled-run -q -t 0.01 -g 0,0,-9.81 <'$T/bad'"
awk '$1 == "array" { on = $2 } on == "border.element" && $0 == "4" { print 3; next } !/^crc/' "$T/m" >"$T/bad"
fails 1 "an element of one volume" "element 3 is not mixed of two volumes" sh -c "tled-run -q -t 0.01 -g 0,0,-9.81 <'$T/bad'"

# ---- two rods in series, and side by side

# stretch Z: how far the places 20 and 60 mm along the bar part at height Z (m), mm.
stretch() {
    for x in 0.02 0.06; do sinew info --get "node.displacement.at.$x,0,$1" <"$T/out"; done | awk '{ x = $1 - x } END { printf "%.9g", 1000 * x }'
}
printf '0 force 0.08,0.005,0.005 0.008 0.0003,0,0\n' >"$T/script" # 3 Pa on 1 cm2
attach -q --fibre axis --rigid-file "$T/wall.obj" <"$T/m" 2>"$T/said" | tled-run -q -d cpu --rest 1e-7 --script "$T/script" >"$T/out"
stress=$(sinew results -q --text stress <"$T/out" | awk '$1 == "array" { on = $2 == "element.stress"; k = 0; next } /^[^-+0-9.]/ { on = 0 } on && k++ == 4 { print $1 }')
near "$stress" 3 2e-3 "whose stress is that of both"
near "$(stretch 0)" "$(awk 'BEGIN { print 3 * (23 / 3000 + 17 / 12000) }')" 2e-3 "two rods in series within a voxel"
bar 20 0 6 14 --fraction 10 --mixed laminate
printf '0 force 0.08,0.005,0.01 0.02 0.0006,0,0\n' >"$T/script"
attach -q --fibre axis --rigid-file "$T/wall.obj" <"$T/m" 2>"$T/said" | tled-run -q -d cpu --rest 1e-7 --script "$T/script" >"$T/out"
mean=$(echo "$(stretch 0) $(stretch 0.01)" | awk '{ print ($1 + $2) / 2 }')
near "$mean" "$(awk 'BEGIN { print 3 * 40 / (0.6 * 3000 + 0.4 * 12000) }')" 1e-2 "two rods side by side within voxels"

# A film of a fifth of a voxel on a bar of two, 20 times as stiff, bent: EI by the transformed section is 2.61 times the bare bar's.
printf 'soft E=3000 nu=0.3 density=1000\nhard E=60000 nu=0.3 density=1000\n' >"$T/materials"
{
    box skin 0 0 0 160 20 20
    box hard -1 -1 18 161 21 21
} >"$T/film.obj"
printf '0 force 0.16,0.01,0.01 0.02 0,0,-0.00001\n' >"$T/script"
# bend ARGS...: how far it sinks.
bend() {
    voxelise -q --unit mm -s 10 --origin 0,0,0 --volumes "$T/volumes" --materials "$T/materials" "$@" "$T/film.obj" 2>"$T/said" |
        attach -q --fibre axis --rigid-file "$T/wall.obj" 2>"$T/said" | tled-run -q -d cpu --rest 1e-6 --script "$T/script" >"$T/out"
    sinew info --get node.displacement.at.0.1,0.01,0.01 <"$T/out" | awk '{ print $3 }'
}
near "$(echo "$(bend) $(bend --fraction 10 --mixed laminate)" | awk '{ printf "%.6g", $1 / $2 }')" 2.61 0.1 "a film thinner than a voxel stiffens a beam as it should"

# ---- a cylinder, 10 times as stiff and a tenth, against its closed form

for ratio in 10 0.1; do
    between=$(inclusion_errors 16 "$ratio" 0.45 0.25 0.1 --fraction 8)
    laminate=$(inclusion_errors 16 "$ratio" 0.45 0.25 0.1 --fraction 8 --mixed laminate)
    is "$(echo "$laminate $between" | awk '{ print ($1 < 0.02), ($1 < 0.5 * $3), ($2 < 0.03), ($2 < $4) }')" "1 1 1 1" \
        "ratio $ratio, 16 voxels: less than half the error, and strain inside within 3 % ($laminate; between: $between)"
done
if [ -n "${SINEW_LONG-}" ]; then
    for ratio in 10 0.1; do
        coarse=$(inclusion_mean 16 "$ratio" 0.45 --fraction 8 --mixed laminate)
        fine=$(inclusion_mean 32 "$ratio" 0.45 --fraction 8 --mixed laminate)
        is "$(echo "$coarse $fine" | awk '{ print (log($1 / $3) / log(2) > 1.2), ($4 < 0.01) }')" "1 1" \
            "ratio $ratio: of order 1.2 and more, strain inside within 1 % in 32 voxels ($coarse; $fine)"
    done
fi

# ---- bytes, energies

printf '0 gravity 0,0,-9.81\n0 contract m 0\n0.01 contract m 1\n' >"$T/script"
printf 'skin surfaces=skin material=soft\nmuscle_m level=1 surfaces=hard material=hard\n' >"$T/volumes"
printf 'soft E=3000 nu=0.4\nhard E=12000 nu=0.45 peak=3000\n' >"$T/materials"
printf 'g rigid\nv -30 -30 0\nv 30 -30 0\nv 30 30 0\nv -30 30 0\nf 1 2 3 4\n' >"$T/wall.obj"
voxelise -q --unit mm -s 5 --volumes "$T/volumes" --materials "$T/materials" --fraction 4 --mixed laminate "$T/ball.obj" 2>"$T/said" |
    attach -q --rigid-file "$T/wall.obj" >"$T/model" 2>>"$T/said"
for precision in double single; do
    tled-run -q -d cpu --precision $precision -t 0.02 --script "$T/script" --threads 1 <"$T/model" >"$T/one"
    tled-run -q -d cpu --precision $precision -t 0.02 --script "$T/script" --threads 3 <"$T/model" >"$T/three"
    SINEW_VECTORS=plain tled-run -q -d cpu --precision $precision -t 0.02 --script "$T/script" <"$T/model" >"$T/plain"
    check "$precision: the same bytes on three threads" cmp "$T/one" "$T/three"
    check "$precision: and without vectors" cmp "$T/one" "$T/plain"
done
tled-run -q -d cpu -t 0.05 --dt 5e-5 -g 0,0,-9.81 --damping 0 --ramp 0.03 -c m=0.5 --log "$T/log" <"$T/model" >"$T/out"
is "$(awk -F '\t' 'NR > 1 { off = $14 < 0 ? -$14 : $14; if (off > most) most = off; if ($6 > held) held = $6 }
    END { print (held > 0 && most < 0.002 * held) }' "$T/log")" 1 "undamped, with a muscle: energies balance to 0.2 %"
near "$(sinew info --get quality.hourglass "$T/out")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-6 "sinew info has the energies of the log"
near "$(sinew results -q --text material.energy <"$T/out" |
    awk '$1 == "frame" { sum = 0 } $1 == "array" { on = $2 == "material.energy"; next } /^[^-+0-9.]/ { on = 0 } on { sum += $1 } END { printf "%.9g", sum }')" \
    "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-5 "and sinew results those of materials"

done_testing
