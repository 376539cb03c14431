#!/bin/sh
# The tutorial of sinew(7), as it stands on the page: every literal block in its order, by bash, by sh and by make, each in an
# empty folder that holds samples/ only. All three must leave the same files.
. "$(dirname "$0")/lib.sh"

# The literal blocks of section TUTORIAL, as a reader sees them.
sed -n '/^\.Sh TUTORIAL/,/^\.Sh ENVIRONMENT/p' man/sinew.7 |
    sed -n '/^\.Bd -literal/,/^\.Ed/{/^\./!p;}' | sed 's/\\e/\\/g; s/\\&//g' >"$T/tutorial"
commands=$(grep -c '^[^ ]' "$T/tutorial")
check "the page has its commands: $commands" test "$commands" -ge 20

# folder NAME: an empty one with samples/.
folder() {
    mkdir "$T/$1" && ln -s "$ROOT/samples" "$T/$1/samples"
}

# run NAME COMMAND...: from within that folder.
# shellcheck disable=SC2317 # called by name
run() {
    (cd "$T/$1" && shift && "$@")
}

folder sh
check "sh" run sh sh -e "$T/tutorial"
is "$(find "$T/sh" -name 'pulled_*.obj' | wc -l)" 6 "an OBJ every 20 ms, from 0 on"
is "$(wc -l <"$T/sh/way.tsv" | tr -d ' ')" 7 "and its row in the table"
check "what was said to be the same is: no words of sinew diff" test "$(grep -c differ "$T/stdout")" -eq 0

if have bash; then
    folder bash
    check "bash" run bash bash -e "$T/tutorial"
    check "the same files" diff -r "$T/sh" "$T/bash"
else
    skip 2 "no bash"
fi
if have make; then
    folder make
    # A recipe: a tab before each line, and each dollar twice.
    sed 's/\$/$$/g; s/^/\t/; 1s/^/all:\n/' "$T/tutorial" | sed '/ |$/s/$/ \\/' >"$T/tutorial.mk"
    check "make" run make env -u MAKEFLAGS -u MAKELEVEL make -f "$T/tutorial.mk"
    check "the same files" diff -r "$T/sh" "$T/make"
else
    skip 2 "no make"
fi
done_testing
