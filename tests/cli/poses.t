#!/bin/sh
# sinew poses: where a probe stands, on voxels and surfaces, against figures by hand and sums in awk; each motion; the time of
# every pose; what msds-run makes of them; and what is refused.
. "$(dirname "$0")/lib.sh"

# poses PLAN [OPTIONS...]: the plan's lines, with ; between; $T/stdout.
poses() {
    plan=$1
    shift
    printf '%s' "$plan" | tr ';' '\n' >"$T/plan"
    sinew poses -q "$@" "$T/plan" >"$T/stdout" 2>"$T/said"
}
# last: position of the last pose, mm, and its axis z and x, of three digits.
last() {
    tail -n 1 "$T/stdout" | awk '
        function show(v) { v += 0; if (v < 5e-4 && v > -5e-4) v = 0; return sprintf("%.3f", v) }
        {
            x = $5; y = $6; z = $7; w = $8
            print show(1e3 * $2), show(1e3 * $3), show(1e3 * $4), "z", show(2 * (x * z + w * y)), show(2 * (y * z - w * x)), show(1 - 2 * (x * x + y * y)),
                "x", show(1 - 2 * (y * y + z * z)), show(2 * (x * y + w * z)), show(2 * (x * z - w * y))
        }'
}

# ---- where it stands
poses 'at 1mm,2cm,.003 into z'
is "$(last)" "1.000 20.000 3.000 z 0.000 0.000 1.000 x 1.000 0.000 0.000" "at a place, into z: columns along x"
is "$(wc -l <"$T/stdout" | tr -d ' ') $(cut -d ' ' -f 1 "$T/stdout")" "1 0.000000" "one pose, at once"
poses 'at 0,0,0 into -z'
is "$(last)" "0.000 0.000 0.000 z 0.000 0.000 -1.000 x 1.000 0.000 0.000" "into -z"
poses 'at 0,0,0 into x'
is "$(last)" "0.000 0.000 0.000 z 1.000 0.000 0.000 x 0.000 1.000 0.000" "into x: columns along y"
poses 'at 0,0,0 into 0,3,4 columns 0,1,0'
is "$(last)" "0.000 0.000 0.000 z 0.000 0.600 0.800 x 0.000 0.800 -0.600" "columns are made to lie across"
cat >"$T/volume.nhdr" <<'NRRD'
NRRD0004
type: uint8
dimension: 3
space: left-posterior-superior
sizes: 4 5 6
space directions: (0,2,0) (0,0,3) (4,0,0)
space origin: (10,20,30)
encoding: raw
data file: volume.raw
NRRD
head -c 120 /dev/zero >"$T/volume.raw"
poses 'at voxel:1,2,3.5 into k columns -i' --volume "$T/volume.nhdr"
is "$(last)" "24.000 22.000 36.000 z 1.000 0.000 0.000 x 0.000 -1.000 0.000" "on a voxel, along the volume's axes"
printf 'v 0 0 0\nv 10 0 0\nv 10 10 5\nv 0 10 5\nv 20 0 0\nv 20 10 5\nf 1 2 3 4\nf 2 5 6 3\n' >"$T/ramp.obj"
poses 'at surface:4,4,12' --surface "$T/ramp.obj" --unit mm
is "$(last)" "4.000 8.000 4.000 z 0.000 0.447 -0.894 x 1.000 0.000 0.000" "on a slope, against its normal"
poses 'at vertex:3 columns y' --surface "$T/ramp.obj" --unit mm
is "$(last)" "10.000 10.000 5.000 z 0.000 0.447 -0.894 x 0.000 0.894 0.447" "at a vertex"
awk -v boxes='cube 0,10,0,10,0,10,4,4' -f "$(dirname "$0")/boxes.awk" >"$T/cube.obj"
poses 'at surface:20,20,20' --surface "$T/cube.obj" --unit mm
is "$(last | cut -d ' ' -f 1-7)" "10.000 10.000 10.000 z -0.577 -0.577 -0.577" "at a corner, by the mean of its faces"
sed 's/^f \(.*\) \(.*\) \(.*\) \(.*\)$/f \4 \3 \2 \1/' "$T/cube.obj" >"$T/inward.obj"
poses 'at surface:5,5,20' --surface "$T/inward.obj" --unit mm
is "$(last | cut -d ' ' -f 1-7) $(grep -c 'faces inward' "$T/said")" "5.000 5.000 10.000 z 0.000 0.000 -1.000 1" "a closed surface that faces inward is told, and pressed inward"

