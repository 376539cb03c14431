#!/bin/sh
# The gate, on a project of one function: what `make coverage` tells, and which edits `make mutate` makes, runs and names.
. "$(dirname "$0")/lib.sh"
have python3 || skip_all "no python3"
gate=$ROOT/tests/gate

# ---- edits: what is no code stays, and each edit is one
cat >"$T/edits.c" <<'C'
/* a < b */
#define ONE (1 + 1)
static double f(double *a, int n, const double more[3])
{
    double wide[8][8], more[8] = {a[n]}; // n + 1
    const char *s = "a + b";
    for (int i = 0; i < n; i++)
        a[i] = fmin(a[i], .5) * wide[1][2];
    if (n > 3 && s)
        g(-a[0]);
    free(a);
    return -1;
}
C
edits() {
    PYTHONPATH=$gate python3 -B -c '
import sys
from mutations import mutations
text = open(sys.argv[1]).read()
for m in mutations(text, set(range(1, 99))):
    print(m.line, text[m.start:m.end].split("\n")[0], "->", m.new)' "$1"
}
edits "$T/edits.c" >"$T/edits"
cat >"$T/want" <<'END'
7 0 -> (-1)
7 0 -> 1
7 < -> <=
7 ++ -> --
8 a[i] = fmin(a[i], .5) * wide[1][2]; -> ;
8 fmin -> fmax
8 .5 -> (-0.5)
8 .5 -> (1.5)
8 * -> /
8 1 -> 0
8 1 -> 2
8 2 -> 1
8 2 -> 3
9 (n > 3 && s) -> (!(n > 3 && s))
9 > -> >=
9 3 -> 2
9 3 -> 4
9 && -> ||
10 g(-a[0]); -> ;
10 0 -> (-1)
10 0 -> 1
12 1 -> 0
END
check "edits of operators, constants, conditions and statements, and of nothing else" diff "$T/want" "$T/edits"

# ---- a project: a function, a test of it that does not try equal numbers, and code that is never reached or compiled
mkdir -p "$T/p/common/base" "$T/p/tests/unit" && cd "$T/p" || exit 1
cat >common/base/larger.c <<'C'
int larger(int a, int b);
int unused(void);

int larger(int a, int b)
{
    int most = a;
    if (a < 0 || b < 0)
        return -1;
    if (b > most)
        most = b;
    return most;
}

#ifdef NEVER_DEFINED
int lost(void)
{
    return 1;
}
#endif

int unused(void)
{
    return 2;
}
C
cat >tests/unit/test_larger.c <<'C'
#include <stdio.h>
int larger(int a, int b);
int main(void)
{
    int wrong = larger(1, 2) != 2 || larger(5, 2) != 5;
    printf("%sok 1 - the larger one\n1..1\n", wrong ? "not " : "");
    return wrong;
}
C
cat >Makefile <<'M'
BUILD = build
.PHONY: all unit cli-programs
all cli-programs:
unit: $(BUILD)/tests/unit/test_larger
$(BUILD)/tests/unit/test_larger: $(BUILD)/common/base/larger.o $(BUILD)/tests/unit/test_larger.o
	gcc $(CFLAGS) -o $@ $^
$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	gcc $(CFLAGS) -MMD -c -o $@ $<
-include $(BUILD)/common/base/larger.d
M
printf 'build\n' >.gitignore
cp -r "$gate" tests/gate
build() {
    env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -s "$@"
}
unset GCOV_PREFIX
if [ "$(id -u)" -eq 0 ] && ! unshare --mount true 2>"$T/stderr"; then
    skip 12 "root has no namespaces here: $(tail -n 1 "$T/stderr")"
    done_testing
fi
build BUILD=build/coverage CFLAGS='-O0 --coverage' unit && mkdir build/coverage/counters
BUILD=build/coverage tests/gate/covered build/coverage/tests/unit/test_larger >/dev/null
is $? 0 "a test runs, and counts"
echo 'gcc -O0 --coverage -MMD -c -o build/coverage/common/base/larger.o common/base/larger.c' |
    python3 -B tests/gate/coverage.py build/coverage >"$T/table"
