#!/bin/sh
# That tests/pages sees what it is there for: text of manual pages that mandoc, groff or both of them drop or misread.
. "$(dirname "$0")/lib.sh"

have mandoc || skip_all "no mandoc"
have groff || skip_all "no groff"

# page LINES: $T/x.1, a sound page but for these lines.
page() {
    printf '%s\n' '.Dd November 21, 2026' '.Dt X 1' '.Os Sinew' '.Sh NAME' '.Nm x' '.Nd a page' '.Sh SYNOPSIS' '.Nm' '.Op Fl -unit Ar FILE' \
        '.Sh DESCRIPTION' 'Words, a range of 1\(en2, a non\-conforming word' '.Pq and Em these' "$@" '.Sh CAVEATS' 'The end is printed.' >"$T/x.1"
}

page 'of --rest.'
check "a sound page" "$ROOT/tests/pages" "$T/x.1"
is "$(cat "$T/stdout")" "" "of which nothing is said"

# finds NAME PATTERN LINES: a breach is said, with its line where that is known.
finds() {
    name=$1 pattern=$2
    shift 2
    page "$@"
    "$ROOT/tests/pages" "$T/x.1" >"$T/said" 2>&1
    is "$? $(grep -Ec -e "$pattern" "$T/said")" "1 1" "$name"
    [ -s "$T/said" ] || diag "nothing is said"
}
finds "a title that begins with a macro ends the page in groff" 'text: mandoc prints' '.Rs' '.%A A. Author' '.%T An old title' '.Re'
finds "which is said of its line too" 'x\.1:15: word: An is a macro; expected \\&An' '.Rs' '.%A A. Author' '.%T An old title' '.Re'
finds "a unit that both take for a macro" 'x\.1:13: word: Pa is a macro' '.Op Fl -stress Cm auto | Pa | kPa'
finds "one at the end of a line" 'x\.1:13: word: Pa is a macro' '.Op Fl -stress Cm kPa | Pa'
finds "a word that is a macro nobody calls" 'x\.1:13: word: In is a macro' '.Em words In print'
finds "a value that gets an option's dash" 'x\.1:13: word: 8 would be an option' '.Fl -fraction 8 ,'
finds "words that get one behind a comma" 'x\.1:13: word: and would be an option' '.Fl -density, and the law'
finds "a journal's number before its volume" 'x\.1:16: word: a number is printed before' '.Rs' '.%A A. Author' '.%V 23' '.%N 2' '.Re'
finds "a command that is printed over two lines" 'x\.1:13: width: 68 characters' ".Dl tool --file $(printf '%056d' 0)"
finds "a macro that there is not" 'x\.1: groff: .*(warning|error)' '.Zz word'
finds "what mandoc alone warns of" 'mandoc: .*WARNING: skipping paragraph' '.Pp'
rm "$T/x.1"
fails 1 "no page at all" '' "$ROOT/tests/pages" "$T/x.1"
done_testing
