#!/bin/sh
# Minutes of pressing: 30 % deep into a block at 60 poses a second, sliding to and fro, by both methods. Ten minutes with SINEW_LONG, else twenty
# seconds: finite to the end, and every press like the one before.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

msds-mesh -q --nodes 17x9x9 --size 16cm,8cm,8cm --young 10000 --poisson 0.45 --density 1000 >"$T/block.sinew"
poses=1200
[ -n "$SINEW_LONG" ] && poses=36000
# 24 mm of 80, each 2 seconds; 1 cm to each side in 10 seconds.
awk -v n=$poses 'BEGIN { pi = 3.14159265358979; for (i = 0; i < n; i++) { t = i / 60;
    printf "%.6f %.6f .04 %.6f 1 0 0 0\n", t, .08 + .01 * sin(2 * pi * t / 10), .081 - .0125 * (1 - cos(pi * t)) } }' >"$T/press.tum"

for probe in sphere:2cm linear:4cm,2cm; do
    for method in msds fem; do
        name="$method, ${probe%%:*}"
        msds-run -v --spring-scale auto --method $method --probe $probe --poses "$T/press.tum" <"$T/block.sinew" 2>"$T/said" |
            sinew info --get node.displacement.max >"$T/most"
        is "$(grep -Ec '^msds-run: +[0-9.]+  (msds|fem) ' "$T/said")" "$poses" "$name: a frame for each of $poses poses"
        # The forces at the deepest, each 10 seconds at the same place, from the second time on; the last against the first of them.
        awk -v n=$poses '$3 == "msds" || $3 == "fem" { t = $2 % 10; f = $5; if (f != f + 0 || f > 100) bad++; if (t < 9.01 && t > 8.99) last = f
                if (t < 9.01 && t > 8.99 && !first) first = f } END { print first, last; exit bad || !(first > .5) || (last / first - 1) ^ 2 > .02 ^ 2 }' \
            "$T/said" >"$T/forces"
        is $? 0 "$name: as hard at the end as at first: $(cat "$T/forces") N, and finite throughout"
        awk '{ exit !($1 < .03) }' "$T/most"
        is $? 0 "$name: at the end nothing is further than $(cat "$T/most") m from its place"
    done
done
done_testing
