#!/bin/sh
# bind --self-contact and tled-run: skin that touches itself. Distances beside planes, a slit block that is closed, balls that meet, a block on
# a slope; bytes, and what is refused.
. "$(dirname "$0")/lib.sh"

here=$(dirname "$0")

# ---- what bind writes: two blocks of 40 x 40 x 20 mm that touch at z = 0
awk -v boxes='lower 0,40,0,40,-20,0,8,8; upper 0,40,0,40,0,20,8,8' -f "$here/boxes.awk" >"$T/two.obj"
voxelise -q --unit mm -s 2.5 --fraction 4 "$T/two.obj" >"$T/two" 2>/dev/null
sinew bind -q --self-contact two <"$T/two" >"$T/touching" 2>"$T/said"
is "$(cat "$T/said")" "" "bind says nothing with -q"
is "$(sinew export -f model --text "$T/touching" | awk '
    /^array/ { name = $2; i = 0; next }
    /^crc|^end|^axis|^meta/ { next }
    name == "node.position" { x[i] = $1; y[i] = $2; z[i++] = $3 }
    name == "element.node" { for (j = 1; j <= 8; j++) { middle[$j] += z[$1] + .00125; count[$j]++ } }
    name == "skin.node" { node[i++] = $1 }
    name == "skin.distance" {
        n = node[i++]
        side = middle[n] > 0 ? 1 : -1 # of the slit
        d = .02
        if (x[n] < d) d = x[n]
        if (y[n] < d) d = y[n]
        if (.04 - x[n] < d) d = .04 - x[n]
        if (.04 - y[n] < d) d = .04 - y[n]
        if (side * z[n] < d) d = side * z[n]
        if (.02 - side * z[n] < d) d = .02 - side * z[n]
        off = $1 + d
        if (off * off > 1e-16) bad++
        rows++
    }
    END { print bad + 0, (rows > 4000) }')" "0 1" "distances of nodes on both sides of a slit are from the skin of their own part"
sinew bind -q --self-contact upper:9mm,9mm,-1mm,31mm,31mm,1mm --contact-spacing 1.25 <"$T/two" >"$T/box"
is "$(get axis.contact "$T/box")" 545 "samples on vertices, edges and in triangles of a box"
sinew bind -q --self-contact 'low*,upper' <"$T/two" >"$T/names"
sinew bind -q --motion element --self-contact lower,upper <"$T/two" >"$T/own" 2>/dev/null
is "$(get contact.blended.min "$T/touching") $(sinew info "$T/own" | grep -c contact.blended)" "1 0" "samples move blended, or with their elements alone as vertices do"
is "$(get axis.contact "$T/names")" "$(get axis.contact "$T/touching")" "by names of groups, or of the surface"
sinew bind -q --self-contact auto <"$T/two" >"$T/auto"
is "$(get axis.contact "$T/auto")" "$(get axis.contact "$T/touching")" "auto: all that is within 8 voxels of the slit"
sinew bind -q <"$T/touching" >"$T/again"
is "$(get axis.contact "$T/again")" "$(get axis.contact "$T/touching")" "bind without the option keeps the samples"

