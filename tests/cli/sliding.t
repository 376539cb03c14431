#!/bin/sh
# attach --slide and tled-run: nodes that slide on bone. Distance fields against a plane and a sphere; blocks on planes and a sphere
# against closed forms; bodies, energies, bytes, and what is refused.
# shellcheck disable=SC2046 # what prints numbers is split into these
. "$(dirname "$0")/lib.sh"

# ---- what attach writes: a block on a plate, 20 x 20 x 10 mm
cat >"$T/block.obj" <<'OBJ'
g skin
v 0 0 0
v 20 0 0
v 20 20 0
v 0 20 0
v 0 0 10
v 20 0 10
v 20 20 10
v 0 20 10
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
OBJ
# its faces down: they are turned
printf 'g skull_plate\nv -40 -40 0\nv 60 -40 0\nv 60 60 0\nv -40 60 0\nf 4 3 2 1\n' >"$T/plate.obj"
voxelise -q --unit mm -s 5 "$T/block.obj" >"$T/voxels"
on_plate() {
    attach -q --rigid-file "$T/plate.obj" "$@" <"$T/voxels" 2>"$T/said"
}
on_plate --slide skull_plate >"$T/slides"
is "$(get axis.slide "$T/slides") $(get axis.field "$T/slides") $(get node.rigid.max "$T/slides") $(get slide.lifts.max "$T/slides")" "25 1 0 0" \
    "all nodes of the lowest layer slide, and none is rigid"
is "$(cat "$T/said")" "" "without a warning"
is "$(sinew export -f model --text "$T/slides" | awk '
    /^array/ { name = $2; next }
    /^crc|^end|^axis|^meta/ { next }
    name == "field.first" { split($0, first, " ") }
    name == "field.samples" { split($0, n, " ") }
    name == "distance.value" { sheet = n[1] * n[2]; k = int(count / sheet); count++; d = $1 - .005 * (first[3] + k); if (d * d > 1e-16) bad++ }
    END { print count == n[1] * n[2] * n[3] && first[1] == -8 && n[1] == 21 && n[3] == 17 ? bad + 0 : "another size" }')" 0 \
    "the distance is the height above the plate, 8 voxels around"
attach -q <"$T/slides" 2>/dev/null >"$T/none"
fails 1 "without --slide the arrays go" "no key" sinew info --get axis.slide "$T/none"
on_plate --slide skull_plate:-1mm,-1mm,-1mm,11mm,21mm,1mm >"$T/half"
is "$(get axis.slide "$T/half") $(get node.rigid.sum "$T/half" 2>/dev/null)" "15 10" "in a box, by lengths with units"
sed -e 's/^v 20/v 11/' -e 's/^v 0/v -3/' -e 's/^\(v [-0-9]*\) 20/\1 23/' -e 's/^\(v [-0-9]*\) 0/\1 -3/' -e 's/ 0$/ -3/' -e 's/ 10$/ 3/' "$T/block.obj" >"$T/region.obj"
on_plate --slide "skull_plate:$T/region.obj" >"$T/region"
is "$(get axis.slide "$T/region")" 15 "or inside of a closed surface"
on_plate --anonymous-names --slide "skull_plate:$T/region.obj" >"$T/nameless"
is "$(sinew info "$T/region" | grep -c ' skull_plate:region.obj') $(sinew info "$T/nameless" | grep -c ' skull_plate:FILE')" "1 1" "whose name provenance has, or not"
on_plate --slide skull_plate --slide-off 'skull*:-1,-1,-1,11,21,1' --part plate=skull_plate >"$T/both"
is "$(get axis.slide "$T/both") $(get slide.lifts.sum "$T/both") $(get field.body.max "$T/both")" "25 15 0" "some may come off; the field is the body's"

