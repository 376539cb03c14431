#!/bin/sh
# voxelise --strain enclosed: moments of what surfaces enclose of voxels, and a tube under pressure by them (tled-run).
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

vox() {
    voxelise -q --text --unit mm "$@" >"$T/m" 2>"$T/said"
}
# rows ARRAY: of $T/m, a line each.
rows() {
    awk -v a="$1" '$1 == "array" { on = $2 == a; next } /^[a-z]/ { on = 0 } on' "$T/m"
}

# ---- moments

# A box from .25 to 2.5 in voxels of 1: of 4 samples a side 3 are inside, 4, and 2; means of places .25, 0 and -.5.
box skin 0.25 0.25 0.25 2.5 2.5 2.5 >"$T/box.obj"
vox -s 1 --origin 0,0,0 --fraction 4 "$T/box.obj"
is "$(grep -c '^array cut\.' "$T/m")" 0 "without it there are none"
cp "$T/m" "$T/default"
vox -s 1 --origin 0,0,0 --fraction 4 --strain centre "$T/box.obj"
is "$(grep -v '^prov' "$T/m" | cmp - "$T/default" 2>&1 | grep -c EOF)$(grep -v '^prov' "$T/default" >"$T/d" && grep -v '^prov' "$T/m" | cmp - "$T/d" && echo same)" \
    "0same" "--strain centre is what there is without"
for slits in on off; do
    vox -s 1 --origin 0,0,0 --fraction 4 --slits "$slits" --strain enclosed "$T/box.obj"
    is "$(rows cut.element | tr '\n' ' ')" "0 1 2 3 4 5 6 7 8 9 10 11 12 14 15 16 17 18 19 20 21 22 23 24 25 26 " \
        "slits $slits: elements that are enclosed in part, not the one in the middle"
    is "$(rows cut.moments | sed -n '1p;2p;14p;26p')" "0.25 0.25 0.25 0.0625 0.0625 0.0625 0.015625
0 0.25 0.25 0 0.0625 0 0
-0.5 0 0 0 0 0 0
-0.5 -0.5 -0.5 0.25 0.25 0.25 -0.125" "slits $slits: their means"
done
# A ball: an enclosed part has its middle inside of the ball; by threads the same bytes.
awk -v r=10 -v n=48 -f tests/cli/sphere.awk >"$T/ball.obj"
vox -s 2.5 --fraction 8 --strain enclosed --threads 1 "$T/ball.obj"
cp "$T/m" "$T/one"
vox -s 2.5 --fraction 8 --strain enclosed --threads 3 "$T/ball.obj"
check "the same bytes on three threads" cmp "$T/m" "$T/one"
# A slit through voxels: each part has its own moments.
{
    box skin 0 0 0 4 1.4 4
    box skin 0 1.6 0 4 3 4
} >"$T/plates.obj"
vox -s 1 --origin 0,0,0 --fraction 10 --strain enclosed "$T/plates.obj"
is "$(rows cut.moments | awk '{ printf "%.6g\n", $2 }' | sort -n | uniq -c | tr -s ' ' | tr '\n' ' ')" " 16 -0.6  16 0.6 " "two plates in one layer of voxels"
fails 2 "--strain without --fraction" "--strain is for --fraction" voxelise --unit mm -s 1 --strain enclosed "$T/box.obj"
fails 2 "--strain of another kind" "--strain 'middle'" voxelise --unit mm -s 1 --fraction 2 --strain middle "$T/box.obj"

# ---- a quarter of a tube, inner radius 11.3 mm, outer 20 mm, plane strain, E 3000 Pa, nu .3, under pressure (Lame)

