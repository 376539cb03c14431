#!/bin/sh
# us-slice --coupling: lines of beams that enter no tissue are black, against closed forms, pixel by pixel, for each array; bytes; frames; labels;
# what is refused.
. "$(dirname "$0")/lib.sh"

# A volume that is 200 everywhere, and a block of 40 x 4 x 10 mm in it, its top at z = 0; of step.sinew, the top is 5 mm lower where x is above 0.
printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'sizes: 2 2 2' 'space directions: (1000,0,0) (0,1000,0) (0,0,1000)' \
    'space: left-posterior-superior' 'encoding: text' 'space origin: (-500,-500,-500)' '' '200 200 200 200 200 200 200 200' >"$T/flat.nrrd"
msds-mesh -q --nodes 41x3x11 --size 40mm,4mm,10mm --origin=-20mm,-2mm,0 --fix zmax | sinew export -f model --text | grep -v '^crc' >"$T/block.sinew"
awk '/^array/ { in_it = $2 == "node.position"; print; next } in_it && NF == 3 { $3 = $1 > 1e-6 ? .005 + $3 / 2 : $3 } { print }' \
    "$T/block.sinew" >"$T/step.sinew"
is "$(awk 'NF == 3 && $1 > .0009 && $1 < .0011 && $3 > .00499 && $3 < .00501' "$T/step.sinew" | grep -c .)" 3 "a block with a step"

# image NAME MODEL Z [OPTION]...: 400 x 160 pixels of 8 mm of depth, the face at (0, 0, Z mm); levels, one a line.
image() {
    to=$T/$1 model=$T/$2.sinew
    echo "0 0 0 $3e-3 0 0 0 1" >"$T/at.tum"
    shift 3
    us-slice -q --poses "$T/at.tum" --size 400x160 --depth 8mm "$@" -o "$to.pgm" "$T/flat.nrrd" <"$model" &&
        tail -c 64000 "$to.pgm" | od -An -v -tu1 -w1 | tr -d ' ' >"$to"
}

# Linear: beams up to x = .2 mm have tissue within 1 mm of the face, those of the columns 0 to 201. Of an aperture of 41 columns, the part s of
# them takes 40 log10(1 / s) of the 60 dB.
image plain step 0 --probe linear:4cm,1cm
image dark step 0 --probe linear:4cm,1cm --coupling 1mm
paste -d ' ' "$T/plain" "$T/dark" | awk '{ c = (NR - 1) % 400; from = c - 20 > 0 ? c - 20 : 0; to = c + 20 < 399 ? c + 20 : 399
        some = (to < 201 ? to : 201) - from + 1; s = some > 0 ? some / (to - from + 1) : 0
        less = s ? int(40 * log(1 / s) / log(10) * 255 / 60 + .5) : 255
        want = $1 > less ? $1 - less : 0; bad += $2 != want; black += c >= 222 && $1 > 0 && $2 == 0; same += c <= 181 && $1 == 200 && $2 == 200 }
    END { print bad + 0, (black > 8000), (same == 182 * 160) }' >"$T/seen"
is "$(cat "$T/seen")" "0 1 1" "a linear array half on tissue: black beyond, as before on it, and less between by the share of the aperture"
is "$(awk '(NR - 1) % 400 > 230 && $1 == 200' "$T/plain" | wc -l | tr -d ' ')" "$(awk 'BEGIN { print 169 * 60 }')" "where the image was of tissue in the air"

# Through gel: the face .9 mm above the tissue is coupled, at 1.1 mm no line is; a warning tells why all is black.
image gel block -.9 --probe linear:4cm,1cm --coupling 1mm
image bare block -.9 --probe linear:4cm,1cm
check "a thinner layer than the gap couples all lines" cmp "$T/gel" "$T/bare"
image air block -1.1 --probe linear:4cm,1cm --coupling 1mm 2>"$T/said"
is "$(sort -u "$T/air") $(grep -c 'every image (of 1) is black;.* with the face on tissue (--coupling)$' "$T/said")" "0 1" "a thicker one couples none, and it is said"
image in block 2 --probe linear:4cm,1cm --coupling 1um
image bare block 2 --probe linear:4cm,1cm
check "a face within the tissue touches it" cmp "$T/in" "$T/bare"

# Curved, R = 30 mm, its face's middle on the flat top: the beam at t has (R - R cos t) / cos t to go, 1 mm at cos t = 30 / 31, 14.59 degrees. An
# aperture of 4 mm is 3.82 degrees to either side; a pixel of .2 degrees of doubt is left out.
image plain block 0 --probe curved:3cm,60,1cm
image dark block 0 --probe curved:3cm,60,1cm --coupling 1mm
sed -n 2p "$T/dark.pgm" | cut -d ' ' -f 3-11 >"$T/lies"
paste -d ' ' "$T/plain" "$T/dark" | awk 'NR == FNR { for (i = 1; i <= 9; i++) p[i] = $i; next }
    { c = (FNR - 1) % 400; r = int((FNR - 1) / 400); x = p[1] + p[4] * c; z = p[3] + p[9] * r + .03
      t = atan2(x, z) * 180 / atan2(0, -1); t = t < 0 ? -t : t
      if (t > 14.59 + 3.82 + .4) { bad += $2 != 0; black += $1 > 0 }
      if (t < 14.59 - 3.82 - .4) { bad += $2 != $1; same += $1 > 0 }
      if (t > 14.2 && t < 15 && $1 > 0) { edge++; bad += $2 < 135 || $2 > 163 } }
    END { print bad + 0, (black > 1000), (same > 5000), (edge > 300) }' "$T/lies" - >"$T/seen"
