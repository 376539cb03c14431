#!/bin/sh
# Stress, strain, stretches and energies of elements in frames: by tled-run --results and by sinew results, to the same
# bytes; against figures of the laws and CalculiX; in the log, in VTU as VTK reads it, in tables and pictures.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

all=stress,stress.mises,strain,stretch,stretch.fibre,energy,material.energy,activation

# block ARGS...: a block, its arguments as awk's -v.
block() {
    awk -v nx=4 -v ny=1 -v nz=1 -v h=0.01 "$@" -f tests/cli/block.awk
}
# get KEY [FILE]
get() {
    sinew info --get "$1" "${2:-$T/out}"
}
# frames FILE: in text.
frames() {
    sinew export -f model --text "$1" | sed -n '/^frame/,$p'
}

# ---- The figures of E 3 kPa, nu .45: pulled to 1.2 it has 502.2590 Pa by area at rest, its sides are .92181984.
block >"$T/bar"
cat >"$T/pull" <<'X'
0 displace -1,-1,-1,0,1,1 0,-,-
0 displace -1,-1,-1,1,0,1 -,0,-
0 displace -1,-1,-1,1,1,0 -,-,0
0 displace 0.04,-1,-1,1,1,1 0,-,-
0.05 displace 0.04,-1,-1,1,1,1 0.008,-,-
X
check "a bar is pulled" sh -c "tled-run -q --rest 1e-9 --script '$T/pull' --results $all --log '$T/log' --tsv material.energy <'$T/bar' >'$T/out'"
near "$(get element.stress.row.2 | cut -d ' ' -f 1)" "$(awk 'BEGIN { printf "%.9g", 502.2590 / .92181984 ^ 2 }')" 1e-6 "Cauchy stress is P over the area"
is "$(get element.stress.row.2 | awk '{ for (i = 2; i <= 6; i++) if ($i ^ 2 > 1e-10) print i, $i }')" "" "and nothing else"
near "$(get element.stress.mises.max)" 591.0656 1e-6 "von Mises' is the same"
near "$(get element.strain.row.0 | cut -d ' ' -f 1)" 0.22 1e-6 "Green-Lagrange's strain"
near "$(get element.stretch.row.0 | cut -d ' ' -f 3)" 0.92181984 1e-6 "the smallest stretch is the sides'"
is "$(get element.stretch.fibre.nan) $(get element.stretch.fibre.rows)" "4 4" "there are no fibres"
near "$(get material.energy.tissue)" "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-8 "energies by material add up to the log's"
is "$(head -n 1 "$T/log" | tr '\t' '\n' | grep material)" "material.energy.tissue/J" "the log has a column a material"
near "$(awk -F '\t' 'END { print $21 }' "$T/log")" "$(get material.energy.tissue)" 1e-8 "with its energy"
near "$(get element.energy.mean)" "$(get material.energy.tissue | awk '{ printf "%.9g", $1 / 4e-6 }')" 1e-6 "by volume it is the elements'"

# ---- A muscle and fat, which halve the first element.
block -v held=low -v muscle=1 | awk '
    $1 == "axis" && ($2 == "volume" || $2 == "material") { $3 = 2 }
    $1 == "end" { print "array element.mix i32 @volume element 1\n1\n-1\n-1\n-1\narray element.mixture f32 1 element 1\n0.5\n0\n0\n0" }
    { print }
    $1 == "array" && $2 ~ /^(volume|material)[.]/ {
        name = $2
        getline
        print
        if (name ~ /[.]name$/) $0 = "\"fat\""
        if (name == "material.E") $0 = 1000
        if (name ~ /[.](material|priority)$/) $0 = 1
        if (name == "volume.muscle") $0 = 0
        print
    }' >"$T/muscle"
