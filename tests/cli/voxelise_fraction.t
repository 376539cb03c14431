#!/bin/sh
# voxelise --fraction: the share of each voxel that is enclosed.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

# total: of the shares.
total() {
    rows element.fraction | awk '{ sum += $1 } END { printf "%.9g", sum }'
}
get() {
    sinew info --get "$1" <"$T/m"
}

# A box from 0.25 to 2.5 in voxels of 1: shares of three quarters, 1 and a half along each axis.
box skin 0.25 0.25 0.25 2.5 2.5 2.5 >"$T/box.obj"
vox -s 1 --origin 0,0,0 --fraction 4 "$T/box.obj"
is "$(get axis.element) $(rows element.fraction | head -n 3 | tr '\n' ' ')" "27 0.421875 0.5625 0.28125 " "voxels that a box cuts"
is "$(total)" 11.390625 "together they are its volume"
vox -s 1 --origin 0,0,0 "$T/box.obj"
is "$(get axis.element) $(rows element.fraction)" "8 " "without it: by centres, and no shares"
vox -s 1 --origin 0,0,0 --fraction 4 --least 0.5 "$T/box.obj"
is "$(get axis.element) $(rows element.fraction | sort -n | head -n 1)" "10 0.5" "--least leaves out what is less"
vox -s 1 --origin 0,0,0 --fraction 4 --least 1 "$T/box.obj"
is "$(get axis.element)" 1 "only what is whole"
vox -s 1 --origin 0,0,0 --fraction 1 "$T/box.obj"
is "$(get axis.element) $(total)" "8 8" "one sample is the centre"
box skin 0.1 0.1 0.1 1.4 1.4 1.4 >"$T/near.obj"
vox -s 1 --origin 0,0,0 --fraction 10 "$T/near.obj"
is "$(get axis.element)" 8 "voxels whose centres are outside"
near "$(total)" 2.197 1e-6 "a voxel whose centre is outside of the surface's box"
vox -s 1 --origin 0,0,0 --box 0,0,0,1,1,1 --fraction 10 "$T/near.obj"
is "$(get axis.element)" 1 "one voxel"
near "$(total)" 0.729 1e-6 "--box still goes by centres"

# Who owns a voxel: the volume with most of it, the first of two.
{
    box skin 0 0 0 4 1 1
    box muscle_a 0 0 0 1.25 1 1
    box muscle_b 2.5 0 0 4 1 1
} >"$T/muscles.obj"
vox -s 1 --origin 0,0,0 --fraction 4 "$T/muscles.obj"
is "$(rows element.volume | tr '\n' ' ')$(rows element.fraction | sort -u)" "1 0 0 2 1" "the most, the first of two"

is "$(rows element.mix | tr '\n' ' ')$(rows element.mixture | tr '\n' ' ')" "-1 1 2 -1 0 0.25 0.5 0 " "the second, and its share"
is "$(cat "$T/said")" "voxelise: warning: nothing is rigid: no surface begins skull, bone or rigid" "quietly"
voxelise --text --unit mm -s 1 --origin 0,0,0 --fraction 4 "$T/muscles.obj" 2>"$T/said" >"$T/m"
is "$(awk '/^  (skin|muscle)/ { $1 = $1; print }' "$T/said")" "skin 0 tissue 2 0 0 176 31
muscle_a 1 tissue 1 1 0 0 100
muscle_b 1 tissue 1 1 0 0 100" "said of each, with the samples that others have"
vox -s 1 --origin 0,0,0 --fraction 4 "$T/box.obj"
is "$(grep -c 'element.mix' "$T/m")" 0 "no such arrays where nothing is mixed"
vox -s 1 --origin 0,0,0 "$T/muscles.obj"
is "$(grep -c 'element.mix' "$T/m")" 0 "nor by centres"
# Three volumes in a voxel, of which 2 tenths are outside: 4 tenths, 3 and 1.
{
    box skin 0 0 0 0.8 1 1
    box muscle_a 0 0 0 0.4 1 1
    box muscle_b 0.4 0 0 0.5 1 1
} >"$T/three.obj"
vox -s 1 --origin 0,0,0 --fraction 10 "$T/three.obj"
is "$(rows element.volume) $(rows element.mix) $(rows element.fraction)" "1 0 0.800000012" "three volumes: the two largest"
near "$(rows element.mixture)" 0.4285714 1e-6 "their shares are of what the two have"
# A muscle that has the most of no voxel.
{
    box skin 0 0 0 4 4 4
    box muscle_thin 1 1 1.1 3 3 1.4
} >"$T/thin.obj"
vox -s 1 --origin 0,0,0 --fraction 10 "$T/thin.obj"
is "$(grep -c "has no voxel" "$T/said") $(rows element.mix | grep -cx 1)" "0 4" "a muscle thinner than half a voxel has its share of some"
vox -s 1 --origin 0,0,0 --fraction 1 "$T/thin.obj"
is "$(grep -c "muscle_thin has no voxel" "$T/said")" 1 "one sample sees none of it"

