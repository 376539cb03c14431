#!/bin/sh
# A probe in pictures: of any shape, from either solver, opaque and seen through; a convex one by what the model holds of it. And that
# msds-run says of a probe that it touches nothing only where that is so.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

compare=${BUILD:-build}/tests/cli/compare_pictures
[ -x "$compare" ] || skip_all "no $compare: make unit builds it"
cp tests/cli/cube.obj "$T/cube.obj"
echo '0 .04 .04 .037 .98 .1 .1 .14106735979665885' >"$T/press.tum"
msds-mesh -q --nodes 9x9x5 --size 8cm,8cm,4cm >"$T/tets.sinew"
awk -v x=80 -v y=80 -v z=40 -v held=top -f tests/cli/box.awk | voxelise -q --unit mm -s 10 - | attach -q >"$T/voxels.sinew"
render="sinew render --up z --size 200x150 --angle 30"

# draw PICTURE MODEL ARGUMENTS...
draw() {
    picture=$1 drawn=$2
    shift 2
    $render "$@" -o "$T/$picture.png" "$T/$drawn" 2>"$T/stderr" || diag_file "$T/stderr"
}

# differ NAME A B: the pictures are not the same.
differ() {
    "$compare" "$T/$2.png" "$T/$3.png" >"$T/stdout" 2>"$T/stderr"
    is "$?:$(grep -c pixels "$T/stdout")" 1:1 "$1: $(cat "$T/stdout")"
}

# ---- A box as an OBJ and the same as a linear array with sharp edges make the same picture, and not that of no probe.
for solver in tets voxels; do
    for shape in "convex:$T/cube.obj" linear:2cm,2cm,0; do
        set -- -q --probe "$shape" --unit mm --poses "$T/press.tum" -o "$T/${shape%%:*}.sinew"
        case $solver in
        tets) msds-run "$@" <"$T/tets.sinew" 2>"$T/said" ;;
        voxels) tled-run -d cpu -n 3 "$@" <"$T/voxels.sinew" 2>"$T/said" ;;
        esac || diag_file "$T/said"
        for clear in '' '--clear probe'; do
            # shellcheck disable=SC2086 # words
            draw "${shape%%:*}${clear:+.clear}" "${shape%%:*}.sinew" --show voxels,probe $clear
        done
    done
    draw none convex.sinew --show voxels
    rm -f "$T/cube.moved" && mv "$T/cube.obj" "$T/cube.moved"
    check "$solver: a convex probe is drawn" "$compare" "$T/convex.png" "$T/linear.png"
    check "$solver: and seen through" "$compare" "$T/convex.clear.png" "$T/linear.clear.png"
    differ "$solver: it is something" convex none
    differ "$solver: seen through it is not the same" convex convex.clear
    differ "$solver: nor nothing" convex.clear none
    draw again convex.sinew --show voxels,probe
    check "$solver: without the OBJ" cmp "$T/again.png" "$T/convex.png"
    is "$(sinew info --get axis.probe-vertex --get axis.probe-face --get probe-vertex.position.low --get meta.probe.shape "$T/convex.sinew" | tr '\n' ' ')" \
        "8 12 -0.01 -0.01 -0.02 convex:cube.obj " "$solver: by its corners, in metres"
    mv "$T/cube.moved" "$T/cube.obj"
done

# ---- Another probe takes its place.
msds-run -q --probe convex:"$T/cube.obj" --unit mm --poses "$T/press.tum" -o "$T/once.sinew" <"$T/tets.sinew" 2>/dev/null
echo '1 .04 .04 .037 1 0 0 0' >"$T/later.tum"
msds-run -q --probe sphere:1cm --poses "$T/later.tum" <"$T/once.sinew" 2>/dev/null | sinew info >"$T/info"
is "$(grep -c 'probe-vertex\|probe-face' "$T/info"):$(grep -c 'probe.shape *sphere:0.01m' "$T/info")" 0:1 "a sphere after it leaves nothing of it"
awk '/^v/ { $4 *= 2 } { print }' "$T/cube.obj" >"$T/tall.obj"
msds-run -q --probe convex:"$T/tall.obj" --unit mm --poses "$T/later.tum" <"$T/once.sinew" 2>/dev/null |
    sinew info --get meta.probe.shape --get probe-vertex.position.low >"$T/info"
