#!/bin/sh
# sinew diff: what differs, tolerances, statuses as diff(1).
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

small=tests/cli/small.sinew

# differs NAME PATTERN ARGS...: status 1, and a line of the report matches.
differs() {
    name=$1 pattern=$2
    shift 2
    sinew diff "$@" >"$T/report" 2>"$T/stderr"
    status=$?
    if [ "$status" -eq 1 ] && grep -Eq -e "$pattern" "$T/report"; then
        ok "$name"
    else
        not_ok "$name"
        diag "status $status, wanted 1, and a line: $pattern"
        diag_file "$T/report"
        diag_file "$T/stderr"
    fi
}

# edited SED-SCRIPT: the small model with a change, in $T/b.
edited() {
    sed "$1" "$small" >"$T/b"
}

check "a model is the same as itself" sinew diff "$small" "$small"
is "$(gzip -c "$small" | sinew diff "$small" -; echo $?)" 0 "- is standard input; nothing is said of what is the same"
gzip -c "$small" >"$T/small.gz"
check "gzipped or not" sinew diff "$T/small.gz" "$small"
edited 's/-s 100 --unit/-s 200 --unit/'
check "provenance does not count" sinew diff "$small" "$T/b"
awk '/^meta source/ { keep = $0; next } { print } /^meta note/ { print keep }' "$small" >"$T/b"
check "the order of metadata does not count" sinew diff "$small" "$T/b"

# What differs, each alone.
edited 's/"mm"/"cm"/'
differs "metadata" "^meta source.unit: 'mm' and 'cm'$" "$small" "$T/b"
edited '/^meta note/d'
differs "metadata in one only" "^meta note: only in $small$" "$small" "$T/b"
differs "metadata in the other only" "^meta note: only in $small$" "$T/b" "$small"
edited 's/^3000$/3001/'
differs "a value" "^material.E: 1 of 2 rows differ, the first row 0: 3000 and 3001; largest difference 1, relative 0.00033322" "$small" "$T/b"
edited 's/"two words"/"two"/'
differs "a string" "^x-word: 1 of 2 rows differ, the first row 1: 'two words' and 'two'$" "$small" "$T/b"
edited '/^array x-word/,/^"two/d'
differs "an array in one only" "^array x-word: only in $small$" "$small" "$T/b"
differs "an array in the other only" "^array x-word: only in $small$" "$T/b" "$small"
edited 's/^array x-heat f32 K/array x-heat f64 K/'
differs "a type" "^x-heat: f32 K node 1, 12 rows and f64 K node 1, 12 rows$" "$small" "$T/b"
edited 's/^array x-heat f32 K/array x-heat f32 mK/'
differs "a unit" "^x-heat: f32 K .* f32 mK" "$small" "$T/b"
edited 's/^axis x-lot 2/axis x-lot 1/; /^"two words"/d'
differs "an axis" "^axis x-lot: 2 and 1$" "$small" "$T/b"
differs "rows" "^x-word: .* 2 rows and .* 1 rows$" "$small" "$T/b"
edited 's/^frame 10 0.5/frame 11 0.6/'
differs "a frame's index" "^frame 2: index 10 and 11$" "$small" "$T/b"
differs "a frame's time" "^frame 2: time 0.5 and 0.6 s$" "$small" "$T/b"
edited 's/^0.03 0 0.04/0.03 0 0.040001/'
differs "a frame's value" "^frame 2: node.displacement: 1 of 12 rows differ, the first row 2: 0.03 0 0.04 and 0.03 0 0.040001" "$small" "$T/b"
cp "$T/b" "$T/moved"
is "$(sinew diff -q "$small" "$T/b"; echo $?)" 1 "-q says it by the status alone"
sed '/^frame 10/,$d' "$small" >"$T/fewer"
echo end >>"$T/fewer"
differs "fewer frames" "^frames: 2 and 1$" "$small" "$T/fewer"
differs "more frames" "^frames: 1 and 2$" "$T/fewer" "$small"
edited 's/^nan$/1/'
differs "nan and a number" "^material.peak: .*: nan and 1; largest difference nan, relative nan$" "$small" "$T/b"
edited 's/^11$/inf/'
differs "no tolerance makes inf a number" "^x-heat: .*: 11 and inf; largest difference inf" --rel 1 --abs 1e300 "$small" "$T/b"

# Tolerances.
check "--abs over the difference" sinew diff --abs 1.1e-6 "$small" "$T/moved"
differs "--abs under the difference" "node.displacement" --abs 0.9e-6 "$small" "$T/moved"
check "--rel over the difference" sinew diff --rel 2.6e-5 "$small" "$T/moved"
differs "--rel under the difference" "node.displacement" --rel 2.4e-5 "$small" "$T/moved"
check "--abs for the array" sinew diff --abs node.displacement=1e-5 "$small" "$T/moved"
differs "--abs for another array" "node.displacement" --abs node.position=1e-5 "$small" "$T/moved"
differs "an array's own tolerance goes before the general one" "node.displacement" \
    --abs node.displacement=1e-9 --abs 1 "$small" "$T/moved"
