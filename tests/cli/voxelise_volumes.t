#!/bin/sh
# voxelise: volumes by name and from a file, levels and priorities (W&M algorithm 1), materials, what the user is told.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

# vox ARGS...: as text into $T/m, what it says into $T/said. Voxels of 1 mm about lattice planes at whole numbers.
vox() {
    voxelise --text --unit mm -s 1 --origin 0,0,0 "$@" >"$T/m" 2>"$T/said"
}
# counts NAMES...: elements of volumes.
counts() {
    for name; do
        printf '%s ' "$(sinew info --get "volume.count.$name" <"$T/m")"
    done
}
# rows ARRAY: of $T/m, on one line.
rows() {
    awk -v a="$1" '$1 == "array" { on = $2 == a; next } /^[a-z]/ { on = 0 } on { printf "%s ", $0 }' "$T/m"
}
# said NAME PATTERN
said() {
    if grep -Eq -e "$2" "$T/said"; then
        ok "$1"
    else
        not_ok "$1"
        diag_file "$T/said"
    fi
}
# silent NAME PATTERN: not said.
silent() {
    if grep -Eq -e "$2" "$T/said"; then
        not_ok "$1"
        diag_file "$T/said"
    else
        ok "$1"
    fi
}

# By names. A block of 10 with a hollow skull of 4, two muscles that overlap, one of them half outside.
{
    box "Skin_face" 0 0 0 10 10 10
    box "SKULL" 3 3 3 7 7 7
    box "muscle_a" 0 0 0 4 2 2
    box "Muscle_b" 2 0 0 12 2 2
} >"$T/head.obj"
vox "$T/head.obj"
is "$(rows volume.name)" '"skin" "muscle_a" "Muscle_b" ' "skin and skull make one volume, each muscle its own"
is "$(rows volume.level)$(rows volume.priority)$(rows volume.muscle)" "0 1 1 0 0 1 0 1 1 " "levels, priorities, muscles"
is "$(counts skin muscle_a Muscle_b)" "896 16 24 " "the first muscle keeps what both could have; none leaves the skin"
is "$(sinew info --get axis.element <"$T/m")" 936 "elements: the block without the skull"
is "$(grep -A 5 '^voxelise: 3 volumes' "$T/said")" "voxelise: 3 volumes
                                        voxels     voxels  kept
  volume    level  material  elements  outside  to others     %
  skin          0  tissue         896        0         40    95
  muscle_a      1  tissue          16        0          0   100
  Muscle_b      1  tissue          24        8          8    60" "the plan"
voxelise -v --unit mm -s 1 -o "$T/m" "$T/head.obj" 2>"$T/said"
said "-v says of which surfaces" "^  skin +0 +0  tissue +896 +0 +40 +95 +Skin_face SKULL$"
silent "the skull is rigid" "nothing is rigid"
check "-q says nothing of it" sh -c "voxelise -q --unit mm -s 1 '$T/head.obj' 2>&1 >/dev/null | wc -c | grep -qx 0"

# The others.
{
    box "gland" 0 0 0 2 2 2
    box "eye" 1 1 1 3 3 3
    box "muscle_out" 8 8 8 9 9 9
    box "muscle_thin" 0 0 0 1 1 0.4
    box "muscle_deep" 0 0 0 1 1 1
    box "muscle_late" 0 0 0 1 1 1
} >"$T/others.obj"
vox "$T/others.obj"
is "$(rows volume.name)" '"other" "muscle_out" "muscle_thin" "muscle_deep" "muscle_late" ' "others together are one volume"
is "$(counts other muscle_deep)" "13 1 " "inside one of two is inside, inside both is outside"
said "a muscle outside" "warning: muscle_out is ignored: all of it is outside the volumes of level 0 \(1 voxel\)$"
said "which the table marks" "^  muscle_thin .* 0 +- +- +-  !$"
is "$(attach --report <"$T/m" 2>&1 >"$T/attached" | grep -e primitives -e "rigid surface")" "attach: 0 rigid surfaces" \
    "a table without rows has no headings"
said "a muscle thinner than a voxel" "warning: muscle_thin has no voxel: no centre is inside it"
said "a muscle that comes too late" "warning: muscle_late has no voxel: other volumes take all of it \(1 voxel\)$"
said "nothing rigid" "warning: nothing is rigid"
said "those are marked" "^  muscle_out +1 .* 0 +1 +0 +0  !$"
silent "and not said twice" "at most half"
{
    box skin 0 0 0 4 4 4
    box muscle_half 2 0 0 6 1 1
    box muscle_third 0 3 0 4 9 1
    box muscle_more 0 0 3 4 1 4
} >"$T/half.obj"
vox "$T/half.obj"
said "muscles that lose half" "warning: 2 muscles keep at most half of their voxels, .*: muscle_half \(50 %\), muscle_third \(16 %\); "
is "$(grep -c '!$' "$T/said")" 2 "are marked too"
check "-q keeps the warning alone" sh -c "voxelise -q --unit mm -s 1 --origin 0,0,0 '$T/half.obj' 2>&1 >/dev/null | grep -v 'nothing is rigid' | grep -c . | grep -qx 1"
box "gland" 0 0 0 2 2 2 >"$T/one.obj"
vox "$T/one.obj"
is "$(rows volume.name)" '"gland" ' "the only other surface names its volume"
box "muscle_alone" 0 0 0 2 2 2 >"$T/alone.obj"
vox "$T/alone.obj"
is "$(rows volume.level)$(counts muscle_alone)" "0 8 " "a muscle alone stands on level 0"
sed 's/^g .*/o A thing/' "$T/one.obj" >"$T/o.obj"
vox "$T/o.obj"
is "$(rows volume.name)" '"A_thing" ' "an object where there are no groups"

