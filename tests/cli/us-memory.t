#!/bin/sh
# How much memory the tools take that read volumes: what their pages say, in bytes a voxel beyond what the program takes for a small one; and
# that --memory refuses what takes more, before it is taken.
. "$(dirname "$0")/lib.sh"
[ -z "$SINEW_SANITIZED" ] || skip_all "sanitizers take memory of their own"
peak=${BUILD:-build}/tests/cli/peak
[ -x "$peak" ] || skip_all "no $peak (make unit)"

# header TYPE SIDE: of a raw cube of SIDE^3 voxels.
header() {
    printf '%s\n' NRRD0004 "type: $1" 'dimension: 3' 'space: LPS' "sizes: $2 $2 $2" 'space directions: (.5,0,0) (0,.5,0) (0,0,.5)' \
        'endian: little' 'encoding: raw' 'space origin: (0,0,0)' ''
}
# bytes COUNT: of a pattern that repeats at no voxel's distance.
bytes() {
    yes 'a pattern that repeats, and not with the rows of a volume' | head -c "$1"
}
{ header uint8 200 && bytes 8000000; } >"$T/big.nrrd"
{ header int16 200 && bytes 16000000; } >"$T/big16.nrrd"
{ header uint8 4 && bytes 64; } >"$T/small.nrrd"
{ header int16 4 && bytes 128; } >"$T/small16.nrrd"
{ header uint8 200 && head -c 8000000 /dev/zero | tr '\0' '\144'; } >"$T/flat.nrrd"
echo '0 .05 .05 0 0 0 0 1' >"$T/pose.tum"

# most LIMIT NAME VOLUME SMALL COMMAND...: it takes at most LIMIT bytes a voxel; @ stands for the volume.
most() {
    limit=$1 name=$2 volume=$3 small=$4
    shift 4
    for of in "$small" "$volume"; do
        for word in "$@"; do
            shift
            [ "$word" != @ ] || word=$of
            set -- "$@" "$word"
        done
        "$peak" "$T/peak.$(basename "$of")" "$@" >"$T/stdout" 2>"$T/stderr" || diag_file "$T/stderr"
        for word in "$@"; do
            shift
            [ "$word" != "$of" ] || word=@
            set -- "$@" "$word"
        done
    done
    took=$(awk -v big="$(cat "$T/peak.$(basename "$volume")")" -v small="$(cat "$T/peak.$(basename "$small")")" \
        'BEGIN { printf "%.2f", (big - small) * 1024 / 8e6 }')
    is "$(awk "BEGIN { print ($took > .5 && $took <= $limit) }")" 1 "$name: $took bytes a voxel, at most $limit"
}
most 2.45 us-slice "$T/big.nrrd" "$T/small.nrrd" us-slice -q --rigid --size 64x64 --poses "$T/pose.tum" -o "$T/x.pgm" @
most 2.45 "us-slice, int16" "$T/big16.nrrd" "$T/small16.nrrd" us-slice -q --rigid --size 64x64 --poses "$T/pose.tum" -o "$T/x.pgm" @
most 2.2 us-segment "$T/big.nrrd" "$T/small.nrrd" us-segment -q -n a --low 100 -o "$T/x.nrrd" @
most 2.5 "us-segment, with all that it can" "$T/big.nrrd" "$T/small.nrrd" us-segment -q -n a --low 80 --tolerance 100 --seed-voxel 1,1,1 \
    --filter .5mm --smooth .5mm --largest --fill -o "$T/x.nrrd" @
most 3.2 "us-segment, int16" "$T/big16.nrrd" "$T/small16.nrrd" us-segment -q -n a --low 100 -o "$T/x.nrrd" @
# The surface is 480,000 triangles around the cube, at 40 bytes each at most: 2.4 bytes a voxel.
most 7.4 us-surface "$T/flat.nrrd" "$T/small.nrrd" us-surface -q -i 50 -o "$T/x.obj" @
most 1.3 us-import "$T/big.nrrd" "$T/small.nrrd" us-import -q -o "$T/x.nrrd" @
most 1.3 msds-mesh "$T/big.nrrd" "$T/small.nrrd" msds-mesh -q --nodes 3x3x3 --like @ -o "$T/x.sinew"

# All of a volume is joined: the walk has more to hold than it may, and comes back for it.
check "a region of all voxels" us-segment -n a --low 0 --seed-voxel 100,100,100 -o "$T/x.nrrd" "$T/flat.nrrd"
is "$(sed 's/.*: \([0-9]*\) voxels.*/\1/' "$T/stderr")" 8000000 "is found whole"

# The last bytes of what is compressed around the file, and not all of it.
{ header uint8 4 | sed '/^$/d' && printf 'byte skip: -1\n\n' && head -c 50000000 /dev/zero && bytes 64; } | gzip -1 >"$T/bomb.nrrd.gz"
check "byte skip: -1 within gzip" "$peak" "$T/peak.bomb" us-import -q --raw -o "$T/last.nrrd" "$T/bomb.nrrd.gz"
is "$(tail -c 64 "$T/last.nrrd" | cksum)" "$(bytes 64 | cksum)" "the last bytes are the voxels"
is "$(awk "BEGIN { print ($(cat "$T/peak.bomb") - $(cat "$T/peak.small.nrrd") < 8192) }")" 1 "in a ring of them: $(cat "$T/peak.bomb") KiB in all"
for left in 63 0; do
    { header uint8 4 | sed '/^$/d' && printf 'byte skip: -1\n\n' && bytes "$left"; } >"$T/few.nrrd"
    fails 1 "with $left bytes for 64 voxels" "data for only $left of 4 x 4 x 4 voxels" us-import -v -o "$T/none.nrrd" "$T/few.nrrd"