run="-q -t 0.05 --every 0.01 -c all=0.5"
# shellcheck disable=SC2086 # options are words
{
    check "a muscle contracts" sh -c "tled-run $run --results $all --log '$T/log' <'$T/muscle' >'$T/out'"
    tled-run $run --results $all --threads 3 <"$T/muscle" >"$T/three"
    check "three threads: the same bytes" cmp "$T/out" "$T/three"
    tled-run $run --text --results $all <"$T/muscle" >"$T/text"
    check "text has a twin" sh -c "sinew export -f model '$T/text' | cmp - '$T/out'"
    tled-run $run <"$T/muscle" >"$T/plain"
    check "without the option frames have what they had" sinew diff --only node.displacement --only node.velocity "$T/out" "$T/plain"
    fails 1 "and no more" 'the last frame has no element.stress.mises; it comes from tled-run or sinew results' get element.stress.mises.max "$T/plain"
    frames "$T/out" >"$T/frames"
    tled-run $run --results activation <"$T/muscle" >"$T/active"
    check "sinew results adds the same later" sh -c "sinew results all <'$T/active' | sinew export -f model --text | sed -n '/^frame/,\$p' | cmp - '$T/frames'"
    check "with 3 threads too" sh -c "sinew results --threads 3 $all <'$T/active' | sinew export -f model --text | sed -n '/^frame/,\$p' | cmp - '$T/frames'"
    tled-run $run --precision single --results $all <"$T/muscle" >"$T/single"
    near "$(get element.stress.mises.max "$T/single")" "$(get element.stress.mises.max)" 1e-4 "single precision comes near"
    check "goes on from a checkpoint" sh -c "tled-run $run --results $all --checkpoint '$T/point' --checkpoint-every 0.01 <'$T/muscle' | cmp - '$T/out'"
}
near "$(get volume.activation.row.0)" 0.25 1e-9 "half way up the ramp the muscle is activated to .25"
is "$(get volume.activation.row.1)" 0 "and the fat is not"
near "$(awk -v a="$(get material.energy.tissue)" -v b="$(get material.energy.fat)" 'BEGIN { printf "%.12g", a + b }')" \
    "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-7 "the energies of two materials add up to the log's"
is "$(get element.stretch.fibre.max | awk '{ print $1 < 1 }')" 1 "fibres are short"

# What a stretched muscle holds is its material's.
tled-run -q -t 0.05 -g 500,0,0 --results all --log "$T/log" -m tissue.passive=2 <"$T/muscle" >"$T/pulled"
passive=$(get material.energy.tissue "$T/pulled")
near "$(awk -v a="$passive" -v b="$(get material.energy.fat "$T/pulled")" 'BEGIN { printf "%.12g", a + b }')" \
    "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-7 "with passive muscles energies of materials add up too"
near "$(awk -v e="$(get element.energy.mean "$T/pulled")" 'BEGIN { printf "%.9g", e * 4e-6 }')" \
    "$(awk -F '\t' 'END { print $6 }' "$T/log")" 1e-6 "and those of elements"

# Stress without that of muscles is said to be that.
check "frames without activation" sh -c "sinew results stress.mises <'$T/plain' >'$T/passive' 2>'$T/said'"
is "$(grep -c 'warning: .*volume.activation' "$T/said")" 1 "are told of"
is "$(awk -v a="$(get element.stress.mises.max "$T/passive")" -v b="$(get element.stress.mises.max)" 'BEGIN { print a != b }')" 1 "as muscles are missing there"
check "strain needs no activation" sh -c "sinew results strain,energy <'$T/plain' 2>&1 >'$T/passive' | cmp - /dev/null"

# ---- A mesh without a lattice, whose elements are these boxes.
grep -v '^meta lattice' "$T/bar" >"$T/mesh"
check "a mesh without a lattice" sh -c "tled-run -q --rest 1e-9 --script '$T/pull' --results $all <'$T/mesh' >'$T/any'"
near "$(get element.stress.row.2 "$T/any" | cut -d ' ' -f 1)" 591.0656 1e-6 "has the same stress"

# ---- CalculiX: one C3D8 under any affine motion.
h='0.2 0.1 -0.05 0.02 -0.1 0.07 0.03 -0.04 0.05'
awk -v nx=1 -v ny=1 -v nz=1 -v h=1 -f tests/cli/block.awk | awk -v h="$h" '
    $2 == "material.E" { print "array material.c10 f64 Pa material 1\n300\narray material.c01 f64 Pa material 1\n200\narray material.K f64 Pa material 1\n2000"; getline; next }
    $2 == "material.nu" { getline; next }
    /neo-hookean/ { print "\"mooney-rivlin\""; next }
    $2 == "node.position" { print; for (n = 0; n < 8; n++) { getline; print; x[n] = $0 } next }
    $1 == "end" {
        split(h, g, " ")
        print "frame 0 0\narray node.displacement f64 m node 3"
        for (n = 0; n < 8; n++) {
            split(x[n], p, " ")
            for (i = 0; i < 3; i++)
                printf "%.9g%s", g[3 * i + 1] * p[1] + g[3 * i + 2] * p[2] + g[3 * i + 3] * p[3], i < 2 ? " " : "\n"
        }
    }
    { print }' >"$T/one"