# A face in several groups: a rigid name marks it, and it is counted once.
{
    box "skin" 0 0 0 4 4 4
    box "muscle_m" 0 0 0 2 2 2
} | awk '/^f/ && ++n == 2 { print "g skin bone_top" } /^f/ && n == 3 { print "g skin" }
    /^f/ && n == 9 { print "g rigid_end muscle_m skin_none" } { print }' >"$T/marks.obj"
sed 's/ skin_none//' "$T/marks.obj" >"$T/marked.obj"
vox "$T/marked.obj"
is "$(rows volume.name)$(counts skin muscle_m)" '"skin" "muscle_m" 56 8 ' "rigid names beside others only mark faces"
fails 1 "a face of a muscle in the skin opens it" "volume skin is open: 8 open edges \(skin_none 8\)" voxelise --unit mm -s 1 "$T/marks.obj"

# Materials by the name of the volume.
printf 'first E=1000\nskin E=2000\nmuscle E=3000\nmuscle_a E=4000\n' >"$T/materials"
vox --materials "$T/materials" "$T/head.obj"
is "$(rows volume.material)" "1 3 2 " "materials of the volumes' names, then 'muscle', then the first"

# From a file.
cat >"$T/volumes" <<'V'
# comment
core   level=2 surfaces=muscle_b muscle=no
middle level=1 priority=3 material=soft surfaces=MUSCLE_A # overlaps core

flesh  surfaces=skin*,skull material=first
last   level=1 priority=7 surfaces=Muscle_b muscle=yes
V
printf 'first E=1000\nsoft E=2000\n' >"$T/materials"
vox --volumes "$T/volumes" --materials "$T/materials" "$T/head.obj"
is "$(rows volume.name)" '"flesh" "middle" "last" "core" ' "in order of level and priority"
is "$(rows volume.level)$(rows volume.priority)$(rows volume.material)$(rows volume.muscle)" \
    "0 1 1 2 0 3 7 0 0 1 0 0 0 0 1 0 " "level, priority, material, muscle"
is "$(counts flesh middle last core)" "896 8 0 32 " "three levels: one climbs only from the level below"
said "a volume that all others take" "warning: last has no voxel: other volumes take all of it \(32 voxels\)$"

# bad NAME PATTERN LINE...: a --volumes file that is refused.
bad() {
    name=$1 pattern=$2
    shift 2
    printf '%s\n' "$@" >"$T/bad"
    fails 1 "$name" "^voxelise: $T/bad:$pattern" voxelise --unit mm -s 1 --volumes "$T/bad" -o "$T/out" "$T/head.obj"
    [ ! -e "$T/out" ] || not_ok "$name: it left an output"
}
bad "unknown key" "2:.*'levle'.*level" '#' 'a levle=0 surfaces=skin*'
bad "unknown surface" "1: unknown surface 'musle_a'.*did you mean 'muscle_a'" 'a surfaces=skin*,musle_a'
bad "a pattern that matches none" "1: unknown surface 'fat\*'" 'a surfaces=fat*'
bad "unknown material" "1: unknown material 'tisue'.*tissue" 'a surfaces=skin* material=tisue'
bad "no surfaces" "1: volume 'a' has no surfaces; expected surfaces=" 'a level=0'
bad "an empty name" "1: an empty name among the surfaces" 'a surfaces=skin*,,skull'
bad "level" "1: level=-1; expected a whole number from 0" 'a level=-1 surfaces=skin*'
bad "priority" "1: priority=1.5; expected a whole number" 'a priority=1.5 surfaces=skin*'
bad "muscle" "1: muscle=maybe; expected yes or no" 'a muscle=maybe surfaces=skin*'
bad "the same name" "2: volume 'A' was given on line 1" 'a surfaces=skin*' 'A level=1 surfaces=muscle_a'
bad "the same level and priority" "2: 'b' has level 0 and priority 0, as 'a' on line 1" 'a surfaces=skin*' 'b surfaces=skull'
bad "a level left out" "2: volume 'b' is on level 2, and no volume is on level 1" 'a surfaces=skin*' 'b level=2 surfaces=skull'
bad "no level 0" "1: volume 'b' is on level 1, and no volume is on level 0" 'b level=1 surfaces=skull'
bad "no name" "1: 'level=0' where a volume's name should be" 'level=0 surfaces=skin*'
bad "no volumes" " no volumes; expected lines" '# nothing'
bad "a key twice" "1:.*level" 'a level=0 level=0 surfaces=skin*'
fails 1 "no such file" "none.*No such file" voxelise --unit mm -s 1 --volumes "$T/none" "$T/head.obj"
printf 'a surfaces=skin*,skull\n' >"$T/volumes"
vox --volumes "$T/volumes" "$T/head.obj"
said "surfaces in no volume" "warning: .*surface 'muscle_a' is in no volume"
{
    cat "$T/one.obj"
    printf 'g points\np 1\n'
} >"$T/points.obj"
printf 'a surfaces=points\n' >"$T/bad"
fails 1 "a surface of points" "bad:1: surface 'points' has no polygons" voxelise --unit mm -s 1 --volumes "$T/bad" "$T/points.obj"