fails 2 "an unknown surface" "unknown surface 'lips'" sinew bind --self-contact lips <"$T/two"
fails 2 "a comma at the end" "expected names of surfaces" sinew bind --self-contact lower, <"$T/two"
fails 2 "a colon at the end" "expected SURFACE" sinew bind --self-contact lower: <"$T/two"
fails 2 "a box that is empty" "the box is empty" sinew bind --self-contact lower:0,0,0,0,1,1 <"$T/two"
fails 2 "five lengths" "expected a region" sinew bind --self-contact lower:0,0,0,0,1 <"$T/two"
fails 1 "a region elsewhere" "none of the [0-9]* triangles" sinew bind --self-contact lower:90,90,90,91,91,91 <"$T/two"
fails 1 "a file that is not there" "nowhere.obj" sinew bind --self-contact "lower:$T/nowhere.obj" <"$T/two"
fails 2 "a spacing alone" "is for samples of --self-contact" sinew bind --contact-spacing 1mm <"$T/two"
fails 2 "no spacing" "above 0" sinew bind --self-contact lower --contact-spacing 0 <"$T/two"
awk -v boxes='skin 0,20,0,20,0,10,4,4' -f "$here/boxes.awk" >"$T/one.obj"
voxelise -q --unit mm -s 5 "$T/one.obj" >"$T/one" 2>/dev/null
fails 2 "auto without slits" "the model has none" sinew bind --self-contact auto <"$T/one"
printf 'g skull\nv 0 0 0\nv 20 0 0\nv 20 20 0\nv 0 20 0\nf 4 3 2 1\n' >"$T/skull.obj"
attach -q --rigid-file "$T/skull.obj" <"$T/one" 2>/dev/null | sinew bind -q "$T/skull.obj" >"$T/rigid"
fails 1 "a surface that is rigid" "is rigid" sinew bind --self-contact skull <"$T/rigid"
msds-mesh -q <"$T/touching" 2>"$T/said" >"$T/tets"
check "tetrahedra do not have it, which is said" grep -q "does not in tetrahedra" "$T/said"
fails 2 "a run to rest" "expected -t or -n" tled-run --rest 1e-3 <"$T/touching"

# ---- closed: blocks 5 mm apart, held below and pushed down by 9 mm above
awk -v boxes='slit 0,40,0,40,-20,0,8,8; slit 0,40,0,40,5,25,8,8' -f "$here/boxes.awk" >"$T/slit.obj"
cat >"$T/close" <<'SCRIPT'
0   displace -9mm,-9mm,-30mm,49mm,49mm,-17mm 0,0,0
0   displace -9mm,-9mm,22mm,49mm,49mm,35mm   0,0,0
0.1 displace -9mm,-9mm,22mm,49mm,49mm,35mm   0,0,-9mm
SCRIPT
voxelise -q --unit mm -s 4 --fraction 4 "$T/slit.obj" 2>/dev/null | sinew bind -q --self-contact slit >"$T/slit"
shut() {
    tled-run -q -d cpu -m tissue.E=3000 -t 0.13 --script "$T/close" "$@" 2>/dev/null
}
# Of a result: the least gap in voxels away from the sides, and the mean height of both sides, mm
gap() {
    sinew deform -q "$T/slit.obj" <"$1" | awk '
        /^v / { z[++n] = $4 }
        END {
            if (!n) exit
            least = 9
            for (j = 2; j < 7; j++)
                for (i = 2; i < 7; i++) {
                    a = z[81 + 9 * j + i + 1]
                    b = z[162 + 9 * j + i + 1]
                    if (b - a < least) least = b - a
                    sum += (a + b) / 2
                    k++
                }
            printf "%.6f %.6f\n", least / 4, sum / k
        }'
}
shut <"$T/slit" >"$T/shut"
# shellcheck disable=SC2046
set -- $(gap "$T/shut")
check "the gap is at least -.05 of a voxel ($1)" awk -v g="$1" 'BEGIN { exit !(g != "" && g > -.05 && g < .02) }'
below "$(awk -v z="$2" 'BEGIN { print z + 2 }')" .05 "and both sides give way alike, as they are mirrored"
shut --threads 1 <"$T/slit" >"$T/alone"
check "any number of threads, the same bytes" cmp "$T/shut" "$T/alone"
shut --precision single <"$T/slit" >"$T/single"
# shellcheck disable=SC2046
set -- $(gap "$T/single")
check "in single precision too ($1)" awk -v g="$1" 'BEGIN { exit !(g != "" && g > -.05 && g < .02) }'
sinew bind -q --self-contact slit --contact-spacing 2mm <"$T/slit" | shut >"$T/dense"
# shellcheck disable=SC2046
set -- $(gap "$T/dense")
check "and at least -.025 with samples half as far apart ($1)" awk -v g="$1" 'BEGIN { exit !(g != "" && g > -.025 && g < .02) }'

