#!/bin/sh
# us-slice: native planes give native pixels; VTK's slices; fans and knobs against closed forms; thickness, labels, polygons, a body; frames of
# msds-run, live; what is wrong. With SINEW_LONG more planes of real volumes.
. "$(dirname "$0")/lib.sh"

# volume EXPRESSION: 12 x 10 x 8 voxels of 1 mm, the first's centre at 0, each this awk expression of i, j, k.
volume() {
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 10 8' \
        'space directions: (1,0,0) (0,1,0) (0,0,1)' 'kinds: domain domain domain' 'encoding: text' 'space origin: (0,0,0)' ''
    awk "BEGIN { for (k = 0; k < 8; k++) for (j = 0; j < 10; j++) for (i = 0; i < 12; i++) print int($1) }"
}

# pixels FILE: of the first PGM in it, one a line.
pixels() {
    awk 'NR == 3 { print $1 * $2; exit }' "$1" >"$T/count"
    skip=$(head -n 4 "$1" | wc -c)
    tail -c +$((skip + 1)) "$1" | head -c "$(cat "$T/count")" | od -An -v -tu1 -w1
}

volume '(i * 37 + j * 91 + k * 53 + i * j * k) % 256' >"$T/noise.nrrd"

# Columns along x, rows along z: the plane at y = 4 mm. Pixels are voxels: the face is half a voxel before the first.
echo '0 .0055 .004 -.0005 0 0 0 1' >"$T/native.tum"
check "a native plane" us-slice --rigid --poses "$T/native.tum" --size 12x8 --width 12mm --depth 8mm -o "$T/native.pgm" "$T/noise.nrrd"
sed '1,/^$/d' "$T/noise.nrrd" | awk 'int((NR - 1) / 12) % 10 == 4' >"$T/want"
pixels "$T/native.pgm" | tr -d ' ' | cmp -s - "$T/want"
is $? 0 "gives the native pixels"
is "$(sed -n 2p "$T/native.pgm")" "# us-slice: 0 0.004 0 0.001 0 0 0 0 0.001" "and says where they lie"

# As 16-bit numbers, as floats through a window, and by frames of a mesh at rest.
sed 's/type: uint8/type: int16/' "$T/noise.nrrd" >"$T/short.nrrd"
us-slice --rigid --poses "$T/native.tum" --size 12x8 --width 12mm --depth 8mm "$T/short.nrrd" | cmp -s - "$T/native.pgm"
is $? 0 "the same from int16 within 0 to 255"
awk 'done { print $1 * 4 - 100; next } { print } /^$/ { done = 1 }' "$T/noise.nrrd" | sed 's/type: uint8/type: float/' >"$T/float.nrrd"
us-slice -q --rigid --window=-100,920 --poses "$T/native.tum" --size 12x8 --width 12mm --depth 8mm "$T/float.nrrd" | cmp -s - "$T/native.pgm"
is $? 0 "and from floats through a window"
msds-mesh -q --nodes 5x4x4 --like "$T/noise.nrrd" -o "$T/mesh.sinew"
us-slice --poses "$T/native.tum" --size 12x8 --width 12mm --depth 8mm "$T/noise.nrrd" <"$T/mesh.sinew" | cmp -s - "$T/native.pgm"
is $? 0 "and through a mesh at rest"
check "a PNG a pose" us-slice --rigid --poses "$T/native.tum" -o "$T/p_%02d.png" "$T/noise.nrrd"
is "$(head -c 4 "$T/p_00.png" | tail -c 3)" PNG "is one"

# real FILE K: a pose and options for the native plane K of a NRRD, and its pixels: tests/cli/native.py.
# shellcheck disable=SC2317 # called by name
real() {
    # shellcheck disable=SC2046
    us-slice -q --rigid --poses "$T/plane.tum" $(python3 tests/cli/native.py "$1" "$2" "$T/plane") -o "$T/plane.pgm" "$1" &&
        tail -c "$(wc -c <"$T/plane.raw")" "$T/plane.pgm" | cmp -s - "$T/plane.raw"
}
if [ -n "$DATA" ] && have python3; then
    us-import -q "$DATA/ultrasound/fetal-head" -o "$T/head.nrrd" 2>/dev/null
    us-import -q "$DATA/ultrasound/SpinePhantomFreehandReconstructed.mha" -o "$T/spine.nrrd"
    for k in 0 ${SINEW_LONG:+40 76} 152; do
        check "the fetal head's plane $k is native to the pixel" real "$T/head.nrrd" "$k"
    done
    for k in 0 ${SINEW_LONG:+30} 103; do
        check "the spine phantom's plane $k" real "$T/spine.nrrd" "$k"
    done
else
    skip 4 "the shared data or python3 are missing"
fi

