#!/bin/sh
# Every fuzz target (tests/fuzz) on its seeds and on what was ever found by it, without libFuzzer: each comes through. Every target has seeds
# and a dictionary; what is kept belongs to a target. Large inputs (tests/fuzz/large) come through within 2 s of a processor, where a time that
# grows with the square of their size is 4 to 28 s.
. "$(dirname "$0")/lib.sh"

replay=${BUILD:-build}/tests/fuzz/replay_
seconds=2
[ -z "$SINEW_SANITIZED" ] || seconds=20
count=0
large=0
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
    tests/fuzz/large "$name" "$T/large"
    for file in "$T/large"/*; do
        [ -e "$file" ] || continue
        large=$((large + 1))
        # shellcheck disable=SC2016 # for the inner shell
        check "$name: many ${file##*/}" sh -c 'ulimit -t "$1" && exec "$2" "$3"' sh "$seconds" "$replay$name" "$file"
    done
    rm -rf "$T/large"
done
check "there are large inputs" test "$large" -gt 10
check "there are targets" test "$count" -gt 10
for folder in tests/fuzz/seeds/* tests/fuzz/found/*; do
    [ -e "tests/fuzz/fuzz_${folder##*/}.c" ] || not_ok "$folder belongs to no target"
done
done_testing
