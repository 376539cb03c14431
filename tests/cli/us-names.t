#!/bin/sh
# What names people stays behind: a word is planted in every element that DICOM knows (a superset of what the basic profile of PS3.15, annex
# E, removes or replaces) and in makers' private ones, and in every key of other headers; no tool's output has it, in its bytes or
# in what they decompress to.
. "$(dirname "$0")/lib.sh"
python=
for p in python3 /usr/bin/python3; do
    "$p" -c 'import pydicom' 2>/dev/null && python=$p
done
[ "$python" ] || skip_all "no pydicom for Python (python3-pydicom)"

WORDS='planted|19420713|042042\.42|1\.2\.42\.4242|4242\.4242|42424242'

# plain FILE: its bytes, and what they decompress to, wherever a gzip member begins.
plain() {
    "$python" - "$1" <<'END'
import sys, zlib
data = open(sys.argv[1], 'rb').read()
sys.stdout.buffer.write(data)
at = data.find(b'\x1f\x8b\x08')
while at >= 0:
    try:
        sys.stdout.buffer.write(zlib.decompressobj(31).decompress(data[at:]))
    except zlib.error:
        pass
    at = data.find(b'\x1f\x8b\x08', at + 1)
at = data.find(b'\x78\x01')
while at >= 0: # zlib: as in VTU and PNG
    try:
        sys.stdout.buffer.write(zlib.decompressobj().decompress(data[at:]))
    except zlib.error:
        pass
    at = data.find(b'\x78\x01', at + 1)
END
}

# names_nobody FILE NAME
names_nobody() {
    if [ -s "$1" ] && ! plain "$1" | LC_ALL=C grep -aqiE "$WORDS"; then ok "$2: names nobody"; else not_ok "$2: names nobody"; fi
}