# With layers, which are mixed as volumes are: what a muscle's voxel has beside it is the layer's that has most of that.
printf 'top thickness=1.2mm\n' >"$T/layers"
vox -s 1 --origin 0,0,0 --fraction 10 --layers "$T/layers" "$T/thin.obj"
is "$(awk '$1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" } on == "element.volume" { v[n++] = $1 }
    on == "element.mix" && $1 >= 0 { print v[n], $1 } on == "element.mix" { n++ }' "$T/m" | sort | uniq -c | tr -s ' ' | tr '\n' ' ')" " 4 0 1  4 0 2 " "the muscle's number is moved"
box skin 0 0 0 4 4 4 >"$T/thick.obj"
box muscle_thick 1 1 0.4 3 3 2.3 >>"$T/thick.obj"
vox -s 1 --origin 0,0,0 --fraction 10 --layers "$T/layers" "$T/thick.obj"
is "$(awk '$1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" } on == "element.volume" { v[n++] = $1 }
    on == "element.mix" && $1 >= 0 { print v[n], $1 } on == "element.mix" { n++ }' "$T/m" | sort | uniq -c | tr -s ' ' | tr '\n' ' ')" " 4 1 2  4 2 1 " "a layer's share of a muscle's voxels"
# Two muscles that share voxels with a little of the skin: layers take nothing of either.
{
    box skin 0 0 0 8 8 8
    box muscle_a 1 1 4 7 3.9 6
    box muscle_b 1 4.1 4 7 7 6
} >"$T/two_muscles.obj"
printf 'top thickness=0.5mm\n' >"$T/layers"
pairs() {
    awk '$1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" } on == "volume.name" { name[n++] = $1 }
        on == "element.volume" { v[n++] = $1 } on == "element.mix" { if ($1 >= 0) mix[n] = $1; n++ }
        END { for (i in mix) { a = name[v[i]]; b = name[mix[i]]; if (a > b) { c = a; a = b; b = c } if (a ~ /muscle/ && b ~ /muscle/) print a, b } }' "$T/m" | sort | uniq -c | tr -s ' ' | tr '\n' ' '
}
vox -s 2 --origin 0,1,0 --fraction 10 "$T/two_muscles.obj"
without=$(pairs)
is "$without" " 2 \"muscle_a\" \"muscle_b\" " "two muscles in a voxel"
vox -s 2 --origin 0,1,0 --fraction 10 --layers "$T/layers" "$T/two_muscles.obj"
is "$(pairs)" "$without" "and with layers too"

