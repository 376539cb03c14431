#!/bin/sh
# us-import: DICOM of every kind that it reads, written byte by byte by dicom.py; what is wrong with series; that nothing that
# names anybody comes out; and real data, its geometry against other readers.
. "$(dirname "$0")/lib.sh"
have python3 || skip_all "no python3 to write DICOM files with"

# dicom KIND KEY=VALUE...: files in $T/in; their voxels in $T/expected.
dicom() {
    rm -rf "$T/in"
    python3 tests/cli/dicom.py "$T/in" "$@" && mv "$T/in/expected" "$T/expected"
}

# voxels FILE: the last bytes of a raw NRRD, as many as are expected.
voxels() {
    tail -c "$(wc -c <"$T/expected")" "$1"
}

# same NAME OPTIONS -- KIND KEY=VALUE...: imports and compares the voxels.
same() {
    name=$1
    shift
    options=
    while [ "$1" != -- ]; do
        options="$options $1"
        shift
    done
    shift
    dicom "$@"
    # shellcheck disable=SC2086
    check "$name" us-import -q --raw $options -o "$T/out.nrrd" "$T/in"
    if voxels "$T/out.nrrd" | cmp -s - "$T/expected"; then
        ok "and its voxels"
    else
        not_ok "and its voxels: $name"
    fi
}

# line FILE KEY: a line of a NRRD header.
line() {
    LC_ALL=C sed -n "/^\$/q;s/^$2: //p" "$1" | head -n 1
}

same "a series, its files in another order" -- series
is "$(line "$T/out.nrrd" sizes)" "7 5 6" "sizes"
is "$(line "$T/out.nrrd" "space origin")" "(10,-20,30)" "origin"
is "$(line "$T/out.nrrd" "space directions" | tr '(),' '   ' | awk '{ printf "%.6g %.6g %.6g %.6g %.6g %.6g %.6g %.6g %.6g", $1, $2, $3, $4, $5, $6, $7, $8, $9 }')" \
    "0.4 0.3 0 0 0 -0.25 -0.45 0.6 0" "directions"
same "implicit" -- series syntax=implicit
same "big-endian, 16 bits with sign" -- series syntax=big bits=16 sign=1
is "$(line "$T/out.nrrd" type)" int16 "its type"
same "12 of 16 bits, white is 0" -- series bits=16 stored=12 colour=MONOCHROME1
same "RGB by pixel" -- series colour=RGB
same "RGB by plane" -- series colour=RGB planar=1
same "YBR by plane" -- series colour=YBR_FULL planar=1
same "YBR, two pixels sharing colours" -- series colour=YBR_FULL_422 columns=8
same "a palette of 16 bits" -- series colour=PALETTE
same "a palette of 8" -- series colour=PALETTE entries=8
same "RLE" -- series syntax=rle
same "deflated as a whole" -- multi syntax=deflated
same "many frames in a file" -- multi
same "many frames, pixels in an ultrasound region's cm" -- multi regions=1
is "$(line "$T/out.nrrd" "space directions")" "(0.5,0,0) (0,0.25,0) (0,0,0.75)" "its directions"
same "regions that differ, and the distance that is said here" --spacing .5,.25,.75mm -- multi regions=2
same "many frames, whose distance is said here" --spacing .5,.25,.75mm -- multi between=no
same "Enhanced US Volume, its last frame first" -- enhanced
is "$(line "$T/out.nrrd" "space origin")" "(10,-20,30)" "its origin"
same "its second time" --time 2 -- enhanced times=2 time=1
same "the kind of data that is asked for" --data FLOW_POWER -- enhanced kinds=2 kind=1
same "a maker's own volume, second time" --time 2 -- philips times=2 time=1
is "$(line "$T/out.nrrd" "space directions")" "(0.5,0,0) (0,0.25,0) (0,0,0.75)" "its directions, from private elements"
same "the second of two series" --series 2 -- series second=1 slices=6
same "items in items, 20000 deep" -- multi deep=20000

