#!/bin/sh
# tled-run with a probe: the same colliders as msds-run's, by a penalty; forces against statics; what it refuses.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

# A block of 8 x 8 x 4 cm from equations, in cm; its bottom is bone.
cat >"$T/block.obj" <<'END'
g skin
v 0 0 0
v 8 0 0
v 8 8 0
v 0 8 0
v 0 0 4
v 8 0 4
v 8 8 4
v 0 8 4
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
g bone
v 0 0 -.01
v 8 0 -.01
v 8 8 -.01
v 0 8 -.01
f 9 10 11 12
END
voxelise -q --unit cm -s 0.5 --origin 0,0,0 --allow-open "$T/block.obj" 2>/dev/null | attach -q --rigid bone >"$T/block.sinew"
is "$(sinew info --get axis.element "$T/block.sinew") $(sinew info --get node.rigid.sum "$T/block.sinew")" "2048 289" "a block on bone"
# 5 mm down in 0.4 s, and 0.2 s there.
awk 'BEGIN { for (i = 0; i <= 24; i++) { t = i / 40; d = t < .4 ? .0125 * t : .005; printf "%.4f .04 .04 %.6f 1 0 0 0\n", t, .0401 - d } }' >"$T/press.tum"

# force MODEL: along z, in the last frame.
force() {
    awk '/^array / { what = $2; next } what == "probe.force" { f = $3 } what == "probe.torque" { t = $1 * $1 + $2 * $2 + $3 * $3 } { what = "" }
        END { print f, sqrt(t) }' "$1"
}

cp tests/cli/cube.obj "$T"
for probe in sphere:2cm linear:4cm,1cm curved:4cm,70,15mm "convex:$T/cube.obj"; do
    check "${probe%%:*}" tled-run -v --text --unit mm --probe "$probe" --poses "$T/press.tum" --rest 1e-3 -m tissue.E=10000 -o "$T/run.sinew" <"$T/block.sinew"
    force "$T/run.sinew" >"$T/force"
    read -r newton torque <"$T/force"
    deep=$(sinew info --get node.displacement.at.0.04,0.04,0.04 "$T/run.sinew" | awk '{ print -1e3 * $3 }')
    awk -v f="$newton" -v d="$deep" -v t="$torque" 'BEGIN { exit !(f > .3 && f < 5 && d > 4.5 && d < 4.95 && t < 1e-3 * f) }'
    is $? 0 "${probe%%:*}: pushes back with $newton N, a torque of $torque N m; the node under it is $deep mm down"
    eval "force_${probe%%:*}=$newton"
done
# A stiffer contact changes the force by what it lets in no longer.
tled-run -q --text --probe sphere:2cm --poses "$T/press.tum" --repulsion 4 --rest 1e-3 -m tissue.E=10000 <"$T/block.sinew" >"$T/stiff.sinew"
read -r stiff torque <<END
$(force "$T/stiff.sinew")
END
# shellcheck disable=SC2154 # by eval
awk -v a="$force_sphere" -v b="$stiff" 'BEGIN { exit !(b > a && b < 1.1 * a) }'
is $? 0 "four times the repulsion: $stiff N"

# A plate on a cube that stands without friction: the force is the law's nominal stress at the stretch that comes of it, times the area.
# W = mu/2 (J^-2/3 tr C - 3) + K/2 (J - 1)^2; the sides are free: their stretch b is where no stress is.
sed -n '/^g bone/q; p' "$T/block.obj" | sed 's/8/4/g' | sed 's/^f .*//' >"$T/cube4.obj"
printf 'f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n' >>"$T/cube4.obj"
echo '0 displace -.001,-.001,-.001,.041,.041,.001 -,-,0' >"$T/stand.script"
awk 'BEGIN { for (i = 0; i <= 20; i++) printf "%.3f .02 .02 %.6f 1 0 0 0\n", i / 40, .0401 - .0041 * i / 20 }' >"$T/plate.tum"
voxelise -q --unit cm -s 1 --origin 0,0,0 "$T/cube4.obj" 2>/dev/null |
    tled-run -q --text -m tissue.E=3000 -m tissue.nu=0.45 --script "$T/stand.script" --probe linear:30cm,20cm --poses "$T/plate.tum" --rest 1e-5 >"$T/uniaxial.sinew" 2>/dev/null
