#!/bin/sh
# Scripts of tled-run: what each line does to a small block, and what is refused.
. "$(dirname "$0")/lib.sh"

block() { # of 20 mm, 4 x 4 x 4 elements
    awk -v nx=4 -v ny=4 -v nz=4 -v h=0.005 "$@" -f tests/cli/block.awk
}
at() { # KEY of the model in $T/out: its columns
    sinew info --get "node.displacement.at.$1" <"$T/out"
}
run() { # SCRIPT [ARG...] on $T/model: the result in $T/out
    printf '%s' "$1" >"$T/script"
    shift
    tled-run -q --script "$T/script" "$@" <"$T/model" >"$T/out" 2>"$T/stderr" || diag_file "$T/stderr"
}
column() { # N "A B C"
    echo "$2" | cut -d ' ' -f "$1"
}

symmetry='0 displace 0,0,0,0,1,1 0,-,-
0 displace 0,0,0,1,0,1 -,0,-
0 displace 0,0,0,1,1,0 -,-,0
'
block -v held=none >"$T/model"
run "$symmetry"'0 displace 2cm,0,0,0.02,1,1 0,-,-
0.2 displace 2cm,0,0,20mm,1,1 4mm,-,- # to a stretch of 1.2
' --rest 1e-6
u=$(at 0.02,0.02,0.02)
near "$(column 1 "$u")" 0.004 1e-12 "a box is displaced as told"
near "$(echo "$u" | awk '{ printf "%.9g", 1 + $2 / 0.02 }')" 0.92181984 1e-5 "uniaxial stretch 1.2: lateral 0.92181984"
near "$(column 3 "$u")" "$(column 2 "$u")" 1e-9 "and the same across"

run "$symmetry"'0 displace 20mm,0,0,20mm,1,1 0,-,-
0 displace 0,20mm,0,1,20mm,1 -,0,-
0 displace 0,0,20mm,1,1,20mm -,-,0
0.1 displace 20mm,0,0,20mm,1,1 -2mm,-,-
' -t 0.15
near "$(column 1 "$(at 0.01,0.01,0.01)")" -0.001 1e-4 "confined to 0.9: the middle moves half as far"

block -v held=low >"$T/model"
run '0 displace skull* 0,0,0
0.05 displace SKULL* 1mm,2mm,-3mm
' --rest 1e-5
u=$(at 0.02,0.02,0.02)
near "$(column 1 "$u")" 0.001 1e-3 "a surface carries all the rest with it, x"
near "$(column 3 "$u")" -0.003 1e-3 "and z"
is "$(at 0,0,0)" "0.001 0.002 -0.003" "rigid nodes move as told"

run '0.05 displace skull_left 1mm,0,0
' -t 0.04
is "$(sinew info --get node.displacement.max <"$T/out")" 0 "before its first key nothing moves"

run '0 gravity 0,0,0
0.1 gravity 0,0,-9.81
'
u=$(at 0.02,0.02,0.02)
tled-run -q -g 0,0,-9.81 --ramp 0.1 <"$T/model" >"$T/out"
is "$(at 0.02,0.02,0.02)" "$u" "gravity in a script is -g with its ramp"

# 3 x 1.1 mm is more than 3.3 mm by a rounding: such nodes are on the box's face all the same.
awk -v nx=3 -v ny=3 -v nz=3 -v h=0.0011 -v held=none -f tests/cli/block.awk >"$T/model"
run '0 displace 0,0,0,3.3mm,3.3mm,3.3mm 0,0,0
0 force 0,0,0 3.3mm 0,0,0
' -n 1
is "$(tled-run --script "$T/script" -n 1 <"$T/model" 2>&1 >/dev/null | sed -n 's/.* \([0-9]*\) held.*/\1/p')" 64 \
    "a box holds the nodes on its faces, whatever the rounding"