edited 's/^1 2 5 4 7 8 11 10/1 2 5 4 7 8 10 11/'
differs "no tolerance for whole numbers" "element.node" --abs 5 "$small" "$T/b"
check "--only looks at nothing else" sinew diff --only node.position,material.E "$small" "$T/b"
check "--only an array without frames does not count frames" sinew diff --only node.position "$small" "$T/fewer"
differs "--only an array of frames does" "frames: 2 and 1" --only node.displacement "$small" "$T/fewer"
check "-o writes the report" sh -c "sinew diff -o '$T/out' $small '$T/moved'; test \$? = 1 && grep -q node.displacement '$T/out'"

# Trouble is 2, whatever it is.
fails 2 "--only an unknown array" "--only zork: neither .* has such an array" sinew diff --only zork "$small" "$small"
fails 2 "a tolerance for an unknown array" "--abs node.displacment: neither" sinew diff --abs node.displacment=1 "$small" "$small"
fails 2 "a tolerance for whole numbers" "node.rigid is of type u8: a tolerance is for f32 and f64" sinew diff --rel node.rigid=1 "$small" "$small"
fails 2 "a negative tolerance" "--abs '-1': expected a number from 0 on" sinew diff --abs -1 "$small" "$small"
fails 2 "a tolerance that is no number" "expected a number" sinew diff --rel node.position=much "$small" "$small"
fails 2 "a tolerance for no name" "expected a number" sinew diff --abs =1 "$small" "$small"
fails 2 "an empty name" "expected names of arrays" sinew diff --only node.position, "$small" "$small"
fails 2 "one operand" "missing operand; expected A B" sinew diff "$small"
fails 2 "three operands" "extra operand" sinew diff "$small" "$small" "$small"
fails 2 "standard input twice" "both operands are standard input" sinew diff - -
fails 2 "no such file" "nonesuch: cannot open" sinew diff "$small" "$T/nonesuch"
fails 2 "not a model" "Makefile: is not a sinew model" sinew diff Makefile "$small"
fails 2 "nothing on standard input" "no model on stdin" sinew diff "$small" -
sed '$d' "$small" >"$T/cut"
fails 2 "a cut stream" "cut" sinew diff "$small" "$T/cut"
fails 2 "a cut stream, first" "cut" sinew diff "$T/cut" "$small"
{ sed '$d' "$small" && echo 'fail 1 "tled-run: no"'; } >"$T/failed"
fails 2 "a failed run in a file" "failed: tled-run: no" sinew diff "$small" "$T/failed"
is "$(sinew diff "$small" - 2>&1 <"$T/failed"; echo $?)" 2 "a failed run in the pipe has been told"

printf '%%sinew 1 text\nend\n' >"$T/empty"
check "nothing is the same as nothing" sinew diff "$T/empty" "$T/empty"
differs "nothing and something" "^axis node: only in $small$" "$T/empty" "$small"

is "$(sinew diff -v "$small" "$small" 2>&1)" "sinew-diff: $(($(grep -c '^array' "$small"))) arrays compared; frames: 2 and 2" \
    "-v says how much was compared"

# A length with its unit, for arrays of lengths.
awk '/^array node.displacement/ && n++ == 0 { print; getline; $1 = $1 + 0.0009; print; next } /^crc/ { next } { print }' "$small" >"$T/b"
sed '/^crc/d' "$small" >"$T/a"
differs "a displacement that is .9 mm off" "^frame 1: node.displacement: 1 of 12 rows" "$T/a" "$T/b"
check "within 1 mm" sinew diff --abs node.displacement=1mm "$T/a" "$T/b"
check "within .1 cm" sinew diff --abs node.displacement=.1cm "$T/a" "$T/b"
differs "not within 800 um" "^frame 1: node.displacement: 1 of 12 rows" --abs node.displacement=800um "$T/a" "$T/b"
check "1 mm for every array of lengths" sinew diff --abs 1mm "$T/a" "$T/b"
edited 's/^3000$/3000.0005/'
differs "which says nothing of those that are none" "^material.E" --abs 1mm "$small" "$T/b"
check "these may have a number beside it" sinew diff --abs 1e-3 --abs 1um "$small" "$T/b"
fails 2 "a length for what is none" "--abs 'material.E=1mm': its unit is Pa, not a length; expected a number" \
    sinew diff --abs material.E=1mm "$small" "$T/b"
fails 2 "a unit for a share" "--rel 'node.displacement=1mm': expected a number" sinew diff --rel node.displacement=1mm "$small" "$T/b"
fails 2 "no unit of ours" "--abs 'node.displacement=1ft': expected" sinew diff --abs node.displacement=1ft "$small" "$T/b"
fails 2 "a length below 0" "--abs 'node.displacement=-1mm': expected" sinew diff --abs node.displacement=-1mm "$small" "$T/b"
done_testing
