#!/bin/sh
# tled-run through its command line: figures that must come out, frames, going on, what is refused. The solver itself has
# its unit tests. With SINEW_LONG finer cantilevers, and more of them.
. "$(dirname "$0")/lib.sh"

at() { # KEY COLUMN of the model in $T/out
    sinew info --get "node.displacement.at.$1" <"$T/out" | cut -d ' ' -f "$2"
}
clock() { # milliseconds, of some clock
    date +%s%3N
}
# An OBJ of X by Y by Z mm with its low or top side rigid, in voxels of H mm, as the model $T/model.
model() { # X Y Z low|top H MATERIAL
    awk -v x="$1" -v y="$2" -v z="$3" -v held="$4" -f tests/cli/box.awk >"$T/box.obj"
    echo "tissue $6" >"$T/materials"
    voxelise -q --unit mm -s "$5" --materials "$T/materials" "$T/box.obj" | attach -q >"$T/model"
}
rest() { # NAME KEY COLUMN WANT TOLERANCE ARG...: at rest under its own weight
    name=$1 key=$2 column=$3 want=$4 tolerance=$5
    shift 5
    begin=$(clock)
    tled-run -q -g 0,0,-9.81 "$@" <"$T/model" >"$T/out"
    end=$(clock)
    got=$(at "$key" "$column")
    near "$got" "$want" "$tolerance" "$name"
    diag "$(awk -v got="$got" -v want="$want" -v ms=$((end - begin)) \
        'BEGIN { printf "%.6g m; wanted %g m: %+.2f %%; %.2f s", got, want, 100 * (got / want - 1), ms / 1000 }')"
}

# ---- Figures: against quadratic elements (C3D20R) of CalculiX 2.20, extrapolated from meshes of 4, 8 and 12 elements
# across: -18.278 mm for the cube; for the cantilever -42.34 mm at nu = .45, -42.05, -41.97 and -41.97 at .49, .499, .4999
# (tests/element/references.tsv).
model 100 100 100 top 12.5 'E=3000 nu=0.45'
rest "cube under gravity, 8^3, to 2 %" 0.05,0.05,0 3 -1.8278e-2 2e-2
cube=$(at 0.05,0.05,0 3)
rest "the same in single precision" 0.05,0.05,0 3 "$cube" 1e-4 --precision single
rest "the same by its name" 0.05,0.05,0 3 "$cube" 0 --hourglass physical
if [ -n "$SINEW_SANITIZED" ]; then
    skip 1 "too slow with sanitizers"
else
    model 80 20 20 low 2.5 'E=30e3 nu=0.45'
    rest "cantilever, 32 x 8 x 8, to 2 %" 0.08,0.01,0.01 3 -4.234e-2 2e-2
fi
many=${SINEW_LONG:+1}
for case in .45=-.04234 ${many:+.49=-.04205 .499=-.04197} .4999=-.04197; do
    model 80 20 20 low 5 "E=30e3 nu=0${case%=*}"
    rest "cantilever, 16 x 4 x 4, nu = ${case%=*}, to 4 %" 0.08,0.01,0.01 3 "${case#*=}" 4e-2
done
# Physical control by its energy alone: a program that minimises the energy by Newton's method, and has nothing else in common with this
# one, gives the mean z of the free end's nodes, in mm, of 4n x n x n elements in equilibrium.
end_mean() {
    awk '/^array node.position/ { on = 1; n = 0; next } /^array node.displacement/ { on = 2; n = 0; next } /^[a-z]/ { on = 0 }
        on == 1 { x[n++] = $1 } on == 2 { if (x[n++] > .0799) { sum += $3; nodes++ } } END { printf "%.6f", 1000 * sum / nodes }' "$1"
}
while read -r n nu weight want; do
    case "$n $nu $weight" in '1 .45 25' | '2 .4999 9.81' | '4 .45 9.81') ;; *) [ "$many" ] || continue ;; esac
    model 80 20 20 low "$((20 / n))" "E=30e3 nu=0$nu"
    tled-run -q --text -g "0,0,-$weight" --rest 1e-6 <"$T/model" >"$T/out"
    got=$(end_mean "$T/out")
    near "$got" "$want" 1.3e-5 "$n thick, nu = $nu, $weight m/s2: $got mm, as Newton's method has it"
