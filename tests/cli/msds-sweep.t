#!/bin/sh
# msds-run between poses: a probe that jumps through a thin slab carries it along, by every method, as one that goes slowly does; it goes
# through free space as ever; a rigid volume stops it, and says where it stands; live, and its replay.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

# A slab of 4 x 4 x .2 cm that is held at its sides, z from 0 to 2 mm; a probe from 3 mm above it to 9 mm below its lower side, in a 60th of a
# second or in 14; then held there.
msds-mesh -q --nodes 17x17x3 --size 4cm,4cm,2mm --young 10000 --poisson .3 --fix xmin,xmax,ymin,ymax -o "$T/slab.sinew"
awk 'BEGIN { for (i = 0; i <= 44; i++) printf "%.7f .02 .02 %.4f 1 0 0 0\n", i / 60, i <= 14 ? .005 - .001 * i : -.009 }' >"$T/slow.tum"
awk 'BEGIN { for (i = 0; i <= 31; i++) printf "%.7f .02 .02 %.4f 1 0 0 0\n", i / 60, i ? -.009 : .005 }' >"$T/jump.tum"

# under FRAMES: how far below its place the lower side is in the middle, mm, in the last of so many frames; and the force up on the probe, N.
under() {
    awk -v last="$1" '/^frame/ { n++ } { if (n <= last && $1 != "end") print } END { print "end" }' "$T/run.sinew" >"$T/some.sinew"
    sinew info --get node.displacement.at.0.02,0.02,0 "$T/some.sinew" | awk '{ printf "%.3f ", -1e3 * $3 }'
    sinew info --tsv probe.force "$T/some.sinew" | awk 'END { printf "%.5f\n", $5 }'
}
for probe in sphere:4mm linear:12mm,6mm; do
    for method in msds fem 'fem --contact penalty' exact warp tissue; do
        # shellcheck disable=SC2086
        check "$method, $probe: slowly" msds-run -q --text --method $method --probe $probe --poses "$T/slow.tum" -o "$T/run.sinew" <"$T/slab.sinew"
        slow=$(under 45)
        # shellcheck disable=SC2086
        check "at once" msds-run -q --text --method $method --probe $probe --poses "$T/jump.tum" -o "$T/run.sinew" <"$T/slab.sinew"
        at_once=$(under 2) held=$(under 32)
        is "$(echo "$at_once" | awk '{ print ($1 > 6) }')" 1 "the slab goes along: $at_once"
        is "$(printf '%s\n%s\n' "$slow" "$held" | awk 'NR == 1 { u = $1; f = $2 } NR == 2 { print ($1 > .95 * u && $1 < 1.05 * u && $2 > 0 && f > 0) }')" 1 \
            "and is held on the same side: $held against $slow"
    done
done

# Through free space there is nothing to sweep: a jump that ends 1 mm above the slab leaves it at rest, and the next
# pose presses it.
echo '0 .02 .02 .5 1 0 0 0
1 .02 .02 .003 1 0 0 0
2 .02 .02 .0018 1 0 0 0' >"$T/air.tum"
msds-run -q --text --method fem --probe sphere:4mm --poses "$T/air.tum" -o "$T/run.sinew" <"$T/slab.sinew"
is "$(sinew info --tsv probe.force "$T/run.sinew" | awk 'NR > 1 { printf "%d ", ($5 > 0) }')" "0 0 1 " "a probe that jumps down touches the slab with the last pose"

