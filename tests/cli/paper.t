#!/bin/sh
# samples/paper: the page that its sections' words make, in both forms; sections without real data and without what measures; a tool
# that fails. (make paper itself takes minutes.)
. "$(dirname "$0")/lib.sh"

have make || skip_all "no make"
have base64 || skip_all "no base64"
have python3 || skip_all "no python3"

# set_page FORM PAGE
set_page() {
    awk -v form="$1" -v folder="$T/in" -v style=samples/paper.d/page.css -f samples/paper.d/page.awk "$2"
}

# A page of its own: what must be escaped, tables with gaps, both kinds of picture.
mkdir "$T/in"
printf 'model\tms, paper\tms\nball & bowl\t0.187\t1.50e-01\nlonger name\t12 (3.4)\t-\nwhat <is> "gone"\t\t7\n' >"$T/in/t.tsv"
printf 'what\tof\nsteps, paper\tno number\nsteps\t5\n' >"$T/in/u.tsv"
sinew render --size 64x48 -o "$T/in/p.png" tests/cli/small.sinew
printf '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path stroke="black" d="M1 1L8 8"/></svg>\n' >"$T/in/s.svg"
{
    printf 'title\tA page of 1\nsay\tBefore: 2 < 3 & 4 > 3, "so".\nchapter\tc\tChapter 5\nheading\th\tHeading 6\n'
    printf 'say\t%s\n' "$(awk 'BEGIN { for (i = 1; i <= 60; i++) printf "word%d ", i }')"
    printf 'table\tt.tsv\tA table of 7\npicture\tp.png\tFirst 8\tA picture\npicture\ts.svg\tSecond 9\tA stroke\n'
    printf 'missing\tThere is no 10.\ntable\tu.tsv\tAnother\n'
} >"$T/page"
set_page html "$T/page" >"$T/page.html"
set_page txt "$T/page" >"$T/page.txt"
is "$(python3 tests/cli/paper_page.py "$T/page.html" "$T/page.txt" 2>&1)" "" "well-formed, alone, and the same numbers in both"
check "what is HTML's is escaped" grep -q '2 &lt; 3 &amp; 4 &gt; 3, &quot;so&quot;' "$T/page.html"
check "a paper's column is marked" grep -q '<td class="number theirs">0.187</td><td class="number">1.50e-01</td>' "$T/page.html"
check "so is a paper's row" grep -q '<th scope="row" class="theirs">steps, paper</th><td class="theirs">no number</td>' "$T/page.html"
check "pictures are side by side" grep -q '<div class="row pairs">' "$T/page.html"
is "$(grep -c '<div class="row pairs">' "$T/page.html")" 1 "in one row"
is "$(awk 'length > 80' "$T/page.txt")" "" "text is 80 wide"
is "$(sed -n '/^  model/,/gone/p' "$T/page.txt")" '  model             ms, paper        ms
  ----------------  ---------  --------
  ball & bowl           0.187  1.50e-01
  longer name        12 (3.4)         -
  what <is> "gone"                    7' "a table of text is aligned"
check "what is missing is said" grep -q '^Note: There is no 10' "$T/page.txt"
# shellcheck disable=SC2016 # for sed
sed -n 's/.*srcset="data:image.svg+xml;base64,\([^"]*\)".*/\1/p' "$T/page.html" | base64 -d >"$T/dark.svg"
check "plots are light on dark" sh -c "grep -q '#e3e7ec' '$T/dark.svg' && ! grep -q black '$T/dark.svg'"
printf 'title\tA\nsay\tx\nchapter\tc\tC\ntable\tnone.tsv\tT\n' >"$T/bad"
fails 1 "a table that is not there" 'none.tsv: no table' set_page html "$T/bad"
printf 'title\tA\nchapter\tc\tC\npicture\tnone.png\tT\tt\n' >"$T/bad"
fails 1 "a picture that is not there" 'none.png: no such picture' set_page html "$T/bad"
printf 'title\tA\nsong\tx\n' >"$T/bad"
fails 1 "a word that is none" "'song' is no word" set_page txt "$T/bad"

# Two sections, without real data and without the programs that measure.
check "two sections" env SINEW_SHARED="$T/none" BENCH="$T/none" samples/paper "$T/out" wm-models wm-table-1
is "$(python3 tests/cli/paper_page.py "$T/out/paper.html" "$T/out/paper.txt" 2>&1)" "" "a page, and the same numbers in its text"
check "it says that there is no real data" grep -q '^Note: There is no real data' "$T/out/paper.txt"
check "and that nothing was measured" grep -q '^Note: Times are not here: there is no bench_tled' "$T/out/paper.txt"
is "$(awk '$1 == "sphere" && $2 == 2176 { print $3, $4, $5; exit }' "$T/out/paper.txt")" "2176 2849 2849" "the ball has the paper's elements and nodes"
is "$(awk '$1 == "nodes" && $2 == 2849 { print $3, $4, ($5 > 10000); exit }' "$T/out/paper.txt")" "480 6724 1" "Table 1 has ours below theirs"
is "$(grep -c '<img' "$T/out/paper.html")" 10 "ten pictures"
machine=$(tests/bench/machine | sed -n '2s/^# \([^,]*\),.*/\1/p')
check "the machine is named" grep -qF "$machine" "$T/out/paper.html"
if grep -q 'No card ran here' "$T/out/paper.html"; then
    check "where a card's figures are is said" grep -q 'on another day is in tests/bench/nvidia-h200-table1.csv' "$T/out/paper.html"