# VTK's own slices, oblique: Debian's python3, which has it.
# shellcheck disable=SC2317 # called by name
vtk() {
    us-slice -q --rigid --poses "$T/oblique.tum" --size 300x200 --width "$2" --depth "$3" -o "$T/oblique.pgm" "$1" &&
        /usr/bin/python3 tests/cli/reslice.py "$1" "$T/oblique.pgm" >"$T/off"
}
if /usr/bin/python3 -c 'import vtkmodules.vtkIOImage' 2>/dev/null; then
    echo '0 .005 .004 -.001 .1 .2 .3 .92736185' >"$T/oblique.tum"
    us-import -q "$T/noise.nrrd" -o "$T/packed.nrrd"
    vtk "$T/packed.nrrd" 15mm 11mm
    is "$(awk '{ print ($1 < .5 && $3 > 5000) }' "$T/off")" 1 "vtkImageReslice agrees to under half a grey level: $(cat "$T/off")"
    if [ -n "$DATA" ]; then
        echo '0 0 0 -.05 .1 .2 .3 .92736185' >"$T/oblique.tum"
        vtk "$T/head.nrrd" 9cm 9cm
        is "$(awk '{ print ($1 < .5 && $3 > 20000) }' "$T/off")" 1 "on the fetal head: $(cat "$T/off")"
        echo '0 -.038 .19 .03 .1 .2 .3 .92736185' >"$T/oblique.tum"
        vtk "$T/spine.nrrd" 9cm 9cm
        is "$(awk '{ print ($1 < .5 && $3 > 5000) }' "$T/off")" 1 "on the spine phantom: $(cat "$T/off")"
    else
        skip 2 "the shared data are missing"
    fi
else
    skip 3 "Debian's python3-vtk9 is not installed"
fi

# Fans, over a volume that is 200 everywhere: the area of the sector, and its ends on the middle column.
printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'sizes: 2 2 2' 'space directions: (1000,0,0) (0,1000,0) (0,0,1000)' \
    'space: left-posterior-superior' 'encoding: text' 'space origin: (-500,-500,-500)' '' '200 200 200 200 200 200 200 200' >"$T/flat.nrrd"
echo '0 0 0 0 0 0 0 1' >"$T/zero.tum"
flat() {
    us-slice -q --rigid --poses "$T/zero.tum" "$@" -o "$T/flat.pgm" "$T/flat.nrrd"
}
# fan NAME PROBE RADIUS ANGLE: at 4 cm of depth, in 400 x 400 pixels.
fan() {
    flat --probe "$2" --depth 4cm --size 400x400
    pixels "$T/flat.pgm" >"$T/list"
    awk -v r="$3" -v a="$4" '{ n += $1 == 200; other += $1 != 200 && $1 != 0
            if ((NR - 1) % 400 == 199) { if ($1) { if (!first) first = row + 1; last = row + 1 }; row++ } }
        END {
            pi = atan2(0, -1); h = a * pi / 360; d = .04
            top = r * (cos(h) - 1); width = 2 * (r + d) * sin(h); height = d - top
            want = h * ((r + d) ^ 2 - r ^ 2) / (width * height) * 160000
            down = -top / height * 400 + .5
            print (other == 0 && n > .995 * want && n < 1.005 * want), (first - down >= -1.01 && first - down <= 2.01), last == 400
        }' "$T/list" >"$T/fan"
    is "$(cat "$T/fan")" "1 1 1" "$1: the sector's area; from the face to the depth along the middle"
}
fan "a curved array" curved:3cm,60,1cm .03 60
fan "a wide one" curved:1cm,120,5mm .01 120
fan "a phased array" phased:90 0 90
fan "half a disc" phased:180 0 180
flat --probe linear:4cm,1cm --depth 4cm --size 40x40
is "$(pixels "$T/flat.pgm" | sort -u | tr -d ' \n')" 200 "a linear array fills its image"
is "$(sed -n 2p "$T/flat.pgm" | cut -d ' ' -f 3-)" "-0.0195 0 0.0005 0.001 0 0 0 0 0.001" "from its face on"

# To scale by itself: the side that is not given follows from width and depth, even; what is given stands, and is said to be stretched.
sides() {
    head -c 300 "$1" | sed -n 3p
}
flat
is "$(sides "$T/flat.pgm")" "512 640" "512 columns of 4 cm, and as many rows as 5 cm have"
is "$(sed -n 2p "$T/flat.pgm" | awk '{ print ($6 == $11), $6 }')" "1 7.8125e-05" "pixels are square"
flat --size 99 --depth 3cm
is "$(sides "$T/flat.pgm")" "99 74" "columns alone: an even number of rows"
flat --size x99 --depth 3cm
is "$(sides "$T/flat.pgm")" "132 99" "rows alone"
flat --probe curved:3cm,60,1cm --depth 4cm
is "$(sides "$T/flat.pgm")" "512 322" "a fan: 7 cm wide, 4.4019 high" # 512 x 44.019 / 70 = 321.97
us-slice --rigid --poses "$T/zero.tum" --size 512x512 -o "$T/flat.pgm" "$T/flat.nrrd" 2>"$T/said"
is "$(sides "$T/flat.pgm") $(grep -c 'pixels are 0.07812 mm wide and 0.09766 mm high: the image is not to scale; --size 512 is' "$T/said")" \
    "512 512 1" "two sides are taken as they are, and said"
