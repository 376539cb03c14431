#!/bin/sh
# The tables of sinew-performance(7) say what the files of tests/bench have, to their last digit.
. "$(dirname "$0")/lib.sh"

page=man/sinew-performance.7
card=tests/bench/nvidia-h200.csv
physical=tests/bench/nvidia-h200-physical.csv
amd=tests/bench/amd-epyc-2-processors.csv

# table TEXT: the first literal block of the page behind a line with TEXT.
table() {
    awk -v text="$1" 'index($0, text) { on = 1 } on && /^\.Ed/ { exit } on == 2 { print } on && /^\.Bd/ { on = 2 }' "$page"
}

# wanted COLUMN: of the rows of steps of FILE..., "DEVICE THREADS PRECISION ELEMENTS VALUE" a line.
wanted() {
    column=$1
    shift
    awk -F, -v column="$column" '$5 == "step" { printf "%s %s %s %d %.9g\n", $2, $2 == "cuda" ? "-" : $3, $4, $6, $column }' "$@"
}

# not_measured FILE FILE: the lines of the first whose last word, which is rounded, the second does not have.
not_measured() {
    awk 'function key() { return $1 " " $2 " " $3 " " $4 }
        # What the last digit that counts stands for: of a number without a point the fourth.
        function unit(text) {
            if (index(text, ".")) return 10 ^ (index(text, ".") - length(text))
            return length(text) > 4 ? 10 ^ (length(text) - 4) : 1
        }
        NR == FNR { value[key()] = value[key()] " " $5; next }
        {
            n = split(value[key()], has, " ")
            for (i = 1; i <= n && (has[i] - $5) ^ 2 > (.51 * unit($5)) ^ 2; i++) ;
            if (i > n) print $0 ", measured" value[key()]
        }' "$2" "$1"
}

# Microseconds a step.
table 'In microseconds, with' | awk '
    NR == 1 { for (i = 1; i <= NF; i++) { gsub(",", "", $i); size[i] = $i }; sizes = NF; next }
    /^H200/ { device = "cuda -" } /^Xeon/ { device = "cpu 16" } /^EPYC, 2/ { device = "cpu 2" } /^EPYC, 1/ { device = "cpu 1" }
    { for (i = 1; $i != "single" && $i != "double"; i++) ; for (k = 1; k <= sizes && i + k <= NF; k++) print device, $i, size[k], $(i + k) }' >"$T/steps"
is "$(wc -l <"$T/steps" | tr -d ' ')" 44 "microseconds a step: 44 numbers"
{ wanted 11 "$card" "$physical" | grep -v '^cpu 1 ' && wanted 11 "$amd"; } >"$T/measured"
is "$(not_measured "$T/steps" "$T/measured")" "" "as they were measured"
sed '1s/2\.06$/2.08/' "$T/steps" >"$T/other"
is "$(not_measured "$T/other" "$T/measured" | grep -c '^cuda - single 2176 2.08,')" 1 "one that was not is seen"

# Seconds for a simulated second, and time steps; of the face at 1.25 mm in double precision one thread.
table 'In seconds, with isotropic' | awk 'NR > 2 { gsub(",", "", $3); print "cuda - single", $3, $5; print "cuda - double", $3, $6
    if (NF > 6) { print "cpu 2 single", $3, $7; print "cpu", $9 == "(1" ? 1 : 2, "double", $3, $8 } }' >"$T/seconds"
is "$(wc -l <"$T/seconds" | tr -d ' ')" 14 "seconds for a simulated second: 14 numbers"
awk -F, -v OFS=, '$16 > 0 { $16 = 1 / $16 } { print }' "$card" "$amd" >"$T/inverse.csv"
wanted 16 "$T/inverse.csv" | grep -v '^cpu 16 ' >"$T/measured"
is "$(not_measured "$T/seconds" "$T/measured")" "" "as they were measured"
table 'In seconds, with isotropic' | awk 'NR > 2 { gsub(",", "", $3); print "cuda - single", $3, $4 }' >"$T/dt"
wanted 15 "$card" >"$T/measured"
is "$(not_measured "$T/dt" "$T/measured")" "" "and the time steps"

# Bytes an element.
table 'In bytes for each element' | awk 'NR > 1 { gsub(",", ""); print "cuda - single", $(NF - 2), $(NF - 1); print "cuda - double", $(NF - 2), $NF }' >"$T/bytes"
is "$(wc -l <"$T/bytes" | tr -d ' ')" 18 "bytes an element: 18 numbers"
wanted 8 "$card" >"$T/measured"
is "$(not_measured "$T/bytes" "$T/measured")" "" "as they were measured"

done_testing
