#!/bin/sh
# The shapes of samples/, what W&M's Table 1 says of three of them, and samples/Makefile as users would call it. With SINEW_LONG an
# osteotomy and a scan too.
. "$(dirname "$0")/lib.sh"

have make || skip_all "no make"

# samples FOLDER WORD...: make in samples/, without what a make above said.
# shellcheck disable=SC2317 # called by name
samples() {
    folder=$1
    shift
    env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -s -C samples OUT="$folder" "$@"
}

# count MODEL KEY
count() {
    sinew info --get "$2" "$1"
}

check "the shapes are written" samples "$T/a" shapes
check "and again" samples "$T/b" shapes
for shape in sphere muscle block head; do
    check "$shape: the same bytes" cmp "$T/a/$shape.obj" "$T/b/$shape.obj"
done

check "models, two at a time" samples "$T/a" -j2 "$T/a/sphere.model" "$T/a/muscle.model" "$T/a/block.model" "$T/a/head.model"
while read -r shape elements nodes; do
    is "$(count "$T/a/$shape.model" axis.element) $(count "$T/a/$shape.model" axis.node)" "$elements $nodes" \
        "$shape: $elements elements, $nodes nodes"
done <<'END'
sphere 2176 2849
muscle 280 480
block 4800 6724
END
for shape in sphere muscle block head; do
    rigid=$(count "$T/a/$shape.model" node.rigid.sum)
    check "$shape: some nodes are rigid, not all" test "$rigid" -gt 0 -a "$rigid" -lt "$(count "$T/a/$shape.model" axis.node)"
done
for side in left right; do
    check "the head's $side muscle has elements" test "$(count "$T/a/head.model" volume.count.muscle_zyg_$side)" -gt 50
done

# The quick ones to their end: moved OBJ files and VTU.
check "the muscle and the block move" samples "$T/a" -j2 SHAPES='muscle block'
for shape in muscle block; do
    is "$(diff "$T/a/$shape.obj" "$T/a/$shape.moved.obj" | sed -n 's/^[<>] \([a-z#]*\) .*/\1/p' | sort -u | tr '\n' ' ')" "v vn " \
        "$shape: only v and vn lines differ"
    check "$shape: a VTU" grep -q '<VTKFile' "$T/a/$shape.vtu"
done

# Plots of both: tables of a run's energies and of a place's way, and pictures of them where there is gnuplot.
if have gnuplot; then
    check "plots" samples "$T/a" -j2 plots
    for shape in muscle block; do
        for plot in energy way; do
            check "$shape: $plot.png" sh -c "head -c 8 '$T/a/$shape.$plot.png' | grep -q PNG"
        done
        is "$(wc -l <"$T/a/$shape.way.tsv" | tr -d ' ')" 102 "$shape: a row each 2 ms, and a heading"
        check "$shape: a log to its end" sh -c "tail -n 1 '$T/a/$shape.log.tsv' | grep -q '^0.2[[:space:]]'"
    done
else
    skip 9 "no gnuplot"
fi

# The block that a ball presses, by both methods: what it says of the forces.
check "a press, two at a time" samples "$T/a" -f press.mk -j2 NODES=9x7x7
is "$(awk '!/^#/ { n++; if ($2 > springs) springs = $2; if ($3 > fem) fem = $3; if (n == 1 || n == 60) ends += $2 + $3 }
    END { print n, (springs > 1), (fem > 1), ends }' "$T/a/press.force")" "60 1 1 0" "60 poses: both push back while they are pressed, and not before and after"
near "$(awk '$1 == 1 { print $3 }' "$T/a/press.force")" "$(awk '$1 == 1.2 { print $3 }' "$T/a/press.force")" 0.001 \
    "the FEM's force is the same while the ball stays"
for method in msds fem; do
    check "press.$method: a VTU" grep -q '<VTKFile' "$T/a/press.$method.vtu"
    is "$(sinew info --get frames "$T/a/press.$method")" 60 "press.$method: a frame a pose"
done

# A folder of OBJ files, one of which is open: the others come out, that one leaves nothing behind.
mkdir "$T/in"
cp "$T/a/sphere.obj" "$T/in/ball.obj"
grep -v '^f 1/' "$T/a/sphere.obj" >"$T/in/open.obj"
fails 2 "a folder with an open surface" "open edges" \
    samples "$T/c" -k -j2 IN="$T/in" VOXELISE='--unit mm -s 12.5' RUN='-n 3 -g 0,-9.81,0'
messages=$(grep -c 'open edges' "$T/stderr")
check "the good one is done" test -s "$T/c/ball.moved.obj"
is "$(find "$T/c" -name 'open*')" "" "the bad one left no file"
is "$messages" 1 "one message for it"

if [ "$SINEW_LONG" ]; then
    # An osteotomy: the upper jaw moves the lip above it forward, the chin moves back; nothing moves further than bone does.
    check "an osteotomy" samples "$T/o" osteotomy OSTEOTOMY_SIDE=8 OSTEOTOMY_COARSE=10
    # shellcheck disable=SC2016 # awk's
    check "the upper lip goes forward, up to 3 mm, the chin back, up to 2.3 mm" \
        awk '/^From B/ { exit } $1 == "upper_lip" { lip = $8 > 1 && $8 < 3.3 && $9 < -1 } $1 == "chin" { chin = $8 > 1 && $8 < 2.5 && $9 > 1 } END { exit !(lip && chin) }' \
        "$T/o/osteotomy.moved.txt"
    # shellcheck disable=SC2016 # likewise
    check "and the prediction of larger voxels is not far" awk '/lip|nose|chin|cheeks/ { near += $4 < 1 } END { exit near != 5 }' "$T/o/osteotomy.voxels.txt"