part() {
    tled-run -q -d cpu --dt 8e-5 --every 0.05 --script "$T/close" "$@" 2>/dev/null
}
part -t 0.1 <"$T/slit" >"$T/whole"
part -t 0.05 <"$T/slit" | part -t 0.05 >"$T/parts"
check "in two parts, the same frames" sinew diff "$T/whole" "$T/parts"
cut_off "$T/point" \
    tled-run -q -d cpu -m tissue.E=3000 -t 0.13 --script "$T/close" --checkpoint "$T/point" --checkpoint-every .02 -o "$T/cut" \
    <"$T/slit"
shut --restart "$T/point" --checkpoint "$T/point" -o "$T/cut" <"$T/slit"
is "$(cmp "$T/shut" "$T/cut" 2>&1)" "" "and a run that was cut off goes on to the same bytes"
shut --every 5e-5 <"$T/slit" | sinew info --get node.displacement.max >"$T/each"
is "$(cat "$T/each")" "$(get node.displacement.max "$T/shut")" "however many frames are written on the way"

# ---- skin that is crushed: a dozen plates, moved to one place
boxes=$(awk 'BEGIN { for (k = 0; k < 12; k++) printf "%slayers 0,20,0,20,%d,%d,4,4", k ? ";" : "", 15 * k, 15 * k + 10 }')
awk -v boxes="$boxes" -f "$here/boxes.awk" >"$T/plates.obj"
awk 'BEGIN {
    for (k = 1; k < 12; k++) {
        plate = sprintf("displace -1,-1,%dmm,1,1,%dmm", 15 * k - 2, 15 * k + 12)
        print 0, plate, "0,0,0"
        print .02, plate, "0,0,-" 15 * k "mm"
    }
}' >"$T/crush"
voxelise -q --unit mm -s 5 "$T/plates.obj" 2>/dev/null | sinew bind -q --self-contact layers >"$T/plates"
tled-run -d cpu -t .03 --script "$T/crush" <"$T/plates" 2>"$T/said" >"$T/out"
check "elements near more than 64 others are told" grep -q 'warning: [1-9][0-9]* elements of skin had more than 64 other elements near them' "$T/said"
is "$(tled-run -q -d cpu -t .13 --script "$T/close" -m tissue.E=3000 <"$T/slit" 2>&1 >/dev/null)" "" "and none where there are none"

# ---- two balls of 20 mm meet, one a little aside
awk -v R=20 -v GAP=1 -v OFF=6 -f "$here/balls.awk" >"$T/balls.obj"
voxelise -q --unit mm -s 4 --fraction 4 "$T/balls.obj" 2>/dev/null | sinew bind -q --self-contact balls >"$T/balls"
tled-run -q -d cpu -m tissue.E=3000 --damping 0 -n 1 --dt 1e-5 --every 1e-5 --text <"$T/balls" 2>/dev/null |
    awk -v frames=2 -v LEFT=.3 -v RIGHT=-.1 -f "$here/swift.awk" >"$T/swift"
tled-run -q -d cpu -m tissue.E=3000 --damping 0 -t 0.06 --text --log "$T/balls.tsv" <"$T/swift" >"$T/met" 2>/dev/null
# shellcheck disable=SC2046
set -- $(awk -v least=.03 -f "$here/momentum.awk" "$T/swift") $(awk -v least=.03 -f "$here/momentum.awk" "$T/met")
check "they have momentum before ($1)" awk -v a="$1" -v all="$4" 'BEGIN { exit !(a / all > .4 && a / all < .6) }'
below "$(awk -v a="$1" -v b="$5" -v all="$4" 'BEGIN { print (b - a) / all }')" 1e-9 "and as much after"
below "$(awk -v a="$6" -v all="$4" 'BEGIN { print a / all }')" 1e-9 "none aside"
below "$(awk -v a="$7" -v all="$4" 'BEGIN { print a / all }')" 1e-9 "and none up"
check "some of which went aside in each, as they meet aside" awk -v a="$4" -v b="$8" 'BEGIN { exit !(b < .95 * a) }'
is "$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    NR == 2 { first = $at["kinetic/J"] }
    { last = $at["balance/J"] / first }
    END { print (last < .005 && last > -.03 ? "kept" : last) }' "$T/balls.tsv")" kept "energy: less by at most 3 %, and no more"

