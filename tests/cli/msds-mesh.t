#!/bin/sh
# msds-mesh: counts, where the nodes are, what is fixed, what is of what, over boxes, images and voxel models; what is refused.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

get() { # MODEL KEY
    sinew info --get "$2" "$1"
}
mesh() { # OPTIONS: into $T/m
    msds-mesh -q -o "$T/m" "$@"
}
# rows ARRAY: its rows in $T/m.
rows() {
    sinew export -f model --text "$T/m" | awk -v name="$1" '
        /^[a-z]/ { on = 0 } on { print } $1 == "array" && $2 == name { on = 1 }'
}

# ---- counts, DESIGN's numbers; the edges of tetrahedra are PST's springs.
for want in 5x5x5:125:320:540 20x10x10:2000:7695:10540 24x12x12:3456:13915:18624 28x14x14:5488:22815:30044 32x16x16:8192:34875:45376; do
    nodes=${want%%:*}
    mesh --nodes "$nodes" --size 16cm,8cm,8cm
    is "$(get "$T/m" axis.node):$(get "$T/m" axis.element):$(rows element.node | awk '
        { for (a = 1; a <= 4; a++) for (b = a + 1; b <= 4; b++) edge[$a < $b ? $a " " $b : $b " " $a] }
        END { n = 0; for (e in edge) n++; print n }')" "${want#*:}" "$nodes: nodes, tetrahedra, edges"
done
msds-mesh -q --nodes 32x16x16 --size 16cm,8cm,8cm >"$T/a"
check "the same bytes again" cmp "$T/a" "$T/m"

# ---- where, and of what
mesh --nodes 3x3x3 --size 2cm,4cm,6cm --origin 1,2,3cm
is "$(rows node.position | sed -n '1p;14p;27p' | tr '\n' ';')" \
    "1 2 0.029999999999999999;1.01 2.02 0.059999999999999998;1.02 2.04 0.089999999999999997;" "positions from an origin"
is "$(rows material.law) $(rows material.E) $(rows material.nu) $(rows material.density)" \
    '"linear" 3000 0.45000000000000001 1000' "one material, linear"
mesh --nodes 3x3x3 --size 1,1,1 --young 5e4 --poisson 0.3 --density 950
is "$(rows material.E) $(rows material.nu) $(rows material.density)" "50000 0.29999999999999999 950" "of other values"
check "what was asked for is in the provenance" sh -c "sinew info '$T/m' | grep -q -e '--nodes 3x3x3 --size 1,1,1 --young 50000'"

# ---- what is fixed
fixed() { # LIST WANT
    mesh --nodes 3x4x5 --size 1,1,1 --fix "$1" 2>/dev/null
    is "$(get "$T/m" node.rigid.sum)" "$2" "--fix $1"
}
mesh --nodes 3x4x5 --size 1,1,1
is "$(get "$T/m" node.rigid.sum)" 12 "zmin is fixed where nothing is said"
is "$(rows node.rigid | head -n 12 | sort -u)" 1 "which is the first layer of nodes"
fixed zmax 12
fixed xmin 20
fixed xmin,xmax 40
fixed ymax 15
fixed sides 50
fixed sides,zmin 52
fixed tissue 60
fixed none 0
fails 0 "nothing is fixed: a warning" "no node is fixed: nothing holds the mesh" msds-mesh --nodes 2x2x2 --size 1,1,1 --fix none -o "$T/m"

# ---- labels: 1 in the lower half of x, 2 above, 0 in the lower quarter of z, in an image that is rotated about z.
{
    printf 'NRRD0004\ntype: short\ndimension: 3\nsizes: 8 8 8\nencoding: ascii\nspace: LPS\n'
    printf 'space directions: (0,2,0) (-2,0,0) (0,0,2)\nspace origin: (1,1,1)\n'
    printf 'Segment0_Name:=bone\nSegment0_LabelValue:=1\n\n'
    awk 'BEGIN { for (i = 0; i < 512; i++) print (i >= 128 ? (i % 8 < 4 ? 1 : 2) : 0) }'
} >"$T/labels.nrrd"
printf 'tissue E=1000\nbone E=1e7 nu=0.3\nlabel2 law=neo-hookean\n' >"$T/materials"
mesh --nodes 9x9x9 --like "$T/labels.nrrd" --labels "$T/labels.nrrd" --materials "$T/materials" --fix bone
is "$(get "$T/m" volume.count.tissue) $(get "$T/m" volume.count.bone) $(get "$T/m" volume.count.label2)" "640 960 960" \
    "elements by the label at their centres"
