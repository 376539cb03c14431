#!/bin/sh
# Headers that lie, of DICOM, MetaImage and NRRD: one line with the reason, exit 1, no output, and little memory; data in files
# elsewhere, names that a shell would take for commands, names with blanks. The other tools have us-import's readers: they are given every fourth
# header, and with SINEW_LONG all.
. "$(dirname "$0")/lib.sh"

# As much as may be mapped, but where a sanitizer maps terabytes.
# shellcheck disable=SC3045 # where a shell has no ulimit -v, nothing is limited
[ "${SINEW_SANITIZED:-}" ] || ulimit -v 1000000 2>/dev/null

headers=0
# bad NAME PATTERN FILE: each tool that reads volumes refuses it.
bad() {
    bad_name=$1 bad_pattern=$2 bad_file=$3
    fails 1 "$bad_name" "$bad_pattern" us-import -v -o "$T/none.nrrd" "$bad_file"
    is "$(wc -l <"$T/stderr" | tr -d ' ')" 1 "$bad_name: one line"
    headers=$((headers + 1))
    [ "$SINEW_LONG" ] || [ $((headers % 4)) -eq 1 ] || return 0
    fails 1 "$bad_name: us-segment" "$bad_pattern" us-segment -n a --low 1 -o "$T/none.nrrd" "$bad_file"
    fails 1 "$bad_name: us-surface" "$bad_pattern" us-surface -i 1 -o "$T/none.nrrd" "$bad_file"
}

# meta SED: a MetaImage of 3 x 3 x 3 bytes, altered.
meta() {
    {
        printf '%s\n' 'ObjectType = Image' 'NDims = 3' 'BinaryData = True' 'BinaryDataByteOrderMSB = False' 'CompressedData = False' \
            'TransformMatrix = 1 0 0 0 1 0 0 0 1' 'Offset = 0 0 0' 'ElementSpacing = 1 1 1' 'DimSize = 3 3 3' 'ElementType = MET_UCHAR' \
            'ElementDataFile = LOCAL' | sed "$1"
        printf 'abcdefghijklmnopqrstuvwxyzA'
    } >"$T/v.mha"
}
meta ''
check "a MetaImage that is right" us-import -q -o "$T/ok.nrrd" "$T/v.mha"
while IFS='|' read -r name pattern edit; do
    meta "$edit"
    bad "MetaImage: $name" "$T/.*$pattern" "$T/v.mha"
done <<'END'
huge sizes|2000000000|s/^DimSize.*/DimSize = 2000000000 2000000000 2000000000/
sizes beyond memory|voxels|s/^DimSize.*/DimSize = 100000 100000 1000/
more voxels than data|data for only 27|s/^DimSize.*/DimSize = 1000 1000 100/
fewer voxels than data|more than 8|s/^DimSize.*/DimSize = 2 2 2/
no size|DimSize|/^DimSize/d
size 0|DimSize|s/^DimSize.*/DimSize = 0 3 3/
negative size|DimSize|s/^DimSize.*/DimSize = -3 3 3/
size that is no number|DimSize|s/^DimSize.*/DimSize = 3 3 x/
negative spacing|ElementSpacing|s/^ElementSpacing.*/ElementSpacing = 1 -1 1/
spacing 0|ElementSpacing|s/^ElementSpacing.*/ElementSpacing = 1 0 1/
spacing that is not a number|ElementSpacing|s/^ElementSpacing.*/ElementSpacing = 1 nan 1/
singular orientation|.|s/^Transform.*/TransformMatrix = 1 0 0 1 0 0 0 0 1/
orientation of nothing|.|s/^Transform.*/TransformMatrix = 0 0 0 0 0 0 0 0 0/
infinite origin|Offset|s/^Offset.*/Offset = 0 inf 0/
17 dimensions|NDims|s/^NDims.*/NDims = 17/
an unknown type|ElementType|s/MET_UCHAR/MET_STRING/
another type's length|data for only|s/MET_UCHAR/MET_DOUBLE/
compressed, which it is not|.|s/^CompressedData .*/CompressedData = True/
data in another folder|outside its folder|s/LOCAL/..\/..\/..\/..\/..\/..\/etc\/passwd/
data at an absolute path|outside its folder|s/LOCAL/\/etc\/passwd/
data of a device|outside its folder|s/LOCAL/\/dev\/zero/
data in a list|.|s/LOCAL/LIST/
data in no file|none\.raw|s/LOCAL/none.raw/
END

# nrrd SED: the same as NRRD.
nrrd() {
    {
        printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 3 3 3' \
            'space directions: (1,0,0) (0,1,0) (0,0,1)' 'encoding: raw' 'space origin: (0,0,0)' | sed "$1"
        printf '\nabcdefghijklmnopqrstuvwxyzA'
    } >"$T/v.nrrd"
}
nrrd ''
check "a NRRD that is right" us-import -q -o "$T/ok.nrrd" "$T/v.nrrd"
while IFS='|' read -r name pattern edit; do
    nrrd "$edit"
    bad "NRRD: $name" "$T/.*$pattern" "$T/v.nrrd"
