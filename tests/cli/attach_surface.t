#!/bin/sh
# attach --surface: bone holds the tissue by films at its surface (tled-run): Lame's solutions about rigid cores, a thin sheet on a
# sphere, bone that moves, energies, bytes, and what is refused.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh
. tests/cli/hollow.sh

get() { # KEY FILE
    sinew info --get "$1" <"$2"
}

# ---- what is written: an eighth of a hollow sphere whose inner surface is bone

echo "skin surfaces=skin_out,skull_in" >"$T/volumes"
echo "tissue E=3000 nu=0.45 density=1000" >"$T/materials"
# core SHAPE H [VOXELISE...]: $T/voxels. triangles: of balls, along the side of a voxel.
triangles=1
core() {
    core_shape=$1 core_size=$2
    shift 2
    core_triangles=$core_size
    [ "$core_shape" = tube ] || core_triangles=$(awk -v h="$core_size" -v n="$triangles" 'BEGIN { print h / n }')
    "$core_shape" "$core_triangles" | sed 's/^g skin_in/g skull_in/' >"$T/$core_shape.obj"
    voxelise -q --unit mm -s "$core_size" --origin 0,0,0 "$@" --volumes "$T/volumes" --materials "$T/materials" "$T/$core_shape.obj" \
        >"$T/voxels" 2>"$T/said" || diag_file "$T/said"
}
core ball 1.25 --fraction 8 --strain enclosed
attach -q <"$T/voxels" >"$T/paper"
attach -q --surface <"$T/voxels" >"$T/held"
is "$(get node.rigid.sum "$T/paper") $(get node.rigid.sum "$T/held")" "352 0" "no node is rigid"
near "$(get bone.area.sum "$T/held")" 2.1182e-4 .01 "the films' area is that of a sphere in their middle"
near "$(get film.share.sum "$T/held")" 67.799 .01 "and their volume that of the shell"
near "$(get bone.depth.max "$T/held")" .000625 1e-12 "all are half a voxel thick"
near "$(get bone.depth.min "$T/held")" .000625 1e-12 "and none is less"
attach -q --surface <"$T/held" >"$T/twice"
is "$(get axis.bone "$T/twice") $(get film.share.sum "$T/twice")" "$(get axis.bone "$T/held") $(get film.share.sum "$T/held")" "a second time replaces them"
attach -q <"$T/held" >"$T/none"
is "$(msds-mesh <"$T/held" 2>"$T/said" | sinew info | grep -c 'element.node\|bone\|film')" 1 "and tetrahedra have none"
fails 1 "and without --surface they go" "no key" sinew info --get axis.bone "$T/none"
attach -q --surface --text <"$T/voxels" >"$T/text"
check "text and binary are twins" sinew diff "$T/held" "$T/text"

# A plate of one face that is far larger than the tissue, whose middle is far from that; and a line, which holds nothing.
printf 'g rigid\nv -9000 -9000 15.1\nv 9000 -9000 15.1\nv 9000 9000 15.1\nv -9000 9000 15.1\nf 1 2 3 4\n' >"$T/plate.obj"
attach -q --surface --rigid-file "$T/plate.obj" <"$T/voxels" >"$T/plate"
area=$(awk -v a="$(get bone.area.sum "$T/plate")" -v b="$(get bone.area.sum "$T/held")" 'BEGIN { printf "%.6g", a - b }')
check "a face that is far larger than the tissue has films on both sides ($area m2)" awk -v a="$area" 'BEGIN { exit !(a > 2.7e-4 && a < 4e-4) }'
printf 'g rigid\nv 12 1 1\nv 19 1 1\nl 1 2\n' >"$T/line.obj"
attach -q --surface --rigid-file "$T/line.obj" <"$T/voxels" 2>"$T/said" >"$T/plate"
check "a line holds nothing, which is told" grep -q "rigid holds nothing by --surface: it has no faces with tissue beside them" "$T/said"

# ---- under pressure (Lame): cores of 11.3 mm in tubes and spheres of 20 mm

