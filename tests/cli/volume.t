#!/bin/sh
# Volume images: what we read and what VTK's readers read are the same, of real images, of ones made here, and of what we write.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

voxels=${BUILD:-build}/tests/cli/list_voxels
python=
for p in python3 /usr/bin/python3; do
    "$p" -c 'import vtkmodules.vtkIOImage' 2>/dev/null && python=$p && break
done
[ -n "$python" ] || skip_all "no VTK for Python (python3-vtk9)"

# agree NAME FILE: the file, and what we write of it, raw and compressed, by both readers.
agree() {
    "$voxels" "$2" "$T/gzip.nrrd" >"$T/ours" 2>&1
    "$voxels" "$2" "$T/raw.nrrd" raw >/dev/null
    is "$("$python" tests/cli/read_volume.py "$2" 2>&1)" "$(cat "$T/ours")" "$1: as VTK reads it"
    for kind in raw gzip; do
        is "$("$python" tests/cli/read_volume.py "$T/$kind.nrrd" 2>&1)" "$(cat "$T/ours")" "$1: VTK reads the same in our $kind NRRD"
    done
    is "$("$voxels" "$T/raw.nrrd" "$T/again.nrrd")" "$(cat "$T/ours")" "$1: and so do we"
    check "$1: written twice, the same bytes" cmp "$T/gzip.nrrd" "$T/again.nrrd"
}

# made NAME TYPE BYTES HEADER: a MetaImage of 12 x 5 x 4 voxels whose bytes count up. (A first axis of fewer than 10 VTK's NRRD reader takes
# for the components of a voxel.)
made() {
    {
        printf 'ObjectType = Image\nNDims = 3\nDimSize = 12 5 4\nElementType = %s\n%b\nElementDataFile = LOCAL\n' "$2" "$4"
        awk -v bytes="$3" 'BEGIN { for (i = 0; i < 240 * bytes; i++) printf "\\%03o", (i * 37 + 11) % 251 }' | {
            read -r octal
            # shellcheck disable=SC2059 # it is the format: bytes in octal
            printf "$octal"
        }
    } >"$T/made.mha"
    agree "$1" "$T/made.mha"
}
made "bytes" MET_UCHAR 1 'ElementSpacing = 0.5 0.25 2\nOffset = 1 -2 3.125'
made "shorts, the most significant byte first" MET_SHORT 2 'ElementByteOrderMSB = True\nElementSpacing = 1 2 3'
made "unsigned shorts" MET_USHORT 2 'BinaryDataByteOrderMSB = False'
made "ints" MET_INT 4 'ElementSpacing = 1e-3 1 1'
made "doubles" MET_DOUBLE 8 'Position = 7 8 9'

if [ -n "$DATA" ]; then
    agree "the spine phantom" "$DATA/ultrasound/SpinePhantomFreehandReconstructed.mha"
    agree "the bone sweep" "$DATA/ultrasound/BoneUltrasound_L14.igs.mha"
else
    skip 10 "no shared data"
fi

# A pipe is as good as a file.
"$voxels" "$T/made.mha" >"$T/want"
is "$(gzip -c "$T/made.mha" | "$voxels" -)" "$(cat "$T/want")" "gzip around it all, from a pipe"
head -c 300 "$T/made.mha" >"$T/cut.mha"
fails 1 "cut short" "cut.mha: data for only [0-9]* of 12 x 5 x 4 voxels; expected exactly these" "$voxels" "$T/cut.mha"
done_testing
