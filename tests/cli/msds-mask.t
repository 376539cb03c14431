#!/bin/sh
# msds-mesh --mask and --refine: what of an image is meshed, where the skin is, what is fixed, where cells are halved; what others make of it.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

mesh() { # OPTIONS: into $T/m
    msds-mesh -q -o "$T/m" "$@"
}
# rows ARRAY: its rows in $T/m.
rows() {
    sinew export -f model --text "$T/m" | awk -v name="$1" '
        /^[a-z]/ { on = 0 } on { print } $1 == "array" && $2 == name { on = 1 }'
}
# volume [NUMBER]: of all tetrahedra in $T/m, or of those of one volume, mm3.
volume() {
    {
        rows element.volume
        rows node.position
        echo
        rows element.node
    } | awk -v only="$1" 'BEGIN { nodes = 0 } NF == 1 { of[ofs++] = $1 }
        NF == 3 { for (a = 1; a <= 3; a++) x[nodes, a] = $a; nodes++ }
        NF == 4 && (only == "" || of[tets++] == only) {
            for (c = 1; c < 4; c++) for (a = 1; a <= 3; a++) e[c, a] = x[$(c + 1), a] - x[$1, a]
            sum += (e[1, 1] * (e[2, 2] * e[3, 3] - e[2, 3] * e[3, 2]) - e[1, 2] * (e[2, 1] * e[3, 3] - e[2, 3] * e[3, 1]) \
                + e[1, 3] * (e[2, 1] * e[3, 2] - e[2, 2] * e[3, 1])) / 6
        }
        END { printf "%.6g", 1e9 * sum }'
}

# Images of 32 x 16 x 24 mm in voxels of 1 mm, skin at z = 16 + x / 8, air above it. `grey`: tissue is 80 with dark speckle in one of nine
# voxels, air is 10, with bright speckle; a vein, dark, goes through along y, and its shadow down to the bottom. `label`: 1 tissue, 2 vein, 3
# gel, a layer of 2 mm above the skin. `sector`: 0 where air is and left of x = 6 + z / 4, with a hole of 0 in the tissue; else 50.
image() {
    awk -v what="$1" 'BEGIN {
        print "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 32 16 24\nencoding: ascii\nspace: LPS"
        print "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (.5,.5,.5)"
        if (what == "label") print "Segment0_Name:=tissue\nSegment0_LabelValue:=1\nSegment1_Name:=vein\nSegment1_LabelValue:=2\nSegment2_Name:=gel\nSegment2_LabelValue:=3"
        print ""
        for (n = 0; n < 32 * 16 * 24; n++) {
            x = n % 32 + .5; y = int(n / 32) % 16 + .5; z = int(n / 512) + .5
            air = z > 16 + x / 8
            vein = (x - 16) ^ 2 + (z - 9) ^ 2 < 9
            speckle = (n * 7919) % 9 == 0
            if (what == "grey") print air ? (speckle ? 90 : 10) : vein || (z < 9 && x > 13 && x < 19) ? 5 : speckle ? 3 : 80
            if (what == "label") print air ? (z < 18 + x / 8 ? 3 : 0) : vein ? 2 : 1
            if (what == "sector") print air || x < 6 + z / 4 || (x > 20 && x < 23 && y > 5 && y < 9 && z > 4 && z < 9) ? 0 : 50
        }
    }'
}
for what in grey label sector; do
    image $what >"$T/$what.nrrd"
done
under=$((32 * 16 * 18)) # mm3 below the skin

# ---- all of it
msds-mesh -q --nodes 9x5x7 --like "$T/grey.nrrd" -o "$T/all"
mesh --nodes 9x5x7 --like "$T/grey.nrrd" --mask above:-1
check "where all is tissue, the lattice is as without --mask" sinew diff -q "$T/all" "$T/m"
msds-mesh -q --nodes 9x5x7 --size 4cm,2cm,3cm -o "$T/all"
mesh --nodes 5x3x4 --size 4cm,2cm,3cm --refine 1m
check "where all cells are halved, it is the finer lattice" sinew diff -q "$T/all" "$T/m"
msds-mesh -q --nodes 9x5x13 --size 4cm,2cm,3cm -o "$T/all"
mesh --nodes 3x2x4 --size 4cm,2cm,3cm --refine 1m,1m
check "or halved twice" sinew diff -q "$T/all" "$T/m"

