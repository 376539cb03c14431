# W&M's Table 1 in its own shape, a column a model: facts of the models (tabs: name, nodes, elements, mm, contraction, stable and taken
# step in ms, mm moved), then the CSV of bench_tled, then that of bench_console.py, in a file `display`.

BEGIN {
    models = split("sphere muscle block face", name, " ")
    split("2849 480 6724 15516", printed_nodes, " ")
    split("2176 280 4800 12267", printed_elements, " ")
    split("12.5 1.5 1.5 2.5", printed_mm, " ")
    split("- 0.25 0.6 0.4", printed_contraction, " ")
    split("0.187 0.205 0.342 0.542", printed_ms, " ")
    split("34 38 15 7", printed_fps, " ")
}

FILENAME ~ /facts$/ {
    facts++
    for (i = 2; i <= 8; i++)
        fact[facts, i] = $i
    next
}

FILENAME ~ /display$/ {
    real[$1] = $3
    shown[$1] = $5
    displays += FNR == 2
    next
}

/^model,/ {
    for (i = 1; i <= NF; i++)
        at[$i] = i
    next
}

$at["what"] == "step" {
    of = $1
    sub(/.*\//, "", of)
    sub(/[.]model$/, "", of)
    way = $at["device"] == "cuda" ? "card" : $at["threads"] ($at["threads"] == 1 ? " thread" : " threads")
    way = way ", " $at["precision"]
    if (!(way in seen))
        ways[++count] = way
    seen[way] = 1
    took[way, of] = $at["median_us_a_step"] / 1000
}

function line(head, of, factor,    i)
{
    printf "%s", head
    for (i = 1; i <= models; i++)
        printf "\t%s", of[i]
    print ""
}

function ours(head, field,    i)
{
    printf "%s", head
    for (i = 1; i <= models; i++)
        printf (field > 5 ? "\t%.3g" : "\t%s"), fact[i, field]
    print ""
}

function by_name(head, of,    i)
{
    printf "%s", head
    for (i = 1; i <= models; i++)
        printf "\t%.3g", of[name[i]]
    print ""
}

END {
    print "detail\tsphere\tmuscle\tblock\tface"
    line("nodes, paper", printed_nodes)
    ours("nodes", 2)
    line("elements, paper", printed_elements)
    ours("elements", 3)
    line("element length, mm, paper", printed_mm)
    ours("element length, mm", 4)
    line("muscle contraction, paper", printed_contraction)
    ours("muscle contraction", 5)
    ours("stable step at rest, ms", 6)
    ours("step taken, ms", 7)
    ours("largest displacement after 0.2 s, mm", 8)
    line("a step takes, ms, paper", printed_ms)
    for (w = 1; w <= count; w++) {
        printf "a step takes, ms, %s", ways[w]
        for (i = 1; i <= models; i++)
            printf "\t%.3g", took[ways[w], name[i]]
        print ""
    }
    for (w = 1; w <= count; w++) {
        printf "times as fast as theirs, %s", ways[w]
        for (i = 1; i <= models; i++)
            printf "\t%.3g", printed_ms[i] / took[ways[w], name[i]]
        print ""
    }
    line("frames a second, paper", printed_fps)
    if (displays) {
        by_name("frames a second, drawn in sinew console", shown)
        by_name("seconds of the model in a second of that", real)
    }
    if (!count)
        exit
    printf "steps that a frame held at most, of the paper's own figures"
    for (i = 1; i <= models; i++)
        printf "\t%.0f", 1000 / printed_fps[i] / printed_ms[i]
    print ""
    for (w = 1; w <= count; w++) {
        printf "frames of so many steps a second, %s", ways[w]
        for (i = 1; i <= models; i++)
            printf "\t%.0f", printed_fps[i] * printed_ms[i] / took[ways[w], name[i]]
        print ""
    }
}
