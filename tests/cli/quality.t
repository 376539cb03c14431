#!/bin/sh
# Which elements are folded, and how much hourglass control holds: by sinew info against closed forms, at the end of a run and in its
# log against sinew info, in pictures and VTU against VTK's own Jacobian; what is warned of, and what is not.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

get() { # KEY FILE
    sinew info --get "quality.$1" "$2" 2>&1
}

# ---- Closed forms. Two cubes of 10 cm; the node that is corner 6 of the second alone goes d of a side along each axis: J there is
# 1 + 3 d, as I + d times ones has it, and 1 + 3 d / 4 in the middle.
two() { # FRAME-LINES
    awk -v nx=2 -v ny=1 -v nz=1 -v h=0.1 -v held=low -f tests/cli/block.awk | sed '/^end/d'
    cat
    echo end
}
pushed() { # D KAPPA
    awk -v d="$1" 'BEGIN { print "frame 0 0\narray node.displacement f64 m node 3"
        for (n = 0; n < 12; n++) print n == 11 ? d / 10 " " d / 10 " " d / 10 : "0 0 0" }' | two
}
for d in 0.3 -0.25 -0.34 -0.5; do
    pushed "$d" >"$T/pushed"
    near "$(get j.corner "$T/pushed")" "$(awk -v d=$d 'BEGIN { print d < 0 ? 1 + 3 * d : 1 }')" 1e-12 "a corner pushed by $d: J there"
    near "$(get j.centre "$T/pushed")" "$(awk -v d=$d 'BEGIN { print d < 0 ? 1 + .75 * d : 1 }')" 1e-12 "and in the middle"
    is "$(get folded "$T/pushed")" "$(awk -v d=$d 'BEGIN { print (1 + 3 * d <= 0) + 0 }')" "how many are folded"
done
is "$(get element "$T/pushed"); $(get place "$T/pushed" | awk '{ printf "%.12g %.12g %.12g", $1, $2, $3 }')" "1; 0.15 0.05 0.05" \
    "which is the worst, and where it rests"
is "$(sinew info "$T/pushed" | grep folded)" "  folded elements 1, the worst element 1 (volume 'skin') at 0.15m,0.05m,0.05m: J -0.5 at a corner" "the summary says so"
if have python3; then
    is "$(sinew info --json "$T/pushed" | python3 -c 'import json, sys; q = json.load(sys.stdin)["last"]["quality"]; print(q["folded"], q["element"], q["j.corner"], q["j.centre"])')" \
        "1 1 -0.5 0.625" "and JSON"
else
    skip 1 "no python3"
fi
pushed -0.25 >"$T/sound"
is "$(sinew info "$T/sound" | grep -c folded)$(sinew info --json "$T/sound" | grep -c folded)" 00 "of nothing that is folded there is no word"
awk -v nx=2 -v ny=1 -v nz=1 -v h=0.1 -f tests/cli/block.awk >"$T/rest"
is "$(get j.centre "$T/rest") $(get j.corner "$T/rest") $(get folded "$T/rest")" "1 1 0" "at rest J is 1"
is "$(get j.corner tests/golden/v1/tet.text)" "$(get j.centre tests/golden/v1/tet.text)" "tetrahedra have one J"

