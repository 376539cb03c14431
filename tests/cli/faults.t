#!/bin/sh
# shellcheck disable=SC2317,SC2016 # what each_command calls; texts for inner shells
# What fails around the tools: full disks, readers that stop, kill -9, calls that are interrupted, folders that are missing or read-only,
# names of any characters. Never a half file under the final name, never status 0 without the whole output, never a hang. With SINEW_LONG by more
# commands, and at more places.
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm # where nothing waits for a disk
. "$(dirname "$0")/lib.sh"
. "$(dirname "$0")/faults.sh"

build=$(cd "${BUILD:-build}" && pwd)
make_inputs || {
    not_ok "inputs for every tool"
    done_testing
}
echo old >"$T/old"
many=${SINEW_LONG:+1}

# limited COMMAND...: ends a command that hangs.
limited() {
    timeout 180 "$@"
}

# said: one line that ends with the tool's word on it, whatever else it told before.
said() { # PATTERN
    tail -n 1 "$T/err" | grep -aEq -e "$1"
}

# of FILE: what a message calls the file of -o. us-import says no names, which may be a patient's.
of() {
    [ "$name" = us-import ] && echo 'the output' || echo "$1"
}

# ---- Full disks: a device, and files that may not grow past a number of blocks.
full() { # NAME INPUT COMMAND...
    name=$1 input=$2
    shift 2
    [ "$name" != diff ] || return 0 # it has nothing to say
    limited "$@" <"$input" >/dev/full 2>"$T/err"
    out=$?
    said 'cannot write: No space left on device' || out="$out, $(tail -n 1 "$T/err")"
    limited "$@" -o /dev/full <"$input" 2>"$T/err"
    file=$?
    said "$(of /dev/full): cannot write: No space left on device" || file="$file, $(tail -n 1 "$T/err")"
    is "$out $file" "1 1" "$name: a full device"
}
if [ -w /dev/full ]; then
    each_command full
    full "render, megabytes at once" "$T/in/frames.sinew" sinew render --size 1280x960 --format ppm
    is "$(wc -l <"$T/err" | tr -d ' ')" 1 "and nothing else is said"
else
    skip 1 "no /dev/full"
fi

limit() { # NAME INPUT COMMAND...
    name=$1 input=$2
    shift 2
    "$@" -o "$T/want" <"$input" >/dev/null 2>&1
    blocks=$(($(wc -c <"$T/want") / 512 + 1)) runs=0 wrong=0
    step=$((many ? blocks / 200 + 1 : blocks / 3 + 1))
    at=0
    while [ "$at" -lt "$blocks" ]; do
        cp "$T/old" "$T/out"
        { # messages go by a pipe, which has no limit
            limited sh -c 'ulimit -f "$1"; shift; exec "$@"' - "$at" "$@" -o "$T/out" <"$input" 2>&1 >/dev/null
            echo $? >"$T/status"
        } | cat >"$T/err"
        status=$(cat "$T/status")
        runs=$((runs + 1))
        if [ $((at * 512)) -ge "$(wc -c <"$T/want")" ]; then
            [ "$status" -eq 0 ] && cmp -s "$T/want" "$T/out" || wrong=$((wrong + 1))
        elif [ "$status" -ne 1 ] || ! cmp -s "$T/old" "$T/out" || ! said 'cannot write: File too large'; then
            wrong=$((wrong + 1))
            diag "$at blocks: status $status, $(wc -c <"$T/out") bytes, $(tail -n 1 "$T/err")"
        fi
        at=$((at + step))
    done
    is "$wrong" 0 "$name: a disk that is full after 0 to $((at - step)) of $blocks blocks, $runs times"
}
each_command limit

mkdir "$T/disk"
if mount -t tmpfs -o size=64k none "$T/disk" 2>/dev/null; then
    trap 'umount "$T/disk"; rm -rf "$T"' EXIT
    echo old >"$T/disk/out"
    dd if=/dev/zero of="$T/disk/filler" bs=1024 count=56 2>/dev/null
    fails 1 "a small tmpfs" 'out: cannot write: No space left on device' \
        tled-run -d cpu -c a=0.5 -t 0.02 --every 0.005 -o "$T/disk/out" <"$T/in/bound.sinew"
    check "what was there stays" cmp "$T/old" "$T/disk/out"
    is "$(find "$T/disk" -type f | sort | tr '\n' ' ')" "$T/disk/filler $T/disk/out " "and nothing beside it"
else
    skip 3 "no file system may be mounted here"
fi