# ---- what it does
poses 'at 0,0,0 into -z;press 12 .5;hold .25;press -2 .25' --unit mm --rate 40
is "$(wc -l <"$T/stdout" | tr -d ' ') $(tail -n 1 "$T/stdout" | cut -d ' ' -f 1)" "41 1.000000" "a second of 40 poses, and the first"
is "$(awk '{ want = (NR - 1) / 40; if ($1 - want > 1e-6 || want - $1 > 1e-6) bad++ } END { print bad + 0 }' "$T/stdout")" 0 "each at its time"
is "$(awk '{ t = $1; s = t < .5 ? t / .5 : 1; z = 12 * s * s * (3 - 2 * s); if (t > .75) { s = (t - .75) / .25; z = 12 - 2 * s * s * (3 - 2 * s) }
    off = -1e3 * $4 - z; if (off > 1e-5 || off < -1e-5) bad++ } END { print bad + 0 }' "$T/stdout")" 0 "pressed, held and let go of, each slowly at both ends"
poses 'at 0,0,0 into -z;sweep 3,4,1 1' --unit mm
is "$(last)" "3.000 -4.000 -1.000 z 0.000 0.000 -1.000 x 1.000 0.000 0.000" "swept along its own axes"
poses 'at 0,0,0 into z;fan 90 1'
is "$(last)" "0.000 0.000 0.000 z 0.000 -1.000 0.000 x 1.000 0.000 0.000" "fanned about its columns"
poses 'at 0,0,0 into z;rock 90 1'
is "$(last)" "0.000 0.000 0.000 z 1.000 0.000 0.000 x 0.000 0.000 -1.000" "rocked in its image"
poses 'at 0,0,0 into z;turn 450 1'
is "$(last)" "0.000 0.000 0.000 z 0.000 0.000 1.000 x 0.000 1.000 0.000" "turned by more than once round"
poses 'at 0,0,0 into z;turn 720 1' --rate 8
is "$(sed -n 3p "$T/stdout" >"$T/third" && awk '{ printf "%.3f", 2 * atan2($7, $8) }' "$T/third")" "$(awk 'BEGIN { s = .25; printf "%.3f", 4 * atan2(0, -1) * s * s * (3 - 2 * s) }')" "on the way too"
poses 'at 1,2,3 into z;move 5,6,7 into x columns y .5' --unit mm
is "$(last)" "5.000 6.000 7.000 z 1.000 0.000 0.000 x 0.000 1.000 0.000" "moved to another place"
poses 'at 0,0,0 into z;hold .1;at 9,0,0 into z;hold .1' --unit mm --rate 20
is "$(awk '{ printf "%g ", 1e3 * $2 }' "$T/stdout")" "0 0 9 9 9 " "put somewhere else at once"
poses 'at 0,0,0 into z;tremor .5 9;hold 20' --unit mm --rate 100
is "$(awk '{ for (a = 2; a < 5; a++) { x = 1e3 * $a; if (x > .5 + 1e-6 || x < -.5 - 1e-6) bad++; if (x > most[a]) most[a] = x; sum[a] += x; up[a] += last[a] <= 0 && x > 0; last[a] = x } }
    END { for (a = 2; a < 5; a++) { if (most[a] < .49 || sum[a] / NR > .01 || sum[a] / NR < -.01) bad++; off = up[a] - 180 * (a == 2 ? 1 : a == 3 ? .8284 : 1.1547); if (off > 1.5 || off < -1.5) bad++ } print bad + 0 }' "$T/stdout")" 0 "a tremor of its length, at its frequencies"