else
    skip 1 "a card ran here"
fi

# What is computed from measured times: here, of a thread that takes half of the paper's time for nodes as many as theirs.
{
    echo 'mesh,nodes,tetrahedra,springs,method,threads,frames,best_ms,median_ms,p95_ms,paper_ms,opentissue_ms'
    for size in 20x10x10,2000,10,30 24x12x12,3456,17,60 28x14x14,5488,27,100 32x16x16,8192,40,150; do
        echo $size | awk -F, '{ for (i = 3; i <= 4; i++) print $1 "," $2 ",9,9," (i == 3 ? "msds" : "fem 20 cg") ",2,9,9," $i / 2 ",9,9,"
            print $1 "," $2 ",9,9,collision,2,9,9,0.05,9,9,"; print $1 "," $2 ",9,9,fem exact,2,9,9,0.05,9,9," }'
    done
} >"$T/frames"
{
    echo 'mesh,tetrahedra,in_the_image,what,threads,images,best_ms,median_ms,p95_ms,against_bare,paper_ms'
    for size in 20x10x10 24x12x12 28x14x14 32x16x16; do
        printf '%s\n' "$size,9,9,spans,2,9,9,2,9,9,9" "$size,9,9,frame: msds and image,2,9,9,4,9,,9" "$size,9,9,frame: fem 20 cg and image,2,9,9,8,9,,9"
    done
} >"$T/images"
rows_of() {
    awk -F, -v part="$1" -f samples/paper.d/times.awk "$T/frames" "$T/images" | tr '\t' ' '
}
is "$(rows_of times | grep -A 1 '^FEM 15')" 'FEM 15 30 50 75
times as fast 2 2 2 2' "Table I: times as fast"
is "$(rows_of times | sed -n '/^volume sampling, spans/,+1p' | tail -n 1)" "times as fast 7 8 10 11.5" "and of the images"
is "$(rows_of rates | sed -n 3p)" "without visualisation 250 (125) 250 (125) 250 (125) 250 (125)" "Table II: a frame is what both take"
for size in 20x10x10 24x12x12 28x14x14 32x16x16; do
    printf '%s\n' "$size,without,msds,0,60,40,20" "$size,without,fem,0,60,30,20" "$size,with,msds,243224,60,40,8" "$size,with,fem,243224,60,7,9"
done >"$T/shown"
is "$(awk -F, -v part=rates -f samples/paper.d/times.awk "$T/images" "$T/shown" | tr '\t' ' ' | sed -n '4p; $p')" \
    "images in sinew console, without surfaces 40 (30) 40 (30) 40 (30) 40 (30)
in sinew console, with 243224 triangles 8 (7) 8 (7) 8 (7) 8 (7)" "and in the console, the rarer of images and drawings"
printf 'ball\t9\t9\t9\t-\t9\t9\t9\n' >"$T/facts"
printf 'model,vertices,real_time,frames_a_second,drawn_a_second\nsphere,9,0.9,60,31\nface,9,0.1,7,6\n' >"$T/display"
is "$(awk -F '\t' -f samples/paper.d/table1.awk "$T/facts" FS=, "$T/display" | tr '\t' ' ' | sed -n '/^frames a second, drawn/,$p')" \
    "frames a second, drawn in sinew console 31 0 0 6
seconds of the model in a second of that 0.9 0 0 0.1" "Table 1 with display"
check "half of their times grow as theirs do" sh -c "echo '$(rows_of words)' |
    grep -q 'power 0.98 for .* and 1.14 for .* here as 0.98 and 1.14. .* here it is 3.00 and 3.75 times.$'"

# A tool that fails ends it, with a word, and leaves no page.
mkdir "$T/bin"
for tool in "$SINEW_BIN"/*; do
    ln -s "$tool" "$T/bin"
done
rm "$T/bin/attach"
printf '#!/bin/sh\necho "attach: broken" >&2\nexit 3\n' >"$T/bin/attach"
chmod +x "$T/bin/attach"
fails 1 "a tool that fails, and in which section" 'paper: wm-models failed, status 1' env SINEW_SHARED="$T/none" BENCH="$T/none" SINEW_BIN="$T/bin" samples/paper "$T/failed" wm-models
check "and there is no page" test ! -e "$T/failed/paper.html"
fails 2 "a section that is none" "no section 'wm-nothing'; expected .*pst-times" samples/paper "$T/failed" wm-nothing
done_testing
