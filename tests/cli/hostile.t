#!/bin/sh
# Small files that claim much: sizes of 2^31, 2^40, 2^62 in each format, lengths of 4 GiB, frames that say another size, elements and images far
# apart, gzip within gzip. Each is refused in one line, in little memory: at most 64 MiB beyond what the tool takes to say its version. With SINEW_LONG
# of every axis, and of every kind of element.
. "$(dirname "$0")/lib.sh"

peak=${BUILD:-build}/tests/cli/peak
[ -x "$peak" ] || skip_all "no $peak (make unit)"
export SINEW_THREADS=1
tet=tests/golden/v1/tet.text
limit='ulimit -v 600000;'
[ -z "$SINEW_SANITIZED" ] || limit=

# base TOOL: KiB that it takes for nothing, once a tool.
base() {
    [ -f "$T/base-$1" ] || "$peak" "$T/base-$1" "$1" -V >"$T/none" 2>&1
    cat "$T/base-$1"
}

# little NAME PATTERN COMMAND...: with status 1 and one line (warnings apart) that matches, little memory, and no lack of it.
little() {
    name=$1 pattern=$2
    shift 2
    tool=$1
    [ "$tool" != sinew ] || tool=sinew-$2
    # shellcheck disable=SC2016 # for the inner shell
    timeout 180 sh -c "$limit"' exec "$@"' sh "$peak" "$T/peak" "$@" <"$T/in" >"$T/stdout" 2>"$T/stderr"
    status=$?
    used=$(($(cat "$T/peak") - $(base "$tool")))
    lines=$(grep -c -v 'warning:' "$T/stderr")
    if [ "$status" -eq 1 ] && [ "$lines" -eq 1 ] && grep -Eq -e "$pattern" "$T/stderr" && ! grep -q 'out of memory' "$T/stderr" &&
        { [ "$used" -lt 65536 ] || [ -n "$SINEW_SANITIZED" ]; }; then
        ok "$name"
    else
        not_ok "$name"
        diag "status $status, $lines lines, $used KiB more than for -V; wanted: $pattern"
        diag_file "$T/stderr"
    fi
}

# bytes OCTAL...: as printf has them.
bytes() {
    # shellcheck disable=SC2059 # the format is the bytes
    printf "$1"
}

: >"$T/in"
large='2147483648 1099511627776 4611686018427387904'

# Models.
for count in $large; do
    printf '%%sinew 1 text\naxis n %s\narray x f64 1 n 3\n0 0 0\n' "$count" >"$T/in"
    little "text: $count rows that are not there" 'cut short|too large for any memory' sinew info
    printf '%%sinew 1 text\naxis n %s\narray x str 1 n 1\n"a"\nend\n' "$count" >"$T/in"
    little "text: $count strings" 'row 1|too large for any memory' sinew info
    printf '%%sinew 1 text\nblock xtra 00000000 %s\n00\n' "$count" >"$T/in"
    little "text: a block of $count bytes" 'cut short' sinew info
    for axis in node ${SINEW_LONG:+element volume material muscle anchor} s/vertex; do
        printf '%%sinew 1 text\naxis %s %s\nend\n' "$axis" "$count" >"$T/in"
        is "$("$peak" "$T/peak" timeout 180 sinew info --json <"$T/in" | grep -c "\"$axis\": $count")" 1 \
            "an axis $axis of $count and nothing over it is described, row by row of nothing"
        little "and attach says what it lacks" 'the model has no ' attach
    done
done
printf '%%sinew 1 text\naxis n 3\narray x u8 1 n 2147483647\n0 0 0\nend\n' >"$T/in"
little "text: 2^31 - 1 columns" 'row 0' sinew info
{
    bytes '\211sinew\r\n\032\n\001\000\011\232\352\064'
    bytes 'META\000\000\000\000\377\377\377\377\377\377\377\077\377\377\377\377'
} >"$T/in"
little "binary: a string of 4 GiB" 'cut short' sinew info
{
    bytes '\211sinew\r\n\032\n\001\000\011\232\352\064'
    bytes 'xtra\000\000\000\000\000\000\000\000\000\000\000\040abc'
} >"$T/in"
little "binary: a block of 2^61 bytes" 'cut short' sinew info
little "the same for a tool of frames" 'cut short' sinew deform tests/cli/cube.obj
head -c 100 "$T/in" | gzip -c | gzip -c >"$T/twice"
cp "$T/twice" "$T/in"
little "a model gzipped twice" 'not a sinew model' sinew info
awk '/^array element.lattice/ { print; getline; print; getline; print "60000 30000 30000"; getline; if ($0 !~ /^crc/) print; next } { print }' \
    tests/cli/small.sinew >"$T/in"
little "two elements far apart" 'spread over' sinew bind --unit mm tests/cli/cube.obj

# Volumes. us-surface reads both formats.
: >"$T/in"
for sizes in '2147483648 1 1' '1099511627776 1 1' '1099511627776 4194304 1' '3 4611686018427387904 3'; do
    for encoding in raw ascii gzip; do
        printf 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: %s\nencoding: %s\n\n1 2' "$sizes" "$encoding" >"$T/a.nrrd"
        little "NRRD: $encoding, $sizes" 'data for only|expected at most the memory|damaged|more than can be counted' us-surface -i 1 "$T/a.nrrd"
    done
    printf 'ObjectType = Image\nNDims = 3\nDimSize = %s\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nab' "$sizes" >"$T/a.mha"
    little "MetaImage: $sizes" 'data for only|expected at most the memory|more than can be counted' us-surface -i 1 "$T/a.mha"
