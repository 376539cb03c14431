# shellcheck shell=sh disable=SC2034,SC2154 # variables of samples/paper, which reads this
# What the sections of samples/paper share. They are read into it, so that whatever fails there ends it ($out, $work, $page, $bench and
# $data are its own). A command in an argument would fail unnoticed: its output goes to a variable first.

tab=$(printf '\t')

# The page: a line each, a word and what it is about, between tabs; page.awk sets it. TEXT is plain ASCII, in a line of its own or several.
line() {
    word=$1
    shift
    printf '%s' "$word" >>"$page"
    for part; do
        printf '\t%s' "$part" | tr '\n' ' ' >>"$page"
    done
    echo >>"$page"
}
title() { line title "$1"; }          # TEXT
chapter() { line chapter "$1" "$2"; } # ID TEXT
heading() { line heading "$1" "$2"; } # ID TEXT
say() { line say "$1"; }              # TEXT
note() { line note "$1"; }            # TEXT: a remark below a table
missing() { line missing "$1"; }      # TEXT: what is not here, and why
# FILE.tsv CAPTION: its first line are its heads; what the papers printed has `paper` in its head, or in its row's first cell.
table() { line table "$1" "$2"; }
# FILE.png|svg CAPTION ALT: side by side where they follow each other.
picture() { line picture "$1" "$2" "$3"; }

# row CELL...: a line of a table.
row() {
    printf '%s' "$1"
    shift
    for part; do
        printf '\t%s' "$part"
    done
    echo
}

# draw PICTURE.png MODEL OPTIONS...: of sinew render; and draw_square, since a legend's letters grow with the height.
draw() {
    drawn=640x480
    draw_sized "$@"
}
draw_square() {
    drawn=600x600
    draw_sized "$@"
}
draw_sized() {
    file=$1 model=$2
    shift 2
    sinew render --size "$drawn" "$@" -o "$out/$file" "$model"
}

# plot PICTURE.svg HEIGHT SCRIPT VARIABLES: of gnuplot, 480 wide; false where there is none, which the page then
# says. (In a condition `set -e` is off: so it exits where gnuplot fails, as measured does.)
plot() {
    if ! command -v gnuplot >/dev/null 2>&1; then
        missing "A plot is not here: there is no gnuplot on this machine."
        return 1
    fi
    gnuplot -e "picture = '$out/$1'; height = $2; $4" "$parts/svg.gnuplot" "$3" || exit 1
}

# calculate EXPRESSION: a number, of awk, to three digits.
calculate() {
    awk "BEGIN { x = $1; k = 1; while (x >= 1000 * k) k *= 10; if (k > 1) printf \"%.0f\", k * int(x / k + .5); else printf \"%.3g\", x }"
}

# now: seconds, with a fraction.
now() {
    date +%s.%N
}

# get MODEL KEY
get() {
    sinew info --get "$2" "$1"
}

# measured PROGRAM ARGUMENTS...: runs one of tests/bench; false where it was not built, which the page then says.
measured() {
    program=$1
    shift
    if [ ! -x "$bench/$program" ]; then
        missing "Times are not here: there is no $program in $bench; 'make paper' builds it."
        return 1
    fi
    "$bench/$program" "$@" || exit 1
}

# in_console PART...: what tests/browser/bench_console.py measures in a browser; false where there is none, which the page then says, or where
# nothing else is measured either, which it says already.
in_console() {
    [ -d "$bench" ] || return 1
    if ! command -v chromium >/dev/null || ! command -v chromedriver >/dev/null || ! /usr/bin/python3 -c 'import selenium' 2>/dev/null; then
        missing "What sinew console shows a second is not here: there is no chromium on this machine that selenium drives."
        return 1
    fi
    SECONDS=4 /usr/bin/python3 tests/browser/bench_console.py "$@" || exit 1
}

has_card='' no_card=''

# card: whether a CUDA card works; $no_card says why not.
card() {
    if [ -z "$has_card" ]; then
        models
        has_card=yes
        tled-run -d cuda -n 1 -o /dev/null <"$work/models/sphere.model" 2>"$work/card" || {
            has_card=no
            no_card=$(sed -n '$s/^tled-run: //p' "$work/card")
        }
    fi
    [ "$has_card" = yes ]
}

# say_no_card FILE.csv: a figure that this run did not make is not on the page; where it can be found is.
say_no_card() {
    say "No card ran here: $no_card. What a card printed on another day is in tests/bench/$1."
}

# models: W&M's four, once, as samples/Makefile makes them, in $work/models. The face is the left half of the real one where that is there
# (about as many elements as theirs), else our own head's part about its left muscle. $up, $side, $half, $contract, $face and $face_words go
# with it: axis, where it is seen from, its plane of symmetry, the muscle, its surfaces and what to call it.
models() {
    [ ! -d "$work/models" ] || return 0
    folder=$work/models
    mkdir "$folder"
    samples_make "$folder" "$folder/sphere.model" "$folder/muscle.model" "$folder/block.model"
    if [ -r "$data/face/face_zyg.obj" ]; then
        face=$data/face/face_zyg.obj box=-200,-200,-200,0,200,200 up=z side=-0.7,1,0.1 contract=zyg_xneg
        face_words="the real face of ArtiSynth's reference model, its left half"
    else
        samples_make "$folder" "$folder/head.obj"
        face=$folder/head.obj box=-15,-82,-30,85,40,111 up=y side=0.7,0.1,1 contract=zyg_left
        face_words="the part of our own head about its left muscle"
    fi
    quietly face_model
}
face_model() {
    voxelise -q --unit mm -s 2.5 --box="$box" "$face" | attach -q --fibre centre -o "$folder/face.model"
}

# samples_make FOLDER TARGET...
samples_make() {
    folder=$1
    shift
    quietly env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -s -C samples OUT="$folder" "$@"
}

# went FILE: how far its poses (TUM lines) are from the first at most, mm.
went() {
    awk 'NR == 1 { x = $2; y = $3; z = $4 } { d = sqrt(($2 - x) ^ 2 + ($3 - y) ^ 2 + ($4 - z) ^ 2); if (d > most) most = d }
        END { printf "%.3g", 1000 * most }' "$1"
}

# scanned: samples/scan, once, in $work/scan, with the real fetal head where that is ($head is its folder, else empty).
scanned() {
    [ ! -d "$work/scan" ] || return 0
    head=
    [ ! -d "$data/ultrasound/fetal-head" ] || head=$data/ultrasound/fetal-head
    IMAGES=24 LUMEN=solid quietly samples/scan "$work/scan" ${head:+"$head"}
}

# heard COMMAND...: what it says on standard error is in $work/said, and is seen where it fails.
heard() {
    "$@" 2>"$work/said" || {
        cat "$work/said" >&2
        return 1
    }
}

# quietly COMMAND...: what it says is only seen where it fails.
quietly() {
    "$@" >"$work/said" 2>&1 || {
        cat "$work/said" >&2
        return 1
    }
}
