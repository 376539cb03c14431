#!/bin/sh
# us-import: pixels as other people's tools compress them (DCMTK's, and OpenJPEG's), without loss and with; and what nobody here
# decompresses. Three slices a series, which are compressed one by one; with SINEW_LONG six.
. "$(dirname "$0")/lib.sh"
have python3 || skip_all "no python3 to write DICOM files with"
have dcmcjpeg || skip_all "no DCMTK tools to compress with (dcmtk)"

slices=${SINEW_LONG:+6}
slices=${slices:-3}

# make KIND KEY=VALUE...: files in $T/in; their voxels in $T/expected.
make_files() {
    rm -rf "$T/in" "$T/packed"
    kind=$1
    shift
    python3 tests/cli/dicom.py "$T/in" "$kind" slices="$slices" "$@" && mv "$T/in/expected" "$T/expected" && mkdir "$T/packed"
}

# differs: the largest difference of a voxel in $T/out.nrrd from what is expected; "size" where there are not as many.
differs() {
    size=$(wc -c <"$T/expected")
    tail -c "$size" "$T/out.nrrd" >"$T/got"
    [ "$(wc -c <"$T/got")" -eq "$size" ] || echo size
    cmp -l "$T/got" "$T/expected" | awk 'function value(s) { return 64 * substr(s, 1, 1) + 8 * substr(s, 2, 1) + substr(s, 3, 1) }
        { d = value(sprintf("%03d", $2)) - value(sprintf("%03d", $3)); d = d < 0 ? -d : d; if (d > most) most = d } END { print most + 0 }'
}

# packed MOST SYNTAX NAME TOOL OPTIONS...: compresses what is in $T/in by a tool, and imports it; its voxels differ by MOST at most, and
# its transfer syntax is that.
packed() {
    most=$1 syntax=$2 name=$3
    shift 3
    failed=
    for f in "$T/in"/*.dcm; do
        "$@" "$f" "$T/packed/${f##*/}" 2>"$T/stderr" || failed=1
    done
    is "$failed$(dcmdump -q +P 0002,0010 "$(find "$T/packed" -name '*.dcm' | head -n 1)" | sed 's/.*=\([A-Za-z0-9:]*\).*/\1/')" "$syntax" "$name: $syntax"
    check "$name" us-import -q --raw -o "$T/out.nrrd" "$T/packed"
    differs=$(differs)
    if [ "$differs" -le "$most" ]; then ok "$name: off by $differs"; else not_ok "$name: off by $differs, expected $most at most"; fi
    rm -f "$T/packed"/*
}

make_files series columns=32 rows=24
packed 0 RLELossless "RLE" dcmcrle
packed 0 "JPEGLossless:Non" "JPEG, lossless, order 1" dcmcjpeg +e1
packed 0 "JPEGLossless:Non" "JPEG, lossless" dcmcjpeg +el +sv 4
packed 8 JPEGBaseline "JPEG, baseline" dcmcjpeg +eb +q 95 +sr
packed 8 JPEGExtended:Process2 "JPEG, extended" dcmcjpeg +ee +q 95 +sr
packed 8 JPEGFullProgression:Non "JPEG, progressive" dcmcjpeg +ep +q 95 +sr
packed 0 JPEGLSLossless "JPEG-LS" dcmcjpls +el
packed 3 JPEGLSLossy "JPEG-LS, nearly" dcmcjpls +en +md 3
packed 0 DeflatedLittleEndianExplicit "deflated" dcmconv +td
packed 0 BigEndianExplicit "big-endian" dcmconv +tb

make_files multi columns=32 rows=24
packed 0 JPEGLossless:Non "frames: JPEG, lossless" dcmcjpeg +e1
packed 0 RLELossless "frames: RLE" dcmcrle
packed 0 JPEGLSLossless "frames: JPEG-LS" dcmcjpls +el

make_files enhanced columns=32 rows=24
packed 0 JPEGLSLossless "Enhanced US Volume: JPEG-LS" dcmcjpls +el
packed 0 DeflatedLittleEndianExplicit "Enhanced US Volume: deflated" dcmconv +td

make_files series bits=16 stored=12 columns=32 rows=24
packed 0 JPEGLossless:Non "12 of 16 bits: JPEG, lossless" dcmcjpeg +e1
packed 0 JPEGLSLossless "12 of 16 bits: JPEG-LS" dcmcjpls +el
packed 0 RLELossless "12 of 16 bits: RLE" dcmcrle

# Of colours, those with a difference of brightness only: what JPEG does with a grey is near it.
make_files series colour=RGB columns=32 rows=24
packed 0 RLELossless "RGB: RLE" dcmcrle
packed 8 JPEGBaseline "RGB: JPEG, baseline, as YBR_FULL_422" dcmcjpeg +eb +q 95 +s2
packed 8 JPEGBaseline "RGB: JPEG, baseline, as YBR_FULL" dcmcjpeg +eb +q 95 +s4
packed 0 JPEGLSLossless "RGB: JPEG-LS" dcmcjpls +el
make_files series colour=PALETTE columns=32 rows=24
packed 0 RLELossless "a palette: RLE" dcmcrle

if have opj_compress; then
    for options in "series" "multi" "enhanced" "series bits=16 stored=12" "series bits=16 sign=1" "series colour=RGB" "series colour=MONOCHROME1" "multi pieces=3"; do
        # shellcheck disable=SC2086
        make_files $options syntax=jpeg2000 columns=32 rows=24
        check "JPEG 2000: $options" us-import -q --raw -o "$T/out.nrrd" "$T/in"
        is "$(differs)" 0 "its voxels"
    done
    for cut in 40 100 160; do
        make_files multi syntax=jpeg2000 slices=1 "cut=$cut"
        fails 1 "JPEG 2000, $cut bytes short" 'multi\.dcm: ' us-import -v --spacing 1,1,1mm "$T/in"
    done
    make_files multi syntax=htj2k columns=32
    fails 1 "HTJ2K" 'transfer syntax .1\.2\.840\.10008\.1\.2\.4\.201.; expected .*JPEG-LS or JPEG 2000' us-import -v "$T/in"
else
    skip 20 "no opj_compress (libopenjp2-tools)"
fi
done_testing
