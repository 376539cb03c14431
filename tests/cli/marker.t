#!/bin/sh
# --marker, of msds-run, tled-run and us-slice: poses of a marker whose face is elsewhere, as lines and as a PLUS sequence, live and not, with
# --body; the kinds of files; records, which need no marker; and what is refused.
. "$(dirname "$0")/lib.sh"
cd "$T" || exit 1

# The face is at (x, y, z) -> (x, -z, y) + (10, 20, 30) mm on the marker. Each kind of file says so.
h=.70710678118654752
echo "0 .01 .02 .03 $h 0 0 $h" >line
printf '1 0 0 10\n0 0 -1 20\n0 1 0 30\n0 0 0 1\n' >matrix
cat >plus.xml <<'XML'
<PlusConfiguration>
  <CoordinateDefinitions>
    <Transform From="ProbeMarker" To="Probe" Matrix="1 0 0 -10   0 0 1 -30   0 -1 0 20   0 0 0 1" />
    <Transform From="StylusTip" To="Stylus" Matrix="1 0 0 200   0 1 0 0   0 0 1 0   0 0 0 1" />
  </CoordinateDefinitions>
</PlusConfiguration>
XML
# Slicer shows that matrix. With the signs of x and y turned on both sides it is (x, y, z) -> (x, z, -y) + (-10, -20, 30), and the file has the
# inverse of this: (x, y, z) -> (x, -z, y) + (10, 30, 20).
printf '%s\n' '#Insight Transform File V1.0' '#Transform 0' 'Transform: AffineTransform_double_3_3' \
    'Parameters: 1 0 0 0 0 -1 0 1 0 10 30 20' 'FixedParameters: 0 0 0' >slicer.tfm

# moved FILE: a pose of the frames, of six digits.
moved() {
    sinew info --get probe.pose "$1" | awk '{ for (i = 1; i <= 7; i++) printf "%s%.6f", (i > 1 ? " " : ""), $i + (($i < 5e-7 && $i > -5e-7) ? -$i : 0); print "" }'
}

# ---- msds-run: the face at (40 40 58) mm, looking down, from (30 70 38) mm of the marker.
msds-mesh -q --nodes 5x5x4 --size 8cm,8cm,6cm --young 10000 --poisson 0.4 --density 1000 >block
face="0.040000 0.040000 0.058000 1.000000 0.000000 0.000000 0.000000"
echo "0 .03 .07 .038 $h 0 0 $h" >at.tum
for file in line matrix plus.xml plus.xml:ProbeToProbeMarker slicer.tfm; do
    msds-run -q --probe sphere:2cm --marker $file --poses at.tum <block >out 2>/dev/null
    is "$(moved out)" "$face" "msds-run: the face by $file"
done
echo 'volume move=1cm,0,0' >body
echo "0 .04 .07 .038 $h 0 0 $h" >inbody.tum
msds-run -q --probe sphere:2cm --marker line --body body --poses inbody.tum <block >out 2>/dev/null
is "$(moved out)" "$face" "and in a body"
printf '1 0 0 10\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' >body4x4
msds-run -q --probe sphere:2cm --marker line --body body4x4 --poses inbody.tum <block >again 2>/dev/null
check "whose file is a matrix: the same bytes" sh -c 'sinew diff -q out again'
# The model is moved by (10 0 0) in LPS: Slicer shows -10, and the file has the inverse of what is in LPS.
printf '%s\n' '#Insight Transform File V1.0' 'Transform: AffineTransform_double_3_3' \
    'Parameters: 1 0 0 0 1 0 0 0 1 -10 0 0' 'FixedParameters: 5 6 7' >body.tfm
msds-run -q --probe sphere:2cm --marker line --body body.tfm --poses inbody.tum <block >again 2>/dev/null
check "or Slicer's" sh -c 'sinew diff -q out again'

# A PLUS sequence: the marker's transform, though there is one of the image; and one of an image as it is.
{
    printf '%s\n' 'ObjectType = Image' 'DimSize = 101 3 1'
    printf 'Seq_Frame0000_ProbeToReferenceTransform = 1 0 0 30 0 0 -1 70 0 1 0 38 0 0 0 1\n'
    printf 'Seq_Frame0000_ImageToReferenceTransform = .2 0 0 30 0 0 -.2 70 0 .2 0 38 0 0 0 1\n'
    printf '%s\n' 'Seq_Frame0000_Timestamp = 0' 'ElementDataFile = LOCAL'
} >plus.mha
msds-run -q --probe sphere:2cm --marker line --poses plus.mha <block >out 2>/dev/null
is "$(moved out)" "$face" "of a PLUS sequence: ProbeToReference, not the image"
msds-run -q --probe sphere:2cm --marker line --poses plus.mha --transform ImageToReference <block >out 2>/dev/null
is "$(moved out)" "$face" "an image that is asked for stays as it is: its first pixel, its own axes"

