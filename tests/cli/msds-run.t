#!/bin/sh
# msds-run as a tool: frames live through a FIFO, changes of method, what it refuses; and CalculiX's linear C3D4 on the same mesh.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

block="--nodes 9x9x7 --size 8cm,8cm,6cm --young 10000 --poisson 0.4 --density 1000"
# shellcheck disable=SC2086
msds-mesh -q $block >"$T/block.sinew"

# press N: poses, each half a millimetre deeper.
press() {
    awk -v n="$1" 'BEGIN { for (i = 0; i < n; i++) printf "%g .04 .04 %.4f 1 0 0 0\n", i / 60, .06 - .0005 * i }'
}
press 10 >"$T/press.tum"
head -n 4 "$T/press.tum" >"$T/four.tum"
sed -n 5p "$T/press.tum" >"$T/fifth.tum"

check "large strains, if no method is named" msds-run -v --probe sphere:2cm --poses "$T/press.tum" -o "$T/msds.sinew" <"$T/block.sinew"
is "$(awk '$3 == "tissue" { rows++ } END { print rows + 0 }' "$T/stderr") $(grep -c 'stable step' "$T/stderr")" "10 0" "in each frame; nothing is said of springs"
check "springs" msds-run --method msds --probe sphere:2cm --poses "$T/press.tum" -o "$T/msds.sinew" <"$T/block.sinew"
is "$(grep -c 'stable step' "$T/stderr")" 1 "says the stable step"
is "$(grep -c 'inertia is' "$T/stderr")" 1 "says by what inertia grew"
is "$(sinew info --get frames "$T/msds.sinew")" 10 "a frame a pose"
check "finite elements" msds-run --method fem --residual --probe sphere:2cm --poses "$T/press.tum" -o "$T/fem.sinew" <"$T/block.sinew"
is "$(awk '$3 == "fem" && NF == 8' "$T/stderr" | wc -l | tr -d ' ') $(grep -c springs "$T/stderr")" "10 0" "says what each frame leaves, and nothing of springs"
check "exactly" msds-run --method fem --exact --residual --probe sphere:2cm --poses "$T/press.tum" -o "$T/exact.sinew" <"$T/block.sinew"
awk '$3 == "fem-exact" { if ($6 + 0 > 1e-6) bad++; n++ } END { exit !(n == 10 && !bad) }' "$T/stderr"
is $? 0 "each frame to 1e-6"
deep=$(sinew info --get node.displacement.at.0.04,0.04,0.06 "$T/exact.sinew" | awk '{ print $3 }')
near "$deep" -0.0045 0.0001 "the node under the pole is where the pole is"

# One line of poses at a time: its frame is there before the next is written.
mkfifo "$T/live"
msds-run -q --text --probe sphere:2cm --poses "$T/live" <"$T/block.sinew" >"$T/live.sinew" &
run=$!
exec 3>"$T/live"
seen=
for i in 1 2 3; do
    sed -n "${i}p" "$T/press.tum" >&3
    tries=0
    while [ "$(grep -c '^frame ' "$T/live.sinew")" -lt "$i" ] && [ "$tries" -lt 1800 ]; do
        sleep 0.1
        tries=$((tries + 1))
    done
    seen="$seen$(grep -c '^frame ' "$T/live.sinew")"
done
exec 3>&-
wait "$run"
is "$? $seen" "0 123" "through a FIFO each frame comes before the next pose"

