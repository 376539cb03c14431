#!/bin/sh
# tled-run's element against converged answers, within limits: tests/element/errors says of what. With SINEW_LONG, finer meshes and large strain too.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/../cli/lib.sh"

# Each row of the table is a test: its error is within its limit, or, where the answer is 0, itself is.
hold() { # LIST
    tests/element/errors "$1" >"$T/table" 2>"$T/said" || not_ok "tests/element/errors $1"
    diag_file "$T/said"
    while IFS="$(printf '\t')" read -r problem case mesh answer got error limit; do
        name="$problem, $case, $mesh: $got, expected $answer within $limit %"
        [ "$problem" = problem ] && continue
        if [ "$limit" = - ]; then
            diag "$problem, $case, $mesh: $got; $answer: $error %"
        elif [ "$answer" = 0 ]; then
            near "$got" 0 "$limit" "$problem, $case, $mesh: $got, expected at most $limit"
        else
            near "$error" 0 "$limit" "$name"
        fi
    done <"$T/table"
}

hold short
# Figures of the table of references, found once more on its coarsest meshes.
again() { # PROBLEM
    SIZES=2 tests/element/references "$1" >"$T/again" 2>"$T/said" || not_ok "tests/element/references $1"
    diag_file "$T/said"
    while read -r problem case size value; do
        near "$value" "$(awk -v p="$problem" -v c="$case" -v n="$size" '$1 == p && $2 == c && $3 == n { print $4 }' tests/element/references.tsv)" 1e-5 \
            "$problem, $case, once more on $size elements through the thickness"
    done <"$T/again"
}

if [ -n "$SINEW_LONG" ]; then
    hold long
    if have ccx; then
        again yeoh
    else
        skip 1 "no CalculiX (calculix-ccx)"
    fi
    if /usr/bin/python3 -c 'import getfem' 2>"$T/said"; then
        again fibres
    else
        skip 1 "no GetFEM (python3-getfem)"
    fi
else
    skip 1 "finer meshes and large strain take minutes: SINEW_LONG is not set"
fi
done_testing
