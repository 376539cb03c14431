#!/bin/sh
# Pressure and traction of scripts of tled-run, against closed forms: a cube in a fluid, columns and bars of the law's stresses, a stiff
# block that a pressure on half a side spins; the same bytes by every executor of the processor; energies, steps; what is refused.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

# block NX NY NZ H N [skip=SIDE]: a block from the origin, its surface bound: `shell`, n x n squares a side.
block() {
    shell "$@" >"$T/shell.obj"
    awk -v nx="$1" -v ny="$2" -v nz="$3" -v h="$4" -f tests/cli/block.awk >"$T/mesh"
    grep -v '^meta lattice' "$T/mesh" | sinew bind -q --unit mm "$T/shell.obj" >"$T/bound_mesh"
    voxelise -q --unit mm -s "$(awk -v h="$4" 'BEGIN { print 1000 * h }')" --origin 0,0,0 --allow-open "$T/shell.obj" 2>"$T/said" |
        sinew bind -q >"$T/bound"
}
shell() { # as block
    awk -v x="$(awk -v n="$1" -v h="$4" 'BEGIN { print 1000 * n * h }')" -v y="$(awk -v n="$2" -v h="$4" 'BEGIN { print 1000 * n * h }')" \
        -v z="$(awk -v n="$3" -v h="$4" 'BEGIN { print 1000 * n * h }')" -v n="$5" -v "${6:-turn=0}" -f tests/cli/shell.awk
}
at() { # KEY of the model in $T/out: its columns
    sinew info --get "node.displacement.at.$1" <"$T/out"
}
column() { # N "A B C"
    echo "$2" | cut -d ' ' -f "$1"
}
tissue='-m tissue.E=3000 -m tissue.nu=0.45'
run() { # MODEL SCRIPT [ARG...]: the result in $T/out
    model=$1
    printf '%s' "$2" >"$T/script"
    shift 2
    # shellcheck disable=SC2086 # options are words
    tled-run -q -d cpu --script "$T/script" $tissue "$@" <"$T/$model" >"$T/out" 2>"$T/stderr" || diag_file "$T/stderr"
}
# The momentum along column C of blocks of cubes that weigh M kg a node's share (text, $T/out), of NX x NY x NZ nodes.
momentum() { # C M NX NY NZ
    awk -v c="$1" -v m="$2" -v nx="$3" -v ny="$4" -v nz="$5" '
        /^array node.lattice/ { on = 2; n = 0; next }
        /^array node.velocity/ { on = 1; n = 0; next }
        on && /^[^-0-9]/ { on = 0 }
        on == 2 { i[n] = $1; j[n] = $2; k[n] = $3; n++ }
        on == 1 { sum += $c * m * (1 + (i[n] > 0 && i[n] < nx - 1)) * (1 + (j[n] > 0 && j[n] < ny - 1)) * (1 + (k[n] > 0 && k[n] < nz - 1)); n++ }
        END { printf "%.12g\n", sum }' "$T/out"
}
symmetry='0 displace -1,-1,-1,0,1,1 0,-,-
0 displace -1,-1,-1,1,0,1 -,0,-
0 displace -1,-1,-1,1,1,0 -,-,0
'

# A cube in a fluid: p = K (1 - J), whatever the shear modulus.
block 4 4 4 0.005 4
for model in bound bound_mesh; do
    run $model '0 pressure shell 0
0.1 pressure shell 500
' --rest 1e-7 --log "$T/log"
    want=$(awk 'BEGIN { printf "%.12g", .01 * (1 - .95 ^ (1 / 3)) }')
    near "$(column 1 "$(at 0,0,0)")" "$want" 1e-6 "$model: a cube in a fluid of 500 Pa: J = .95"
    near "$(column 2 "$(at 0.02,0.02,0.02)")" "-$want" 1e-6 "and so at the corner across"
    near "$(column 3 "$(at 0.01,0.01,0.01)")" 0 1e-12 "it goes nowhere"
    near "$(column 2 "$(at 0.02,0.01,0.02)")" 0 1e-10 "nor turns"
    near "$(awk -F '\t' 'END { print $11 }' "$T/log")" 0 2e-7 "$model: energies balance"
    near "$(awk -F '\t' 'END { print $6 + $7 }' "$T/log")" "$(awk 'BEGIN { print 5000 * .05 ^ 2 * 8e-6 }')" 1e-4 \
        "and what it holds is K/2 (J - 1)^2 V"
