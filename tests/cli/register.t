#!/bin/sh
# sinew register: a motion that is known by hand, in each format, as --body and --marker read it; Slicer's files of points; residuals, and what is
# expected elsewhere, against sums in awk; and what is refused. (tests/unit/test_registration.c has noise, against theory.)
. "$(dirname "$0")/lib.sh"
cd "$T" || exit 1

# The model is at (x, y, z) -> (x, -z, y) + (10, 20, 30) mm in the frame of the poses.
cat >model.txt <<'END'
# picked on the model, mm
left 70 0 10
right -70 10 20
top 10 90 -30
back 0 -80 50
chin 30 20 110
END
awk '!/^#/ { print $1, ($2 + 10) / 1e3, (20 - $4) / 1e3, ($3 + 30) / 1e3 }' model.txt | sort >touched.txt # m, in another order

# rounded FILE: its last line or lines, of six digits, without -0.
rounded() {
    grep -v '^#' "$1" | awk '{ for (i = 1; i <= NF; i++) { v = $i + 0; if (v < 5e-7 && v > -5e-7) v = 0; printf "%s%.6f", (i > 1 ? " " : ""), v }; print "" }'
}
check "points with names, in two units" sinew register --unit mm,m model.txt touched.txt -o body.tum
is "$(rounded body.tum)" "0.000000 0.010000 0.020000 0.030000 0.707107 0.000000 0.000000 0.707107" "the motion, as a line"
is "$(grep -c 'sinew-register: 5 pairs: FRE .*e-1[0-9] mm (rms), largest .*; FLE' stderr)" 1 "and what is left"
sinew register -q --unit mm,m model.txt touched.txt --format 4x4 >body.4x4
is "$(rounded body.4x4 | tr '\n' ' ')" "1.000000 0.000000 0.000000 10.000000 0.000000 0.000000 -1.000000 20.000000 0.000000 1.000000 0.000000 30.000000 0.000000 0.000000 0.000000 1.000000 " "as a matrix"
sinew register -q --unit mm,m model.txt touched.txt --format tfm >body.tfm
is "$(sed -n 's/^Parameters: //p' body.tfm | tr ' ' '\n' >numbers; rounded numbers | tr '\n' ' ')" \
    "1.000000 0.000000 0.000000 0.000000 0.000000 1.000000 0.000000 -1.000000 0.000000 -10.000000 -30.000000 20.000000 " "as Slicer's file: the inverse, in LPS"

# Each of them is read back as the same place by --body and --marker: images of the volume do not differ.
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 10 8' \
        'space directions: (1,0,0) (0,1,0) (0,0,1)' 'encoding: text' 'space origin: (0,0,0)' ''
    awk 'BEGIN { for (k = 0; k < 8; k++) for (j = 0; j < 10; j++) for (i = 0; i < 12; i++) print (i * 37 + j * 91 + k * 53 + i * j * k) % 256 }'
} >v.nrrd
h=.70710678118654752
echo '0 .0055 .004 .0001 0 0 0 1' >face.tum
echo "0 .0155 .0199 .034 $h 0 0 $h" >body-pose.tum     # in the body
echo "0 -.0045 -.026 .0201 -$h 0 0 $h" >marker-pose.tum # of the marker, whose face is at the motion
image() { # OUT OPTIONS...
    to=$1
    shift
    us-slice -q --rigid --size 60x40 --probe linear:12mm,2mm --depth 8mm "$@" v.nrrd | tail -c 2400 >"$to"
}
image want --poses face.tum
sinew register -q --for marker --unit mm,m model.txt touched.txt --format tfm >marker.tfm
for file in body.tum body.4x4 body.tfm; do
    image got --body $file --poses body-pose.tum
    check "--body $file" cmp want got
done
for file in body.tum body.4x4 marker.tfm; do
    image got --marker $file --poses marker-pose.tum
    check "--marker $file" cmp want got
done