us-slice --rigid --poses "$T/zero.tum" --size 512x640 -o "$T/flat.pgm" "$T/flat.nrrd" 2>"$T/said"
is "$(grep -c 'to scale' "$T/said")" 0 "unless they are to scale"
us-slice --rigid --poses "$T/zero.tum" --width 1m --depth 1um -o "$T/flat.pgm" "$T/flat.nrrd" 2>"$T/said"
is "$(sides "$T/flat.pgm") $(grep -c 'wide and 0.0005 mm high: the image is not to scale; more pixels are' "$T/said")" "512 2 1" "nor are rows that could only be two"
fails 2 "a side of too many" 'an image of 1 x 9000 mm, in pixels that are square, has a side of 4608000; expected at most 16384' \
    us-slice --rigid --poses "$T/zero.tum" --width 1mm --depth 9m "$T/flat.nrrd"
# phys FILE: pixels a metre along x and y, and the unit, of a PNG's chunk pHYs.
phys() {
    tail -c +42 "$1" | head -c 9 | od -An -v -tu1 | awk '{ print (($1 * 256 + $2) * 256 + $3) * 256 + $4, (($5 * 256 + $6) * 256 + $7) * 256 + $8, $9 }'
}
us-slice -q --rigid --poses "$T/zero.tum" --size 400x100 --probe linear:4cm,1cm --depth 2cm -o "$T/phys_%d.png" "$T/flat.nrrd"
is "$(tail -c +38 "$T/phys_0.png" | head -c 4) $(phys "$T/phys_0.png")" "pHYs 10000 5000 1" "a PNG says how large it is, along each side: .1 and .2 mm a pixel"
if /usr/bin/python3 -c 'import vtkmodules.vtkIOImage' 2>/dev/null; then
    /usr/bin/python3 -c 'import sys
from vtkmodules.vtkIOImage import vtkPNGReader
r = vtkPNGReader()
r.SetFileName(sys.argv[1])
r.Update()
print(r.GetOutput().GetDimensions(), r.GetOutput().GetScalarRange())' "$T/phys_0.png" >"$T/read"
    is "$(cat "$T/read")" "(400, 100, 1) (200.0, 200.0)" "and VTK reads it"
else
    skip 1 "Debian's python3-vtk9 is not installed"
fi

# Knobs: level 200 of 60 dB is -12.94 dB.
knob() {
    name=$1 want=$2
    shift 2
    flat --depth 4cm --size 4x4 "$@"
    is "$(pixels "$T/flat.pgm" | awk 'NR % 4 == 1 { printf "%s%d", s, $1; s = " " }')" "$want" "$name"
}
knob "6 dB more" "226 226 226 226" --gain 6
knob "more than white" "255 255 255 255" --gain 40
knob "less than black" "0 0 0 0" --gain -60
knob "gain by depth" "181 194 206 219" --tgc=-6,6
knob "a curve of it" "206 219 219 206" --tgc=0,6,0
knob "30 dB shown" "145 145 145 145" --dynamic-range 30
knob "as recorded with 40 dB" "182 182 182 182" --dynamic-range 30,40

# A ramp along y, the beam's thickness: means of slices are those of the ramp; at the volume's end the black beyond comes in.
volume '20 * j' >"$T/ramp.nrrd"
thick() {
    us-slice -q --rigid --poses "$T/thick.tum" --size 4x4 --width 2mm --depth 2mm "$@" -o "$T/thick.pgm" "$T/ramp.nrrd"
    pixels "$T/thick.pgm" | sort -u | tr -d ' \n'
}
echo '0 .005 .0043 .002 0 0 0 1' >"$T/thick.tum"
is "$(thick)" 86 "a thin beam"
is "$(thick --thickness 3mm)" 86 "a thick one on a ramp"
is "$(thick --thickness 3mm,8)" 86 "of an even number of slices"
echo '0 .005 .009 .002 0 0 0 1' >"$T/thick.tum"
is "$(thick --thickness 4mm,4)" 125 "what of it is beyond the volume is black" # 150, 170, 180 (half a voxel past the last centre) and 0

# Labels over grey.
volume 'i < 6 ? 0 : 7' >"$T/labels.nrrd"
us-slice -q --rigid --poses "$T/native.tum" --size 12x8 --width 12mm --depth 8mm --labels "$T/labels.nrrd" -o "$T/over.ppm" "$T/noise.nrrd"
is "$(head -n 1 "$T/over.ppm")" P6 "labels make it colour"
tail -c 288 "$T/over.ppm" | od -An -v -tu1 -w3 >"$T/over"
paste -d ' ' "$T/want" "$T/over" | awk '{ half = (NR - 1) % 12 >= 6
    if (half) bad += $2 != int(($1 + 213 + 1) / 2) || $3 != int(($1 + 94 + 1) / 2) || $4 != int(($1 + 1) / 2)
    else bad += $2 != $1 || $3 != $1 || $4 != $1 } END { print bad + 0, NR }' >"$T/bad"
