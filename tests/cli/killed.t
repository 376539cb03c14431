#!/bin/sh
# A tool that is killed while it writes leaves the old file whole, or the new one, and nothing beside it: by each signal, at each of its calls to
# the system (tests/faults/calls.c), where files need no name until they are in their place, and where they do. What kill -9 leaves there is gone
# after the next run. All calls with SINEW_LONG, else some.
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm # where nothing waits for a disk
. "$(dirname "$0")/lib.sh"
. "$ROOT/tests/cli/boxes.sh"

library=$(cd "${BUILD:-build}" && pwd)/tests/faults/calls.so
[ -e "$library" ] || skip_all "no library to preload: make unit"
[ -z "$SINEW_SANITIZED" ] || skip_all "sanitizers come first in the list of libraries"
# shellcheck disable=SC3045 # dash, bash and busybox have it
ulimit -c 0
mkdir "$T/in" "$T/here" "$T/want"
cp tests/cli/small.sinew "$T/in"
box skin 2 2 2 10 10 6 >"$T/in/skin.obj"
voxelise -q --unit mm -s 4 "$T/in/skin.obj" 2>"$T/err" | sinew bind -q "$T/in/skin.obj" |
    tled-run -q -d cpu -n 20 -g 0,0,-9.81 --every 1e-3 -o "$T/in/frames" 2>"$T/err"
LD_PRELOAD=$library SINEW_FAULT_CALL=any SINEW_FAULT_COUNT=$T/count sinew info --get axis.node "$T/in/small.sinew" >/dev/null
[ -s "$T/count" ] || skip_all "calls of this C library are not counted so"
cd "$T/here" || exit 1

fresh() {
    rm -f ./* .sinew*
    for file in $old; do
        echo old >"$file"
    done
}

# Whether each file is the old one (or is not there), or the new one whole.
are_whole() {
    for file in ../want/*; do
        made=${file#../want/}
        [ ! -e "$made" ] || cmp -s "$file" "$made" || [ "$(cat "$made")" = old ] || return 1
    done
}

left() {
    find . -name '.sinew*' | wc -l
}

# killed NAME OLD COMMAND...: which makes files here, of which those of OLD are there.
killed() {
    name=$1 old=$2
    shift 2
    "$@" 2>../err
    mv ./* ../want
    for branch in '' named; do
        fresh
        LD_PRELOAD=$library SINEW_FAULT_CALL=any SINEW_FAULT_COUNT=$T/count ${branch:+env SINEW_FAULT_NAMED=1} "$@" 2>../err
        all=$(cat "$T/count")
        for number in $signals; do
            step=$((all * files / 20 + 1))
            [ "$number" -eq 9 ] || step=$((all / 3))
            [ -z "$SINEW_LONG" ] || step=1
            n=$((number % step + 1)) runs=0 wrong=0 lefts=0 unswept=0 unsignalled=0
            while [ "$n" -le "$all" ]; do
                fresh
                env LD_PRELOAD="$library" SINEW_FAULT_CALL=any SINEW_FAULT_AT="$n" SINEW_FAULT_SIGNAL="$number" ${branch:+SINEW_FAULT_NAMED=1} "$@" 2>../err
                [ $? -eq $((128 + number)) ] || unsignalled=$((unsignalled + 1))
                are_whole || wrong=$((wrong + 1))
                if [ "$(left)" -gt 0 ]; then
                    lefts=$((lefts + 1))
                    env ${branch:+LD_PRELOAD="$library" SINEW_FAULT_NAMED=1} "$@" 2>../err
                    [ "$(left)" -eq 0 ] || unswept=$((unswept + 1))
                fi
                runs=$((runs + 1)) n=$((n + step))
            done
            most=0
            [ "$number" -ne 9 ] || most=$files # between the calls by which a file has a name, and takes its place
            [ "$number$branch" != 9named ] || most=$runs
            [ "$lefts" -le "$most" ] || wrong="$lefts left something"
            is "$wrong $unswept $unsignalled" "0 0 0" "$name${branch:+, named}: signal $number at $runs of $all calls: whole files, $lefts times something left, which the next run removed"
        done
    done 2>/dev/null # the shell tells of programs that died
    rm ../want/*
}

signals='9 3 24 15'
files=0 # a new one goes to its place at once
killed "info, a new file" '' sinew-info -o out ../in/small.sinew
files=1
killed "info" out sinew-info -o out ../in/small.sinew
signals='9 24'
files=3
killed "deform, a series" 's_0.obj s_1.obj s_2.obj' sh -c 'exec sinew-deform --threads 1 --frame all -o s_%d.obj ../in/skin.obj <../in/frames'

# A limit on the size of files fails what writes, and says which file; the process does not end by SIGXFSZ.
over() { # COMMAND...: messages go by a pipe, which has no limit
    # shellcheck disable=SC2016 # for the inner shell
    { sh -c 'ulimit -f 0; exec "$@"' - "$@" 2>&1 >out; echo "status $?"; } | cat
}
old=
fresh
is "$(over sinew-info ../in/small.sinew)" "sinew-info: stdout: cannot write: File too large
status 1" "standard output"
is "$(over sinew --help)" "sinew: stdout: cannot write: File too large
status 1" "of sinew"
is "$(over sinew-info -o some ../in/small.sinew)" "sinew-info: some: cannot write: File too large
status 1" "-o"
is "$(over tled-run -q -d cpu -n 3 --log log -o /dev/null <../in/frames | grep -v warning)" "tled-run: log: cannot write: File too large
status 1" "a log"
LD_PRELOAD=$library SINEW_FAULT_CALL=write SINEW_FAULT_AT=1 SINEW_FAULT_SIGNAL=25 sinew-info -o out ../in/small.sinew
is "$? $(sinew-info ../in/small.sinew | cmp - out)" "0 " "nor by one that comes from elsewhere"
is "$(find . -type f | sort | tr '\n' ' ')" "./log ./out " "and nothing is left"
done_testing