done <<'CASES'
1 .45 9.81 -41.857
1 .4999 9.81 -41.647
1 .45 25 -66.244
2 .45 9.81 -40.267
2 .4999 9.81 -39.078
2 .45 25 -65.285
4 .45 9.81 -41.382
4 .4999 9.81 -40.673
4 .45 25 -66.513
CASES

# Isotropic control is that of CalculiX's C3D8R elements; the sweep over kappa is against its published values.
model 100 100 100 top 12.5 'E=3000 nu=0.45'
rest "isotropic control: the cube" 0.05,0.05,0 3 -1.8191e-2 5e-3 --hourglass isotropic
cube=$(at 0.05,0.05,0 3)
rest "a number is its kappa" 0.05,0.05,0 3 "$cube" 0 --hourglass 0.0075
rest "kappa 0.0075" 0.05,0.05,0 3 -1.8188e-2 5e-3 --hourglass isotropic:0.0075
rest "kappa 0.075" 0.05,0.05,0 3 -1.7828e-2 5e-3 --hourglass isotropic:0.075
rest "kappa 0.5" 0.05,0.05,0 3 -1.6435e-2 5e-3 --hourglass 0.5
if [ ! "$many" ]; then
    skip 1 "SINEW_LONG is not set"
else
    model 80 20 20 low 2.5 'E=30e3 nu=0.45'
    rest "its cantilever, 32 x 8 x 8" 0.08,0.01,0.01 3 -4.2577e-2 1e-2 --hourglass 0.0075
fi
# It is by mu: toward nu = .5 nothing locks, and the cantilever stays softer than 16 x 4 x 4 C3D20R are by nearly the same share.
set -- # all of them
for case in .45=-.04197 ${many:+.49=-.04149 .499=-.04120} .4999=-.04107; do
    model 80 20 20 low 5 "E=30e3 nu=0${case%=*}"
    rest "its cantilever, nu = ${case%=*}, to 4.5 %" 0.08,0.01,0.01 3 "${case#*=}" 4.5e-2 --hourglass 0.0075
    [ "$case" != .45=-.04197 ] || near "$got" -4.3478e-2 1e-2 "as C3D8R's to 1 %"
    set -- "$@" "$(awk -v got="$got" -v want="$want" 'BEGIN { print got / want }')"