is "$(cat "$T/bad")" "0 96" "half seen through, where there are any"
# tints NAME...: the colours of labels 1, 2, ... with these names, over the grey level 1.
volume 1 >"$T/one.nrrd"
tints() {
    volume 'i + 1' >"$T/plain.nrrd"
    {
        sed '/^$/,$d' "$T/plain.nrrd"
        n=0
        for name in "$@"; do
            printf 'Segment%d_Name:=%s\nSegment%d_LabelValue:=%d\n' $n "$name" $n $((n + 1))
            n=$((n + 1))
        done
        sed -n '/^$/,$p' "$T/plain.nrrd"
    } >"$T/named.nrrd"
    us-slice -q --rigid --poses "$T/native.tum" --size 12x8 --width 12mm --depth 8mm --labels "$T/named.nrrd" -o "$T/named.ppm" "$T/one.nrrd"
    tail -c 288 "$T/named.ppm" | od -An -v -tu1 -w3 | head -n $# |
        sed 's/^ *107 *48 *1$/red/; s/^ *44 *91 *117$/sky/; s/^ *1 *80 *58$/green/; s/^ *121 *115 *34$/yellow/; s/^ *1 *58 *90$/blue/' | tr '\n' ' '
}
is "$(tints a b c d e)" "red sky green yellow blue " "labels have colours in their order"
is "$(tints vein artery bone)" "sky red yellow " "but for vein, artery and bone, which have their own"
is "$(tints Gel 'Left Vein' 'right vein' 'Brachial artery')" "green sky yellow red " "by what is in their names; the others have what is left"

# Polygons: at rest they cover the cut through the block, 12 x 8 mm, without a gap.
us-slice -q --poses "$T/native.tum" --size 12x8 --width 12mm --depth 8mm --cut "$T/cut.obj" "$T/noise.nrrd" <"$T/mesh.sinew" >/dev/null
awk '$1 == "v" { x[++n] = $2; y[n] = $4 } $1 == "f" { for (k = 2; k <= NF; k++) { a = $k; b = $(k < NF ? k + 1 : 2); sum += (x[a] * y[b] - x[b] * y[a]) / 2 } }
    END { printf "%.6f", sum }' "$T/cut.obj" >"$T/area"
near "$(cat "$T/area")" 96 1e-6 "the polygons of a slice cover the block, all wound alike"
is "$(grep -c '^g tissue' "$T/cut.obj")" 1 "grouped by volume"

# A body: the volume turned by 90 degrees about z and moved; the same pose in it sees the same.
printf '%s\n' '# where things are' 'volume move=10cm,0,20mm turn=0,0,0.7071067811865476,0.7071067811865476' 'surface skin.obj unit=mm' >"$T/body"
echo '0 .096 .0055 .0195 0 0 0.7071067811865476 0.7071067811865476' >"$T/placed.tum"
us-slice --rigid --body "$T/body" --poses "$T/placed.tum" --size 12x8 --width 12mm --depth 8mm "$T/noise.nrrd" >"$T/placed.pgm"
pixels "$T/placed.pgm" | tr -d ' ' | cmp -s - "$T/want"
is $? 0 "a body places the volume"
is "$(sed -n 2p "$T/placed.pgm" | awk '{ printf "%.4f %.4f %.4f", $3, $4, $5 }')" "0.0960 0.0000 0.0200" "and the image lies in the body"

# sinew render shows the image and the body: more is seen with them than without.
msds-run -q --probe linear:6mm,4mm --poses "$T/native.tum" <"$T/mesh.sinew" >"$T/one.sinew" 2>/dev/null
us-slice -q --size 12x8 --depth 8mm -o "$T/s_%d.pgm" "$T/noise.nrrd" <"$T/one.sinew"
printf 'v 0 0 0\nv 30 0 0\nv 0 0 30\nf 1 2 3\n' >"$T/skin.obj"
for extra in "" "--slice $T/s_%d.pgm" "--body $T/body"; do
    # shellcheck disable=SC2086
    check "a picture $extra" sinew render --show voxels,probe --clear voxels $extra --view 1,2,3 --size 80x60 --format ppm -o "$T/r.ppm" "$T/one.sinew"
    cksum <"$T/r.ppm" >>"$T/sums"
done
is "$(sort -u "$T/sums" | wc -l | tr -d ' ')" 3 "differs with each"
printf 'P5\n12 8\n255\n' >"$T/bare.pgm"
fails 1 "an image that does not say where it lies" "bare.pgm:2: no image that says where it lies; expected '# us-slice:'" \
    sinew render --show probe --slice "$T/bare.pgm" -o "$T/r.png" "$T/one.sinew"
for comment in '# us-slice: 0 0 0 1 0 0 0 0' '# us-slice: 0 0 0 1 0 0 0 0 1 2' '# us-slice: 0 0 0 1 0 0 0 0 one' '# us-slice: 0 0 0 1 0 0 0 0 1 more words' \
    '# us-slice: 0 0 0 1 0 0 0 0 1 fan 1 2 3' '# us-slice: 0 0 0 1 0 0 0 0 1 fan 1 2 3 60 5' '# us-slice: fan 1 2 3 60' '# us-slice: 0 0 0 1 0 0 0 0 1 fan 1 2 3 60 fan'; do
    sed "2s/.*/$comment/" "$T/s_0.pgm" >"$T/bare.pgm"
    fails 1 "an image with '$comment'" "bare.pgm:2: no image that says where it lies; expected '# us-slice:' and nine numbers, or those of a fan" \
        sinew render --show probe --slice "$T/bare.pgm" -o "$T/r.png" "$T/one.sinew"
