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
if [ -n "$SINEW_LONG" ]; then
    hold long
else
    skip 1 "finer meshes and large strain take minutes: SINEW_LONG is not set"
fi
done_testing