done
shares=$*
while [ $# -gt 2 ]; do # the last and the first
    first=$1
    shift 2
    set -- "$first" "$@"
done
near "$2" "$1" 1.5e-2 "from nu = .45 to .4999 that share changes by 1.5 % at most: $shares"
# The coefficient that makes kappa 11 mu into kappa (lambda + 2 mu) at .499 brings back how that locked.
model 80 20 20 low 5 'E=30e3 nu=0.499'
rest "held by lambda + 2 mu, at nu = .499, it locks" 0.08,0.01,0.01 3 -0.0263859 1e-5 --rest 1e-6 --hourglass 0.341590909

# A muscle that nothing resists: mu, K and a s f(l) in balance, solved apart from this program.
awk -v nx=4 -v ny=4 -v nz=4 -v h=0.005 -v nu=0.49 -v muscle=1 -f tests/cli/block.awk >"$T/model"
cat >"$T/symmetry" <<'SCRIPT'
0 displace 0,0,0,0,1,1 0,-,-
0 displace 0,0,0,1,0,1 -,0,-
0 displace 0,0,0,1,1,0 -,-,0
SCRIPT
for case in 0.05=0.7392330 0.4=0.5571587 1=0.5109409; do
    tled-run -q -c "all=${case%=*}" --script "$T/symmetry" --rest 1e-6 <"$T/model" >"$T/out"
    stretch=$(at 0.02,0.02,0.02 1 | awk '{ printf "%.7f", 1 + $1 / 0.02 }')
    near "$stretch" "${case#*=}" 1e-5 "a free muscle at level ${case%=*} shortens to $stretch"
done

# ---- A muscle within tissue, from an OBJ.
cat >"$T/muscle.awk" <<'AWK'
function box(x0, y0, z0, x1, y1, z1) {
    for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++)
        print "v", i ? x1 : x0, j ? y1 : y0, k ? z1 : z0
}
BEGIN {
    box(0, 0, 0, 60, 30, 30)
    box(-5, 10, 10, 45, 20, 20)
    print "g skull\nf 1 5 7 3\ng skin\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7"
    print "g muscle_bar\nf 9 13 15 11\nf 10 12 16 14\nf 9 10 14 13\nf 11 15 16 12\nf 9 11 12 10\nf 13 14 16 15"
}
AWK
awk -f "$T/muscle.awk" >"$T/muscle.obj"
voxelise -q --unit mm -s 5 "$T/muscle.obj" | attach -q >"$T/model"
run() { # ARG...
    tled-run "$@" <"$T/model"
}
run -q -c bar=0.4 -t 0.2 --every 0.05 --threads 1 >"$T/out"
is "$(sinew info --get frames <"$T/out")" 5 "frames every 0.05 s from 0 to 0.2 s"
x=$(at 0.045,0.015,0.015 1)
check "the muscle's far end has moved toward its origin by more than 5 mm ($x)" awk "BEGIN { exit !($x < -0.005) }"
is "$(at 0,0,0 1) $(at 0,0.015,0.015 1) $(at 0,0.03,0.03 3)" "0 0 0" "rigid nodes have not moved"
for threads in 2 3; do
    run -q -c bar=0.4 -t 0.2 --every 0.05 --threads $threads >"$T/again"
    check "the same bytes from $threads threads" cmp "$T/out" "$T/again"
done
SINEW_THREADS=2 tled-run -q -c bar=0.4 -t 0.2 --every 0.05 <"$T/model" >"$T/again"
check "and from SINEW_THREADS" cmp "$T/out" "$T/again"
run -q -c muscle_bar=0.4 -t 0.2 --every 0.05 >"$T/again"
check "muscle_bar is bar" sinew diff "$T/out" "$T/again"
run -q -c bar=0.4 -t 0.2 --every 0.05 --text >"$T/text"
check "text says the same" sinew diff "$T/out" "$T/text"
run -q -c bar=0.4 -t 0.2 >"$T/again"
is "$(sinew info --get node.displacement.max <"$T/again")" "$(sinew info --get node.displacement.max <"$T/out")" \
    "frames in between do not change the end"
is "$(awk '/^frame / { printf "%d %.12g, ", $2, $3 }' "$T/text")" "0 0, 1 0.05, 2 0.1, 3 0.15, 4 0.2, " "frames have index and time"
is "$(awk '/^frame / { f = $2 } /^array node.(displacement|velocity) / { on = 1; next } /^[a-z]/ { on = 0 }
    on && f == 0 && ($1 || $2 || $3) { n++ } END { print n + 0 }' "$T/text")" 0 "the first is the model at rest"
is "$(run -q -c bar=0.4 -t 0 --every 0.05 | sinew info --get frames)" 1 "a run that takes no step has one"

check "whatever it is told, -q says nothing" run -q -c bar=0.4 -n 3
is "$(cat "$T/stderr")" "" "indeed nothing"
fails 0 "else it says the stable step and its own" 'stable step [0-9.]+ ms, dt [0-9.]+ ms' run -c bar=0.4 -n 3
fails 0 "and energies with -v" 'kinetic .* strain .* stable step' run -v -c bar=0.4 -n 30

