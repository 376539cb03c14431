#!/bin/sh
# voxelise in little memory: a lattice of 512^3 cells takes less than 2 bytes a cell beyond what its elements take, which is no
# more than the model that is written.
. "$(dirname "$0")/lib.sh"
[ -z "$SINEW_SANITIZED" ] || skip_all "sanitizers take memory of their own"
have python3 || skip_all "python3 is not installed"

# ball RADIUS GROUP FROM: its vertices are numbered on from FROM.
ball() {
    awk -v r="$1" -v n=96 -v g="$2" -f tests/cli/sphere.awk |
        awk -v from="$3" '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } 1'
}
{
    ball 100 skin 0
    ball 99 skull $((2 + 95 * 192))
} >"$T/shell.obj"

# peak ARGS...: the most memory that voxelise had at a time, in bytes.
peak() {
    python3 -c 'import os, sys
child = os.spawnvp(os.P_NOWAIT, sys.argv[1], sys.argv[1:])
status, usage = os.wait4(child, 0)[1:]
print(usage.ru_maxrss * 1024 if status == 0 else "failed")' voxelise -q --unit mm -n 512 "$@" "$T/shell.obj"
}
# within NAME ARGS...
within() {
    name=$1
    shift
    had=$(peak "$@" -o "$T/m")
    model=$(wc -c <"$T/m")
    is "$(awk -v had="$had" -v model="$model" 'BEGIN { print (had > model / 2 && had < model + 2 * 512 ^ 3) ? "little" : "too much" }')" \
        little "$name"
    echo "# $had bytes, and a model of $model"
}
within "by centres"
within "by shares" --fraction 4
printf 'top thickness=0.5\n' >"$T/layers"
within "in layers" --layers "$T/layers"
done_testing
