#!/bin/sh
# The laws of tissue and their keys: through files of materials, both encodings, import, export and -m; and what is refused.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

awk -v x=20 -v y=20 -v z=20 -v held=top -f tests/cli/box.awk >"$T/box.obj"
printf 'skin law=mooney-rivlin c10=2500 K=1e5 c01=500\nfat density=950\n' >"$T/materials"
voxelise -q --unit mm -s 5 --materials "$T/materials" "$T/box.obj" | attach -q >"$T/two"

# values MODEL: its arrays of materials, a line each.
values() {
    sinew export -f model --text "$1" | awk '/^array material\./ { name = $2; n = 2; line = name; next }
        n-- > 0 { line = line " " $0; if (!n) print line } END { }' | sed 's/^material\.//'
}
cat >"$T/want" <<'END'
name "skin" "fat"
law "mooney-rivlin" "neo-hookean"
E nan 3000
nu nan 0.48999999999999999
c10 2500 nan
c01 500 nan
K 100000 nan
density 1000 950
peak 30000 30000
END
values "$T/two" >"$T/got"
check "a model of two laws has the keys of both, nan where a law has none" diff "$T/want" "$T/got"
sinew export -f model --text -o "$T/text" "$T/two"
sinew export -f model -o "$T/binary" "$T/text"
check "text and binary are twins" sinew diff "$T/text" "$T/binary"
values "$T/text" >"$T/got"
check "and have the same values" diff "$T/want" "$T/got"
printf 'skin law=mooney-rivlin c10=2500 c01=500 nu=0.45\n' >"$T/one"
voxelise -q --unit mm -s 5 --materials "$T/one" "$T/box.obj" | attach -q >"$T/single"
is "$(values "$T/single" | cut -d ' ' -f 1 | tr '\n' ' ')" "name law nu c10 c01 density peak " "a model of one law has no other law's keys"
check "sinew info --json has a row of the law's keys" sh -c "sinew info --json '$T/two' | grep -q '\"law\": \"mooney-rivlin\", .*\"c10\": 2500, \"c01\": 500, \"K\": 100000'"
check "and the summary" sh -c "sinew info '$T/two' | grep -q '^  skin  *mooney-rivlin  *c10=2500 c01=500 K=100000 density=1000 peak=30000$'"
is "$(sinew info --get material.c10.max "$T/two")" 2500 "and --get tells one"

# ---- Abaqus's files.
check "sinew export" sinew export -f inp -o "$T/two.inp" "$T/two"
is "$(grep -A 1 MOONEY "$T/two.inp" | tr '\n' ' ')" "*HYPERELASTIC, MOONEY-RIVLIN 2500, 500, 2e-05 " "C10, C01 and D1 = 2/K"
check "and back" sinew import -q --unit m -o "$T/back" "$T/two.inp"
is "$(values "$T/back" | grep -E '^(law|c10|c01|K) ' | tr '\n' ' ')" 'law "mooney-rivlin" "neo-hookean" c10 2500 nan c01 500 nan K 99999.999999999985 nan ' \
    "the same values, K to the rounding of 2/D1"
sinew import -q --unit m --stress MPa --density kg/m3 -o "$T/back" "$T/two.inp"
is "$(values "$T/back" | grep -E '^(c10|c01|K) ' | tr '\n' ' ')" 'c10 2500000000 nan c01 500000000 nan K 99999999999.999985 nan ' "in another unit of stress"
sed 's/^2500, 500, 2e-05/2500, -500, 2e-05/' "$T/two.inp" >"$T/bad.inp"
fails 1 "C01 below 0" 'bad.inp:[0-9]*: material.c01, row 0: -500 is not allowed; expected 0 to 1e12 Pa' sinew import --unit m -o "$T/no" "$T/bad.inp"
sed 's/^2500, 500, 2e-05/2500, 500/' "$T/two.inp" >"$T/bad.inp"
fails 1 "no D1" 'bad.inp:[0-9]*: .*expected C10, C01, D1' sinew import --unit m -o "$T/no" "$T/bad.inp"
sed 's/^2500, 500, 2e-05/x, 500, 2e-05/' "$T/two.inp" >"$T/bad.inp"
fails 1 "no number" "bad.inp:[0-9]*: 'x'; expected C10, C01, D1" sinew import --unit m -o "$T/no" "$T/bad.inp"
echo 'm_skin law=mooney-rivlin c10=1 c01=2 K=3' | sed 's/m_//' >"$T/table"
echo 'fat' >>"$T/table"
check "a table in place of the file's" sinew import -q --unit m --materials "$T/table" -o "$T/back" "$T/two.inp"
is "$(values "$T/back" | grep '^c01 ')" 'c01 2 nan' "has its values"

