#!/bin/sh
# The CPU solvers in each instruction set that this processor has, for several numbers of threads: the same bytes.
. "$(dirname "$0")/lib.sh"

awk -v nx=19 -v ny=9 -v nz=7 -v h=0.005 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/model"
cat >"$T/script" <<'SCRIPT'
0 contract all 0.3
0 force 0.06,0.045,0.035 0.02 .002,.001,0
0.04 displace 0.09,-1,-1,1,0.001,1 -,0.002,-0.003
SCRIPT
run() { # PRECISION THREADS: 200 steps
    tled-run -q -d cpu --precision "$1" --threads "$2" --script "$T/script" -n 200 <"$T/model"
}
for precision in double single; do
    run $precision 1 >"$T/first"
    for vectors in plain AVX2 AVX-512; do
        for threads in 1 2 5; do
            name="$precision, $vectors, $threads threads"
            if SINEW_VECTORS=$vectors run $precision $threads >"$T/out" 2>"$T/err"; then
                check "$name: the same bytes" cmp "$T/first" "$T/out"
            else
                skip 1 "$name: $(sed 's/; .*//' "$T/err")"
            fi
        done
    done
done
# msds-run's, each method.
msds-mesh -q --nodes 13x9x8 --size 12cm,8cm,7cm --young 8000 >"$T/block"
awk 'BEGIN { for (i = 0; i < 6; i++) printf "%g .06 .04 %.4f 1 0 0 0\n", i / 60, .07 - .001 * i }' >"$T/press"
for method in msds fem 'fem --exact'; do
    # shellcheck disable=SC2086
    msds-run -q --method $method --probe sphere:2cm --poses "$T/press" <"$T/block" >"$T/first"
    for vectors in plain AVX2 AVX-512; do
        # shellcheck disable=SC2086
        if SINEW_VECTORS=$vectors msds-run -q --method $method --probe sphere:2cm --poses "$T/press" <"$T/block" >"$T/out" 2>"$T/err"; then
            check "msds-run $method, $vectors: the same bytes" cmp "$T/first" "$T/out"
        else
            skip 1 "msds-run $method, $vectors: $(sed 's/; .*//' "$T/err")"
        fi
    done
done
echo '0 0 0 1 0 0 0 1' >"$T/pose"
SINEW_VECTORS=MMX fails 1 "msds-run: an unknown instruction set" \
    "^msds-run: SINEW_VECTORS: 'MMX' is not available here; expected plain, AVX2 or AVX-512$" msds-run -q --poses "$T/pose" <"$T/block"
SINEW_VECTORS=MMX fails 1 "an unknown instruction set" \
    "^tled-run: SINEW_VECTORS: 'MMX' is not available here; expected plain, AVX2 or AVX-512$" run double 1
done_testing