# A shear of .2 in all (J 1, W = mu / 2 .04) and u_x = a (1, -1, 1, -1, ...) by the signs of xy in both cubes: modes of 8 a. F^-1 leaves them
# as they are, so they bend with a strain of 2 a / h.
# twisted NU KEY VALUE: metadata of that run
twisted() {
    awk -v nx=2 -v ny=1 -v nz=1 -v h=0.1 -v nu="$1" -f tests/cli/block.awk |
        sed "/^end/d; s/^meta source.unit.*/&\nmeta hourglass.$2 \"$3\"/"
    awk 'BEGIN { print "frame 0 0\narray node.displacement f64 m node 3"
        for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 3; i++)
            printf "%.17g 0 0\n", .2 * .1 * k + .001 * ((i + j) % 2 ? -1 : 1) }
        END { print "end" }' /dev/null
}
for nu in .3 .45 .4999; do
    twisted "$nu" control physical >"$T/twisted"
    near "$(get hourglass "$T/twisted")" "$(awk -v nu=$nu 'BEGIN { mu = 1 / (2 * (1 + nu)); printf "%.12g", 1 / (1 - nu ^ 2) / 6 * (2 * .001 / .1) ^ 2 / (mu / 2 * .04) }')" \
        1e-9 "hourglass energy over strain energy, nu = $nu: of bending"
    twisted "$nu" control isotropic:0.02 >"$T/twisted"
    near "$(get hourglass "$T/twisted")" "$(awk 'BEGIN { printf "%.12g", .02 * 11 * 150 / 8 / 2 * (8 * .001) ^ 2 / (.04 / 2) }')" 1e-9 "of isotropic control, by mu"
    twisted "$nu" kappa 0.0075 >"$T/twisted"
    near "$(get hourglass "$T/twisted")" "$(awk -v nu=$nu 'BEGIN { wave = 2 * nu / (1 - 2 * nu) + 2; if (wave > 11) wave = 11
        printf "%.12g", .0075 * wave * 150 / 8 / 2 * (8 * .001) ^ 2 / (.04 / 2) }')" 1e-9 "of a run of Sinew 0.2 and before, by min(lambda + 2 mu, 11 mu)"
done
# A model of an older release keeps what it said, beside what holds now.
awk -v nx=2 -v ny=1 -v nz=1 -v h=0.1 -v held=low -f tests/cli/block.awk | sed 's/^meta source.unit.*/&\nmeta hourglass.kappa "0.0075"/' >"$T/old"
check "a run of such a model" sh -c "tled-run -q -d cpu -g 0,0,-1 -n 20 <'$T/old' >'$T/both'"
is "$(sinew info --get meta.hourglass.kappa --get meta.hourglass.control "$T/both" | tr '\n' ' ')" "0.0075 physical " "leaves both keys"
near "$(get hourglass "$T/both")" "$(sinew export -f model --text "$T/both" | grep -v -e ^crc -e hourglass.kappa >"$T/one" && get hourglass "$T/one")" 0 \
    "and the newer one counts"
# Modes alone hold no strain: inf, wherever it is told. And where nothing but rounding is held, the share is 0.
{
    sed '/^end/d' "$T/rest"
    awk 'BEGIN { print "frame 0 0\narray node.displacement f64 m node 3"
        for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 3; i++) print (i + j) % 2 ? "-.001 0 0" : ".001 0 0"
        print "array node.velocity f64 m/s node 3"; for (n = 0; n < 12; n++) print "0 0 0"; print "end" }' /dev/null
} >"$T/modes"
check "modes alone" tled-run -d cpu --hourglass 0.0075 -t 0 --log "$T/log" -o "$T/out" <"$T/modes"
is "$(get hourglass "$T/out") $(tail -n 1 "$T/log" | cut -f 24) $(sed -n 's/.*; hourglass energy \(.*\) of strain energy$/\1/p' "$T/stderr")" \
    "inf inf inf %" "the share is inf, in a frame, the log and the line at the end"
is "$(grep -c 'warning: hourglass energy is inf % of strain energy at the end' "$T/stderr")" 1 "and that is warned of"
check "modes alone, physical" tled-run -d cpu -t 0 --log "$T/log" -o "$T/out" <"$T/modes"
is "$(get hourglass "$T/out") $(tail -n 1 "$T/log" | cut -f 24) $(sed -n 's/.*; hourglass energy \(.*\) of strain energy$/\1/p' "$T/stderr") $(grep -c 'warning: hourglass' "$T/stderr")" \
    "inf inf inf % 0" "the share is inf too, and nothing is warned of: it is the tissue's own energy"
awk -v nx=10 -v ny=4 -v nz=4 -v h=0.0025 -v held=low -f tests/cli/block.awk >"$T/block"
for g in 1e-9 1e-7 1e-6; do
    check "a weight of $g m/s2" tled-run -d cpu -g 0,0,-$g -t .05 --log "$T/log" -o "$T/out" <"$T/block"
    is "$(get hourglass "$T/out") $(tail -n 1 "$T/log" | cut -f 24) $(sed -n 's/.*; hourglass energy \(.*\) of strain energy$/\1/p' "$T/stderr")" \
        "0 0 0 %" "strain of that size is rounding: no share of it"