printf 'skin law=yeoh c10=2500 c20=1175 K=1e5\nfat law=arruda-boyce mu=3000 lock=1.4 K=1e5\n' >"$T/table"
tled-run -q -n 1 --materials "$T/table" <"$T/two" >"$T/stiff"
sinew export -f inp -o "$T/stiff.inp" "$T/stiff" 2>"$T/said"
check "sinew export says that the volumetric energy is another" grep -q 'material fat: the volumetric energy of Abaqus.s ARRUDA-BOYCE is K/2 ((J^2 - 1)/2 - ln J), here' "$T/said"
is "$(grep -A 1 -E 'YEOH|ARRUDA' "$T/stiff.inp" | tr '\n' ' ')" "*HYPERELASTIC, YEOH 2500, 1175, 0, 2e-05, 20000000, 20000000 -- *HYPERELASTIC, ARRUDA-BOYCE 3000, 1.4, 2e-05 " \
    "yeoh and arruda-boyce"
check "and back" sh -c "sinew import -q --unit m --stress MPa -o '$T/back' '$T/stiff.inp'"
is "$(values "$T/back" | grep -E '^(law|c10|c20|c30|mu|lock) ' | tr '\n' ' ')" \
    'law "yeoh" "arruda-boyce" c10 2500000000 nan c20 1175000000 nan c30 0 nan mu nan 3000000000 lock nan 1.3999999999999999 ' "in MPa"
sinew import --unit m -o "$T/back" "$T/stiff.inp" 2>"$T/said"
check "sinew import says it too" grep -q 'material m_*fat: the volumetric energy' "$T/said"
sed 's/^\(2500, 1175, 0, 2e-05\), .*/\1, 0, 1/' "$T/stiff.inp" >"$T/bad.inp"
fails 1 "D3" 'bad.inp:[0-9]*: volumetric energy of .J - 1..4 or on; expected D2 and D3 of 0, or at least 1e9 times D1' sinew import --unit m -o "$T/no" "$T/bad.inp"
sed 's/^2500, 1175, 0, 2e-05, .*/2500, -1175, 0, 2e-05/' "$T/stiff.inp" >"$T/bad.inp"
fails 1 "C20 below 0" 'bad.inp:[0-9]*: c20=-1175 with c10=2500 and c30=0 lets the stress fall' sinew import --unit m -o "$T/no" "$T/bad.inp"
printf 'skin law=ogden mu1=1000 a1=2 mu2=200 a2=-4 K=1e5\nfat law=ogden mu1=1000 a1=2 mu2=200 a2=-4 mu3=10 a3=9 K=1e5\n' >"$T/table"
tled-run -q -n 1 --materials "$T/table" <"$T/two" >"$T/stretches"
sinew export -f inp -o "$T/stretches.inp" "$T/stretches" 2>"$T/said"
is "$(grep -A 2 OGDEN "$T/stretches.inp" | grep -v DENSITY | tr '\n' ' ')" \
    "*HYPERELASTIC, OGDEN, N=2 1000, 2, 200, -4, 2e-05, 20000000 -- *HYPERELASTIC, OGDEN, N=3 1000, 2, 200, -4, 10, 9, 2e-05, 20000000 20000000 " "ogden of two terms and of three"