done
is "$(sed -n 1p "$T/stderr" | grep -c 'nothing holds the model')" 1 "a closed surface's pressure is in balance: held or not, it comes to rest"

# The same of squares that nobody has cut, each corner of which gets a quarter, and on one side of triangles.
shell 4 4 4 0.005 4 quads=1 >"$T/squares.obj"
sinew bind -q --unit mm "$T/squares.obj" <"$T/bound" >"$T/two"
run two '0 pressure squares 0
0.1 pressure squares 500
' --rest 1e-7
near "$(column 1 "$(at 0,0,0)")" "$want" 1e-6 "of squares: J = .95"
near "$(column 3 "$(at 0.02,0.02,0.02)")" "-$want" 1e-6 "and so at the corner across"
run two "$symmetry"'0 traction squares:x1 502.2590,0,0
' --rest 1e-7
near "$(column 1 "$(at 0.02,0.02,0.02)")" 0.004 1e-5 "and a traction on them pulls it to 1.2"

# Columns and bars.
confined='0 displace -1,-1,-1,0,1,1 0,-,-
0 displace 0.02,-1,-1,1,1,1 0,-,-
0 displace -1,-1,-1,1,0,1 -,0,-
0 displace -1,0.02,-1,1,1,1 -,0,-
0 displace -1,-1,-1,1,1,0 -,-,0
'
run bound "$confined"'0 pressure shell:z1 1156.1882
' --rest 1e-7
near "$(column 3 "$(at 0.01,0.01,0.02)")" -0.002 1e-5 "confined, its top pressed by 1156.1882 Pa: .9"
run bound "$confined"'0 pressure SHELL:0,0,20mm,2cm,2cm,2cm 1156.1882
' --rest 1e-7
near "$(column 3 "$(at 0.01,0.01,0.02)")" -0.002 1e-5 "and by a box about it"
# slab X0 X1 Z0 Z1 [COUNT]: a box as OBJ, 0 to 2 along y, the first COUNT of its sides.
slab() {
    printf 'v %s\n' "$1 0 $3" "$2 0 $3" "$2 2 $3" "$1 2 $3" "$1 0 $4" "$2 0 $4" "$2 2 $4" "$1 2 $4"
    printf 'f %s\n' '4 3 2 1' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8' | head -n "${5:-6}"
}
slab 0 2 1.9 2 | gzip >"$T/top.obj.gz"
run bound "$confined""0 pressure shell:$T/top.obj.gz 1156.1882
" --rest 1e-7 --unit cm
near "$(column 3 "$(at 0.01,0.01,0.02)")" -0.002 1e-5 "and by what lies inside of an OBJ, or on it"
run bound "$symmetry"'0 traction shell:x1 502.2590,0,0
' --rest 1e-7
near "$(column 1 "$(at 0.02,0.02,0.02)")" 0.004 1e-5 "a traction of 502.2590 Pa, by the area at rest, pulls it to 1.2"
run bound "$symmetry"'0 pressure shell:x* 100
0 pressure shell:x1 -691.064
' --rest 1e-7
u=$(at 0.02,0.02,0.02)
near "$(column 1 "$u")" 0.004 1e-4 "a suction does by the area now: 502.2590 / .92181984^2 = 591.064 Pa, less what another curve adds"
near "$(awk -v u="$(column 2 "$u")" 'BEGIN { print 1 + u / .02 }')" 0.92181984 1e-5 "and its sides"

# Momenta: of a free block, 8 g.
run bound '0 pressure shell:y1 0.01
' -t 0.01 --damping 0 --text
near "$(momentum 2 1.5625e-5 5 5 5)" -4e-8 1e-5 "10 mPa on 4 cm2 for 10 ms: 4e-8 N s"
near "$(momentum 1 1.5625e-5 5 5 5)" 0 1e-18 "along the normal alone"
run bound '0 traction shell:y1 3,-20,1
' -t 0.1 --damping 0 --text
momentum 2 1.5625e-5 5 5 5 >"$T/momentum"
near "$(cat "$T/momentum")" -8e-4 1e-9 "a traction of -20 Pa on 4 cm2 for .1 s: as a force of -8 mN"
run bound '0 force 1cm,2cm,1cm 0.0142 0.0012,-0.008,0.0004
' -t 0.1 --damping 0 --text
near "$(momentum 2 1.5625e-5 5 5 5)" "$(cat "$T/momentum")" 1e-9 "and the force does the same"

