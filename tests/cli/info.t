#!/bin/sh
# sinew info: the summary, single values, JSON, and what it says to nonsense.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

small=tests/cli/small.sinew

get() {
    sinew info --get "$1" <"$small"
}

# Single values, worked out by hand from the file.
is "$(get axis.node)" 12 "axis.NAME"
is "$(get axis.s/vertex)" 4 "an axis of a surface"
is "$(get meta.source.unit)" mm "meta.KEY, without quotes"
is "$(get meta.note)" 'a "quoted" \ name: é' "metadata as it is"
is "$(get frames)" 2 "frames"
is "$(get frame.index)" 10 "the last frame's index"
is "$(get frame.time)" 0.5 "the last frame's time"
is "$(get node.rigid.sum)" 4 "sum of a column"
is "$(get volume.count.muscle_a)" 1 "elements of a volume"
is "$(get node.displacement.max)" 0.05 "max of vectors is the largest norm"
is "$(get node.displacement.min)" 0 "min of vectors is the least norm"
is "$(get node.displacement.sum)" "0.13 0 0.04" "sum of vectors, by column"
is "$(get node.displacement.at.0.2,0,0)" "0.03 0 0.04" "the node at a place, last frame"
is "$(get node.displacement.at.19cm,10mm,0.01)" "0.03 0 0.04" "the nearest node; lengths with units"
is "$(get node.position.at.0.05,0.05,0)" "0 0 0" "of nodes as near, the first"
is "$(get element.fibre.at.0.2,0,0)" "-1 0 0" "the element whose centre is nearest"
is "$(get s/vertex.weight.at.0.2,0.1,0)" "0 0 1" "the vertex of a surface"
is "$(get node.position.low)" "0 0 0" "low, by column"
is "$(get node.position.high)" "0.2 0.1 0.1" "high, by column"
is "$(get x-heat.min)" 0.1 "a float is written as short as a float can be"
is "$(get x-heat.rows)" 12 "rows"
is "$(get x-heat.unit)" K "unit"
is "$(get element.node.columns)" 8 "columns"
is "$(get s/face.start.type)" i64 "type"
is "$(get element.node.mean)" 5.5 "mean"
is "$(get material.peak.max)" 30000 "nan left out of max"
is "$(get material.peak.sum)" nan "nan in a sum shows"
is "$(get material.peak.nan)" 1 "nan are counted"
is "$(get material.E.Tissue)" 6000 "a row of a table by its name; case counts"
is "$(get muscle.centre.muscle_a)" "0 0.05 0.05" "a muscle has its volume's name"
is "$(get muscle.centre)" "0 0.05 0.05" "an array of one row needs nothing more"
is "$(get x-word.row.1)" "two words" "a string by its row"
is "$(sinew info --get frames --get axis.element "$small" | tr '\n' ' ')" "2 2 " "several keys, in order; a file as operand"

# Lists of names, one a line.
lines() {
    sinew info --get "$1" "$2" | tr '\n' '|'
}
is "$(lines volume.name "$small")" "skin|muscle_a|" "names of volumes"
is "$(lines material.name "$small")$(lines muscle.name "$small")$(lines surface.name "$small")" "tissue|Tissue|muscle_a|s|" "of materials, muscles, surfaces"
is "$(lines array.name "$small" | tr '|' '\n' | sort | tr '\n' ' ')" "$(sed -n 's/^array \([^ ]*\).*/\1/p' "$small" | sort -u | tr '\n' ' ')" \
    "of arrays, those of frames too"
printf '%%sinew 1 text\naxis anchor 4\narray anchor.name str 1 anchor 1\n"two\\nlines"\n"tab\\t, \\x1b[31m"\n"a\\\\x2cb"\n"caf\303\251"\nend\n' >"$T/names"
is "$(lines anchor.name "$T/names")" "two\\x0alines|tab\\x09, \\x1b[31m|a\\x2cb|$(printf 'caf\303\251')|" "bytes that are no text of a line as \\xHH"
is "$(sinew info --get anchor.name.row.3 "$T/names")" "$(printf 'caf\303\251')" "one of them"
printf '%%sinew 1 text\naxis anchor 0\narray anchor.name str 1 anchor 1\naxis x-a 2\narray x-a.b str 1 x-a 2\n"a" "b"\n"c" "d"\nend\n' >"$T/none"
is "$(sinew info --get anchor.name --get axis.anchor --get surface.name "$T/none" | tr '\n' '|')" "0|" "a list of none is no line"
is "$(lines x-a.b "$T/none" | tr '\t' ' ')" "a b|c d|" "columns between tabs"
fails 1 "a model without muscles" "no key 'muscle.name': the model has no muscle.volume; it comes from attach" sinew info --get muscle.name "$T/none"
fails 1 "without that array" "no key 'anchor.name': the model has no anchor.name; it comes from attach" sinew info --get anchor.name tests/golden/v1/tet.text
fails 1 "a slip in one" "no key 'muscle.nam'; did you mean 'muscle.name'" sinew info --get muscle.nam "$small"

