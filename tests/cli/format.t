#!/bin/sh
# The format of models as the tools read and write it: both encodings, gzip, how a stream ends, what is refused. The unit
# tests try every byte and bit; here the real tools stand in real pipes. `sinew bind` serves as the tool that copies.
. "$(dirname "$0")/lib.sh"

copy() {
    sinew bind -q "$@"
}
# Without what a copy adds to the provenance.
strip() {
    grep -v '^prov bind '
}

small=$ROOT/tests/cli/small.sinew
sed '/^end$/d' "$small" | awk '/^frame / && !done { print "block xtra 00000007 3\n0102ff"; done = 1 } { print }' >"$T/with"
echo end >>"$T/with"
copy --text <"$T/with" >"$T/text"
is $? 0 "text is read"
copy <"$T/text" >"$T/binary"
is "$(head -c 6 "$T/binary" | tail -c 5)" sinew "binary is the default"
copy --text <"$T/binary" | strip >"$T/again"
strip <"$T/text" >"$T/once"
check "text -> binary -> text: the same bytes" cmp "$T/once" "$T/again"
is "$(grep -A 2 '^block xtra' "$T/again" | tr '\n' ' ')" "block xtra 00000007 3 0102ff crc $(sed -n '/^block xtra/{n;n;s/crc //p;}' "$T/again") " \
    "an unknown block is copied"
is "$(grep -c '^block abcd 00000000 0$' "$T/again")" 1 "and one of no bytes"
grep -q '^array x-heat' "$T/again" && grep -q '^array x-word' "$T/again"
is $? 0 "unknown arrays are kept"
copy -z <"$T/text" >"$T/packed"
is "$(od -An -tx1 -N2 "$T/packed" | tr -d ' ')" 1f8b "-z writes gzip"
gzip -dc "$T/packed" >"$T/plain"
check "which holds the same binary" cmp "$T/plain" "$T/binary"
copy --text <"$T/packed" | strip >"$T/again"
check "gzip is read" cmp "$T/once" "$T/again"
grep -v '^crc ' "$T/once" >"$T/edited"
copy <"$T/edited" | copy --text | strip >"$T/again"
check "text without checksums is taken" cmp "$T/once" "$T/again"

# Not taken.
awk '/^array node.rigid/ { n = NR + 1 } NR == n { print 1 - $1; next } { print }' "$T/once" >"$T/wrong"
line=$(awk '/^array node.rigid/ { seen = 1 } seen && /^crc/ { print NR; exit }' "$T/once")
fails 1 "a wrong checksum in text is refused, with its line" "^sinew-info: stdin:$line: crc [0-9a-f]{8} does not fit array node.rigid" \
    sh -c "sinew info <'$T/wrong'"
fails 1 "nothing on stdin" "^bind: no model on stdin \\(0 bytes\\); if bash's builtin bind ran, write 'sinew bind'\$" \
    sh -c "sinew bind </dev/null >'$T/out'"
fails 1 "something else on stdin" "^sinew-info: stdin: is not a sinew model; expected '%sinew 1 text'" \
    sh -c "echo v 0 0 0 | sinew info"
fails 1 "text of a later major version" "^sinew-info: stdin:1: is a model of format version 2; expected 1" \
    sh -c "printf '%%sinew 2 text\nend\n' | sinew info"
check "text of a later minor version" sh -c "printf '%%sinew 1.9 text\nend\n' | sinew info"

# Cut somewhere: refused, and no output file is left.
taken=0
size=$(wc -c <"$T/binary")
at=1
while [ "$at" -lt "$size" ]; do
    head -c "$at" "$T/binary" | copy -o "$T/cut" 2>"$T/err" && taken=$((taken + 1))
    grep -Eq 'cut short|damaged' "$T/err" || taken=$((taken + 1))
    at=$((at + size / 20))
done
head -c $((size - 1)) "$T/binary" | copy -o "$T/cut" 2>"$T/err" && taken=$((taken + 1))
is $taken 0 "a binary model cut at twenty places is refused"
is "$(ls "$T/cut" 2>/dev/null)" "" "and leaves no file"
size=$(wc -c <"$T/once")
fails 1 "text without its last line end is refused" "cut short; expected .end." sh -c "head -c $((size - 1)) '$T/once' | sinew info"
at=$(($(grep -abo node.position "$T/binary" | head -n 1 | cut -d: -f1) + 100))
fails 1 "a wrong byte is refused, with its block" "^sinew-info: stdin: block [0-9]+ \\(ARRY node.position\\): checksum is" \
    sh -c "(head -c $at '$T/binary'; printf '\\252'; tail -c +$((at + 2)) '$T/binary') | sinew info"

# Sizes that lie, in little memory: 2^60 bytes of an unknown block, 2^60 rows.
{
    printf '\211sinew\r\n\032\n\001\000\011\232\352\064'
    printf 'xtra\000\000\000\000\000\000\000\000\000\000\000\020'
    head -c 5000 "$T/binary"
} >"$T/huge"
limit=
[ -n "$SINEW_SANITIZED" ] || limit='ulimit -v 400000;'
fails 1 "a block of 2^60 bytes" "cut short" sh -c "$limit sinew info <'$T/huge'"
fails 1 "an array of 10^18 rows" "stdin:5: array x, row 1 " \
    sh -c "$limit printf '%%sinew 1 text\naxis n 1000000000000000000\narray x f64 1 n 1\n0\nend\n' | sinew info"

# How a stream ends.
printf '%%sinew 1 text\nfail 3 "tled-run: diverged"\n' >"$T/failed"
copy --text <"$T/failed" 2>"$T/err" | strip >"$T/out"
check "fail is copied" cmp "$T/failed" "$T/out"
copy <"$T/failed" >"$T/out" 2>"$T/err"
is $? 3 "its status is taken"
is "$(cat "$T/err")" "" "silently"
copy <"$T/failed" | copy | copy -o "$T/none" 2>"$T/err"
is "$? $(cat "$T/err") $(ls "$T/none" 2>/dev/null)" "3  " "through any number of tools, and no file is left"
(sinew bind --bogus <"$T/text" | attach | copy >"$T/out") 2>"$T/err"
is "$? $(wc -l <"$T/err") $(grep -c '^bind: ' "$T/err")" "2 1 1" "a usage error ends the whole pipe, with one message"

# What the manual shows is so.
awk '/^\.Ed/ { exit } on; /^\.Bd -literal/ { on = 1 }' "$ROOT/man/sinew-model.5" >"$T/example"
is "$(sinew info --get node.displacement.max <"$T/example")" 0.01 "the model in sinew-model(5)"

# Indices of frames increase.
sed 's/^frame 10 /frame 0 /' "$small" >"$T/twice"
fails 1 "two frames of one index" "twice:[0-9]+: frame 0 after frame 0; expected indices that increase" sinew info "$T/twice"
sed 's/^frame 10 /frame -1 /' "$small" >"$T/back"
fails 1 "a frame before the last" "frame -1 after frame 0" sinew info "$T/back"

done_testing