# A block of 4 x 4 x 2 cm, rigid below z = 1 cm: the probe stops there, within a hundredth of its size, wherever its poses go.
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 2 2 2' 'space directions: (20,0,0) (0,20,0) (0,0,10)' \
        'kinds: domain domain domain' 'encoding: text' 'space origin: (10,10,5)' 'Segment0_Name:=bone' 'Segment0_LabelValue:=1' 'Segment1_Name:=flesh' \
        'Segment1_LabelValue:=2' '' 1 1 1 1 2 2 2 2
} >"$T/labels.nrrd"
msds-mesh -q --nodes 9x9x9 --like "$T/labels.nrrd" --labels "$T/labels.nrrd" --fix bone -o "$T/bone.sinew"
awk 'BEGIN { for (i = 0; i <= 30; i++) printf "%.7f .02 .02 %.5f 1 0 0 0\n", i / 60, i <= 20 ? .0205 - .0006 * i : .0085 + .0006 * (i - 20) }' >"$T/down.tum"
printf '0 .02 .02 .0205 1 0 0 0\n.1 .02 .02 .002 1 0 0 0\n.2 .021 .02 .001 1 0 0 0\n.3 .02 .02 .0202 1 0 0 0\n' >"$T/plunge.tum"

# heights: of the probe's face, in frames of run.sinew, mm.
heights() {
    sinew info --tsv probe.pose "$T/run.sinew" | awk 'NR > 1 { printf "%.4f\n", 1e3 * $5 }'
}
for probe in sphere:5mm linear:12mm,10mm curved:3cm,40,8mm; do
    check "on bone, $probe" msds-run --text --method tissue --probe $probe --poses "$T/down.tum" -o "$T/run.sinew" <"$T/bone.sinew"
    is "$(grep -c 'down.tum:19: the probe would enter a rigid volume, and stops 0.[1-9][0-9]* mm before its pose$' "$T/stderr") $(grep -c 'would' "$T/stderr") $(
        grep -c 'a rigid volume kept the probe from its pose in 5 of 31 frames, first at 0.3 s$' "$T/stderr")" "1 1 1" "is said once, and at the end how often"
    is "$(heights | awk -v bone=10 '{ want = NR <= 21 ? 20.5 - .6 * (NR - 1) : 8.5 + .6 * (NR - 21); off = $1 - want; low += $1 < bone + .005 * 4
            high += want > bone + .1 && off ^ 2 > 1e-8; there += want < bone && $1 < bone + .06 } END { print low + 0, high + 0, there }')" "0 0 5" \
        "the probe stands on it, and at its poses else"
    check "a plunge, $probe" msds-run --text --method fem --probe $probe --poses "$T/plunge.tum" -o "$T/run.sinew" <"$T/bone.sinew"
    is "$(heights | awk 'NR == 1 || NR == 4 { printf "%.1f ", $1 } NR == 2 || NR == 3 { printf "%d ", ($1 > 10.02 && $1 < 10.06) }')" "20.5 1 1 20.2 " \
        "a jump ends there, and the next leaves it"
done

# Pressed onto bone and moved along it, it slides.
awk 'BEGIN { for (i = 0; i <= 20; i++) printf "%.7f %.4f .02 %.4f 1 0 0 0\n", i / 60, .015 + .0005 * i, i ? .008 : .0205 }' >"$T/slide.tum"
check "along bone" msds-run --text --method fem --probe linear:8mm,6mm --poses "$T/slide.tum" -o "$T/run.sinew" <"$T/bone.sinew"
is "$(sinew info --tsv probe.pose "$T/run.sinew" | awk 'NR > 2 { want = .015 + .0005 * (NR - 2); bad += ($3 - want) ^ 2 > 1e-8 || $5 < .01001 || $5 > .01006 } END { print NR, bad + 0 }')" \
    "22 0" "it is over its poses, to .1 mm, on bone"

# From one side of it to the other, through the air below: it was led around, so nothing moves. At once in bone: it comes down along its axis.
printf '0 -.02 .02 -.03 0 0 0 1\n.1 .02 .02 .05 1 0 0 0\n' >"$T/around.tum"
check "around bone" msds-run --text --method fem --probe sphere:5mm --poses "$T/around.tum" -o "$T/run.sinew" <"$T/bone.sinew"
is "$(sinew info --tsv probe.pose "$T/run.sinew" | awk 'END { print $3, $5 }') $(sinew info --get node.displacement.max "$T/run.sinew")" "0.02 0.05 0" "is where its pose says"
echo '0 .02 .02 .004 1 0 0 0' >"$T/in.tum"
check "in bone at first" msds-run --text --method fem --probe sphere:5mm --poses "$T/in.tum" -o "$T/run.sinew" <"$T/bone.sinew"
is "$(heights | awk '{ print ($1 > 10.02 && $1 < 10.06) }') $(grep -c 'in.tum:1: the probe begins inside the tissue' "$T/stderr") $(
    grep -c 'in.tum:1: the probe would enter a rigid volume' "$T/stderr")" "1 1 1" "is moved in along its axis, to bone"