done
fails 1 "of a run that does not say its control" "quality.hourglass': hourglass energy is not known: the model has no metadata hourglass.control; it comes from tled-run" \
    sinew info --get quality.hourglass "$T/pushed"
fails 1 "without frames" "quality.hourglass': the model has no frames" sinew info --get quality.hourglass "$T/rest"
fails 1 "of tetrahedra" "for hexahedra only, and these elements have 4 nodes" sinew info --get quality.hourglass tests/golden/v1/tet.text
for kappa in nan -1 inf '' '1 2' x; do
    sed "s/^meta hourglass.kappa.*/meta hourglass.kappa \"$kappa\"/" "$T/twisted" >"$T/bad"
    fails 1 "a coefficient of '$kappa'" 'hourglass.kappa' sinew info --get quality.hourglass "$T/bad"
done
for control in '' physica isotropic:-1 isotropic:; do
    twisted .45 control "$control" >"$T/bad"
    fails 1 "a control of '$control'" "hourglass.control holds '$control'; expected physical or isotropic:KAPPA" sinew info --get quality.hourglass "$T/bad"
done
awk -v nx=0 -v ny=1 -v nz=1 -v h=0.1 -f tests/cli/block.awk >"$T/flat"
for key in element place; do
    fails 1 "quality.$key of 0 elements" "quality.$key': the model has no elements\$" sinew info --get quality.$key "$T/flat"
done
fails 1 "no elements" "quality.folded': the model has no elements; they come from voxelise" sinew info --get quality.folded tests/golden/v1/empty.text
fails 1 "a slip" "did you mean 'quality.j.centre'" sinew info --get quality.j.centr "$T/rest"
fails 1 "no such key" "expected one of these: quality.j.centre, quality.j.corner, quality.folded, quality.element, quality.place, quality.hourglass" \
    sinew info --get quality.x "$T/rest"

# ---- A run's log says what sinew info says of its frames, to the nine digits of a log.
# logged NAME MODEL FOLDED ARG...: as many, at least, are folded at the end.
logged() {
    name=$1 model=$2 folded=$3
    shift 3
    tled-run -q -d cpu --every .02 --log "$T/log" --log-every .02 -o "$T/out" "$@" <"$model" 2>"$T/said"
    awk -F '\t' -v OFS='\t' 'NR > 1 { print $1, $(NF - 3), $(NF - 2), $(NF - 1), $NF }' "$T/log" >"$T/rows"
    sinew info --tsv quality.j.centre --tsv quality.j.corner --tsv quality.folded --tsv quality.hourglass "$T/out" | sed 1d | cut -f 2- >"$T/frames"
    is "$(paste "$T/rows" "$T/frames" | awk '{ for (i = 1; i <= 5; i++) { d = $i - $(i + 5); if (d < 0) d = -d
        s = $i < 0 ? -$i : $i; if (NF != 10 || d > 6e-9 * s) print } }')" "" "$name: the log and sinew info say the same, $(wc -l <"$T/rows" | tr -d ' ') times"
    check "$name: $(get folded "$T/out") folded" test "$(get folded "$T/out")" -ge "$folded"
}
awk -v nx=10 -v ny=4 -v nz=4 -v h=0.0025 -v held=low -v muscle=1 -v nu=.49 -f tests/cli/block.awk >"$T/muscle"
logged "a muscle" "$T/muscle" 0 -c all=1 -t .1
logged "a muscle that folds elements" "$T/muscle" 1 --hourglass 0.0075 -c all=1 -t .1
is "$(awk -F '\t' '{ print $(NF - 3), $(NF - 2), $(NF - 1), $NF; exit }' "$T/log")" "quality.j.centre quality.j.corner quality.folded quality.hourglass" "named as the keys"
is "$(sinew info --tsv quality.place --tsv quality.folded --tsv quality.element "$T/out" | sed -n 1p | tr '\t' ' ')" \
    "frame time/s quality.place.x/m quality.place.y/m quality.place.z/m quality.folded quality.element" "a table of frames has units"