done
head -c 300000000 /dev/zero | gzip -9c >"$T/zeros.gz"
{ printf 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 300000000 1 1\nencoding: gzip\n\n' && cat "$T/zeros.gz"; } | gzip -9c >"$T/a.nrrd"
little "NRRD: gzip within gzip, $(wc -c <"$T/a.nrrd") bytes for 300 MB" 'compressed twice' us-surface -i 1 "$T/a.nrrd"
{ printf 'NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 1 1\nencoding: gzip\n\n' && cat "$T/zeros.gz"; } >"$T/a.nrrd"
little "NRRD: more than it says, 300 MB" 'data for more than' us-surface -i 1 "$T/a.nrrd"
rm "$T/zeros.gz"

# Sweeps: two images a kilometre apart.
{
    sed '1,2d; s/ProbeToTracker/ImageToReference/; s/^\(Seq_Frame0002_.*Transform = .*\) 32 0 0 0 1$/\1 1000000 0 0 0 1/; s/^DimSize = 4 3 2/DimSize = 4 3 3/' \
        tests/fuzz/seeds/sweep/small.mha | sed '1i\
ObjectType = Image\
NDims = 3\
ElementType = MET_UCHAR' && printf 'abcdefghijklabcdefghijklabcdefghijkl'
} >"$T/a.mha"
grep -q 1000000 "$T/a.mha" || diag "the sweep was not changed"
little "a sweep with an image a kilometre away" 'far apart|more than memory' us-import -q --voxel 0.5mm "$T/a.mha"

# Meshes: what an OBJ points to and does not have, numbers as large as can be.
printf 'v 0 0 0\nf 1 2147483648 4611686018427387904\n' >"$T/a.obj"
little "OBJ: vertex 2^31" 'a.obj:2: ' voxelise --unit mm -s 1 "$T/a.obj"
printf 'v 0 0 0\nv 1e300 0 0\nv 0 1e300 1e300\nf 1 2 3\n' >"$T/a.obj"
little "OBJ: 1e300 mm" 'a.obj' voxelise --unit mm -s 1 --allow-open "$T/a.obj"
printf 'v 0 0 0\nv 1e9 0 0\nv 0 1e9 1e9\nv 0 1e9 0\ng skin\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n' >"$T/a.obj"
little "OBJ: 10^27 voxels" 'lattice of' voxelise --unit mm -s 1 "$T/a.obj"

# Files that people write.
cp tests/golden/v1/hex.text "$T/in"
head -c 100000 /dev/zero | tr '\000' 'a' >"$T/long"
little "materials: one word of 100 KB" 'long:1: ' tled-run --materials "$T/long"
little "script: one word of 100 KB" 'long:1: ' tled-run --script "$T/long"
# Without its frames, behind which this run could not go on.
awk '/^frame / { print "end"; exit } { print }' "$tet" >"$T/in"
little "poses: one word of 100 KB" 'long:1: ' msds-run -q --probe sphere:1cm --poses "$T/long"
little "volumes: one word of 100 KB" 'long:1: ' voxelise --unit mm -s 1 --volumes "$T/long" tests/cli/cube.obj
: >"$T/in"

# DICOM: elements that claim 4 GiB, where the syntax is said and where it is not; images larger than their file can hold.
head_of() { # SYNTAX, of 18 bytes
    head -c 128 /dev/zero
    bytes 'DICM\002\000\020\000UI\022\000'
    printf '%s' "$1"
}
for syntax in '1.2.840.10008.1.2 ' '1.2.840.10008.1.2.' '1.2.              '; do
    for vr in OB UN ${SINEW_LONG:+UT '??'} zz; do
        { head_of "$syntax" && bytes '\340\177\020\000' && printf '%s' "$vr" && bytes '\000\000\376\377\377\377ab'; } >"$T/a.dcm"
        little "DICOM: ($syntax) $vr of 4 GiB" 'us-import: file 1 of 1: ' us-import "$T/a.dcm"
    done
done
{ head_of '1.2.840.10008.1.2.' && bytes '\010\000\000\001UN\000\000\377\377\377\377\376\377\000\340\377\377\377\377\010\000\000\001\376\377\377\177ab'; } >"$T/a.dcm"
little "DICOM: 2 GiB within an item within UN" 'us-import: file 1 of 1: ' us-import "$T/a.dcm"
if [ ! -f tests/fuzz/seeds/dicom/jpegbase ] || ! have perl; then
    skip 5 "no perl"
else
    for kind in jpegbase jpegll jpegls jpeg2000; do
        perl -0777 -pe 's/(\xff[\xc0\xc3\xf7]\x00.[\x08-\x10])....|(\xff\x4f\xff\x51..........)........|(\xff\x51....)......../($1 || $2 || $3) . ($1 ? "\xff\xff\xff\xff" : "\x00\x00\xff\xff\x00\x00\xff\xff")/es' \
            "tests/fuzz/seeds/dicom/$kind" >"$T/a.dcm"
        cmp -s "$T/a.dcm" "tests/fuzz/seeds/dicom/$kind" && diag "$kind was not changed"
        little "DICOM: $kind of 65535 x 65535 in a small image" 'another (size|shape)' us-import "$T/a.dcm"
    done
    gzip -c tests/fuzz/seeds/dicom/deflated >"$T/a.dcm"
    little "DICOM: deflated within gzip" 'compressed twice' us-import "$T/a.dcm"
fi

done_testing