# A probe that leaves, and stays away: exact frames find rest again, and stay there.
awk 'BEGIN { for (i = 0; i < 12; i++) printf "%g .04 .04 %.4f 1 0 0 0\n", i / 60, i < 4 ? .06 - .001 * i : .08 }' >"$T/leave.tum"
for warp in '' --warp; do
    # shellcheck disable=SC2086
    check "a probe that leaves exact frames $warp" msds-run --method fem --exact $warp --probe sphere:2cm --poses "$T/leave.tum" -o "$T/leave.sinew" <"$T/block.sinew"
    cp "$T/stderr" "$T/leave.said"
    sinew info --tsv node.displacement.max --tsv probe.force "$T/leave.sinew" | awk -F '\t' '
        function size() { return sqrt($4 ^ 2 + $5 ^ 2 + $6 ^ 2) }
        NR > 1 && $3 > u { u = $3; at = $2 }
        NR > 1 && size() > f { f = size(); when = $2 }
        END { printf "12 poses, to %.6g s: largest displacement %.6g mm, at %.6g s; largest force on the probe %.4g N, at %.6g s\n", $2, 1e3 * u, at, f, when }' >"$T/want"
    is "$(sed -n '/poses, to/{s/^msds-run: //;s/ from [0-9]* nodes*,//;p;}' "$T/leave.said")" "$(cat "$T/want")" "the largest of all poses, when"
    check "lets go of the tissue" awk -v u="$(sinew info --get node.displacement.max "$T/leave.sinew")" 'BEGIN { exit !(u < 1e-8) }'
done
awk 'BEGIN { for (i = 0; i < 60; i++) printf "%g .04 .04 %.4f 1 0 0 0\n", i / 60, i < 4 ? .06 - .001 * i : .08 }' >"$T/leave.tum"
check "a probe that leaves frames of conjugate gradients" msds-run --residual --method fem --probe sphere:2cm --poses "$T/leave.tum" -o "$T/leave.sinew" <"$T/block.sinew"
is "$(awk '$3 == "fem" { at = $6 + 0 < 1e-5 } END { print at + 0 }' "$T/stderr")" 1 "leaves nothing but what is slight"

# Methods change between poses, and the state carries over.
{ sed -n 1,4p "$T/press.tum"; echo 'method fem'; sed -n 5,7p "$T/press.tum"; echo 'method msds'; sed -n 8,10p "$T/press.tum"; } >"$T/both.tum"
check "methods change in the stream" msds-run -v --method msds --exact --probe sphere:2cm --poses "$T/both.tum" -o "$T/both.sinew" <"$T/block.sinew"
is "$(grep -c '  fem-exact  ' "$T/stderr") $(grep -c '  msds  ' "$T/stderr") $(grep -c 'time/s' "$T/stderr")" "3 7 1" "three frames by the FEM, seven by springs"
is "$(grep -c 'springs: inertia is' "$T/stderr")" 1 "their inertia is said once"
sed -n '5,$p' "$T/both.tum" >"$T/late.tum"
check "springs that come later" msds-run --method fem --probe sphere:2cm --poses "$T/late.tum" -o /dev/null <"$T/block.sinew"
is "$(grep -c 'springs: inertia is' "$T/stderr")" 1 "are told of then"
sed -n 1,4p "$T/press.tum" >"$T/first.tum"
sed -n 5,10p "$T/press.tum" >"$T/last.tum"
msds-run -q --method fem --exact --probe sphere:2cm --poses "$T/first.tum" <"$T/block.sinew" |
    msds-run -q --method fem --exact --probe sphere:2cm --poses "$T/last.tum" >"$T/parts.sinew"
check "in two parts: the same" sinew diff --rel 1e-4 --abs 1e-8 --only node.displacement "$T/exact.sinew" "$T/parts.sinew"