# ---- a slope of 30 degrees, without damping
awk -v boxes='ramp 0,40,0,20,-5,0,8,4; ramp 5,15,5,15,0,5,2,2' -f "$here/boxes.awk" >"$T/ramp.obj"
voxelise -q --unit mm -s 2.5 --fraction 4 "$T/ramp.obj" 2>/dev/null | sinew bind -q --self-contact ramp >"$T/ramp"
echo '0 displace -1mm,-1mm,-6mm,41mm,21mm,-2mm 0,0,0' >"$T/hold"
slides() { # MU
    tled-run -q -d cpu -m tissue.E=6e4 --damping 0 --friction "$1" -t 0.02 -g 4.905,0,-8.4957 --ramp 0 --script "$T/hold" \
        --tsv node.displacement.at.10mm,10mm,5mm --log "$T/slides.tsv" <"$T/ramp" 2>/dev/null >/dev/null
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /displacement.at.*x\/m/) at = i; next } { a = 2 * $at / ($1 * $1) } END { print a }' "$T/slides.tsv"
}
slid=$(slides 0)
below "$(awk -v a="$slid" 'BEGIN { print a / 4.905 - 1 }')" .01 "a block slides by g sin"
slid=$(slides .1)
below "$(awk -v a="$slid" 'BEGIN { print a / (4.905 - .84957) - 1 }')" .02 "by g (sin - mu cos)"
slid=$(slides 2)
check "and hardly by friction of 2 ($slid)" awk -v a="$slid" 'BEGIN { exit !(a < .6) }'
fails 2 "friction of nothing" "bind --self-contact" tled-run --friction .1 -t 0.001 <"$T/one"

# ---- lips of a real face that are pursed, as expressions.mk has them: pairs of triangles of the skin that cross, and the deepest, mm
pursed() {
    tled-run -q -d cpu --precision single -m muscle.peak=3e5 --script "$T/purse" --expressions samples/face.expressions \
        --rise-fall 0.01,0.04 -t 0.35 <"$T/$1/face_all.expressions.model" 2>"$T/said" | sinew deform -q "$T/$1/face_all.jaw.obj" >"$T/pursed.obj"
    /usr/bin/python3 "$here/crossing.py" skin "$T/pursed.obj"
}
if [ "$SINEW_LONG" ] && [ -n "$DATA" ] && [ -f "$DATA/face/face_all.obj" ] && /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    printf '0 contract @pucker 0\n0.1 contract @pucker 1\n' >"$T/purse"
    for lips in apart together; do
        set -- # as expressions.mk has lips, or none that touch
        [ $lips = together ] || set -- EXPRESSIONS_LIPS=
        env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -s -C samples OUT="$T/$lips" FACE="$(realpath "$DATA")/face/face_all.obj" "$@" \
            "$T/$lips/face_all.expressions.model" 2>"$T/said"
    done
    pursed apart >"$T/crossing"
    # shellcheck disable=SC2016 # of awk
    check "lips pass through each other without it: $(cat "$T/crossing")" awk '{ exit !($2 > .5) }' "$T/crossing"
    pursed together >"$T/crossing"
    # shellcheck disable=SC2016 # of awk
    check "with it no pair is deeper than .2 mm: $(cat "$T/crossing")" awk '{ exit !($2 < .2) }' "$T/crossing"
else
    skip 2 "lips of a real face take a minute: SINEW_LONG is not set, or there is no face or no numpy"
fi
done_testing
