#!/bin/sh
# README.md as its reader types it: the commands of each block marked sh, in order, in one shell, in a folder that holds what a clone does
# (samples/, and the tools in bin/). bash runs them on coarser meshes. With SINEW_LONG it runs them as they stand, so
# that what they print and draw is compared (tests/golden tells of each change of results before), and sh runs them on coarser meshes. A block that is one `make TARGET` takes minutes: here it must be a target. Checked too: the files that the commands name, the lines of the blocks
# marked text, and that figures, make targets, pages and files that the text names are what they are called.
. "$(dirname "$0")/lib.sh"

have make || skip_all "no make"
have bash || skip_all "no bash"

mkdir "$T/blocks"
awk -v to="$T/blocks" '
    /^```/ { on = !on; if (on) { n++; kind = substr($0, 4) } next }
    on { print >sprintf("%s/%02d.%s", to, n, kind) }' README.md
check "there are blocks of commands" test "$(find "$T/blocks" -name '*.sh' | wc -l)" -ge 7
is "$(find "$T/blocks" -type f ! -name '*.sh' ! -name '*.text')" "" "each block is marked sh or text"

# The rules of make, by name.
env -u MAKEFLAGS -u MAKELEVEL make -pRrq : 2>/dev/null | sed -n 's/^\([a-z][a-z0-9-]*\):.*/\1/p' | sort -u >"$T/targets"
# is_target NAME
is_target() {
    grep -qx -e "$1" "$T/targets"
}

# clone FOLDER
clone() {
    mkdir "$1" && cp -R samples "$1/samples" && ln -s "$SINEW_BIN" "$1/bin"
}

# typed FOLDER SED: a script of all blocks, each edited by SED, what each says in FOLDER/said-NN.
typed() {
    printf 'cd "%s"\n' "$1"
    for block in "$T/blocks"/*.sh; do
        number=$(basename "$block" .sh)
        if [ "$(wc -l <"$block")" -eq 1 ] && grep -qx 'make [a-z-]*' "$block"; then
            continue
        fi
        if grep -q ffmpeg "$block" && ! have ffmpeg; then
            continue
        fi
        printf '{\n'
        sed "$2" "$block"
        printf '} >"%s/said-%s" 2>&1\n' "$1" "$number"
    done
}
for block in "$T/blocks"/*.sh; do
    if [ "$(wc -l <"$block")" -eq 1 ] && grep -qx 'make [a-z-]*' "$block"; then
        check "a target: $(cat "$block")" is_target "$(sed 's/make //' "$block")"
    fi
done

# run_typed FOLDER SHELL...: the script of FOLDER, by that shell; where it stops, what the last block said.
# shellcheck disable=SC2317 # called by name
run_typed() {
    typed_in=$1
    shift
    if ! env -u MAKEFLAGS -u MAKELEVEL "$@" "$typed_in.script"; then
        tail -n 5 "$(find "$typed_in" -name 'said-*' | sort | tail -n 1)"
        return 1
    fi
}
coarser='s/-s 2\.5 --fraction 4/-s 6/; s/-t 0\.2/-t 0.04/; s/--nodes 32x10x24/--nodes 13x5x11/; s/seconds=2/seconds=0.5/; s/--size 1200x400/--size 400x150/'
clone "$T/bash"
# (With sanitizers coarser too: what is printed is no test of memory.)
coarse=
[ -n "${SINEW_LONG:-}" ] || coarse="SINEW_LONG is not set: figures of coarser meshes"
[ -z "${SINEW_SANITIZED:-}" ] || coarse="coarser with sanitizers"
typed "$T/bash" "${coarse:+$coarser}" >"$T/bash.script"
# -H and -o history: a '!' means what it does to one who types.
check "all commands, typed in bash" run_typed "$T/bash" bash -e -H -o history
other=$T/bash
if [ -n "${SINEW_LONG:-}" ]; then
    other=$T/sh
    clone "$T/sh"
    typed "$T/sh" "$coarser" >"$T/sh.script"
    check "and in sh" run_typed "$T/sh" sh -e
else
    skip 1 "SINEW_LONG is not set: the same in sh"
fi

# Files that commands write, behind > or -o: each is there and not empty.
cat "$T/blocks"/*.sh | grep -oE "(>| -o) *'?[A-Za-z][A-Za-z0-9_.%/]*" | sed "s/^\(>\| -o\) *'*//; s/%04d/0000/" | sort -u >"$T/files"
have ffmpeg || skip 1 "no ffmpeg: no arm.mp4"
while read -r file; do
    [ "$file" != arm.mp4 ] || have ffmpeg || continue
    check "$file" test -s "$T/bash/out/$file" -a -s "$other/out/$file"
done <"$T/files"
check "files are named" test "$(wc -l <"$T/files")" -ge 20
is "$(cd "$T/bash/out/moved" && echo *.moved.obj)" "anna.moved.obj ben.moved.obj" "a folder of OBJ files"
is "$(wc -l <"$T/bash/out/corner.tsv")" "$(($(sinew info --get frames "$T/bash/out/smile.sinew") + 1))" "a row for each frame"
compare=${BUILD:-build}/tests/cli/compare_pictures
if [ -n "$coarse" ]; then
    skip 1 "$coarse"
elif [ -x "$compare" ]; then
    check "README's picture" "$compare" "$T/bash/out/face.png" samples/face.png
else
    skip 1 "no $compare: make unit builds it"
fi
check "a film for ParaView" grep -q '<DataSet' "$T/bash/out/smile.pvd"
is "$(diff "$T/bash/out/head.obj" "$T/bash/out/smile.obj" | sed -n 's/^[<>] \([a-z#]*\) .*/\1/p' | sort -u | tr '\n' ' ')" "v vn " "only v and vn lines change"
if [ -z "$coarse" ]; then
    is "$(cat "$T/bash"/said-* | grep -c 'warning: ')" 0 "no tool warns"
else
    skip 1 "$coarse"
fi

# What README says was printed, was: the lines of blocks marked text, and what the two longer examples end with.
cat "$T/bash"/said-* >"$T/said"
cat "$T/blocks"/*.text >"$T/lines"
while IFS= read -r line; do
    if [ -n "$coarse" ]; then
        skip 1 "$coarse"
    else
        check "printed: $line" grep -qxF -e "$line" "$T/said"
    fi
done <"$T/lines"

# quotes TEXT: README has it, wherever its lines end.
tr '\n' ' ' <README.md >"$T/readme"
quotes() {
    check "README says: $1" grep -qF -e "$1" "$T/readme"
}
if [ -n "${SINEW_LONG:-}" ]; then
    samples/arm "$T/arm" >"$T/long" 2>&1
    quotes "\`$(grep '^at 12 mm: ' "$T/long")\`"
    samples/scan "$T/scan" >"$T/long" 2>&1
    quotes "\`$(grep '^arm: of the vein ' "$T/long")\`"
else
    skip 2 "SINEW_LONG is not set: make arm, make scan"
fi
quotes "$(sed -n 's/^\(-*[0-9.]* -*[0-9.]* -*[0-9.]*\)$/\1/p' "$T/lines" | awk '{
    printf "moves %.1f mm: %.1f mm to its side, %.1f mm up and %.1f mm back", 1000 * sqrt($1 ^ 2 + $2 ^ 2 + $3 ^ 2), 1000 * $1, 1000 * $2, -1000 * $3 }')"
# real_time CSV MODEL DEVICE,THREADS,PRECISION: how many times real time
real_time() {
    awk -F, -v row="$2,$3,step" 'index($0, row) == 1 { print $16 }' "tests/bench/$1"
}
quotes "sinew_$(sinew -V | sed 's/.* //')_amd64.deb"
quotes "$(real_time nvidia-h200.csv face_2.5mm cuda,16,single | awk '{ printf "24,297 elements runs %.0f times as fast as real time", $1 }')"
quotes "$(real_time nvidia-h200.csv face_1.25mm cuda,16,single | awk '{ printf "194,192 elements %.1f times", $1 }')"
quotes "$({
    real_time amd-epyc-2-processors.csv face_2.5mm cpu,2,double
    real_time amd-epyc-2-processors.csv face_1.25mm cpu,2,double
} | awk '{ s[NR] = 1 / $1 } END { printf "take %.1f s and %.0f s", s[1], s[2] }')"
quotes "$(sed -n 's/^# Table II, 32x16x16: \([0-9]*\) .*/\1 frames a second/p' tests/bench/amd-epyc-2-processors.csv)"

# What README and CONTRIBUTING.md name is there: targets of make, pages of the manual, files.
for file in README.md CONTRIBUTING.md; do
    # shellcheck disable=SC2016 # `make TARGET` in the text
    grep -oE '`[^`]*`' "$file" | grep -oE '(^`|[ =0-9])make( [a-z][a-z-]*)+' | sed 's/.*make //' | tr ' ' '\n' | sort -u >"$T/named"
    unknown=
    while read -r target; do
        is_target "$target" || unknown="$unknown $target"
    done <"$T/named"
    is "$unknown" "" "$file names targets that make has: $(wc -l <"$T/named")"
    unknown=
    grep -oE '[a-z][a-z-]*\([157]\)' "$file" | grep -vxF 'diff(1)' | sed 's/(/./; s/)//' | sort -u >"$T/named"
    while read -r page; do
        test -e "man/$page" || unknown="$unknown $page"
    done <"$T/named"
    is "$unknown" "" "$file names pages that there are: $(wc -l <"$T/named")"
    grep -oE '\]\([^)#]*\)' "$file" | sed 's/](//; s/)//' | grep -v '^http' >"$T/named"
    unknown=
    while read -r linked; do
        test -e "$linked" || unknown="$unknown $linked"
    done <"$T/named"
    is "$unknown" "" "and files that there are: $(wc -l <"$T/named")"
done
done_testing