check "and back" sh -c "sinew import -q --unit m --stress kPa -o '$T/back' '$T/stretches.inp'"
is "$(values "$T/back" | grep -E '^(law|mu.|a.) ' | tr '\n' ' ')" \
    'law "ogden" "ogden" mu1 1000000 1000000 a1 2 2 mu2 200000 200000 a2 -4 -4 mu3 nan 10000 a3 nan 9 ' "in kPa"
sed 's/N=3/N=4/' "$T/stretches.inp" >"$T/bad.inp"
fails 1 "more terms" 'bad.inp:[0-9]*: .HYPERELASTIC of another law; expected .* or OGDEN of N=1 to 3' sinew import --unit m -o "$T/no" "$T/bad.inp"
sed 's/^20000000 *$/7/' "$T/stretches.inp" >"$T/bad.inp"
fails 1 "D3 on its line" 'bad.inp:[0-9]*: volumetric energy of .J - 1..4 or on; expected D2 and D3 of 0, or at least 1e9 times D1' sinew import --unit m -o "$T/no" "$T/bad.inp"
printf 'skin law=veronda-westmann c1=1000 c2=3 K=1e5\nfat\n' >"$T/table"
tled-run -q -n 1 --materials "$T/table" <"$T/two" >"$T/skin"
fails 1 "a law that Abaqus does not have" "material 'skin' has the law 'veronda-westmann', which Abaqus's files do not have here; expected linear, neo-hookean" \
    sinew export -f inp -o "$T/no" "$T/skin"
printf 'skin law=fung c=2000 bf=8 bt=2 bfs=4 K=1e5\nfat\n' >"$T/table"
fails 1 "a law that needs directions" "volume '.*' has the law fung, but no element of it has a direction; expected directions" \
    tled-run -q -n 1 --materials "$T/table" -o "$T/no" <"$T/two"
awk '/^array/ { along = $2 == "element.fibre" } /^crc|^sum/ { next } { print along && !/^array|^end/ ? "0 1 0" : $0 }' "$T/text" >"$T/directed"
check "and runs with them" tled-run -q -d cpu -n 1 --materials "$T/table" -o "$T/heart" <"$T/directed"
is "$(values "$T/heart" | grep -E '^(law|K|c|bf|bt|bfs) ' | tr '\n' ' ')" \
    'law "fung" "neo-hookean" K 100000 nan c 2000 nan bf 8 nan bt 2 nan bfs 4 nan ' "the keys of fung"
fails 1 "fung is not in Abaqus's files either" "material 'skin' has the law 'fung', which Abaqus's files do not have here; expected linear" \
    sinew export -f inp -o "$T/no" "$T/heart"

# ---- -m, in any order; the last of a key counts.
changed() { # ARG...: the values after them
    tled-run -q -n 1 "$@" <"$T/two" >"$T/out" && values "$T/out" | grep -E '^(law|E|nu|c10|c01|K|density) ' | tr '\n' ' '
}
is "$(changed -m skin.E=4000 -m skin.nu=.3 -m skin.law=neo-hookean)" 'law "neo-hookean" "neo-hookean" E 4000 3000 nu 0.29999999999999999 0.48999999999999999 density 1000 950 ' \
    "to the default law, its name last"
more() { # ARG...: the values of all keys after them
    tled-run -q -n 1 "$@" <"$T/two" >"$T/out" && values "$T/out" | grep -vE '^(name|law|density|peak) ' | tr '\n' ' '
}
stiff='-m skin.law=yeoh -m skin.c10=400 -m skin.c20=1400 -m skin.nu=.46'
# shellcheck disable=SC2086 # options are words
{
    is "$(more $stiff)" 'E nan 3000 nu 0.46000000000000002 0.48999999999999999 c10 400 nan c20 1400 nan ' "yeoh without c30 has none"
    is "$(more $stiff -m skin.c30=7)" 'E nan 3000 nu 0.46000000000000002 0.48999999999999999 c10 400 nan c20 1400 nan c30 7 nan ' "and with it"
}
is "$(changed -m skin.nu=.45 -m skin.c10=7 -m skin.c10=8)" 'law "mooney-rivlin" "neo-hookean" E nan 3000 nu 0.45000000000000001 0.48999999999999999 c10 8 nan c01 500 nan density 1000 950 ' \
    "nu in place of K"
