#!/bin/sh
# shellcheck disable=SC2317 # what each_command calls
# Memory that is not to be had: in every tool, the n-th allocation after main begins fails, alone or with all after it. The tool says so and exits
# with 1, with the output as it was before; or does without, and the output is right. All n with SINEW_LONG, else some.
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm # where nothing waits for a disk
. "$(dirname "$0")/lib.sh"
. "$(dirname "$0")/faults.sh"

library=$(cd "${BUILD:-build}" && pwd)/tests/faults/memory.so
[ -e "$library" ] || skip_all "no library to preload: make unit"
[ -z "$SINEW_SANITIZED" ] || skip_all "sanitizers have allocations of their own"
LD_PRELOAD=$library SINEW_FAULT_COUNT=$T/count tled-run --version >/dev/null
[ -s "$T/count" ] || skip_all "allocations of this C library are not counted so"
make_inputs || {
    not_ok "inputs for every tool"
    done_testing
}
tries=6
[ -z "$SINEW_LONG" ] || tries=1500
echo old >"$T/old"

# died: whether it was in a library that others made, and that has no way to say so: Embree and its threads (TBB) end the program by an
# exception that nothing can catch, and DCMTK, while it reads its dictionary, writes to what it did not get. Whose code it was is what the
# preloaded library tells: the innermost that is none of the C or C++ library. Where that is ours, it is a defect.
died() {
    case $name in
    'voxelise --check' | render) whose='embree|tbb' ;;
    us-import) whose='ofstd|dcmdata' ;;
    *) return 1 ;;
    esac
    [ "$status" -eq 134 ] || [ "$status" -eq 139 ] || return 1
    grep -vE '/(libc|libstdc\+\+|libgcc_s|libm)\.so[^/]*$' "$T/death" | head -n 1 | grep -qE "/lib($whose)[0-9]*\\.so[^/]*\$"
}

every_n() { # NAME INPUT COMMAND...
    name=$1 input=$2
    shift 2
    bad=1
    [ "$name" != diff ] || bad=2 # as diff(1) has it
    "$@" -o "$T/want" <"$input" 2>/dev/null
    LD_PRELOAD=$library SINEW_FAULT_COUNT=$T/count "$@" -o "$T/out" <"$input" >/dev/null 2>&1
    all=$(cat "$T/count")
    step=$((all / tries + 1))
    runs=0 ended=0 recovered=0 dead=0 wrong=0
    for on in '' 1; do
        n=1
        while [ "$n" -le "$all" ]; do
            cp "$T/old" "$T/out"
            : >"$T/death"
            timeout 180 env LD_PRELOAD="$library" SINEW_FAULT_DEATH="$T/death" SINEW_FAULT_AT="$n" ${on:+SINEW_FAULT_ON=1} "$@" -o "$T/out" <"$input" >/dev/null 2>"$T/err"
            status=$?
            runs=$((runs + 1))
            if [ "$status" -eq 0 ] && cmp -s "$T/want" "$T/out"; then
                recovered=$((recovered + 1))
            elif [ "$status" -eq "$bad" ] && [ -s "$T/err" ] && cmp -s "$T/old" "$T/out"; then
                ended=$((ended + 1))
            elif died && cmp -s "$T/old" "$T/out"; then
                dead=$((dead + 1))
            else
                wrong=$((wrong + 1))
                [ "$wrong" -gt 8 ] || diag "$name, allocation $n${on:+ and all after it}: status $status, $(wc -c <"$T/out") bytes, in $(head -n 9 "$T/death" | tr '\n' ' '): $(head -n 1 "$T/err")"
            fi
            n=$((n + step))
        done
    done 2>/dev/null # the shell tells of programs that died
    is "$wrong" 0 "$name: $runs of 2 x $all allocations that failed: $ended ended with a message, $recovered did without$([ "$dead" -eq 0 ] || echo ", $dead died in a library of others")"
}

each_command every_n

# A run with checkpoints, and one that goes on: whatever fails, what was saved is whole, and the run goes on from there.
set -- -q -d cpu --threads 2 -c a=0.5 -t 0.02 --every 0.005
saves="--checkpoint-every 0.005"
goes() { # HOW OPTION...: PRELOADED, if anything
    how=$1
    shift
    # shellcheck disable=SC2086 # two words
    env ${at:+LD_PRELOAD="$library" SINEW_FAULT_AT="$at"} tled-run "$@" "$how" "$T/state" $saves -o "$T/out" <"$T/in/bound.sinew" 2>"$T/err"
}
at=''
tled-run "$@" -o "$T/want" <"$T/in/bound.sinew"
LD_PRELOAD=$library SINEW_FAULT_COUNT=$T/count goes --checkpoint "$@"
all=$(cat "$T/count")
step=1 n=1 runs=0 again=0 good=0
[ "$SINEW_LONG" ] || n=$((all * 3 / 4)) step=$((all / 4 / tries + 1)) # most are before it begins
while [ "$n" -le "$all" ]; do
    rm -f "$T"/state* "$T/out"
    runs=$((runs + 1)) at=$n
    if ! goes --checkpoint "$@" && [ -s "$T/err" ] && [ ! -e "$T/out" ] && [ -e "$T/state" ]; then
        again=$((again + 1))
        at=$((n / 2 + 1))
        goes --restart "$@" || { [ -s "$T/err" ] && [ ! -e "$T/out" ] && [ -e "$T/state" ]; } || diag "allocation $at of one that goes on: $(cat "$T/err")"
    fi
    at='' how=--checkpoint
    [ ! -e "$T/state" ] || how=--restart
    { [ -e "$T/out" ] || goes $how "$@"; } && cmp -s "$T/want" "$T/out" && [ ! -e "$T/state" ] && good=$((good + 1))
    n=$((n + step))
done
is "$good" "$runs" "tled-run --checkpoint: $runs of $all allocations that failed, $again after something was saved: all went on to the same bytes"
check "some went on" test "$again" -gt 0

# What would not be taken for a death in others' code: one in a program of ours.
if have "${CC:-cc}"; then
    printf '#include <stdlib.h>\n#include <string.h>\nint main(void) { char *p = malloc(9); memset(p, 1, 9); return p[1]; }\n' >"$T/ours.c"
    "${CC:-cc}" -O0 -o "$T/ours" "$T/ours.c"
    { env LD_PRELOAD="$library" SINEW_FAULT_DEATH="$T/death" SINEW_FAULT_AT=1 "$T/ours"; } 2>/dev/null
    status=$? name=render
    is "$status $(died && echo theirs) $(grep -c '/ours$' "$T/death")" "139  2" "a death in code of ours is told as such"
else
    skip 1 "no compiler"
fi
done_testing
