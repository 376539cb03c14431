#!/bin/sh
# tests/check: what it counts and how it ends, with a make that only says what a part's make would say; and .ci/run where set-up fails.
. "$(dirname "$0")/lib.sh"

export BUILD="$T/build" SAYS="$T/says" MAKE="$T/make" JOBS=
mkdir "$SAYS"
# The stand-in for make says what the file of its last word has, and fails where that ends in a line `fail`.
cat >"$T/make" <<'END'
#!/bin/sh
for word; do :; done
echo "$word" >>"$SAYS/asked"
if [ -e "$SAYS/$word" ]; then
    cat "$SAYS/$word"
    [ "$(tail -n 1 "$SAYS/$word")" != fail ]
else
    printf 'ok 1 - as it should be\n1..1\n'
fi
END
chmod +x "$T/make"

# counts LIST...: the status and the last line; $T/said has all of it.
counts() {
    : >"$SAYS/asked"
    tests/check "$@" >"$T/said" 2>&1 </dev/null
    echo "$? $(tail -n 1 "$T/said")"
}
# part_counts WORD TEXT LIST: with what a part says.
part_counts() {
    # shellcheck disable=SC2059 # the text has newlines
    printf "$2" >"$SAYS/$1"
    counts "$3"
    rm "$SAYS/$1"
}

parts=$(tests/check check >"$T/said" && grep -c '^ok ' "$T/said")
is "$(counts check)" "0 $parts passed, 0 failed, 0 skipped" "check: all parts pass"
is "$(grep -cE '^[0-9]+ passed, [0-9]+ failed, [0-9]+ skipped$' "$T/said")" 1 "one line of counts"
sort "$SAYS/asked" >"$T/check"
for list in ci all; do
    counts "$list" >"$T/stdout"
    sort "$SAYS/asked" | comm -23 "$T/check" - >"$T/left"
    is "$(cat "$T/stdout" "$T/left" | sed 's/[0-9]* passed/n passed/')" "0 n passed, 0 failed, 0 skipped" "$list: has every part of check, and passes"
done
# (What is quick in ci is whole in all.)
counts ci >"$T/stdout"
sed 's/-quick$//' "$SAYS/asked" | sort >"$T/ci"
counts all >"$T/stdout"
sort "$SAYS/asked" | comm -23 "$T/ci" - >"$T/left"
is "$(cat "$T/left")" "" "all: has every part of ci"
sed -n '/^SLOW = /,/^UNIT_TEST/p' tests/check.mk | grep -oE '[a-z_0-9-]+\.t|UNIT_TEST\)[a-z_]+' | sed 's/.*)/test_/' | sort >"$T/long"
grep -lE 'SINEW_LONG' tests/cli/*.t tests/unit/*.c | grep -v '/check\.t$' | sed 's|.*/||; s|\.c$||' | sort >"$T/heed"
is "$(diff "$T/heed" "$T/long")" "" "each test that does more with SINEW_LONG is of make check-all's slow tests or of make soak"
is "$(counts soak | sed 's/[0-9]* passed/n passed/')" "0 n passed, 0 failed, 0 skipped" "soak"
is "$(part_counts unit 'x.c:1: error\nfail\n' check)" "1 $((parts - 1)) passed, 1 failed, 0 skipped" "a build that fails is one failure"
check "what it said is shown" grep -q '^    x.c:1: error$' "$T/said"
is "$(part_counts check-tests 'ok 1 - a\nok 2 # skip no card\nnot ok 3 - c\n# got 4\nok 4 - d\n1..4\nfail\n' check)" \
    "1 $((parts + 1)) passed, 1 failed, 1 skipped" "tests are counted one by one"
check "the test that failed is shown" grep -q '^    # got 4$' "$T/said"
is "$(part_counts check-tests 'x.t .. skipped: no nmap\nok 1 - a\n1..1\n' check)" "0 $parts passed, 0 failed, 1 skipped" "a file that is skipped is one skip"
check "the reason is shown" grep -q 'skipped: no nmap' "$T/said"
is "$(part_counts check-tests 'ok 1 - a\nx.t (Wstat: 139 (Signal: SEGV) Tests: 1 Failed: 0)\nfail\n' check)" \
    "1 $parts passed, 1 failed, 0 skipped" "a test file that dies is one failure"
is "$(part_counts check-tests 'ok 1 - a\nfail\n' check)" "1 $parts passed, 1 failed, 0 skipped" "so is a part that fails for no test's sake"
is "$(part_counts check-tests 'nothing\n' check)" "1 $((parts - 1)) passed, 1 failed, 0 skipped" "and one that runs no test"
# One that hangs: timeout is told what the table says, and stands for time here.
mkdir "$T/late"
# shellcheck disable=SC2016 # for the inner shell
printf '#!/bin/sh\ncase " $* " in *" check-tests "*) exit "$LATE" ;; esac\nshift 2\nexec "$@"\n' >"$T/late/timeout"
chmod +x "$T/late/timeout"
for LATE in 124 137; do
    export LATE
    is "$(PATH=$T/late:$PATH counts check)" "1 $((parts - 1)) passed, 1 failed, 0 skipped" "a part that is stopped is one failure: status $LATE"
    check "what ended it is shown" grep -qE '^    tests: (stopped|killed) after [0-9]+ minutes' "$T/said"
done
fails 2 "a list that is none" "list 'chekc'; expected some of check, ci, all, soak" tests/check chekc
fails 2 "a second one" "list 'many'; expected" tests/check check many
fails 2 "no list" "expected some of check" tests/check

# Continuous integration on a machine that has neither make nor apt.
mkdir "$T/few"
for program in bash sh dirname uname id; do
    ln -s "$(command -v $program)" "$T/few/$program"
done
PATH=$T/few bash .ci/run >"$T/said" 2>"$T/warned"
is "$? $(cat "$T/said")" "1 0 passed, 1 failed, 0 skipped" "set-up that fails is one failure"
check "what is missing is said" grep -q 'missing, and no apt-get' "$T/warned"
done_testing
