# shellcheck shell=sh
# Blocks of tissue that are pulled, for the tests of laws and muscles in tled-run and CalculiX.

# block NX NY NZ H ARGS...: a block with the corner at the origin.
block() {
    nx=$1 ny=$2 nz=$3 h=$4
    shift 4
    awk -v nx="$nx" -v ny="$ny" -v nz="$nz" -v h="$h" "$@" -f tests/cli/block.awk
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
# same_by_sets THREADS NAME MODEL ARG...: tled-run of $T/MODEL writes the same bytes by each instruction set, on each number of
# threads. The last of them stays in $T/same.
same_by_sets() {
    numbers=$1 what=$2 model=$3
    shift 3
    first=
    for set in plain AVX2 AVX-512; do
        for threads in $numbers; do
            run="$what, $model, $set, $threads threads"
            SINEW_VECTORS=$set tled-run -q --text -d cpu --threads "$threads" "$@" <"$T/$model" >"$T/by" 2>"$T/said"
            if grep -q SINEW_VECTORS "$T/said"; then
                skip 1 "$run: this processor cannot"
                continue
            fi
            mv "$T/by" "$T/same"
            sum=$(sed -n '/^frame/,$p' "$T/same" | cksum)
            grep -q '^frame' "$T/same" || sum="$run has none"
            is "$sum" "${first:=$sum}" "$run: the same bytes"
        done
    done
}

# refuse_bar NAME WANTED ARG...: tled-run of $T/bar ends with this status and says this.
refuse_bar() {
    name=$1 wanted=$2
    shift 2
    tled-run -q -d cpu -n 1 "$@" <"$T/bar" >"$T/out" 2>"$T/said"
    is "$? $(cat "$T/said")" "$wanted" "$name"
}
# below VALUE LIMIT NAME
below() {
    is "$(awk -v a="$1" -v b="$2" 'BEGIN { print (a < b) }')" 1 "$3: $1"
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