is "$(lines group.name "$small")" "skin|edge|lip|" "groups of surfaces, each once"

fibres='tissue.optimum tissue.passive tissue.stiffening tissue.straight tissue.vmax tissue.series tissue.fibre tissue.eta tissue.k1 tissue.k2 tissue.kappa tissue.angle'
# shellcheck disable=SC2046,SC2086 # words
is "$(lines material.key "$small")" "$(printf '%s|' tissue.law tissue.E tissue.nu tissue.density tissue.peak $fibres Tissue.law Tissue.E Tissue.nu Tissue.density Tissue.peak $(echo "$fibres" | sed s/tissue/Tissue/g))" \
    "what -m can set"
is "$(sed 's/^"neo-hookean"$/"mooney-rivlin"/' "$small" | sed '/^crc/d' | sinew info --names --get material.key | sed 6q | tr '\n' '|')" \
    "tissue.law|tissue.nu|tissue.c10|tissue.c01|tissue.K|tissue.density|" "of mooney-rivlin, its own keys"

# For completion: names alone, without a look at long arrays.
awk 'BEGIN { print "%sinew 1 text\naxis x-a 9000\narray x-a.b f64 1 x-a 2"; for (i = 0; i < 9000; i++) print i, "0.5"
    print "axis anchor 1\narray anchor.name str 1 anchor 1\n\"bone\"\nend" }' >"$T/long"
sinew export -f model -o "$T/long.bin" "$T/long"
gzip -c "$T/long.bin" >"$T/long.gz"
for file in long long.bin long.gz; do
    is "$(sinew info --names --get muscle.name --get anchor.name "$T/$file")" bone "--names of $file"
done
sed 's/^7 0.5$/7 what/' "$T/long" >"$T/passed"
is "$(sinew info --names --get anchor.name "$T/passed")" bone "a value of a long array is passed over"
fails 1 "which else is read" "expected 2 numbers" sinew info --get anchor.name "$T/passed"
head -c 9000 "$T/long.bin" >"$T/long.cut"
fails 1 "--names of what is cut" "cut" sinew info --names --get anchor.name "$T/long.cut"
is "$(cat "$T/stdout")" "" "has none"

# The summary.
check "the summary, by -o" sinew info -o "$T/summary" "$small"
for line in "text encoding" "node.displacement .*norm 0 to 0.05" "^  skin  *1  *0  *0  tissue$" \
    "^  muscle_a  *1  *0.0*  *0.050*  *0.050*$" "frames  2, the last of index 10; times 0 to 0.5 s" \
    "largest displacement 0.05 m, node 2 at 0.2 0 0" "x 0 to 0.2" "peak .*30000 to 30000, 1 nan" \
    "^  tissue  *neo-hookean  *E=3000 nu=0.45 density=1000$" "^  Tissue  *neo-hookean  *E=6000 nu=0.49 density=1100 peak=30000$"; do
    check "the summary has: $line" grep -q "$line" "$T/summary"
done
check "-v says what arrays are" sh -c "sinew info -v $small | grep -q 'contraction centre, the mean of its rigid nodes'"
printf '%%sinew 1 text\nmeta a "bell\x07 escape\x1b[31m"\nend\n' >"$T/rude"
is "$(sinew info "$T/rude" | tr -d '[:print:]\n')" "" "the summary sends a terminal no control characters"

# A time series.
sinew info --tsv node.displacement.max --tsv node.displacement.at.0.2,0,0 "$small" >"$T/series"
is "$(head -n 1 "$T/series" | tr '\t' ' ')" "frame time/s node.displacement.max/m node.displacement.at.0.2,0,0.x/m node.displacement.at.0.2,0,0.y/m node.displacement.at.0.2,0,0.z/m" \
    "--tsv: a heading with units"