awk -v h=1.25 'BEGIN {
    pi = atan2(0, -1); m = 128
    for (k = 0; k < 2; k++)
        for (j = 0; j < 2; j++)
            for (i = 0; i <= m; i++) {
                r = j ? 20 : 11.3; x = r * cos(pi / 2 * i / m); y = r * sin(pi / 2 * i / m)
                printf "v %.12g %.12g %.12g\n", i == m ? 0 : x, i ? y : 0, k * h
            }
    print "g skin_in"
    for (i = 1; i <= m; i++) { a = i; c = i + 2 * (m + 1); print "f", a, c, c + 1, a + 1 }
    print "g skin_out"
    for (i = 1; i <= m; i++) {
        a = i + m + 1; c = i + 3 * (m + 1); print "f", a, a + 1, c + 1, c
        print "f", i, i + 1, i + 1 + m + 1, i + m + 1
        print "f", i + 2 * (m + 1), i + 3 * (m + 1), i + 1 + 3 * (m + 1), i + 1 + 2 * (m + 1)
    }
    print "f", 1, m + 2, 3 * m + 4, 2 * m + 3
    print "f", m + 1, 3 * m + 3, 4 * m + 4, 2 * m + 2
}' >"$T/tube.obj"
echo "skin surfaces=skin_in,skin_out" >"$T/volumes"
echo "tissue E=3000 nu=0.3 density=1000" >"$T/materials"
# within X0 X1 Y0 Y1 Z0 Z1: a box about a plane.
within() {
    printf '%smm,%smm,%smm,%smm,%smm,%smm' "$1" "$3" "$5" "$2" "$4" "$6"
}
{
    echo "0 pressure tube:skin_in 3e-4"
    echo "0 displace $(within -1e-3 1e-3 -1 21 -1 2) 0,-,-"
    echo "0 displace $(within -1 21 -1e-3 1e-3 -1 2) -,0,-"
    echo "0 displace $(within -1 21 -1 21 -1 2) -,-,0"
} >"$T/script"
# error RULE: of the displacement of nodes in the tube at rest, in parts of it.
error() {
    voxelise -q --text --unit mm -s 1.25 --origin 0,0,0 --fraction 8 --strain "$1" --volumes "$T/volumes" --materials "$T/materials" \
        "$T/tube.obj" 2>"$T/said" | sinew bind -q >"$T/$1.model" 2>>"$T/said"
    tled-run --text --rest 1e-6 --script "$T/script" -o "$T/$1.out" <"$T/$1.model" 2>"$T/$1.log" || diag_file "$T/$1.log"
    awk '$1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" }
        on == "node.position" { x[n] = $1; y[n++] = $2 }
        on == "node.displacement" {
            r = sqrt(x[n] ^ 2 + y[n] ^ 2)
            if (r > .0113 && r < .02) {
                mu = 3000 / 2.6; c = 3e-4 * .0113 ^ 2 / (.02 ^ 2 - .0113 ^ 2)
                u = c * r / (2 * mu / .4) + c * .02 ^ 2 / (2 * mu * r)
                off += ($1 - u * x[n] / r) ^ 2 + ($2 - u * y[n] / r) ^ 2; all += u ^ 2
            }
            n++
        }
        END { printf "%.9g", all ? sqrt(off / all) : 1 }' "$T/$1.out"
}
by_mean=$(error enclosed)
by_share=$(error centre)
echo "# a tube of 16 voxels: out by $by_mean by the mean, $by_share by shares"
check "a tube under pressure, by the mean strain" awk -v e="$by_mean" 'BEGIN { exit !(e < 3e-3) }'
check "less than half of what it is by shares" awk -v e="$by_mean" -v s="$by_share" 'BEGIN { exit !(2 * e < s) }'
check "its stable step is .65 of that of whole voxels" grep -q "stable step 0.29" "$T/enclosed.log"
fails 1 "cut elements that are not in order" "cut.element, row 1 is 0 after 0" sh -c "sed '/^array cut.element/,/^[a-z]/s/^1\$/0/; /^crc/d' '$T/one' | tled-run"
# What else reads such models.
is "$(tled-run -q --text -n 3 -g 0,0,-9.81 <"$T/one" 2>"$T/said" | sinew results stress | sinew info --get frames)" 1 "results of frames"
is "$(msds-mesh --tets <"$T/one" 2>/dev/null | sinew info | grep -c 'cut\.')" 0 "tetrahedra have none"
done_testing
