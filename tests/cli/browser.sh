#!/bin/sh
# The HTML pages that samples/paper and man/html make, opened in a browser: every picture loads, and nothing is wider than the screen of a
# telephone. `make browser` runs this test, as do make check-all and continuous integration; make check does not, since a browser is large.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

have chromium || skip_all "no chromium"

# opened PAGE SCRIPT: opens a page of $T, 360 pixels wide, and prints the value of the script, in which d is the page's document. (The window
# cannot be as narrow as a telephone, but a frame in it can.)
opened() {
    cat >"$T/frame.html" <<END
<!DOCTYPE html><html><body style="margin:0"><iframe id="f" style="border:0;width:360px;height:700px" src="$1"></iframe><script>
onload = () => { const d = document.getElementById("f").contentDocument; document.title = $2; };
</script></body></html>
END
    HOME=$T timeout 240 chromium --headless=new --no-sandbox --hide-scrollbars --disable-gpu --disable-dev-shm-usage --user-data-dir="$T/profile" \
        --allow-file-access-from-files --dump-dom "file://$T/frame.html" >"$T/dom" 2>"$T/chromium"
    sed -n 's/.*<title>\(.*\)<\/title>.*/\1/p' "$T/dom"
}

# The figures and tables of the papers, two sections of them, without real data and without the programs that measure.
check "a page of figures" env SINEW_SHARED="$T/none" BENCH="$T/none" samples/paper "$T/out" wm-models wm-table-1
is "$(opened out/paper.html '[d.documentElement.scrollWidth, [...d.images].filter(p => p.naturalWidth > 0).length, d.querySelectorAll("h3").length].join(" ")')" \
    "360 10 4" "360 pixels: nothing is wider, all pictures are there, all headings"

# The manual: a page with tables, and the list of pages.
if have mandoc; then
    check "the manual as HTML" man/html "$T/man"
    is "$(opened man/tled-run.1.html '[d.documentElement.scrollWidth <= 360, d.querySelectorAll("table").length > 0, d.title].join(" ")')" \
        "true true TLED-RUN(1)" "a page of the manual"
    is "$(opened man/index.html '[d.documentElement.scrollWidth <= 360, [...d.querySelectorAll("a")].length > 10].join(" ")')" "true true" "the list of pages"
else
    skip 3 "no mandoc"
fi
done_testing