logged "single precision" "$T/muscle" 1 --hourglass 0.0075 --precision single -c all=1 -t .1
logged "single precision, physical" "$T/muscle" 0 --precision single -c all=1 -t .1
awk -v n=5 -f samples/ball.awk | sinew import -q --unit m -o "$T/ball" -
logged "elements that are no boxes" "$T/ball" 1 -g 0,3,-30 -t .1
{
    box skin 0 0 0 47 23 23
    box muscle_a 3 3 3 44 20 20
    box skull -1 -1 -1 3 24 24
} >"$T/parts.obj"
printf 'skin surfaces=skin material=soft\nmuscle_a level=1 surfaces=muscle_a material=stiff\n' >"$T/volumes"
printf 'soft E=3000 nu=0.45 density=1000\nstiff E=9000 nu=0.48 density=1500\n' >"$T/materials"
voxelise -q --unit mm -s 5 --fraction 3 --volumes "$T/volumes" --materials "$T/materials" "$T/parts.obj" | attach -q >"$T/parts"
is "$(sinew info "$T/parts" | grep -c -e 'element.fraction' -e 'element.mixture')" 2 "a model of parts of elements, and of mixed ones"
logged "elements of two materials" "$T/parts" 0 -c a=1 -t .1

# ---- What is said at the end, and warned of. Isotropic control folds elements where physical control does not, and its energy is artificial.
line='smallest J -?[0-9.e-]* in the middle of an element, -?[0-9.e-]* at a corner; [0-9]* folded; hourglass energy [0-9.e-]* % of strain energy'
check "a run that folds elements is none that failed" sh -c "tled-run -d cpu --hourglass 0.0075 -c all=1 -t .1 -o '$T/out' <'$T/muscle'"
cp "$T/stderr" "$T/folded"
check "it says the smallest J" grep -Eq "^tled-run: $line\$" "$T/folded"
is "$(sed -n 's/.*; \([0-9]*\) folded;.*/\1/p' "$T/folded") $(sed -n 's/.*warning: \([0-9]*\) of 160 elements .*/\1/p' "$T/folded")" \
    "$(get folded "$T/out") $(get folded "$T/out")" "and how many are folded, as sinew info does"
is "$(sed -n "s/.*folded at the end (J <= 0 in the middle or at a corner); the worst is element \([0-9]*\) (volume 'muscle_all') at .*m,.*m,.*m, J .*/\1/p" "$T/folded")" \
    "$(get element "$T/out")" "the worst by number, volume and place"
place=$(sed -n "s/.*the worst is element [0-9]* (volume 'muscle_all') at \([^ ]*\), J.*/\1/p" "$T/folded")
is "$(sinew info --get "element.node.at.$place" "$T/out")" "$(sinew info --get "element.node.row.$(get element "$T/out")" "$T/out")" \
    "a place that keys of sinew info take: $place"
check "with what helps" grep -q 'warning: .*expected voxelise --fraction 4, a stiffer material, less load or contraction there, or a larger --hourglass$' "$T/folded"
check "with -q" sh -c "tled-run -q -d cpu --hourglass 0.0075 -c all=1 -t .1 -o '$T/out' <'$T/muscle'"
is "$(grep -c . "$T/stderr") $(grep -c 'folded at the end' "$T/stderr")" "1 1" "the warning stays, the line does not"
check "with a larger --hourglass" tled-run -d cpu --hourglass .1 -c all=1 -t .1 -o "$T/out" <"$T/muscle"
is "$(grep -c -e folded "$T/stderr") $(get folded "$T/out")" "1 0" "none is folded, and none is warned of: that does help"
check "with physical control" tled-run -d cpu -c all=1 -t .1 -o "$T/out" <"$T/muscle"
is "$(grep -c -e folded "$T/stderr") $(get folded "$T/out")" "1 0" "so does that"
printf '0 contract all 0\n.04 contract all 1\n.06 contract all 1\n.1 contract all 0\n' >"$T/script"
check "a muscle that lets go" tled-run -q -d cpu --hourglass 0.0075 --script "$T/script" -t .3 --every .02 -o "$T/out" <"$T/muscle"
sinew info --tsv quality.folded --tsv quality.j.corner "$T/out" | awk -F '\t' 'NR > 1 && $3 > 0 { n++ } NR > 1 && $4 < least { least = $4; at = $2; many = $3 }
    END { print n " of " NR - 1 " frames, worst at " at " s, " many " of 160;" }' >"$T/want"