is "$(cat "$T/seen")" "0 1 1 1" "a curved array on a plane: black at the sides, from 14.59 degrees on 12 dB less"

# Phased, 90 degrees, 2 mm above: beams within acos(2 / 2.5) = 36.87 degrees of 45 reach the tissue, so all echoes are 3.54 dB less, 15 levels.
image plain block -2 --probe phased:90
image dark block -2 --probe phased:90 --coupling 2.5mm
paste -d ' ' "$T/plain" "$T/dark" | awk '{ bad += $2 != ($1 ? $1 - 15 : 0); lit += $1 > 0 } END { print bad + 0, (lit > 10000) }' >"$T/seen"
is "$(cat "$T/seen")" "0 1" "a phased array is coupled as a whole"

# The same bytes however they are made; slices of a thick beam have their own coupling, which is the same in a prism.
image dark step 0 --probe curved:3cm,60,1cm --coupling 1mm
for how in "--threads 3 --regions 7" "--threads 1 --regions 1" "--method paper" "--thickness 2mm,3"; do
    # shellcheck disable=SC2086
    image other step 0 --probe curved:3cm,60,1cm --coupling 1mm $how
    check "the same with $how" cmp "$T/other.pgm" "$T/dark.pgm"
done
for vectors in plain AVX2 AVX-512; do
    SINEW_VECTORS=$vectors image other step 0 --probe curved:3cm,60,1cm --coupling 1mm 2>"$T/said"
    if ! grep -q SINEW_VECTORS "$T/said"; then
        check "and by $vectors" cmp "$T/other.pgm" "$T/dark.pgm"
    else
        skip 1 "this processor has no $vectors"
    fi
done
image plain step 0 --probe curved:3cm,60,1cm
image other step 0 --probe curved:3cm,60,1cm --coupling 0
check "0 is off" cmp "$T/other.pgm" "$T/plain.pgm"

# Frames: a probe presses half of the block's top, then leaves it; knobs act on what is left of the echo.
printf '%s\n' '0 .012 0 .0005 0 0 0 1' '1 .012 0 .001 0 0 0 1' '2 .012 0 -.003 0 0 0 1' >"$T/press.tum"
msds-run -q --method fem --probe linear:16mm,4mm --poses "$T/press.tum" <"$T/block.sinew" >"$T/run.sinew" 2>"$T/said"
us-slice -q --size 160x80 --depth 8mm --coupling .5mm -o "$T/f_%d.pgm" "$T/flat.nrrd" <"$T/run.sinew"
for i in 0 1 2; do
    tail -c 12800 "$T/f_$i.pgm" | od -An -v -tu1 -w1 | awk '{ n += $1 > 0 } END { print (n > 11000), (n == 0) }' | tr '\n' ' '
done >"$T/seen"
is "$(cat "$T/seen")" "1 0 1 0 0 1 " "frames: the image is there while the probe presses, and goes when it leaves"
image loud block -2 --probe phased:90 --coupling 2.5mm --gain 6 --dynamic-range 50,60
sort -n "$T/loud" | uniq -c | awk 'END { print $2 }' >"$T/seen"
is "$(cat "$T/seen")" "$(awk 'BEGIN { print int(255 * (1 + ((185 / 255 - 1) * 60 + 6) / 50) + .5) }')" "gain comes after"

# Labels: what has no echo is not tinted.
sed 's/200/1/g' "$T/flat.nrrd" | awk '/^encoding/ { print; next } /^$/ && !done { print "Segment0_Name:=a"; print "Segment0_LabelValue:=1"; done = 1 } { print }' >"$T/labels.nrrd"
echo '0 0 0 0 0 0 0 1' >"$T/at.tum"
for coupling in "" "--coupling 1mm"; do
    # shellcheck disable=SC2086
    us-slice -q --poses "$T/at.tum" --size 400x160 --depth 8mm --probe linear:4cm,1cm $coupling --labels "$T/labels.nrrd" "$T/flat.nrrd" <"$T/step.sinew" |
        tail -c 192000 | od -An -v -tu1 -w3 | awk '(NR - 1) % 400 > 222 && ($1 > 0 || $2 > 0 || $3 > 0)' | wc -l
done | tr -d ' ' | tr '\n' ' ' >"$T/seen"
is "$(awk '{ print ($1 > 8000), $2 }' "$T/seen")" "1 0" "nor are labels shown there"

fails 2 "a length that is a slip" '--coupling: 20 m; expected 1 um to 10 m, or 0: every beam is coupled' \
    us-slice --coupling 20 "$T/flat.nrrd"
fails 2 "one below 0" '--coupling' us-slice --coupling=-1mm "$T/flat.nrrd"
fails 2 "no tissue" '--coupling with --rigid: there is no tissue that the face could touch' \
    us-slice --rigid --poses "$T/at.tum" --coupling 1mm "$T/flat.nrrd"
done_testing
