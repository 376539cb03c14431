#!/bin/sh
# Rigid bodies: what attach --part makes of rigid nodes, how tled-run moves them, by scripts, files of poses and live
# lines, what it says of forces on them, and what is drawn of surfaces that go with them.
. "$(dirname "$0")/lib.sh"

# A cube of 20 mm in 4 x 4 x 4 voxels: skull_low holds it at x = 0, skull_top at z = 20 mm.
{
    printf 'v %s\n' '0 0 0' '20 0 0' '20 20 0' '0 20 0' '0 0 20' '20 0 20' '20 20 20' '0 20 20'
    printf 'g skin\nf 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n'
    printf 'g skull_low\nf 4 1 5 8\ng skull_top\nf 5 6 7 8\n'
} >"$T/cube.obj"
voxelise -q --unit mm -s 5 "$T/cube.obj" >"$T/voxels"
box() { # X0 Y0 Z0 X1 Y1 Z1, mm: a closed box as OBJ
    awk -v b="$*" 'BEGIN { split(b, a, " ")
        for (i = 0; i < 8; i++)
            print "v", a[1 + 3 * (i % 2)], a[2 + 3 * (int(i / 2) % 2)], a[3 + 3 * int(i / 4)]
        print "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6" }'
}
get() { # KEY FILE
    sinew info --get "$1" <"$2"
}
sum() { # COLUMN "A B C"
    echo "$2" | cut -d ' ' -f "$1"
}

# Which nodes
attach -q --rigid skull_top --part lid=skull_top <"$T/voxels" >"$T/lid"
is "$(get body.name.lid "$T/lid") $(get axis.body "$T/lid")" "lid 1" "a body has its name"
is "$(get node.body.max "$T/lid") $(get node.rigid.sum "$T/lid")" "0 25" "its nodes are the surface's"
near "$(sum 3 "$(get body.centre "$T/lid")")" .02 1e-12 "the mean of its nodes"
attach -q --part 'top=SKULL_T*' --part low=skull_low <"$T/voxels" >"$T/two"
is "$(get node.body.sum "$T/two")" "-55" "of two surfaces the first that holds a node has it; names may have a *"
box -1 -1 12 30 30 30 >"$T/upper.obj"
box -1 -1 -1 30 30 9 >"$T/lower.obj"
attach -q --part "upper=$T/upper.obj" --part "lower=$T/lower.obj" <"$T/voxels" >"$T/cut"
is "$(sinew info --get node.body.sum <"$T/cut")" "-65" "closed files: nodes inside of one, and near it, each the nearest"
attach -q --text --anonymous-names --part "upper=$T/upper.obj" <"$T/voxels" >"$T/anonymous"
check "provenance has no name of a file" grep -q -- '--part upper=FILE' "$T/anonymous"
check "or its base only" sh -c "attach -q --text --part 'upper=$T/upper.obj' <'$T/voxels' | grep -q -- '--part upper=upper.obj'"
attach -q --rigid skull_top --part lid=skull_top --text <"$T/voxels" >"$T/text"
check "text and binary are twins" sinew diff "$T/lid" "$T/text"
attach -q <"$T/lid" >"$T/again"
attach -q <"$T/voxels" >"$T/plain"
fails 1 "without --part no body stays" 'no key' sinew info --get body.name.lid "$T/again"