is "$(sed -n 's/.*elements are folded during the run (J <= 0 in the middle or at a corner), in \(.*;\) the worst is element [0-9]* .*/\1/p' "$T/stderr")" "$(cat "$T/want")" \
    "what is folded in frames on the way is told: $(cat "$T/want")"
is "$(get folded "$T/out") $(grep -c . "$T/stderr")" "0 1" "once, and nothing else: hourglass energy is little of what there was"
check "a run that is killed" sh -c "tled-run -q -d cpu --hourglass 0.0075 --script '$T/script' -t .3 --every .02 --checkpoint '$T/state' --checkpoint-every .1 <'$T/muscle' | head -c 100000 >/dev/null; test -e '$T/state'"
check "and goes on" tled-run -q -d cpu --hourglass 0.0075 --script "$T/script" -t .3 --every .02 --restart "$T/state" -o "$T/out" <"$T/muscle"
is "$(grep -Fc "in $(cat "$T/want")" "$T/stderr")" 1 "says the same of all frames, with those from before"
awk -v nx=6 -v ny=2 -v nz=1 -v h=0.005 -v held=low -f tests/cli/block.awk >"$T/thin"
printf '0 gravity 0,0,0\n.05 gravity 0,0,-200\n.1 gravity 0,0,-200\n.15 gravity 0,0,0\n' >"$T/script"
set -- -d cpu --hourglass 0.0075 --damping 40 --script "$T/script" -t .6 --every .004
check "a strip that is let go" tled-run "$@" -o "$T/out" <"$T/thin"
is "$(get hourglass "$T/out" | awk '{ print ($1 > 1) }')$(grep -c 'warning: hourglass' "$T/stderr")" 10 "its modes are most of what is left, and little of what there was"
check "killed after that" sh -c "tled-run -q $* --checkpoint '$T/state' --checkpoint-every .25 <'$T/thin' | head -c 200000 >/dev/null; test -e '$T/state'"
check "and gone on" tled-run "$@" --restart "$T/state" -o "$T/out" <"$T/thin"
is "$(grep -c 'warning: hourglass' "$T/stderr")" 0 "it is still little of what there was"
check "a strip one element thick that bends" tled-run -d cpu --hourglass 0.0075 -g 0,0,-9.81 -t .1 -o "$T/out" <"$T/thin"
share=$(get hourglass "$T/out" | awk '{ printf "%.3g", 100 * $1 }')
is "$(grep -Ec "warning: hourglass energy is $share % of strain energy at the end, expected at most 10 %: .* element [0-9]* \(volume 'skin'\) at .*m,.*m,.*m holds the most of it, .*; expected smaller voxels\$" "$T/stderr")" \
    1 "is past 10 %: $share %"
check "the same strip, physical" tled-run -d cpu -g 0,0,-9.81 -t .1 -o "$T/out" <"$T/thin"
is "$(get hourglass "$T/out" | awk '{ print ($1 > 1) }') $(grep -c warning "$T/stderr")" "1 0" "most of its energy is in these modes, and nothing is warned of: it bends"
printf '0 force 0.03,0.01,0.005 1mm 0,0,0\n.05 force 0.03,0.01,0.005 1mm 0,0,-.02\n' >"$T/script"
check "one corner of it pushed" tled-run -q -d cpu --hourglass 0.0075 --script "$T/script" -t .1 -o "$T/out" <"$T/thin"
is "$(grep -c 'hourglass energy is [0-9]* %' "$T/stderr")$(grep -c 'folded at the end.*expected voxelise --fraction 4, a stiffer material, or less load or contraction there$' "$T/stderr")" 11 \
    "where it folds elements at a share past 10 %, no larger --hourglass is advised"
printf '.06 force 0.03,0.01,0.005 1mm 0,0,0\n' >>"$T/script"
tled-run -q -d cpu --hourglass 0.0075 --script "$T/script" -t .2 --every .05 -o "$T/out" <"$T/thin" 2>"$T/said"
is "$(grep -c 'folded during the run.*expected voxelise --fraction 4, a stiffer material, or less load or contraction there$' "$T/said")" 1 "nor of frames on the way"
sed -i 's/-.02$/-.08/' "$T/script"
tled-run -q -d cpu --hourglass .02 --script "$T/script" -t .05 -o "$T/out" <"$T/thin" 2>"$T/said"
is "$(grep -c 'folded at the end' "$T/said")$(grep -c 'expected smaller voxels$' "$T/said")" 11 "nor a smaller one, which would fold more"
tled-run -q -d cpu --script "$T/script" -t .05 -o "$T/out" <"$T/thin" 2>"$T/said"
is "$(grep -c 'folded at the end.*expected voxelise --fraction 4, a stiffer material, or less load or contraction there$' "$T/said") $(grep -c . "$T/said")" \
    "1 1" "where physical control folds elements, --hourglass is no remedy, and its energy no warning"
