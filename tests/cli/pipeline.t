#!/bin/sh
# The whole way through real pipes: a failing stage, what passes through, the same bytes however the tools are joined; and
# the main job, a smile on the real face.
. "$(dirname "$0")/lib.sh"

# A box of two materials' worth of nothing: 4 x 2 x 2 voxels, a muscle through its length, one rigid end.
cat >"$T/box.obj" <<'OBJ'
# a comment that must stay
mtllib box.mtl
v 0 0 0
v 40 0 0
v 40 20 0
v 0 20 0
v 0 0 20
v 40 0 20
v 40 20 20
v 0 20 20
v 0 5 5
v 38 5 5
v 38 15 5
v 0 15 5
v 0 5 15
v 38 5 15
v 38 15 15
v 0 15 15
vt 0 0
vn 1 0 0
vn 0 0 1
usemtl flesh
g skull
f 1/1 5/1 8/1 4/1
g skin
f 2//1 3//1 7//1 6//1
f 1 4 3 2
f 5//2 6//2 7//2 8//2
f 1 2 6 5
f 3 4 8 7
g muscle_long
f 9 13 16 12
f 10 11 15 14
f 9 12 11 10
f 13 14 15 16
f 9 10 14 13
f 11 12 16 15
OBJ

V="voxelise -q --unit mm -s 10 $T/box.obj"
R="tled-run -q -c long=0.2 -n 40"
$V | attach -q | sinew bind -q | $R >"$T/piped"
is $? 0 "the pipeline runs"
$V >"$T/1" && attach -q <"$T/1" >"$T/2" && sinew bind -q <"$T/2" >"$T/3" && $R <"$T/3" >"$T/4"
check "A | B gives the same bytes as A > f; B < f" cmp "$T/piped" "$T/4"
$V --text | attach -q -z | sinew bind -q --text | $R >"$T/5"
check "and the encodings between the tools do not matter" cmp "$T/piped" "$T/5"
$V --threads 1 | attach -q | sinew bind -q --threads 3 | $R --threads 3 >"$T/6"
check "nor do the threads" cmp "$T/piped" "$T/6"
is "$(sinew info --get node.rigid.sum <"$T/piped")" 9 "the rigid end holds its 3 x 3 nodes"
sinew deform "$T/box.obj" <"$T/piped" >"$T/moved.obj"
is $? 0 "deform"
is "$(grep -cE '^v ' "$T/moved.obj")" 16 "all vertices are there"
grep -vE '^(v|vn) ' "$T/box.obj" >"$T/rest"
grep -vE '^(v|vn) ' "$T/moved.obj" >"$T/rest2"
check "every other line stays" cmp "$T/rest" "$T/rest2"
is "$(sed -n 3p "$T/moved.obj")" "v 0 0 0" "a vertex on the rigid end stays to the byte"
x=$(awk '$1 == "v" && ++n == 2 { print ($2 < 39.9) }' "$T/moved.obj")
is "$x" 1 "the free end moved toward the rigid one"

# What a tool does not know passes through.
$V --text >"$T/text"
{
    sed '/^end$/d' "$T/text"
    printf 'axis x-thing 2\narray x-mine f64 1 x-thing 2\n1 nan\n-0 0.1\narray node-colour u8 1 node 1\n'
    awk '$1 == "axis" && $2 == "node" { for (i = 0; i < $3; i++) print i % 256 }' "$T/text"
    echo end
} >"$T/with"
attach -q <"$T/with" | sinew bind -q | $R | sinew info --json >"$T/json"
is $? 0 "unknown arrays and axes are let through"
check "x-mine arrives" grep -q '"x-mine"' "$T/json"
check "node-colour arrives" grep -q '"node-colour"' "$T/json"

# One broken stage: one message, its own status at the end of any pipe.
(voxelise --unit mm -s 10 "$T/none.obj" | attach | sinew bind | tled-run -c long=0.2 -n 1 >"$T/out") 2>"$T/err"
is $? 1 "a missing OBJ ends the whole pipe with 1"
is "$(wc -l <"$T/err" | tr -d ' ')" 1 "with one message"
check "which is voxelise's" grep -q "^voxelise: .*none.obj: " "$T/err"
(voxelise --unit mm "$T/box.obj" | attach | sinew bind | tled-run -n 1 >"$T/out") 2>"$T/err"
is $? 2 "a usage error in the first stage ends the pipe with 2"
is "$(wc -l <"$T/err" | tr -d ' ')" 1 "with one message"
($V | attach -q --rigid nonesuch | sinew bind | tled-run -n 1 >"$T/out") 2>"$T/err"
is $? 2 "a failing middle stage: its status"
is "$(wc -l <"$T/err" | tr -d ' ')" 1 "and its message alone"
(voxelise --unit mm -s 10 "$T/none.obj" | attach -q | sinew deform "$T/box.obj" >"$T/out.obj") 2>"$T/err"
is $? 1 "a tool that writes no model ends with the status too"
is "$(wc -c <"$T/out.obj" | tr -d ' ')" 0 "and writes nothing"
(voxelise --unit mm -s 10 "$T/none.obj" | attach -q -o "$T/never") 2>/dev/null
[ ! -e "$T/never" ]
is $? 0 "-o leaves no file behind a failed stage"
$V | head -c 3000 >"$T/cut"
fails 1 "a stream that is cut is refused" "stdin: .*(cut|end)" sh -c "attach <'$T/cut'"
fails 1 "nothing on stdin" "no model on stdin .0 bytes.; if bash's builtin bind ran, write 'sinew bind'" attach

# The real face.
if [ -n "$DATA" ] && [ -f "$DATA/face/face_zyg.obj" ]; then
    F=$DATA/face/face_zyg.obj
    voxelise -q --unit mm -s 2.5 --origin -125,-125,-125 "$F" >"$T/face"
    is "$(sinew info --get axis.element <"$T/face")" 24316 "the elements of the real face"
    is "$(sinew info --get volume.count.muscle_zyg_xneg <"$T/face")" 60 "60 of them are muscle_zyg_xneg's own"
    voxelise -q --unit mm -s 2.5 "$F" | attach -q | sinew bind -q | tled-run -q -c zyg_xneg=0.4 -t 0.5 >"$T/smile"
    is $? 0 "a smile"
    sinew deform "$F" <"$T/smile" >"$T/smile.obj"
    is $? 0 "its OBJ"
    grep -vE '^v ' "$F" >"$T/a"
    grep -vE '^v ' "$T/smile.obj" >"$T/b"
    check "only its v lines differ" cmp "$T/a" "$T/b"
    # The muscle's tube runs from the cheekbone down to the mouth's corner: the end near the mouth moves up (z) and back (-y).
    paste -d' ' "$F" "$T/smile.obj" | awk -f "$ROOT/tests/cli/smile.awk" >"$T/figures"
    sed 's/^/# /' "$T/figures"
    is "$(grep -c '^mouth up and back$' "$T/figures")" 1 "the mouth's corner moved up and back"
    is "$(grep -c '^skull still$' "$T/figures")" 1 "the skull has not moved"
else
    skip 7 "no real face here"
fi
done_testing
