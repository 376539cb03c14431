#!/bin/sh
# attach --contact and --contact-file: samples of skin may not enter bone, nor bodies that are carried. A block that falls, slides
# and is lifted; a ball pressed into a layer against the formula; bytes, and what is refused.
# shellcheck disable=SC2046 # what prints numbers is split into these
. "$(dirname "$0")/lib.sh"
here=$(dirname "$0")

# ---- what attach writes: a block, 20 x 20 x 10 mm, 3 mm above a plate that holds nothing of it
cat >"$T/block.obj" <<'OBJ'
g skin
v 0 0 0
v 20 0 0
v 20 20 0
v 0 20 0
v 0 0 10
v 20 0 10
v 20 20 10
v 0 20 10
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
OBJ
plate() { # Z
    printf 'g plate\nv -40 -40 %g\nv 60 -40 %g\nv 60 60 %g\nv -40 60 %g\nf 1 2 3 4\n' "$1" "$1" "$1" "$1"
}
plate -3 >"$T/plate.obj"
plate 0 >"$T/under.obj"
voxelise -q --unit mm -s 2.5 "$T/block.obj" 2>/dev/null >"$T/voxels"
with() { # OPTION...
    attach -q "$@" <"$T/voxels" 2>"$T/said"
}
with --contact-file "$T/plate.obj" --part tray=plate >"$T/tray"
is "$(get axis.field "$T/tray") $(get field.contact.min "$T/tray") $(get field.body.max "$T/tray") $(get node.rigid.max "$T/tray")" "1 1 0 0" \
    "a field that skin may not enter, of a body that holds no node"
set -- $(get body.centre "$T/tray")
below "$(awk -v x="$1" -v y="$2" -v z="$3" 'BEGIN { print (x - .01) ^ 2 + (y - .01) ^ 2 + (z + .003) ^ 2 }')" 1e-12 "whose centre is that of its surface"
is "$(sinew info "$T/tray" | grep -c 'slide\.')" 0 "and nothing slides"
with --rigid-file "$T/under.obj" --contact plate >"$T/held"
is "$(get axis.field "$T/held") $(get node.rigid.sum "$T/held") $(get field.contact.min "$T/held")" "1 81 1" "or of bone that holds nodes"

fails 1 "a region beside all" "has none of the 2 triangles" sh -c "attach -q --rigid-file '$T/under.obj' --contact plate:1,1,1,2,2,2 <'$T/voxels'"
with --rigid-file "$T/under.obj" --contact plate --slide plate >"$T/both"
is "$(get axis.field "$T/both") $(get field.contact.sum "$T/both") $(get slide.field.max "$T/both") $(get slide.field.min "$T/both")" "2 1 1 1" "both: the nodes slide by a field of their own"
attach -q <"$T/both" 2>/dev/null >"$T/none"
fails 1 "without these options the arrays go" "no key" sinew info --get axis.field "$T/none"
fails 2 "an unknown surface" "unknown rigid surface 'plat'; did you mean 'plate'" sh -c "attach -q --rigid-file '$T/under.obj' --contact plat <'$T/voxels'"
fails 2 "no region" "expected SURFACE,...\[:REGION\]" sh -c "attach -q --rigid-file '$T/under.obj' --contact plate: <'$T/voxels'"
fails 2 "an unknown surface of a part" "unknown rigid surface" sh -c "attach -q --contact-file '$T/plate.obj' --part tray=dish <'$T/voxels'"
fails 1 "a file that is not there" "cannot open" sh -c "attach -q --contact-file nofile.obj <'$T/voxels'"
fails 2 "standard input" "standard input is the model's" sh -c "attach -q --contact-file - <'$T/voxels'"
printf 'g dots\nv 0 0 0\nv 1 0 0\np 1\nl 1 2\n' >"$T/dots.obj"
fails 1 "points and lines alone" "expected polygons" sh -c "attach -q --contact-file '$T/dots.obj' <'$T/voxels'"

# ---- the block falls on it, and comes to rest
sinew bind -q --self-contact skin <"$T/tray" >"$T/falls"
tled-run -q -d cpu -m tissue.nu=.3 -g 0,0,-9.81 --ramp 0 --damping 60 -t .4 <"$T/falls" 2>/dev/null >"$T/fell"
sinew deform -q "$T/block.obj" <"$T/fell" >"$T/fell.obj"
below "$(awk '$1 == "v" && !(low < $4) { low = $4 } END { print (low + 3) / 2.5 }' "$T/fell.obj")" 1e-3 "at rest the corners that are drawn are on the plate, in voxels"
set -- $(get node.displacement.at.10mm,10mm,0 "$T/fell")
below "$(awk -v z="$3" 'BEGIN { print (z + .003) / .0025 }')" 1e-3 "and the middle of its lower side"
set -- $(get node.displacement.at.0,0,0 "$T/fell") $(get node.displacement.at.20mm,20mm,0 "$T/fell")
below "$(awk -v a="$1" -v b="$4" 'BEGIN { print a + b }')" 1e-12 "and spreads alike to both sides"
tled-run -q -d cpu -m tissue.nu=.3 -m tissue.E=1e5 -g 0,0,-9.81 --ramp 0 --damping 0 -t .08 --log-every .002 --log "$T/fall.tsv" <"$T/falls" 2>/dev/null >/dev/null
is "$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next } { e = $at["balance/J"]; most = e > most ? e : most; k = $at["kinetic/J"]; top = k > top ? k : top }
    END { print (most < .01 * top ? "kept" : most / top) }' "$T/fall.tsv")" kept "without damping no energy comes of it"

