#!/bin/sh
# shellcheck disable=SC2016 # texts for inner shells
# --salvage: the whole frames of a stream that was cut, as by a run that was killed and wrote by the shell's `>`. The output is whole, one line
# says how much was taken and where reading stopped, and the status is 1.
. "$(dirname "$0")/lib.sh"
. "$ROOT/tests/cli/boxes.sh"

cd "$T" || exit 1
box skin 2 2 2 18 13 13 >skin.obj
voxelise -q --unit mm -s 4 skin.obj 2>err | sinew bind -q skin.obj >bound
run() {
    tled-run -q -d cpu -g 0,0,-9.81 --ramp 0 --every 2e-3 "$@" <bound 2>err
}
run -n 40 >film
run -n 40 --text >film.text
size=$(wc -c <film)
count=$(sinew info --get frames.count film 2>err || sinew info --tsv node.displacement.max film | tail -n +2 | wc -l)
is "$((count))" 5 "a run of five frames"

head -c "$((size - 6000))" film >part
awk '{ if (/^frame 3 /) in3 = 1; if (in3 && ++n > 20) exit; print }' film.text >cut.text
sinew export -f model film -z -o film.gz
head -c "$(($(wc -c <film.gz) - 100))" film.gz >cut.gz
rows() { # ARG...
    sinew info --tsv node.displacement.max --tsv node.velocity.max "$@"
}
rows film >all.rows

# first: that what it wrote is the beginning of the rows of all.
first() {
    cp stdout got
    check "the rows before that" sh -c '[ "$(wc -l <got)" -gt 1 ] && head -n "$(wc -l <got)" all.rows | cmp - got'
}

# salvaged NAME FRAMES FILE COMMAND...: what it says of that file.
salvaged() {
    name=$1 frames=$2 file=$3
    shift 3
    fails 1 "$name" "^sinew-[a-z]*: $file: salvaged $frames frames?, up to index $((frames - 1)) at [0-9.]* s; reading stopped at byte [0-9]*( of what gunzip gives)?: " "$@"
    is "$(wc -l <stderr | tr -d ' ')" 1 "$name: one line"
}

salvaged "info" 3 part rows --salvage part
first
salvaged "of text" 3 cut.text rows --salvage cut.text
first
fails 1 "of gzip" "cut.gz: salvaged [1-4] frames.*; reading stopped at byte [0-9]* of what gunzip gives: gzip data is cut short" rows --salvage cut.gz
first
second=$(grep -abo '^frame 1 ' film.text | cut -d: -f1)
head -c "$second" film.text >edge
salvaged "of the first frame alone" 1 edge rows --salvage edge
cp stderr told
first
check "and that it may have had more" grep -q '(the first frame has [0-9]* arrays before that, and may have had more)$' told
head -c "$((second + 3))" film.text >within
salvaged "some bytes into the second" 1 within rows --salvage within
first
fails 1 "which is offered" "cut short; .*; --salvage takes the 1 frame before that$" sinew info within
is "$(sinew info --salvage film 2>&1 | cmp - /dev/stdin 2>&1 <<X
$(sinew info film)
X
)" "" "a whole one is as without it"
for tool in "info part" "info --json part" "deform skin.obj" "export -f vtu part" "export -f model part" "render --size 20x20 part"; do
    # shellcheck disable=SC2086 # words
    fails 1 "sinew $tool without it" "the model is cut short; .*; --salvage takes the 3 frames before that$" sinew $tool -o none <part
done
is "$(ls none 2>/dev/null)" "" "leaves nothing"

