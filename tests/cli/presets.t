#!/bin/sh
# sinew materials: laws, keys, and the materials of files; and that those of samples have what is told of them, and run.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

tsv() {
    sinew materials --tsv "$@"
}

# ---- Laws and keys are those that a run takes and refuses.
is "$(tsv laws | cut -f 1 | sed 1d | tr '\n' ' ')" "neo-hookean mooney-rivlin yeoh arruda-boyce veronda-westmann ogden fung linear " "the laws"
is "$(tsv laws | awk -F '\t' '$1 == "yeoh" { print $2, "by", $3 }')" "c10, c20, nu or K, [c30] by tled-run" "keys and solver of one"
is "$(tsv keys | awk -F '\t' '$1 == "c30" { print $2, $3, $4, $5 }')" "Pa 0 1000000000000 yeoh" "a key of one law"
is "$(tsv keys | awk -F '\t' '$1 == "density" { print $2, $3, $4, $5 }')" "kg/m3 0.001 1000000 all" "a key of every law"
is "$(tsv laws | awk -F '\t' 'NF != 5')$(tsv keys | awk -F '\t' 'NF != 6')$(tsv presets | awk -F '\t' 'NF != 7')" "" "each row has all columns"
tsv keys | sed 1d | while IFS="$(printf '\t')" read -r key unit low high laws what; do
    law=${laws%%,*}
    [ "$law" = all ] && law=neo-hookean
    for value in "$low" "$high"; do
        # What else the law needs makes other complaints; this value is none.
        printf 'a law=%s %s=%s\n' "$law" "$key" "$value" | sinew materials - 2>&1 | grep -q "$key=.*is not allowed" && echo "$key=$value $unit $what"
    done
    printf 'a law=%s %s=%s\n' "$law" "$key" 2e12 | sinew materials - 2>&1 | grep -q "$key=2e12.*expected" || echo "$key=2e12"
done >"$T/ranges"
is "$(cat "$T/ranges")" "" "the ends of each range are allowed, and what is beyond is not"

# ---- Files.
printf '# A knee.\n# more\nfat law=yeoh c10=400 c20=1400 nu=0.46\t# below the\tpatella \nbone E=1e6 nu=.3 # hard\nrest E=3000 #\n' >"$T/knee"
sinew materials "$T/knee" >"$T/out"
is "$(sed -n 2p "$T/out")" "  A knee." "what a file is of: its first line"
# 9 K mu / (3 K + mu), of mu = 800 and nu = .46.
is "$(awk '$1 == "fat"' "$T/out" | tr -s ' \t' ' ')" " fat yeoh 2336 0.46 below the patella" "a material, its moduli at rest, and its comment, without a tab"
is "$(tsv presets "$T/knee" | awk -F '\t' 'NR > 1 { print $2 ":" $4 ":" $7 }' | tr '\n' '|')" \
    "fat:nu=0.46 c10=400 c20=1400 density=1000 peak=30000:below the patella|bone:E=1000000 nu=0.3 density=1000 peak=30000:hard|rest:E=3000 nu=0.49 density=1000 peak=30000:|" \
    "as TSV"
is "$(sinew materials - <"$T/knee" | sed 1d)" "$(sed 1d "$T/out")" "the same from standard input"
printf 'fat E=3000 # 50 %%d \377\n' >"$T/odd"
check "bytes that are no text are mended" sh -c "sinew materials '$T/odd' | grep -q '50 %d ?\$'"
sinew materials "$T/knee" "$T/odd" >"$T/two"
is "$(grep -c "^/" "$T/two")" 2 "two files"

# ---- Those of samples: every one is told of and has a source or says that it is assumed; what keys print is read again to the same.
is "$(tsv presets | sed 1d | cut -f 1 | sort -u | sed 's,.*/,,' | tr '\n' ' ')" "$(cd samples && echo *.materials) " "all files of samples are listed"
is "$(tsv presets | awk -F '\t' '$7 == "" { print $1, $2 }')" "" "each says what it is"
for file in samples/*.materials; do
    check "${file#samples/}: what it is of, and where values are from" awk 'NR == 1 && !/^# The .*\.$/ { exit 1 }
        /^#.*(ssumed|et al\.|Maddock|PMC|10\.1[0-9]+\/)/ { source = 1 } END { exit !source }' "$file"
    tsv presets "$file" | awk -F '\t' 'NR > 1 { print $2, "law=" $3, $4 }' >"$T/again"
    is "$(tsv presets "$T/again" | cut -f 2-6)" "$(tsv presets "$file" | cut -f 2-6)" "${file#samples/}: its keys make the same materials"
done
# A face: of its groups, and with a layer of skin, in laws that go together.
sed 's/^g .*//; 1i g skin' tests/cli/cube.obj >"$T/box.obj"
printf 'dermis thickness=2mm\nhypodermis thickness=5mm\n' >"$T/layers"
check "layers take the face's materials by name" \
    voxelise -q --unit mm -s 1 --fraction 2 --materials samples/face.materials --layers "$T/layers" -o "$T/face" "$T/box.obj"
is "$(sinew info "$T/face" | awk '/^volumes/ { on = 1 } on && ($1 == "skin" || $1 == "dermis" || $1 == "hypodermis") { print $1, $NF }' | tr '\n' ' ')" \
    "skin tissue dermis dermis hypodermis hypodermis " "and the rest is its tissue"
for name in breast liver brain; do
    check "$name runs" sh -c "voxelise -q --unit mm -s 5 --materials samples/$name.materials '$T/box.obj' | tled-run -q -n 3 >'$T/run'"
done
check "the face runs" sh -c "tled-run -q -n 3 <'$T/face' >'$T/run'"

# ---- Refused.
printf 'fat E=3000\n\nfat E=2\n' >"$T/bad"
fails 1 "a file with an error" "$T/bad:3: material 'fat' is given twice" sinew materials "$T/bad"
fails 1 "none" "No such file" sinew materials "$T/none"
: >"$T/empty"
fails 1 "an empty one" "no material in it" sinew materials "$T/empty"
fails 2 "a file beside laws" "--tsv laws does not read" sinew materials --tsv laws "$T/knee"
fails 2 "another table" "--tsv 'all'" sinew materials --tsv all
done_testing