# ---- Going on.
run -q -c bar=0.4 -t 0.2 --damping 50 --every 0.1 >"$T/whole"
run -q -c bar=0.4 -t 0.1 --damping 50 --every 0.1 >"$T/first"
tled-run -q -c bar=0.4 -t 0.1 --damping 50 --every 0.1 <"$T/first" >"$T/second"
check "a run of two parts is the run of both" sinew diff "$T/whole" "$T/second"
is "$(sinew info --get frames <"$T/second")" 3 "the first part's frames are passed on, and where it ended is not written twice"
run -q -c bar=0.4 -t 0.1 --damping 50 >"$T/first"
tled-run -q -c bar=0.4 -t 0.1 --damping 50 <"$T/first" >"$T/second"
is "$(sinew info --get node.displacement.max <"$T/second")" "$(sinew info --get node.displacement.max <"$T/whole")" \
    "nor without frames in between does the end differ"
fails 0 "with frames dropped, the start is written" 'warning: .*1 frame dropped' \
    sh -c "tled-run -m tissue.E=4000 -t 0.01 --every 0.01 <'$T/first' >'$T/again'"
is "$(sinew info --get frames "$T/again")" 2 "and so is the end"
fails 0 "other materials drop the frames" 'warning: .*1 frames? dropped' \
    sh -c "tled-run -m tissue.E=4000 -t 0.01 <'$T/first' >'$T/second'"
is "$(sinew info --get frames <"$T/second")" 1 "and leave the new one"
sinew info "$T/second" >"$T/info"
check "provenance says what was run and with what" grep -q 'tled-run [0-9.]* .*-m tissue.E=4000.*--hourglass physical .*dt [0-9.]*.*damping [0-9.]*' "$T/info"
for case in physical=physical isotropic=isotropic:0.0075 isotropic:0.02=isotropic:0.02 0.02=isotropic:0.02 0=isotropic:0; do
    run -q --hourglass "${case%=*}" -n 1 >"$T/second"
    is "$(sinew info "$T/second" | sed -n 's/.* --hourglass \([^ ]*\) .*/\1/p') $(sinew info --get meta.hourglass.control "$T/second")" \
        "${case#*=} ${case#*=}" "and how hourglass modes are held, in full: ${case%=*}"
done

tled-run -q -g 0,0,-1 -t 0.3 <"$T/model" >"$T/first"
check "what sets in at once on a model that moves already is no jump too far" \
    sh -c "tled-run -q -g 0,0,-1 -c bar=0.4 -t 0.1 <'$T/first' >'$T/second'"

# ---- Parts that nothing holds.
cat >"$T/boxes.awk" <<'AWK'
function box(g, x0, y0, z0, x1, y1, z1) {
    for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++)
        print "v", i ? x1 : x0, j ? y1 : y0, k ? z1 : z0
    print "g " g "\nf -8 -4 -2 -6\nf -7 -5 -1 -3\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -6 -5 -7\nf -4 -3 -1 -2"
}
AWK
{
    cat "$T/boxes.awk"
    echo 'BEGIN { box("skin", 0, 0, 0, 20, 20, 20); box("skin", 40, 0, 0, 60, 20, 20) }'
} >"$T/two.awk"
awk -f "$T/two.awk" >"$T/two.obj"
voxelise -q --unit mm -s 5 "$T/two.obj" >"$T/two"
printf '0 displace 0,0,0,0,1,1 0,0,0\n0 force 0.02,0.01,0.01 5mm 0,0,-0.001\n' >"$T/hold"
fails 1 "a part that nothing holds never comes to rest under its weight" \
    "nothing holds 1 part of the model, 64 elements, the first of them [0-9]+ \(volume 'skin'\)" \
    sh -c "tled-run -q -g 0,0,-1 --script '$T/hold' <'$T/two'"
fails 0 "it is warned of where no load acts on it" 'warning: nothing holds 1 part' \
    sh -c "tled-run --script '$T/hold' <'$T/two' >'$T/out'"