refuse() { # NAME WHAT OPTION...
    name=$1 what=$2
    shift 2
    fails "$3" "$name" "$what" sh -c "attach -q --rigid-file '$T/plate.obj' $1 $2 <'$T/voxels'"
}
refuse "an unknown surface" "unknown rigid surface 'skul'; did you mean 'skull_plate'" --slide skul 2
refuse "no region" "expected SURFACE,...\[:REGION\]" --slide skull_plate: 2
refuse "a region of three lengths" "expected a region X0,Y0,Z0,X1,Y1,Z1" --slide skull_plate:1,2,3 2
refuse "an empty box" "the box is empty" --slide skull_plate:1,2,3,0,5,6 2
refuse "a region beside all" "has none of the 25 nodes that are held" --slide skull_plate:100,100,100,110,110,110 1
refuse "a file that is not there" "cannot open" --slide skull_plate:nofile.obj 1
refuse "a surface that is open" "is not closed" --slide "skull_plate:$T/plate.obj" 1
refuse "films" "films hold all" "--surface --slide" skull_plate 2
printf 'v 100 -40 0\nv 100 60 0\nf 2 5 6 3\n' | cat "$T/plate.obj" - >"$T/wrong.obj"
fails 1 "faces that face both ways" "two faces face different sides" sh -c "attach -q --rigid-file '$T/wrong.obj' --slide skull_plate <'$T/voxels'"

# ---- planes: blocks of 40 x 40 x 10 mm and nu 0.3, pressed first, then pulled along the plane, by a slope of 30 degrees
on_plane() { # LIFTS
    awk -v E=30000 -v nu=.3 -v nx=8 -v ny=8 -v nz=2 -v h=.005 -f tests/cli/block.awk | awk -v lifts="$1" -v nx=8 -v ny=8 -v h=.005 -f tests/cli/slide.awk
}
on_plane 0 >"$T/keeps"
on_plane 1 >"$T/lifts"
awk 'BEGIN {
    t = atan2(1, sqrt(3)); n = -9.81 * cos(t); s = 9.81 * sin(t)
    for (i = 0; i <= 20; i++) { x = i / 20; printf "%g gravity 0,0,%.9g\n", i * .01, n * x * x * (3 - 2 * x) }
    for (i = 1; i <= 20; i++) { x = i / 20; printf "%g gravity %.9g,0,%.9g\n", .2 + i * .005, s * x * x * (3 - 2 * x), n }
}' >"$T/slope"
# slid MODEL MU: the mean way and the velocity along x after .5 s
slid() {
    tled-run -q -d cpu --script "$T/slope" --damping 0 --friction "$2" -t .5 <"$T/$1" >"$T/out" 2>/dev/null
    echo "$(get node.displacement.mean "$T/out" | cut -d ' ' -f 1) $(get node.velocity.mean "$T/out" | cut -d ' ' -f 1)"
}
# way MU: the same of a point
way() {
    awk -v mu="$1" 'BEGIN {
        t = atan2(1, sqrt(3)); dt = 1e-5
        for (i = 0; i < 3e4; i++) {
            x = (i + .5) * dt / .1; x = x > 1 ? 1 : x
            a = 9.81 * (sin(t) * x * x * (3 - 2 * x) - mu * cos(t))
            if (v <= 0 && a < 0) a = 0
            v += a * dt / 2; u += v * dt; v += a * dt / 2
        }
        print u, v
    }'
}
for model in keeps lifts; do
    near "$(slid $model 0)" "$(way 0)" .001 "$model: without friction it slides with g sin"
    set -- $(slid $model .1) $(way .1)
    near "$1" "$3" .01 "$model: with mu 0.1 as far as with g (sin - mu cos)"
    near "$2" "$4" .01 "and as fast"
    below "$(slid $model .6 | cut -d ' ' -f 1)" 2e-4 "$model: where mu is more than the slope it sticks"
done
set -- $(slid lifts .3) $(way .3)
near "$1" "$3" .01 "lifts: with mu 0.3 likewise"
tled-run -q -d cpu -g 0,0,1 --ramp 0 --damping 0 -t .1 <"$T/lifts" >"$T/out"
near "$(get node.displacement.mean "$T/out" | cut -d ' ' -f 3)" .005 .02 "what may come off does"
tled-run -q -d cpu -g 0,0,1 --ramp 0 --damping 0 -t .1 <"$T/keeps" >"$T/out"
below "$(get node.displacement.at.0,0,0 "$T/out" | cut -d ' ' -f 3)" 1e-9 "what may not does not"
tled-run -q -d cpu --script "$T/slope" --damping 5 --friction .1 -t .5 --log "$T/log" --log-every .0005 <"$T/keeps" >"$T/out" 2>/dev/null
near "$(awk -F '\t' 'END { printf "%.9g", 1 + $14 / $8 }' "$T/log")" 1 1e-3 "energies balance, with what friction takes"
check "friction takes energy" test "$(awk -F '\t' 'END { print ($10 < -1e-3) }' "$T/log")" = 1