# ---- above a level
# off: how far nodes are from the skin at most where they are above it, and in the mean where x and y are inside and z is that of the uppermost, mm
off() {
    rows node.position | awk '{ d = 1e3 * $3 - 16 - 1e3 * $1 / 8; if (d > most) most = d
            k = int(1e3 * $1 / 4 + .5) " " int(1e3 * $2 / 4 + .5); if (!(k in up) || d > up[k]) up[k] = d }
        END { for (k in up) { sum += up[k] < 0 ? -up[k] : up[k]; n++ } printf "%.2f %.2f", most, sum / n }'
}
mesh --nodes 9x5x7 --like "$T/grey.nrrd" --mask above:40
near "$(volume)" $under .02 "above a level: all below the skin, with the dark vein and its shadow"
read -r most mean <<EOF
$(off)
EOF
below "$most" .6 "no node is above the skin, to half a voxel"
below "$mean" .5 "the uppermost are on it, in the mean"
is "$(get node.rigid.sum "$T/m")" 45 "the bottom is fixed: all of its nodes"
mesh --nodes 9x5x7 --like "$T/grey.nrrd" --mask above:40 --fix zmax
is "$(rows node.rigid | paste - /dev/null | awk '$1 == 1' | wc -l | tr -d ' ')" "$(rows node.position | awk '1e3 * $3 > 15.4 + 1e3 * $1 / 8' | wc -l | tr -d ' ')" \
    "zmax is the skin: each of its nodes"
msds-mesh --nodes 9x5x7 --like "$T/grey.nrrd" --mask above:40 -o "$T/m" 2>"$T/said"
check "it says how many nodes are there" grep -Eq '^msds-mesh: [0-9]+ of [0-9]+ nodes of the skin lie on the border of tissue, moved by at most [0-9.]+ mm$' "$T/said"
msds-mesh -q --nodes 9x5x7 --like "$T/grey.nrrd" --mask above:40 >"$T/a"
check "the same bytes again" cmp "$T/a" "$T/m"
fails 1 "a level above all voxels" "no voxel is tissue" \
    msds-mesh -o "$T/x" --nodes 9x5x7 --like "$T/grey.nrrd" --mask above:255

# ---- labels
mesh --nodes 17x9x13 --like "$T/label.nrrd" --labels "$T/label.nrrd" --mask tissue:tissue,tissue:2
near "$(volume)" $under .02 "two labels"
is "$(rows volume.name | tr '\n' ' ')" '"tissue" "vein" ' "which are the volumes too"
cp "$T/m" "$T/a"
mesh --nodes 17x9x13 --like "$T/label.nrrd" --labels "$T/label.nrrd" --mask air:gel,air:0 2>"$T/warn"
is "$(cat "$T/warn")" "" "labels that are air are not told to be missing"
check "or what is air: the same" sinew diff -q "$T/a" "$T/m"
mesh --nodes 17x9x13 --like "$T/label.nrrd" --labels "$T/label.nrrd" --mask air:0
near "$(volume)" $((under + 32 * 16 * 2)) .02 "gel is tissue where it is not said to be air"
mesh --nodes 17x9x13 --like "$T/label.nrrd" --labels "$T/label.nrrd" --mask tissue:1
near "$(volume)" $((under - 16 * 28)) .02 "without the vein: a hole"
mesh --nodes 17x9x13 --like "$T/grey.nrrd" --labels "$T/label.nrrd" --names 2=vena --mask above:40,air:vena
near "$(volume)" $((under - 16 * 28)) .02 "what several words say; names of --names"

# ---- a sector
mesh --nodes 17x9x13 --like "$T/sector.nrrd" --mask sector
near "$(volume)" "$(image sector | awk 'NR > 9 && $1 == 50 { n++ } END { print n + 2 * 3 * 4 }')" .02 "what a sweep covers, with the hole in it"
near "$(rows node.position | awk '1e3 * $3 < .1 { if (!n++ || $1 < least) least = $1 } END { print 1e3 * least }')" 6 .1 "its side at the border"

# ---- parts
awk 'BEGIN {
    print "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 30 10 20\nencoding: ascii\nspace: LPS"
    print "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (.5,.5,.5)\n"
    for (n = 0; n < 6000; n++) print (n % 30 < 14 || n % 30 > 19)
}' >"$T/parts.nrrd"
mesh --nodes 16x6x11 --like "$T/parts.nrrd" --labels "$T/parts.nrrd" --mask tissue:1 2>"$T/warn"
is "$(cat "$T/warn")" "msds-mesh: warning: left out: 1250 tetrahedra of tissue, in 1 part that no face joins to the rest" "of two slabs, the smaller is left out, with a word"
near "$(volume)" 2800 1e-5 "the larger is meshed"