# error SHAPE [ATTACH...]: of the displacement of nodes in the tissue of $T/voxels, in parts of it.
error() {
    error_shape=$1
    shift
    { echo "0 pressure $error_shape:skin_out 3e-4" && planes "$error_shape" "$core_size"; } >"$T/script"
    attach -q "$@" <"$T/voxels" 2>"$T/said" | sinew bind -q >"$T/model" 2>>"$T/said"
    tled-run --text --rest 1e-6 --script "$T/script" -o "$T/out" <"$T/model" 2>"$T/log" || diag_file "$T/log"
    awk -v shape="$error_shape" '$1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" }
        on == "node.position" { x[n] = $1; y[n] = $2; z[n++] = $3 }
        on == "node.displacement" {
            d = shape == "tube" ? 2 : 3; w = d == 2 ? 0 : z[n]; r = sqrt(x[n] ^ 2 + y[n] ^ 2 + w ^ 2)
            if (r > .0113 && r < .02) {
                mu = 3000 / 2.9; K = 10000; s = (.0113 / .02) ^ d
                u = -3e-4 / (d == 3 ? 3 * K + 4 * mu * s : 2 * (K - 2 * mu / 3) + 2 * mu * (1 + s)) * (r - .0113 ^ d / r ^ (d - 1))
                off += ($1 - u * x[n] / r) ^ 2 + ($2 - u * y[n] / r) ^ 2 + ($3 - u * w / r) ^ 2; all += u ^ 2
            }
            n++
        }
        END { printf "%.9g", all ? sqrt(off / all) : 1 }' "$T/out"
}
triangles=4 # a pressure acts at their vertices
core tube 1.25 --fraction 8 --strain enclosed
by_surface=$(error tube --surface)
check "a tube of 16 voxels has the step that it has by nodes" grep -q "stable step 0.157" "$T/log"
below "$by_surface" .009 1 "the error by films"
below "$by_surface" "$(error tube)" 12 "a twelfth of what it is by nodes"
core tube 1.25
below "$(error tube --surface)" "$(error tube)" 1.4 "by centres less than by nodes, too"
core ball 2.5 --fraction 8
below "$(error ball --surface)" .025 1 "a sphere of 8 voxels, by films"
if [ -n "$SINEW_LONG" ]; then
    # Order 1.6: over two halvings of the voxels to 1/9.2.
    core tube .3125 --fraction 8
    below "$(error tube --surface)" "$by_surface" 9.2 "a tube of 16 to 64 voxels: order 1.6"
    core ball 2.5 --fraction 8
    coarse=$(error ball --surface)
    core ball .625 --fraction 8
    by_surface=$(error ball --surface)
    below "$by_surface" "$coarse" 9.2 "a sphere of 8 to 32 voxels: order 1.6"
    below "$by_surface" "$(error ball)" 20 "a twentieth of what it is by nodes"
else
    skip 3 "SINEW_LONG is not set"
fi

# ---- a constant gradient above an oblique bone, u = a w with w the height above it: its sides are moved so, and all within follows

awk 'BEGIN { for (i = 0; i < 4; i++) { x = i == 1 || i == 2 ? 20 : 0; y = i > 1 ? 20 : 0; print "v", x, y, 2 + .3 * x + .2 * y; print "v", x, y, 20 }
    print "g skull\nf 1 7 5 3\ng skin\nf 2 4 6 8\nf 1 3 4 2\nf 3 5 6 4\nf 5 7 8 6\nf 7 1 2 8" }' >"$T/wedge.obj"
voxelise -q --unit mm -s 2.5 --origin 0,0,0 --fraction 16 "$T/wedge.obj" | attach -q --surface --text >"$T/wedge"
awk '$1 == "array" { on = $2; next } /^[a-z]/ { on = "" }
    function near(v) { return sprintf("%.9g,%.9g,%.9g", $1 + v, $2 + v, $3 + v) }
    on == "node.position" && ($1 < 1e-9 || $2 < 1e-9 || $1 > .02 - 1e-9 || $2 > .02 - 1e-9 || $3 > .02 - 1e-9) {
        w = $3 - .002 - .3 * $1 - .2 * $2; box = near(-1e-5) "," near(1e-5)
        printf "0 displace %s 0,0,0\n.05 displace %s %.12g,%.12g,%.12g\n", box, box, .02 * w, -.01 * w, .03 * w
    }' "$T/wedge" >"$T/script"