# ---- a sphere of 50 mm below a block, on which it swings for 10,000 steps
awk -v E=30000 -v nx=8 -v ny=8 -v nz=3 -v h=.0025 -f tests/cli/block.awk | awk -v nx=8 -v ny=8 -v h=.0025 -v R=.05 -f tests/cli/slide.awk >"$T/sphere"
tled-run -q -d cpu -g 2,1,9.81 --ramp .01 --damping 1 -n 10000 <"$T/sphere" >"$T/out" 2>"$T/said"
is "$(cat "$T/said")" "" "no node leaves its field"
set -- $(sinew export -f model --text "$T/out" | awk -v h=.0025 -v R=.05 -v nx=8 -v ny=8 -f tests/cli/slid.awk)
below "$1" 1e-3 "after 10,000 steps on a sphere no node is off by as much of a voxel"
below "$2" .02 "nor, where samples lie between, from the sphere itself"
check "which went by more than 10 mm" test "$(get node.displacement.max "$T/out" | awk '{ print ($1 > .01) }')" = 1
tled-run -q -d cpu -g 40,0,9.81 --ramp .01 --damping 1 -t .2 <"$T/sphere" >"$T/out" 2>"$T/said"
check "one that leaves it is told" grep -q 'nodes slid beyond the distance field of their bone, which goes on there as at its border' "$T/said"
check "it comes to rest" sh -c "tled-run -q -d cpu -g 2,1,9.81 --ramp .01 -o '$T/rest' <'$T/sphere'"

# ---- bytes
swing() {
    tled-run -q -d cpu -g 2,1,9.81 --ramp 0 --damping 1 --friction .2 "$@"
}
frame() {
    sinew export -f model --text "$1" | awk '/^frame/ { s = ""; next } { s = s $0 "\n" } END { printf "%s", s }'
}
swing --threads 1 -n 400 <"$T/sphere" >"$T/one"
swing --threads 3 -n 400 <"$T/sphere" >"$T/three"
is "$(cmp "$T/one" "$T/three" 2>&1)" "" "the same bytes for any number of threads"
swing -n 150 <"$T/sphere" | swing -n 250 >"$T/in_two"
frame "$T/one" >"$T/one.text"
frame "$T/in_two" >"$T/in_two.text"
is "$(cmp "$T/one.text" "$T/in_two.text" 2>&1)" "" "and in two parts"
swing --precision single -n 400 <"$T/sphere" >"$T/single"
check "single precision is near" sinew diff --abs 1e-6 --only node.displacement "$T/one" "$T/single"

# ---- bone that moves: a body that holds no node
on_plane 0 | awk -v body=plate -f tests/cli/slide.awk >"$T/moves"
printf '0 gravity 0,0,0\n.1 gravity 0,0,-9.81\n.1 move plate 0,0,0 0,0,0,1\n.6 move plate 0,0,0 0,0.258819045,0,0.965925826\n' >"$T/tilt"
tled-run -q -d cpu --script "$T/tilt" --friction 1 --damping 300 -t .9 <"$T/moves" >"$T/out"
set -- $(get node.displacement.at.40mm,0,0 "$T/out")
near "$3" -.02 .02 "a tilted plate takes along what friction holds: down"
near "$1" -.0053590 .05 "and back"
set -- $(get body.force.plate "$T/out")
near "$3" -.15696 .01 "and bears its weight"
set -- $(get body.pose "$T/out")
near "$5" .258819045 1e-6 "frames say how it has turned"
tled-run -q -d cpu -g 0,0,-9.81 --friction 1 --damping 300 -t .1 <"$T/out" >"$T/on"
set -- $(get node.displacement.at.40mm,0,0 "$T/on") $(get node.velocity.max "$T/on")
near "$3" -.02 .02 "going on without a script, it stays where it was"
below "$4" .01 "and at rest"
tled-run -q -d cpu -g 0,0,-9.81 --ramp .01 --friction 1 -o "$T/rest" <"$T/out"
check "to rest, as friction holds it" sinew info --get node.displacement.max "$T/rest"
near "$(get node.displacement.at.40mm,0,0 "$T/rest" | awk '{ print $3 }')" -.02 .02 "where it was"
printf '0 gravity 0,0,0\n.1 gravity 0,0,-9.81\n.1 move plate 0,0,0 0,0,0,1\n.3 move plate 20mm,0,5mm 0,0,0,1\n' >"$T/push"
tled-run -q -d cpu --script "$T/push" --damping 20 -t .4 <"$T/moves" >"$T/out" 2>/dev/null
set -- $(get node.displacement.mean "$T/out")
below "$1" 1e-9 "one without friction leaves tissue where it was"
near "$3" .005 .01 "but lifts it"