# The momentum of a free block (text, $T/out): nodes weigh an eighth of 1000 kg/m3 x h^3 for each element that they are in.
momentum() { # COLUMN
    awk -v c="$1" '
        /^array node.velocity/ { on = 1; n = 0; next }
        on && /^[^-0-9]/ { on = 0 }
        on { i = n % 5; j = int(n / 5) % 5; k = int(n / 25); n++
             sum += $c * 0.000125 / 8 * (1 + (i > 0 && i < 4)) * (1 + (j > 0 && j < 4)) * (1 + (k > 0 && k < 4)) }
        END { printf "%.9g\n", sum }' "$T/out"
}
block -v held=none >"$T/model"
run '0 force 0.01,0.01,0.01 1 0.008,0,-0.002
' -t 0.1 --damping 0 --text
near "$(momentum 1)" 0.0008 1e-9 "a force of 8 mN on all nodes gives 0.8 mN s in 0.1 s"
near "$(momentum 3)" -0.0002 1e-9 "and so along z"
run '0 force 2cm,2cm,2cm 1mm 0,0,0
0.1 force 2cm,2cm,2cm 1mm 0.008,0,0
0.1 force 2cm,2cm,2cm 1mm 0.004,0,0
' -t 0.2 --damping 0 --text
near "$(momentum 1)" 0.0008 2e-3 "a ramp to 8 mN, a jump to 4 mN, then held: 0.4 + 0.4 mN s, on one node"
run '0.05 gravity 0,-2,0
' -t 0.1 --damping 0 --text
near "$(momentum 2)" -0.0008 1e-2 "gravity from 0.05 s on, all mass of 8 g: 0.05 s of 2 m/s2"

block -v held=low -v muscle=1 >"$T/model"
run '0 contract all 0
0.1 contract muscle_all 0.1
'
u=$(at 0.02,0.02,0.02)
tled-run -q -c all=0.1 <"$T/model" >"$T/out"
is "$(at 0.02,0.02,0.02)" "$u" "contract in a script is -c with its ramp"


# What is refused. A model that nothing changes; no output may be left.
block -v held=low -v muscle=1 >"$T/model"
# shellcheck disable=SC2317 # fails runs it
moved() { # ARG...
    tled-run "$@" <"$T/model"
}
refuse() { # PATTERN SCRIPT
    printf '%b' "$2" >"$T/bad.txt"
    rm -f "$T/left"
    fails 1 "refused: $(printf '%s' "$2" | cut -c 1-60)" "^tled-run: .*$1" \
        moved -q --script "$T/bad.txt" -o "$T/left"
    [ ! -e "$T/left" ] || not_ok "no output is left by it"
    [ "$(wc -l <"$T/stderr")" -eq 1 ] || not_ok "one message"
}
refuse 'bad.txt: nothing in it; expected lines TIME VERB' ''
refuse 'bad.txt:1: .gravity. is not a time; expected TIME VERB' 'gravity 0,0,0\n'
refuse "bad.txt:2: '-1' is not a time" '0 gravity 0,0,0\n-1 gravity 0,0,0\n'
refuse 'bad.txt:1: .nan. is not a time' 'nan gravity 0,0,0\n'
refuse "bad.txt:1: unknown verb 'gravty'; did you mean 'gravity'" '0 gravty 0,0,0\n'
refuse 'bad.txt:1: 5 words; expected TIME gravity X,Y,Z' '0 gravity 0 0 -9.81\n'
refuse "bad.txt:3: unknown muscle 'al'; did you mean 'all'\\? expected one of: all" '# a\n\n0 contract al 1\n'
refuse "bad.txt:1: level '2'; expected a number from 0 to 1" '0 contract all 2\n'
refuse 'bad.txt:1: .*no node lies within 0.001 m of 1,0,0; the nearest is 0.98 m away' '0 force 1,0,0 1mm 1,0,0\n'
refuse "bad.txt:1: unknown rigid surface 'skul_left'; did you mean 'skull_left'" '0 displace skul_left 0,0,0\n'
refuse "bad.txt:1: no node is held by 'skull_top'" '0 displace skull_top 0,0,0\n'
refuse 'bad.txt:2: time 0 s comes after 1 s for the same target' '1 contract all 0\n0 contract muscle_all 1\n'
refuse 'bad.txt:2: .*frees other components than line 1' '0 displace skull* 0,-,0\n1 displace skull* 0,0,0\n'
refuse 'bad.txt:2: component x of node 0 is displaced by line 1 too' \
    '0 displace skull* 0,-,-\n0 displace 0,0,0,0,0,0 1,-,-\n'