is "$(sed -n 3p "$T/series" | tr '\t' ' ')" "10 0.5 0.05 0.03 0 0.04" "a row a frame"
is "$(wc -l <"$T/series" | tr -d ' ') $(awk -F '\t' '{ print NF }' "$T/series" | sort -u)" "3 6" "as many as there are frames, all as wide"
is "$(sinew info --tsv node.displacement.rows --tsv node.displacement.row.2 "$small" | sed -n '1p;3p' | tr '\t\n' '  ')" \
    "frame time/s node.displacement.rows node.displacement.row.2.x/m node.displacement.row.2.y/m node.displacement.row.2.z/m 10 0.5 12 0.03 0 0.04 " "counts have no unit"
sed -n '1,/^frame 10/p' "$small" | sinew info --tsv node.displacement.max 2>"$T/stderr" | { read -r _; read -r first && echo "$first" >"$T/live"; }
is "$(cut -f 1 "$T/live")" "$(sed -n '2s/\t.*//p' "$T/series")" "a row comes when its frame is whole, not at the end"
check "--tsv -o" sinew info --tsv node.displacement.max -o "$T/out.tsv" "$small"
is "$(cut -f 1-3 "$T/series" | cksum)" "$(cksum <"$T/out.tsv")" "the same in a file"
{ sed '$d' "$small" && echo 'fail 3 "tled-run: it diverged"'; } | sinew info --tsv node.displacement.max >"$T/failed.tsv"
is "$? $(wc -l <"$T/failed.tsv" | tr -d ' ')" "3 3" "a stream that failed gives the rows that came, and its status"
fails 1 "--tsv of an array of the body" "is not a number of a frame" sinew info --tsv node.position.max "$small"
fails 1 "of metadata" "is not a number of a frame" sinew info --tsv meta.note "$small"
fails 1 "of a type" "is not a number of a frame" sinew info --tsv node.displacement.type "$small"
fails 1 "of several rows" "several rows" sinew info --tsv node.displacement "$small"
fails 1 "of what frames lack" "no node.velocity; it comes from tled-run" sinew info --tsv node.velocity.max "$small"
fails 1 "of a slip" "did you mean 'node.displacement.max'" sinew info --tsv node.displacment.max "$small"
is "$(cat "$T/stdout")" "" "without a heading"
sed '/^frame/,$d' "$small" >"$T/body" && echo end >>"$T/body"
fails 1 "of a model without frames" "frame" sinew info --tsv node.displacement.max "$T/body"
fails 2 "--tsv with --get" "exclude each other" sinew info --tsv node.displacement.max --get frames "$small"
sed '$d' "$small" >"$T/cut"
fails 1 "of a stream that is cut" "cut" sinew info --tsv node.displacement.max -o "$T/never" "$T/cut"
is "$(ls "$T/never" 2>/dev/null)" "" "leaves no file"

# JSON.
if have python3; then
    sinew info --json "$small" >"$T/json"
    check "--json is JSON" python3 -m json.tool "$T/json"
    is "$(python3 -c "
import json, sys
m = json.load(open(sys.argv[1]))
peak = [a for a in m['arrays'] if a['name'] == 'material.peak'][0]
print(m['meta']['note'], m['axes']['node'], m['frames'], m['last']['time'], m['last']['arrays'][0]['max'],
      m['material'][0]['peak'], peak['nan'], m['volume'][1]['name'], m['volume'][1]['elements'], m['muscle'][0]['centre'])
" "$T/json")" "a \"quoted\" \\ name: é 12 2 0.5 0.05 None 1 muscle_a 1 [0, 0.05, 0.05]" "JSON has the values, nan as null"
    printf '%%sinew 1 text\nmeta a "tab\\tline\\nbell\\x07"\nend\n' | sinew info --json >"$T/json"
    is "$(python3 -c "import json, sys; print(repr(json.load(open(sys.argv[1]))['meta']['a']))" "$T/json")" \
        "'tab\\tline\\nbell\\x07'" "control characters in JSON strings"
    printf '%%sinew 1 text\nend\n' | sinew info --json >"$T/json"
    check "JSON of an empty model" python3 -m json.tool "$T/json"
else
    skip 4 "no python3"
fi

# Nonsense.
fails 1 "a slip in an axis" "no key 'axs.node'; did you mean 'axis.node'" sinew info --get axs.node "$small"
fails 1 "a slip in an array" "did you mean 'node.displacement.max'" sinew info --get node.displacment.max "$small"
fails 1 "a slip in a volume" "did you mean 'volume.count.skin'" sinew info --get volume.count.skn "$small"
fails 1 "no such value" "an array of numbers has min, max" sinew info --get node.displacement.maximum "$small"
fails 1 "numbers of strings" "an array of strings has rows" sinew info --get volume.name.max "$small"
fails 1 "a known array that is missing names its maker" "no node.velocity; it comes from tled-run" \
    sinew info --get node.velocity.max "$small"