tled-run --text --rest 1e-6 --script "$T/script" <"$T/wedge" 2>"$T/said" >"$T/out" || diag_file "$T/said"
near "$(awk '$1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" }
    on == "node.position" { x[n] = $1; y[n] = $2; z[n++] = $3 }
    on == "node.displacement" {
        w = z[n] - .002 - .3 * x[n] - .2 * y[n]
        if (w > 0 && (x[n] - .01) ^ 2 < 1e-5 && (y[n] - .01) ^ 2 < 1e-5 && z[n] < .019) {
            off += ($1 - .02 * w) ^ 2 + ($2 + .01 * w) ^ 2 + ($3 - .03 * w) ^ 2; all += .0014 * w ^ 2; count++
        }
        n++
    }
    END { printf "%.4f", (count > 30 ? sqrt(off / all) : 1) }' "$T/out")" 0 .03 "a constant gradient above an oblique bone stays one"

# ---- a sheet of one and a half voxels, bonded to a rigid sphere and pulled off it: u(b) = p/(3 K + 4 mu a^3/b^3) (b - a^3/b^2)

inner=20 outer=23
core ball 2 --fraction 8 --strain enclosed
{ echo "0 pressure ball:skin_out -3e-4" && planes ball 2; } >"$T/script"
# pulled [ATTACH...]: how far the sheet's surface moves out, over what it should.
pulled() {
    attach -q "$@" <"$T/voxels" | sinew bind -q | tled-run -q --rest 1e-6 --script "$T/script" 2>"$T/said" | sinew deform -q "$T/ball.obj" >"$T/moved.obj"
    awk '$1 != "v" { next } FNR == NR { x[++n] = $2; y[n] = $3; z[n] = $4; next }
        { r = sqrt(x[++m] ^ 2 + y[m] ^ 2 + z[m] ^ 2); if (r > 22.9) { sum += ($2 * x[m] + $3 * y[m] + $4 * z[m]) / r - r; all++ } }
        END { mu = 3000 / 2.9; s = (20 / 23) ^ 3; printf "%.4f", sum / all / (3e-4 / (30000 + 4 * mu * s) * 23 * (1 - s)) }' "$T/ball.obj" "$T/moved.obj"
}
near "$(pulled --surface)" 1 .025 "a sheet of one and a half voxels on a sphere, pulled"
inner=11.3 outer=20

# ---- bone that moves, in a lattice that fits nowhere

{
    printf 'v %s\n' '0 0 0' '20 0 0' '20 20 0' '0 20 0' '0 0 20' '20 0 20' '20 20 20' '0 20 20'
    printf 'g skin\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n'
    printf 'g skull_low\nf 4 1 5 8\ng skull_top\nf 5 6 7 8\n'
} >"$T/cube.obj"
voxelise -q --unit mm -s 5 --origin 1,2,3.4 --fraction 8 --strain enclosed "$T/cube.obj" | attach -q --surface --rigid skull_top --part lid=skull_top >"$T/lid"
quaternion=$(awk 'BEGIN { s = sin(.25); printf "%.17g,%.17g,%.17g,%.17g", s / 3, 2 * s / 3, 2 * s / 3, cos(.25) }')
printf '0 move lid 0,0,0 0,0,0,1 about 1cm,1cm,2cm\n.1 move lid 1mm,2mm,-3mm %s about 1cm,1cm,2cm\n' "$quaternion" >"$T/script"
tled-run -q --script "$T/script" -t 1 --log-every 5e-4 --log "$T/log" <"$T/lid" >"$T/out" 2>"$T/said" || diag_file "$T/said"
# shellcheck disable=SC2016 # of awk
check "turned and moved, the tissue follows without strain" awk -F '\t' 'END { exit !($6 < 1e-14 && $10 > 1e-4) }' "$T/log"
near "$(awk -F '\t' 'END { printf "%.9g", 1 + $14 / $10 }' "$T/log")" 1 1e-3 "energies balance while bone moves"
check "the pose is the script's" sh -c "sinew info --get body.pose.lid '$T/out' | awk -v q=$quaternion '{ split(q, a, \",\"); for (i = 1; i <= 4; i++) if ((\$(3 + i) - a[i]) ^ 2 > 1e-18) exit 1 }'"
tled-run -q --text --script "$T/script" -t 1 <"$T/lid" 2>"$T/said" | awk -v q="$quaternion" '
    $1 == "array" { on = $2; n = 0; next } /^[a-z]/ { on = "" }
    on == "node.position" { for (i = 1; i <= 3; i++) x[n, i] = $i; n++ }
    on == "node.displacement" {
        split(q, a, ","); for (i = 1; i <= 3; i++) v[i] = x[n, i] - (i == 3 ? .02 : .01)
        for (i = 1; i <= 3; i++) { j = i % 3 + 1; k = j % 3 + 1; t[i] = 2 * (a[j] * v[k] - a[k] * v[j]) }
        for (i = 1; i <= 3; i++) { j = i % 3 + 1; k = j % 3 + 1
            u = a[4] * t[i] + a[j] * t[k] - a[k] * t[j] + (i == 3 ? -.003 : i * .001); off += ($i - u) ^ 2; all++ }
        n++
    }
    END { exit !(all && off < 1e-16) }'