read -r newton torque <<END
$(force "$T/uniaxial.sinew")
END
stretch=$(sinew info --get node.displacement.at.0.02,0.02,0.04 "$T/uniaxial.sinew" | awk '{ print 1 + $3 / .04 }')
want=$(awk -v l="$stretch" 'function side(b, J, I) { J = l * b * b; I = l * l + 2 * b * b; return mu * J ^ (-2 / 3) * (b - I / (3 * b)) + K * (J - 1) * J / b }
    BEGIN { mu = 3000 / 2.9; K = 10000; low = .8; high = 1.3
        for (i = 0; i < 100; i++) { b = (low + high) / 2; if (side(b) < 0) low = b; else high = b }
        J = l * b * b; I = l * l + 2 * b * b
        print -.0016 * (mu * J ^ (-2 / 3) * (l - I / (3 * l)) + K * (J - 1) * J / l) }')
near "$newton" "$want" 1e-4 "a plate: $newton N at a stretch of $stretch, the law's $want"

for n in 1 2 3; do
    tled-run -q --threads $n --probe linear:4cm,1cm --poses "$T/press.tum" -t .1 --every .02 <"$T/block.sinew" | cksum
done | sort -u >"$T/sums"
is "$(wc -l <"$T/sums" | tr -d ' ')" 1 "the same bytes by 1, 2 and 3 threads"
check "in two parts" sh -c "tled-run -q --probe sphere:2cm --poses '$T/press.tum' -t .2 <'$T/block.sinew' | tled-run -q --probe sphere:2cm --poses '$T/press.tum' -t .2 >'$T/two.sinew' 2>'$T/said'"
tled-run -q --probe sphere:2cm --poses "$T/press.tum" -t .4 <"$T/block.sinew" >"$T/one.sinew"
is "$(sinew info --get node.displacement.max "$T/one.sinew")" "$(sinew info --get node.displacement.max "$T/two.sinew")" "in two parts: the same"

echo '0 .04 .04 .035 1 0 0 0' >"$T/inside.tum"
check "starts inside" tled-run --probe sphere:2cm --poses "$T/inside.tum" -t .3 -o "$T/inside.sinew" <"$T/block.sinew"
is "$(grep -c 'the probe begins 5 mm inside the tissue: its contact force rises over 0.1 s' "$T/stderr")" 1 "it says so"
check "larger than the tissue" tled-run --probe linear:30cm,20cm --poses "$T/press.tum" -t .3 -o "$T/plate.sinew" <"$T/block.sinew"
is "$(grep -c 'larger than the tissue: it presses like a plate' "$T/stderr")" 1 "it says so"
check "thinner than an element" tled-run --probe linear:3cm,3mm --poses "$T/press.tum" -n 5 -o /dev/null <"$T/block.sinew"
is "$(grep -c 'the probe is 3 mm thick, elements are [0-9.]* mm wide: it may slip between nodes' "$T/stderr")" 1 "it says so"
awk '{ $2 *= 1000; $3 *= 1000; $4 *= 1000; print }' "$T/press.tum" >"$T/mm.tum"
check "poses in millimetres" tled-run --probe sphere:2cm --poses "$T/mm.tum" -n 5 -o /dev/null <"$T/block.sinew"
is "$(grep -c 'the probe never comes near the tissue; expected poses in metres' "$T/stderr")" 1 "are said to be far away"
check "poses in metres" tled-run --probe sphere:2cm --poses "$T/press.tum" -n 5 -o /dev/null <"$T/block.sinew"
is "$(grep -c 'never comes near' "$T/stderr")" 0 "have no such word"
# Hertz: a ball of 12 cm pressed .3 mm into a bonded layer of 2 cm that is 20 contact radii wide, a quarter of it.
hertz() { # WHAT OPTION...
    what=$1
    shift
    awk -v W=60 -v H=20 -v R=120 -v D=.3 -v what="$what" "$@" -f tests/cli/hertz.awk
}
hertz layer >"$T/layer.obj"
hertz poses >"$T/layer.tum"
hertz script -v still=1 >"$T/layer.script"
voxelise -q --unit mm -s 2 "$T/layer.obj" | attach -q |
    tled-run -q -d cpu --text --precision single -m tissue.nu=.45 --script "$T/layer.script" --probe sphere:120mm --poses "$T/layer.tum" --repulsion 4 --damping 200 -t .13 >"$T/layer" 2>/dev/null
force "$T/layer" >"$T/force"
read -r newton torque <"$T/force"
near "$(awk -v f="$newton" -v want="$(hertz force -v E=3000 -v nu=.45)" 'BEGIN { print f / want }')" 1 .03 "a ball presses as the bonded layer's formula says"
fails 2 "poses without a probe" 'expected both' tled-run --poses "$T/press.tum" -t .1 <"$T/block.sinew"
{ cat "$T/inside.tum"; echo 'method fem'; } >"$T/method.tum"
fails 1 "a change of method" 'method.tum:2: .*expected poses alone' tled-run --probe sphere:2cm --poses "$T/method.tum" -t .1 <"$T/block.sinew"
fails 1 "a step too long with contact" 'above the stable step' tled-run --probe sphere:2cm --poses "$T/press.tum" --dt "$(tled-run -n 1 -o /dev/null <"$T/block.sinew" 2>&1 | sed -n 's/.*stable step \([^ ]*\) ms.*/\1/p' | awk '{ print $1 * .9e-3 }')" -n 5 <"$T/block.sinew"
# A ball without friction that leans by .3: all of its force goes through its centre, 1 cm behind the origin, and the torque with it.
awk -v nx=6 -v ny=6 -v nz=3 -v h=0.005 -v held=low -f tests/cli/block.awk >"$T/lean.sinew"
echo '0 .02 .015 .012 .98877107793604228 0 -.14943813247359922 0' >"$T/lean.tum"
tled-run -q -d cpu --text --probe sphere:1cm --poses "$T/lean.tum" -t .15 <"$T/lean.sinew" 2>/dev/null |
    awk '/^array / { what = $2; next } what == "probe.force" { x = $1; z = $3 } what == "probe.torque" { printf "%.12g %s\n", .01 * (cos(.3) * x - sin(.3) * z), $2 } { what = "" }' >"$T/lean"
read -r want got <"$T/lean"
near "$got" "$want" 1e-6 "the torque of a ball is its force's, through its centre: $got N m"

done_testing