fails 1 "an unknown key lists arrays" "no key 'zork'; expected frames, .*node.position, node.rigid" sinew info --get zork "$small"
fails 1 "an empty key" "no key ''" sinew info --get "" "$small"
fails 1 "a row past the end" "12 rows; expected a row from 0 on" sinew info --get node.rigid.row.12 "$small"
fails 1 "a negative row" "expected a row from 0 on" sinew info --get node.rigid.row.-1 "$small"
fails 1 "a place of two numbers" "expected at.X,Y,Z" sinew info --get node.position.at.1,2 "$small"
fails 1 "a place in an array without places" "at.X,Y,Z is for arrays of nodes" sinew info --get material.E.at.0,0,0 "$small"
fails 1 "several rows at once" "several rows" sinew info --get node.position "$small"
fails 2 "--json with --get" "exclude each other" sinew info --json --get frames "$small"
fails 2 "two models" "extra operand" sinew info "$small" "$small"
fails 1 "no such file" "nonesuch: cannot open" sinew info "$T/nonesuch"
fails 1 "no model at all" "no model on stdin \\(0 bytes\\)" sinew info
fails 1 "not a model" "is not a sinew model" sinew info common/base/err.h

sed '$d' "$small" >"$T/cut"
fails 1 "a stream without its end" "cut" sinew info "$T/cut"
is "$(cat "$T/stdout")" "" "a cut stream gives no summary"
fails 1 "--get of a cut stream gives nothing" "cut" sinew info --get axis.node -o "$T/never" "$T/cut"
is "$(ls "$T/never" 2>/dev/null)" "" "no output is left"

{ sed '$d' "$small" && echo 'fail 3 "tled-run: it diverged"'; } >"$T/failed"
sinew info <"$T/failed" >"$T/stdout" 2>"$T/stderr"
is "$?" 3 "a failed stream on standard input gives its status"
is "$(cat "$T/stdout" "$T/stderr")" "" "and says nothing: its tool has said it"
fails 3 "a failed stream in a file is told" "the run that wrote it failed: tled-run: it diverged" sinew info "$T/failed"

printf '%%sinew 1 text\nend\n' >"$T/empty"
check "an empty model has a summary" sinew info "$T/empty"
fails 1 "no axes" "no key 'axis.node'" sinew info --get axis.node "$T/empty"
is "$(sinew info --get frames "$T/empty")" 0 "no frames"
fails 1 "the time of no frame" "no key 'frame.time': the model has no frames" sinew info --get frame.time "$T/empty"
is "$(sinew info --get volume.count.a "$small")" 1 "muscle_ may be left out of a volume's name"
is "$(sinew info --get muscle.centre.a "$small")" "$(sinew info --get muscle.centre.muscle_a "$small")" "and of a muscle's"
printf '%%sinew 1 text\naxis node 0\narray node.position f64 m node 3\nend\n' >"$T/none"
is "$(sinew info --get node.position.max "$T/none")" nan "the largest of nothing"
is "$(sinew info --get node.position.mean "$T/none")" "nan nan nan" "the mean of nothing"
fails 1 "the nearest of no nodes" "there must be some" sinew info --get node.position.at.0,0,0 "$T/none"

# Whole numbers that no double holds: 2^63 - 1, -2^63 + 1, 2^53 + 1.
printf '%%sinew 1 text\naxis material 3\narray material.x-id i64 1 material 1\n%s\n%s\n%s\nend\n' \
    9223372036854775807 -9223372036854775807 9007199254740993 >"$T/whole"
is "$(sinew info --get material.x-id.max --get material.x-id.min --get material.x-id.low --get material.x-id.row.2 "$T/whole" |
    tr '\n' ' ')" "9223372036854775807 -9223372036854775807 -9223372036854775807 9007199254740993 " "i64 are exact"
sinew info "$T/whole" | grep -q ' -9223372036854775807 to 9223372036854775807$'
is $? 0 "in the summary"
is "$(sinew info --json "$T/whole" | grep -c -e '"min": -9223372036854775807, "max": 9223372036854775807' \
    -e '{"x-id": 9223372036854775807}' -e '{"x-id": -9223372036854775807}' -e '{"x-id": 9007199254740993}')" 4 "and in JSON"
printf '%%sinew 1 text\naxis a 0\narray x-id i64 1 a 1\nend\n' >"$T/whole"
is "$(sinew info --get x-id.max "$T/whole")" nan "the largest of none"

done_testing
