#!/bin/sh
# --frames of tled-run and msds-run: which arrays frames have, as f32 or f64; bound surfaces as sinew deform moves them; and that all who read
# frames take f32, and say what they lack.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
export SINEW_THREADS=2

cp tests/cli/cube.obj "$T/cube.obj"
{
    cat tests/cli/cube.obj
    echo 'vn 1 0 0'
    echo 'f 1//1 2//1 3//1'
} >"$T/normal.obj"
voxelise -q --unit mm -s 2.5 "$T/cube.obj" | sinew bind -q --unit mm "$T/cube.obj" "$T/normal.obj" >"$T/cube.sinew" 2>"$T/said"
tled() {
    tled-run -q -d cpu -n 60 --every .001 -g 0,0,-9.81 "$@"
}
tled --ramp 0 <"$T/cube.sinew" >"$T/all.sinew" 2>"$T/said"
tled --ramp 0 --frames node.displacement,node.velocity <"$T/cube.sinew" >"$T/named.sinew"
tled --ramp 0 --frames velocity:f32,displacement:f32 <"$T/cube.sinew" >"$T/f32.sinew"
tled --ramp 0 --frames displacement:f32,surfaces:f64 <"$T/cube.sinew" >"$T/both.sinew"
tled --ramp 0 --frames surfaces <"$T/cube.sinew" >"$T/surfaces.sinew"
tled --ramp 0 --frames surfaces:f32 --text <"$T/cube.sinew" >"$T/surfaces32.text"

is "$(sinew info --get frames "$T/all.sinew")" "$(sinew info --get frames "$T/surfaces.sinew")" "as many frames as ever"
sinew diff "$T/all.sinew" "$T/named.sinew" >"$T/out"
is "$(grep -c 'frame' "$T/out")" 0 "all arrays by name are what frames have without the option"
check "f32 is f64, rounded to half a unit of its last place" sinew diff --rel node.displacement=5.97e-8 --rel node.velocity=5.97e-8 \
    --only node.displacement,node.velocity "$T/all.sinew" "$T/f32.sinew"
sinew diff --only node.displacement "$T/all.sinew" "$T/f32.sinew" >"$T/out"
is $? 1 "without a tolerance f32 differs from f64"
case $(sinew info "$T/f32.sinew") in
*'node.displacement  f32'*'node.velocity      f32'*) ok "sinew info says f32" ;;
*) not_ok "sinew info says f32" ;;
esac
is "$(sinew info "$T/surfaces.sinew" | grep -c 'node\.\(displacement\|velocity\)')" 0 "surfaces alone: no nodes"

for surface in cube normal; do
    sinew deform -q "$T/$surface.obj" <"$T/all.sinew" >"$T/by_nodes.obj"
    sinew deform -q "$T/$surface.obj" <"$T/surfaces.sinew" >"$T/by_solver.obj"
    grep -v '^vn' "$T/by_nodes.obj" >"$T/want"
    grep -v '^vn' "$T/by_solver.obj" >"$T/got"
    check "surface $surface is where sinew deform moves it, to the byte" cmp "$T/got" "$T/want"
    check "and moved" sh -c "! cmp -s '$T/got' '$T/$surface.obj'"
done
check "a surface as f32, as text, is deformed too" sinew deform -q -o "$T/out.obj" "$T/cube.obj" <"$T/surfaces32.text"
check "a surface alone is exported" sinew export -q -f vtu --surface cube --deformed -o "$T/out.vtu" "$T/surfaces.sinew"

# ---- who reads frames: f32
tled --ramp 0 --frames displacement:f32 <"$T/cube.sinew" >"$T/u32.sinew"
check "sinew deform takes f32" sinew deform -q -o "$T/out.obj" "$T/cube.obj" <"$T/u32.sinew"
check "sinew results takes f32" sh -c "sinew results -q stress <'$T/u32.sinew' >'$T/stress.sinew'"
check "and passes it on as f32" sh -c "sinew info '$T/stress.sinew' | grep -q 'node.displacement *f32'"
check "sinew export takes f32" sinew export -q -f vtu -o "$T/out.vtu" "$T/u32.sinew"
check "sinew render takes f32" sinew render -q --size 40x40 -o "$T/out.png" "$T/u32.sinew"
tled --ramp 0 --frames displacement:f32,velocity <"$T/cube.sinew" >"$T/mixed.sinew"
check "without --frames a run goes on with the types of the frames before" sh -c "tled-run -q -d cpu -n 5 <'$T/mixed.sinew' >'$T/on.sinew'"
is "$(sinew info "$T/on.sinew" | grep -c 'node.displacement *f32\|node.velocity *f64')" 2 "f32 where they are, f64 where they are not"
is "$(sinew info --get frames "$T/on.sinew")" "$(($(sinew info --get frames "$T/mixed.sinew") + 1))" "and has a frame more"
check "a run goes on from f32" sh -c "tled-run -q -d cpu -n 5 --frames displacement:f32 <'$T/u32.sinew' >'$T/on.sinew' 2>'$T/said'"
is "$(grep -c 'no node.velocity: the run begins with velocity 0' "$T/said")" 1 "and says that it has no velocities"

