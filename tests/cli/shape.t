#!/bin/sh
# That tests/shape sees what it is there for; and what tools owe their users whatever they do: -V at once, every option in usage and page,
# no privileges.
. "$(dirname "$0")/lib.sh"

tools="voxelise attach bind tled-run msds-mesh msds-run us-import us-segment us-surface us-slice sinew-materials sinew-deform sinew-results sinew-info sinew-diff sinew-distance sinew-poses sinew-igtl-out sinew-register sinew-export sinew-import sinew-render sinew-console sinew-igtl-in"
# A tool that is new is told of here.
is "$(for tool in $tools sinew voxelize; do echo "$tool"; done | LC_ALL=C sort | tr '\n' ' ')" "$(cd "$SINEW_BIN" && echo * | tr '\n' ' ')" "these are all tools"

# ---- Breaches, one a check, in a tree of their own.
mkdir -p "$T/tree/common/base" "$T/tree/common/model" "$T/tree/voxelise" "$T/tree/attach" "$T/tree/bind" "$T/tree/tled" "$T/tree/msds" \
    "$T/tree/slice" "$T/tree/man" "$T/tree/samples" "$T/tree/tests" "$T/tree/.ci" "$T/tree/common/cli"
cd "$T/tree" || exit 1
touch README.md Makefile
# table ROW...: the folders, as CONTRIBUTING.md has them.
table() {
    # shellcheck disable=SC2016 # Markdown
    printf '| `%s` | lives | not | %s |\n' "$@" >CONTRIBUTING.md
}
table common/base '' common/model base voxelise common attach common
# found NAME CHECK PATTERN: the check complains, and of this.
found() {
    BUILD=$T/tree/build "$ROOT/tests/shape" "$2" >"$T/said" 2>&1
    is "$? $(grep -Ec -e "$3" "$T/said")" "1 1" "$1"
    [ -s "$T/said" ] && diag_file "$T/said"
}
printf '#ifndef SINEW_A_H\n#define SINEW_A_H\n#endif\n' >common/base/a.h
is "$("$ROOT/tests/shape" names sizes widths conditionals errors includes builtin 2>&1)" "" "a tree without a breach"
cp common/base/a.h voxelise/a.h
found "two files of one name" names 'several files are called a\.h'
mv voxelise/a.h voxelise/b.h
found "two headers with one guard" names 'guarded by SINEW_A_H'
rm voxelise/b.h
awk 'BEGIN { print "int f(void)\n{"; for (i = 0; i < 51; i++) print "    ;"; print "}" }' >attach/long.c
found "a long function" sizes 'attach/long.c:2: a function of 51 lines'
awk 'BEGIN { for (i = 0; i < 601; i++) print "" }' >attach/long.c
found "a long file" sizes 'attach/long.c: 601 lines'
rm attach/long.c
for i in $(seq 41); do echo >"attach/many$i.c"; done
found "a folder of many files" sizes 'attach: 41 files; expected at most 40'
rm attach/many*.c
awk 'BEGIN { printf "/* "; for (i = 0; i < 115; i++) printf "x"; print " */\n/* right */" }' >bind/wide.c
found "a wide line" widths 'bind/wide.c:1: 121 columns; expected at most 120'
rm bind/wide.c
printf '%s\n' 'int f(int a)' '{' '    /* a ? b : c ? d : e */' '    return a < 0 ? 0 : a > 9 ? 9 : a; // ?' '}' >bind/nested.c
found "a nested conditional" conditionals 'bind/nested.c:4: .*; 1 of [0-9]+ lines, expected at most'
printf '%s\n' 'int f(int a)' '{' '    /* why ?' '     * a ? b : c ? d : e */' "    return a == '?' ? g(\"a?\") : 1; // ? ?" '}' >bind/nested.c
is "$("$ROOT/tests/shape" conditionals)" "" "one conditional a line is let be"
rm bind/nested.c
printf '%s\n' 'int f(err *e)' '{' '    g(e);' '    return e->status ? -1 : 0;' '}' >bind/asks.c
found "a function that asks e->status" errors 'bind/asks.c:4: asks e->status; expected what the call'
printf '%s\n' 'int f(err *e)' '{' '    e->status = STATUS_USAGE;' '    return g(e);' '}' >bind/asks.c
is "$("$ROOT/tests/shape" errors)" "" "what sets it, and what returns what a call did, is let be"
rm bind/asks.c
echo '#include "attach/body.h"' >voxelise/across.c
found "a tool that includes another" includes 'voxelise/across.c includes attach/body.h'
rm voxelise/across.c
echo '#include "model/model.h"' >common/base/up.c
found "base that knows a model" includes 'common/base/up.c includes model/model.h; expected of others only: $'
rm common/base/up.c
echo '#include "model/model.h"' >voxelise/down.c
is "$("$ROOT/tests/shape" includes)" "" "a tool includes what is common"
mv voxelise/down.c msds/down.c
found "a folder that the table does not have" includes 'msds/down.c is in no folder of the table'
rm msds/down.c
table common/base model common/model base voxelise common
found "a table with a circle" includes 'a circle in the table of CONTRIBUTING.md: input contains a loop'
table common/base '' common/model base voxelise common common/legs base
found "a table with a folder that is not there" includes 'has common/legs, which is not there'
table common/base '' common/model base voxelise common attach common
# shellcheck disable=SC2016 # these are what is looked for
for line in 'attach | bind | tled-run' '    bind < a > b' '$ bind face.obj' 'x=$(bind face.obj)' 'voxelise a && bind -q' 'attach |bind'; do
    printf '%s\n' "$line" >README.md
    found "typed: $line" builtin 'README.md:1:'