# ---- Held in some components: damping is pi c / L, L the farthest of any component; c = 1.0171 m/s.
awk -v nx=5 -v ny=1 -v nz=25 -v h=0.001 -v nu=0.45 -f tests/cli/block.awk >"$T/slice"
printf '0 displace -1,-1,-1,1,1,1 -,0,-\n0 displace -1,-1,-1,1,1,0 0,-,0\n' >"$T/plane"
printf '0 displace -1,-1,-1,0,1,1 0,-,-\n0 displace -1,-1,-1,1,0,1 -,0,-\n0 displace -1,-1,-1,1,1,0 -,-,0\n' >"$T/planes"
head -n 2 "$T/planes" >"$T/fall"
for case in plane planes; do
    damping=$(tled-run --script "$T/$case" -n 1 <"$T/slice" 2>&1 >/dev/null | sed -n 's/.*damping \([0-9.]*\) 1.*/\1/p')
    near "$damping" "$(awk 'BEGIN { print 3.14159265 * sqrt(3000 / 2.9 / 1000) / 0.025 }')" 1e-3 "$case: the damping of a column of 25 mm, $damping"
done
fails 1 "what gravity pulls along an axis on which nothing holds it" \
    "nothing holds the part of element 0 \(volume 'skin'\) along z, where gravity pulls it, so that it never comes to rest" \
    tled-run --script "$T/fall" -g 0,0,-1 -o "$T/left" <"$T/slice"
fails 0 "falls for so long as is asked" "warning: nothing holds the part of element 0 \(volume 'skin'\) along z, where gravity pulls it" \
    tled-run --script "$T/fall" -g 0,0,-1 -n 1 -o "$T/out" <"$T/slice"
echo '0 force 0,0,0 1 0,0,0.001' >>"$T/fall"
fails 0 "a force may bear it" "warning: nothing holds the part of element 0" \
    tled-run --script "$T/fall" -g 0,0,-1 --rest 1 -o "$T/out" <"$T/slice"
is "$(tled-run --script "$T/planes" -g 1,2,-9 -n 1 <"$T/slice" 2>&1 >/dev/null | grep -c warning)" 0 "what planes of symmetry hold does not fall"
awk 'NR == 2 { next } { print }' "$T/planes" >"$T/level" # z and x alone are held
is "$(tled-run --script "$T/level" -g 3,1e-17,-9 --rest 1 -o "$T/out" <"$T/slice" 2>&1 | grep -c 'nothing holds')" 0 \
    "a component that is rounding beside the largest pulls nothing"
fails 1 "1e-6 of it does" "nothing holds the part of element 0 .* along y" tled-run --script "$T/level" -g 3,1e-5,-9 --rest 1 -o "$T/left" <"$T/slice"
printf '0 gravity 6e-16,1e-17,-9\n1 gravity 0,0,0\n' >>"$T/level"
is "$(tled-run --script "$T/level" -n 1 -o "$T/out" <"$T/slice" 2>&1 | grep -c 'nothing holds')" 0 "nor in a script"

