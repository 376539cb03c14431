#!/bin/sh
# Every fuzz target (tests/fuzz) on its seeds and on what was ever found by it, without libFuzzer: each comes through. Every target has seeds
# and a dictionary; what is kept belongs to a target.
. "$(dirname "$0")/lib.sh"

replay=${BUILD:-build}/tests/fuzz/replay_
count=0
for source in tests/fuzz/fuzz_*.c; do
    name=${source#tests/fuzz/fuzz_}
    name=${name%.c}
    count=$((count + 1))
    [ -x "$replay$name" ] || skip_all "no $replay$name (make unit)"
    set -- "tests/fuzz/seeds/$name"
    [ ! -d "tests/fuzz/found/$name" ] || set -- "$@" "tests/fuzz/found/$name"
    check "$name: $(find "$@" -type f | wc -l) inputs" "$replay$name" "$@"
    check "$name has seeds" test -n "$(ls "tests/fuzz/seeds/$name")"
    check "$name has words" grep -q '^"' "tests/fuzz/dict/$name.dict"
done
check "there are targets" test "$count" -gt 10
for folder in tests/fuzz/seeds/* tests/fuzz/found/*; do
    [ -e "tests/fuzz/fuzz_${folder##*/}.c" ] || not_ok "$folder belongs to no target"
done
done_testing