# What is refused
sed '$d' "$T/upper.obj" >"$T/open.obj"
printf 'v 0 0 0\n' >"$T/none.obj"
box 50 50 50 60 60 60 >"$T/far.obj"
refuse_part() { # NAME STATUS PATTERN PART...
    refuse_name=$1 refuse_status=$2 refuse_pattern=$3
    shift 3
    for refuse_part; do
        shift
        set -- "$@" --part "$refuse_part"
    done
    "$SINEW_BIN/attach" -q "$@" <"$T/voxels" >"$T/stdout" 2>"$T/stderr"
    is "$? $(grep -Ec -e "$refuse_pattern" "$T/stderr")" "$refuse_status 1" "$refuse_name: $(head -n 1 "$T/stderr")"
}
refuse_part "an open part" 1 "^attach: --part: .*open.obj is not closed: 4 open edges, the first at" "jaw=$T/open.obj"
refuse_part "no polygons" 1 "none.obj has no polygons; expected a closed surface" "jaw=$T/none.obj"
refuse_part "no file" 1 "missing.obj" "jaw=$T/missing.obj"
refuse_part "no node" 1 "'jaw' has no rigid node; expected bone of it that holds tissue" "jaw=$T/far.obj"
refuse_part "shared nodes" 1 "'a' and 'b' share 20 rigid nodes, the first at 5mm,0mm,20mm; expected parts that lie apart" 'a=skull_t*' b=skull_top
refuse_part "shared by a file" 1 "'a' and 'b' share 20 rigid nodes" a=skull_top "b=$T/upper.obj"
refuse_part "an unknown surface" 2 "unknown rigid surface 'skull_tip'; did you mean 'skull_top'" jaw=skull_tip
refuse_part "one of two" 2 "unknown rigid surface 'skull_lid'; did you mean 'skull_low'" jaw=skull_top,skull_lid
refuse_part "no name between commas" 2 "unknown rigid surface ''" jaw=skull_top,,skull_low
refuse_part "no name" 2 "expected NAME=SURFACE,... or NAME=FILE.obj, such as jaw=skull_jaw" =skull_top
refuse_part "no surface" 2 "expected NAME=SURFACE" jaw=
refuse_part "a blank" 2 "expected NAME=SURFACE" 'my jaw=skull_top'
refuse_part "twice" 2 "'jaw' is named twice" jaw=skull_top jaw=skull_low

# A turn of 30 degrees
run() { # SCRIPT [ARG...] on $T/lid: the result in $T/out
    printf '%s' "$1" >"$T/script"
    shift
    tled-run -q --script "$T/script" "$@" <"$T/lid" >"$T/out" 2>"$T/stderr" || diag_file "$T/stderr"
}
turn='0 move lid 0,0,0 0,0,0,1 about 1cm,1cm,2cm
0.1 move lid 1mm,0,2mm 0.25881904510252074,0,0,0.96592582628906829 about 1cm,1cm,2cm
'
run "$turn" --rest 1e-9 --log "$T/log" --log-every .0005
u=$(get node.displacement.at.2cm,2cm,0 "$T/out") # from the point: 10, 10, -20 mm
near "$(sum 1 "$u")" .001 1e-8 "all turns with the face that holds it: x"
near "$(sum 2 "$u")" "$(awk 'BEGIN { a = atan2(0, -1) / 6; printf "%.15g", .01 * cos(a) + .02 * sin(a) - .01 }')" 1e-7 "y"
near "$(sum 3 "$u")" "$(awk 'BEGIN { a = atan2(0, -1) / 6; printf "%.15g", .01 * sin(a) - .02 * cos(a) + .022 }')" 1e-7 "z"
column() { # NAME of $T/log: its values
    awk -F '\t' -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i } NR > 1 { print $at }' "$T/log"
}
worst() { # the largest size of standard input
    awk '{ x = $1 < 0 ? -$1 : $1; if (x > most) most = x } END { printf "%.9g", most }'
}
last=$(column strain/J | tail -n 1)
is "$(awk -v w="$last" 'BEGIN { print (w < 0 ? -w : w) < 1e-9 * 3000 * 8e-6 }')" 1 "and has no strain energy at rest: $last J"
near "$(column balance/J | worst)" 0 "$(column displaced/J | awk '{ most = $1 > most ? $1 : most } END { print 2e-3 * most }')" "the energy balance closes to 0.2 % of the work"
near "$(sum 4 "$(get body.pose "$T/out")")" .25881904510252074 1e-12 "the frame has its turn"
p=$(get body.pose.lid "$T/out")
near "$(sum 1 "$p")" .001 1e-9 "and its place"
is "$(sinew info --get body.pose.unit --get body.force.unit --get body.torque.unit <"$T/out" | tr '\n' ' ')" "1 N N.m " "units"