dicom series slope=2 intercept=-5 columns=2 rows=1 slices=2
check "slope and intercept" us-import -q --raw -o "$T/out.nrrd" "$T/in"
is "$(line "$T/out.nrrd" type)" float "make floats"
is "$(tail -c 16 "$T/out.nrrd" | od -A n -t fF | tr -s ' ' | sed 's/^ //')" "-5 -3 9 11" "of the right values"

dicom enhanced scaled=1 columns=2 rows=1 slices=2
check "a slope a frame" us-import -q --raw -o "$T/out.nrrd" "$T/in"
is "$(tail -c 16 "$T/out.nrrd" | od -A n -t fF | tr -s ' ' | sed 's/^ //')" "0 1 14 16" "scales that frame"

# says PATTERN FILE NAME, says_not: whether a file has a line like this.
says() {
    if grep -aqi -e "$1" "$2"; then ok "$3"; else not_ok "$3"; fi
}
says_not() {
    if grep -aqi -e "$1" "$2"; then not_ok "$3"; else ok "$3"; fi
}

# ---- what is wrong
bad() {
    name=$1 pattern=$2
    shift 2
    dicom "$@"
    fails 1 "$name" "$pattern" us-import -v -o "$T/bad.nrrd" "$T/in"
}
bad "a slice is missing" 'slices: 1 missing between im07\.dcm and im14\.dcm; expected all 0\.75 mm apart' series drop=2
bad "two are" '2 missing between im07\.dcm and im14\.dcm' series drop=2,3
bad "one is there twice" 'im11x\.dcm and im21\.dcm lie at one place' series dup=3
bad "one is shifted" 'im14\.dcm and im21\.dcm lie 0\.95 mm apart; im21\.dcm and im28\.dcm lie 0\.55 mm apart' series shift=3:.2
bad "frames of a file" '1 missing between frame 4 and frame 3|lie .* mm apart' enhanced shift=3:.2
bad "a frame of other pixels" 'frame 2 has pixels of 1 x 0.25 mm, frame 1 of 0.5 x 0.25' enhanced wider=1
bad "they are askew" 'beside the normal of the first slice' series tilt=.2
bad "no spacing" 'no distance between pixels' series spacing=no
bad "regions in cm that differ" 'no distance between pixels; expected PixelSpacing, or ultrasound regions in cm that agree' multi regions=2
bad "no positions" 'has no position' series position=no
bad "no distance between frames" '6 frames, and no distance between them' multi between=no
bad "two series" '2 series: 1: 1 file of 7 x 5 from im00\.dcm, 2: 5 files .*--series N' series second=1
bad "two times" 'volumes of 2 times; expected --time 1 to 2' enhanced times=2
bad "cut" 'im00\.dcm: not whole' series cut=20
bad "two kinds of data" 'several kinds of data; expected --data, one of: FLOW_POWER, TISSUE_INTENSITY' enhanced kinds=2
bad "deflated, and cut" 'deflated elements that do not end' multi syntax=deflated cut=20
bad "colours of another kind" 'pixels of another kind; expected MONOCHROME1' series colour=XYB
bad "colours that are shared in odd rows" 'in odd rows' series colour=YBR_FULL_422 rows=4
bad "too deep" 'more than 100000 items' multi deep=120000
bad "one slice" 'one slice' series slices=1
check "no output is left" test ! -e "$T/bad.nrrd"
dicom series
fails 1 "no such series" '^us-import: --series 3: there is one series, of 6 files; expected 1, or no --series$' us-import --series 3 "$T/in"
dicom series second=1
fails 1 "of two" '^us-import: --series 3: there are 2 series: 1: 1 file of 7 x 5 from file 1 of 6, 2: 5 files of 7 x 5 from file 2 of 6; expected 1 to 2 \(-v says all\)$' us-import --series 3 "$T/in"
dicom series
fails 1 "no such data" 'no frames of FLOW; expected --data of: .not said.' us-import --data FLOW "$T/in"
fails 1 "no such time" 'volumes of 1 time; expected --time 1' us-import --time 2 "$T/in"
echo text >"$T/in/notes.txt"
check "a file of another kind in a folder" us-import -o "$T/out.nrrd" "$T/in"
says '1 file without a DICOM image' "$T/stderr" "is said"
fails 1 "by name it is an error" 'notes\.txt: not a DICOM file' us-import -v "$T/in/notes.txt" "$T/in/im00.dcm"
fails 1 "no file" 'cannot read' us-import "$T/none"
mkdir "$T/empty"
fails 1 "an empty folder" 'no files' us-import "$T/empty"
fails 2 "options of sweeps" 'are for sweeps' us-import --fill 3 "$T/in"
# every length that a file may be cut to
status=0
for cut in 1 40 90 200 300 400 500 600 700; do
    dicom enhanced "cut=$cut" slices=2 columns=3 rows=2
    us-import -o "$T/bad.nrrd" "$T/in" 2>/dev/null
    [ $? -eq 1 ] || status=$cut