done
for more in 0 1 63 64 65 3000000; do # the ring ends anywhere
    { header int16 4 | sed '/^$/d' && printf 'byte skip: -1\n\n' && head -c "$more" /dev/zero && bytes 128; } >"$T/ring.nrrd"
    us-import -q --raw -o "$T/last.nrrd" "$T/ring.nrrd"
    is "$(tail -c 128 "$T/last.nrrd" | cksum)" "$(bytes 128 | cksum)" "and $more bytes before them"
done

# --memory: one line that says what it takes, and nothing is written; with that much, it goes.
allows() {
    name=$1 least=$2
    shift 2
    rm -f "$T/out"
    "$@" --memory 1MB -o "$T/out" >"$T/stdout" 2>"$T/stderr"
    status=$?
    said=$(sed -n 's/.*take \([0-9.]* [kM]*B\).*memory.*; --memory allows 1 MB.*/\1/p' "$T/stderr")
    is "$status $(wc -l <"$T/stderr" | tr -d ' ') $([ -e "$T/out" ] && echo written)" "1 1 " "$name: refused in a line: $said"
    is "$(echo "$said" | awk -v least="$least" '{ print ($1 >= least && $1 < 1.2 * least + 1 && $2 == "MB") }')" 1 "$name: all of it is counted"
    check "$name: with a little more than that it goes" "$@" -q --memory "$(echo "$said" | awk '{ print $1 * 1.01 + .1 }')MB" -o "$T/out"
}
allows us-slice 18 us-slice --rigid --size 64x64 --poses "$T/pose.tum" "$T/big.nrrd"
fails 1 "us-slice --labels, beside the volume" '200 x 200 x 200 voxels of 1 byte take 26.7 MB of memory here; --memory allows 26 MB' \
    us-slice --rigid --size 64x64 --poses "$T/pose.tum" --labels "$T/big.nrrd" --memory 26MB -o "$T/none.pgm" "$T/big.nrrd"
allows us-segment 16 us-segment -n a --low 100 "$T/big.nrrd"
allows "us-segment --filter" 17 us-segment -n a --low 20 --filter 1mm "$T/big.nrrd"
allows "us-segment --onto" 16 us-segment -n a --low 100 --onto "$T/flat.nrrd" "$T/flat.nrrd"
allows us-surface 40 us-surface -i 50 "$T/flat.nrrd"
allows us-import 8 us-import "$T/big.nrrd"
allows msds-mesh 8 msds-mesh --nodes 3x3x3 --like "$T/big.nrrd"
fails 1 "labels whose samples are too many" 'label_100: the volume and the samples around this label take 40 MB of memory; --memory allows 20 MB' \
    us-surface -l 100 --memory 20MB -o "$T/none.obj" "$T/flat.nrrd"
check "and with more" us-surface -q -l 100 --memory 41MB -o "$T/x.obj" "$T/flat.nrrd"
if have python3; then
    python3 tests/cli/dicom.py "$T/in" series columns=200 rows=200 slices=20 && rm "$T/in/expected"
    fails 1 "DICOM" 'pixels of .* by file 10 of 20, and the volume that is made of them, take more memory than --memory allows, 750 kB' \
        us-import --memory 750kB -o "$T/none.nrrd" "$T/in"
    check "DICOM, all of it" us-import -q --memory 1.6MB -o "$T/x.nrrd" "$T/in"
else
    skip 2 "no python3 to write DICOM files with"
fi
{
    printf '%s\n' 'ObjectType = Image' 'NDims = 3' 'BinaryData = True' 'BinaryDataByteOrderMSB = False' 'CompressedData = False' \
        'TransformMatrix = 1 0 0 0 1 0 0 0 1' 'Offset = 0 0 0' 'ElementSpacing = 1 1 1' 'DimSize = 50 50 40' 'ElementType = MET_UCHAR'
    for f in $(seq 0 39); do
        printf 'Seq_Frame%04d_ImageToReferenceTransform = 1 0 0 0 0 1 0 0 0 0 1 %d 0 0 0 1\nSeq_Frame%04d_Timestamp = %d\n' "$f" "$f" "$f" "$f"
    done
    printf 'ElementDataFile = LOCAL\n'
    bytes 100000
} >"$T/sweep.mha"
fails 1 "a sweep" 'the images, and their volume in voxels of 1 mm, take 1 MB of memory or more; --memory allows 900 kB: expected a larger --voxel, or more' \
    us-import --memory 900kB -o "$T/none.nrrd" "$T/sweep.mha"
check "with more" us-import -q --memory 1001kB -o "$T/x.nrrd" "$T/sweep.mha"
check "no output is left" test ! -e "$T/none.nrrd" -a ! -e "$T/none.obj" -a ! -e "$T/none.pgm"
for size in 0 -1MB 2 2G 2gb 1e30GB 'nan MB' GB 1KiBB 0.5B; do
    fails 2 "--memory '$size'" "--memory '$size': expected a size such as 500MB or 2GiB" us-import --memory "$size" "$T/small.nrrd"
done
for size in 1GB 1.5GiB '2 TB' 64KiB 4096B 1e3kB; do
    check "--memory '$size'" us-import -q --memory "$size" -o "$T/x.nrrd" "$T/small.nrrd"
done
done_testing