done <<'END'
huge sizes|4000000000|s/^sizes.*/sizes: 4000000000 4000000000 4000000000/
sizes beyond memory|voxels|s/^sizes.*/sizes: 100000 100000 1000/
more voxels than data|data for only 27|s/^sizes.*/sizes: 1000 1000 100/
fewer voxels than data|more than 8|s/^sizes.*/sizes: 2 2 2/
no sizes|sizes|/^sizes/d
a size of 0|sizes|s/^sizes.*/sizes: 0 3 3/
a negative size|sizes|s/^sizes.*/sizes: -3 3 3/
17 dimensions|dimension|s/^dimension.*/dimension: 17/
singular directions|.|s/^space dir.*/space directions: (1,0,0) (1,0,0) (0,0,1)/
directions of nothing|.|s/^space dir.*/space directions: (0,0,0) (0,1,0) (0,0,1)/
a direction that is no number|space directions|s/^space dir.*/space directions: (nan,0,0) (0,1,0) (0,0,1)/
an unknown encoding|encoding|s/^encoding.*/encoding: bzip2/
an unknown type|type|s/^type.*/type: block/
gzip, which it is not|.|s/^encoding.*/encoding: gzip/
bytes of another order without endian|endian|s/uint8/int16/
data in another folder|outside its folder|s/^encoding.*/&\ndata file: ..\/..\/..\/..\/..\/..\/etc\/passwd/
data at an absolute path|outside its folder|s/^encoding.*/&\ndata file: \/etc\/passwd/
data of a command|touch touched: cannot open|s/^encoding.*/&\ndata file: |touch touched/
data in files by number|data file|s/^encoding.*/&\ndata file: v%03d.raw 1 3 1/
END
: >"$T/v.nrrd"
fails 1 "an empty file" 'v\.nrrd' us-surface -i 1 "$T/v.nrrd"

# ---- DICOM
if have python3; then
    while IFS='|' read -r name pattern kind set; do
        rm -rf "$T/in"
        python3 tests/cli/dicom.py "$T/in" "$kind" "set=$set" && rm "$T/in/expected"
        fails 1 "DICOM: $name" "$pattern" us-import -v -o "$T/none.nrrd" "$T/in"
        is "$(wc -l <"$T/stderr" | tr -d ' ')" 1 "DICOM: $name: one line"
    done <<'END'
no rows|im.*: an image of 0 rows|series|00280010:US:0
more pixels than there are|im.*: 36 bytes of pixels; expected|series|00280010:US:65535
frames without end|multi\.dcm: .* bytes of pixels; expected|multi|00280008:IS:2147483647
no frames|multi\.dcm: 0 frames|multi|00280008:IS:0
half a frame|multi\.dcm: 1\.5 frames|multi|00280008:IS:1.5
12 bits allocated|of 12 bits|series|00280100:US:12
more bits than allocated|samples of 8 bits a pixel, 9 of them|series|00280101:US:9
a high bit beyond|samples|series|00280102:US:15
samples without end|65535 samples|series|00280002:US:65535
an orientation of nothing|im.*orientation|series|00200037:DS:0\0\0\0\0\0
a singular orientation|im.*orientation|series|00200037:DS:1\0\0\1\0\0
negative spacing|no distance between pixels|series|00280030:DS:-0.5\-0.5
spacing 0|no distance between pixels|series|00280030:DS:0\0
spacing that is no number|no distance between pixels|series|00280030:DS:much\more
a position that is no number|one of several images has no position|series|00200032:DS:here
a position that is infinite|one of several images has no position|series|00200032:DS:1e999\0\0
no place twice|lie at one place|series|00200032:DS:1\2\3
planes of a maker without end|planes of its depth need|philips|30011001:UL:60000
no distance of a maker|private elements of its depth|philips|30011003:FD:nan
END
    # A head that is cut anywhere, or that claims a syntax that nobody has.
    rm -rf "$T/in"
    python3 tests/cli/dicom.py "$T/in" multi && rm "$T/in/expected"
    head -c 140 "$T/in/multi.dcm" >"$T/short.dcm"
    fails 1 "DICOM: a head alone" 'short\.dcm' us-import -v "$T/short.dcm"
    LC_ALL=C sed 's/1\.2\.840\.10008\.1\.2\.1/1.2.840.10008.1.2.7/' "$T/in/multi.dcm" >"$T/syntax.dcm"
    fails 1 "DICOM: a transfer syntax of nobody" 'transfer syntax .1\.2\.840\.10008\.1\.2\.7.; expected' us-import -v "$T/syntax.dcm"
else
    skip 38 "no python3 to write DICOM files with"
fi
check "no output is left" test ! -e "$T/none.nrrd"
check "no command was run" test ! -e touched -a ! -e "$T/touched"

# ---- names that are unusual, and good
mkdir "$T/a folder; touch touched" && cd "$T/a folder; touch touched" || exit 1
# shellcheck disable=SC2016 # not to be expanded
mv "$T/ok.nrrd" './$(touch touched) "v".nrrd'
nrrd 's/^encoding.*/&\ndata file: the voxels, raw.raw/'
LC_ALL=C sed '/^$/,$d' "$T/v.nrrd" >'a b.nhdr'
printf 'abcdefghijklmnopqrstuvwxyzA' >'the voxels, raw.raw'
# shellcheck disable=SC2016
for f in './$(touch touched) "v".nrrd' 'a b.nhdr'; do
    check "a name with blanks and signs: $f" us-import -q -o 'an output.nrrd' "$f"
    check "a label of it" us-segment -q -n 'a b' --low 100 --onto 'an output.nrrd' -o 'l a.nrrd' "$f"
    check "its surface" us-surface -q -l 'a b' -o 's a.obj' 'l a.nrrd'
done
is "$(grep '^g' 's a.obj')" "g a_b" "a label's name with a blank is a group's word"
check "no command was run" test ! -e touched
done_testing