done
is "$status" 0 "files cut anywhere are refused"

# ---- crop, burned-in annotation
dicom series burned=YES
check "burned-in annotation" us-import --raw -o "$T/out.nrrd" "$T/in"
says 'warning: 6 files say that they have annotation burned' "$T/stderr" "is said"
check "crop" us-import --raw --crop 1,2,4,5 -o "$T/crop.nrrd" "$T/in"
says_not warning "$T/stderr" "then it is not"
is "$(line "$T/crop.nrrd" sizes) $(line "$T/crop.nrrd" "space origin")" "3 3 6 (10.4,-19.7,29.5)" "what is left, and where"
fails 2 "crop beyond the image" 'crop: 0 to 8 along axis 0' us-import --crop 0,0,8,5 "$T/in"

# ---- nothing that names anybody
for kind in series multi enhanced philips; do
    dicom "$kind"
    us-import --report -o "$T/out.nrrd" "$T/in" 2>"$T/report"
    us-import --raw "$T/in" >"$T/raw.nrrd" 2>>"$T/report"
    gzip -dc <"$T/out.nrrd" >"$T/plain" 2>/dev/null
    LC_ALL=C sed '1,/^$/d' "$T/out.nrrd" | gzip -dc >>"$T/plain"
    cat "$T/out.nrrd" "$T/raw.nrrd" "$T/plain" "$T/report" >"$T/all"
    says_not planted "$T/all" "$kind: no name in any output"
done
says '(0010,0010) *1  PatientName' "$T/report" "the report names elements"
says "from a maker's private elements" "$T/report" "and private geometry"

# ---- a sweep
{
    printf '%s\n' 'ObjectType = Image' 'NDims = 3' 'BinaryData = True' 'BinaryDataByteOrderMSB = False' 'CompressedData = False' \
        'TransformMatrix = 1 0 0 0 1 0 0 0 1' 'Offset = 0 0 0' 'ElementSpacing = 1 1 1' 'DimSize = 4 3 5' 'ElementType = MET_UCHAR'
    for f in 0 1 2 3 4; do
        printf 'Seq_Frame000%d_ImageToReferenceTransform = 0.5 0 0 1 0 0.5 0 2 0 0 1 %s 0 0 0 1\n' "$f" "$f"
        printf 'Seq_Frame000%d_ImageToReferenceTransformStatus = OK\nSeq_Frame000%d_Timestamp = %d\n' "$f" "$f" "$f"
    done
    printf 'ElementDataFile = LOCAL\n'
    awk 'BEGIN { for (f = 0; f < 5; f++) for (i = 0; i < 12; i++) printf "%c", 65 + 8 * f }'
} >"$T/sweep.mha"
check "a sweep" us-import --raw --voxel .5mm -o "$T/out.nrrd" "$T/sweep.mha"
is "$(line "$T/out.nrrd" sizes) $(line "$T/out.nrrd" "space origin")" "4 3 9 (1,2,0)" "its size and place"
is "$(tail -c 108 "$T/out.nrrd" | head -c 1)$(tail -c 108 "$T/out.nrrd" | tail -c 84 | head -c 1)$(tail -c 1 "$T/out.nrrd")" "AIa" \
    "its voxels: of the first and last frames, and of one between"