is "$(tr '\n' ' ' <"$T/info")" "convex:tall.obj -0.01 -0.01 -0.04 " "another OBJ takes its place"

cp "$T/cube.obj" "$T/$(printf 'caf\351.obj')"
check "a name that is not UTF-8" msds-run -q --probe "convex:$T/$(printf 'caf\351.obj')" --unit mm --poses "$T/press.tum" -o "$T/latin.sinew" <"$T/tets.sinew"
is "$(sinew info --get meta.probe.shape "$T/latin.sinew")" 'convex:caf?.obj' "is mended"

# ---- What a model may say that is no probe.
sinew export -f model --text "$T/once.sinew" | grep -v '^crc' >"$T/text"
# refused NAME PATTERN SED
refused() {
    sed "$3" "$T/text" >"$T/bad.sinew"
    fails 1 "$1" "$2" sinew render --show voxels,probe --size 60x40 -o "$T/bad.png" "$T/bad.sinew"
}
refused "a shape that is none" "bad.sinew: metadata, probe.shape: 'cone:3' is not a probe; expected one as" 's/^meta probe.shape .*/meta probe.shape "cone:3"/'
refused "no corners" 'the probe is the OBJ cube.obj, which the model does not hold; expected its corners' 's/probe-vertex.position/x-position/'
refused "no triangles" 'which the model does not hold' 's/probe-face.vertex/x-face/'
refused "a corner at infinity" 'array probe-vertex.position, row 0: inf 0 0; expected finite numbers' '/^array probe-vertex.position/,+3s/^-0.01.*/inf 0 0/'
refused "a corner that there is not" 'probe-face.vertex' '/^array probe-face.vertex/,+1s/^[0-9].*/0 1 8/'
refused "no corner at all" 'probe-face.vertex' '/^array probe-face.vertex/,+1s/^[0-9].*/0 1 -1/'
refused "no probe" 'the model has no probe to show; expected one from msds-run or tled-run with --probe' '/^meta probe.shape/d'
check "which only --show probe minds" sinew render --show voxels --size 60x40 -o "$T/bad.png" "$T/bad.sinew"

# ---- Seen through: --clear surface is every surface; a name stays a name.
sinew bind --unit mm tests/cli/cube.obj <"$T/once.sinew" >"$T/bound.sinew" 2>/dev/null
draw whole bound.sinew --show surface,probe
draw named bound.sinew --show surface,probe --clear cube
draw all bound.sinew --show surface,probe --clear surface
check "--clear surface is each of them" cmp "$T/all.png" "$T/named.png"
differ "and something" all whole

# ---- A probe that goes through and is out again at each pose has touched.
printf '%s\n' '0 -.02 .04 .036 1 0 0 0' '.2 .1 .04 .036 1 0 0 0' >"$T/through.tum"
check "a probe that goes through an edge between two poses" msds-run -d cpu --method msds --probe sphere:1cm --poses "$T/through.tum" -o "$T/run.sinew" <"$T/tets.sinew"
is "$(grep -c 'touches nothing' "$T/stderr"):$(sinew info --get node.displacement.max "$T/run.sinew" | awk '{ print ($1 > 5e-4) }')" 0:1 \
    "is not said to touch nothing, as springs moved by most of a millimetre"
sed 's/[.]036/.06/' "$T/through.tum" >"$T/above.tum"
fails 0 "one that goes above it is" 'the probe touches nothing in any frame \(2 in all\)' msds-run -d cpu --probe sphere:1cm --poses "$T/above.tum" -o /dev/null <"$T/tets.sinew"
check "finite elements are swept too" msds-run -d cpu --method fem --probe sphere:1cm --poses "$T/through.tum" -o "$T/run.sinew" <"$T/tets.sinew"
is "$(grep -c 'touches nothing' "$T/stderr"):$(sinew info --get node.displacement.max "$T/run.sinew" | awk '{ print ($1 > 0 && $1 < 1e-6) }')" 0:1 \
    "and not said to touch nothing; they are back by then"
done_testing
