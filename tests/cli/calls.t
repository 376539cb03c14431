#!/bin/sh
# shellcheck disable=SC2317 # what each_command calls
# Calls to the system that fail: in every tool, the n-th open, stat, write, fsync, link, rename, ... after main begins (tests/faults/calls.c). The
# tool says in one line which file and why, and exits with 1, with the output as it was before; or the call is one that may fail, and the output
# is right. Nothing is left beside it. Files without a name, and with one. All n of every tool with SINEW_LONG, else some of a few.
#
# What may fail: the way to a file that has another way (O_TMPFILE, then a file with a name; a link to the file's place, then to a name beside it
# and a rename), the lock by which others know a file for somebody's, a look for what killed runs left, closing what is stored.
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm # where nothing waits for a disk
. "$(dirname "$0")/lib.sh"
. "$(dirname "$0")/faults.sh"

library=$(cd "${BUILD:-build}" && pwd)/tests/faults/calls.so
[ -e "$library" ] || skip_all "no library to preload: make unit"
[ -z "$SINEW_SANITIZED" ] || skip_all "sanitizers come first in the list of libraries"
LD_PRELOAD=$library SINEW_FAULT_CALL=any SINEW_FAULT_COUNT=$T/count tled-run --version >/dev/null
[ -s "$T/count" ] || skip_all "calls of this C library are not counted so"
make_inputs || {
    not_ok "inputs for every tool"
    done_testing
}
mkdir "$T/here" "$T/wants"
tries=2
calls='open:EMFILE write:EIO fsync:EDQUOT rename:EACCES close:EIO'
if [ "$SINEW_LONG" ]; then
    tries=2000
    calls='open:EACCES open:EMFILE open:EIO stat:EIO write:EIO write:ENOSPC write:EDQUOT fsync:EIO fsync:EDQUOT link:EIO link:ENOSPC
        rename:EACCES rename:ENOSPC unlink:EACCES truncate:EIO chmod:EIO lock:EIO close:EIO'
fi

# text ERROR: as strerror() has it.
text() {
    case $1 in
    EIO) echo 'Input/output error' ;;
    ENOSPC) echo 'No space left on device' ;;
    EDQUOT) echo 'Disk quota exceeded' ;;
    EACCES) echo 'Permission denied' ;;
    EMFILE) echo 'Too many open files' ;;
    esac
}

# One line says it, with the name of a file or stream.
said() {
    [ "$(grep -ac "$(text "$error")" "$T/err")" -eq 1 ] && grep -aqE "^[a-z-]+: [^ ].*: ($(text "$error")|.*: $(text "$error"))" "$T/err"
}

# Old files, one that may not be read by all among them.
fresh() {
    rm -rf "$T/here/"* "$T"/here/.sinew*
    for file in $files; do
        echo old >"$T/here/$file"
        chmod 604 "$T/here/$file"
    done
}

# are STATE...: every file is in one of these states: old, or new and whole; its permissions are those that the old one had.
are() {
    for file in $files; do
        is_one=
        for state; do
            case $state in
            old) [ "$(cat "$T/here/$file")" != old ] || is_one=1 ;;
            new) ! cmp -s "$T/wants/$file" "$T/here/$file" || is_one=1 ;;
            esac
        done
        [ "$is_one" ] && [ "$(stat -c %a "$T/here/$file")" = 604 ] || return 1
    done
}

# preloaded COMMAND...: the n-th call of $call fails by $error; n 0: none.
preloaded() {
    timeout 180 env LD_PRELOAD="$library" SINEW_FAULT_CALL="$call" SINEW_FAULT_AT="$n" SINEW_FAULT_ERROR="$error" SINEW_FAULT_COUNT="$T/count" \
        ${named:+SINEW_FAULT_NAMED=1} "$@" <"$input" >/dev/null 2>"$T/err"
}

# each_failure TRY COMMAND...: calls TRY COMMAND... for each call of each kind that fails.
each_failure() {
    try=$1
    shift
    runs=0 ended=0 right=0 late=0 wrong=0
    for how in $calls; do
        call=${how%%:*} error=${how#*:}
        for named in '' 1; do
            [ ! "$named" ] || case $call in link | rename | unlink | open) ;; *) continue ;; esac
            n=0
            fresh
            preloaded "$@"
            all=$(cat "$T/count")
            step=$((all / tries + 1))
            n=$((step > 1 ? 2 : 1))
            while [ "$n" -le "$all" ]; do
                fresh
                preloaded "$@"
                status=$?
                runs=$((runs + 1))
                "$try" "$@" || {
                    wrong=$((wrong + 1))
                    diag "$name, $call $n of $all, $error${named:+, named}: status $status, $(ls -lA "$T/here"): $(cat "$T/err")"
                }
                n=$((n + step))
            done
        done
    done 2>/dev/null
    is "$wrong" 0 "$name: $runs calls that failed: $ended ended with a message, $late did that once files were there, $right were right all the same"
}