# ---- where cells are halved
# sides Z: how long the edges along x are at a height, mm
sides() {
    rows node.position | awk -v z="$1" '(1e3 * $3 - z) ^ 2 < 1e-12 && $2 < 1e-9 { print 1e3 * $1 }' | sort -n | awk 'NR > 1 { print $1 - before } { before = $1 }' | sort -u | tr '\n' ' '
}
mesh --nodes 5x3x4 --size 32mm,16mm,24mm --refine 9mm,3mm
is "$(sides 24) $(sides 16) $(sides 8) $(sides 0)" "2  4  4  8 " "finest at the top, coarse below"
near "$(volume)" 12288 1e-5 "they fill the box"
mesh --nodes 5x3x4 --size 32mm,16mm,24mm --refine 9mm,3mm --top zmin
is "$(sides 0) $(sides 8) $(sides 16) $(sides 24)" "2  4  4  8 " "at another side"
is "$(get node.rigid.sum "$T/m")" 15 "and the side opposite is fixed"
mesh --nodes 5x3x4 --size 32mm,16mm,24mm --refine 9mm,3mm --around 0,0,24mm
is "$(sides 24)" "2 4 8 " "or around a place"
msds-mesh --nodes 5x3x4 --size 32mm,16mm,24mm --refine 9mm,3mm -o "$T/m" 2>"$T/said"
check "it says how fine" grep -Fqx 'msds-mesh: cells of 8 x 8 x 8 mm, the finest 2 x 2 x 2 mm' "$T/said"

# ---- both, and what others make of it
mesh --nodes 9x5x7 --like "$T/grey.nrrd" --mask above:40 --refine 4mm
near "$(volume)" $under .02 "cells are halved below the skin"
is "$(rows node.position | awk '1e3 * $1 < .1 && 1e3 * $2 < .1' | wc -l | tr -d ' ')" 6 "where it is: nodes at 16, 14, 12 mm, and 8, 4, 0"
printf '0 .016 .008 .0185 1 0 0 0\n.1 .016 .008 .0165 1 0 0 0\n' >"$T/down.tum"
for method in exact tissue msds; do
    check "msds-run presses it by $method" sh -c "msds-run -q --method $method --probe sphere:6mm --poses '$T/down.tum' -o '$T/pressed' <'$T/m'"
done
check "us-slice slices it" sh -c "us-slice -q --depth 2cm --size 64 -o '$T/s_%d.png' '$T/grey.nrrd' <'$T/pressed'"
us-surface -q -i 40 --level 40 "$T/grey.nrrd" >"$T/skin.obj" 2>/dev/null || printf 'v 16 8 15\nv 20 8 15\nv 16 12 15\nf 1 2 3\n' >"$T/skin.obj"
check "sinew bind binds to it" sh -c "sinew bind -q --unit mm '$T/skin.obj' <'$T/m' >'$T/bound'"
check "sinew render draws it" sinew render -q --size 80x60 -o "$T/m.png" "$T/m"

# ---- smooth borders of labels
awk -v what=labels -f samples/arm.awk >"$T/arm.nrrd"
arm() { # OPTIONS: a vein (volume 1) and an artery
    mesh --nodes 33x11x17 --like "$T/arm.nrrd" --labels "$T/arm.nrrd" --names 1=tissue,2=vein,3=artery,4=bone "$@"
}
# wall: how far the nodes between the vein and others are from its ellipse, from its middle, in the mean and at most, mm
wall() {
    {
        rows node.position
        echo
        rows element.node
        echo
        rows element.volume
    } | awk 'BEGIN { n = 0 } !NF { part++ } part == 0 && NF { x[n] = 1e3 * $1; z[n++] = 1e3 * $3 } part == 1 && NF { t[m++] = $0 }
        part == 2 && NF { c = split(t[i++], of); for (k = 1; k <= c; k++) has[of[k], $1 == 1] = 1 }
        END {
            for (k = 0; k < n; k++) if ((k, 0) in has && (k, 1) in has) {
                d = sqrt((x[k] + 7) ^ 2 + (z[k] + 13) ^ 2) * (1 - 1 / sqrt(((x[k] + 7) / 5) ^ 2 + ((z[k] + 13) / 3.4) ^ 2))
                d = d < 0 ? -d : d
                sum += d; count++; if (d > most) most = d
            }
            printf "%.3f %.3f", sum / count, most }'
}
arm
read -r before before_most <<EOF
$(wall)
EOF
arm --smooth vein,artery
read -r mean most <<EOF
$(wall)
EOF
below "$most" .5 "all nodes of a vein's wall are half a voxel from its ellipse, at most"
below "$mean" "$(awk -v mean="$before" 'BEGIN { print mean / 2 }')" "in the mean less than half as far as without, $before mm"
below 1 "$before_most" "which is more than a voxel at most"
near "$(volume)" 128000 1e-9 "the mesh still fills the box"
cp "$T/m" "$T/a"
arm --smooth 2,3
check "by numbers: the same" sinew diff -q "$T/a" "$T/m"
msds-mesh --nodes 9x5x7 --like "$T/label.nrrd" --labels "$T/label.nrrd" --mask air:gel,air:0 --smooth vein --refine 8mm -o "$T/m" 2>"$T/said"
check "it says how many nodes are there" grep -Eq '^msds-mesh: ([0-9]+) of \1 nodes of smooth borders lie on them, moved by at most [0-9.]+ mm$' "$T/said"
near "$(volume)" $under .02 "with a mask, and halved cells"
near "$(volume 1)" $((16 * 28)) .15 "the vein keeps its volume, about"

