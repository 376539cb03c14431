#!/bin/sh
# tled-run --log: what was held, came and went of energy adds up, for each thing that does work; the run is the same with and
# without; rows are whole, in time's order, and of sound states only.
. "$(dirname "$0")/lib.sh"

awk -v nx=8 -v ny=6 -v nz=5 -v h=0.005 -v held=low -f tests/cli/block.awk >"$T/block.sinew"
awk -v nx=10 -v ny=4 -v nz=4 -v h=0.0025 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/muscle.sinew"
awk 'BEGIN { for (i = 0; i <= 20; i++) printf "%.4f 0.02 0.015 %.6f 1 0 0 0\n", i / 100, .026 - .006 * i / 20 }' >"$T/press.tum"
printf '0 force .04,.015,.0125 .01 0,0,0\n.05 force .04,.015,.0125 .01 0,.005,0\n' >"$T/force"
printf '0 displace .0399,-1,-1,1,1,1 0,0,0\n.05 displace .0399,-1,-1,1,1,1 .004,0,.002\n' >"$T/displace"

# column NAME FILE: of the last row.
column() {
    awk -F '\t' -v name="$1/" 'NR == 1 { for (i = 1; i <= NF; i++) if (index($i "/", name) == 1) at = i } END { print $at }' "$2"
}
# balanced NAME COLUMN SHARE: nothing is left over but SHARE of the most that was done by COLUMN, in any row, and it did something.
balanced() {
    awk -F '\t' -v name="$2/" 'NR == 1 { for (i = 1; i <= NF; i++) { if (index($i, name) == 1) at = i; if ($i == "balance/J") rest = i } next }
        { d = $at < 0 ? -$at : $at; if (d > most) most = d; b = $rest < 0 ? -$rest : $rest; if (b > left) left = b }
        END { printf "%.3g of %.3g J", left, most; exit !(at && rest && most > 1e-9 && left < '"$3"' * most) }' "$T/log" >"$T/left"
    is $? 0 "$1: what is left over is $(cat "$T/left")"
}
# logged NAME COLUMN SHARE FILE ARG...
logged() {
    name=$1 what=$2 share=$3 file=$4
    shift 4
    check "$name" tled-run -q -d cpu --log "$T/log" --log-every .001 -o "$T/out" "$@" <"$file"
    balanced "$name" "$what" "$share"
}
logged "gravity, no damping" gravity .01 "$T/block.sinew" -g 0,2,-9.81 --damping 0 -t .1
is "$(awk -F '\t' 'NR > 1 { $7 += 0; if ($9 != 0 || $10 != 0 || $11 != 0 || $12 != 0 || $13 != 0) print }' "$T/log")" "" "and nothing else does work"
logged "gravity, damped" gravity .01 "$T/block.sinew" -g 0,2,-9.81 -t .2
logged "a force" forces .01 "$T/block.sinew" --script "$T/force" --damping 5 -t .1
logged "a displacement" displaced .01 "$T/block.sinew" --script "$T/displace" --damping 20 -t .1
logged "a muscle" muscles .01 "$T/muscle.sinew" -c all=0.5 -t .2
printf '0 contract all 0\n.05 contract all 0\n.06 contract all 1\n' >"$T/late"
logged "steps that are cut, and taken again" muscles .01 "$T/muscle.sinew" --script "$T/late" -t .2
is "$(awk -F '\t' 'NR == 2 { first = $3 } NR > 2 && $3 < first { cut = 1 } NR > 2 && $1 <= before { print NR } { before = $1 } END { print cut + 0 }' "$T/log")" \
    1 "the step was cut, and no row stands twice"
logged "a muscle and gravity, in single precision" muscles .01 "$T/muscle.sinew" --precision single -c all=0.5 -g 0,0,-9.81 -t .2
logged "a probe" probe .02 "$T/block.sinew" --probe sphere:2cm --poses "$T/press.tum" -t .2
awk -v n=5 -f samples/ball.awk | sinew import -q --unit m -o "$T/ball.sinew" -
logged "gravity on elements that are no boxes" gravity .01 "$T/ball.sinew" -g 0,3,-9.81 --damping 5 -t .1
logged "a poor hourglass control" hourglass .2 "$T/block.sinew" --hourglass .0005 --script "$T/force" --damping 5 -t .1