# ---- Rest: a soft beam on a hard block that is squeezed, whose forces are far greater than the beam's weight.
{
    cat "$T/boxes.awk"
    echo 'BEGIN { box("block", 0, 0, 0, 40, 40, 40); box("beam", 40, 10, 10, 100, 30, 30) }'
} >"$T/two.awk"
awk -f "$T/two.awk" >"$T/two.obj"
printf 'block level=0 priority=0 material=hard surfaces=block\nbeam level=0 priority=1 material=soft surfaces=beam\n' >"$T/volumes"
printf 'hard E=3e7 nu=0.45\nsoft E=30e3 nu=0.45\n' >"$T/materials"
cat >"$T/squeeze" <<'SCRIPT'
0   displace 0,0,0,0,1,1               0,0,0
0   displace 4cm,0,0,4cm,0,4cm         0,0,0
0.1 displace 4cm,0,0,4cm,0,4cm         0,2mm,0
0   displace 4cm,4cm,0,4cm,4cm,4cm     0,0,0
0.1 displace 4cm,4cm,0,4cm,4cm,4cm     0,-2mm,0
SCRIPT
voxelise -q --unit mm -s 10 --volumes "$T/volumes" --materials "$T/materials" "$T/two.obj" >"$T/two"
tled-run -q -g 0,0,-9.81 --script "$T/squeeze" <"$T/two" >"$T/out"
loose=$(at 0.1,0.02,0.02 3)
tled-run -q -g 0,0,-9.81 --script "$T/squeeze" --rest 1e-6 <"$T/two" >"$T/out"
tight=$(at 0.1,0.02,0.02 3)
near "$loose" "$tight" 1e-3 "a soft beam on a hard block that is squeezed: $loose m at rest to 1e-4"
check "it hangs down by more than 1 cm ($tight m)" awk "BEGIN { exit !($tight < -0.01) }"

# ---- Time steps and divergence.
fails 1 "a step above the stable one" '--dt 0.01 is above the stable step; expected at most 0.000[0-9]* s' \
    run -o "$T/left" --dt 0.01 -t 1
stable=$(run -n 1 2>&1 >/dev/null | sed -n 's/.*stable step \([0-9.]*\) ms.*/\1/p')
run -q -n 100 --dt "$(awk "BEGIN { print $stable * 0.999 / 1000 }")" >"$T/again"
is $? 0 "a step just below it is taken"
near "$stable" "$(awk 'BEGIN { print 1000 * 0.005 / sqrt(3 * 50000 / 1000) }')" 1e-5 "the stable step is h / sqrt(3 K / rho)"
echo '0 force 0.06,0.015,0.015 5mm 100,0,0' >"$T/tear"
fails 3 "a force that tears it" 'tled-run: diverged at step [0-9]+, [0-9.]+ s: element [0-9]+ \(volume .*\)' \
    run -q --script "$T/tear" --dt 0.0003 -t 1 -o "$T/left"
echo '0 force 0.06,0.015,0.015 5mm 1e6,0,0' >"$T/tear"
fails 3 "and a greater one, whatever the step" 'tled-run: diverged at step [0-9]+, [0-9.e-]+ s: element [0-9]+ \(volume .*\)' \
    run -q --script "$T/tear" -t 1 -o "$T/left"
[ ! -e "$T/left" ]
is $? 0 "no output is left by either"
run -q --script "$T/tear" --dt 0.0003 -t 1 2>"$T/stderr" | sinew info >/dev/null 2>"$T/silent"
is "$? $(cat "$T/silent")" "3 " "the tool behind it ends with 3 too, silently"
is "$(wc -l <"$T/stderr" | tr -d ' ')" 1 "one message in all"

# ---- Bad command lines and models.
for bad in '-t -1' '-t x' '-g 1,2' '-g 0,0,0,0' '-t 1 -n 3' '--rest 1e-3 -t 1' '--every 0' '--hourglass -1' '--hourglass isotropic:' '--threads 0' \
    '-d vulkan' '--dt 0' '--damping -1' '--ramp -1' '-n 0' '-n 1.5' '--rest 2' '--precision half' '--gravty 0,0,1' 'model.sinew'; do
    # shellcheck disable=SC2086 # words of an option
    fails 2 "usage: $bad" '^tled-run: .*' run $bad