# What each volume has, of a ball in a ball: its shares come to it, where whole voxels do not.
awk -v r=100 -v n=96 -v g=skin -f tests/cli/sphere.awk >"$T/two.obj"
awk -v r=57 -v n=96 -v g=muscle_m -f tests/cli/sphere.awk | awk -v from="$((2 + 95 * 192))" '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } 1' >>"$T/two.obj"
inner=$(voxelise -v --check --unit mm "$T/two.obj" | awk '$1 == "volume" { on = $2 == "muscle_m" } $1 == "surface" { on = $2 == "muscle_m" } on && $1 == "encloses" && $2 > 0 { v = $2 } END { print v }')
for size in 25 12.5 6.25; do
    vox -s "$size" --fraction 8 --threads 3 "$T/two.obj"
    cp "$T/m" "$T/three"
    vox -s "$size" --fraction 8 --threads 1 "$T/two.obj"
    check "mixed: the same bytes on three threads" cmp "$T/m" "$T/three"
    sums=$(awk -v s="$size" '$1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" } on == "element.volume" { v[n++] = $1 }
        on == "element.fraction" { f[n++] = $1 } on == "element.mix" { m[n++] = $1 }
        on == "element.mixture" { x = f[n]; own += v[n] * x; all += v[n] ? x * (1 - $1) : m[n] == 1 ? x * $1 : 0; n++ }
        END { printf "%.9g %.9g", all * s ^ 3, own * s ^ 3 }' "$T/m")
    near "${sums% *}" "$inner" 0.005 "the inner ball's shares, voxels of $size mm"
    echo "# voxels of $size mm: $(awk -v a="${sums% *}" -v b="${sums#* }" -v c="$inner" 'BEGIN { printf "%.3g %% by shares, %.3g by whole elements", 100 * (a / c - 1), 100 * (b / c - 1) }')"
done

# The volume of a ball: shares are nearer than centres by far.
awk -v r=100 -v n=96 -f tests/cli/sphere.awk >"$T/ball.obj"
true_volume=$(voxelise -v --check --unit mm "$T/ball.obj" | awk '$1 == "encloses" { print $2; exit }')
for size in 25 12.5 6.25; do
    vox -s "$size" --fraction 8 --threads 1 "$T/ball.obj"
    cp "$T/m" "$T/one"
    near "$(awk -v t="$(total)" -v s="$size" 'BEGIN { printf "%.9g", t * s ^ 3 }')" "$true_volume" 0.0015 \
        "a ball, voxels of $size mm"
    vox -s "$size" --fraction 8 --threads 3 "$T/ball.obj"
    check "the same bytes on three threads" cmp "$T/m" "$T/one"
done
is "$(sinew info <"$T/m" | sed -n 's/^  voxelise [0-9.]* //p')" "--unit mm -s 6.25 --fraction 8 ball.obj" "provenance"
fails 2 "no samples" "--fraction '0': expected a whole number from 1" voxelise --unit mm -s 1 --fraction 0 "$T/box.obj"
fails 2 "--least without --fraction" "--least is for --fraction" voxelise --unit mm -s 1 --least 0.5 "$T/box.obj"
fails 2 "--least past 1" "--least '1.5'" voxelise --unit mm -s 1 --fraction 2 --least 1.5 "$T/box.obj"
for option in "--fraction 4" "--box 0,0,0,1,1,1" "--origin 0,0,0"; do
    # shellcheck disable=SC2086 # an option and its value
    fails 2 "--check with $option" "--check looks at surfaces and makes no voxels" voxelise --check --unit mm $option "$T/box.obj"
done
fails 1 "nothing is enough" "no voxel has enough of it inside" voxelise --unit mm -s 10 --origin 0,0,0 --fraction 4 --least 0.5 "$T/box.obj"
# With attach: what it holds by centres it holds by shares too, and nothing hangs loose.
# held FILE: the lattice places of the model's rigid nodes. parts: of $T/m, how many parts faces join.
held() {
    awk '$1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" } on == "node.lattice" { place[n++] = $0 }
        on == "node.rigid" && $1 { print place[n] } on == "node.rigid" { n++ }' "$1" | sort
}
parts() {
    rows element.lattice | awk '
        function root(a) { while (up[a] != a) a = up[a] = up[up[a]]; return a }
        { up[NR] = NR; cell[$1, $2, $3] = NR; x[NR] = $1; y[NR] = $2; z[NR] = $3 }
        END {
            for (n = 1; n <= NR; n++) {
                if ((x[n] - 1, y[n], z[n]) in cell) up[root(n)] = root(cell[x[n] - 1, y[n], z[n]])
                if ((x[n], y[n] - 1, z[n]) in cell) up[root(n)] = root(cell[x[n], y[n] - 1, z[n]])
                if ((x[n], y[n], z[n] - 1) in cell) up[root(n)] = root(cell[x[n], y[n], z[n] - 1])
            }
            for (n = 1; n <= NR; n++) count += up[n] == n
            print count
        }'
}
# held_too NAME SIZE OBJ: attach holds with shares what it holds without, and nothing is loose.
held_too() {
    vox -s "$2" "$3"
    attach -q --text <"$T/m" >"$T/centres"
    vox -s "$2" --fraction 8 "$3"
    attach -q --text <"$T/m" >"$T/shares"
    held "$T/centres" >"$T/held"
    check "$1: nodes are held" test "$(wc -l <"$T/held")" -gt 100
    is "$(held "$T/shares" | comm -23 "$T/held" -)" "" "$1: with shares too"
    is "$(parts)" 1 "$1: by shares it is in one piece"
}
awk -v r=100 -v n=96 -v g=skin -f tests/cli/sphere.awk >"$T/ball.obj"
{
    cat "$T/ball.obj"
    awk -v r=50 -v n=48 -v g=skull -f tests/cli/sphere.awk |
        awk -v from="$((2 + 95 * 192))" '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } 1'
} >"$T/core.obj"
held_too "a ball about a core" 12.5 "$T/core.obj"
if [ -n "$DATA" ]; then
    held_too "the real face" 5 "$DATA/face/face_zyg.obj"
else
    skip 3 "no real face"
fi

# A plate within the ball holds its own nodes, and of cut voxels no more.
printf 'g rigid\nv -200 -200 0\nv 200 -200 0\nv 200 200 0\nv -200 200 0\nf 1 2 3 4\n' >"$T/plate.obj"
vox -s 12.5 --fraction 8 "$T/ball.obj"
attach -q --text --rigid-file "$T/plate.obj" <"$T/m" >"$T/shares"
is "$(held "$T/shares" | awk '{ print $3 }' | sort -u)" 8 "a plate in its middle"
done_testing