# A stiff block that floats, pressed on the upper half of one side, spins as a rigid body does, and its push with it: with alpha =
# F 5 mm / I (of lumped masses: 1 + 2 / 4^2 times a solid's), momenta are the integrals of F cos and F sin of alpha t^2 / 2.
printf '%s' '0 pressure shell:20mm,0,10mm,20mm,20mm,20mm 1000
' >"$T/script"
tled-run -q -d cpu --text --script "$T/script" -m tissue.E=2e6 -m tissue.nu=0.3 --damping 0 -t 0.045 <"$T/bound" >"$T/out" 2>"$T/stderr"
awk 'BEGIN { f = .2; alpha = f * .005 / (.008 * .0008 / 12 * 1.125); n = 10000; h = .045 / n
    for (i = 0; i < n; i++) { a = alpha * ((i + .5) * h) ^ 2 / 2; x -= f * cos(a) * h; z += f * sin(a) * h }
    print x, -z, a }' >"$T/want"
read -r x z angle <"$T/want"
near "$(momentum 1 1.5625e-5 5 5 5)" "$x" 5e-3 "a block that spins ($angle): its push along x"
near "$(momentum 3 1.5625e-5 5 5 5)" "$z" 5e-3 "and along z, as it turns"

# The same bytes.
for model in bound bound_mesh; do
    for precision in double single; do
        first=
        for set in plain AVX2 AVX-512; do
            for threads in 1 2 3; do
                SINEW_VECTORS=$set run $model "$confined"'0 pressure shell:z1 0
0.02 pressure shell:z1 2000
0.01 pressure shell -500
0 traction shell:x0 5,0,-20
' -t 0.02 --text --precision $precision --threads $threads
                if grep -q SINEW_VECTORS "$T/stderr"; then
                    skip 1 "$set: this processor cannot"
                    continue
                fi
                sum=$(sed -n '/^frame/,$p' "$T/out" | cksum)
                is "$sum" "${first:=$sum}" "$model, $precision, $set, $threads threads: the same bytes"
            done
        done
    done
done
ramp='0 pressure shell:z1 0
0.1 pressure shell:z1 1000
'
run bound "$confined$ramp" -t 0.1 --text
sed -n '/^array node.disp/,$p' "$T/out" >"$T/whole"
run bound "$confined$ramp" -t 0.05
# shellcheck disable=SC2086 # options are words
tled-run -q -d cpu --text --script "$T/script" -t 0.05 <"$T/out" 2>"$T/stderr" | awk '/^frame 1/ { on = 1 } on' | sed -n '/^array node.disp/,$p' >"$T/parts"
check "in two parts: the same bytes" cmp "$T/whole" "$T/parts"

# Energies balance where the pressed nodes are moved too, and with a probe.
cat >"$T/moved" <<'END'
0 displace -1,-1,-1,1,1,0 0,0,0
0.1 displace -1,-1,-1,1,1,0 1mm,-0.5mm,2mm
0 pressure shell 0
0.1 pressure shell 300
0 pressure shell:z1 0
0.05 pressure shell:z1 -200
0 traction shell:x1 0,10,0
END
printf '0 .01 .01 .024 1 0 0 0\n.1 .01 .01 .020 1 0 0 0\n' >"$T/poses"
tled-run -q -d cpu --script "$T/moved" -t 0.15 --log "$T/log" --log-every 0.00025 -m tissue.E=3000 -m tissue.nu=0.45 \
    --probe sphere:8mm --poses "$T/poses" <"$T/bound" >"$T/out" 2>"$T/stderr"
awk -F '\t' 'END { print $9, $12, $14 }' "$T/log" >"$T/work"
is "$(awk '{ print ($1 > 1e-4 && $2 * $2 > 1e-14 && $3 < 1e-4 * $1 && $3 > -1e-4 * $1) }' "$T/work")" 1 \
    "energies balance: work of pressures, of the probe, and what is left over: $(cat "$T/work") J"