is "$?" 0 "each node has moved with the bone"
# A load that the lid bears: gravity, turned with it or not.
tled-run -q -g 0,0,-9.81 --rest 1e-5 <"$T/lid" >"$T/out" 2>"$T/said"
near "$(get body.force.lid "$T/out" | awk '{ print $3 }')" -.07848 1e-4 "at rest a body bears the tissue's weight"
printf '0 displace skull_top 0,0,0\n.05 displace skull_top 0,0,2mm\n' >"$T/script"
tled-run -q --script "$T/script" --rest 1e-6 <"$T/lid" >"$T/out" 2>"$T/said" || diag_file "$T/said"
near "$(get node.displacement.at.5mm,5mm,5mm "$T/out" | awk '{ print $3 }')" .002 1e-5 "scripts displace bone by its surface"
printf '0 displace skull_top -,-,0\n.05 displace skull_top -,-,2mm\n' >"$T/script"
tled-run -q --script "$T/script" --rest 1e-6 <"$T/lid" >"$T/one" 2>"$T/said" || diag_file "$T/said"
check "what is left as it is stays held, as at rigid nodes" sinew diff "$T/out" "$T/one"

# ---- energies, bytes

tled-run -q -g 1,2,-9.81 --ramp .01 -t .05 --log-every 1e-4 --log "$T/log" <"$T/lid" >"$T/one" 2>"$T/said" || diag_file "$T/said"
near "$(awk -F '\t' 'END { printf "%.9g", 1 + $14 / $8 }' "$T/log")" 1 1e-3 "energies balance under gravity"
# known NAME [TLED-RUN...]: what the model in $T/lid has of energy is the log's, by materials, in frames and in what is made of them later.
known() {
    known_name=$1
    shift
    tled-run -q "$@" -t .02 --log-every .01 --log "$T/log" --tsv material.energy --results material.energy <"$T/lid" >"$T/out" 2>"$T/said" || diag_file "$T/said"
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next } { sum = 0; for (k in column) if (k ~ /^material.energy/) sum += $column[k] } END { printf "%.9g %.9g %.9g\n", $column["strain/J"], sum, $column["quality.hourglass"] }' "$T/log" >"$T/row"
    read -r strain sum modes <"$T/row"
    near "$sum" "$strain" 1e-8 "$known_name: the strain energy is that of materials"
    near "$(get material.energy.sum "$T/out")" "$strain" 1e-8 "and that of frames"
    is "$(sinew results material.energy <"$T/out" | sinew info --get material.energy.sum)" "$(get material.energy.sum "$T/out")" "also where it is asked for later"
    near "$(get quality.hourglass "$T/out")" "$modes" 1e-7 "hourglass energy is the same share of it"
}
cp "$T/lid" "$T/one"
printf '0 move lid 0,0,0 0,0,0,1 about 1cm,1cm,2cm\n.02 move lid 1mm,2mm,-3mm %s about 1cm,1cm,2cm\n' "$quaternion" >"$T/script"
printf '0 displace skull_low 0,0,0\n.02 displace skull_low 1mm,0,0\n' >>"$T/script"
voxelise -q --unit mm -s 5 --origin 1,2,3.4 --fraction 8 "$T/cube.obj" | attach -q --surface --part lid=skull_top >"$T/lid"
known "bone that turns and slides" --script "$T/script"
check "frames say how bone has moved" test "$(get bone.displacement.max "$T/out")" != 0
awk -f samples/shape.awk -f samples/head.awk >"$T/head.obj"
for mixed in between laminate; do
    voxelise -q --unit mm -s 10 --fraction 4 --mixed "$mixed" --materials samples/head.materials "$T/head.obj" | attach -q --surface >"$T/lid"
    known "a head with muscles, mixed elements $mixed" -c zyg_left=.3 -g 0,0,-9.81
