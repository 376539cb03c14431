#!/bin/sh
# What DIAGNOSTICS of a page quotes is what its tool prints, numbers aside; and each quote is printed here.
. "$(dirname "$0")/lib.sh"

# quotes PAGE: a line each, as a reader sees it, numbers as N, paths without folders.
quotes() {
    sed -n '/^\.Sh DIAGNOSTICS/,/^\.Sh [^D]/s/^\.It //p' "$ROOT/man/$1.1" | sed 's/^"//; s/"$//; s/\\(dq/"/g; s/\\&//g; s/\\-/-/g' | numbers
}

numbers() {
    sed -E 's, /[^ ]*/, /,; s/-?[0-9]+(\.[0-9]+)?(e-?[0-9]+)?/N/g'
}

# quoted PAGE COMMAND...: the command prints one of the page's quotes; which is noted.
quoted() {
    page=$1
    shift
    "$@" >/dev/null 2>"$T/stderr" </dev/null
    numbers <"$T/stderr" >"$T/printed"
    quotes "$page" | while IFS= read -r quote; do
        ! grep -Fq -e "$quote" "$T/printed" || printf '%s\n' "$quote"
    done >"$T/found"
    sed "s/^/$page: /" "$T/found" >>"$T/seen"
    check "$page: $(head -n 1 "$T/found")" test -s "$T/found" || diag_file "$T/printed"
}

# shellcheck disable=SC2317 # called by name
from() {
    file=$1
    shift
    "$@" <"$file"
}

cd "$T" || exit 1
sed '1i g skin' "$ROOT/tests/cli/cube.obj" >face.obj
voxelise -q --unit mm -s 5 face.obj -o loose.sinew 2>"$T/made" && attach -q --rigid skin -o held.sinew <loose.sinew && sinew bind -q -o bound.sinew <held.sinew
tled-run -q -n 2 -o run.sinew <bound.sinew
tled-run -q -n 2 -o unbound.sinew <held.sinew
awk '/^v / && !n++ { $2 += 1 } { print }' face.obj >changed.obj
mkdir other && mv changed.obj other/face.obj

quoted sinew sinew inof
cp "$SINEW_BIN/sinew" "$T/other/sinew"
quoted sinew "$T/other/sinew" info
quoted sinew-deform from run.sinew sinew deform other/face.obj
quoted sinew-deform from unbound.sinew sinew deform face.obj
quoted sinew-deform from bound.sinew sinew deform face.obj
cp run.sinew a.sinew
cp run.sinew b.sinew
quoted sinew-diff sinew diff --abs node.rigid=1 a.sinew b.sinew
quoted sinew-diff sinew diff --only node.displacment a.sinew b.sinew
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n' >scan.obj
printf 'v 0 0 1\nv 9 0 1\nv 9 9 1\nv 0 9 1\nf 1 2 3 4\n' >predicted.obj
quoted sinew-distance sinew distance --unit mm predicted.obj scan.obj
quoted sinew-distance sinew distance --unit mm --region a=0,0,0,1,1,1 predicted.obj scan.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 2 0\nf 1 2 3\nf 1 4 3\nf 4 3 5\n' >scan.obj
quoted sinew-distance sinew distance --unit mm predicted.obj scan.obj
quoted sinew-export sinew export -f vtu --frame 3 run.sinew
quoted sinew-export sinew export -f vtu --surface face --deformed unbound.sinew
sinew export -f vtu -o liver.vtu run.sinew
sinew export -f inp -o whole.inp run.sinew
awk '/^\*ELEMENT/ { print; getline; split($0, n, ","); sub(n[2] ",", n[3] ",") } { print }' whole.inp >liver.inp
quoted sinew-import sinew import --unit m liver.inp
quoted sinew-import sinew import --unit mm liver.vtu
quoted sinew-import sinew import --unit mm whole.inp
quoted sinew-info sinew info --get axs.node run.sinew
quoted sinew-info sinew info --get node.velocity.max bound.sinew
quoted sinew-materials sinew materials --tsv laws two.materials
printf 'tissue E=3000\nfat law=yeo\n' >two.materials
quoted sinew-materials sinew materials two.materials
quoted sinew-results from run.sinew sinew results stresses
quoted sinew-results from bound.sinew sinew results all
awk -v nx=1 -v ny=1 -v nz=1 -v h=1 -v held=low -v muscle=1 -f "$ROOT/tests/cli/block.awk" | tled-run -q -n 2 >muscle.sinew
quoted sinew-results from muscle.sinew sinew results stress
quoted sinew-render sinew render --camera 1,0,0,2,0,0 run.sinew
quoted sinew-render sinew render --colour displacement unbound.sinew
quoted sinew-render sinew render --show voxels --clear skin run.sinew
quoted sinew-render sinew render --font none.ttf --sheet rest,deformed run.sinew

for page in sinew sinew-deform sinew-diff sinew-distance sinew-export sinew-import sinew-info sinew-materials sinew-render sinew-results; do
    quotes "$page" | sed "s/^/$page: /"
done | sort >"$T/quotes"
is "$(sort -u "$T/seen" | comm -13 - "$T/quotes")" "" "every quote was printed"
done_testing