# ---- the plate goes up by 8 mm and takes it along; the same bytes by other threads and in two parts
printf '0 gravity 0,0,-9.81\n0 move tray 0,0,0 0,0,0,1\n.1 move tray 0,0,0 0,0,0,1\n.2 move tray 0,0,8mm 0,0,0,1\n' >"$T/lift"
lifted() { # OPTION...
    tled-run -q -d cpu -m tissue.nu=.3 --script "$T/lift" --damping 60 "$@" 2>/dev/null
}
lifted -t .5 <"$T/falls" >"$T/up"
set -- $(get node.displacement.at.10mm,10mm,0 "$T/up")
below "$(awk -v z="$3" 'BEGIN { print (z - .005) / .0025 }')" 1e-3 "a plate that moves takes it along"
near "$(get body.pose "$T/up" | awk '{ print $3 }')" .008 1e-9 "and frames say where it is"
for n in 1 3; do lifted --threads $n -t .2 <"$T/falls" | cksum; done >"$T/sums"
is "$(sort -u "$T/sums" | wc -l | tr -d ' ')" 1 "the same bytes by 1 and 3 threads"
lifted -t .1 <"$T/falls" | lifted -t .1 >"$T/parts"
lifted -t .2 <"$T/falls" >"$T/whole"
check "and in two parts" sinew diff --only node.displacement,node.velocity "$T/whole" "$T/parts"

# ---- a slope of 30 degrees without damping, on a plate below, of a stiff block
with --contact-file "$T/under.obj" >"$T/ramp"
sinew bind -q --self-contact skin <"$T/ramp" >"$T/slides"
slides() { # MU
    tled-run -q -d cpu -m tissue.nu=.3 -m tissue.E=1e5 --damping 0 --friction "$1" -t .04 -g 4.905,0,-8.4957 --ramp 0 --tsv node.displacement.at.10mm,10mm,5mm --log "$T/slid.tsv" <"$T/slides" 2>/dev/null >/dev/null
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /displacement.at.*x\/m/) at = i; next } { a = 2 * $at / ($1 * $1) } END { print a }' "$T/slid.tsv"
}
slid=$(slides 0)
below "$(awk -v a="$slid" 'BEGIN { print a / 4.905 - 1 }')" .01 "a block slides by g sin"
slid=$(slides .1)
below "$(awk -v a="$slid" 'BEGIN { print a / (4.905 - .84957) - 1 }')" .02 "by g (sin - mu cos)"
slid=$(slides 2)
check "and hardly by friction of 2 ($slid)" awk -v a="$slid" 'BEGIN { exit !(a < .6) }'

# ---- Hertz: a ball of 12 cm, pressed .3 mm into a bonded layer of 2 cm that is 20 contact radii wide
hertz() { # WHAT OPTION...
    what=$1
    shift
    awk -v W=60 -v H=20 -v R=120 -v D=.3 -v what="$what" "$@" -f "$here/hertz.awk"
}
hertz layer >"$T/layer.obj"
hertz ball >"$T/ball.obj"
hertz script >"$T/press"
voxelise -q --unit mm -s 2 "$T/layer.obj" | attach -q --part base=bone --contact-file "$T/ball.obj" --part ball=ball | sinew bind -q --self-contact skin 2>/dev/null >"$T/layer"
tled-run -q -d cpu --precision single -m tissue.nu=.45 --script "$T/press" --damping 200 -t .13 <"$T/layer" 2>/dev/null | sinew export -f model --text >"$T/pressed"
force=$(awk '/^array/ { what = $2; next } what == "body.force" { print -$3; exit }' "$T/pressed")
below "$(awk -v f="$force" -v want="$(hertz force -v E=3000 -v nu=.45)" 'BEGIN { print f / want - 1 }')" .03 "a ball presses as the bonded layer's formula says"

# ---- what is told
plate 3 >"$T/in.obj"
with --contact-file "$T/in.obj" >"$T/deep"
sinew bind -q --self-contact skin <"$T/deep" | tled-run -q -d cpu -n 2 2>"$T/said" >/dev/null
check "skin that is in bone at rest" grep -q 'samples of skin are deeper in bone at rest than 0.1 of a voxel, the deepest 3 mm' "$T/said"
tled-run -q -d cpu -n 2 <"$T/tray" 2>"$T/said" >/dev/null
check "bone without samples" grep -q 'bone that skin may not enter (attach --contact), but no samples of skin' "$T/said"
done_testing
