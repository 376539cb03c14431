#!/bin/sh
# msds-run --skin: a surface apart from the tissue, carried in the model, in frames, in deform and in render.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

msds-mesh -q --nodes 7x7x4 --size 6cm,6cm,3cm >"$T/block.sinew"
# A sheet of 10 x 10 cm at the block's top, in mm, with normals.
awk 'BEGIN { n = 41; for (j = 0; j < n; j++) for (i = 0; i < n; i++) printf "v %g %g 30\n", -20 + 2.5 * i, -20 + 2.5 * j
    for (j = 0; j < n; j++) for (i = 0; i < n; i++) print "vn 0 0 1"
    print "g skin"
    for (j = 0; j + 1 < n; j++) for (i = 1; i < n; i++) { a = j * n + i; print "f " a "//" a " " a + 1 "//" a + 1 " " a + n + 1 "//" a + n + 1 " " a + n "//" a + n } }' >"$T/sheet.obj"
# Down 1 cm in half a second, half a second there, away, and four seconds more.
awk 'BEGIN { for (i = 0; i <= 300; i++) { t = i / 60; z = t < .5 ? .031 - .022 * t : t < 1 ? .02 : .1; printf "%.6f .03 .03 %.6f 1 0 0 0\n", t, z } }' >"$T/press.tum"

check "a skin" msds-run --unit mm --skin "$T/sheet.obj" --probe sphere:2cm --poses "$T/press.tum" -o "$T/skin.sinew" <"$T/block.sinew"
is "$(sed -n 's/.*\(skin sheet: .*\)/\1/p' "$T/stderr")" "skin sheet: 1681 vertices, 4880 springs" "its vertices, and a spring an edge"
is "$(sinew info --get axis.sheet/vertex "$T/skin.sinew")" 1681 "the model carries it"
sinew deform --frame 59 "$T/sheet.obj" --unit mm <"$T/skin.sinew" >"$T/down.obj"
lowest=$(awk '$1 == "v" && ($4 < low || !low) { low = $4 } END { print low }' "$T/down.obj")
near "$lowest" 20 1e-3 "deform: its lowest vertex is where the pole is, at $lowest mm"
awk '$1 == "v" { z[++n] = $4 } $1 == "vn" { l = $2 * $2 + $3 * $3 + $4 * $4; m++; bad += (l - 1) ^ 2 > 1e-12; tilted += $4 < .9; flat += $4 > .999 }
    END { exit bad || n != 1681 || m != 1681 || tilted < 20 || flat < 500 }' "$T/down.obj"
is $? 0 "deform: normals are unit vectors, tilted round the dent"
sinew deform "$T/sheet.obj" --unit mm <"$T/skin.sinew" >"$T/after.obj"
awk 'NR == FNR { if ($1 == "v") { x[++n] = $2; y[n] = $3; z[n] = $4 } next }
    $1 == "v" { d = sqrt(($2 - x[++k]) ^ 2 + ($3 - y[k]) ^ 2 + ($4 - z[k]) ^ 2); worst = d > worst ? d : worst } END { print worst; exit !(worst < 1e-4 * 100) }' \
    "$T/sheet.obj" "$T/after.obj" >"$T/worst"
is $? 0 "it is back at rest to $(cat "$T/worst") mm of 100, four seconds after the probe left"
check "render shows it" sinew render --show skin,probe --frame 59 --colour displacement --size 320x240 -o "$T/skin.png" "$T/skin.sinew"
check "the tissue goes as without a skin" sh -c "msds-run -q --probe sphere:2cm --poses '$T/press.tum' <'$T/block.sinew' >'$T/bare.sinew'; sinew diff --only node.displacement '$T/bare.sinew' '$T/skin.sinew'"
for n in 1 2 3; do
    msds-run -q --threads $n --unit mm --skin "$T/sheet.obj" --probe sphere:2cm --poses "$T/press.tum" <"$T/block.sinew" | cksum
done | sort -u >"$T/sums"
is "$(wc -l <"$T/sums" | tr -d ' ')" 1 "the same bytes by 1, 2 and 3 threads"

# In two parts: the second goes on from where the first left it.
sed -n 1,40p "$T/press.tum" >"$T/first.tum"
sed -n 41,60p "$T/press.tum" >"$T/second.tum"
msds-run -q --unit mm --skin "$T/sheet.obj" --probe sphere:2cm --poses "$T/first.tum" <"$T/block.sinew" >"$T/half.sinew"
check "goes on from frames" sh -c "msds-run -q --unit mm --skin '$T/sheet.obj' --probe sphere:2cm --poses '$T/second.tum' <'$T/half.sinew' >'$T/whole.sinew'"
is "$(sinew info --get frames "$T/whole.sinew")" 60 "all frames are there"

check "a skin of another unit" msds-run --unit m --skin "$T/sheet.obj" --probe sphere:2cm --poses "$T/first.tum" -o /dev/null <"$T/block.sinew"
is "$(grep -c 'presses the tissue, but touches the skin in no frame; expected sheet in the place of the tissue; check --unit' "$T/stderr")" 1 "is said to be away"
check "one of the right unit" msds-run --unit mm --skin "$T/sheet.obj" --probe sphere:2cm --poses "$T/first.tum" -o /dev/null <"$T/block.sinew"
is "$(grep -c 'the skin in no frame' "$T/stderr")" 0 "has no such word"
fails 1 "no unit" 'expected --unit' msds-run --skin "$T/sheet.obj" --probe sphere:2cm --poses "$T/press.tum" <"$T/block.sinew"
fails 1 "frames without a skin" 'has no sheet/vertex.displacement; expected it' msds-run --unit mm --skin "$T/sheet.obj" --poses "$T/second.tum" <"$T/bare.sinew"
printf 'v 0 0 0\nv 1 0 0\nl 1 2\n' >"$T/line.obj"
fails 1 "no polygons" 'surface line has no polygons' msds-run --unit mm --skin "$T/line.obj" --poses "$T/press.tum" <"$T/block.sinew"
done_testing