cp "$T/out" "$T/binary"

# A surface of the body, whose vertices are at no node
printf 'v 7 6 20\nv 13 6.5 20\nv 9 12 20\nvn 0 0 1\ng skull_top\nf 1//1 2//1 3//1\n' >"$T/plate.obj"
sinew bind -q "$T/plate.obj" <"$T/binary" >"$T/plate"
sinew deform -q "$T/plate.obj" <"$T/plate" >"$T/got"
sinew export -q -f obj --deformed --surface plate -o "$T/exported" "$T/plate"
awk '$1 == "v" { a = atan2(0, -1) / 6; n++
    off = off || ($2 - x[n]) ^ 2 + ($3 - 10 - y[n] * cos(a)) ^ 2 + ($4 - 22 - y[n] * sin(a)) ^ 2 > 1e-14 }
    $1 == "vn" { off = off || ($3 + sin(a)) ^ 2 + ($4 - cos(a)) ^ 2 > 1e-14 }
    BEGIN { x[1] = 8; y[1] = -4; x[2] = 14; y[2] = -3.5; x[3] = 10; y[3] = 2; a = atan2(0, -1) / 6 }
    END { print n, off }' "$T/got" >"$T/off"
grep '^v ' "$T/got" >"$T/moved"
grep '^v ' "$T/exported" | paste -d ' ' "$T/moved" - | awk '{ print ($2 - $6) ^ 2 + ($3 - $7) ^ 2 + ($4 - $8) ^ 2 < 1e-14 }' | tr -d '\n' >"$T/same"
is "$(cat "$T/same")" 111 "sinew export has the same"
is "$(cat "$T/off")" "3 0" "its vertices and its normal turn with it, to 1e-7 mm"
run "$turn" --rest 1e-9 --text
check "text and binary frames are twins" sinew diff "$T/binary" "$T/out"

# Half way between two keys
run "$turn" -t 0.05 --every 0.025
half=$(get node.displacement.at.0,2cm,2cm "$T/out")
near "$(sum 2 "$half")" "$(awk 'BEGIN { a = atan2(0, -1) / 12; printf "%.15g", .01 * (cos(a) - 1) }')" 1e-9 "half way is 15 degrees: y"
near "$(sum 3 "$half")" "$(awk 'BEGIN { a = atan2(0, -1) / 12; printf "%.15g", .01 * sin(a) + .001 }')" 1e-9 "z"
v=$(get node.velocity.at.0,2cm,2cm "$T/out")
near "$(sum 3 "$v")" "$(awk 'BEGIN { a = atan2(0, -1) / 12; printf "%.15g", .01 * cos(a) * 20 * a + .02 }')" 5e-3 "velocities are those of the turn: z"

# A weight
tled-run -q -g 0,0,-9.81 --rest 1e-9 <"$T/lid" >"$T/hung"
near "$(sum 3 "$(get body.force.lid "$T/hung")")" -0.07848 1e-6 "at rest the body bears the weight"
near "$(sum 1 "$(get body.force.lid "$T/hung")")" 0 1e-12 "and nothing aside"
attach -q --part top=skull_top --part low=skull_low <"$T/voxels" | tled-run -q -g 0,0,-9.81 --rest 1e-9 >"$T/both"
near "$(get body.force.sum "$T/both" | cut -d ' ' -f 3)" -0.07848 1e-6 "two bodies bear it together"
tled-run -q -g 0,0,-9.81 --rest 1e-9 -d cpu --precision single <"$T/lid" >"$T/single" 2>"$T/stderr" ||
    tled-run -q -g 0,0,-9.81 --rest 1e-4 -d cpu --precision single <"$T/lid" >"$T/single"