# ---- Readers that stop: at each block of a binary model, elsewhere at steps; SIGPIPE as it is, and ignored.
reader=$build/tests/cli/reader
stops() { # NAME INPUT COMMAND...
    name=$1 input=$2
    shift 2
    "$@" <"$input" >"$T/want" 2>"$T/whole"
    size=$(wc -c <"$T/want")
    if [ "$(head -c 6 "$T/want" | tail -c 5)" = sinew ]; then
        "$reader" blocks "$T/want" >"$T/borders"
    else
        awk -v n="$size" 'BEGIN { for (i = 0; i < 20; i++) print int(i * n / 20) }' >"$T/borders"
    fi
    awk -v n="$(wc -l <"$T/borders")" -v all="$many" 'all || n < 3 || NR % int(n / 3 + 1) == 1' "$T/borders" >"$T/some"
    runs=0 wrong=0
    while read -r at; do
        for how in '' ignored; do
            ended=$(limited "$reader" "$at" ${how:+ignored} "$@" <"$input" 2>"$T/err")
            runs=$((runs + 1))
            case $ended in
            'signal 13') [ "$(wc -l <"$T/err")" -le "$(wc -l <"$T/whole")" ] && ! grep -q 'cannot write' "$T/err" ;;
            'exit 0') [ $((size - at)) -le 4096 ] ;; # the pipe had room for the rest
            *) false ;;
            esac || {
                wrong=$((wrong + 1))
                diag "$name: $at of $size bytes $how: $ended: $(tail -n 1 "$T/err")"
            }
        done
    done <"$T/some"
    [ "$runs" -gt 0 ] || wrong=none
    is "$wrong" 0 "$name: a reader that stopped $runs times ends it quietly"
}
each_command stops

# ---- kill -9 at random moments: the old bytes, or the new ones.
kills=${many:+100}
kills=${kills:-5}
killed() { # NAME INPUT COMMAND...
    name=$1 input=$2
    shift 2
    case $name in voxelise | tled-run | us-surface | deform | 'export -f vtu') ;; *) return 0 ;; esac
    "$@" -o "$T/want" <"$input" >/dev/null 2>&1
    tries=0 olds=0 news=0 wrong=0
    while [ "$tries" -lt "$kills" ]; do
        tries=$((tries + 1))
        cp "$T/old" "$T/out"
        "$@" -o "$T/out" <"$input" >/dev/null 2>&1 &
        pid=$!
        sleep "0.0$(printf '%03d' $((tries * 120 / kills)))"
        kill -9 "$pid" 2>/dev/null
        wait "$pid" 2>/dev/null
        if cmp -s "$T/old" "$T/out"; then
            olds=$((olds + 1))
        elif cmp -s "$T/want" "$T/out"; then
            news=$((news + 1))
        else
            wrong=$((wrong + 1))
        fi
    done
    "$@" -o "$T/out" <"$input" >/dev/null 2>&1 # what the last of them left
    is "$wrong $(find "$T" -maxdepth 1 -name '.sinew*')" "0 " "$name: of $tries that were killed $olds left the old bytes, $news the new ones whole, and nothing else"
}
each_command killed

# ---- Interrupted system calls.
seeds=1
[ -z "$many" ] || seeds=$(seq 1 25)
interrupted() { # NAME INPUT COMMAND...
    name=$1 input=$2
    shift 2
    "$@" -o "$T/want" <"$input" >/dev/null 2>&1
    "$@" <"$input" >"$T/want.out" 2>/dev/null
    rm -f "$T/count"
    wrong=0 runs=0
    for seed in $seeds; do
        runs=$((runs + 2))
        cp "$T/old" "$T/out"
        limited env LD_PRELOAD="$build/tests/faults/interrupt.so" SINEW_FAULT_SEED="$seed" SINEW_FAULT_COUNT="$T/count" \
            "$@" -o "$T/out" <"$input" >/dev/null 2>"$T/err" && cmp -s "$T/want" "$T/out" || wrong=$((wrong + 1))
        limited env LD_PRELOAD="$build/tests/faults/interrupt.so" SINEW_FAULT_SEED="$seed" SINEW_FAULT_COUNT="$T/count" \
            "$@" <"$input" >"$T/out" 2>>"$T/err" && cmp -s "$T/want.out" "$T/out" || wrong=$((wrong + 1))
    done
    is "$wrong" 0 "$name: the same bytes in $runs runs with $(awk '{ n += $1 } END { print n }' "$T/count") calls interrupted"
    [ "$wrong" -eq 0 ] || diag_file "$T/err"
}
if [ -n "$SINEW_SANITIZED" ]; then
    skip 1 "sanitizers come first in the list of libraries"
else
    each_command interrupted
    sinew deform --frame all --format pc2 -o "$T/want" "$T/in/skin.obj" <"$T/in/frames.sinew"
    wrong=0
    for seed in 1 2 3 ${many:+4 5 6 7 8}; do
        LD_PRELOAD="$build/tests/faults/interrupt.so" SINEW_FAULT_SEED=$seed sinew deform --frame all --format pc2 \
            -o "$T/out" "$T/in/skin.obj" <"$T/in/frames.sinew" && cmp -s "$T/want" "$T/out" || wrong=$((wrong + 1))
    done
    is "$wrong" 0 "deform to a point cache, whose head is written last: the same bytes"