# A ball that is smaller than the bone is thick, so that its inside is far from any side.
printf '0 .02 .02 .0205 1 0 0 0\n.1 .02 .02 .004 1 0 0 0\n' >"$T/deep.tum"
check "a jump deep into bone" msds-run --text --method fem --probe sphere:1mm --poses "$T/deep.tum" -o "$T/run.sinew" <"$T/bone.sinew"
is "$(heights | awk 'END { print ($1 > 10 && $1 < 10.1) }')" 1 "ends on it"
tail -n 1 "$T/deep.tum" >"$T/begin.tum"
check "deep in bone at first" msds-run --text --method fem --probe sphere:1mm --poses "$T/begin.tum" -o "$T/run.sinew" <"$T/bone.sinew"
is "$(heights | awk 'END { print ($1 > 10 && $1 < 10.1) }')" 1 "is moved in from outside, to bone"

# What is rigid without a volume stops nobody: nodes of a side.
msds-mesh -q --nodes 9x9x5 --size 4cm,4cm,2cm --fix zmin,xmin,xmax -o "$T/floor.sinew"
printf '0 .02 .02 .0205 1 0 0 0\n.1 .02 .02 .015 1 0 0 0\n.2 .02 .02 -.001 1 0 0 0\n' >"$T/floor.tum"
check "through a floor" msds-run --text --method fem --probe sphere:5mm --poses "$T/floor.tum" -o "$T/run.sinew" <"$T/floor.sinew"
is "$(heights | tail -n 1) $(grep -c rigid "$T/stderr")" "-1.0000 0" "the probe goes where it is told"

# Where two sides that are held meet there are tetrahedra of four rigid nodes.
msds-mesh -q --nodes 8x8x4 --size 4cm,4cm,2cm --fix sides,zmin -o "$T/box.sinew"
printf '0 .02 .02 .0205 1 0 0 0\n.1 .02 .02 .015 1 0 0 0\n' >"$T/plate.tum"
check "a plate on a box whose sides are held" msds-run --text --method fem --probe linear:5cm,5cm --poses "$T/plate.tum" -o "$T/run.sinew" <"$T/box.sinew"
is "$(heights | tail -n 1) $(grep -c rigid "$T/stderr")" "15.0000 0" "goes where it is told"

# Live, with the jump and the stop in it, and the record again.
mkfifo "$T/poses"
for method in msds fem exact; do
    rm -f "$T/record"
    msds-run --live --text --method $method --probe sphere:5mm --poses "$T/poses" --record "$T/record" <"$T/bone.sinew" >"$T/live" 2>"$T/said" &
    run=$!
    exec 3>"$T/poses"
    while read -r pose; do
        echo "$pose" >&3
        before=$(grep -c '^frame ' "$T/live") tries=0
        while [ "$(grep -c '^frame ' "$T/live")" -lt $((before + 3)) ] && [ "$tries" -lt 300 ]; do
            sleep .02
            tries=$((tries + 1))
        done
    done <"$T/plunge.tum"
    exec 3>&-
    kill -INT "$run"
    wait "$run"
    check "$method: a replay" msds-run -q --text --replay "$T/record" -o "$T/again" <"$T/bone.sinew"
    grep -v '^prov' "$T/live" >"$T/one"
    grep -v '^prov' "$T/again" | cmp -s - "$T/one"
    is "$? $(awk '/^array probe.pose/ { getline; n += $3 > .01002 && $3 < .01006 } END { print (n > 1) }' "$T/live") $(grep -c 'would enter a rigid' "$T/said")" \
        "0 1 1" "is the live run, which stops at bone"
done
done_testing