# ---- Rows.
is "$(head -n 1 "$T/log" | tr '\t' '\n' | sed -n '1p;4p;14p;20p' | tr '\n' ' ')" "time/s stable/s balance/J elements/(1/s) " "a heading with units"
is "$(awk -F '\t' 'NF != 24 || (NR > 2 && $1 <= before) { print NR } { before = $1 }' "$T/log")" "" "24 columns, times that rise"
tled-run -q -d cpu -c all=1 -t .2 -o "$T/plain" <"$T/muscle.sinew"
for every in '' '--log-every .0007' '--log-every 1e-9' '--log-every 5'; do
    # shellcheck disable=SC2086 # two words, or none
    tled-run -q -d cpu -c all=1 -t .2 --log "$T/log" $every -o "$T/out" <"$T/muscle.sinew"
    check "the same run with a log, ${every:-a row a look}: $(wc -l <"$T/log" | tr -d ' ') lines" cmp "$T/plain" "$T/out"
    is "$(column time "$T/log") $(awk -F '\t' 'NR == 2 { print $1 }' "$T/log")" "0.2 0" "from the first state to the last"
done
is "$(wc -l <"$T/log" | tr -d ' ')" 3 "an interval longer than the run: its first and last state"
tled-run -q -d cpu -c all=1 -t .2 --log "$T/log" -o "$T/out" <"$T/muscle.sinew"
# shellcheck disable=SC2016 # for awk
check "the step was cut on the way" awk -F '\t' 'NR == 2 { first = $3 } NR > 2 && $3 < first { cut = 1 } END { exit !cut }' "$T/log"
tled-run -q -d cpu -c all=1 -t .2 --every .001 --log "$T/film" -o "$T/out" <"$T/muscle.sinew"
is "$(cut -f 1-18,21- "$T/film" | cksum)" "$(cut -f 1-18,21- "$T/log" | cksum)" "the same rows whatever frames are written"
for threads in 1 2 3; do
    tled-run -q -d cpu --threads $threads -c all=1 -t .2 --log-every .003 --log "$T/log$threads" -o "$T/out" <"$T/muscle.sinew"
done
cut -f 1-18,21- "$T/log1" >"$T/first"
for threads in 2 3; do
    cut -f 1-18,21- "$T/log$threads" >"$T/other"
    check "$threads threads: the same bytes, but for the clock's columns" cmp "$T/first" "$T/other"
done
near "$(sinew info --get node.displacement.max "$T/out")" "$(column displacement "$T/log1")" 1e-8 "the largest displacement"
near "$(sinew info --get node.velocity.max "$T/out")" "$(column speed "$T/log1")" 1e-8 "the largest speed"
check "to rest" tled-run -q -d cpu -g 0,0,-9.81 --rest 1e-3 --log "$T/log" -o "$T/out" <"$T/block.sinew"
check "what remains, in the end: $(column remaining "$T/log")" awk "BEGIN { exit !($(column remaining "$T/log") <= 1e-3) }"
# Steps grow at the script's end, .1 s: seen from there a multiple lies in the step to it that an earlier one was of.
check "to rest, by an interval that no step meets" tled-run -q -d cpu -g 0,0,-9.81 --rest 1e-3 --every .0071 --log "$T/log" --log-every .0071 -o "$T/grown" <"$T/block.sinew"
# twice: multiples of .0071 s that several times of standard input are of; the last time, of the end, is none.
twice() {
    sed '$d' | awk '{ m = int($1 / .0071 + 1e-6) } NR > 1 && m == was { print m } { was = m }'
}
is "$(sed 1d "$T/log" | cut -f 1 | twice)" "" "no multiple has two rows"
is "$(sinew info --tsv node.displacement.max "$T/grown" | sed 1d | cut -f 2 | twice)" "" "nor two frames"
check "a run gone on with" sh -c "tled-run -q -d cpu -g 0,0,-9.81 -t .05 --log '$T/log' <'$T/out' >/dev/null"
is "$(awk -F '\t' 'NR == 2 { print $8 + $13, $14 }' "$T/log")" "0 0" "counts from its start"

