#!/bin/sh
# The CPU solver in each instruction set that this processor has, for several numbers of threads: the same bytes.
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
SINEW_VECTORS=MMX fails 1 "an unknown instruction set" \
    "^tled-run: SINEW_VECTORS: 'MMX' is not to be had here; expected plain, AVX2 or AVX-512$" run double 1
done_testing