# ---- nodes that the script holds in part slide in the rest
printf '0 gravity 0,0,0\n.1 gravity 2,2,-9.81\n0 displace -1mm,-1mm,-1mm,1mm,50mm,1mm 0,-,-\n' >"$T/part"
tled-run -q -d cpu --script "$T/part" --damping 50 -t .2 <"$T/keeps" >"$T/out"
set -- $(get node.displacement.at.0,0,0 "$T/out")
check "in the direction that is free, and on the plane" awk -v x="$1" -v y="$2" -v z="$3" 'BEGIN { exit !(x == 0 && y > .003 && z * z < 1e-30) }'
awk -v E=30000 -v nx=8 -v ny=8 -v nz=3 -v h=.0025 -f tests/cli/block.awk | awk -v nx=8 -v ny=8 -v h=.0025 -v R=.05 -f tests/cli/slide.awk >"$T/sphere"
printf '0 displace 12mm,9mm,-1mm,13mm,11mm,1mm -,-,0\n.01 displace 12mm,9mm,-1mm,13mm,11mm,1mm -,-,.1mm\n' >"$T/up"
tled-run -q -d cpu --script "$T/up" --damping 50 -t .02 <"$T/sphere" >"$T/out"
below "$(get node.displacement.max "$T/out" | cut -d ' ' -f 1)" 1e-3 "what is held along the normal is not thrown along the bone"

# ---- what else goes with it: a run that was cut off, one that is live, and other formats
lasting() {
    tled-run -q -d cpu --script "$T/push" --friction .1 --damping 20 -t 3 --every .5 "$@" <"$T/moves" 2>/dev/null
}
lasting -o "$T/whole"
cut_off "$T/point" \
    tled-run -q -d cpu --script "$T/push" --friction .1 --damping 20 -t 3 --every .5 --checkpoint "$T/point" --checkpoint-every .02 -o "$T/cut" \
    <"$T/moves"
fails 1 "a checkpoint keeps the friction" "friction" sh -c "tled-run -q -d cpu --script '$T/push' --friction .2 --damping 20 -t 3 --every .5 --restart '$T/point' -o '$T/cut' <'$T/moves'"
lasting --restart "$T/point" --checkpoint "$T/point" -o "$T/cut"
is "$(cmp "$T/whole" "$T/cut" 2>&1)" "" "and a run that was cut off goes on to the same bytes"
sinew export -f inp -o "$T/file.inp" "$T/keeps" 2>"$T/said"
check "an Abaqus file has no sliding nodes, and says so" grep -q 'nodes that slide on bone are free there' "$T/said"

# ---- refused
fails 2 "friction of nothing" "no node of the model slides on bone" sh -c "awk -v nx=2 -v ny=2 -v nz=2 -v h=.01 -v held=low -f tests/cli/block.awk | tled-run -n 1 --friction .1"
spoilt() { # ARRAY ROW VALUE
    awk -v array="$1" -v row="$2" -v value="$3" 'BEGIN { at = -1 } /^[a-z]/ { at = -1 } $1 == "array" && $2 == array { at = 0; print; next } { if (at >= 0 && at++ == row) $0 = value; print }' "$T/keeps" >"$T/spoilt"
}
spoilt slide.node 3 1
fails 1 "nodes not in order" "slide.node, row 3, is 1 after 2; expected ascending numbers" sh -c "tled-run -n 1 <'$T/spoilt'"
spoilt node.rigid 5 1
fails 1 "a rigid one" "node 5 is rigid and slides; expected one of both" sh -c "tled-run -n 1 <'$T/spoilt'"
spoilt field.samples 0 "13 13 4"
fails 1 "samples that are not there" "distance.value has 845 rows; expected 676, as field.samples say" sh -c "tled-run -n 1 <'$T/spoilt'"
spoilt field.samples 0 "13 13 6"
fails 1 "or too many" "field.samples, row 0, is 13 13 6; expected no more than the 845 rows" sh -c "tled-run -n 1 <'$T/spoilt'"
done_testing
