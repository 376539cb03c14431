#!/bin/sh
# The same bytes from 1, 2, 3 and 8 threads, and again and again: every tool that has --threads, on small models whose loops are cut into several
# chunks all the same. REPEATS says how often (SINEW_LONG: 100). make tsan runs this under ThreadSanitizer too.
. "$(dirname "$0")/lib.sh"

repeats=${REPEATS:-${SINEW_LONG:+100}}
repeats=${repeats:-1}
long=${SINEW_SANITIZED:+1}

# A sphere of tissue about a ball of bone, with a muscle; a block of tetrahedra with a vein; a volume.
if [ -n "$long" ]; then size=6 nodes=9x9x5; else size=4 nodes=13x13x9; fi
{
    awk -v r=50 -v n=24 -v g=skin -f tests/cli/sphere.awk
    awk -v r=20 -v n=16 -v g=skull -f tests/cli/sphere.awk | awk -v from=$((2 + 23 * 48)) '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } 1'
    awk -v r=14 -v n=12 -v g=muscle_a -f tests/cli/sphere.awk |
        awk -v from=$((2 + 23 * 48 + 2 + 15 * 32)) '$1 == "f" { for (i = 2; i <= NF; i++) $i += from } $1 == "v" { $2 += 28 } 1'
} >"$T/ball.obj"
voxelise -q --unit mm -s "$size" --fraction 3 -o "$T/voxels" "$T/ball.obj"
attach -q -o "$T/ball" <"$T/voxels"
voxelise -q --unit mm -s "$size" "$T/ball.obj" | attach -q -o "$T/whole"
msds-mesh -q --nodes "$nodes" --size 12cm,12cm,8cm -o "$T/block"
printf '0 0.06 0.06 0.09 0 1 0 0\n0.1 0.06 0.06 0.078 0 1 0 0\n0.2 0.06 0.07 0.074 0 1 0 0\n' >"$T/poses"
printf '0 0 0 0.052 0 1 0 0\n0.02 0 0 0.044 0 1 0 0\n' >"$T/onto"
awk 'BEGIN { print "NRRD0004\ntype: uchar\ndimension: 3\nspace: LPS\nsizes: 24 24 16\nspace directions: (5,0,0) (0,5,0) (0,0,5)\nencoding: ascii\n"
    for (i = 0; i < 24 * 24 * 16; i++) print (i * 7919) % 251 }' >"$T/volume.nrrd"
msds-run -q -d cpu --probe linear:4cm,2.5cm --poses "$T/poses" -o "$T/pressed" <"$T/block"

# many NAME INPUT COMMAND...: with --threads N, N one of four in turn, as often as REPEATS says.
many() {
    name=$1 input=$2
    shift 2
    "$@" --threads 1 <"$input" >"$T/first" 2>"$T/stderr" || {
        not_ok "$name runs"
        diag_file "$T/stderr"
        return
    }
    differ=0
    i=0
    while [ "$i" -lt "$repeats" ]; do
        for threads in 2 3 8 1; do
            "$@" --threads "$threads" <"$input" >"$T/again" 2>"$T/stderr" && cmp -s "$T/first" "$T/again" || differ=$((differ + 1))
        done
        i=$((i + 1))
    done
    is "$differ of $((4 * repeats)) differ, $(($(wc -c <"$T/first") > 100))" "0 of $((4 * repeats)) differ, 1" \
        "$name: the same bytes for 1, 2, 3 and 8 threads, $repeats times each"
    [ "$differ" -eq 0 ] || diag_file "$T/stderr"
}

many "voxelise, by centres" /dev/null voxelise -q --unit mm -s "$size" "$T/ball.obj"
many "voxelise, by shares" /dev/null voxelise -q --unit mm -s "$size" --fraction 3 "$T/ball.obj"
many "attach, to centres" "$T/voxels" attach -q
many "attach, along a field" "$T/voxels" attach -q --fibre field
many "bind" "$T/ball" sinew bind -q "$T/ball.obj"
many "tled-run, double" "$T/whole" tled-run -q -d cpu -c a=0.4 -g 0,0,-9.81 -n 40 --every 0.01
many "tled-run, single" "$T/whole" tled-run -q -d cpu --precision single -c a=0.4 -g 0,0,-9.81 -n 40
many "tled-run, of shares" "$T/ball" tled-run -q -d cpu -c a=0.2 -n 40
many "tled-run, pressed by a probe" "$T/whole" tled-run -q -d cpu --probe sphere:2cm --poses "$T/onto" -t 0.02
# A card has as many threads as it likes; here --threads counts for nothing, and each run is one more.
if tled-run -q -d cuda -n 1 <"$T/whole" >"$T/first" 2>"$T/stderr"; then
    many "tled-run, on a card, double" "$T/whole" tled-run -q -d cuda -c a=0.4 -n 40
    many "tled-run, on a card, single" "$T/ball" tled-run -q -d cuda --precision single -c a=0.2 -n 40
    many "msds-run, springs on a card" "$T/block" msds-run -q -d cuda --probe linear:4cm,2.5cm --poses "$T/poses"
    many "msds-run, FEM on a card" "$T/block" msds-run -q -d cuda --method fem --probe linear:4cm,2.5cm --poses "$T/poses"
else
    skip 4 "no card"
fi
many "msds-run, springs" "$T/block" msds-run -q -d cpu --probe linear:4cm,2.5cm --poses "$T/poses"
many "msds-run, FEM" "$T/block" msds-run -q -d cpu --method fem --probe linear:4cm,2.5cm --poses "$T/poses"
many "msds-run, FEM, warped" "$T/block" msds-run -q -d cpu --method fem --warp --probe linear:4cm,2.5cm --poses "$T/poses"
many "msds-run, exact" "$T/block" msds-run -q -d cpu --method fem --exact --probe linear:4cm,2.5cm --poses "$T/poses"
many "us-slice" "$T/pressed" us-slice -q --probe linear:4cm,2.5cm --depth 4cm --size 120x100 --thickness 3mm,3 "$T/volume.nrrd"
many "sinew render" "$T/ball" sinew render -q --size 120x100
done_testing
