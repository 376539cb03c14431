#!/bin/sh
# Probes of every shape in msds-run: forces and torques, rates of poses, poses that start inside, probes larger than the tissue, OBJ files
# that are no convex body. With SINEW_LONG at 120 poses a second too.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

msds-mesh -q --nodes 21x11x8 --size 12cm,6cm,4cm --young 10000 --poisson 0.45 --density 1000 >"$T/block.sinew"

# press HZ: 10 mm down in half a second, a quarter of a second there, and back, at so many poses a second, 5 mm beside the middle.
press() {
    awk -v hz="$1" 'BEGIN { for (i = 0; i <= hz; i++) { t = i / hz; d = t < .5 ? .02 * t : t < .8 ? .01 : .05 * (1 - t);
        printf "%.6f .065 .03 %.7f 1 0 0 0\n", t, .0405 - d } }'
}
for hz in 30 60 120; do
    press "$hz" >"$T/press$hz.tum"
done
cp tests/cli/cube.obj "$T"

# Forces, N, at seconds .3, .5 and .8 of a run.
forces() {
    msds-run -v -o "$T/run.sinew" "$@" <"$T/block.sinew" 2>&1 | awk '$2 == .3 || $2 == .5 || $2 == .8 { printf "%s ", $5 }'
}

rates='30 120'
[ "$SINEW_LONG" ] || rates=30
for probe in sphere:2cm linear:4cm,1cm curved:4cm,70,15mm "convex:$T/cube.obj"; do
    for method in msds fem 'fem --exact'; do
        [ "$method $probe" = 'fem --exact sphere:2cm' ] && continue # slow; the other shapes show it
        for hz in 60 $rates; do
            # shellcheck disable=SC2086
            forces --method $method --unit mm --probe "$probe" --poses "$T/press$hz.tum" >"$T/forces$hz"
        done
        read -r half down held <"$T/forces60"
        name="${probe%%:*}, $method"
        awk -v a="$half" -v b="$down" -v c="$held" 'BEGIN { exit !(a > .1 && b > a && c > .8 * a) }'
        is $? 0 "$name: pushes back with $half, $down, $held N"
        for hz in $rates; do
            awk 'NR == 1 { split($0, a) } NR == 2 { for (i = 1; i <= 3; i++) bad += !(($i - a[i]) ^ 2 <= (.02 * a[i]) ^ 2) } END { exit NR != 2 || bad > 0 }' \
                "$T/forces60" "$T/forces$hz"
            is $? 0 "$name: the same within 2 % at $hz poses a second: $(cat "$T/forces$hz")"
        done
        # Springs know no volume: under the cube's edge a tetrahedron turns inside out, and stays so.
        [ "$method ${probe%%:*}" = 'msds convex' ] && continue
        rest=$(sinew info --get node.displacement.max "$T/run.sinew")
        awk -v r="$rest" 'BEGIN { exit !(r < .001) }'
        is $? 0 "$name: let go of, the tissue is back to $rest m"
    done
done
echo '0 .06 .03 .03 1 0 0 0' >"$T/inside.tum"
is "$(msds-run -q --probe "convex:$T/cube.obj" --unit mm --poses "$T/inside.tum" <"$T/block.sinew" | sinew info | grep -c "$T")" 0 "no folder in provenance"
is "$(msds-run -q --probe "convex:$T/cube.obj" --unit mm --poses "$T/inside.tum" <"$T/block.sinew" | sinew info | grep -c -- '--probe convex:cube.obj ')" 1 "but the file"

# The torque is the forces' arms: beside the middle of a symmetric block, pushed up more on one side.
cat >"$T/side.tum" <<'END'
0 .03 .03 .0405 1 0 0 0
.1 .03 .03 .035 1 0 0 0
END
msds-run -q --text --method fem --exact --probe linear:4cm,1cm --poses "$T/side.tum" <"$T/block.sinew" |
    awk '/^array / { what = $2; next } what == "probe.force" { f = $3 } what == "probe.torque" { t = $2 } { what = "" } END { print f, t }' >"$T/side"
read -r force torque <"$T/side"
awk -v f="$force" -v t="$torque" 'BEGIN { exit !(f > .1 && t != 0 && t * t < (.02 * f) ^ 2) }'
is $? 0 "a torque of $torque N m at $force N: an arm within the face"

# At once inside; and larger than the tissue.
for method in msds fem 'fem --exact'; do
    for probe in linear:3cm,1cm sphere:15mm; do
        # shellcheck disable=SC2086
        check "$probe: starts inside, $method" msds-run --method $method --probe $probe --poses "$T/inside.tum" -o "$T/inside.sinew" <"$T/block.sinew"
        is "$(grep -c 'inside.tum:1: the probe begins inside the tissue; it is moved in along its axis, from [1-9][0-9.]* mm back' "$T/stderr")" 1 "it says so"
        deep=$(sinew info --get node.displacement.at.0.06,0.03,0.04 "$T/inside.sinew" | awk '{ print -1e3 * $3 }')
        awk -v d="$deep" 'BEGIN { exit !(d > 7 && d < 11) }'
        is $? 0 "and tissue goes down before it: $deep mm"
    done
done
for method in msds fem 'fem --exact'; do
    # shellcheck disable=SC2086
    check "larger than the tissue, $method" msds-run --method $method --probe linear:30cm,20cm --poses "$T/press30.tum" -o "$T/plate.sinew" <"$T/block.sinew"
    is "$(grep -c 'larger than the tissue: it presses like a plate' "$T/stderr")" 1 "it says so"
done

# Thinner than cells are wide: it goes in between their nodes.
awk '{ $2 = .063; $3 = .033; print }' "$T/press30.tum" >"$T/gap.tum"
check "thinner than cells" msds-run --probe linear:3cm,4mm --poses "$T/gap.tum" -o "$T/gap.sinew" <"$T/block.sinew"
is "$(grep -c 'the probe is 4 mm thick, cells are 5[0-9.]* mm wide: it may slip between nodes' "$T/stderr")" 1 "it says so"
check "as thick as cells" msds-run --probe linear:3cm,6mm --poses "$T/gap.tum" -o "$T/gap.sinew" <"$T/block.sinew"
is "$(grep -c 'between nodes' "$T/stderr")" 0 "has no such word"

# What is no convex body.
fails 1 "a convex probe without a unit" 'expected --unit' msds-run --probe "convex:$T/cube.obj" --poses "$T/press30.tum" <"$T/block.sinew"
fails 2 "an unknown shape" 'expected sphere:RADIUS' msds-run --probe cone:3 --poses "$T/press30.tum" <"$T/block.sinew"
sed '$d' "$T/cube.obj" >"$T/open.obj"
fails 1 "an open one" 'open.obj: 4 open edges.*expected a closed convex' msds-run --unit mm --probe "convex:$T/open.obj" --poses "$T/press30.tum" <"$T/block.sinew"
sed 's/^v 10 10 0/v 2 2 -15/' "$T/cube.obj" >"$T/dent.obj"
fails 1 "a dent" 'dent.obj: .*not convex' msds-run --unit mm --probe "convex:$T/dent.obj" --poses "$T/press30.tum" <"$T/block.sinew"
fails 1 "no file" 'none.obj: cannot open' msds-run --unit mm --probe "convex:$T/none.obj" --poses "$T/press30.tum" <"$T/block.sinew"

done_testing
