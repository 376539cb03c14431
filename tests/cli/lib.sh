# shellcheck shell=sh
# TAP from POSIX shell scripts, for the tests in this folder: `. "$(dirname "$0")/lib.sh"` is their first line.
# The tools under test are in $SINEW_BIN (default bin), first on PATH. A test starts in the checkout's root, with
# standard input empty, and has
#   $T     a fresh temporary folder, removed at the end        $ROOT  the checkout
#   $DATA  the folder of shared data, or empty where there is none (SINEW_SHARED names it)
# What a checked command wrote stays in $T/stdout and $T/stderr until the next one.

ROOT=$(cd "$(dirname "$0")/../.." && pwd)
cd "$ROOT" || exit 1
case ${SINEW_BIN:=bin} in
/*) ;;
*) SINEW_BIN=$ROOT/$SINEW_BIN ;;
esac
PATH=$SINEW_BIN:$PATH
LC_ALL=C
DATA=${SINEW_SHARED:-$ROOT/../shared}/data
[ -d "$DATA" ] || DATA=
T=$(mktemp -d) || exit 1
export ROOT SINEW_BIN PATH LC_ALL DATA T
trap 'rm -rf "$T"' EXIT
trap 'exit 1' HUP INT TERM
exec </dev/null

# What stands first on PATH may be a wrapper that takes longer to begin than a small test takes in all.
if [ -x /usr/bin/python3 ]; then
    python3() {
        /usr/bin/python3 "$@"
    }
fi

tap_count=0
tap_failed=0

# ok NAME: one test that passed.
ok() {
    tap_count=$((tap_count + 1))
    printf 'ok %d - %s\n' "$tap_count" "$1"
}

# not_ok NAME: one that failed.
not_ok() {
    tap_count=$((tap_count + 1))
    tap_failed=$((tap_failed + 1))
    printf 'not ok %d - %s\n' "$tap_count" "$1"
}

# diag TEXT: a remark under a failed test.
diag() {
    printf '%s\n' "$1" | sed 's/^/# /'
}

# diag_file FILE: the first lines of what a command wrote.
diag_file() {
    head -c 4000 "$1" | tr -d '\000' | head -n 20 | sed 's/^/#   /'
}

# is GOT WANT NAME: the same text.
is() {
    if [ "$1" = "$2" ]; then
        ok "$3"
    else
        not_ok "$3"
        diag "got    '$1'"
        diag "wanted '$2'"
    fi
}

# check NAME COMMAND...: it exits 0.
check() {
    tap_name=$1
    shift
    "$@" >"$T/stdout" 2>"$T/stderr"
    tap_status=$?
    if [ "$tap_status" -eq 0 ]; then
        ok "$tap_name"
    else
        not_ok "$tap_name"
        diag "exit status $tap_status of: $*"
        diag_file "$T/stderr"
        diag_file "$T/stdout"
    fi
}

# fails STATUS NAME PATTERN COMMAND...: it exits with STATUS and its stderr matches PATTERN (of grep -E).
fails() {
    tap_want=$1 tap_name=$2 tap_pattern=$3
    shift 3
    "$@" >"$T/stdout" 2>"$T/stderr"
    tap_status=$?
    if [ "$tap_status" -eq "$tap_want" ] && grep -Eq -e "$tap_pattern" "$T/stderr"; then
        ok "$tap_name"
    else
        not_ok "$tap_name"
        diag "exit status $tap_status, wanted $tap_want, of: $*"
        diag "wanted on stderr: $tap_pattern"
        diag_file "$T/stderr"
    fi
}

# get KEY FILE: what sinew info says of a model.
get() {
    sinew info --get "$1" "$2"
}

# below GOT MOST NAME: a number, |GOT| < MOST.
below() {
    check "$3 ($1)" awk -v got="$1" -v most="$2" 'BEGIN { exit !(got != "" && got * got < most * most) }'
}

# near GOT WANT RELTOL NAME: numbers, |GOT - WANT| <= RELTOL |WANT| (absolute where WANT is 0).
near() {
    if awk -v got="$1" -v want="$2" -v tolerance="$3" 'BEGIN {
        if (got !~ /^[-+]?[0-9.]/) exit 1
        off = got - want; if (off < 0) off = -off
        size = want + 0; if (size < 0) size = -size; if (size == 0) size = 1
        exit !(off <= tolerance * size) }'; then
        ok "$4"
    else
        not_ok "$4"
        diag "got $1, wanted $2 to a relative $3"
    fi
}

# cut_off POINT COMMAND...: runs it until its checkpoint is there, 5 s at most, and kills it.
cut_off() {
    tap_point=$1
    shift
    { "$@" <&3 >"$T/stdout" 2>/dev/null & } 3<&0 # a command behind & has no stdin but by name
    tap_cut=$!
    tap_waits=0
    while [ ! -s "$tap_point" ] && [ $tap_waits -lt 100 ]; do
        sleep .05
        tap_waits=$((tap_waits + 1))
    done
    kill -KILL $tap_cut
    wait $tap_cut 2>/dev/null
}

# options_of TOOL: the options that its help has, letters and names, one a line, sorted.
options_of() {
    "$1" --help | grep -E '^  (-[a-zA-Z]|    --)' | sed 's/^ *//; s/  .*//' | tr ' ,' '[\n*]' | grep -E '^(-[a-zA-Z]|--[a-z-]+)$' | sort -u
}

# skip N REASON: N tests that cannot be made here.
skip() {
    tap_skips=$1
    while [ "$tap_skips" -gt 0 ]; do
        tap_count=$((tap_count + 1))
        tap_skips=$((tap_skips - 1))
        printf 'ok %d # skip %s\n' "$tap_count" "$2"
    done
}

# skip_all REASON: the whole file cannot be run here.
skip_all() {
    printf '1..0 # skip %s\n' "$1"
    exit 0
}

# have COMMAND: whether there is such a command.
have() {
    command -v "$1" >/dev/null 2>&1
}

# The last line of every test.
done_testing() {
    printf '1..%d\n' "$tap_count"
    [ "$tap_failed" -eq 0 ]
    exit $?
}