poses 'at 0,0,0 into z;hold .1 # and that;# is all;;hold .1'
is "$(wc -l <"$T/stdout" | tr -d ' ')" 13 "comments and empty lines"
printf 'at 0,0,0 into z\n' | sinew poses -q >"$T/stdout"
is "$(wc -l <"$T/stdout" | tr -d ' ')" 1 "a plan from standard input"

# ---- with msds-run: the press of a block by hand, and by a plan
msds-mesh -q --nodes 7x7x5 --size 6cm,6cm,4cm --young 5000 >"$T/block"
awk 'BEGIN { for (i = 0; i <= 30; i++) { s = i / 30; printf "%.6f .03 .03 %.9f 1 0 0 0\n", i / 60, .04 - .004 * s * s * (3 - 2 * s) } }' >"$T/hand"
poses 'at 3,3,4 into -z;press 4mm .5' --unit cm
msds-run -q -d cpu --method fem --probe sphere:1cm --poses "$T/hand" <"$T/block" >"$T/one"
msds-run -q -d cpu --method fem --probe sphere:1cm --poses "$T/stdout" <"$T/block" >"$T/other"
check "msds-run presses by the plan as by hand" sinew diff --abs 1e-9 --only node.displacement "$T/one" "$T/other"

# ---- refused
refused() { # NAME PATTERN PLAN [OPTIONS...]
    refused_name=$1 pattern=$2
    shift 2
    poses "$@" -o "$T/none"
    status=$?
    is "$status $(grep -c "$pattern" "$T/said") $(wc -l <"$T/said" | tr -d ' ') $([ -e "$T/none" ] && echo there)" "1 1 1 " "$refused_name: $(cat "$T/said")"
}
refused "nothing" 'no line at PLACE' ''
refused "a motion first" "plan:1: press before the probe is anywhere" 'press 1 1'
refused "no place" 'plan:1: at without a place' 'at'
refused "two lengths" "plan:1: '1,2': expected three lengths" 'at 1,2 into z'
refused "no axis" "expected into AXIS" 'at 0,0,0'
refused "an axis that is none" "'w': expected an axis" 'at 0,0,0 into w'
refused "an axis of no length" "'0,0,0': expected an axis" 'at 0,0,0 into 0,0,0'
refused "columns along it" 'lie along the axis' 'at 0,0,0 into z columns z'
refused "a word too many" "'here': expected at PLACE" 'at 0,0,0 into z here'
refused "a voxel without a volume" "'voxel:1,1,1': expected --volume" 'at voxel:1,1,1 into z'
refused "a voxel outside" 'outside of the volume; expected at most 3,4,5' 'at voxel:4,0,0 into z' --volume "$T/volume.nhdr"
refused "a vertex without a surface" "'vertex:1': expected --surface" 'at vertex:1'
refused "a vertex that is none" 'expected a number from 1 to 6' 'at vertex:7' --surface "$T/ramp.obj" --unit mm
refused "no seconds" "plan:2: 2 words; expected press DEPTH SECONDS" 'at 0,0,0 into z;press 1'
refused "seconds of 0" "plan:2: '0': expected seconds" 'at 0,0,0 into z;hold 0'
refused "an angle that is none" "plan:2: 'x': expected degrees" 'at 0,0,0 into z;fan x 1'
refused "a frequency of 0" "expected a frequency" 'at 0,0,0 into z;tremor 1mm 0'
refused "a word that is none" "unknown word 'fna'; did you mean 'fan'" 'at 0,0,0 into z;fna 1 1'
refused "a plan without end" 'more than 100000000 poses' 'at 0,0,0 into z;hold 1e6' --rate 1e6
refused "a surface without polygons" 'no polygon' 'at vertex:1' --surface /dev/null --unit mm
fails 2 "a surface without its unit" 'an OBJ does not tell its unit' sinew poses --surface "$T/ramp.obj" "$T/plan"
fails 1 "a plan that is not there" 'nowhere' sinew poses "$T/nowhere"
done_testing