done
[ -e /dev/nvidia0 ] || fails 1 "-d cuda without a device" 'CUDA|cuda' run -d cuda -n 1
fails 2 "an unknown muscle" "^tled-run: -c: unknown muscle 'baz'; did you mean 'bar'\\?" run -c baz=1
fails 2 "a volume that is no muscle" "unknown muscle 'skin'" run -c skin=1
fails 2 "a level of 2" "level '2' of bar; expected a number from 0 to 1" run -c bar=2
fails 2 "a muscle twice" "given twice" run -c bar=0.1 -c muscle_bar=0.2
fails 2 "no level" "expected MUSCLE=LEVEL" run -c bar
# A model that never saw attach has no fibres, and nothing would come of a contraction.
run -q -n 1 --text | sed -e '/^crc/d' -e '/^frame/,$d' |
    sed '/^array element.fibre/,/^array /{/^array element.fibre/d;/^array /!d;}' >"$T/fibreless"
echo end >>"$T/fibreless"
for device in cpu auto; do
    fails 1 "contraction without fibres, $device" '^tled-run: -c: muscle_bar cannot contract: the model has no fibres .*run attach' \
        sh -c "tled-run -q -d $device -c bar=0.4 -t 0.1 -o '$T/left' <'$T/fibreless'"
done
[ ! -e "$T/left" ]
is $? 0 "no output is left"
check "a sweep may begin at 0" sh -c "tled-run -q -d cpu -c bar=0 -t 0.01 -o '$T/out' <'$T/fibreless'"
fails 1 "a full disk" 'No space left' run -q -n 1 -o /dev/full
fails 1 "and a long run ends there" 'No space left' timeout 180 tled-run -q -t 1e6 --every 0.01 -o /dev/full <"$T/model"
timeout 180 sh -c "tled-run -q -c bar=0.1 -t 1e6 --every 0.01 <'$T/model' 2>'$T/stderr' | head -c 100 >/dev/null"
is "$? $(cat "$T/stderr")" "0 " "or where nobody reads, silently"

edit() { # NAME PATTERN SED: the model, edited as text, is refused
    run -q -n 1 --text 2>/dev/null | sed -e '/^crc/d' -e '/^frame/,$d' -e "$3" >"$T/edited"
    echo end >>"$T/edited"
    cmp -s "$T/edited" "$T/whole_text" && not_ok "$1: an edit that changes nothing"
    fails 1 "$1" "$2" sh -c "tled-run -q -g 0,0,-1 <'$T/edited'"
}
run -q -n 1 --text | sed -e '/^crc/d' -e '/^frame/,$d' >"$T/whole_text"
echo end >>"$T/whole_text"
check "a model may be edited as text" sh -c "tled-run -q -n 1 <'$T/whole_text'"
edit "a negative modulus" 'stdin:[0-9]+: array material.E, row 0: -5; expected 0.001 to 1e12 Pa' '/^array material.E/{n;s/.*/-5/;}'
edit "a fibre of another length" 'stdin:[0-9]+: array element.fibre, row [0-9]+: 0 0 2; expected rows of length 1, to 0.001, or 0 0 0' \
    '/^array element.fibre/{n;s/.*/0 0 2/;}'
edit "a node that is nowhere" 'array node.position, row 0: nan 0 0; expected finite numbers' \
    '/^array node.position/{n;s/.*/nan 0 0/;}'
edit "an unknown law" "unknown law 'mooney'" 's/"neo-hookean"/"mooney"/'
edit "no lattice" 'lattice.spacing' '/lattice.spacing/d'
edit "another spacing" 'not a box' 's/^\(meta lattice.spacing\).*/\1 "0.005 0.005 0.006"/'
edit "gravity to rest where nothing holds the model" 'nothing holds the model' \
    '/^array node.rigid/,/^array /{s/^1$/0/;}'
fails 1 "nothing on stdin" 'no model on stdin \(0 bytes\)' tled-run
head -c 2000 "$T/model" >"$T/cut"
fails 1 "a model that is cut" 'stdin' sh -c "tled-run -q <'$T/cut'"

is "$(tled-run --table mdoc)" "$(sed -n '/^\.\\" synopsis$/,/^\.\\" end synopsis$/{/^\.\\"/!p;}' man/tled-run.1)" \
    "the manual's synopsis is the table's"
done_testing
