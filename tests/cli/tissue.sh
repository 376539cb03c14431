# shellcheck shell=sh
# Blocks of tissue that are pulled, for the tests of laws in tled-run and CalculiX.

# block NX NY NZ H ARGS...: a block with the corner at the origin.
block() {
    awk -v nx="$1" -v ny="$2" -v nz="$3" -v h="$4" -f tests/cli/block.awk
}
# of LAW KEY=VALUE...: options for such tissue.
of() {
    echo "-m tissue.law=$1"
    shift
    for pair in "$@"; do
        echo "-m tissue.$pair"
    done
}
# Planes of symmetry.
planes='0 displace -1,-1,-1,0,1,1 0,-,-
0 displace -1,-1,-1,1,0,1 -,0,-
0 displace -1,-1,-1,1,1,0 -,-,0'
# bar PRESSURE: a script that pulls the end of a bar of 40 x 10 x 10 mm.
bar() {
    echo "$planes"
    echo "0 force 0.04,0.005,0.005 0.008 $(awk -v p="$1" 'BEGIN { printf "%.9g", p * 1e-4 }'),0,0"
}
# stretched FILE: of a bar, its length and its side, as shares of those at rest.
stretched() {
    sinew info --get node.displacement.at.0.04,0.01,0.01 "$1" | awk '{ printf "%.7f %.7f", 1 + $1 / 0.04, 1 + $2 / 0.01 }'
}
# calculix HYPERELASTIC CONSTANTS STRETCH: the force (N) that pulls a cube of 1 m so far, by one C3D8 of CalculiX.
calculix() {
    cat >"$T/cube.inp" <<X
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
*ELEMENT, TYPE=C3D8, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=M
*HYPERELASTIC, $1
$2
*SOLID SECTION, ELSET=E, MATERIAL=M
*NSET, NSET=X0
1, 4, 5, 8
*NSET, NSET=X1
2, 3, 6, 7
*NSET, NSET=Y0
1, 2, 5, 6
*NSET, NSET=Z0
1, 2, 3, 4
*BOUNDARY
X0, 1, 1
Y0, 2, 2
Z0, 3, 3
*STEP, NLGEOM, INC=100
*STATIC
0.1, 1
*BOUNDARY
X1, 1, 1, $(awk -v s="$3" 'BEGIN { print s - 1 }')
*NODE PRINT, NSET=X1, TOTALS=ONLY
RF
*END STEP
X
    (cd "$T" && ccx -i cube >ccx.log)
    awk '/total force/ { getline; getline; x = $1 } END { print x + 0 }' CONVFMT=%.9g OFMT=%.9g "$T/cube.dat"
}