near "$(sum 3 "$(get body.force.lid "$T/single")")" -0.07848 1e-3 "in single precision too"
awk -v nx=4 -v ny=2 -v nz=2 -v h=0.005 -v held=low -v muscle=1 -f tests/cli/block.awk |
    sed '$d' >"$T/muscle"
{
    cat "$T/muscle"
    printf 'axis body 1\narray body.name str 1 body 1\n"base"\narray body.centre f64 m body 3\n0 0.005 0.005\n'
    echo 'array node.body i32 @body node 1'
    awk -v n=45 'BEGIN { for (i = 0; i < n; i++) print i % 5 ? -1 : 0 }'
    echo end
} >"$T/based"
tled-run -q -c all=0.3 --rest 1e-8 <"$T/based" >"$T/out"
near "$(sum 1 "$(get body.force.base "$T/out")")" 0 1e-7 "a muscle that is free at its other end pulls at nothing"
printf '0 displace 2cm,0,0,2cm,1,1 0,-,-\n0 contract all 0\n0.1 contract all 0.3\n' >"$T/script"
tled-run -q --script "$T/script" --rest 1e-8 <"$T/based" >"$T/out"
is "$(awk -v f="$(sum 1 "$(get body.force.base "$T/out")")" 'BEGIN { print (f > .1 * .3 * 30000 * 1e-4) }')" 1 "one that is held there pulls its base toward itself"
pulls=$(sum 1 "$(get body.force.base "$T/out")")
tled-run -q -m tissue.vmax=10 --script "$T/script" -t .4 --log "$T/log" <"$T/based" >"$T/out"
near "$(sum 1 "$(get body.force.base "$T/out")")" "$pulls" 1e-3 "and by as much once it no longer moves, where its force depends on velocity"
near "$(awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^body.force.base.x/) at = i } END { print $at }' "$T/log")" "$pulls" 1e-3 "as its log says"

# Files of poses, records, checkpoints
printf '%s' "$turn" | sed 's/ about.*//; s/0\.1 move lid 1mm/0.1 move lid 0.001/; s/,2mm/,0.002/' >"$T/script"
tled-run -q --script "$T/script" -t 0.12 --every 0.02 <"$T/lid" >"$T/by-script"
tr ',' ' ' <"$T/script" | awk '{ $2 = $1; $1 = "lid"; $3 = ""; print }' >"$T/poses"
tled-run -q --rigid-poses "$T/poses" -t 0.12 --every 0.02 <"$T/lid" >"$T/by-poses"
check "a file of poses does what a script does" sinew diff "$T/by-script" "$T/by-poses"
printf 'volume move=1,0,0 turn=0,0,0.7071067811865476,0.7071067811865476\n' >"$T/body"
printf 'lid 0 0 0 0 0 0 0 1\nlid 0.1 0 0.003 0 0 0 0 1\n' >"$T/poses"
tled-run -q --rigid-poses "$T/poses" --body "$T/body" -t 0.12 <"$T/lid" >"$T/out"
near "$(sum 1 "$(get body.pose "$T/out")")" .003 1e-12 "poses may be in the frame of a body, where y is the model's x"
check "a run that is continued" sh -c "tled-run -q --script '$T/script' -t 0.05 <'$T/lid' |
    tled-run -q --script '$T/script' -t 0.07 >'$T/two-runs'"
tled-run -q --script "$T/script" -t 0.12 <"$T/lid" >"$T/one-run"
is "$(get node.displacement.row.3 "$T/two-runs")" "$(get node.displacement.row.3 "$T/one-run")" "moves the body as one run does"
# A run that is killed while the body moves
printf '0 move lid 0,0,0 0,0,0,1\n40 move lid 0,0,1mm 0.6,0,0,0.8\n' >"$T/script"
tled-run -q -d cpu --script "$T/script" -t 40 --every 1 <"$T/lid" >"$T/want"
tled-run -q -d cpu --script "$T/script" -t 40 --every 1 --checkpoint "$T/state" --checkpoint-every 0.05 -o "$T/got" <"$T/lid" &
for _ in 1 2 3 4 5 6 7 8 9 10; do
    [ -s "$T/state.frames" ] && break
    sleep 0.05