fi

# ---- Folders that are missing, are none, or may not be written in; input that is a folder.
nobody=
if [ "$(id -u)" -ne 0 ]; then
    nobody='env'
elif have setpriv && setpriv --reuid 65534 --regid 65534 --clear-groups true 2>/dev/null; then
    nobody='setpriv --reuid 65534 --regid 65534 --clear-groups'
fi
mkdir "$T/locked"
echo old >"$T/locked/there"
chmod 755 "$T"
chmod 555 "$T/locked"
chmod 444 "$T/locked/there"
folders() { # NAME INPUT COMMAND...
    name=$1 input=$2
    shift 2
    bad=1
    [ "$name" != diff ] || bad=2
    got=
    limited "$@" -o "$T/none/out" <"$input" >/dev/null 2>"$T/err"
    got="$got $?"
    said "$(of none/out): cannot create: No such file or directory" || got="$got $(tail -n 1 "$T/err")"
    limited "$@" -o "$T/old/out" <"$input" >/dev/null 2>"$T/err"
    got="$got $?"
    said "$(of old/out): cannot [a-z]*: Not a directory" || got="$got $(tail -n 1 "$T/err")"
    limited "$@" -o "$T/locked" <"$input" >/dev/null 2>"$T/err"
    got="$got $?"
    said "$(of locked): is a folder" || got="$got $(tail -n 1 "$T/err")"
    is "$got" " $bad $bad $bad" "$name: -o in no folder, in a file, to a folder"
    if [ "$input" != /dev/null ]; then
        limited "$@" <"$T/in" >/dev/null 2>"$T/err"
        got=$?
        said 'stdin: cannot read: Is a directory' || got="$got $(tail -n 1 "$T/err")"
        is "$got" "$bad" "$name: a folder for its input"
    fi
    [ -n "$nobody" ] || return 0
    # shellcheck disable=SC2086 # words
    limited $nobody "$@" -o "$T/locked/new" <"$input" >/dev/null 2>"$T/err"
    got=$?
    said "$(of locked/new): cannot create: Permission denied" || got="$got $(tail -n 1 "$T/err")"
    # shellcheck disable=SC2086
    limited $nobody "$@" -o "$T/locked/there" <"$input" >/dev/null 2>"$T/err"
    got="$got $?"
    said "$(of locked/there): cannot write: Permission denied" || got="$got $(tail -n 1 "$T/err")"
    is "$got $(cat "$T/locked/there") $(ls -A "$T/locked")" "$bad $bad old there" "$name: -o in a folder, to a file that may not be written"
}
each_command folders
[ -n "$nobody" ] || skip 1 "no setpriv to be nobody with"

# ---- Names: blanks, a line break, UTF-8, what is no UTF-8, quotes, a dash first.
names() { # NAME INPUT COMMAND...
    name=$1 input=$2
    shift 2
    "$@" -o "$T/want" <"$input" >/dev/null 2>&1
    odd="$(printf 'a  b\n\303\274\344\270\255 \377 $x "q" '"'"'s'"'"' `;*')"
    wrong=0
    for file in "$T/$odd" ${many:+"$T/-out" ./-x}; do
        (cd "$T" && limited "$@" -o "$file" <"$input" >/dev/null 2>&1) && (cd "$T" && cmp -s "$T/want" "$file") || wrong=$((wrong + 1))
        (cd "$T" && rm -f "$file")
    done
    (cd "$T" && limited "$@" -o -x <"$input" >/dev/null 2>&1 && cmp -s "$T/want" ./-x) || wrong=$((wrong + 1))
    rm -f "$T/-x"
    is "$wrong" 0 "$name: -o with any name"
}
each_command names
mkdir "$T/names"
cd "$T/names" || exit 1
odd="$(printf 'a  b\n\303\274\344\270\255 \377 $x "q" '"'"'s'"'"' `;*')"
for name in "$odd" -x; do
    cp "$T/in/head.obj" "./$name.obj"
    check "voxelise reads such a name" voxelise -q --unit mm -s 4 -o "./$name" -- "$name.obj"
    check "and puts it into provenance" sinew info -o "./$name.info" -- "$name"
    check "bind and deform read it" sh -c 'attach <"$1" | sinew bind -o bound -- "$1.obj" && tled-run -q -d cpu -n 3 -c a=0.1 <bound | sinew deform -o "$1.moved" -- "$1.obj"' - "$name"
    check "there it is" test -s "./$name.moved"
    cp "$T/in/script" "./$name.script"
    check "a script of such a name" sh -c 'tled-run -q -d cpu -n 3 --script "$1.script" --checkpoint "$1.state" --checkpoint-every 1e-9 -o out <bound' - "$name"
done
is "$(find . -name '*.state*')" "" "checkpoints too, which are gone"
done_testing