# ---- Slicer's points: model.fcsv in LPS; touched.fcsv as Slicer has it of poses in LPS, and of a tracker's own axes, which it shows as they are.
fcsv() { # SPACE: of NAME X Y Z in mm
    printf '%s\n' '# Markups fiducial file version = 4.11' "# CoordinateSystem = $1" \
        '# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID'
    awk '!/^#/ { print NR "," $2 "," $3 "," $4 ",0,0,0,1,1,1,0," $1 ",," }'
}
fcsv LPS <model.txt >model.fcsv
awk '{ print $1, 1e3 * $2, 1e3 * $3, 1e3 * $4 }' touched.txt | fcsv LPS >touched.fcsv
awk '{ print $1, 1e3 * $2, 1e3 * $3, 1e3 * $4 }' touched.txt | fcsv RAS >shown.fcsv
sinew register -q model.fcsv touched.fcsv >got.tum
is "$(rounded got.tum)" "$(rounded body.tum)" ".fcsv, both in LPS"
sinew register -q --for tracker model.fcsv shown.fcsv >got.tum
is "$(rounded got.tum)" "$(rounded body.tum)" "a tracker's own axes are as Slicer shows them"
awk '!/^#/ { print $1, -$2, -$3, $4 }' model.txt | fcsv 0 >ras.fcsv
sinew register -q --unit m ras.fcsv touched.txt >got.tum
is "$(rounded got.tum)" "$(rounded body.tum)" "a model in RAS; the other file in text"
cut -d ' ' -f 2- model.txt | sed 1d >unnamed.txt
awk '!/^#/ { print ($2 + 10), (20 - $4), ($3 + 30) }' model.txt >unnamed2.txt
sinew register -q --unit mm unnamed.txt unnamed2.txt >got.tum
is "$(rounded got.tum)" "$(rounded body.tum)" "points without names, by their order"

# ---- Residuals: a square of 80 mm on which one corner is picked 4 mm out along the normal: by hand, each corner is left 1 mm.
printf '%s\n' '40 40 0' '-40 40 0' '-40 -40 0' '40 -40 0' >square
printf '%s\n' '40 40 4' '-40 40 0' '-40 -40 0' '40 -40 0' >bent
sinew register --unit mm square bent --residuals left.tsv --target 0,0,10cm >bent.tum 2>said
is "$(awk -F '\t' 'NR > 1 { printf "%s %.2f %.2f;", $1, $5, $4 }' left.tsv)" "1 1.00 1.00;2 1.00 -1.00;3 1.00 1.00;4 1.00 -1.00;" "what is left of each"
is "$(grep -c '4 pairs: FRE 1 mm (rms), largest .* mm, of [1-4]; FLE 1.41 mm by it' said)" 1 "FRE and FLE"
# f^2 = 1600 about both axes of the square, 3200 about its normal; d = 100 from the former: TRE^2 = 2 FRE^2 / 4 (1 + 2/3 100^2 / 1600).
near "$(sed -n 's/.*expected TRE \([0-9.]*\) mm (rms) at the target (0, 0, 100) mm/\1/p' said)" \
    "$(awk -F '\t' 'NR > 1 { s += $5 * $5 / 4 } END { print sqrt(2 * s / 4 * (1 + 2 / 3 * 1e4 / 1600)) }' left.tsv)" .005 "TRE at a target, by hand"

# ---- Nonsense.
refused() { # NAME PATTERN ARG...
    title=$1 pattern=$2
    shift 2
    fails 1 "$title" "$pattern" sinew register "$@" -o none.tum
    [ ! -e none.tum ] || not_ok "$title: a file is left"
}
head -n 2 unnamed.txt >two
refused "two points" 'two: 2 pairs of points; expected three or more' --unit mm two two
refused "another count" 'unnamed2.txt: has 5 points, but two has 2' --unit mm two unnamed2.txt
awk '{ print $1, $1 * 2, $1 * 3 }' unnamed.txt >line
refused "a line" 'the first points are on a line, to within' --unit mm line unnamed2.txt
awk '{ print $1, $2, -$3 }' unnamed.txt >mirror
refused "a mirror" 'mirror: the points fit their partners better mirrored' --unit mm mirror unnamed2.txt
sort -r unnamed2.txt >disorder
refused "another order" 'the points do not fit their partners: .* mm \(rms\) are left' --unit mm unnamed.txt disorder
refused "another unit" 'the points do not fit their partners' --unit mm,m unnamed.txt unnamed2.txt
sed 's/chin/nose/' touched.txt >renamed
refused "a name without a partner" "model.txt:6: 'chin' has no partner in renamed" --unit mm,m model.txt renamed
refused "no unit" 'model.txt: is text, whose unit is not said' model.txt touched.txt
echo '{"markups": []}' >v.json
refused "Slicer's .mrk.json" 'v.json: is JSON.*save the points as .fcsv' --unit mm v.json touched.txt
refused "garbage" "v.nrrd:1: 1 words" --unit mm v.nrrd touched.txt
fails 2 "a wrong unit" "--unit 'mm,x': expected um, mm" sinew register --unit mm,x model.txt touched.txt
fails 2 "half a target" '--target with 2 lengths' sinew register --unit mm --target 1,2 model.txt touched.txt
fails 2 "one file" 'FROM TO' sinew register --unit mm model.txt
cp model.txt kept
fails 2 "an output that is an input" 'kept' sinew register --unit mm,m kept touched.txt -o kept
check "is as it was" cmp kept model.txt

done_testing