done
kill -KILL $!
wait $! 2>/dev/null
if [ -f "$T/state" ]; then
    fails 1 "a checkpoint knows how bodies move" 'belongs to another run: script differs' \
        sh -c "mkdir '$T/other'; sed 's/0.6,0,0,0.8/0.8,0,0,0.6/' '$T/script' >'$T/other/script'
            tled-run -q -d cpu --script '$T/other/script' -t 40 --every 1 --restart '$T/state' -o '$T/got' <'$T/lid'"
    check "the run goes on" sh -c "tled-run -q -d cpu --script '$T/script' -t 40 --every 1 --restart '$T/state' -o '$T/got' <'$T/lid'"
    check "to the same bytes" cmp "$T/want" "$T/got"
else
    skip 3 "the run was over before it was killed"
fi

# Live lines, and their record
{
    cat "$T/lid"
    sleep 0.1
    echo 'now move lid 0,0,1mm 0.1,0,0,0.99498743710662 about 0,0,2cm'
    echo 'now move lip 0,0,1mm 0,0,0,1'
    echo 'now move lid 0,0,1mm 0,0,0,0'
    sleep 0.3
    echo 'now gravity 0,0,-9.81'
    sleep 0.3
} | tled-run -d cpu --live --control - --record "$T/record" >"$T/live" 2>"$T/said"
is "$(grep -c '^now move lid' "$T/record") $(grep -c '2 lines skipped' "$T/said")" "1 1" "live: a line moves the body; two are wrong"
near "$(sum 4 "$(get body.pose "$T/live")")" 0.1 1e-12 "it is where the line says"
check "and replayed, the same" sh -c "tled-run -q -d cpu --replay '$T/record' <'$T/lid' >'$T/replayed'"
check "to the last byte" sinew diff "$T/live" "$T/replayed"

# Surfaces that go with a body
box 5 5 20 15 15 25 >"$T/tooth.obj"
printf 'volume move=1,0,0\nsurface tooth.obj unit=mm in=lid\n' >"$T/around"
printf 'surface tooth.obj unit=mm in=volume\n' >"$T/still"
printf '0 move lid 0,0,0 0,0,0,1\n0.1 move lid 8mm,0,5mm 0,0,0,1\n' >"$T/script"
sinew bind -q <"$T/lid" | tled-run -q --script "$T/script" -t 0.15 --every 0.15 >"$T/film"
picture() { # FILE [ARG...]
    picture_to=$1
    shift
    sinew render -q --up z --camera 1cm,-20cm,1cm,1cm,1cm,1cm --size 160x120 -o "$T/$picture_to.png" "$@" "$T/film"
}
picture moved --body "$T/around"
picture still --body "$T/still"
picture bare
picture rest --frame rest --body "$T/around"
picture rest-still --frame rest --body "$T/still"
check "at rest a surface of a body is where it is drawn in the volume" cmp "$T/rest.png" "$T/rest-still.png"
fails 1 "moved it is elsewhere" 'differ' sh -c "cmp '$T/moved.png' '$T/still.png' >&2"
printf 'surface tooth.obj unit=mm in=lip\n' >"$T/wrong"
fails 1 "a surface of no body" "wrong:1: unknown body 'lip'; did you mean 'lid'" sinew render -o "$T/no.png" --body "$T/wrong" "$T/film"
sinew bind -q <"$T/plain" >"$T/bound"
fails 1 "of a model without any" "around:2: 'lid': the model has no rigid bodies" sinew render -o "$T/no.png" --body "$T/around" "$T/bound"

done_testing