check "four elements thick" sh -c "awk -v nx=24 -v ny=8 -v nz=4 -v h=0.00125 -v held=low -f tests/cli/block.awk | tled-run -d cpu --hourglass 0.0075 -g 0,0,-9.81 -t .1 -o '$T/out'"
is "$(grep -c warning "$T/stderr")" 0 "it is not ($(get hourglass "$T/out")): smaller voxels do help"
printf '*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,.3,.3,.3\n8,0,1,1\n*ELEMENT,TYPE=C3D8R,ELSET=a\n1,1,2,3,4,5,6,7,8\n*NSET,NSET=low\n1,2,3,4\n*BOUNDARY\nlow,1,3\n' |
    sinew import -q --unit m -o "$T/inside" - 2>"$T/said"
tled-run -q -d cpu -g 0,0,-1 -n 20 -o "$T/out" <"$T/inside" 2>"$T/said"
is "$(grep -c "the worst is element 0 (volume 'a') at .*, inside out at a corner at rest already: .*; expected a mesh without such elements$" "$T/said")$(get folded "$T/out")" 11 \
    "an element that is folded as it came is told apart"
fails 3 "a run that diverges" 'diverged at step' tled-run -d cpu --hourglass 0.0075 -c all=1 -t .1 --dt .000145 --every .0005 -o "$T/none" <"$T/muscle"
is "$(grep -Ec "^tled-run: the last frame, at 0.0[0-9]* s: $line\$" "$T/stderr")" 1 "tells of the last frame before"
is "$(grep -c 'warning: [0-9]* of 160 elements are folded at 0.0[0-9]* s, in the last frame, and some in [0-9]* of [0-9]* frames' "$T/stderr")" 1 "and of what it folded"
check "a run in which nothing happens" tled-run -d cpu -n 3 -o "$T/out" <"$T/muscle"
is "$(sed -n "s/.*\(smallest.*\)/\1/p" "$T/stderr"); $(grep -c warning "$T/stderr"); $(get hourglass "$T/out")" \
    "smallest J 1 in the middle of an element, 1 at a corner; 0 folded; hourglass energy 0 % of strain energy; 0; 0" "has nothing to warn of"

# ---- VTU: VTK's own Jacobian of hexahedra is the smallest of the corners' and the middle's, of the places that they have moved to.
python=
for p in python3 /usr/bin/python3; do
    "$p" -c 'import vtkmodules.vtkFiltersVerdict' 2>/dev/null && python=$p && break