salvaged "deform" 3 stdin sinew deform --salvage -o s.obj skin.obj <part
sinew deform --frame 2 -o want.obj skin.obj <film
check "the last that is whole" cmp want.obj s.obj
salvaged "a file a frame" 3 stdin sinew deform --salvage --frame all -o s_%d.obj skin.obj <part
is "$(ls s_*)" "s_0.obj
s_1.obj
s_2.obj" "three files"
check "the last of them" cmp want.obj s_2.obj
sinew deform --format pc2 -o film.pc2 skin.obj <film
salvaged "a point cache" 3 stdin sinew deform --salvage --format pc2 -o cut.pc2 skin.obj <part
is "$(od -A n -t d4 -j 28 -N 4 cut.pc2 | tr -d ' ') $(wc -c <cut.pc2 | tr -d ' ')" "3 $((32 + 3 * 8 * 12))" "three samples, in its head too"
check "which are the first" sh -c 'tail -c +33 cut.pc2 >a; tail -c +33 film.pc2 | head -c "$(wc -c <a)" | cmp - a'
fails 1 "a frame past the cut" "frame 4: no such frame; .* of the 3 there.*; reading stopped at byte" sinew deform --salvage --frame 4 -o none skin.obj <part
is "$(ls none 2>/dev/null)" "" "gives none"

salvaged "export to a model" 3 part sinew export -f model --salvage -o whole part
check "which is whole" rows whole
first
is "$(sinew info whole | grep -c 'sinew-export .* --salvage')" 1 "and says what it comes of"
salvaged "as text, in a pipe" 3 stdin sh -c 'sinew export -f model --salvage --text <part >pipe'
check "which is whole too" sinew diff whole pipe
salvaged "export of a series" 3 part sinew export -f vtu --salvage --frame all -o f.pvd part
is "$(grep -c DataSet f.pvd) $(find . -name 'f_*.vtu' | wc -l | tr -d ' ')" "3 3" "three in the collection, and three files"
salvaged "export" 3 part sinew export -f obj --surface skin --deformed --salvage -o s.obj part
sinew export -f obj --surface skin --deformed --frame 2 -o want.obj film
check "the last that is whole" cmp want.obj s.obj
salvaged "render" 3 part sinew render --salvage --size 64x48 -o s.png part
sinew render --frame 2 --size 64x48 -o want.png film
check "the last that is whole" cmp want.png s.png
salvaged "a film" 3 part sinew render --salvage --size 20x20 --frame all -o p_%d.png part
is "$(find . -name 'p_*' | wc -l | tr -d ' ')" 3 "three pictures"

# What is left in front of a frame, what is damaged, what failed.
fails 1 "a body that is cut" "cut short.*; nothing can be salvaged before the first frame$" sh -c 'head -c 3000 film | sinew export -f model --salvage -o none'
is "$(ls none 2>/dev/null)" "" "gives nothing"
at=$((size - 4000)) # in the fifth frame, or the fourth: one of them is damaged, not part
{ head -c "$at" film; printf 'x'; tail -c +"$((at + 2))" film; } >damaged
fails 1 "damage" "damaged: salvaged [34] frames.*: block [0-9]* \((FRAM|ARRY node.[a-z]*)\): .*damaged" rows --salvage damaged
first
{ grep -v '^end$' film.text; printf 'fail 3 "tled-run: diverged"\n'; } >failed
fails 3 "a run that failed" "failed: the run that wrote it failed: tled-run: diverged; --salvage takes the 5 frames before that" sinew info failed
salvaged "its frames" 5 failed rows --salvage failed
first
fails 3 "in a pipe it was said" '^$' sh -c 'sinew deform skin.obj <failed; s=$?; echo >&2; exit $s'
salvaged "and is salvaged there too" 5 stdin sinew deform --salvage -o s.obj skin.obj <failed
size=$(wc -c <film.gz)
{ head -c "$((size - 60))" film.gz; head -c 60 /dev/zero; } >damaged.gz
fails 1 "damaged gzip" "damaged.gz: salvaged [1-5] frames.*gzip data is damaged" rows --salvage damaged.gz
first
fails 1 "no model" "is not a sinew model" sinew info --salvage skin.obj

# A run that is killed.
mkfifo pipe2
tled-run -q -d cpu -g 0,0,-9.81 --ramp 0 -t 1000 --every 1e-3 <bound >pipe2 2>err &
pid=$!
head -c 100000 pipe2 >killed
kill -9 "$pid" 2>/dev/null
wait "$pid" 2>/dev/null
fails 1 "a run that was killed" "killed: salvaged [0-9]* frames, up to index" sinew info --salvage --get node.displacement.max killed
done_testing
