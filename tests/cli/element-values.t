#!/bin/sh
# Values that single elements have in place of their material's (element.E and so on): where they are the material's, the
# bytes are; a graded bar against its closed form; every tool keeps them; what is wrong is told.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

awk -v nx=6 -v ny=3 -v nz=3 -v h=0.01 -v held=low -v muscle=1 -f tests/cli/block.awk >"$T/muscle"
grep -v '^meta lattice' "$T/muscle" >"$T/mesh"
awk -v nx=8 -v ny=1 -v nz=1 -v h=0.01 -v held=low -v nu=0 -f tests/cli/block.awk >"$T/bar"

# with MODEL KEY UNIT PROGRAM: the model with the array element.KEY, the value of each element, n of them from 0, by awk.
with() {
    awk -v key="$2" -v unit="$3" "/^axis element/ { n = \$3 }
        /^end|^crc|^sum/ && !done++ { print \"array element.\" key \" f64 \" unit \" element 1\"; for (i = 0; i < n; i++) { $4 } }
        !/^crc|^sum/" "$1"
}
# frames ARG...: a sum of the frames of $T/model.
frames() {
    tled-run -q --text -d cpu -n 20 "$@" <"$T/model" | sed -n '/^frame/,$p' >"$T/frames"
    [ -s "$T/frames" ] && cksum <"$T/frames"
}

# ---- where they are the material's, each on its own and in some elements alone
for model in muscle mesh; do
    for precision in double single; do
        cp "$T/$model" "$T/model"
        sum=$(frames --precision $precision -c all=0.5 -g 9,2,-9.81)
        with "$T/$model" E Pa 'print i % 3 ? 3000 : "nan"' >"$T/model"
        is "$(frames --precision $precision -c all=0.5 -g 9,2,-9.81)" "${sum:-none}" "$model, $precision: the same bytes by element.E"
        with "$T/model" density kg/m3 'print 1000' >"$T/two" && mv "$T/two" "$T/model"
        is "$(frames --precision $precision -c all=0.5 -g 9,2,-9.81)" "$sum" "and by element.density too"
        with "$T/$model" E Pa 'print i == 7 ? 3001 : "nan"' >"$T/model"
        other=$(frames --precision $precision -c all=0.5 -g 9,2,-9.81)
        check "but not where one differs" test -n "$other" -a "$other" != "$sum"
    done
done

# ---- graded: pulled by s, the bar grows by s times the sum of its elements' lengths over their moduli
echo '0 force 0.08,0.005,0.005 0.008 0.00003,0,0' >"$T/script"
# grows MODEL NAME ARG...: to 1e-3.
grows() {
    file=$1
    name=$2
    shift 2
    tled-run -q -d cpu --rest 1e-7 --script "$T/script" --log "$T/log" "$@" <"$file" >"$T/out"
    near "$(sinew info --get node.displacement.at.0.08,0,0 "$T/out")" \
        "$(awk 'BEGIN { for (i = 0; i < 8; i++) sum += 0.01 / (1000 * 2 ^ (i / 2)); printf "%.9g", 0.3 * sum }')" 1e-3 "$name"
    near "$(sinew info --get quality.hourglass "$T/out")" "$(awk -F '\t' 'END { print $NF }' "$T/log")" 1e-5 "and sinew info has the energies of the log"
}
with "$T/bar" E Pa 'printf "%.17g\n", 1000 * 2 ^ (i / 2)' >"$T/graded"
grows "$T/graded" "a graded bar"
grep -v '^meta lattice' "$T/graded" >"$T/model"
grows "$T/model" "without a lattice"
with "$T/bar" c10 Pa 'printf "%.17g\n", 1000 * 2 ^ (i / 2) / 4 - 100' >"$T/model"
grows "$T/model" "by mooney-rivlin's c10" -m tissue.law=mooney-rivlin -m tissue.c10=100 -m tissue.c01=100 -m tissue.nu=0

# ---- tetrahedra
msds-mesh -q --text --nodes 5x5x4 --size 4cm,4cm,3cm --young 10000 --poisson 0.4 --density 1000 >"$T/block"
echo '0 .02 .02 .029 1 0 0 0' >"$T/poses"
pressed() {
    msds-run -q --text --method fem --exact --probe sphere:2cm --poses "$T/poses" <"$T/model" 2>"$T/said" | sed -n '/^frame/,$p' >"$T/frames"
    [ -s "$T/frames" ] && cksum <"$T/frames"
}
cp "$T/block" "$T/model"
sum=$(pressed)
with "$T/block" E Pa 'print i % 3 ? 10000 : "nan"' >"$T/model"
is "$(pressed)" "${sum:-none}" "msds-run: the same bytes by element.E"
with "$T/block" E Pa 'print i % 3 ? 20000 : "nan"' >"$T/model"
other=$(pressed)
check "but not where some differ" test -n "$other" -a "$other" != "$sum"

# ---- every tool keeps them
is "$(sinew info "$T/graded" | awk '$1 == "element.E" { print $6, $8 }')" "1000 11313.71" "sinew info tells them"
tled-run -q -n 1 <"$T/graded" >"$T/out"
is "$(sinew info "$T/out" | awk '$1 == "element.E" { print $6, $8 }')" "1000 11313.71" "and so does tled-run"
sinew export -f inp -o "$T/inp" "$T/graded" 2>"$T/said"
check "sinew export says that Abaqus's files have no place for them" grep -q 'element.E is not in the file' "$T/said"

# ---- what is wrong
# no NAME MODEL MESSAGE
no() {
    fails 1 "$1" "$3" tled-run -n 1 -o "$T/no" <"$2"
}
with "$T/bar" E Pa 'print i == 5 ? 0 : 3000' >"$T/bad"
no "a value that no material may have" "$T/bad" 'element.E, row 5: 0; expected 0.001 to 1e12 Pa, or nan'
with "$T/bar" c10 Pa 'print 7' >"$T/bad"
no "a key that the material does not have" "$T/bad" 'element.c10, row 0: 7 is not allowed; expected nan, as its material, of the law neo-hookean, has no c10'
with "$T/bar" nu 1 'print i == 6 ? .45 : "nan"' >"$T/model"
fails 1 "-m changes the law under it" "element.nu, row 6: 0.45 is not allowed; expected nan, as its material, of the law mooney-rivlin, has no nu" \
    tled-run -n 1 -m tissue.law=mooney-rivlin -m tissue.c10=1 -m tissue.c01=1 -m tissue.K=9 -o "$T/no" <"$T/model"
with "$T/bar" c2 1 'print i ? "nan" : 0.1' >"$T/model"
fails 1 "values that are no material together" "element, row 0: veronda-westmann, c2=0.1 lets waves lose their speed where tissue is stretched; expected c2 above" \
    tled-run -n 1 -m tissue.law=veronda-westmann -m tissue.c1=1000 -m tissue.c2=3 -m tissue.K=1e4 -o "$T/no" <"$T/model"
fung='-m tissue.law=fung -m tissue.c=2000 -m tissue.bf=8 -m tissue.bt=2 -m tissue.bfs=4 -m tissue.K=1e4'
with "$T/muscle" bfs 1 'print i == 3 ? 4 : "nan"' >"$T/model"
with "$T/muscle" K Pa 'print i == 3 ? 2e4 : "nan"' >"$T/stiffer"
# shellcheck disable=SC2086 # options of a material are words
{
    fails 1 "what fibres take of their volume" "element.bfs, row 3: 4 is not allowed; expected nan, as fibres have the values of their volume's material" \
        tled-run -q -n 1 $fung -o "$T/no" <"$T/model"
    check "but K may be an element's" tled-run -q -d cpu -n 1 $fung -o "$T/out" <"$T/stiffer"
}
done_testing