for kind in series multi enhanced philips; do
    rm -rf "$T/plain" "$T/in"
    "$python" tests/cli/dicom.py "$T/plain" "$kind" >/dev/null && "$python" tests/cli/dicom.py "$T/in" "$kind" plant=1
    rm "$T/plain/expected" "$T/in/expected"
    count=$(dcmdump "$T/in"/*.dcm 2>/dev/null | grep -ciE "$WORDS")
    if [ "$kind" = series ]; then
        # The test's own eye: the words are there to be found.
        cat "$T/in"/*.dcm >"$T/all"
        LC_ALL=C grep -aqiE "$WORDS" "$T/all"
        is $? 0 "$kind: words are planted ($count of them)"
    fi
    check "$kind: imported" us-import --report -o "$T/v.nrrd" "$T/in"
    names_nobody "$T/stderr" "$kind: report"
    names_nobody "$T/v.nrrd" "$kind: volume"
    us-import -q -o "$T/w.nrrd" "$T/plain"
    check "$kind: the bytes are those of files in which nothing is planted" cmp "$T/v.nrrd" "$T/w.nrrd"
done
left=$(us-import --report -o "$T/v.nrrd" "$T/in" 2>&1 | sed '1,/ left out$/d' | grep -c '^  (')
if [ "$left" -gt 2000 ]; then ok "the report lists all that was left out: $left elements"; else not_ok "the report lists $left elements"; fi

# What is wrong with such files, in a folder and under names that are planted too.
for wrong in drop=2 dup=3 second=1 cut=2000; do
    mkdir -p "$T/Planted"
    in=$T/Planted/planted_$wrong
    "$python" tests/cli/dicom.py "$in" series plant=1 "$wrong" && rm -f "$in/expected"
    for f in "$in"/*; do mv "$f" "$in/planted $(basename "$f")"; done
    us-import --report "$in" >"$T/w.nrrd" 2>"$T/stderr"
    is "$? $(grep -aciE "$WORDS" "$T/stderr") $(wc -c <"$T/w.nrrd")" "1 0 0" "$wrong: the error names nobody"
    us-import -q "$in" >"$T/w.nrrd" 2>"$T/stderr"
    is "$? $(grep -aciE "$WORDS" "$T/stderr") $(wc -c <"$T/w.nrrd")" "1 0 0" "$wrong: nor with -q"
done

# On from there: every tool that the volume passes through.
"$python" tests/cli/dicom.py "$T/in2" series plant=1 columns=24 rows=20 slices=16 && rm "$T/in2/expected"
us-import -q -o "$T/v.nrrd" "$T/in2"
check "a label" us-segment -n vein --low 60 --high 140 -o "$T/l.nrrd" "$T/v.nrrd"
names_nobody "$T/l.nrrd" "us-segment"
check "a surface" us-surface -l all -o "$T/s.obj" "$T/l.nrrd"
names_nobody "$T/s.obj" "us-surface"
check "a mesh" msds-mesh -q --like "$T/v.nrrd" --labels "$T/l.nrrd" --nodes 5x5x5 -z -o "$T/m.sinew"
names_nobody "$T/m.sinew" "msds-mesh"
sinew bind --unit mm "$T/s.obj" <"$T/m.sinew" >"$T/b.sinew" 2>"$T/stderr"
names_nobody "$T/b.sinew" "sinew bind"
printf '0 0.01 0 0.05 0 0 0 1\n1 0.01 0 0.04 0 0 0 1\n' >"$T/p.tum"
msds-run -q --probe sphere:1cm --poses "$T/p.tum" <"$T/b.sinew" >"$T/r.sinew"
names_nobody "$T/r.sinew" "msds-run"
sinew deform "$T/s.obj" <"$T/r.sinew" >"$T/d.obj"
names_nobody "$T/d.obj" "sinew deform"
for format in vtu inp obj; do
    sinew export -f "$format" -o "$T/e.$format" "$T/r.sinew"
    names_nobody "$T/e.$format" "sinew export -f $format"
done
sinew info "$T/r.sinew" >"$T/info"
names_nobody "$T/info" "sinew info"
sinew render --size 64x48 -o "$T/p.png" "$T/r.sinew" 2>"$T/stderr"
names_nobody "$T/p.png" "sinew render"

# Other headers: comments and keys.
printf '%s\n' NRRD0004 '# PLANTED comment' 'content: PLANTED' 'type: uint8' 'dimension: 3' 'space: LPS' 'sizes: 3 3 3' \
    'space directions: (1,0,0) (0,1,0) (0,0,1)' 'encoding: text' 'space origin: (0,0,0)' 'sample units: PLANTED' 'PatientName:=PLANTED' \
    'Segment0_Name:=vein' 'Segment0_LabelValue:=1' 'Segment0_Tags:=PLANTED' 'Segment0_ID:=PLANTED' '' \
    '1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 0' >"$T/h.nrrd"
printf '%s\n' 'ObjectType = Image' 'Comment = PLANTED' 'Name = PLANTED' 'NDims = 3' 'BinaryData = False' 'Modality = MET_MOD_OTHER' \
    'PatientID = PLANTED' 'DimSize = 3 3 3' 'ElementSpacing = 1 1 1' 'ElementType = MET_UCHAR' 'ElementDataFile = LOCAL' \
    '1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 0' >"$T/h.mha"
for f in h.nrrd h.mha; do
    us-import --report -o "$T/o.nrrd" "$T/$f" 2>"$T/stderr"
    is $? 0 "$f: imported"
    names_nobody "$T/o.nrrd" "$f: volume"
    names_nobody "$T/stderr" "$f: report"
    us-segment -q -n a --low 1 --onto "$T/$f" -o "$T/o.nrrd" "$T/$f"
    names_nobody "$T/o.nrrd" "$f: label image"
    us-surface -q -i 1 "$T/$f" >"$T/o.obj"
    names_nobody "$T/o.obj" "$f: surface"
done
done_testing
