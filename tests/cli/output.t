#!/bin/sh
# What a tool writes to, where something is wrong with it: closed descriptors, full devices, long names, links, terminals.
. "$(dirname "$0")/lib.sh"

small=$ROOT/tests/cli/small.sinew
sinew info --json "$small" >"$T/want"
is $? 0 "sinew info"

# A closed descriptor is not the output's: no message may go into it, whatever the output's number would be.
cat >"$T/cube.obj" <<'OBJ'
g thing
v 0 0 0
v 4 0 0
v 4 4 0
v 0 4 0
v 0 0 4
v 4 0 4
v 4 4 4
v 0 4 4
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
OBJ
voxelise -o "$T/one" --unit mm -s 2 "$T/cube.obj" 2>"$T/err"
check "this warns" grep -q warning "$T/err"
for closed in '2>&-' '0<&-' '1>&-' '0<&- 2>&-' '0<&- 1>&- 2>&-'; do
    # shellcheck disable=SC2016 # for the inner shell
    check "-o with $closed" sh -c 'voxelise -o "$1" --unit mm -s 2 "$2" '"$closed" - "$T/two" "$T/cube.obj"
    check "writes the same model" cmp "$T/one" "$T/two"
    rm -f "$T/two"
done
# shellcheck disable=SC2016
fails 1 "standard output that is closed is an error" "stdout: cannot write: Bad file descriptor" \
    sh -c 'voxelise --unit mm -s 2 "$1" >&-' - "$T/cube.obj"
fails 1 "standard input that is closed is an error" "stdin: cannot read: Bad file descriptor" sh -c 'attach -o /dev/null <&-'
is "$(attach --help 2>&- <&- | head -c 5)" "usage" "--help without the others"

# A full device.
if [ -w /dev/full ]; then
    for tool in voxelise attach tled-run sinew sinew-info; do
        for option in --help --version; do
            # shellcheck disable=SC2016
            fails 1 "$tool $option to a full device is said" "$tool: stdout: cannot write: No space" \
                sh -c '"$1" "$2" >/dev/full' - "$tool" "$option"
        done
    done
else
    skip 10 "no /dev/full"
fi

# Names.
name=$(printf '%0255d' 0)
check "a name of 255 bytes" sinew info --json -o "$T/$name" "$small"
check "holds what was written" cmp "$T/want" "$T/$name"
fails 1 "a longer one is refused" "File name too long" sinew info -o "$T/${name}0" "$small"
ln -s there "$T/link"
check "-o to a link to nothing" sinew info --json -o "$T/link" "$small"
is "$(readlink "$T/link")" there "leaves the link"
check "and makes what it names" cmp "$T/want" "$T/there"

# What is read is not written over.
cp "$small" "$T/own"
fails 2 "-o with the operand's own name" "overwrite what is read, .*own.; expected another file" sinew info -o "$T/own" "$T/own"
ln -s own "$T/alias"
fails 2 "or a link to it" "overwrite what is read" sinew info -o "$T/alias" "$T/own"
check "the file stays" cmp "$small" "$T/own"

# What a message says of a file steers no terminal.
printf 'x\033[2J\302\233y' >"$T/esc"
fails 1 "a name with escapes" '^sinew-info: .*x\?\[2J\?\?y: cannot open' sinew info "$(cat "$T/esc")"
printf '%%sinew 1 text\nfail 1 "tool: \\u001b[2J"\n' >"$T/fail"
sinew info "$T/fail" >"$T/stdout" 2>"$T/stderr"
is $? 1 "a model that failed"
is "$(tr -d '[:print:]\n' <"$T/stderr")" "" "and its text is harmless"

# Zeros after gzipped data are padding.
gzip -c "$small" >"$T/padded.gz"
dd if=/dev/zero bs=1000 count=300 2>/dev/null >>"$T/padded.gz"
check "gzip with padding" sinew info --json -o "$T/padded" "$T/padded.gz"
check "gives the same" cmp "$T/want" "$T/padded"
printf 'something else' >>"$T/padded.gz"
fails 1 "but nothing else after it" "gzip data is damaged" sinew info "$T/padded.gz"
done_testing
