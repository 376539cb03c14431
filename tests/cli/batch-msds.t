#!/bin/sh
# --batch of msds-run: the bytes of separate runs, whatever fails beside, for any number of threads.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

like() {
    printf '%s\n' "$1" | grep -q -- "$2"
    is $? 0 "$3"
}

cd "$T" || exit 1
msds-mesh -q --nodes 7x7x5 --size 8cm,8cm,6cm --young 10000 --poisson 0.4 --density 1000 >block
# press FROM N: poses, each half a millimetre deeper.
press() {
    awk -v from="$1" -v n="$2" 'BEGIN { for (i = 0; i < n; i++) printf "%g .04 .04 %.4f 1 0 0 0\n", i / 60, from - .0005 * i }'
}
press .06 4 >a.tum
press .06 3 >'b c.tum'
{
    press .06 2
    echo 'method fem'
    echo 'set gravity 0,0,-9.81'
    awk 'BEGIN { print "1 .04 .04 .059 1 0 0 0" }'
} >lines.tum
awk 'BEGIN { n = 9; for (i = 0; i < n * n; i++) printf "v %g %g .0605\n", i % n * .01, int(i / n) * .01
             for (y = 1; y < n; y++) for (x = 1; x < n; x++) printf "f %d %d %d %d\n", n * (y - 1) + x, n * (y - 1) + x + 1, n * y + x + 1, n * y + x }' >skin.obj
awk -v r=.02 -v n=8 -v g=tip -f "$OLDPWD/tests/cli/sphere.awk" | awk '$1 == "v" { $4 -= .02 } 1' >tip.obj
run="msds-run -q -d cpu --unit m --probe sphere:2cm"

# ---- The same bytes
cat >jobs.txt <<'END'
# Presses of a block
--poses a.tum -o one        # a comment

--poses 'b c.tum' --probe linear:4cm,4cm --method exact -o 'with blank'
	--poses lines.tum -g 0,0,-1 -o "quoted \"b\""
--poses a.tum --method msds --skin skin.obj --iterations 10 -o four\ th
--poses a.tum --probe convex:tip.obj --method warp --contact penalty -o five
END
$run --poses a.tum <block >apart1
$run --poses 'b c.tum' --probe linear:4cm,4cm --method exact <block >apart2
$run --poses lines.tum -g 0,0,-1 <block >apart3
$run --poses a.tum --method msds --skin skin.obj --iterations 10 <block >apart4
$run --poses a.tum --probe convex:tip.obj --method warp --contact penalty <block >apart5
is "$(cat apart? | wc -c | awk '{ print ($1 > 10000) }')" 1 "there is something to compare"
for threads in 1 2 5; do
    rm -f one with* quoted* four* five
    $run --threads $threads --batch jobs.txt <block >said 2>&1
    is "$? $(wc -c <said)" "0 0" "jobs on $threads threads are done, and nothing is said with -q"
    cmp -s one apart1 && cmp -s 'with blank' apart2 && cmp -s 'quoted "b"' apart3 && cmp -s 'four th' apart4 && cmp -s five apart5
    is $? 0 "their results have the bytes of separate runs, on $threads threads"
done
rm -f one five
SINEW_THREADS=3 $run --batch jobs.txt <block
cmp -s one apart1
is $? 0 "likewise where SINEW_THREADS says how many"
msds-run -d cpu --unit m --probe sphere:2cm --batch jobs.txt <block 2>&1 | sort >said
is "$(wc -l <said) $(grep -c '^msds-run: jobs.txt:[24567]: .*: [34] poses, to [0-9.]* s: largest displacement [0-9.]* mm, at .*N, from .*; [0-9.e-]* s$' said)" "5 5" "without -q a line is said for each job"
printf -- '-o second\n' >jobs.txt
$run --poses a.tum -o first <block
$run --poses 'b c.tum' --batch jobs.txt <first
$run --poses 'b c.tum' <first >apart1
cmp -s second apart1
is "$? $(sinew info --get frames second)" "0 7" "a job goes on from the last frame that came, and passes frames on"
printf -- '-o same --skin skin.obj --poses a.tum\n' >jobs.txt
$run --skin skin.obj --poses a.tum --method fem <block >first
$run --batch jobs.txt <first
$run --skin skin.obj --poses a.tum <first >apart1
cmp -s same apart1
is $? 0 "with a skin that the model has already"