check "any motion" sh -c "sinew results stress stress.mises <'$T/one' >'$T/moved'"
if have ccx; then
    cat >"$T/cube.inp" <<'X'
*NODE, NSET=N
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
*ELEMENT, TYPE=C3D8, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=M
*HYPERELASTIC, MOONEY-RIVLIN
300, 200, 0.001
*SOLID SECTION, ELSET=E, MATERIAL=M
*STEP, NLGEOM, INC=100
*STATIC
1, 1
*BOUNDARY
X
    awk -v h="$h" 'BEGIN {
        split(h, g, " ")
        split("0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1", x, " ")
        for (n = 0; n < 8; n++)
            for (i = 0; i < 3; i++)
                printf "%d, %d, %d, %.9g\n", n + 1, i + 1, i + 1, g[3 * i + 1] * x[3 * n + 1] + g[3 * i + 2] * x[3 * n + 2] + g[3 * i + 3] * x[3 * n + 3]
        print "*EL PRINT, ELSET=E\nS\n*END STEP" }' >>"$T/cube.inp"
    (cd "$T" && ccx -i cube >ccx.log)
    # xx yy zz xy xz yz there, xx yy zz xy yz xz here.
    awk '$1 == 1 && $2 == 1 { print $3, $4, $5, $6, $8, $7 }' "$T/cube.dat" >"$T/theirs"
    is "$(get element.stress.row.0 "$T/moved" | cat - "$T/theirs" | awk '
        NR == 1 { for (i = 1; i <= 6; i++) a[i] = $i }
        NR == 2 { for (i = 1; i <= 6; i++) if ((a[i] - $i) ^ 2 > 1e-12 * a[1] ^ 2) print i, a[i], $i; print NF }')" 6 \
        "CalculiX has the same six stresses, to 1e-6"
else
    skip 1 "no CalculiX (calculix-ccx)"
fi

# ---- Elsewhere: VTU, tables, pictures.
check "VTU" sinew export -f vtu -o "$T/a.vtu" "$T/out"
if python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null; then
    is "$(python3 tests/cli/read_vtu.py "$T/a.vtu" | grep -E '^cell (stress|strain|stretch|energy)' | tr '\n' ';')" \
        "cell stress float 6;cell stress.mises float 1;cell strain float 6;cell stretch float 3;cell stretch.fibre float 1;cell energy float 1;" \
        "VTK has them as cell data"
    is "$(python3 tests/cli/read_vtu.py "$T/a.vtu" cell stress | sed -n 1p)" "$(get element.stress.row.0)" "with their numbers"
else
    skip 2 "no VTK for Python (python3-vtk9)"
fi
is "$(sinew info --tsv element.stress.mises.max --tsv material.energy.fat "$T/out" | awk -F '\t' '{ n[NF]++ } END { for (i in n) print i, n[i] }')" "4 7" "a table has a row a frame"
check "a picture of what the frame has" sinew render --size 120x90 --colour element.stress.xx -o "$T/there.png" "$T/out"
check "or of what is computed" sinew render --size 120x90 --colour element.stretch.1 -o "$T/computed.png" "$T/plain"
sinew render --size 120x90 --colour element.stretch.1 -o "$T/again.png" "$T/out"
check "which is the same picture" cmp "$T/computed.png" "$T/again.png"
check "American spelling" sinew render --size 120x90 --color element.stretch.fiber -o "$T/again.png" "$T/plain"
fails 2 "no such number of it" "unknown field 'element.stress.zx'" sinew render --colour element.stress.zx -o "$T/no.png" "$T/plain"
fails 1 "at rest there is none" "element.energy cannot be shown at rest" sinew render --frame rest --colour element.energy -o "$T/no.png" "$T/plain"

# ---- Refused.
fails 2 "a name that is none" "unknown result 'stresses'; did you mean 'stress'" tled-run --results stresses
fails 2 "a name that is none, later" "unknown result 'mises'" sinew results mises
fails 2 "nothing asked for" "NAME" sinew results
fails 2 "what a run alone knows" "activation comes from tled-run --results" sinew results activation
fails 1 "no frames" "the model has no frames; expected results, from tled-run" sh -c "sinew results all <'$T/bar'"
fails 2 "a log without such a key" "material.energy" tled-run --log "$T/log" --tsv material.energies
fails 1 "no displacement" "frame 0 has no node.displacement" sh -c "sed 's/^array node.displacement/array x-other/' '$T/one' | sinew results energy"
done_testing