says '^us-import: transform: ImageToReference$' "$T/stderr" "the transform that was taken"
check "without filling" us-import -q --raw --voxel .5mm --fill 0 -o "$T/out.nrrd" "$T/sweep.mha"
is "$(tail -c 96 "$T/out.nrrd" | head -c 1 | od -A n -t u1 | tr -d ' ')" 0 "a gap stays"
sed '1a UltrasoundImageOrientation = UN' "$T/sweep.mha" >"$T/turned.mha"
check "stored the other way round" us-import -q --raw --voxel .5mm -o "$T/out.nrrd" "$T/turned.mha"
is "$(line "$T/out.nrrd" "space origin") $(line "$T/out.nrrd" "space directions" | sed 's/-0\([,)]\)/0\1/g')" "(2.5,3,0) (-0.5,0,0) (0,-0.5,0) (0,0,0.5)" \
    "it lies where it did, and its axes go back"
check "and cropped" us-import -q --raw --voxel .5mm --crop 1,0,4,2 -o "$T/out.nrrd" "$T/turned.mha"
is "$(line "$T/out.nrrd" sizes) $(line "$T/out.nrrd" "space origin")" "3 2 9 (2,3,0)" "as the file counts"
sed '1a UltrasoundImageOrientation = FM' "$T/sweep.mha" >"$T/turned.mha"
fails 1 "images on their sides" "UltrasoundImageOrientation: 'FM'; expected MF, MN, UF or UN" us-import -v "$T/turned.mha"
echo '1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2' >"$T/calibration"
fails 1 "a calibration that is none" 'not a transform' us-import --calibration "$T/calibration" "$T/sweep.mha"
fails 2 "options of DICOM" 'are for DICOM' us-import --series 1 "$T/sweep.mha"

# ---- real data
if [ -z "$DATA" ]; then
    skip 9 "no shared data"
    done_testing
fi
U=$DATA/ultrasound
check "the fetal head" us-import --report --raw -o "$T/head.nrrd" "$U/fetal-head"
cat "$T/head.nrrd" "$T/stderr" >"$T/all"
says_not planted "$T/all" "no name in its outputs"
is "$(line "$T/head.nrrd" sizes)" "211 232 153" "its size"
check "the spine phantom" us-import -o "$T/spine.nrrd" "$U/SpinePhantomFreehandReconstructed.mha"
# An array of 38 mm is 467 pixels wide; how the image lies to its marker is not known, so that pixels lie along the marker's axes.
printf '0.0814 0 0 -33.34\n0 0.0814 0 -0.16\n0 0 0.0814 0\n0 0 0 1\n' >"$T/calibration"
check "the bone sweep" us-import --voxel .4mm --crop 176,2,643,616 --calibration "$T/calibration" -o "$T/bone.nrrd" "$U/BoneUltrasound_L14.igs.mha"
says '^us-import: transform: ProbeToReference, after --calibration$' "$T/stderr" "and which transform was taken"
says '21 frames (0 without tracking left out) to 99 x 127 x 24 voxels of 0.4 mm' "$T/stderr" "its size: 38 mm wide, 50 deep"

reader=
for p in python3 /usr/bin/python3; do
    "$p" -c 'import pydicom, vtkmodules.vtkIOImage' 2>/dev/null && reader=$p
done
if [ -z "$reader" ]; then
    skip 2 "no pydicom and VTK for Python (python3-pydicom, python3-vtk9)"
else
    check "geometry and voxels as pydicom reads them" "$reader" tests/cli/read_dicom.py "$T/head.nrrd" "$U/fetal-head"
    check "geometry and voxels as VTK reads them" "$reader" tests/cli/read_meta.py "$T/spine.nrrd" "$U/SpinePhantomFreehandReconstructed.mha"
fi
done_testing