# ---- What fails
mkdir folder
mkfifo pipe
printf '0 0 0\n' >broken.tum
cat >jobs.txt <<'END'
--poses a.tum -o one
--poses a.tum
--probe cone:2cm --poses a.tum -o two
--poses none.tum -o three
--poses broken.tum -o four
--poses a.tum -o none/five
-o six
--poses a.tum -o -
--poses 'a.tum -o eight
a.tum -o nine
--poses - -o ten
--poses a.tum -o folder
--poses pipe -o eleven
--poses spnav: -o twelve
--poses a.tum -o a.tum
--poses a.tum -o one
--poses a.tum --friction 1 --method msds -o thirteen
--poses a.tum --device cpu -o fourteen
--poses a.tum --live -o fifteen
--poses a.tum --compare -o sixteen
--poses a.tum --iterations 0 -o seventeen
--poses a.tum -o jobs.txt
--poses a.tum -o block
--poses a.tum -o last
END
cp a.tum before
cp block model
rm -f one five
$run --batch jobs.txt <block >out 2>said
is "$? $(wc -c <out)" "1 0" "where jobs fail the status is 1, and standard output is empty"
cmp -s one last && cmp -s a.tum before && cmp -s block model
is "$? $(cat two three four five six eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen 2>/dev/null | wc -c)" "0 0" "the other jobs are done, and those leave nothing and write over nothing"
is "$(sed -n 's/^msds-run: jobs.txt:\([0-9]*\): .*/\1/p' said | sort -n | tr '\n' ' ')$(tail -1 said)" \
    "$(seq 2 23 | tr '\n' ' ')msds-run: jobs.txt: 22 of 24 jobs failed" "each says its line"
for words in '2: a job without -o' "3: --probe cone:2cm; expected sphere:RADIUS" '4: none.tum: cannot open' '5: broken.tum:1: ' '6: none/five: cannot create' \
    '7: missing option --poses' '8: -o -; expected the name of a file' '9: a quote has no end' "10: extra operand 'a.tum'" '11: --poses -; expected the name of a file' '12: folder: ' \
    "13: --poses 'pipe' is a pipe; expected a file" '14: --poses spnav: in a job; expected a file of poses' "15: -o 'a.tum' would overwrite the file of --poses" \
    "16: writes '.*/one', which the job of line 1 writes; expected another file" '17: --friction 1 with the method msds' '18: a job with --device; expected it on the command line, for all jobs' \
    '19: a job with --live; expected a run without --batch' '20: a job with --compare; expected a run without --batch' "21: --iterations '0': expected" "22: -o 'jobs.txt' would overwrite the file of --batch" \
    "23: -o 'block' would overwrite the model on standard input"; do
    like "$(cat said)" "jobs.txt:$words" "line $words"
done
for option in '-o x' --live '--record x' '--control x' '--replay x' --force '--haptics x' --compare --residual; do
    # shellcheck disable=SC2086 # words
    msds-run -q $option --batch jobs.txt <block >out 2>said
    is "$? $(grep -c -- "${option%% *} with --batch; expected" said)" "2 1" "$option with --batch is refused"
done
$run --batch - <block >out 2>said
like "$? $(cat said)" "2 .*--batch -: standard input has the model" "jobs on standard input too"
# What springs cannot bear, whose steps are fixed.
printf -- '--poses a.tum -o calm\n--poses a.tum --method msds --mass lumped --dt 1 -o torn\n' >jobs.txt
$run --batch jobs.txt <block 2>said
is "$? $(ls calm torn 2>/dev/null) $(tail -1 said)" "1 calm msds-run: jobs.txt: 1 of 2 jobs failed" "a job that cannot be computed fails alone"
printf -- '--poses a.tum -o cut1\n' >jobs.txt
head -c 2000 block | $run --batch jobs.txt 2>said
is "$? $(wc -l <said) $(ls cut1 2>/dev/null)" "1 1 " "a model that is cut short: one line, and no job"

# ---- Memory goes by the jobs at once, not by all
mkdir many
awk 'BEGIN { for (i = 0; i < 300; i++) printf "-g 0,0,%g -o many/%d\n", -i / 30, i }' >jobs.txt
head -2 jobs.txt >few
head -1 a.tum >once.tum
peak() {
    msds-run -q -d cpu --threads 2 --method fem --poses once.tum --batch "$1" <block 2>said &
    pid=$!
    most=0
    while now=$(awk '/VmHWM/ { print $2 }' /proc/$pid/status 2>/dev/null) && [ -n "$now" ]; do most=$now; done
    wait $pid
}
if [ -z "$SINEW_SANITIZED" ]; then
    peak few
    few=$most
    peak jobs.txt
    is "$(find many -type f | wc -l)" 300 "300 jobs are done"
    [ "$most" -lt $((few + 20000)) ]
    is $? 0 "300 jobs take not much more memory than two ($most and $few KiB)"
fi
done_testing