done
tled-run -q -d cpu --hourglass 0.0075 -c all=1 -t .1 --every .05 -o "$T/out" <"$T/muscle" 2>"$T/said"
check "VTU of each frame" sinew export -f vtu --deformed --frame all -o "$T/film.pvd" "$T/out"
sinew export -f vtu --frame rest -o "$T/rest.vtu" "$T/out"
awk '/^frame/ && !n++ { print "array element.quality.j.centre f64 1 element 1"; for (i = 0; i < 160; i++) print 5 } { print }' <<END >"$T/own"
$(sinew export -f model --text "$T/out" | grep -v '^crc')
END
sinew export -f vtu -o "$T/own.vtu" "$T/own"
is "$(grep -ac 'Name="quality.j.centre"' "$T/own.vtu")$(grep -ac 'Name="quality.j.corner"' "$T/own.vtu")" 11 "an array of the model by one of these names stands alone"
if [ -n "$python" ]; then
    sinew info --tsv quality.folded --tsv quality.j.corner "$T/out" | sed 1d >"$T/frames"
    for file in "$T"/film*.vtu; do
        "$python" tests/cli/vtk_jacobian.py "$file" >"$T/theirs"
        for part in centre corner; do
            "$python" tests/cli/read_vtu.py "$file" cell quality.j.$part >"$T/$part"
        done
        paste "$T/theirs" "$T/centre" "$T/corner" | awk '{ j = $2 < $3 ? $2 : $3; d = $1 / .0025 ^ 3 - j; if (d < 0) d = -d
            if (d > off) off = d; if (NR == 1 || $3 < least) least = $3; n += j <= 0 }
            END { printf "%d %s %.9g\n", NR, off < 1e-12 ? "alike" : off, least; print n > "/dev/stderr" }' >"$T/got" 2>"$T/count"
        is "$(cat "$T/got")" "$(sed -n 1p "$T/frames" | awk '{ printf "160 alike %.9g", $4 }')" "J of 160 elements is VTK's, and the smallest that of sinew info"
        is "$(cat "$T/count")" "$(sed -n 1p "$T/frames" | cut -f 3)" "and as many are folded"
        sed -i 1d "$T/frames"
    done
    is "$(wc -l <"$T/frames" | tr -d ' ')" 0 "for each frame"
    is "$("$python" tests/cli/read_vtu.py "$T/rest.vtu" | grep -c quality)" 0 "at rest there is none"
    sinew export -f vtu -o "$T/tet.vtu" tests/golden/v1/tet.text
    sinew export -f vtu --deformed -o "$T/moved.vtu" tests/golden/v1/tet.text
    sinew export -f vtu --frame rest -o "$T/still.vtu" tests/golden/v1/tet.text
    "$python" tests/cli/vtk_jacobian.py "$T/moved.vtu" >"$T/moved"
    "$python" tests/cli/vtk_jacobian.py "$T/still.vtu" >"$T/still"
    "$python" tests/cli/read_vtu.py "$T/tet.vtu" cell quality.j.corner >"$T/corner"
    is "$(paste "$T/moved" "$T/still" "$T/corner" | awk '{ d = $1 / $2 - $3 } d < -1e-12 || d > 1e-12')$(wc -l <"$T/corner" | tr -d ' ')" 90 "of 90 tetrahedra too"
else
    skip 9 "no VTK for Python (python3-vtk9)"
fi

# ---- Pictures: what is folded is red, and nothing else is; the legend says what red is.
# red NAME MODEL ARG...: how many pixels are.
red() {
    sinew render --colour quality.j.corner --size 160x120 --format ppm -o "$T/picture" "$@" 2>"$T/said" || cat "$T/said"
    tail -c 57600 "$T/picture" | od -An -v -tu1 -w3 | awk '$1 > 90 && $1 > 2.5 * $2 && $1 > 2.5 * $3 { n++ } END { print n + 0 }'
}
check "folded elements are red: $(red --show voxels "$T/pushed") pixels" test "$(red --show voxels "$T/pushed")" -gt 300
is "$(red --show voxels "$T/sound")" 0 "where none is, nothing is"
check "with --range too" test "$(red --show voxels --range 0.5,1 "$T/pushed")" -gt 300
is "$(sinew render --colour quality.j.centre --show voxels --size 160x120 --format ppm "$T/pushed" | cksum)" \
    "$(sinew render --colour quality.j.centre --show voxels --size 160x120 --format ppm "$T/pushed" --range 0,1 | cksum)" "the scale begins at 0"
fails 1 "at rest" "quality.j.corner cannot be shown at rest, because it needs a frame of results" sinew render --colour quality.j.corner --frame rest -o "$T/none.png" "$T/pushed"
fails 2 "a slip in a field" "did you mean 'quality.j.corner'" sinew render --colour quality.j.corners -o "$T/none.png" "$T/pushed"
box skin 0 0 0 200 100 100 >"$T/skin.obj"
{
    voxelise -q --text --unit mm -s 100 "$T/skin.obj" 2>"$T/said" | sinew bind -q --text | grep -v -e '^crc' -e '^end'
    awk 'BEGIN { print "frame 0 0\narray node.displacement f64 m node 3"; for (n = 0; n < 12; n++) print n == 11 ? "-.05 -.05 -.05" : "0 0 0"; print "end" }'
} >"$T/bound"
check "on a surface the smallest of the elements round a node counts: $(red "$T/bound") pixels" test "$(red "$T/bound")" -gt 750

done_testing