# ---- tled-run and us-slice take it alike.
awk -v nx=4 -v ny=4 -v nz=4 -v h=0.005 -v held=low -f "$ROOT/tests/cli/block.awk" >cube
echo "0 0 .04 .005 $h 0 0 $h" >cube.tum
tled-run -q -n 2 --probe sphere:1cm --marker line --poses cube.tum <cube >out
is "$(moved out)" "0.010000 0.010000 0.025000 1.000000 0.000000 0.000000 0.000000" "tled-run"
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 10 8' \
        'space directions: (1,0,0) (0,1,0) (0,0,1)' 'encoding: text' 'space origin: (0,0,0)' ''
    awk 'BEGIN { for (k = 0; k < 8; k++) for (j = 0; j < 10; j++) for (i = 0; i < 12; i++) print (i * 37 + j * 91 + k * 53 + i * j * k) % 256 }'
} >v.nrrd
view="--size 60x40 --probe linear:12mm,2mm --depth 8mm"
echo '0 .0055 .004 .0001 0 0 0 1' >face.tum
echo "0 -.0045 -.026 .0201 -$h 0 0 $h" >slice.tum
# shellcheck disable=SC2086 # options
{
    us-slice -q --rigid $view --poses face.tum v.nrrd | tail -c 2400 >want
    us-slice -q --rigid $view --marker slicer.tfm --poses slice.tum v.nrrd | tail -c 2400 >got
}
check "us-slice" cmp want got
check "whose image is not all black" sh -c 'tr -d "\000" <want | grep -q .'

# ---- Live: the frames, and the record, have the face; the replay needs no marker.
# until_seen FILE PATTERN: waits until a line matches, 10 s at most.
until_seen() {
    tries=0
    while ! grep -q -e "$2" "$1" 2>/dev/null && [ "$tries" -lt 500 ]; do
        tries=$((tries + 1))
        sleep .02
    done
}
# live NAME MODEL POSE COMMAND...: a live run that takes this pose; out and record.
live() {
    title=$1 model=$2 pose=$3
    shift 3
    rm -f record fifo
    mkfifo fifo
    "$@" --live --record record --poses fifo <"$model" >out 2>said &
    run=$!
    exec 3>fifo
    echo "$pose" >&3
    until_seen record '^frame 3 '
    kill -TERM "$run"
    wait "$run"
    is $? 0 "$title: a live run"
    exec 3>&-
}
replayed() { # NAME MODEL COMMAND...
    title=$1 model=$2
    shift 2
    "$@" --replay record <"$model" >again 2>/dev/null
    sed -n '/^frame /,$p' out >frames
    sed -n '/^frame /,$p' again >frames-again
    check "$title: replayed without a marker, to the same bytes" cmp frames frames-again
}
live msds-run block "$(cat inbody.tum)" msds-run -q --text --probe sphere:2cm --marker plus.xml --body body
is "$(grep -c 'pose=0.0[34][0-9]*,0.0[34][0-9]*,0.05[78]' record | awk '{ print ($1 > 2) }')" 1 "and its record has the face"
replayed msds-run block msds-run -q --text
live tled-run cube "$(cat cube.tum)" tled-run -q --text --probe sphere:1cm --marker slicer.tfm
is "$(sinew info --get probe.pose out | awk '{ printf "%.6f %.6f %.6f", $1, $2, $3 }')" "0.010000 0.010000 0.025000" "and its frames have the face"
replayed tled-run cube tled-run -q --text --probe sphere:1cm
# shellcheck disable=SC2086
{
    live us-slice /dev/null "$(cat slice.tum)" us-slice -q --rigid $view --marker matrix v.nrrd
    header=$(head -n 4 out | wc -c)
    tail -c "+$((header + 1))" out | head -c 2400 >got
    check "and its images are those of the face" cmp want got
    us-slice -q --replay record --rigid $view v.nrrd >again
    check "us-slice: replayed without a marker, to the same bytes" cmp -n "$(wc -c <again)" out again
    fails 2 "us-slice: a marker with a replay" '--marker with --replay' us-slice --replay record --rigid $view --marker line v.nrrd
    fails 2 "us-slice: a marker without poses" '--marker without --poses' us-slice --marker line v.nrrd
}
fails 2 "msds-run: a marker with a replay" '--marker.*: what came live is in the record, with poses as they were used' msds-run --replay record --marker line <block
fails 2 "tled-run: a marker with a replay" '--replay with --marker' tled-run --replay record --probe sphere:1cm --marker line <cube
fails 2 "tled-run: a marker without poses" '--marker without --poses' tled-run -n 1 --marker line <cube

# ---- Files that are no way from a marker to a face.
refused() { # NAME PATTERN FILE
    fails 1 "$1" "$2" msds-run --probe sphere:2cm --marker "$3" --poses at.tum <block
}
printf '\211HDF\r\n\032\n\002' >t.h5
refused "Slicer's .h5" 't.h5: is HDF5.*save the transform as .tfm' t.h5
refused "a name that is not there" 'plus.xml: does not say where A is in B; .*by what it has: ProbeMarkerToProbe, StylusTipToStylus' plus.xml:AToB
refused "a name of a matrix" 'matrix: has no transforms with names' matrix:ProbeToProbeMarker
refused "no file" 'absent' absent
refused "a body's file" 'body: is none of these' body
printf '1 0 0 10\n0 0 -1.5 20\n0 1.5 0 30\n0 0 0 1\n' >scaled
refused "scale" 'scaled: a matrix with scale: .* 1, 1.5 and 1.5' scaled
fails 1 "a body of PLUS without a name" 'plus.xml: which transform is meant is not said' msds-run --probe sphere:2cm --body plus.xml --poses at.tum <block
printf 'AffineTransform\n' >bad
fails 1 "a body that is neither" "bad:1: 'AffineTransform'; expected volume or surface" msds-run --probe sphere:2cm --body bad --poses at.tum <block
is "$(find . -name '.*' -type f | wc -l | tr -d ' ')" 0 "nothing half written is left"

done_testing