# Five methods by their names, or by options that add to fem; and by names in the stream.
frames() {
    sed -n '/^frame /,$p' "$1"
}
for method in 'exact:fem --exact' 'warp:fem --warp' 'exact-warp:fem --exact --warp' 'exact-warp:exact --warp' 'exact-warp:warp --exact'; do
    msds-run -q --text --method "${method%%:*}" --probe sphere:2cm --poses "$T/four.tum" <"$T/block.sinew" >"$T/named.sinew"
    # shellcheck disable=SC2086
    msds-run -q --text --method ${method#*:} --probe sphere:2cm --poses "$T/four.tum" <"$T/block.sinew" >"$T/flags.sinew"
    { echo "method ${method%%:*}"; cat "$T/four.tum"; } >"$T/line.tum"
    msds-run -q --text --probe sphere:2cm --poses "$T/line.tum" <"$T/block.sinew" >"$T/line.sinew"
    is "$(frames "$T/flags.sinew" | cksum) $(frames "$T/line.sinew" | cksum)" "$(frames "$T/named.sinew" | cksum) $(frames "$T/named.sinew" | cksum)" "${method%%:*} is ${method#*:}"
done
is "$(frames "$T/named.sinew" | grep -c '^frame ')" 4 "of four frames each"
{ cat "$T/four.tum"; echo 'method warp'; cat "$T/fifth.tum"; echo 'method exact-warp'; cat "$T/fifth.tum"; echo 'method fem'; cat "$T/fifth.tum"; echo 'method tissue'; cat "$T/fifth.tum"; echo 'method exact'; cat "$T/fifth.tum"; } >"$T/all.tum"
check "all methods in one run" msds-run -v --method msds --probe sphere:2cm --poses "$T/all.tum" -o "$T/all.sinew" <"$T/block.sinew"
is "$(awk '/time\/s/ { on = 1; next } on && NF == 8 { printf "%s ", $3 }' "$T/stderr")" "msds msds msds msds warp exact-warp fem tissue fem-exact " "each frame by its own"
echo 'method wrap' >"$T/wrap.tum"
fails 1 "a method that is none" "wrap.tum:1: unknown method 'wrap'; did you mean 'warp'\?" msds-run --poses "$T/wrap.tum" <"$T/block.sinew"

check "compares" msds-run --method msds --compare --exact --spring-scale auto --probe sphere:2cm --poses "$T/press.tum" -o /dev/null <"$T/block.sinew"
is "$(awk '/time\/s/ { on = NF; next } on && NF == on { rows++ } END { print on, rows + 0 }' "$T/stderr")" "11 10" "a difference a frame"
is "$(grep -Ec '^msds-run: 10 poses, to [0-9.]+ s: largest displacement [0-9.]+ mm, at [0-9.]+ s; largest force on the probe [0-9.]+ N, from [0-9]+ nodes, at [0-9.]+ s$' "$T/stderr")" 1 "and the end"

# The root mean square of their difference, by hand from both.
for method in msds 'fem --exact'; do
    # shellcheck disable=SC2086
    msds-run -q --text --method $method --spring-scale auto --probe sphere:2cm --poses "$T/press.tum" <"$T/block.sinew" |
        awk '/^frame/ { frame = $2 } /^[a-z]/ { on = $2 == "node.displacement" && frame == 9; next } on' >"$T/${method%% *}.rows"
done
by_hand=$(paste "$T/msds.rows" "$T/fem.rows" | awk '{ for (i = 1; i <= 3; i++) { off += ($i - $(i + 3)) ^ 2; size += $(i + 3) ^ 2 } }
    END { printf "%.4g", sqrt(off / size) }')
near "$(awk '$3 == "msds" { rms = $9 } END { print rms }' "$T/stderr")" "$by_hand" 1e-3 "which is that of both by hand, $by_hand"

# What is carried: the first frame after a change is that of a run which begins with the frames before.
for change in 'msds:fem' 'fem:msds'; do
    { cat "$T/four.tum"; echo "method ${change#*:}"; cat "$T/fifth.tum"; } >"$T/change.tum"
    msds-run -q --iterations 5 --method "${change%:*}" --probe sphere:2cm --poses "$T/change.tum" <"$T/block.sinew" >"$T/change.sinew"
    msds-run -q --iterations 5 --method "${change%:*}" --probe sphere:2cm --poses "$T/four.tum" <"$T/block.sinew" |
        msds-run -q --iterations 5 --method "${change#*:}" --probe sphere:2cm --poses "$T/fifth.tum" >"$T/parts.sinew"
    check "$change: displacements and velocities carry over" sinew diff --rel 1e-3 --abs 2e-5 --only node.displacement,node.velocity \
        "$T/change.sinew" "$T/parts.sinew"
    msds-run -q --iterations 5 --method "${change#*:}" --probe sphere:2cm --poses "$T/fifth.tum" <"$T/block.sinew" >"$T/fresh.sinew"
    carried=$(sinew info --get node.displacement.at.0.04,0.04,0.04 "$T/parts.sinew" | awk '{ print $3 }')
    fresh=$(sinew info --get node.displacement.at.0.04,0.04,0.04 "$T/fresh.sinew" | awk '{ print $3 }')
    check "$change: from rest it is another ($fresh, not $carried m)" awk -v a="$carried" -v b="$fresh" 'BEGIN { exit !((a - b) / a > 0.02 || (a - b) / a < -0.02) }'
done

# A PLUS sequence as poses, in mm, of two transforms.
{
    printf 'ObjectType = Image\nNDims = 3\nDimSize = 5 4 2\n'
    for i in 0 1; do
        printf 'Seq_Frame000%d_ProbeToReferenceTransform = 1 0 0 40 0 -1 0 40 0 0 -1 %d 0 0 0 1\n' "$i" $((59 - i))
        printf 'Seq_Frame000%d_StylusToReferenceTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\nSeq_Frame000%d_Timestamp = %d.5\n' "$i" "$i" "$i"
    done
    printf 'ElementDataFile = LOCAL\n'
} >"$T/sweep.mha"
check "a PLUS sequence" msds-run -q --text --transform ProbeToReference --probe sphere:2cm --poses "$T/sweep.mha" -o "$T/sweep.sinew" <"$T/block.sinew"
is "$(awk '/^array probe.pose/ { getline; print $1, $2, $3, $4 }' "$T/sweep.sinew" | tr '\n' ';')" \
    "0.040000000000000001 0.040000000000000001 0.058999999999999997 1;0.040000000000000001 0.040000000000000001 0.058000000000000003 1;" "in metres"
fails 1 "a transform of lines" 'press.tum: lines of poses have no transform NoseToReference; expected a PLUS sequence' \
    msds-run --transform NoseToReference --poses "$T/press.tum" <"$T/block.sinew"
fails 1 "a transform that it has not" 'sweep.mha:[0-9]*: frame 0 does not say where Nose is' \
    msds-run --transform NoseToReference --poses "$T/sweep.mha" <"$T/block.sinew"

for method in msds 'fem' 'fem --exact' 'fem --warp' 'fem --exact --warp'; do
    # shellcheck disable=SC2086
    for n in 1 2 3; do
        msds-run -q --threads $n --method $method --probe sphere:2cm --poses "$T/press.tum" <"$T/block.sinew" | cksum
    done | sort -u >"$T/sums"
    is "$(wc -l <"$T/sums" | tr -d ' ')" 1 "$method: the same bytes by 1, 2 and 3 threads"
done

# Exact frames of a plate on a slab take long: on a terminal it is shown which pose and what of it, and a pipe and -q see nothing.
msds-mesh -q --nodes 71x71x4 --size 8cm,8cm,1cm --young 10000 --poisson 0.4999 >"$T/slab.sinew"
echo '0 .04 .04 .0095 1 0 0 0' >"$T/slab.tum"
slab="--threads 1 --method fem --exact --probe linear:7cm,7cm --poses $T/slab.tum -o $T/slab.out"
if have script; then
    script -qec "msds-run $slab <$T/slab.sinew" /dev/null >"$T/shown"
    tr '\r' '\n' <"$T/shown" >"$T/lines"
    is "$(grep -c '^msds-run: pose 1, 0 s: solve 1, .*[1-9][0-9]* nodes near the probe: [a-z ]*, [0-9]* %' "$T/lines" |
        awk '{ print ($1 > 1) }')" 1 "progress within a pose"
    is "$(tail -c 4 "$T/shown" | od -An -c | tr -d ' \n')" '\r033[K' "the line is cleared at the end"
    script -qec "msds-run -q $slab <$T/slab.sinew" /dev/null >"$T/shown"
    is "$(grep -c pose "$T/shown")" 0 "none with -q"
    # shellcheck disable=SC2086
    msds-run $slab <"$T/slab.sinew" 2>"$T/stderr"
    is "$(grep -c 'pose [0-9]' "$T/stderr")" 0 "nor where nobody watches"
else
    skip 4 "no script of util-linux"
fi

# Physical masses: substeps, or a refusal.
check "physical masses" msds-run --method msds --mass lumped --dt 1e-4 --iterations 5 --probe sphere:2cm --poses "$T/first.tum" -o /dev/null <"$T/block.sinew"
is "$(grep -c 'each step is cut into' "$T/stderr")" 1 "substeps are said"
fails 1 "a step past all substeps" 'times the stable step; expected' msds-run --mass lumped --dt 10 --poses "$T/first.tum" <"$T/block.sinew"

# What is bad.
fails 1 "a probe of radius 0" 'radius of 0 m; expected 1e-09 to 1e\+06 m' msds-run --probe sphere:0 --poses "$T/press.tum" <"$T/block.sinew"
fails 2 "no poses" 'poses' msds-run <"$T/block.sinew"
echo '0 0 0 nan 0 0 0 1' >"$T/nan.tum"
fails 1 "a nan" 'nan.tum:1: ' msds-run --poses "$T/nan.tum" <"$T/block.sinew"
{ sed -n 3p "$T/press.tum"; sed -n 1p "$T/press.tum"; } >"$T/back.tum"
fails 1 "poses out of order" 'back.tum:2: ' msds-run --poses "$T/back.tum" <"$T/block.sinew"
: >"$T/empty.tum"
fails 1 "no pose" 'no pose; expected' msds-run --poses "$T/empty.tum" <"$T/block.sinew"
msds-run -q --text --poses "$T/first.tum" <"$T/block.sinew" | awk '/^frame/ { exit } /^crc/ { next } { print } END { print "end" }' >"$T/text.sinew"
awk '/^array element.node/ { print; getline; print $2, $1, $3, $4; next } { print }' "$T/text.sinew" >"$T/inverted.sinew"
at=$(awk '/^array element.node/ { print NR + 1 }' "$T/inverted.sinew")
fails 1 "an inverted element" "stdin:$at: element 0 is inverted" msds-run --poses "$T/first.tum" <"$T/inverted.sinew"
awk '/^array material.nu/ { print; getline; print "0.5"; next } { print }' "$T/text.sinew" >"$T/nu.sinew"
at=$(awk '/^array material.nu/ { print NR + 1 }' "$T/nu.sinew")
fails 1 "nu = .5" "stdin:$at: array material.nu, row 0: 0.5; expected -0.99 to 0.4999" msds-run --poses "$T/first.tum" <"$T/nu.sinew"
echo 'method fem' >"$T/method.tum"
fails 1 "changes of method and no pose" 'method.tum: no pose; expected' msds-run --poses "$T/method.tum" <"$T/block.sinew"
printf '0 .04 .04 .07 1 0 0 0\n0.1 .04' >"$T/cut.tum"
fails 1 "a pose that is cut short" 'cut.tum:2: 2 words; expected time tx' msds-run --poses "$T/cut.tum" <"$T/block.sinew"
mkfifo "$T/fifo"
printf '0 .04 .04 .07 1 0 0 0\n0.1 .0' >"$T/fifo" &
fails 1 "a FIFO whose writer goes in the middle of a pose" 'fifo:2: 2 words' msds-run -o "$T/left" --poses "$T/fifo" <"$T/block.sinew"
: >"$T/fifo" &
fails 1 "a FIFO whose writer says nothing" 'fifo: no pose' msds-run -o "$T/left" --poses "$T/fifo" <"$T/block.sinew"
check "no output is left" test ! -e "$T/left"
echo '0 .04 .04 .5 1 0 0 0' >"$T/far.tum"
fails 0 "a probe that never touches" 'warning: the probe touches nothing in any frame \(1 in all\)' \
    msds-run --probe sphere:2cm --poses "$T/far.tum" -o /dev/null <"$T/block.sinew"
fails 0 "and one that does" 'node' msds-run --probe sphere:2cm --poses "$T/press.tum" -o /dev/null <"$T/block.sinew"
is "$(grep -c warning "$T/stderr")" 0 "has no such word"
awk '/^array material.E/ { print; getline; print "nan"; next } { print }' "$T/text.sinew" >"$T/E.sinew"
fails 1 "E = nan" 'material.E, row 0: nan is not allowed; expected 0.001 to 1e12 Pa' msds-run --poses "$T/first.tum" <"$T/E.sinew"
awk '/^array node.position/ { print; getline; print "0 nan 0"; next } { print }' "$T/text.sinew" >"$T/place.sinew"
at=$(awk '/^array node.position/ { print NR + 1 }' "$T/place.sinew")
fails 1 "a place that is nan" "stdin:$at: array node.position, row 0: 0 nan 0; expected finite numbers" msds-run --poses "$T/first.tum" <"$T/place.sinew"
awk '/^array element.node/ { print; getline; print $1, $2, $3, $3; next } { print }' "$T/text.sinew" >"$T/flat.sinew"
fails 1 "a flat element" 'stdin:[0-9]*: element.node, row 0 has 3 different nodes' msds-run --poses "$T/first.tum" <"$T/flat.sinew"
# shellcheck disable=SC2086
msds-mesh -q $block --fix none >"$T/free.sinew" 2>"$T/err"
fails 1 "an exact FEM that nothing holds" 'nothing holds node' msds-run --method fem --exact --poses "$T/first.tum" <"$T/free.sinew"
fails 1 "no model" 'no model on stdin' msds-run --poses "$T/first.tum" </dev/null

# Frames are written while the next is computed: what is wrong with the output is said as it is of any other.
if [ -w /dev/full ]; then
    # shellcheck disable=SC2016
    fails 1 "frames on a full device" '^msds-run: stdout: cannot write: No space' \
        sh -c 'msds-run -q --probe sphere:2cm --poses "$1" <"$2" >/dev/full' - "$T/press.tum" "$T/block.sinew"
else
    skip 1 "no /dev/full"
fi
mkfifo "$T/closed"
msds-run -q --probe sphere:2cm --poses "$T/press.tum" <"$T/block.sinew" >"$T/closed" 2>"$T/err" &
run=$!
head -c 1000 "$T/closed" >"$T/read"
wait "$run"
is "$? $(wc -c <"$T/err" | tr -d ' ')" "141 0" "a reader that ends: so does the run, quietly"

# The hanging block, by CalculiX's linear tetrahedra and ours.
if have ccx; then
    # shellcheck disable=SC2086
    msds-mesh -q $block --fix zmax >"$T/hang.sinew"
    echo '0 0 0 1 0 0 0 1' >"$T/one.tum"
    check "an input file" sinew export -f inp -g 0,0,-9.81 -o "$T/hang.inp" "$T/hang.sinew"
    check "CalculiX takes it" sh -c "cd '$T' && ccx -i hang >hang.log && grep -q 'Job finished' hang.log"
    msds-run -q --text --method fem --exact -g 0,0,-9.81 --poses "$T/one.tum" <"$T/hang.sinew" >"$T/hang.rest"
    awk -f tests/cli/calculix.awk "$T/hang.dat" "$T/hang.rest" >"$T/differences"
    read -r worst mean furthest inside nodes <"$T/differences"
    is "${nodes%% *}" 567 "the same nodes"
    near "$worst" 0 1e-4 "every node within 1e-4 of CalculiX (largest difference $worst, mean $mean, $furthest $inside)"
    msds-run -q --text --method fem --iterations 400 -g 0,0,-9.81 --poses "$T/one.tum" <"$T/hang.sinew" >"$T/hang.cg"
    awk -f tests/cli/calculix.awk "$T/hang.dat" "$T/hang.cg" >"$T/differences"
    read -r worst mean furthest inside nodes <"$T/differences"
    near "$worst" 0 1e-4 "and by 400 conjugate gradients"
else
    skip 5 "no CalculiX (calculix-ccx)"
fi

done_testing