done
check "without bone that moves it is 0" test "$(get bone.displacement.max "$T/out")" = 0
mv "$T/one" "$T/lid"
for sets in plain AVX2; do
    for precision in double single; do
        SINEW_VECTORS=$sets tled-run -q --precision "$precision" --threads 1 -g 1,2,-9.81 -t .02 <"$T/lid" >"$T/a" 2>"$T/said" || { skip 1 "no $sets" && continue; }
        tled-run -q --precision "$precision" --threads 3 -g 1,2,-9.81 -t .02 <"$T/lid" >"$T/b" 2>"$T/said"
        check "$precision: $sets on one thread has the bytes of the best on three" sinew diff "$T/a" "$T/b"
    done
done

# ---- refused

# spoilt ARRAY ROW VALUES: of $T/lid.text.
sinew export -f model --text <"$T/lid" >"$T/lid.text"
spoilt() {
    awk -v a="$1" -v row="$2" -v to="$3" '$1 == "array" { on = $2; n = 0; print; next } /^[a-z]/ { if ($1 == "crc") next; on = "" }
        { if (on == a && n++ == row) print to; else print }' "$T/lid.text" >"$T/spoilt"
}
spoilt bone.depth 3 0
fails 1 "a film without thickness" "bone.depth and bone.area, row 3, are 0 and .*; expected both above 0" sh -c "tled-run -n 1 <'$T/spoilt'"
spoilt bone.depth 3 1e-300
fails 1 "or next to none" "bone.depth, row 3, is 1e-300 m; expected at least a millionth of a voxel, 5e-09 m" sh -c "tled-run -n 1 <'$T/spoilt'"
spoilt bone.normal 2 "0 0 0"
fails 1 "without a normal" "bone.normal, row 2, is 0 0 0; expected a unit normal" sh -c "tled-run -n 1 <'$T/spoilt'"
spoilt bone.point 1 "1 1 1"
fails 1 "away from its element" "bone.point, row 1, is away from its element" sh -c "tled-run -n 1 <'$T/spoilt'"
spoilt film.element 1 0
fails 1 "not in order" "film.element, row 1 is 0 after [0-9]*; expected ascending numbers" sh -c "tled-run -n 1 <'$T/spoilt'"
awk '$1 == "axis" && $2 == "bone" { print "axis bone 0"; next } /^[a-z]/ { drop = 0 } $1 == "array" && $2 ~ /^bone/ { print; drop = 1; next } $1 != "crc" && !drop' "$T/lid.text" >"$T/spoilt"
fails 1 "shares of films that are none" "film.element has [0-9]* rows and bone.element none; expected some of both" sh -c "tled-run -n 1 <'$T/spoilt'"
fails 1 "a muscle with vmax" "volume '.*' has vmax, and bone that holds it by its surface; expected materials without vmax" \
    sh -c "tled-run -n 1 -m tissue.vmax=5 -m tissue.passive=.05 <'$T/lid'"
done_testing
