#!/bin/sh
# --batch: the bytes of separate runs, whatever fails beside, for any number of threads.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

like() {
    printf '%s\n' "$1" | grep -q -- "$2"
    is $? 0 "$3"
}

# A ball of tissue about one of bone, with a muscle.
{
    awk -v r=50 -v n=24 -v g=skin -f tests/cli/sphere.awk
    awk -v r=20 -v n=16 -v g=skull -f tests/cli/sphere.awk | awk -v from=$((2 + 23 * 48)) '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } 1'
    awk -v r=14 -v n=12 -v g=muscle_a -f tests/cli/sphere.awk |
        awk -v from=$((2 + 23 * 48 + 2 + 15 * 32)) '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } $1 == "v" { $2 += 28 } 1'
} >"$T/ball.obj"
voxelise -q --unit mm -s 8 "$T/ball.obj" 2>/dev/null | attach -q >"$T/ball"
cd "$T" || exit 1
printf '0 a 0\n' >broken.script
run="tled-run -q -d cpu -t 0.01 --every 0.005"

# ---- The same bytes
cat >jobs.txt <<'END'
# Expressions of a ball
-c a=0.1 -o one        # a comment

-c a=0.05 --ramp 0 -o 'with blank'
	-g 0,0,-9.81 -o "quoted \"b\"" --log three.tsv
-c a=0.1 -g 1,0,0 -o four\ th
END
$run -c a=0.1 <ball >apart1
$run -c a=0.05 --ramp 0 <ball >apart2
$run -g 0,0,-9.81 --log apart3.tsv <ball >apart3
$run -c a=0.1 -g 1,0,0 <ball >apart4
for threads in 1 2 5; do
    rm -f one with* quoted* four*
    $run --threads $threads --batch jobs.txt <ball >said 2>&1
    is "$? $(wc -c <said)" "0 0" "jobs on $threads threads are done, and nothing is said with -q"
    cmp -s one apart1 && cmp -s 'with blank' apart2 && cmp -s 'quoted "b"' apart3 && cmp -s 'four th' apart4
    is $? 0 "their results have the bytes of separate runs, on $threads threads"
done
cut -f 1-18 apart3.tsv >apart.log
cut -f 1-18 three.tsv | cmp -s - apart.log
is $? 0 "and a log, but for its clock"
$run --log-every 0.002 --tsv material.energy --batch jobs.txt <ball
is "$? $(wc -l <three.tsv) $(head -1 three.tsv | grep -c energy)" "0 7 1" "what the command line says of logs is of the jobs that have one"
tled-run -d cpu -t 0.01 --batch jobs.txt <ball 2>&1 | sed 's/; [0-9.e-]* s$//' | sort >said
is "$(wc -l <said) $(grep -c '^tled-run: jobs.txt:[2456]: .*: at 0.01 s, after [0-9]* steps, largest displacement [0-9.e-]* mm$' said)" "4 4" "without -q a line is said for each job"
$run -c a=0.1 -o first <ball
printf -- '-c a=0.1 -o second\n' >jobs.txt
$run --batch jobs.txt <first
$run -c a=0.1 <first >apart1
cmp -s second apart1
is $? 0 "a job goes on from the last frame that came, and passes frames on"
$run -m tissue.E=2000 --batch jobs.txt <first 2>/dev/null
$run -m tissue.E=2000 -c a=0.1 <first 2>/dev/null >apart1
cmp -s second apart1
is $? 0 "as with a material that changes, whose frames are dropped"

# ---- What fails
mkdir folder
cat >jobs.txt <<'END'
-c a=0.1 -o one
-c a=0.1
-c nose=0.4 -o two
--script none.script -o three
--script broken.script -o four
-c a=0.1 -o none/five
-c a=0.1 --device cpu -o six
-c a=0.1 -o -
-c 'a=0.1 -o eight
a=0.1 -o nine
--script - -o ten
-c a=0.1 -o folder
-c a=0.1 --log one.log -o one.log
-c a=0.1 -o last
END
rm -f one
$run --batch jobs.txt <ball >out 2>said
is "$? $(wc -c <out)" "1 0" "where jobs fail the status is 1, and standard output is empty"
cmp -s one last && [ ! -e two ] && [ ! -e three ] && [ ! -e four ] && [ ! -e six ] && [ ! -e ten ] && [ ! -e one.log ]
is $? 0 "the other jobs are done, and those leave nothing"
is "$(sed -n 's/^tled-run: jobs.txt:\([0-9]*\): .*/\1/p' said | sort -n | tr '\n' ' ')$(tail -1 said)" "2 3 4 5 6 7 8 9 10 11 12 13 tled-run: jobs.txt: 12 of 14 jobs failed" "each says its line"
for words in '2: a job without -o' "3: -c: unknown muscle 'nose'" '4: none.script: cannot open' "5: broken.script:1: " '6: none/five: cannot create' \
    '7: a job with --device' '8: -o -' '9: a quote has no end' "10: extra operand 'a=0.1'" '11: --script -' '12: folder: ' '13: -.* .one.log. would overwrite'; do
    like "$(cat said)" "jobs.txt:$words" "line $words"