done
for sides in 12 '12 8 1'; do
    sed "3s/.*/$sides/" "$T/s_0.pgm" >"$T/bare.pgm"
    fails 1 "an image with sides of '$sides'" "bare.pgm:3: no image that says where it lies; expected columns and rows" \
        sinew render --show probe --slice "$T/bare.pgm" -o "$T/r.png" "$T/one.sinew"
done
head -c 90 "$T/s_0.pgm" >"$T/bare.pgm"
fails 1 "an image cut off" 'bare.pgm: ends after .* of 96 bytes' sinew render --show probe --slice "$T/bare.pgm" -o "$T/r.png" "$T/one.sinew"

# Frames of msds-run: the default probe is theirs; the two methods and any number of threads agree.
printf '%s\n' '0 .0055 .0045 -.0005 0 0 0 1' '1 .0055 .0045 .0005 0 0 0 1' '2 .0055 .0045 .001 0 0 0 1' >"$T/press.tum"
msds-run -q --probe linear:6mm,4mm --poses "$T/press.tum" <"$T/mesh.sinew" >"$T/run.sinew"
check "frames" us-slice --depth 7mm --size 60x70 -o "$T/run.pgm" "$T/noise.nrrd" <"$T/run.sinew"
is "$(grep -ac '^# us-slice' "$T/run.pgm")" 3 "an image each"
is "$(sed -n 2p "$T/run.pgm" | cut -d ' ' -f 6-8)" "0.0001 0 0" "as wide as the probe that pressed"
for how in "--threads 3 --regions 7" "--threads 1 --regions 1"; do
    # shellcheck disable=SC2086
    us-slice --depth 7mm --size 60x70 $how "$T/noise.nrrd" <"$T/run.sinew" | cmp -s - "$T/run.pgm"
    is $? 0 "the same bytes with $how"
done
for vectors in plain AVX2 AVX-512; do
    if SINEW_VECTORS=$vectors us-slice --depth 7mm --size 60x70 "$T/noise.nrrd" <"$T/run.sinew" >"$T/other.pgm" 2>/dev/null; then
        check "and by $vectors" cmp "$T/other.pgm" "$T/run.pgm"
    else
        skip 1 "this processor has no $vectors"
    fi
done
us-slice --depth 7mm --size 60x70 --method paper "$T/noise.nrrd" <"$T/run.sinew" >"$T/paper.pgm"
is "$(cmp -l "$T/paper.pgm" "$T/run.pgm" | awk '{ a = substr($2, 1, length($2) - 2) * 64 + substr($2, length($2) - 1, 1) * 8 + substr($2, length($2))
    b = substr($3, 1, length($3) - 2) * 64 + substr($3, length($3) - 1, 1) * 8 + substr($3, length($3)); d = a > b ? a - b : b - a; if (d > 1) bad++ } END { print bad + 0 }')" 0 \
    "PST's own steps give the same to a grey level"

# The probe is the model's probe.shape, whatever provenance says; where it came from is said, and where poses do.
us-slice -o "$T/x.pgm" "$T/noise.nrrd" <"$T/run.sinew" 2>"$T/said"
is "$(grep -c "^us-slice: probe: linear:0.006m,0.004m,0.001m, the model's probe.shape$" "$T/said") $(grep -c "^us-slice: poses: those of the frames$" "$T/said")" \
    "1 1" "which probe and which poses are said"
is "$(us-slice -q "$T/noise.nrrd" <"$T/run.sinew" 2>&1 >"$T/x.pgm")" "" "not with -q"
sinew export -f model --text "$T/run.sinew" | sed -e '/^crc/d' -e '/^prov msds-run/s/linear:0.006m,0.004m,0.001m/linear:0.009m,0.004m,0.001m/' >"$T/prose.txt"
us-slice -q --depth 7mm --size 60x70 "$T/noise.nrrd" <"$T/prose.txt" | cmp -s - "$T/run.pgm"
is "$? $(grep -c '^prov.*0.009m' "$T/prose.txt")" "0 1" "what provenance says is prose"
grep -v '^meta probe.shape' "$T/prose.txt" >"$T/bare.txt"
us-slice -o "$T/x.pgm" "$T/noise.nrrd" <"$T/bare.txt" 2>"$T/said"
is "$(grep -c 'the model has no probe.shape: the image is that of a linear array of 4 cm; --probe says another' "$T/said")" 1 "a model that does not say is said"
sed 's/^meta probe.shape .*/meta probe.shape "sphere:2cm"/' "$T/prose.txt" >"$T/ball.txt"
us-slice -o "$T/x.pgm" "$T/noise.nrrd" <"$T/ball.txt" 2>"$T/said"
is "$(grep -c "probe.shape, sphere:2cm, makes no image: the image is that of a linear array of 4 cm" "$T/said")" 1 "and one whose probe makes no image"
sed 's/^meta probe.shape .*/meta probe.shape "linear:wide"/' "$T/prose.txt" >"$T/wide.txt"
fails 1 "a shape that is none" "stdin: metadata, probe.shape: 'linear:wide' is not a probe; expected one as msds-run writes it" us-slice "$T/noise.nrrd" <"$T/wide.txt"