is "$(rows volume.material | tr '\n' ' ')$(rows material.E | tr '\n' ' ')$(rows material.nu | head -n 2 | tr '\n' ' ')" \
    "0 1 2 1000 10000000 3000 0.45000000000000001 0.29999999999999999 " "each of the material of its name; what a file does not say is the option's"
is "$(rows material.law | tr '\n' ' ')" '"linear" "linear" "neo-hookean" ' "and its law"
is "$(get "$T/m" node.rigid.sum)" 315 "all nodes of a volume are fixed: 5 x 9 x 7"
is "$(get "$T/m" meta.source.unit)" mm "what is like an image is in its unit"
is "$(rows node.position | sed -n '1p;729p' | tr '\n' ' ' )" "0.002 0 0 -0.014 0.016 0.016 " \
    "it covers the voxels to their outer faces, in metres, turned with them"
is "$(rows node.rigid | sed -n '163p;171p')" "1
0" "bone is at the beginning of the image's first axis"
mesh --nodes 9x9x9 --like "$T/labels.nrrd" --labels "$T/labels.nrrd" --names 2=vein,1=vein --materials "$T/materials" 2>"$T/warn"
is "$(get "$T/m" volume.count.vein) $(get "$T/m" axis.volume)" "1920 2" "labels of one name are one volume"
is "$(cat "$T/warn")" "msds-mesh: warning: material bone belongs to no volume
msds-mesh: warning: material label2 belongs to no volume" "materials that nothing is of are told"
mesh --nodes 9x9x9 --size 1,1,1 --labels "$T/labels.nrrd" 2>"$T/warn"
is "$(sed 's/ has no tetrahedron, .*//' "$T/warn" | tr '\n' ' ')" \
    "msds-mesh: warning: label 1 (bone) msds-mesh: warning: label 2 " "labels that no tetrahedron has are told"
is "$(rows volume.name | tr '\n' ' ')" '"tissue" ' "outside the image all is tissue"
mesh --nodes 9x9x9 --like "$T/labels.nrrd" --labels "$T/labels.nrrd" --names 7=vein 2>"$T/warn"
is "$(cat "$T/warn")" "msds-mesh: warning: label 7 (vein) is named, but no voxel has this label" "so is a name of no label"
gzip -c "$T/labels.nrrd" | msds-mesh -q --nodes 5x5x5 --like - >"$T/m" && is "$(get "$T/m" axis.element)" 320 "an image from a pipe"

# ---- a voxel model
awk -v r=50 -v n=16 -v g=skin -f tests/cli/sphere.awk >"$T/ball.obj"
voxelise -q --unit mm -s 10 "$T/ball.obj" 2>/dev/null >"$T/hex"
hexes=$(get "$T/hex" axis.element)
msds-mesh -q --fix zmin <"$T/hex" >"$T/m"
is "$(get "$T/m" axis.element) $(get "$T/m" axis.node)" "$((5 * hexes)) $(get "$T/hex" axis.node)" "five tetrahedra a voxel, the same nodes"
is "$(rows node.lattice | awk '$3 == 0 { n++ } END { print n }')" "$(get "$T/m" node.rigid.sum)" "zmin of its lattice is fixed"
is "$(rows material.law)" '"neo-hookean"' "its materials stay"
sinew bind --unit mm "$T/ball.obj" <"$T/hex" 2>/dev/null | msds-mesh -q --fix zmin >"$T/m" 2>"$T/warn"
is "$(cat "$T/warn")" "msds-mesh: warning: surface ball is no longer bound: bind it to the tetrahedra" "a bound surface is told"
check "and can be bound again" sh -c "sinew bind -q --unit mm '$T/ball.obj' <'$T/m' >'$T/bound'"
printf 'tissue E=7000\n' >"$T/seven"
msds-mesh -q --materials "$T/seven" --fix zmin <"$T/hex" >"$T/m"
is "$(rows material.E)" 7000 "a file changes its materials"

# ---- what others make of it
mesh --nodes 5x5x5 --size 10cm,10cm,10cm --fix zmax
check "sinew export writes it for CalculiX" sinew export -f inp -g 0,0,-9.81 -o "$T/m.inp" "$T/m"
is "$(grep -c -e 'TYPE=C3D4' -e '^\*ELASTIC' -e NLGEOM "$T/m.inp")" 2 "linear: C3D4 and *ELASTIC, and no large deformation"
if have ccx; then
    check "CalculiX solves it" sh -c "cd '$T' && ccx -i m >log && grep -q 'Job finished' log"
    near "$(awk '$1 == 63 && NF == 4 { print $4 }' "$T/m.dat")" "$(awk '$1 == 13 && NF == 4 { print $4 / 2 }' "$T/m.dat")" 0.7 \
        "and what hangs goes down"