is "$(changed -m fat.law=mooney-rivlin -m fat.K=5e4 -m fat.c01=0 -m fat.c10=500)" 'law "mooney-rivlin" "mooney-rivlin" c10 2500 500 c01 500 0 K 100000 50000 density 1000 950 ' \
    "to mooney-rivlin"
printf 'fat law=mooney-rivlin K=5e4 c01=0 c10=500\n' >"$T/change"
tled-run -q -n 1 --materials "$T/change" <"$T/two" >"$T/by-file"
check "a file gives the same" sinew diff "$T/out" "$T/by-file"

# ---- What is refused.
no() { # NAME PATTERN ARG...
    name=$1 pattern=$2
    shift 2
    fails 2 "-m: $name" "^tled-run: -m skin: $pattern" tled-run -n 1 "$@" <"$T/two"
}
no "c01 below 0" "'c01=-1' is not allowed; expected 0 to 1e12 Pa" -m skin.c01=-1
no "no K" "'K=0' is not allowed; expected 0.001 to 1e12 Pa" -m skin.K=0
no "both K and nu" "the law mooney-rivlin with both nu and K; expected nu or K" -m skin.K=1e4 -m skin.nu=.4
no "another law's key" "'E' is not a key of the law mooney-rivlin; expected c10, c01, nu or K, density, peak" -m skin.E=1
no "a law without its keys" "the law neo-hookean without E; expected E, nu" -m skin.law=neo-hookean
no "an unknown key" "unknown key 'c11'; did you mean 'c10'" -m skin.c11=1
yeoh='-m skin.law=yeoh -m skin.c10=400 -m skin.K=1e4'
# shellcheck disable=SC2086 # options are words
{
    no "yeoh without c20" "the law yeoh without c20; expected c10, c20, nu or K, \[c30\]" $yeoh
    no "c20 below 0 alone" "the law yeoh, c20=-1 with c10=400 and c30=0 lets the stress fall where shear grows; expected c20 of 0 or more, or c30 above 3 c20.2 / .5 c10. = 0.0015" \
        $yeoh -m skin.c20=-1
    no "c30 below 0" "'c30=-1' is not allowed; expected 0 to 1e12 Pa" $yeoh -m skin.c20=1 -m skin.c30=-1
    no "chains that lock at rest" "'lock=.9' is not allowed; expected 1 to 1000" -m skin.law=arruda-boyce -m skin.mu=1 -m skin.lock=.9 -m skin.K=9
}
no "an exponential that is too slow" "the law veronda-westmann, c2=0.3 lets waves lose their speed where tissue is stretched; expected c2 above 0.35754" \
    -m skin.law=veronda-westmann -m skin.c1=1000 -m skin.c2=.3 -m skin.K=9
no "an exponent below 1" "the law ogden, a1=-0.5 lets the stress fall where shear grows; expected a1 of 1 or more, or of -1 or less" \
    -m skin.law=ogden -m skin.mu1=1000 -m skin.a1=-.5 -m skin.K=9
no "a term without its exponent" "the law ogden, mu2 without a2; expected both mu2 and a2, or neither" \
    -m skin.law=ogden -m skin.mu1=1000 -m skin.a1=2 -m skin.mu2=7 -m skin.K=9
no "fung without bfs" "the law fung without bfs; expected c, bf, bt, bfs, nu or K" \
    -m skin.law=fung -m skin.c=1000 -m skin.bf=1 -m skin.bt=1 -m skin.K=9