# may_fail: whether a call of this kind may fail without a word.
may_fail() {
    case $call in
    write | fsync | rename | truncate | chmod) return 1 ;;
    esac
}

# What became of the files of a command that ended.
ended_well() {
    if [ "$status" -eq 0 ] && may_fail && are new; then
        right=$((right + 1))
    elif [ "$status" -eq "$bad" ] && said && are old; then
        ended=$((ended + 1))
    elif [ "$status" -eq "$bad" ] && said && grep -aq 'is there, but its folder cannot be stored' "$T/err" && are new; then
        late=$((late + 1))
    elif [ "$status" -eq "$bad" ] && said && [ "$files" != out ] && { [ "$call" != write ] || [ "${name%,*,*}" = us-slice ]; } && are old new; then
        late=$((late + 1)) # of several files some are in their places: no system puts all there at once, and us-slice each as it is done
    else
        return 1
    fi
    # What cannot be removed stays, but only that.
    [ -z "$(find "$T/here" -name '.sinew*')" ] || [ "$call" = unlink ]
}

# single NAME INPUT COMMAND...: with -o out.
single() {
    name=$1 input=$2 files=out bad=1
    shift 2
    case $name in
    diff) bad=2 ;; # as diff(1) has it
    'attach --fibre field, text' | info | us-import) ;;
    *) [ "$SINEW_LONG" ] || return 0 ;;
    esac
    "$@" -o "$T/wants/out" <"$input" 2>/dev/null
    each_failure ended_well "$@" -o "$T/here/out"
}
each_command single

# several NAME FILES INPUT COMMAND...: files in the folder that the command is told of as DIR.
several() {
    name=$1 files=$2 input=$3 bad=1
    shift 3
    for file in $files; do
        cp "$T/in/skin.obj" "$T/wants/$file"
    done
    (cd "$T/wants" && "$@" <"$input" >/dev/null 2>&1)
    cd "$T/here" || exit 1
    each_failure ended_well "$@"
    cd "$ROOT" || exit 1
}
several "deform, a series" "s_0.obj s_1.obj s_2.obj" "$T/in/frames.sinew" sinew-deform --frame all -o s_%d.obj "$T/in/skin.obj"
if [ "$SINEW_LONG" ]; then
    several "deform, a point cache" out "$T/in/frames.sinew" sinew-deform --format pc2 -o out "$T/in/skin.obj"
    several "export, a series" "f.pvd f_0000.vtu f_0001.vtu f_0002.vtu" "$T/in/frames.sinew" sinew-export -f vtu --frame all -o f.pvd
    several "render, a series" "p_0.png p_1.png p_2.png" "$T/in/frames.sinew" sinew-render --size 20x20 --frame all -o p_%d.png
    several "us-slice, a series, cuts" "i_0.pgm i_1.pgm c_0.obj c_1.obj" "$T/in/pressed.sinew" \
        us-slice --size 24x24 --depth 2cm --cut c_%d.obj -o i_%d.pgm "$T/in/volume.nrrd"
fi

# A run with a log and checkpoints: what it saved is whole, and it goes on from there to the same bytes and rows.
goes_on() {
    same_log() { # but for the columns that go by the clock
        cut -f 1-18 "$T/here/log" | cmp -s - "$T/rows"
    }
    if [ "$status" -eq 0 ] && may_fail && are new && same_log && [ ! -e "$T/here/state" ]; then
        right=$((right + 1))
        return
    fi
    [ "$status" -eq 1 ] && said || return 1
    if are new && grep -aqE 'is there, but its folder cannot be stored|belongs to a run that has ended' "$T/err"; then
        late=$((late + 1))
    elif are old; then
        ended=$((ended + 1))
    else
        return 1
    fi
    how=--checkpoint
    [ ! -e "$T/here/state" ] && [ ! -e "$T/here/state.1" ] || how=--restart
    tled-run "$how" state -q -d cpu --threads 2 -c a=0.5 -t 0.02 --every 0.005 --log log --checkpoint-every 0.005 -o out <"$input" >/dev/null 2>&1 &&
        are new && same_log && [ ! -e "$T/here/state" ]
}
name="tled-run with a log and checkpoints" input=$T/in/bound.sinew files=out bad=1
[ "$SINEW_LONG" ] || calls='open:EMFILE write:EIO fsync:EDQUOT stat:EIO'
tled-run -q -d cpu --threads 2 -c a=0.5 -t 0.02 --every 0.005 --log "$T/log" -o "$T/wants/out" <"$input"
cut -f 1-18 "$T/log" >"$T/rows"
cd "$T/here" || exit 1
each_failure goes_on tled-run --checkpoint state -q -d cpu --threads 2 -c a=0.5 -t 0.02 --every 0.005 --log log --checkpoint-every 0.005 -o out
done_testing
