#!/bin/sh
# Names of files and folders are often patients': us-import's messages have none, and nothing that a file holds, without -v; and
# --anonymous-names leaves them out of models. With SINEW_LONG more lengths of paths.
. "$(dirname "$0")/lib.sh"
have python3 || skip_all "no python3 to write DICOM files with"

# Everything lies in a folder that is called as the patient is, and so is every file.
P=$T/KOWAL_JANE
mkdir "$P"
# hides NAME PATTERN COMMAND...: it fails in one line that matches and has no name; with -v it has one.
hides() {
    name=$1 pattern=$2
    shift 2
    "$@" >"$T/stdout" 2>"$T/stderr"
    status=$?
    if [ "$status" -ne 0 ] && [ "$(wc -l <"$T/stderr")" -eq 1 ] && grep -Eq -e "$pattern" "$T/stderr" && ! grep -aqi kowal "$T/stdout" "$T/stderr"; then
        ok "$name"
    else
        not_ok "$name"
        diag "exit status $status, wanted one line with $pattern, and no name"
        diag_file "$T/stderr"
    fi
    "$@" -v 2>&1 >"$T/stdout" | grep -qi kowal
    is $? 0 "$name: -v says it"
}
# dicom KIND KEY=VALUE...: files in $P/scan.
dicom() {
    rm -rf "$P/scan"
    python3 tests/cli/dicom.py "$P/scan" "$@" && rm "$P/scan/expected"
    for f in "$P"/scan/*; do mv "$f" "$P/scan/KOWAL_$(basename "$f")"; done
}

dicom series burned=YES
echo 'Jane Kowal, born 1942' >"$P/scan/KOWAL_notes.txt"
us-import --report -o "$P/out.nrrd" "$P/scan" >"$T/said" 2>&1
is "$? $(grep -aci kowal "$T/said") $(grep -c 'without a DICOM image' "$T/said")" "0 0 1" "a series: no name is said"
rm "$P/scan/KOWAL_notes.txt"
dicom series drop=2
hides "a slice is missing" 'slices: 1 missing between file 2 of 5 and file 3 of 5; expected all 0\.75 mm apart \(-v says all\)$' us-import "$P/scan"
dicom series dup=3
hides "one is there twice" 'file 3 of 7 and file 4 of 7 lie at one place|file . of 7 and file . of 7 lie at one place' us-import "$P/scan"
dicom series second=1
hides "two series" '2 series: 1: 1 file of 7 x 5 from file 1 of 6, 2: 5 files .*--series N' us-import "$P/scan"
dicom series cut=20
hides "a file that is cut" '^us-import: file 1 of 6: not whole' us-import "$P/scan"
dicom series
echo 'Jane Kowal, born 1942' >"$P/KOWAL.txt"
hides "a file that is none" '^us-import: file 1 of 1:1: .*\.\.\.. begins no volume of a known format; expected NRRD or MetaImage' us-import "$P/KOWAL.txt"
hides "among others" '^us-import: file 1 of 7: not a DICOM file' us-import "$P/KOWAL.txt" "$P/scan"
hides "a folder that is not there" '^us-import: argument 2 of 2: cannot read: No such file' us-import "$P/scan" "$P/KOWAL_none"
hides "an output that cannot be" '^us-import: the output: .*No such file or directory' us-import -o "$P/none/KOWAL.nrrd" "$P/scan"
cp "$P/out.nrrd" "$P/KOWAL_in.nrrd"
us-import -o "$P/KOWAL_in.nrrd" "$P/KOWAL_in.nrrd" 2>"$T/stderr"
is "$? $(grep -ci kowal "$T/stderr") $(grep -c overwrite "$T/stderr")" "2 0 1" "an output that is the input"

# Headers: a name in every value, and as a key.
printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: LPS' 'sizes: 1 1 1' 'space directions: (1,0,0) (0,1,0) (0,0,1)' \
    'kinds: domain domain domain' 'space units: "mm" "mm" "mm"' 'encoding: text' 'space origin: (0,0,0)' '' 7 >"$P/good.nrrd"
check "a header" us-import -o "$T/x.nrrd" "$P/good.nrrd"
for field in type dimension space sizes 'space directions' 'space units' encoding 'space origin'; do
    sed "s/^$field: .*/$field: Jane O'Kowal's \"Kowal\" 'Kowal'/" "$P/good.nrrd" >"$P/KOWAL_bad.nrrd"
    hides "NRRD, $field" "^us-import: file 1 of 1:[0-9]+: $field: '\.\.\.'" us-import "$P/KOWAL_bad.nrrd"
done
sed "s/^kinds: .*/O'Kowal: 7/" "$P/good.nrrd" >"$P/KOWAL_bad.nrrd"
hides "NRRD, a field of its own" "^us-import: file 1 of 1:7: field: '\.\.\.'; expected" us-import "$P/KOWAL_bad.nrrd"
sed 's/^7$/Kowal/' "$P/good.nrrd" >"$P/KOWAL_bad.nrrd"
hides "NRRD, a voxel" "^us-import: file 1 of 1: voxel 0: '\.\.\.'; expected a number" us-import "$P/KOWAL_bad.nrrd"
sed "s,^encoding.*,&\ndata file: KOWAL.raw," "$P/good.nrrd" >"$P/KOWAL_bad.nrrd"
hides "NRRD, data that are not there" "^us-import: the data file of file 1 of 1: cannot open: No such file" us-import "$P/KOWAL_bad.nrrd"
: >"$P/KOWAL.raw"
hides "NRRD, a data file that is empty" "^us-import: the data file of file 1 of 1: .*expected" us-import "$P/KOWAL_bad.nrrd"
rm "$P/KOWAL.raw"
sed "s,^encoding.*,&\ndata file: ../KOWAL.raw," "$P/good.nrrd" >"$P/KOWAL_bad.nrrd"
hides "NRRD, data in ../KOWAL.raw" "^us-import: (the data file of )?file 1 of 1: .*(No such file|outside its folder|expected)" us-import "$P/KOWAL_bad.nrrd"
step=${SINEW_LONG:+20}
# Folders so long that a path and what is wrong are more than one message holds.
long=$P/$(printf 'x%.0s' $(seq 200))
long=$long/$(basename "$long")/$(basename "$long")/$(basename "$long")
mkdir -p "$long"
for length in $(seq 900 "${step:-80}" 1060); do
    file=$long/$(printf 'k%.0s' $(seq $((length - ${#long} - 1))))
    sed "s/^type: .*/type: Jane Kowal of Cracow O'Kowal/" "$P/good.nrrd" >"$file"
    hides "NRRD, a path of $length characters" "^us-import: file 1 of 1:2: type: '\.\.\.'; expected unsigned char" us-import "$file"
done
mkdir "$P/KOWAL.raw"
sed "s,^encoding.*,&\ndata file: KOWAL.raw," "$P/good.nrrd" >"$P/KOWAL_bad.nrrd"
hides "NRRD, data in a folder" "^us-import: the data file of file 1 of 1: is not a regular file; expected one that '\.\.\.' names" us-import "$P/KOWAL_bad.nrrd"
printf '%s\n' 'ObjectType = Image' 'NDims = 3' 'BinaryData = False' 'TransformMatrix = 1 0 0 0 1 0 0 0 1' 'Offset = 0 0 0' \
    'ElementSpacing = 1 1 1' 'DimSize = 1 1 1' 'ElementType = MET_UCHAR' 'ElementDataFile = LOCAL' 7 >"$P/good.mha"
for key in ObjectType NDims BinaryData TransformMatrix Offset ElementSpacing DimSize ElementType; do
    sed "s/^$key = .*/$key = Jane O'Kowal/" "$P/good.mha" >"$P/KOWAL_bad.mha"
    hides "MetaImage, $key" "^us-import: file 1 of 1:[0-9]+: $key: '\.\.\.'" us-import "$P/KOWAL_bad.mha"
done
# Sequences: transforms that are called after her.
sequence() {
    sed "s/^ElementDataFile/$1\n&/" "$P/good.mha" >"$P/KOWAL_seq.mha"
}
sequence 'Seq_Frame0000_KowalToTableTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\nSeq_Frame0000_Timestamp = 1'
hides "no transform that is known" "frame 0 does not say where Image or Probe is in Reference or Tracker; expected transforms that do, among: '\.\.\.'" us-import "$P/KOWAL_seq.mha"
sequence 'Seq_Frame0000_KowalToTableTransform = 1 0'
hides "a transform that is cut" "^us-import: file 1 of 1:9: '\.\.\.'; expected 16 finite numbers" us-import "$P/KOWAL_seq.mha"
sequence 'UltrasoundImageOrientation = KOWAL\nSeq_Frame0000_ImageToReferenceTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\nSeq_Frame0000_Timestamp = 1'
hides "an orientation" "^us-import: file 1 of 1: UltrasoundImageOrientation: '\.\.\.'; expected MF, MN, UF or UN" us-import "$P/KOWAL_seq.mha"
sequence 'Seq_Frame0000_ImageToReferenceTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\nSeq_Frame0000_Timestamp = 1'
echo 'Kowal 0 0' >"$P/KOWAL.calibration"
hides "a calibration" "^us-import: the calibration: '\.\.\.' at number 1; expected 16 numbers" us-import --calibration "$P/KOWAL.calibration" "$P/KOWAL_seq.mha"
head -c 300 "$P/out.nrrd" >"$P/KOWAL_cut.nrrd"
hides "data that are cut" '^us-import: file 1 of 1: ' us-import "$P/KOWAL_cut.nrrd"

# Models: base names stand in provenance and as surfaces' names, unless they are to be left out; what follows works all the same.
printf '%s\n' 'v 0 0 0' 'v 9 0 0' 'v 9 9 0' 'v 0 9 0' 'v 0 0 9' 'v 9 0 9' 'v 9 9 9' 'v 0 9 9' \
    'f 4 3 2 1' 'f 5 6 7 8' 'f 1 2 6 5' 'f 2 3 7 6' 'f 3 4 8 7' 'f 4 1 5 8' >"$P/KOWAL.obj"
sed 's/^v 9/v 8/' "$P/KOWAL.obj" >"$P/KOWAL_2.obj"
sed 's/^v 9/v 7/' "$P/KOWAL.obj" >"$P/KOWAL_skin.obj"
printf '0 .0045 .0045 -.001 0 0 0 1\n1 .0045 .0045 .0005 0 0 0 1\n' >"$P/KOWAL.tum"
printf '0 gravity 0,0,-9.81\n' >"$P/KOWAL.script"
printf 'tissue E=3000\n' >"$P/KOWAL.materials"
chain() {
    msds-mesh -q "$@" --nodes 4x4x4 --like "$P/good2.nrrd" --materials "$P/KOWAL.materials" |
        sinew bind "$@" --unit mm "$P/KOWAL.obj" "$P/KOWAL_2.obj" |
        msds-run -q "$@" --skin "$P/KOWAL_skin.obj" --unit mm --probe "convex:$P/KOWAL.obj" --poses "$P/KOWAL.tum" -o "$T/press.sinew"
    voxelise -q "$@" --unit mm -n 3 --materials "$P/KOWAL.materials" "$P/KOWAL.obj" | attach -q "$@" --rigid-file "$P/KOWAL_2.obj" | sinew bind "$@" |
        tled-run -q "$@" -t .001 --script "$P/KOWAL.script" -o "$T/face.sinew"
    { sinew info "$T/press.sinew" && sinew info "$T/face.sinew" && gzip -dcf <"$T/press.sinew" && gzip -dcf <"$T/face.sinew"; } >"$T/all"
}
sed -e 's/^sizes.*/sizes: 2 2 2/' -e 's/^space directions.*/space directions: (9,0,0) (0,9,0) (0,0,9)/' -e 's/^7$/7 7 7 7 7 7 7 7/' "$P/good.nrrd" >"$P/good2.nrrd"
chain 2>"$T/stderr"
is "$(grep -aci kowal "$T/all" | awk '{ print ($1 > 10) }')" 1 "names of files are in models"
chain --anonymous-names 2>"$T/stderr"
is "$(test -s "$T/press.sinew" && test -s "$T/face.sinew" && grep -aci kowal "$T/all")" 0 "with --anonymous-names they are not"
is "$(sinew info "$T/press.sinew" | grep -c 'surface_[123]')" "$(sinew info "$T/press.sinew" | grep -c surface_)" "surfaces are numbered"
is "$(sinew info "$T/press.sinew" | grep -c 'msds-mesh .*--like FILE .*--materials FILE')" 1 "provenance says that there was a file"
check "an OBJ is deformed that has another name in the model" sinew deform --unit mm "$P/KOWAL_2.obj" -o "$T/moved.obj" <"$T/press.sinew"
check "and a skin" sinew deform --unit mm "$P/KOWAL_skin.obj" -o "$T/moved.obj" <"$T/press.sinew"

done_testing