done
# shellcheck disable=SC2016 # likewise
printf '%s\n' 'attach | sinew bind' '`bind` is a builtin' '.Xr bind 1' '.Nm bind' 'they bind surfaces' >README.md
is "$("$ROOT/tests/shape" builtin)" "" "prose of it is let be"
if have "${CC:-cc}" && have nm; then
    mkdir -p build/common/base
    while IFS='|' read -r name pattern body; do
        printf '%s\n' "$body" >common/base/bad.c
        "${CC:-cc}" -O0 -c -o build/common/base/bad.o common/base/bad.c 2>"$T/cc" || diag_file "$T/cc"
        found "$name" objects "common/base/bad.o $pattern"
    done <<'END'
an exit|uses exit|void exit(int); void f(void); void f(void) { exit(1); }
a message|uses stderr|extern void *stderr; int fputc(int, void *); void g(void *); void f(void); void f(void) { g(stderr); }
a print|uses puts|int puts(const char *); void f(void); void f(void) { puts("x"); }
a variable|has the writable global count|int count = 1; int f(void); int f(void) { return ++count; }
a zeroed one|has the writable global count|static int count; int f(void); int f(void) { return ++count; }
a pointer|has the writable global at|static const char *at = "a"; const char *f(const char *); const char *f(const char *b) { const char *was = at; at = b; return was; }
a thread's|has the writable global count|static _Thread_local int count = 2; int f(void); int f(void) { return ++count; }
a shell|calls system|int system(const char *); void f(void); void f(void) { system("ls"); }
another program|calls execvp|int execvp(const char *, char *const *); void f(char **a); void f(char **a) { execvp(a[0], a); }
another user|calls setuid|int setuid(unsigned); void f(void); void f(void) { setuid(0); }
END
    echo 'extern const char *const table[]; const char *const table[] = {"a", "b"}; static const int n = 3; int f(void); int f(void) { return n; }' >common/base/bad.c
    "${CC:-cc}" -fPIE -c -o build/common/base/bad.o common/base/bad.c
    is "$(BUILD=$T/tree/build "$ROOT/tests/shape" objects)" "" "constants are let be"
    mkdir -p build/tled
    echo 'int left = 1;' >tled/left.c
    "${CC:-cc}" -c -o build/tled/left.o tled/left.c
    found "an object beside it" objects 'tled/left.o has the writable global left'
    rm tled/left.c
    is "$(BUILD=$T/tree/build "$ROOT/tests/shape" objects)" "" "one whose source is gone is let be"
    rm common/base/bad.c
    found "no object at all" objects 'none in '