else
    skip 3 "an osteotomy takes seconds: SINEW_LONG is not set"
fi

# A case: DICOM files to a volume, labels, surfaces and a mesh, and a probe that presses it. Volumes are known from the equations.
check "a case of a patient" samples "$T/d" case
C=$T/d/case
# volume FILE GROUP: what a group's triangles enclose.
volume() {
    awk -v group="$2" '$1 == "g" { on = $2 == group } $1 == "v" { x[++n] = $2; y[n] = $3; z[n] = $4 }
        $1 == "f" && on { a = $2; b = $3; c = $4
            sum += x[a] * (y[b] * z[c] - z[b] * y[c]) + y[a] * (z[b] * x[c] - x[b] * z[c]) + z[a] * (x[b] * y[c] - y[b] * x[c]) }
        END { print sum / 6 }' "$1"
}
near "$(volume "$C/surfaces.obj" bone)" 9651 .03 "the bone's volume"
near "$(volume "$C/surfaces.obj" vein)" 1508 .03 "the vein's"
near "$(volume "$C/surfaces.obj" artery)" 942 .06 "the artery's, of 32 pixels a slice"
# height FILE: of the vein, amid the volume.
height() {
    awk '$1 == "g" { on = $2 == "vein" } $1 == "v" && on && $4 * $4 < 1 { if (!n++ || $3 < low) low = $3; if ($3 > high) high = $3 }
        END { print high - low }' "$1"
}
check "the vein is pressed from $(height "$C/surfaces.obj") to $(height "$C/pressed.obj") mm" awk \
    "BEGIN { exit !($(height "$C/pressed.obj") < .9 * $(height "$C/surfaces.obj")) }"
is "$(cat "$C"/dicom/*.dcm | grep -ac Nobody) $(find "$C" -maxdepth 1 -type f -exec cat {} + | grep -ac -e Nobody -e 2.25.4242)" "48 0" \
    "the patient's name is in the DICOM files only"

# The arm, in a coarse mesh: the vein collapses, the artery does not.
check "the arm is pressed" env NODES=25x7x13 HZ=10 SINEW_BIN="$(dirname "$(command -v sinew)")" samples/arm "$T/arm"
awk 'NR == 2 { for (i = 3; i <= 6; i++) at[i] = $i }
    $1 == 1.5 { line = $0; bad = !($3 < .5 * at[3] && $4 > .8 * at[4] && $5 < .5 * at[5] && $6 > .8 * at[6] && $7 > .5 && $8 > .5); seen = 1 }
    END { print line; exit bad || !seen || NR != 27 }' "$T/arm/areas.tsv" >"$T/areas"
is $? 0 "areas and forces, deepest: $(cat "$T/areas")"
for picture in arm skin; do
    check "a picture: $picture.png" sh -c "head -c 8 '$T/arm/$picture.png' | grep -q PNG"
done
if have gnuplot; then
    for picture in areas fold; do
        check "a plot: $picture.png" sh -c "head -c 8 '$T/arm/$picture.png' | grep -q PNG"
    done
else
    skip 2 "no gnuplot"
fi

if [ "$SINEW_LONG" ]; then
    # From a volume to images of the arm: an image a pose; the vein all but closes in them, the artery does not, and both come back.
    check "a scan" env IMAGES=24 SINEW_BIN="$(dirname "$(command -v sinew)")" samples/scan "$T/scan"
    is "$(find "$T/scan" -name 'arm_00??.png' | grep -c .)" 25 "an image a pose"
    awk 'NR == 2 { vein = $2; artery = $3 } NR > 1 && (NR == 2 || $2 < least) { least = $2; then = $3 }
        END { printf "%.2f %.2f", least / vein, then / artery; exit !(least < .3 * vein && then > .85 * artery && $2 == vein && $3 == artery) }' \
        "$T/scan/arm_areas.tsv" >"$T/left"
    is $? 0 "what is left of vein and artery: $(cat "$T/left")"
    check "the image in space" sh -c "head -c 8 '$T/scan/arm_space.png' | grep -q PNG"
else
    skip 4 "a scan takes seconds: SINEW_LONG is not set"
fi

# Landmarks: the nearest vertex of the skin, though one of the skull is nearer, and how far it goes in each file.
printf 'chin 0.9 0 0 # a comment\ntip 0 2 0\n' >"$T/landmarks"
printf 'v 1 0 0\nv 0 2 0\nv 0 0 1\nv .9 0 0\ng skin_of_face\nf 1 2 3\ng skull\nf 4 2 3\n' >"$T/rest.obj"
printf 'v 4 4 12\nv 0 2 0\nv 0 0 1\nv 9 9 9\n' >"$T/laugh.obj"
printf 'v 1 0 0\nv 0 0 0\nv 0 0 1\nv 9 9 9\n' >"$T/cry.obj"
is "$(awk -f samples/landmarks.awk "$T/landmarks" "$T/rest.obj" "$T/laugh.obj" "$T/cry.obj" | tr '\t\n' ' /')" \
    "expression chin.x chin.y chin.z chin tip.x tip.y tip.z tip/laugh 3.00 4.00 12.00 13.00 0.00 0.00 0.00 0.00/cry 0.00 0.00 0.00 0.00 0.00 -2.00 0.00 2.00/" \
    "landmarks of two expressions"

fails 2 "a folder without OBJ files" "no OBJ file in .*expected IN=folder" make -C samples IN="$T/none"
done_testing