no "an unknown law" "unknown law 'mooney'; did you mean 'mooney-rivlin'" -m skin.law=mooney
while IFS='|' read -r name line pattern; do
    echo "$line" >"$T/bad"
    fails 1 "file: $name" "bad:1: $pattern" voxelise -q --unit mm -s 5 --materials "$T/bad" -o "$T/no" "$T/box.obj"
    fails 1 "and tled-run" "bad:1: $pattern" tled-run -n 1 --materials "$T/bad" -o "$T/no" <"$T/two"
done <<'END'
c01 below 0|skin law=mooney-rivlin c10=1 c01=-1 K=9|'c01=-1' is not allowed; expected 0 to 1e12 Pa
K of 0|skin law=mooney-rivlin c10=1 c01=1 K=0|'K=0' is not allowed
both|skin law=mooney-rivlin c10=1 c01=1 K=9 nu=.3|the law mooney-rivlin with both nu and K; expected nu or K
another law's key|skin law=mooney-rivlin c10=1 c01=1 K=9 E=3|'E' is not a key of the law mooney-rivlin
no key of the other law|fat law=mooney-rivlin c10=1 c01=1|the law mooney-rivlin without nu or K; expected c10, c01, nu or K
no c10|fat law=mooney-rivlin c01=1 K=9|the law mooney-rivlin without c10; expected c10, c01, nu or K
a key of no law that it has|fat c10=1|'c10' is not a key of the law neo-hookean; expected E, nu, density, peak
END
sed 's/"mooney-rivlin"/"yeoh"/; s/^array material.c01/array material.c20/; s/^500 *$/-500/; /^crc\|^sum/d' "$T/text" >"$T/bad"
fails 1 "a model of values that no material has" "stdin:[0-9]*: material.law, row 0: yeoh, c20=-500 with c10=2500 and c30=0 lets the stress fall" \
    tled-run -n 1 -o "$T/no" <"$T/bad"
# by_hand NAME MESSAGE EDIT: such a change of a model's text.
by_hand() {
    sed "$3" "$T/text" | sed '/^crc\|^sum/d' >"$T/bad"
    fails 1 "a model with $1" "stdin:[0-9]*: $2" tled-run -n 1 -o "$T/no" <"$T/bad"
}
by_hand "neither K nor nu" "material.law, row 0: mooney-rivlin without nu or K; expected one of them" '/^array material.K/ { n; s/.*/nan/; }'
by_hand "both" "material.K, row 0: 100000 is not allowed; expected nan, as material.nu has a value" '/^array material.nu/ { n; s/.*/.3/; }'
by_hand "no c10" "material.c10, row 0: nan is not allowed; expected 0.001 to 1e12 Pa" '/^array material.c10/ { n; s/.*/nan/; }'
by_hand "another law's key" "material.E, row 0: 3 is not allowed; expected nan, as the law mooney-rivlin has no such key" '/^array material.E/ { n; s/.*/3/; }'
by_hand "a law that is not there" "unknown law 'mooney'; did you mean 'mooney-rivlin'" 's/"mooney-rivlin"/"mooney"/'
msds-mesh -q --materials "$T/one" --size 20mm,20mm,20mm --nodes 4x4x4 -o "$T/tets"
awk 'BEGIN { print "0 0 0 0.1 0 0 0 1" }' >"$T/poses"
printf 'skin law=fung c=2000 bf=8 bt=2 bfs=4 nu=.45\n' >"$T/table"
msds-mesh -q --materials "$T/table" --size 20mm,20mm,20mm --nodes 4x4x4 -o "$T/along"
fails 1 "nor fung" "volume '.*' has the law 'fung'; expected linear, or neo-hookean" msds-run --poses "$T/poses" -o "$T/no" <"$T/along"
fails 1 "msds-run has no such law" "volume '.*' has the law 'mooney-rivlin'; expected linear, or neo-hookean" \
    msds-run --poses "$T/poses" -o "$T/no" <"$T/tets"
done_testing