# ---- what is lacking
fails() {
    name=$1 status=$2 words=$3
    shift 3
    "$@" >"$T/stdout" 2>"$T/stderr"
    got=$?
    is "$got" "$status" "$name: status $status"
    case $(cat "$T/stderr") in
    *"$words"*) ok "$name: says so" ;;
    *)
        not_ok "$name: says so"
        diag_file "$T/stderr"
        ;;
    esac
}
fails "results of surfaces alone" 1 "no node.displacement" sh -c "sinew results -q stress <'$T/surfaces.sinew'"
fails "a picture of elements that are not there" 1 "no node.displacement" sinew render -q --show voxels -o "$T/out.png" "$T/surfaces.sinew"
fails "a run from surfaces alone" 1 "no node.displacement" sh -c "tled-run -q -d cpu -n 5 <'$T/surfaces.sinew'"
fails "frames of other arrays behind others" 1 "expected the same --frames" sh -c "tled-run -q -d cpu -n 5 --frames displacement <'$T/u32.sinew'"
fails "all arrays behind fewer" 1 "no node.velocity, and those to come have it; expected --frames node.displacement:f32" sh -c "tled-run -q -d cpu -n 5 <'$T/u32.sinew'"
sinew results -q stress <"$T/all.sinew" >"$T/stressed.sinew"
fails "what this run does not make" 1 "have element.stress, which frames of this run cannot have" sh -c "tled-run -q -d cpu -n 5 <'$T/stressed.sinew'"
fails "an array that is not there" 2 "expected some of displacement, velocity, surfaces" sh -c "tled-run -q --frames bodies <'$T/cube.sinew'"
fails "a type that is none" 2 "expected f32 or f64" sh -c "tled-run -q --frames displacement:f16 <'$T/cube.sinew'"
fails "an array twice" 2 "as f32 and as f64" sh -c "tled-run -q --frames displacement:f32,node.displacement <'$T/cube.sinew'"

# ---- msds-run
msds-mesh -q --nodes 9x7x5 --size 4cm,3cm,2cm >"$T/block.sinew"
echo '0 .02 .015 .0195 1 0 0 0
0.1 .02 .015 .018 1 0 0 0
0.2 .021 .015 .016 1 0 0 0' >"$T/poses"
printf 'v 10 10 12\nv 30 10 12\nv 20 25 15\nf 1 2 3\n' >"$T/vessel.obj"
sinew bind -q --unit mm "$T/vessel.obj" <"$T/block.sinew" >"$T/bound.sinew" 2>"$T/said"
msds() {
    msds-run -q -d cpu --probe sphere:6mm --poses "$T/poses" "$@" <"$T/bound.sinew"
}
msds >"$T/all.sinew"
msds --frames displacement,velocity,probe >"$T/named.sinew"
msds --frames surfaces,probe:f32 >"$T/surfaces.sinew"
msds --frames displacement:f32 >"$T/f32.sinew"
check "msds-run: all by name" sinew diff --only node.displacement,node.velocity,probe.pose,probe.force,probe.torque "$T/all.sinew" "$T/named.sinew"
check "msds-run: f32" sinew diff --only node.displacement --rel node.displacement=5.97e-8 "$T/all.sinew" "$T/f32.sinew"
sinew deform -q --unit mm "$T/vessel.obj" <"$T/all.sinew" >"$T/want"
sinew deform -q --unit mm "$T/vessel.obj" <"$T/surfaces.sinew" >"$T/got"
check "msds-run: a vessel is where sinew deform moves it" cmp "$T/got" "$T/want"
check "and has moved" sh -c "! cmp -s '$T/got' '$T/vessel.obj'"
is "$(sinew info "$T/surfaces.sinew" | grep -c 'probe.force *f32')" 1 "the probe's force as f32"

check "msds-run: a run goes on as f64 without --frames" sh -c "msds-run -q -d cpu --probe sphere:6mm --poses '$T/poses' <'$T/all.sinew' >'$T/on.sinew'"
fails "msds-run: all arrays behind fewer" 1 "expected --frames node.displacement:f32" \
    sh -c "msds-run -q -d cpu --probe sphere:6mm --poses '$T/poses' <'$T/f32.sinew'"
fails "msds-run: a probe that is not there" 2 "'probe': probe.pose says nothing here; expected --probe too" \
    sh -c "msds-run -q -d cpu --poses '$T/poses' --frames displacement,probe <'$T/bound.sinew'"
fails "msds-run: nor is it offered" 2 "expected some of displacement, velocity, surfaces, node.displacement" \
    sh -c "msds-run -q -d cpu --poses '$T/poses' --frames bodies <'$T/bound.sinew'"

done_testing