# ---- Places.
check "--tsv" tled-run -q -d cpu -c all=0.5 -t .1 --every .01 --log "$T/log" --tsv node.displacement.at.25mm,5mm,5mm --tsv node.displacement.at.0.02,0.001,0.0101 -o "$T/out" <"$T/muscle.sinew"
is "$(head -n 1 "$T/log" | cut -f 19- | tr '\t' ' ')" "steps/(1/s) elements/(1/s) node.displacement.at.25mm,5mm,5mm.x/m node.displacement.at.25mm,5mm,5mm.y/m node.displacement.at.25mm,5mm,5mm.z/m node.displacement.at.0.02,0.001,0.0101.x/m node.displacement.at.0.02,0.001,0.0101.y/m node.displacement.at.0.02,0.001,0.0101.z/m muscles.falling quality.j.centre quality.j.corner quality.folded quality.hourglass" "columns after the others, and before those of quality.t"
# What sinew info says of the frames, in nine digits as in a log.
sinew info --tsv node.displacement.at.25mm,5mm,5mm --tsv node.displacement.at.0.02,0.001,0.0101 "$T/out" |
    awk -F '\t' 'NR > 1 { printf "%.9g", $2; for (i = 3; i <= 8; i++) printf "\t%.9g", $i; print "" }' >"$T/frames"
sed 1d "$T/log" | cut -f 1,21-26 >"$T/rows"
is "$(wc -l <"$T/rows" | tr -d ' ')" 11 "a row a look"
check "the same as of frames" cmp "$T/frames" "$T/rows"
tled-run -q -d cpu -c all=0.5 -t .1 --log "$T/log" --log-every .0005 --tsv node.displacement.at.25mm,5mm,5mm -o "$T/plain" <"$T/muscle.sinew"
is "$(awk -F '\t' 'NR > 1 && NF == 28 { n++ } END { print n }' "$T/log")" 201 "finer than frames, without any"
is "$(sinew info --get frames "$T/plain") $(sinew info "$T/plain" | grep -c -e --tsv)" "1 0" "and no word of it in provenance"

# ---- What goes wrong.
fails 3 "a run that diverges" "diverged at step" tled-run -q -d cpu --dt .00035 -c all=1 -t .2 --ramp .01 --log "$T/log" -o "$T/none" <"$T/muscle.sinew"
is "$(awk -F '\t' 'NF != 25 { print NR } NR > 1 && ($5 != $5 + 0 || $6 != $6 + 0) { print NR }' "$T/log")" "" "leaves whole rows of what was sound"
check "up to where it broke" test "$(wc -l <"$T/log")" -ge 2
fails 1 "a full disk" "/dev/full: cannot write: No space left" tled-run -q -d cpu -n 10 --log /dev/full -o "$T/never" <"$T/block.sinew"
is "$(ls "$T/never" 2>/dev/null)" "" "leaves no model"
fails 1 "no such folder" "nonesuch/log: cannot open" tled-run -q -n 10 --log "$T/nonesuch/log" -o "$T/never" <"$T/block.sinew"
fails 1 "standard output" "standard output is the model's" tled-run -q -n 10 --log - -o "$T/never" <"$T/block.sinew"
fails 2 "--log-every alone" "log-every without --log" tled-run -q -n 10 --log-every 1 <"$T/block.sinew"
fails 2 "--tsv alone" "tsv without --log" tled-run -q -n 10 --tsv node.displacement.at.0,0,0 <"$T/block.sinew"
for key in node.displacement.max node.velocity.at.0,0,0 node.displacement.at.1,2 node.displacement.at.1,2,3,4 node.displacement.at.1,2,3parsec node.displacement.at.nan,0,0 ''; do
    fails 2 "--tsv '$key'" "expected node.displacement.at.X,Y,Z, three lengths" tled-run -q -n 10 --log "$T/none.log" --tsv "$key" <"$T/block.sinew"
done
is "$(ls "$T/none.log" 2>/dev/null)" "" "makes no log"
cp "$T/force" "$T/both"
for option in --script --materials --checkpoint --restart; do
    fails 2 "a log that is the file of $option too" "both' would overwrite the file of $option '.*both'; expected another file" tled-run -q -n 10 --log "$T/both" $option "$T/both" <"$T/block.sinew"
done
check "stays as it was" cmp "$T/force" "$T/both"
fails 2 "a log that is the output too" "would overwrite the file of .*output.s'; expected another file" tled-run -q -n 10 --log "$T/output.s" -o "$T/output.s" <"$T/block.sinew"
is "$(sinew info "$T/plain" | grep -c -e --log)" 0 "no word of it in provenance"
done_testing
