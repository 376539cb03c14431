#!/bin/sh
# make html: every page and an index; every link leads to something, and none out of the folder but to Debian's pages.
. "$(dirname "$0")/lib.sh"

have mandoc || skip_all "no mandoc"
check "the pages are made" man/html "$T/man"
cd "$T/man" || exit 1
is "$(ls)" "$({ for page in "$ROOT"/man/*.[157]; do echo "$(basename "$page").html"; done; printf 'index.html\nman.css\n'; (cd "$ROOT/man" && ls -- *.svg); } | LC_ALL=C sort)" \
    "a page each, an index, one style, and the figures"
grep -o 'href="[^"]*"' -- *.html | sed 's/:href="/ /; s/"$//' | sort -u >"$T/links"
check "there are links: $(wc -l <"$T/links" | tr -d ' ')" test "$(wc -l <"$T/links")" -gt 500
# Where a link may lead: files, and places in them.
{
    find . -type f -size +0 | sed 's|^\./||'
    grep -o 'id="[^"]*"' -- *.html | sed 's/:id="/#/; s/"$//'
} >"$T/places"
awk 'NR == FNR { is[$0]; next }
    $2 ~ /^(https:\/\/manpages\.debian\.org\/bookworm\/.*\.[1-8]$|http:\/\/|https:\/\/doi\.org\/)/ { next }
    { to = $2 ~ /^#/ ? $1 $2 : $2 }
    !(to in is) { print $1 ": " $2 }' "$T/places" "$T/links" >"$T/dead"
is "$(cat "$T/dead")" "" "no link is dead"
is "$(sed -n 's|.* https://manpages.debian.org/bookworm/||p' "$T/links" | sort -u | while read -r page; do [ -e "$ROOT/man/$page" ] && echo "$page"; done)" "" \
    "none to Debian's pages for one of ours"
is "$(grep -L 'name="viewport"' -- *.html)" "" "each is laid out for the width of a telephone too"
is "$(grep -L 'href="index.html"' -- *.[157].html)" "" "each leads back to the index"
is "$(for page in *.[157].html; do grep -q "href=\"$page\"" index.html || echo "$page"; done)" "" "which leads to each"
check "light and dark" grep -q 'prefers-color-scheme: dark' man.css
is "$(grep -c 'url(\|@import' man.css)" 0 "the style needs no other file"

mkdir "$T/bin"
printf '#!/bin/sh\nexit 1\n' >"$T/bin/mandoc"
chmod +x "$T/bin/mandoc"
env PATH="$T/bin:$PATH" "$ROOT/man/html" "$T/failed"
is "$?" 1 "where mandoc fails, so does man/html"
is "$(find "$T/failed" -name '*.part')" "" "nothing unfinished is left"
done_testing