# Refused by its header, whose data are not even there: named, with what helps.
printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'sizes: 2 32001 2' 'spacings: 1 1 1' 'encoding: raw' '' >"$T/long.nrrd"
fails 1 "too many voxels along an axis" 'long\.nrrd: 32001 voxels along axis 1; expected at most 32000: us-import --crop keeps a part of them' \
    us-slice --rigid --poses "$T/native.tum" -o "$T/x.pgm" "$T/long.nrrd"
sed -i 's/32001/32000/' "$T/long.nrrd"
fails 1 "as many as there may be" 'long\.nrrd: data for only 0 of 2 x 32000 x 2 voxels' us-slice --rigid --poses "$T/native.tum" -o "$T/x.pgm" "$T/long.nrrd"

# Pressed by one face and seen by another: one line that names both.
msds-run -q --probe curved:4mm,40,3mm,.5mm --poses "$T/press.tum" <"$T/mesh.sinew" >"$T/curved.sinew" 2>/dev/null
seen() {
    us-slice --probe "$1" --depth 5mm -o "$T/x.pgm" "$T/noise.nrrd" <"${2:-$T/curved.sinew}" 2>&1 | grep warning
}
is "$(seen curved:4mm,80,3mm)" "us-slice: warning: the image is that of curved:4mm,80,3mm, but curved:0.004m,40,0.003m,0.0005m pressed \
(the model's probe.shape); expected --probe curved:0.004m,40,0.003m,0.0005m, or none" "another fan is warned of"
is "$(seen linear:4mm,3mm | grep -c 'but curved:0.004m,40')" 1 "and another kind"
is "$(seen curved:4.01mm,40,3mm | grep -c 'but curved:0.004m,40')" 1 "and another radius"
is "$(seen linear:7mm,4mm "$T/run.sinew" | grep -c 'but linear:0.006m')" 1 "and another width"
for same in curved:4mm,40,3mm curved:4.003mm,40.02,3mm curved:.4cm,40,9mm,1mm phased:90; do
    is "$(seen "$same")" "" "$same is not: the same face, or a phased array, which no shape that presses is"
done
is "$(seen linear:7mm,4mm "$T/ball.txt")" "" "nor is any array after a sphere"

# Around a fan the slice is not there, in space: the same image drawn as one that does not say what its fan is has a dark frame.
us-slice -q --depth 5mm --size 40x40 -o "$T/fan_%d.pgm" "$T/noise.nrrd" <"$T/curved.sinew"
is "$(sed -n 2p "$T/fan_0.pgm" | cut -d ' ' -f 12-)" "fan 0.00382428585 0.004 0.009 40" "a fan's image says its tip, radii and angle"
dark() {
    sinew render --show voxels --clear voxels --slice "$1" --frame 0 --view 0,-1,0 --up=-z --size 200x160 --format ppm "$T/curved.sinew" |
        tail -c 96000 | od -An -v -tu1 -w3 | awk '$1 < 100 && $2 < 100 && $3 < 100 { n++ } END { print n + 0 }'
}
sed '2s/ fan .*//' "$T/fan_0.pgm" >"$T/frame_0.pgm"
with=$(dark "$T/fan_0.pgm") without=$(dark "$T/frame_0.pgm")
if [ "$with" -lt $((without / 2)) ]; then ok "and is drawn without its corners: $with dark pixels, not $without"; else not_ok "dark pixels: $with, and without a fan $without"; fi
sed '2s/ 40$/ 240/' "$T/fan_0.pgm" >"$T/wrong_0.pgm"
fails 1 "a fan that is none" "wrong_0.pgm:2: no image that says where it lies; expected '# us-slice:' and nine numbers, or those of a fan" \
    sinew render --show voxels --slice "$T/wrong_0.pgm" --frame 0 -o "$T/r.png" "$T/curved.sinew"

# A tracked sequence: which of its transforms is taken.
sequence() {
    printf '%s\n' 'ObjectType = Image' 'DimSize = 3 3 1'
    printf 'Seq_Frame0000_%s = 1 0 0 %s 0 1 0 4 0 0 1 0 0 0 0 1\n' ProbeToTrackerTransform 5.5 ProbeToReferenceTransform 5
    printf '%s\n' 'Seq_Frame0000_Timestamp = 0' 'ElementDataFile = LOCAL'
}
sequence >"$T/plus.mha"
us-slice --rigid --poses "$T/plus.mha" --size 12x8 --width 12mm --depth 8mm -o "$T/x.pgm" "$T/noise.nrrd" 2>"$T/said"
is "$(grep -c "^us-slice: poses: ProbeToReference of .*plus.mha; their frame is the volume's$" "$T/said")" 1 "the transform that was taken is said"
us-slice --rigid --poses "$T/plus.mha" --transform ProbeToTracker --body "$T/body" -o "$T/x.pgm" "$T/noise.nrrd" 2>"$T/said"
is "$(grep -c "^us-slice: poses: ProbeToTracker of .*plus.mha; their frame is that of the body, in which the volume lies as --body says$" "$T/said")" 1 "and where the volume lies"