is "$(grep common/base "$T/table" | tr -s ' ')" "| common/base | 6 | 9 | 66.7 | 4 | 6 | 66.7 | 1 | 2 | 50.0 |" "a table of what tests reach"
cat >"$T/want" <<'END'
common/base/larger.c:7: 2 of 4 branches never reached: if (a < 0 || b < 0)
common/base/larger.c:8: line never reached: return -1;
common/base/larger.c:15: never compiled, up to line 18: line 14 has #ifdef NEVER_DEFINED: int lost(void)
common/base/larger.c:21: function never called: unused: int unused(void)
common/base/larger.c:21: line never reached: int unused(void)
common/base/larger.c:23: line never reached: return 2;
END
check "all that is never reached, called or compiled, by name" diff "$T/want" build/coverage/branches.txt

if [ "$(id -u)" -eq 0 ]; then
    echo "touch /dev/sinew.$$ && rm /dev/sinew.$$ || echo 'devices stay'; echo >/dev/null && echo 'they work'" >devices.t
    is "$(BUILD=build/coverage tests/gate/covered devices.t 2>"$T/stderr")" "devices stay
they work" "no test that counts can put a file in place of a device"
    rm devices.t
else
    skip 1 "not root, who alone can change /dev"
fi

# ---- a place where broken programs can harm nothing
mkdir "$T/place"
if [ "$(id -u)" -ne 0 ]; then
    skip 10 "not root, who alone has the sandbox"
    done_testing
fi
"$gate/sandbox" "$T/place" sh -c "touch here; touch /dev/sinew.$$ $ROOT/sinew.$$ $T/sinew.$$; kill -0 $$ || echo alone; pwd" >"$T/stdout" 2>/dev/null
is "$(cat "$T/stdout")$(ls "$T/place") $(ls /dev/sinew.$$ "$ROOT/sinew.$$" "$T/sinew.$$" 2>/dev/null)" "alone
/mnthere " "in the sandbox only its folder can be changed, and no other process be seen"
is "$(setsid --wait sh -c "trap 'echo hit' USR1; '$gate/sandbox' '$T/place' sh -c 'kill -USR1 0'; echo" 2>/dev/null)" "" "nor be signalled by its group"
CPU_SECONDS=1 "$gate/sandbox" "$T/place" sh -c 'while :; do :; done' 2>/dev/null
is $? 137 "and what runs for ever is ended"

# ---- mutants
git init -q . && git add . || exit 1
mutate() {
    env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL python3 -B tests/gate/mutate.py "$@"
}
cp common/base/larger.c "$T/larger.c"
mutate build all 2 3 >"$T/first" 2>&1
is "$? $(tail -n +1 "$T/first" | grep -c '^killed \|^survived ')" "0 2" "as many mutants as were asked for"
mutate build common 2 3 >"$T/second" 2>&1
names() {
    sed -n 's/^\(killed\|survived\) *\([0-9]* [^ ]* [^ ,]*\).*/\1 \2/p' "$1" | sort
}
is "$(names "$T/second")" "$(names "$T/first")" "the same seed, the same mutants and ends"
check "the checkout stays as it was" cmp common/base/larger.c "$T/larger.c"
grep -q '^-    ' "$T/first" && grep -q '^+    ' "$T/first"
is "$? $(grep -c '^survivor [123]: common/base/larger.c:[79] ' "$T/first")" "0 1" "a survivor is named, with its diff"
echo >>common/base/larger.c
fails 1 "a file that is not what coverage saw" 'larger\.c is not what .make coverage. saw; run it again' mutate build all 2 3
fails 1 "a folder of which there is none" "FOLDER is 'legs', of which no test reaches a line; expected all" sh -c "cp '$T/larger.c' common/base; python3 -B tests/gate/mutate.py build legs 2 3"
done_testing
