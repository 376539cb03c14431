#!/bin/sh
# OBJ files as people have them, read by bind: gzip, CR LF, folders, nonsense. Each refusal names the file and the line,
# says what was expected, exits 1 and leaves no output.
. "$(dirname "$0")/lib.sh"

awk -v nx=2 -v ny=2 -v nz=2 -v h=0.01 -f tests/cli/lattice.awk >"$T/model"

# binds FILE: what of the surface the model then holds, without its head.
binds() {
    sinew bind -q --text --name s "$1" <"$T/model" | sed -n '/^array s/,$p'
}

cat >"$T/plain.obj" <<'OBJ'
# a square
o thing
v 1 1 1
v 9 1 1 1.0
v 9 9 1 0.5 0.5 0.5
v 1 9 1
vt 0 0
vn 0 0 1
usemtl skin
s 1
f 1/1/1 2/1/1 3/1/1 4/1/1
g left right
f -4//-1 -3//-1 -2//-1
l 1 2 3
p 4
OBJ
binds "$T/plain.obj" >"$T/want"
check "an OBJ of every kind of line is carried" grep -q '^"left right"$' "$T/want"
is "$(sed -n '/vertex.position/,/^array/p' "$T/want" | sed -n 2p)" "0.001 0.001 0.001" "in metres"
is "$(sed -n '/face.vertex/,/^array/p' "$T/want" | grep -v array | grep -v crc | tr '\n' ' ')" \
    "0 1 2 3 0 1 2 0 1 1 2 3 " "polygons, segments of lines, points"

sed 's/$/\r/' "$T/plain.obj" >"$T/crlf.obj"
binds "$T/crlf.obj" >"$T/got"
check "CR LF: the same surface" cmp "$T/got" "$T/want"
sed 's/ 3\/1\/1/ \\\n3\/1\/1/; s/^v 9 1/v 9 \\\n 1/' "$T/plain.obj" >"$T/lines.obj"
binds "$T/lines.obj" >"$T/got"
check "continuation lines: the same surface" cmp "$T/got" "$T/want"
gzip -c "$T/plain.obj" >"$T/plain.obj.gz"
binds "$T/plain.obj.gz" >"$T/got"
check "gzip: the same surface" cmp "$T/got" "$T/want"
printf '%s' "$(cat "$T/plain.obj")" >"$T/short.obj"
binds "$T/short.obj" >"$T/got"
check "no line end at the end: the same surface" cmp "$T/got" "$T/want"

# refuse NAME LINE PATTERN: $T/bad.obj is refused there.
refuse() {
    rm -f "$T/out"
    fails 1 "refused: $1" "^bind: .*/bad\\.obj:$2: .*$3.*; expected " \
        sinew bind -q -o "$T/out" "$T/bad.obj" <"$T/model"
    [ -e "$T/out" ] && not_ok "no output: $1"
    [ "$(wc -l <"$T/stderr")" -eq 1 ] || not_ok "one line: $1"
}
# bad NAME LINE PATTERN TEXT: the text after a square's four vertices.
bad() {
    printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n%b' "$4" >"$T/bad.obj"
    refuse "$1" "$2" "$3"
}
bad "a face of two corners" 5 "a face of 2 corners" 'f 1 2\n'
bad "index 0" 6 "'0'" '\nf 1 2 0\n'
bad "an index past the end" 5 "vertex 5, but the file has 4" 'f 1 2 5\nf 3 4 1\n'
bad "a negative index before the start" 5 "vertex -5, but only 4" 'f -1 -2 -5\n'
bad "a normal that is not there" 5 "normal 1, but the file has 0" 'f 1//1 2//1 3//1\n'
bad "a face of mixed forms" 5 "'3/1'" 'f 1 2 3/1\n'
bad "a word for a number" 5 "'one'" 'v one 2 3\n'
bad "nan" 5 "'nan'" 'v 0 nan 3\n'
bad "inf" 5 "'-inf'" 'v 0 -inf 3\n'
bad "a number too large" 5 "'1e400'" 'v 0 1e400 3\n'
bad "a decimal comma" 5 "'0,5'" 'v 0,5 0 3\n'
bad "two numbers" 5 "a vertex of 2 numbers" 'v 0 1\n'
bad "an unknown statement" 7 "'vvv'" '# c\n\nvvv 1 2 3\n'
bad "a NUL byte" 5 "NUL" 'f 1 2 3\0000\n'
bad "a CR within a line" 5 "CR" 'f 1 2 3\rf 1 2 3\n'
bad "an error after continuations" 7 "'x'" 'f 1 \\\n2 \\\nx\n'
head -c 3000 /bin/ls >"$T/bad.obj"
fails 1 "refused: a program" "^bind: .*/bad\\.obj:[0-9]+: " sinew bind -q "$T/bad.obj" <"$T/model"
head -c 40 "$T/plain.obj.gz" >"$T/bad.obj"
fails 1 "refused: gzip cut short" "bad\\.obj: gzip" sinew bind -q "$T/bad.obj" <"$T/model"
: >"$T/bad.obj"
fails 1 "refused: an empty file" "bad\\.obj: no vertices; expected" sinew bind -q "$T/bad.obj" <"$T/model"
fails 1 "refused: no such file" "none\\.obj: cannot open: No such file" sinew bind -q "$T/none.obj" <"$T/model"
fails 1 "refused: a folder" "cannot (open|read)" sinew bind -q "$T" <"$T/model"
done_testing