else
    skip 2 "no CalculiX (calculix-ccx)"
fi
printf 'tissue law=linear\n' >"$T/linear"
voxelise -q --unit mm -s 10 --materials "$T/linear" "$T/ball.obj" 2>/dev/null | attach -q 2>/dev/null >"$T/m"
fails 1 "tled-run has no such law" "volume 'skin' has the law 'linear'; expected neo-hookean" sh -c "tled-run -n 1 <'$T/m' >'$T/x'"

# ---- what is refused
no() { # STATUS PATTERN OPTIONS...
    status=$1 pattern=$2
    shift 2
    rm -f "$T/left"
    fails "$status" "refused: $*" "^msds-mesh: $pattern" msds-mesh -o "$T/left" "$@"
    [ ! -e "$T/left" ] || not_ok "no output is left by it"
}
no 2 "--nodes '5x5': expected NXxNYxNZ" --nodes 5x5 --size 1,1,1
no 2 "--nodes '5x5x5x5': expected" --nodes 5x5x5x5 --size 1,1,1
no 2 "--nodes '1x5x5': expected .* each 2 or more" --nodes 1x5x5 --size 1,1,1
no 2 "--nodes '5x5x9999999999999999': expected" --nodes 5x5x9999999999999999 --size 1,1,1
no 1 "2000x2000x2000 nodes are more than can be numbered" --nodes 2000x2000x2000 --size 1,1,1
no 2 "no place for the mesh; expected --size X,Y,Z or --like VOLUME" --nodes 5x5x5
no 2 "--size and --like both" --nodes 5x5x5 --size 1,1,1 --like x.nrrd
no 2 "--origin and --like both" --nodes 5x5x5 --origin 1,1,1 --like x.nrrd
no 2 "--size: expected three lengths above 0" --nodes 5x5x5 --size 1,0,1
no 2 ".*--poisson" --nodes 5x5x5 --size 1,1,1 --poisson 0.5
no 2 ".*--young" --nodes 5x5x5 --size 1,1,1 --young 0
no 2 ".*--density" --nodes 5x5x5 --size 1,1,1 --density nan
no 2 "--names is for --labels" --nodes 5x5x5 --size 1,1,1 --names 1=a
no 2 "--names: '1'; expected LABEL=NAME" --nodes 5x5x5 --size 1,1,1 --labels "$T/labels.nrrd" --names 1
no 2 "--young is for a mesh of --nodes" --young 5
no 2 "--like - and --labels -: standard input is read once" --nodes 5x5x5 --like - --labels -
no 2 "--names: label 1 is named twice" --nodes 5x5x5 --size 1,1,1 --labels "$T/labels.nrrd" --names 1=a,2=b,1=c
no 2 "--fix: unknown side or volume 'zmim'; did you mean 'zmin'" --nodes 5x5x5 --size 1,1,1 --fix zmim
no 2 "--fix: unknown side or volume ''" --nodes 5x5x5 --size 1,1,1 --fix xmin,
no 1 "$T/none.nrrd: cannot open" --nodes 5x5x5 --like "$T/none.nrrd"
no 1 "no model on stdin \(0 bytes\)"
printf 'NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 1 1 1.5 1 1 1 1\n' >"$T/half.nrrd"
no 1 "$T/half.nrrd: voxel 3 is 1.5; expected labels, which are whole numbers" --nodes 5x5x5 --like "$T/half.nrrd" --labels "$T/half.nrrd"
printf 'NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\nspacings: 1 -1 1\nencoding: ascii\n\n' >"$T/minus.nrrd"
no 1 "$T/minus.nrrd:5: spacings: '-1'; expected a distance above 0" --nodes 5x5x5 --like "$T/minus.nrrd"
printf 'tissue nu=0.5\n' >"$T/half"
no 1 "$T/half:1: 'nu=0.5' is not allowed" --nodes 5x5x5 --size 1,1,1 --materials "$T/half"
mesh --nodes 3x3x3 --size 1,1,1
fails 1 "a mesh of tetrahedra is not cut again" "the model's elements have 4 nodes; expected hexahedra" sh -c "msds-mesh <'$T/m' >'$T/x'"

is "$(msds-mesh --table mdoc)" "$(sed -n '/^\.\\" synopsis$/,/^\.\\" end synopsis$/{/^\.\\"/!p;}' man/msds-mesh.1)" \
    "the manual's synopsis is the table's"
done_testing