# Open, repeated and unwelded polygons.
soup "$T/head.obj" >"$T/soup.obj"
vox "$T/soup.obj"
is "$(counts skin muscle_a Muscle_b)" "896 16 24 " "polygons that share no vertex are welded by their places"
sed '/^g SKULL/,/^g/ { /^f -8 -7/d; }' "$T/head.obj" >"$T/open.obj"
fails 1 "an open surface" "open.obj: volume skin is open: 4 open edges \(SKULL 4\), the first at 5mm,3mm,3mm; expected every edge" \
    voxelise --unit mm -s 1 -o "$T/out" "$T/open.obj"
is "$([ -e "$T/out" ] && echo left)" "" "no output is left"
vox --allow-open "$T/open.obj"
said "--allow-open warns" "warning: volume skin is open: 4 open edges \(SKULL 4\), the first at 5mm,3mm,3mm; what"
sed 's/^f -8 -6 -5 -7$/&\nf -6 -5 -7 -8\nf -7 -5 -6 -8/' "$T/one.obj" >"$T/again.obj"
vox "$T/again.obj"
is "$(counts gland)" "8 " "a polygon given three times counts once"
said "that is said" "warning: volume gland repeats polygons \(2 of them\): each counts once"
sed 's/^f .*$/&\n&/' "$T/one.obj" >"$T/twice.obj"
vox "$T/twice.obj"
is "$(counts gland)" "8 " "a surface given twice counts once"
{
    box "a" 0 0 0 1 1 1
    box "b" 1 0 0 2 1 1
} >"$T/touch.obj"
vox "$T/touch.obj"
is "$(counts other)" "2 " "two boxes that share a face"
said "that is said" "repeats polygons \(1 of them\): they cancel in pairs"
{
    cat "$T/twice.obj" "$T/twice.obj"
    box "c" 4 4 4 6 6 6
    box "d" 6 4 4 8 6 6
} >"$T/both.obj"
vox "$T/both.obj"
is "$(counts other)" "24 " "a surface given four times and two boxes that share a face, in one volume"
said "what counts once" "repeats polygons \(18 of them\): each counts once"
said "and what cancels" "repeats polygons \(1 of them\): they cancel in pairs"
sed '$d' "$T/both.obj" >"$T/torn.obj"
vox --allow-open "$T/torn.obj"
said "an open one of them" "is open: 4 open edges \(d 4\)"
said "leaves the other as it is" "repeats polygons \(18 of them\): each counts once"
{
    box "e" 9 4 4 9.5 6 6
    cat "$T/torn.obj"
} >"$T/apart.obj"
vox --allow-open "$T/apart.obj"
said "one part's gap is its own" "is open: 4 open edges \(d 4\)"
sed '$d' "$T/one.obj" | sed 's/^f .*$/&\n&/' >"$T/torn.obj"
fails 1 "a torn surface given twice is open, not gone" "gland is open: 4 open edges \(gland 4\)" \
    voxelise --unit mm -s 1 "$T/torn.obj"
# What two solids share need not be flat, nor begin at the same corner or go the same way round.
for face in '2 4 8 6' '4 8 6 2' '6 8 4 2' '4 2 6 8'; do
    {
        printf 'v %s\n' '0 0 0' '2 0 0' '0 4 0' '6 4 0' '0 0 4' '6 0 4' '0 4 4' '2 4 4' \
            '8 0 0' '8 4 0' '8 0 4' '8 4 4'
        printf 'f %s\n' '1 2 4 3' '5 7 8 6' '1 5 6 2' '3 4 8 7' '1 3 7 5' '2 4 8 6' \
            '2 9 10 4' '6 8 12 11' '2 6 11 9' '4 10 12 8' '9 11 12 10' "$face"
    } >"$T/warped.obj"
    vox "$T/warped.obj"
    is "$(counts default)" "128 " "two solids that share a polygon which is not flat: $face"
done
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\ng skin\n' >"$T/none.obj"
fails 1 "no polygons" "none.obj: no polygons; expected closed surfaces" voxelise --unit mm -s 1 "$T/none.obj"
done_testing