# Live: one pose in, one image out, before the next pose is written. (A reader knows that the first frame is whole when the second comes.)
take_image() {
    for _ in 1 2 3 4; do
        read -r header <&5
        printf '%s\n' "$header" >>"$T/live.pgm"
    done
    dd bs=1 count=4200 <&5 2>/dev/null >>"$T/live.pgm"
}
if have mkfifo && have timeout; then
    mkfifo "$T/poses" "$T/images"
    timeout 180 msds-run -q --probe linear:6mm,4mm --poses "$T/poses" <"$T/mesh.sinew" |
        timeout 180 us-slice --depth 7mm --size 60x70 "$T/noise.nrrd" >"$T/images" &
    exec 4>"$T/poses" 5<"$T/images"
    head -n 2 "$T/press.tum" >&4
    take_image
    take_image
    for _ in 1 2 3; do
        tail -n 1 "$T/press.tum" >&4
        take_image
    done
    exec 4>&- 5<&-
    wait
    { cat "$T/press.tum" && tail -n 1 "$T/press.tum" && tail -n 1 "$T/press.tum"; } >"$T/more.tum"
    msds-run -q --probe linear:6mm,4mm --poses "$T/more.tum" <"$T/mesh.sinew" | us-slice --depth 7mm --size 60x70 -o "$T/more.pgm" "$T/noise.nrrd"
    check "live, image by image, the same" cmp "$T/live.pgm" "$T/more.pgm"
else
    skip 1 "no mkfifo or timeout"
fi

fails 2 "no volume" 'missing operand' us-slice --rigid --poses "$T/zero.tum"
fails 2 "rigid without poses" '--rigid without --poses' us-slice --rigid "$T/noise.nrrd"
fails 2 "a size that is none" "--size 12x; expected COLUMNS, xROWS or COLUMNSxROWS" us-slice --rigid --poses "$T/zero.tum" --size 12x "$T/noise.nrrd"
fails 2 "a size too large" 'each 1 to 16384' us-slice --rigid --poses "$T/zero.tum" --size 99999x4 "$T/noise.nrrd"
fails 2 "no depth" '--depth: 0 m; expected 1 um to 10 m' us-slice --rigid --poses "$T/zero.tum" --depth 0 "$T/noise.nrrd"
fails 2 "a width that is none" '--width: 1e[+]300 m' us-slice --rigid --poses "$T/zero.tum" --width 1e300 "$T/noise.nrrd"
fails 2 "a sphere makes no image" 'makes no image' us-slice --rigid --poses "$T/zero.tum" --probe sphere:2cm "$T/noise.nrrd"
fails 2 "a fan past the half disc" 'expected phased:ANGLE' us-slice --rigid --poses "$T/zero.tum" --probe phased:200 "$T/noise.nrrd"
fails 2 "a thickness that is none" '--thickness 0' us-slice --rigid --poses "$T/zero.tum" --thickness 0 "$T/noise.nrrd"
fails 2 "slices that are none" 'N from 1 to 99' us-slice --rigid --poses "$T/zero.tum" --thickness 1mm,0 "$T/noise.nrrd"
fails 2 "a window upside down" 'LOW below HIGH' us-slice --rigid --poses "$T/zero.tum" --window 5,1 "$T/noise.nrrd"
fails 2 "a dynamic range of none" 'expected 1 to 200 dB' us-slice --rigid --poses "$T/zero.tum" --dynamic-range 0 "$T/noise.nrrd"
fails 2 "polygons without a mesh" 'no tetrahedra to cut' us-slice --rigid --poses "$T/zero.tum" --cut "$T/x.obj" "$T/noise.nrrd"
fails 2 "a body without poses" '--body without --poses' us-slice --body "$T/body" "$T/noise.nrrd"
fails 2 "a PNG for all images" 'one.png.*expected a name such as image_%04d.png' \
    us-slice --rigid --poses "$T/zero.tum" -o "$T/one.png" "$T/noise.nrrd"
check "and none is made" [ ! -e "$T/one.png" ]
fails 2 "two numbers in a name" 'expected one number' us-slice --rigid --poses "$T/zero.tum" -o "$T/%d_%d.png" "$T/noise.nrrd"
fails 1 "no frames and no poses" 'the model has no frames' us-slice "$T/noise.nrrd" <"$T/mesh.sinew"
fails 1 "nothing on stdin" 'no model on stdin' us-slice "$T/noise.nrrd"
fails 1 "fewer poses than frames" 'has 1 poses, fewer than there are frames' us-slice --poses "$T/zero.tum" -o "$T/none.pgm" "$T/noise.nrrd" <"$T/run.sinew"
check "leave no file" test ! -e "$T/none.pgm"
printf '%s\n' 'v 0 0 0' 'v 9 0 0' 'v 9 9 0' 'v 0 9 0' 'v 0 0 9' 'v 9 0 9' 'v 9 9 9' 'v 0 9 9' \
    'f 4 3 2 1' 'f 5 6 7 8' 'f 1 2 6 5' 'f 2 3 7 6' 'f 3 4 8 7' 'f 4 1 5 8' >"$T/cube.obj"