# ---- what is refused
no() { # STATUS PATTERN OPTIONS...
    status=$1 pattern=$2
    shift 2
    fails "$status" "refused: $*" "^msds-mesh: $pattern" msds-mesh -o "$T/left" --nodes 5x3x4 "$@"
}
words="expected above:LEVEL, tissue:LABEL, air:LABEL or sector"
no 2 "--mask: '20'; $words" --like "$T/grey.nrrd" --mask 20
no 2 "--mask: 'above:x'; $words" --like "$T/grey.nrrd" --mask above:x
no 2 "--mask: ''; $words" --like "$T/grey.nrrd" --mask sector,
no 2 "--mask: 'sector:1'; $words" --like "$T/grey.nrrd" --mask sector:1
no 2 "--mask: 'air:'; $words" --like "$T/grey.nrrd" --mask air:
no 2 "--mask: above: stands twice" --like "$T/grey.nrrd" --mask above:1,above:2
no 2 "--mask is for --like VOLUME" --size 1,1,1 --mask sector
no 2 "--mask of labels is for --labels VOLUME" --like "$T/grey.nrrd" --mask air:0
no 2 "--mask: unknown label 'gul'; did you mean 'gel'" --like "$T/label.nrrd" --labels "$T/label.nrrd" --mask air:gul
no 2 "--smooth is for --labels VOLUME" --like "$T/grey.nrrd" --smooth vein
no 2 "--smooth: unknown label 'vain'; did you mean 'vein'" --like "$T/label.nrrd" --labels "$T/label.nrrd" --smooth vain
no 2 "--smooth: 'vein' stands twice" --like "$T/label.nrrd" --labels "$T/label.nrrd" --smooth 2,vein
no 1 "$T/label.nrrd: .*memory" --like "$T/grey.nrrd" --labels "$T/label.nrrd" --smooth vein --memory 20kB
no 1 "--mask: no voxel is tissue" --like "$T/label.nrrd" --labels "$T/label.nrrd" --mask tissue:7
no 1 "$T/grey.nrrd: .*memory" --like "$T/grey.nrrd" --mask sector --memory 40kB
no 2 "--around is for --refine" --size 1,1,1 --around 0,0,0
no 2 "--refine: expected depths above 0, each at most the one before" --size 1,1,1 --refine 5mm,15mm
no 2 "--refine: expected depths above 0" --size 1,1,1 --refine 0
no 2 ".*--refine" --size 1,1,1 --refine 7,6,5,4,3,2,1
no 2 ".*--top" --size 1,1,1 --top up
fails 2 "refused for a model of voxels" "--refine is for a mesh of --nodes" msds-mesh --refine 1

# ---- real data
if [ -z "$DATA" ]; then
    skip 3 "no shared data"
    done_testing
fi
us-import -q -o "$T/spine.nrrd" "$DATA/ultrasound/SpinePhantomFreehandReconstructed.mha"
check "a phantom's volume, freehand" msds-mesh --nodes 15x11x11 --like "$T/spine.nrrd" --mask sector --top ymin --refine 1cm -o "$T/m"
share=$(awk -v all="$(volume)" 'BEGIN { print all / (147 * 106 * 104 * .125) }')
near "$share" .3 .3 "a third of its box is what the sweep covers: $share"
check "none is inverted or flat" sh -c "sinew info '$T/m' >'$T/info'"
done_testing
