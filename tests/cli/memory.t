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
tries=24
[ -z "$SINEW_LONG" ] || tries=1500
echo old >"$T/old"


# died: whether it was a library that others made, and that has no way to say so: Embree's threads (TBB) end the program by an
# exception that nothing can catch, and DCMTK, while it reads its dictionary, writes to what it did not get.
died() {
    case $name in
    'voxelise --check' | render) { [ "$status" -eq 134 ] && grep -q '^terminate called' "$T/err"; } || [ "$status$on" = 1391 ] ;;
    us-import) [ "$status" -eq 139 ] ;;
    *) false ;;
    esac
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
            timeout 30 env LD_PRELOAD="$library" SINEW_FAULT_AT="$n" ${on:+SINEW_FAULT_ON=1} "$@" -o "$T/out" <"$input" >/dev/null 2>"$T/err"
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
                [ "$wrong" -gt 8 ] || diag "$name, allocation $n${on:+ and all after it}: status $status, $(wc -c <"$T/out") bytes: $(head -n 1 "$T/err")"
            fi
            n=$((n + step))
        done
    done 2>/dev/null # the shell tells of programs that died
    is "$wrong" 0 "$name: $runs of 2 x $all allocations that failed: $ended ended with a message, $recovered did without$([ "$dead" -eq 0 ] || echo ", $dead died in a library of others")"
}

each_command every_n
done_testing