voxelise -q --unit mm -n 3 "$T/cube.obj" -o "$T/cube.sinew" 2>/dev/null
fails 1 "hexahedra" 'elements of 8 nodes; expected tetrahedra' us-slice --poses "$T/zero.tum" "$T/noise.nrrd" <"$T/cube.sinew"
head -c $(($(wc -c <"$T/run.sinew") / 2)) "$T/run.sinew" >"$T/cut.sinew"
fails 1 "a model cut off" 'stdin' us-slice "$T/noise.nrrd" <"$T/cut.sinew"
msds-run -q --probe linear:6mm,4mm --poses "$T/none.tum" <"$T/mesh.sinew" 2>"$T/said" | us-slice "$T/noise.nrrd" >"$T/x" 2>"$T/echo"
is "$(cat "$T/echo")" "" "a tool that failed before is not said twice"
sinew info --help >/dev/null
msds-run -q --text --probe linear:6mm,4mm --poses "$T/press.tum" <"$T/mesh.sinew" | sed '/^crc/d' >"$T/run.txt"
awk '/^array node.displacement/ { print; getline; print "nan 0 0"; next } { print }' "$T/run.txt" >"$T/nan.txt"
fails 1 "displacements that are none" 'array node.displacement, row 0: nan 0 0; expected finite' us-slice "$T/noise.nrrd" <"$T/nan.txt"
awk '/^array probe.pose/ { print; getline; print "0 0 0 0 0 0 2"; next } { print }' "$T/run.txt" >"$T/turn.txt"
fails 1 "a turn that is none" 'array probe.pose, row 0: 0 0 0 0 0 0 2; expected a place and a quaternion of length 1' us-slice "$T/noise.nrrd" <"$T/turn.txt"
sed 's/^array node.displacement /array x-moved /' "$T/run.txt" >"$T/still.txt"
fails 1 "frames that do not say how far nodes moved" 'frame 0 holds no node.displacement' us-slice "$T/noise.nrrd" <"$T/still.txt"
echo '0 5 0 0 0 0 0 1' >"$T/away.tum"
us-slice --rigid --poses "$T/away.tum" -o "$T/away.pgm" "$T/noise.nrrd" 2>"$T/said"
is "$? $(grep -c 'warning: every image (of 1) is black; expected poses in metres, in the volume.s frame, that look into it' "$T/said")" "0 1" \
    "a pose that sees nothing is warned of"
us-slice --poses "$T/away.tum" -o "$T/away.pgm" "$T/noise.nrrd" <"$T/mesh.sinew" 2>"$T/said"
is "$(grep -c "in the volume's frame (which is the model's too), that look into it" "$T/said") $(grep -c ,, "$T/said")" "1 0" "with a model too"
us-slice -q --rigid --poses "$T/native.tum" -o "$T/away.pgm" "$T/noise.nrrd" 2>"$T/said"
is "$(cat "$T/said")" "" "one that sees something is not"
awk '/^array node.displacement/ { print; getline; print "1e300 -1e300 1e200"; next } { print }' "$T/run.txt" >"$T/far.txt"
check "a node that flew away" us-slice -o "$T/far.pgm" "$T/noise.nrrd" <"$T/far.txt"
head -c 300 "$T/noise.nrrd" >"$T/short2.nrrd"
fails 1 "a volume cut off" 'short2.nrrd' us-slice --rigid --poses "$T/zero.tum" "$T/short2.nrrd"
: >"$T/empty.tum"
fails 1 "no poses" 'no pose; expected lines' us-slice --rigid --poses "$T/empty.tum" "$T/noise.nrrd"
if [ -c /dev/full ]; then
    fails 1 "a full disk" 'No space left' us-slice --rigid --poses "$T/zero.tum" -o /dev/full "$T/noise.nrrd"
fi
wrong() {
    printf '%s\n' "$2" >"$T/wrong"
    fails 1 "a body: $1" "wrong:1: .*$3" us-slice --rigid --body "$T/wrong" --poses "$T/zero.tum" "$T/noise.nrrd"
}
wrong "a word that is none" 'volum move=1,2,3' "'volum'; expected volume or surface"
wrong "two numbers" 'volume move=1,2' 'expected three lengths'
wrong "a turn of length 2" 'volume turn=0,0,0,2' 'expected a unit quaternion'
wrong "a unit that is none" 'surface a.obj unit=furlong' 'unit=furlong'
wrong "no unit" 'surface a.obj' "without unit="
wrong "a file elsewhere" 'surface ../a.obj unit=mm' 'expected the name of a file in the folder'
wrong "an unknown key" 'volume mvoe=1,2,3' "unknown key 'mvoe'"
wrong "no file" 'surface unit=mm' 'a surface without a file'
done_testing
