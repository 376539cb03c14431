#!/bin/sh
# American spellings on command lines do what the British ones do, to the byte; second names of options and values; and neither spelling
# nor second name gets between a user and the user's own names.
. "$(dirname "$0")/lib.sh"

small=tests/cli/small.sinew
awk -f samples/shape.awk -f samples/muscle.awk >"$T/muscle.obj"
voxelise -q --unit mm -s 3 "$T/muscle.obj" >"$T/british"
voxelize -q --unit mm -s 3 "$T/muscle.obj" >"$T/american"
check "voxelize" cmp "$T/british" "$T/american"
sinew voxelize -q --unit mm -s 3 "$T/muscle.obj" >"$T/american"
check "sinew voxelize" cmp "$T/british" "$T/american"
fails 2 "a tool that is none in either spelling" "no tool 'voxelyze'; did you mean 'voxelise'" sinew voxelyze
is "$(voxelize --version | sed 's/ (.*//') $(voxelize --help | grep -c voxelize)" "voxelise 0" "it says its one name"

attach -q --fibre field <"$T/british" >"$T/fibres"
for option in '--fiber field' --fiber=field; do
    # shellcheck disable=SC2086 # an option and its value
    attach -q $option <"$T/british" >"$T/fibers"
    check "attach $option, provenance and all" cmp "$T/fibres" "$T/fibers"
done
attach -q --fibre centre <"$T/british" >"$T/centre"
attach -q --fiber center <"$T/british" >"$T/center"
check "attach --fiber center" cmp "$T/centre" "$T/center"
fails 2 "a value that is none in either spelling" "--fibre 'color': expected centre\|axis\|field" attach --fiber color <"$T/british"
fails 2 "an option that is none in either" "no option --center" attach --center 1 <"$T/british"

for key in element.fiber.rows element.fiber.at.0.2,0,0 muscle.center muscle.center.muscle_a quality.j.center; do
    is "$(sinew info --get $key "$small")" "$(sinew info --get "$(echo $key | sed 's/er/re/')" "$small")" "info --get $key"
done
is "$(sinew info --tsv quality.j.center "$small")" "$(sinew info --tsv quality.j.centre "$small")" "info --tsv, its heading too"
sed 's/muscle_a/center.a/; /^crc/d' "$small" >"$T/named"
is "$(sinew info --get volume.count.center.a "$T/named")" 1 "a volume whose name is spelled so"
fails 1 "whose name is not spelled in another way" "no key 'volume.count.centre.a'" sinew info --get volume.count.centre.a "$T/named"
is "$(sinew info --get muscle.center.center.a "$T/named")" "0 0.05 0.05" "behind a key that is"
sed 's/^array element.fibre/array element.fiber/; /^crc/d' "$small" >"$T/own"
is "$(sinew info --get element.fiber.type "$T/own") $(sinew diff "$T/own" "$T/own" --only element.fiber)" "f32 " "an array that has the American name"
sinew info --get element.fibre.type "$T/own" >"$T/stdout" 2>&1
is "$(grep -c 'has no element.fibre' "$T/stdout")" 1 "which is not ours"
for option in --only --abs --rel; do
    value=element.fiber
    [ $option = --only ] || value=$value=0.1
    check "diff $option $value" sinew diff $option $value "$small" "$small"
done
fails 2 "diff --only of what is no array" "" sinew diff --only element.color "$small" "$small"

for how in '--color element.fibre.x' '--colour element.fiber.x' '--color element.fiber.x'; do
    # shellcheck disable=SC2086
    sinew render --size 320x240 --show voxels $how -o "$T/a.png" "$small"
    sinew render --size 320x240 --show voxels --colour element.fibre.x -o "$T/b.png" "$small"
    check "render $how" cmp "$T/a.png" "$T/b.png"
done
sinew render --size 320x240 --show voxels,centers --clear voxels -o "$T/a.png" "$small"
sinew render --size 320x240 --show voxels,centres --clear voxels -o "$T/b.png" "$small"
check "render --show centers" cmp "$T/a.png" "$T/b.png"

# --equilibrium is --rest, --frame undeformed is --frame rest.
tled-run -q -d cpu --rest 1e-2 -c muscle=0.1 <"$T/fibres" >"$T/rest" 2>/dev/null
for option in '--equilibrium 1e-2' --equilibrium=1e-2 '--equi 1e-2'; do
    # shellcheck disable=SC2086
    tled-run -q -d cpu $option -c muscle=0.1 <"$T/fibres" >"$T/equilibrium" 2>/dev/null
    check "tled-run $option" cmp "$T/rest" "$T/equilibrium"
done
is "$(sinew info "$T/equilibrium" | grep -c -- '--rest 0.01')" 1 "whose provenance says --rest"
fails 2 "with another end" "three ways to end" tled-run --equilibrium 1e-2 -n 1 <"$small"
for format in vtu msh; do
    sinew export -f $format --frame rest "$small" >"$T/a"
    check "export -f $format --frame undeformed" sh -c "sinew export -f $format --frame undeformed $small | cmp - \$T/a"
done
fails 2 "undeformed and --deformed" "--frame undeformed selects none" sinew export -f vtu --deformed --frame undeformed "$small"
for how in '--frame undeformed' '--sheet undeformed'; do
    # shellcheck disable=SC2086
    sinew render --size 320x240 $how -o "$T/a.png" "$small"
    # shellcheck disable=SC2086
    sinew render --size 320x240 ${how%undeformed}rest -o "$T/b.png" "$small"
    check "render $how" cmp "$T/a.png" "$T/b.png"
done
fails 2 "what is no frame" "--frame 'unreformed': expected a frame's index, last, all, rest or undeformed" \
    sinew render --frame unreformed -o "$T/a.png" "$small"

# The undeformed state of an OBJ is the OBJ.
sinew bind -q "$T/muscle.obj" <"$T/fibres" 2>/dev/null >"$T/bound"
for frame in rest undeformed; do
    check "deform --frame $frame: as it was" sh -c "sinew deform --frame $frame \$T/muscle.obj <\$T/bound | cmp - \$T/muscle.obj"
done
sinew deform --frame rest --format pc2 -o "$T/rest.pc2" "$T/muscle.obj" <"$T/bound"
is "$(od -An -t d4 -j 28 -N 4 "$T/rest.pc2" | tr -d ' ')" 1 "a point cache of it has one sample"
done_testing