else
    skip 14 "no compiler or no nm"
fi
cd "$ROOT" || exit 1

# ---- Every option stands in the usage and in the page, and the page has no other.
for tool in $tools; do
    options_of "$tool" >"$T/usage"
    sed -n '/^\.Sh DESCRIPTION/,/^\.Sh \(EXIT\|ENV\)/s/^\.It Fl //p' "man/$tool.1" |
        awk '{ for (i = 1; i <= NF; i++) { if ($i == "Ar" || $i == "Oo" || $i == "Cm" || $i == "Ns" || $i == "Li") break; if ($i != "," && $i != "Fl") print "-" $i } }' | sort -u >"$T/page"
    check "$tool: $(wc -l <"$T/usage" | tr -d ' ') names of options, all in its page" diff "$T/usage" "$T/page"
    "$tool" --help | sed -nE 's/^(Input|What happens|Numerics|Output|Common):$/\1/p; s/^ {2,6}(-[a-zA-Z], )?--([a-z-]+).*/\2/p; s/^  -([a-zA-Z])( .*|$)/\1/p' >"$T/usage"
    sed -n '/^\.Sh OPTIONS/,/^\.Sh [^O]/p' "man/$tool.1" | sed -nE 's/^\.Ss //p; s/^\.It Fl ([a-zA-Z] , )?-?([a-zA-Z-]+).*/\2/p' >"$T/page"
    check "$tool: its page has them in the groups and the order of --help" diff "$T/usage" "$T/page"
done

# ---- -V takes a few milliseconds of a processor, not of a clock, which others' work makes run on; no card is looked at. Others' work also takes the
# processor's caches away, and there are machines where any program takes long to begin: at most 20 ms, or ten times what a shell takes that does
# nothing, then and there; and one of three tries is enough.
# ten_take COMMAND...: in milliseconds, of ten: times tells hundredths of a second.
ten_take() {
    (for _ in 1 2 3 4 5 6 7 8 9 10; do "$@" || exit; done >"$T/version" && times) | tail -n 1 |
        tr 'ms' '  ' | awk '{ print 100 * ($2 + $4) }'
}
# at_once TOOL: $took and $limit have what the last try took, and might.
at_once() {
    for _ in 1 2 3; do
        took=$(ten_take "$1" -V)
        limit=$(awk -v shell="$(ten_take sh -c :)" 'BEGIN { print (10 * shell > 20 ? 10 * shell : 20) }')
        awk -v took="$took" -v limit="$limit" 'BEGIN { exit !(took != "" && took < limit) }' && return
    done
}
for tool in $tools sinew; do
    if [ "${SINEW_SANITIZED:-}" ]; then
        skip 1 "sanitizers take their time"
    elif at_once "$tool"; then
        ok "$tool -V takes $took ms"
    else
        not_ok "$tool -V takes $took ms; expected less than $limit"
    fi
done

# ---- As nobody, in a folder that is nobody's.
if [ "$(id -u)" -eq 0 ] && have setpriv; then
    chmod 755 "$T"
    mkdir -m 777 "$T/free"
    cp tests/cli/cube.obj "$T/free/"
    chmod a+rx "$SINEW_BIN" 2>/dev/null
    # shellcheck disable=SC2016 # for the inner shell
    if setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=-all --inh-caps=-all test -x "$SINEW_BIN/voxelise" 2>/dev/null; then
        check "nobody, without a capability, makes a model and moves it" \
            setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=-all --inh-caps=-all sh -c 'cd "$T/free" &&
                voxelise -q --unit mm -s 5 cube.obj | attach -q | sinew bind | tled-run -q -d cpu -n 5 -o run.sinew &&
                sinew render -o run.png run.sinew && sinew deform cube.obj -o moved.obj <run.sinew'
    else
        skip 1 "the tools lie where nobody gets"
    fi
else
    check "not root: what every test does, it does without privileges" test "$(id -u)" -ne 0
fi
is "$(find "$SINEW_BIN" -perm /6000)" "" "no tool is set-user-id"
done_testing
