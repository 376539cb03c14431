#!/bin/sh
# msds-run --friction: Coulomb's law of a plate on a cube, by each method that has it: what slips pulls with mu times what presses, what sticks
# moves with the probe and comes back with it; the same bytes; lines that change it; what is refused.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

# A cube of 4 cm under a plate that is larger, 2 mm into it, then moved aside by SIDE mm in 40 frames, held for 10, and brought back.
msds-mesh -q --nodes 7x7x7 --size 4cm,4cm,4cm --young 10000 --poisson .3 -o "$T/cube.sinew"
# drag SIDE: the poses.
drag() {
    awk -v side="$1" 'BEGIN { for (i = 0; i <= 120; i++) { d = i < 10 ? i / 10 : 1; s = i < 20 ? 0 : i < 60 ? (i - 20) / 40 : i < 70 ? 1 : i < 110 ? (110 - i) / 40 : 0
        printf "%.7f %.7f .02 %.6f 1 0 0 0\n", i / 60, .02 + .001 * side * s, .0405 - .0025 * d } }'
}
drag 8 >"$T/far.tum"
drag .1 >"$T/near.tum"
# run POSES OPTIONS...: and FRAMES: the force on the probe aside over that up, by frame.
run() {
    poses=$1
    shift
    msds-run -q --probe linear:30cm,20cm --poses "$T/$poses.tum" "$@" -o "$T/run.sinew" <"$T/cube.sinew" 2>"$T/said"
    sinew info --tsv probe.force "$T/run.sinew" | awk 'NR > 1 { print $3, $5, $3 / ($5 > 0 ? $5 : 1) }' >"$T/forces"
}
for method in fem warp tissue 'fem --contact penalty' 'tissue --contact penalty'; do
    for mu in .05 .2; do
        # shellcheck disable=SC2086
        run far --method $method --friction $mu
        is "$(awk -v mu=$mu 'NR == 21 { rest = $3 } NR == 61 || NR == 70 { bad += !($3 < -.97 * mu && $3 > -1.001 * mu) } NR == 111 { bad += !($3 > .97 * mu && $3 < 1.001 * mu) }
                END { bad += rest ^ 2 > 1e-5 * mu ^ 2 + 1e-6; print NR, bad + 0 }' "$T/forces")" "121 0" \
            "$method, mu $mu: what slips pulls with mu times what presses: $(awk 'NR == 61 || NR == 111 { printf "%.4f ", $3 }' "$T/forces")"
    done
    # shellcheck disable=SC2086
    run near --method $method --friction 2
    sinew export -f model --text "$T/run.sinew" | awk '/^frame/ { n++ } /^array node.displacement/ { getline; for (k = 0; k < 343; k++) { if (n == 61 && k == 318) print $1; getline } }' >"$T/top"
    is "$(awk 'NR == 61 { far = $1 } NR == 121 { print (far < -.01), ($1 ^ 2 < (.03 * far) ^ 2) } ' "$T/forces") $(awk '{ print ($1 > .9e-4 && $1 < 1.001e-4) }' "$T/top")" "1 1 1" \
        "what sticks moves with the probe, $(cat "$T/top") m of .1 mm, and pulls no more when it is back"
    # shellcheck disable=SC2086
    run far --method $method
    is "$(awk '{ most = $3 ^ 2 > most ? $3 ^ 2 : most } END { print (most < 1e-6) }' "$T/forces")" 1 "without friction nothing pulls aside"
    mv "$T/run.sinew" "$T/free.sinew"
    # shellcheck disable=SC2086
    run far --method $method --friction 0
    check "0 is none, to the byte" sinew diff "$T/run.sinew" "$T/free.sinew"
done

# The same bytes.
run far --method tissue --friction .3 --threads 1
mv "$T/run.sinew" "$T/one.sinew"
run far --method tissue --friction .3 --threads 3
check "for any number of threads" cmp "$T/run.sinew" "$T/one.sinew"
for vectors in plain AVX2 AVX-512; do
    rm -f "$T/run.sinew"
    SINEW_VECTORS=$vectors run far --method tissue --friction .3 2>/dev/null # run keeps what msds-run says
    if ! grep -q SINEW_VECTORS "$T/said"; then
        check "and by $vectors" cmp "$T/run.sinew" "$T/one.sinew"
    else
        skip 1 "this processor has no $vectors"
    fi
done

# Lines change it: halfway through, friction ends, and with it what pulls aside.
sed '41a set friction 0' "$T/far.tum" >"$T/lines.tum"
run lines --method fem --friction .2
is "$(awk 'NR == 40 { a = $3 } NR == 55 { print (a < -.15), ($3 ^ 2 < 1e-6) }' "$T/forces")" "1 1" "set friction 0 lets go"

fails 2 "springs" "--friction 0.3 with the method msds, by which tissue slides on the probe; expected fem, warp or tissue, or --friction 0" \
    msds-run --method msds --friction .3 --probe sphere:1cm --poses "$T/far.tum" <"$T/cube.sinew"
fails 2 "exact frames" "--friction 0.3 with the method exact, by which" msds-run --method fem --exact --friction .3 --probe sphere:1cm --poses "$T/far.tum" <"$T/cube.sinew"
fails 2 "below 0" "--friction" msds-run --friction=-1 --probe sphere:1cm --poses "$T/far.tum" <"$T/cube.sinew"
printf '0 .02 .02 .05 1 0 0 0\nmethod exact\n' >"$T/exact.tum"
fails 1 "a method without it" "exact.tum:2: .*--friction 0.3 with the method exact" \
    msds-run --method fem --friction .3 --probe sphere:1cm --poses "$T/exact.tum" <"$T/cube.sinew"
printf '0 .02 .02 .05 1 0 0 0\nset friction .3\n' >"$T/exact.tum"
fails 1 "a line of it with another" "exact.tum:2: .*--friction 0.3 with the method msds" \
    msds-run --method msds --probe sphere:1cm --poses "$T/exact.tum" <"$T/cube.sinew"
done_testing