refuse 'bad.txt:1: a NUL byte in text' '0 gravity\0000,0,0\n'
refuse 'bad.txt:1: control character 0x01' '0 gravity \0001\n'
tled-run -t 0 <"$T/model" >"$T/binary" 2>/dev/null
fails 1 "a model for a script" 'binary:1: ' moved --script "$T/binary"
fails 1 "a script that is not there" "$T/none: .*No such file" moved --script "$T/none"
printf '0 contract all 0.1\n0 gravity 0,0,0\n' >"$T/both"
fails 2 "a muscle in the script and in -c" 'line 1 of the script too' \
    moved --script "$T/both" -c muscle_all=0.2
fails 2 "gravity in the script and in -g" 'line 2 of the script too' \
    moved --script "$T/both" -g 0,0,1

# What is read all the same.
printf '\357\273\277# a mark, CR LF, no last line end\r\n0 contract all 0\r\n0.1\tcontract  muscle_all 0.1' >"$T/odd"
gzip -c "$T/odd" >"$T/odd.gz"
tled-run -q --script "$T/odd" <"$T/model" >"$T/a" && tled-run -q --script "$T/odd.gz" <"$T/model" >"$T/out"
is "$(at 0.02,0.02,0.02)" "$u" "a script from another system, gzipped"
sed '/^array element.fibre/,/^array volume.name/{/^array volume.name/!d}' "$T/model" >"$T/plain"
mv "$T/plain" "$T/model"
fails 1 "a muscle without fibres" "^tled-run: $T/odd:2: muscle_all cannot contract: its elements .64. have no fibre" \
    moved --script "$T/odd" -t 0.01
printf '0 gravity 0,0,-1\n0 contract all 0\n1 contract all 0\n' >"$T/idle"
check "at a level of 0 it need have none" moved -q --script "$T/idle" -t 0.01 -o "$T/out"
is "$(cat "$T/stderr")" "" "and nothing is said of it"
# A second muscle, of the upper half; it alone has fibres.
awk '/^axis volume/ { $3 = 2 } /^array element.volume/ { print; for (n = 0; n < 64; n++) { getline; print (n >= 32) + 0 }
    print "array element.fibre f32 1 element 3"; for (n = 0; n < 64; n++) print (n >= 32) + 0, 0, 0; next }
    { print } /^"muscle_all"/ { print "\"muscle_up\"" } p ~ /^array volume\.(level|priority|material|muscle)/ { print } { p = $0 }' "$T/model" >"$T/two"
printf '0 contract up 0\n.01 contract up .1\n0 contract all 0\n.01 contract all .1\n' >"$T/half"
check "one of two muscles" sh -c "tled-run -q --script '$T/half' -t .01 -o '$T/out' <'$T/two'"
is "$(sed 's/; .*//' "$T/stderr")" "tled-run: warning: $T/half:3: muscle_all will not contract: its elements (32) have no fibre" \
    "is warned of with the script's line"
check "by -c" sh -c "tled-run -q -c up=.1,all=.1 -t .01 -o '$T/out' <'$T/two'"
is "$(sed 's/; .*//' "$T/stderr")" "tled-run: warning: -c: muscle_all will not contract: its elements (32) have no fibre" \
    "with the option"
done_testing