done
# ---- Files of several jobs: the later line is wrong
printf '0 a 0\n' >calm.script
printf '#\n-c a=0.1 -o same\n-c a=0.05 -o new\n-c a=0.3 -o ./folder/../same --log rest.tsv\n--script new -o next\n-c a=0.2 -o rest.tsv\n--script calm.script -o read\n-c a=0.1 -o calm.script\n-t never -o other\n-c a=0.1 -o other\n-c a=0.1 -o /dev/null\n-c a=0.2 -o /dev/null\n' >jobs.txt
rm -f same new
$run --batch jobs.txt <ball 2>said
is "$? $(cat next read 2>/dev/null | wc -c) $(cat calm.script)" "1 0 0 a 0" "jobs with the files of others fail"
is "$(sed -n 's/^tled-run: jobs.txt:\([0-9]*\): .*/\1/p' said | sort -n | tr '\n' ' ')$(tail -1 said)" "4 5 7 8 9 tled-run: jobs.txt: 5 of 11 jobs failed" "they alone"
cmp -s same first && [ -e new ] && [ -e rest.tsv ] && [ -e other ]
is $? 0 "the others are done, also with a file of one that failed"
for words in "4: writes '.*/same', which the job of line 2 writes; expected another file" "5: reads '.*/new', which the job of line 3 writes"; do
    like "$(cat said)" "jobs.txt:$words" "line $words"
done
printf -- '--script calm.script -o one\n-c a=0.1 -o calm.script\n' >jobs.txt
$run --batch jobs.txt <ball 2>said
like "$? $(cat said)" "1 .*jobs.txt:2: writes '.*/calm.script', which the job of line 1 reads" "a job that writes what one before it reads"
cp ball model
ln -s model linked
mkfifo pipe
printf -- '-c a=0.1 -o linked\n-c a=0.1 -o jobs.txt\n--script calm.script -o calm.script\n--script pipe -o one\n' >jobs.txt
cp jobs.txt before
$run --batch jobs.txt <model 2>said
is "$? $(cmp model ball) $(cmp jobs.txt before)" "1  " "the model and the jobs are not written over"
for words in "1: -o 'linked' would overwrite the model on standard input; expected another file" "2: -o 'jobs.txt' would overwrite the file of --batch 'jobs.txt'" \
    "3: -o 'calm.script' would overwrite the file of --script 'calm.script'" "4: --script 'pipe' is a pipe; expected a file"; do
    like "$(cat said)" "jobs.txt:$words" "line $words"
done

# ---- How a run ends: a line's way stands for that of the command line
printf -- '-c a=0.1 -o steps -n 3\n-c a=0.1 -o time -t 0.01\n-c a=0.1 -o both -n 3 -t 1\n--rest 0.1 -g 1,0,0 -o rest\n-c a=0.1 -o asked\n' >jobs.txt
tled-run -q -d cpu -t 0.02 --batch jobs.txt <ball 2>said
is "$? $(cat said)" "1 tled-run: jobs.txt:3: -t, -n and --rest are three ways to end; expected one of them
tled-run: jobs.txt: 1 of 5 jobs failed" "two ways to end in one line are refused"
tled-run -q -d cpu -c a=0.1 -n 3 <ball >apart1
tled-run -q -d cpu -c a=0.1 -t 0.01 <ball >apart2
tled-run -q -d cpu --rest 0.1 -g 1,0,0 <ball >apart3
tled-run -q -d cpu -c a=0.1 -t 0.02 <ball >apart4
cmp -s steps apart1 && cmp -s 'time' apart2 && cmp -s rest apart3 && cmp -s asked apart4
is $? 0 "-n, -t and --rest of a line stand for -t of the command line"
for empty in '' '# nothing

'; do
    printf '%s' "$empty" >jobs.txt
    $run --batch jobs.txt <ball 2>said
    is "$? $(cat said)" "1 tled-run: jobs.txt: no job; expected lines of options, each with -o FILE" "a file without jobs"
done
printf -- '-c a=0.1 -o one --live\n-c a=0.1 -o one -m tissue.E=1\n-c a=0.1 -o one --batch jobs.txt\n' >jobs.txt
$run --batch jobs.txt <ball 2>said
is "$(cat said)" "tled-run: jobs.txt:1: a job with --live; expected a run without --batch for that
tled-run: jobs.txt:2: a job with --material; expected it on the command line, for all jobs
tled-run: jobs.txt:3: a job with --batch; expected it on the command line, for all jobs
tled-run: jobs.txt: 3 of 3 jobs failed" "options that no job has, with the reason"
# What tears the tissue, where steps are fixed.
printf -- '-c a=0.1 -o calm\n-g 0,0,-1e9 --ramp 0 -o torn\n' >jobs.txt
rm -f torn
$run --dt 1e-4 --batch jobs.txt <ball 2>said
is "$? $(ls calm) $(ls torn 2>/dev/null)" "1 calm " "a job that diverges fails alone"
like "$(cat said)" "jobs.txt:2: .*" "and says so"
for option in '-o x' --live '--checkpoint x' '--restart x' '--record x' '--control x' '--replay x' '--rate 5' '--log x' --force '--checkpoint-every 1'; do
    # shellcheck disable=SC2086 # words
    tled-run -q $option --batch jobs.txt <ball >out 2>said
    is "$? $(grep -c -- "${option%% *} with --batch; expected" said)" "2 1" "$option with --batch is refused"
done

# ---- Memory goes by the jobs at once, not by all
awk 'BEGIN { for (i = 0; i < 300; i++) printf "-c a=%g -n 1 -o many/%d\n", i / 300, i }' >jobs.txt
head -2 jobs.txt >few
mkdir many
peak() {
    tled-run -q -d cpu --threads 2 --batch "$1" <ball 2>said &
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