# The stable step: less where a pressure is large, and a step that is too long is refused.
step() { # SCRIPT: the stable step at rest, ms
    printf '%s' "$1" >"$T/script"
    # shellcheck disable=SC2086 # options are words
    tled-run -d cpu --script "$T/script" $tissue -n 1 -o /dev/null <"$T/bound" 2>&1 | sed -n 's/.*stable step \([^ ]*\) ms.*/\1/p'
}
plain=$(step '0 gravity 0,0,0
')
pressed=$(step '0 pressure shell 0
0.1 pressure shell 1000
')
is "$(awk -v a="$plain" -v b="$pressed" 'BEGIN { print (b < a && b > .8 * a) }')" 1 "1000 Pa: a stable step of $pressed ms, $plain without"
is "$(step '0 pressure shell -1000
')" "$pressed" "and likewise of -1000 Pa"
fails 1 "a longer step" 'is above the stable step; expected at most' \
    tled-run -q -d cpu --script "$T/script" -m tissue.E=3000 -m tissue.nu=0.45 --dt "$(awk -v a="$plain" 'BEGIN { print a / 1001 }')" -n 1 <"$T/bound"

# A card that cannot says what it lacks; auto takes the processor.
fails 1 "no pressure on CUDA" 'the CUDA back end has no pressure on a surface; expected -d cpu or auto|this build has no CUDA back end; have: cpu' \
    tled-run -d cuda --script "$T/script" -n 1 <"$T/bound"
check "auto" tled-run -d auto --script "$T/script" -n 1 -o /dev/null <"$T/bound"
is "$(grep -c 'cpu (the one with pressure on a surface' "$T/stderr")" 1 "takes the processor, and says why"

# Triangles that are larger than elements: their load is at few nodes.
shell 4 4 4 0.005 1 >"$T/coarse.obj"
sinew bind -q --unit mm "$T/coarse.obj" <"$T/bound" >"$T/two"
printf '0 traction coarse:x1 1,0,0\n0 traction shell 1,0,0\n' >"$T/script"
check "large triangles" tled-run -q -d cpu --script "$T/script" -n 1 -o /dev/null <"$T/two"
is "$(grep -c "script:1: triangles of 'coarse' are up to 20 mm wide, elements 5 mm: the load acts at their corners alone" "$T/stderr") \
$(grep -c "triangles of" "$T/stderr")" "1 1" "are warned of, and they alone"

# A run continues only with the script that it began with.
printf '0 pressure shell:z1 1\n' >"$T/one"
(ulimit -f 160 && tled-run -q -d cpu --script "$T/one" -t 0.2 --every 0.01 --checkpoint "$T/state" -o "$T/cut" <"$T/bound" 2>"$T/said")
check "an interrupted run goes on" tled-run -q -d cpu --script "$T/one" -t 0.2 --every 0.01 --restart "$T/state" -o "$T/cut" <"$T/bound"
tled-run -q -d cpu --script "$T/one" -t 0.2 --every 0.01 -o "$T/whole" <"$T/bound" 2>"$T/said"
check "to the same bytes" cmp "$T/whole" "$T/cut"
(ulimit -f 160 && tled-run -q -d cpu --script "$T/one" -t 0.2 --every 0.01 --checkpoint "$T/state" -o "$T/cut" <"$T/bound" 2>"$T/said")
cp "$T/one" "$T/kept"
echo '0 pressure shell:z0 1' >"$T/one"
fails 1 "not with another group" 'belongs to another run: script differs' \
    tled-run -q -d cpu --script "$T/one" -t 0.2 --every 0.01 --restart "$T/state" -o "$T/cut" <"$T/bound"

cp "$T/kept" "$T/one"

# A load on a part that nothing holds.
fails 1 "a region's pressure on what nothing holds" 'nothing holds the model: no node is rigid or displaced, so that it never comes to rest' \
    tled-run -q -d cpu --script "$T/one" --rest 1e-4 <"$T/bound"

# What is refused.
shell 4 4 4 0.005 4 skip=z1 >"$T/open.obj"
sinew bind -q --unit mm "$T/open.obj" <"$T/bound" >"$T/both"
refuse() { # PATTERN SCRIPT [MODEL]
    printf '%b' "$2" >"$T/bad.txt"
    rm -f "$T/left"
    fails 1 "refused: $(printf '%s' "$2" | cut -c 1-60)" "^tled-run: .*$1" \
        tled-run -q --script "$T/bad.txt" -o "$T/left" <"$T/${3:-both}"
    [ ! -e "$T/left" ] || not_ok "no output is left by it"
    [ "$(wc -l <"$T/stderr")" -eq 1 ] || not_ok "one message"
}
refuse 'bad.txt:1: 3 words; expected TIME pressure SURFACE\[:GROUP|:X0,Y0,Z0,X1,Y1,Z1|:FILE.obj\] PA' '0 pressure shell\n'
refuse "bad.txt:2: pressure '1kPa'; expected a number in Pa" '# a\n0 pressure shell 1kPa\n'
refuse "bad.txt:1: pressure 'inf'; expected a number in Pa" '0 pressure shell inf\n'
refuse "bad.txt:1: '5'; expected X,Y,Z in Pa" '0 traction shell 5\n'
refuse "bad.txt:1: unknown bound surface 'shel'; did you mean 'shell'\\? expected one of: shell, open" '0 pressure shel 5\n'
refuse "bad.txt:1: unknown group of polygons 'z2'; did you mean .* expected one of: x0, x1, y0" '0 pressure shell:z2 5\n'
refuse "bad.txt:1: unknown group of polygons ''; expected one of: x0" '0 pressure shell: 5\n'
refuse "bad.txt:1: no triangle of 'shell' lies in the box 1,1,1,2,2,2; expected X0,Y0,Z0,X1,Y1,Z1 around some" '0 traction shell:1,1,1,2,2,2 0,0,5\n'
refuse "bad.txt:1: '1,1,1'; expected X0,Y0,Z0,X1,Y1,Z1: a box" '0 pressure shell:1,1,1 5\n'
refuse 'bad.txt:1: box 2,0,0,1,1,1 is empty: 2 > 1; expected the low corner first' '0 pressure shell:2,0,0,1,1,1 5\n'
refuse "bad.txt:1: surface 'open' is not closed: 16 open edges, the first at [0-9.]*mm,[0-9.]*mm,20mm; expected each edge between two triangles" '0 pressure open 5\n'
slab 0 20 19 20 5 >"$T/hole.obj"
slab 50 60 19 20 >"$T/far.obj"
slab 0 20 19 20 0 >"$T/bare.obj"
echo 'f 1 2 3' >"$T/broken.obj"
refuse 'bad.txt:1: .*none.obj: cannot open: No such file' "0 pressure shell:$T/none.obj 5\\n"
refuse 'bad.txt:1: .*broken.obj:1: vertex 1, but the file has 0' "0 pressure shell:$T/broken.obj 5\\n"
refuse 'bad.txt:1: .*bare.obj has no polygons; expected a closed surface' "0 pressure shell:$T/bare.obj 5\\n"
refuse 'bad.txt:1: .*hole.obj is not closed: 4 open edges, the first at [0-9.]*mm,[0-9.]*mm,[0-9.]*mm; expected each edge between two triangles' "0 traction shell:$T/hole.obj 0,0,5\\n"
refuse "bad.txt:1: no triangle of 'shell' lies inside of .*far.obj; expected a closed surface around some" "0 pressure shell:$T/far.obj 5\\n"
printf '0 pressure shell:%s 5\n' "$T/far.obj" >"$T/bad.txt"
fails 2 "a unit that is none" "^tled-run: --unit 'pc': expected um, mm, cm, m or in" tled-run -q --unit pc --script "$T/bad.txt" -n 1 <"$T/both"
refuse 'bad.txt:2: time 0 s comes after 1 s for the same target' '1 pressure shell:Z1 5\n0 pressure SHELL:z1 6\n'
voxelise -q --unit mm -s 5 --origin 0,0,0 "$T/shell.obj" >"$T/unbound" 2>"$T/said"
refuse "bad.txt:1: surface 'shell' is not bound; expected one that sinew bind put into the model" '0 pressure shell 5\n' unbound
refuse "bad.txt:1: 'shell': the model has no bound surface; expected one from sinew bind" '0 pressure shell 5\n' mesh
printf '0 pressure open:* 5\n0 traction open 1,0,0\n' >"$T/script"
check "an open surface's region need not be closed, nor what a traction pulls" \
    tled-run -q -d cpu --script "$T/script" -n 1 -o /dev/null <"$T/both"
done_testing
