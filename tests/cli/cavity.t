#!/bin/sh
# msds-run --cavity: a vein that a probe presses shut and that opens again, beside an artery that stays open and a thrombus; the
# same bytes from a record and by any number of threads; a pressure that changes on the way; and what is refused.
. "$(dirname "$0")/lib.sh"

# ---- an arm: 12 mm down in a second, held for half a second, and up
root=$(dirname "$0")/../..
arm() {
    awk -v what="$1" -f "$root/samples/arm.awk"
}
arm labels >"$T/labels.nrrd"
arm poses >"$T/press.tum"
# mesh MATERIALS FILE
mesh() {
    msds-mesh -q --nodes 33x11x17 --like "$T/labels.nrrd" --labels "$T/labels.nrrd" --names 1=tissue,2=vein,3=artery,4=bone \
        --materials "$1" --fix zmin,bone -o "$2"
}
mesh "$root/samples/arm.materials" "$T/arm.sinew"
press() {
    msds-run -d cpu --method tissue --probe linear:4cm,1cm "$@"
}
# vessels ARGS: with both.
vessels() {
    press --cavity vein=10mmHg,artery=100mmHg --wall artery=500 "$@"
}
vessels -v --poses "$T/press.tum" -o "$T/out.sinew" <"$T/arm.sinew" 2>"$T/said"
# column TIME NAME: of the table, NAME's at a time.
column() {
    awk -v time="$1" -v name="$2" '/time\/s/ { for (i = 2; i <= NF; i++) if ($i == name) at = i } $2 == time { print $at + 0 }' "$T/said"
}
# within VALUE LOW HIGH: yes or no.
within() {
    awk -v x="$1" -v low="$2" -v high="$3" 'BEGIN { print (x >= low && x <= high ? "yes" : "no " x) }'
}
is "$(awk '$3 == "tissue" { sum += $8; rows++ } END { print rows, sum }' "$T/said")" "151 0" "no tetrahedron is inverted in any frame, press and release"
is "$(within "$(column 0 vein%)" 97 104) $(within "$(column 0 artery%)" 97 108)" "yes yes" "at rest both are as they were imaged"
# The probe is 1 cm thick, the vessels 4 cm long: the vein is shut under it, and open beside it.
is "$(within "$(column 1.5 vein%)" 50 65) $(within "$(column 1.5 artery%)" 95 104)" "yes yes" "pressed, the vein gives way, the artery does not"
is "$(within "$(column 2.5 vein%)" 98 104) $(awk '$2 == 2.5 { print ($6 < 1e-4) }' "$T/said")" "yes 1" "let go, the vein is open again"
is "$(grep -c 'cavity vein: 1.9.* ml at rest; at least 6.*, at 1.5 s' "$T/said")" 1 "the end tells when it was least open"

# The middle ring of the vein, and of what is a soft solid in its place.
for surface in vein artery; do
    arm $surface >"$T/$surface.obj"
done
area() {
    sinew deform -q --unit mm --frame "$2" -o "$T/moved.obj" "$T/$3.obj" <"$1"
    awk -v what=areas -f "$root/samples/arm.awk" "$T/moved.obj"
}
sinew bind -q --unit mm "$T/vein.obj" "$T/artery.obj" <"$T/out.sinew" >"$T/bound.sinew"
rest=$(area "$T/bound.sinew" 0 vein)
is "$(within "$(area "$T/bound.sinew" 85 vein | awk -v rest="$rest" '{ print $1 / rest }')" 0 .3)" yes "under the probe the vein is shut as far as cells of 2.5 mm go"
sed 's/^vein .*/vein law=linear E=3000 nu=0.49 density=1000/' "$root/samples/arm.materials" >"$T/thrombus"
mesh "$T/thrombus" "$T/soft.sinew"
head -n 62 "$T/press.tum" >"$T/down.tum"
press -q --cavity artery=100mmHg --wall artery=500 --poses "$T/down.tum" <"$T/soft.sinew" | sinew bind -q --unit mm "$T/vein.obj" >"$T/solid.sinew"
is "$(within "$(area "$T/solid.sinew" 61 vein | awk -v rest="$rest" '{ print $1 / rest }')" .6 1)" yes "a thrombus in its place is not"

# ---- the same bytes
head -n 24 "$T/press.tum" >"$T/some.tum"
vessels -q --threads 1 --poses "$T/some.tum" <"$T/arm.sinew" >"$T/one.sinew"
vessels -q --threads 3 --poses "$T/some.tum" <"$T/arm.sinew" >"$T/three.sinew"
is "$(sinew diff "$T/one.sinew" "$T/three.sinew" >/dev/null && echo same)" same "by one thread and by three"
{ head -n 12 "$T/some.tum"; echo 'set cavity vein=0'; tail -n 12 "$T/some.tum"; } >"$T/live.tum"
{ cat "$T/arm.sinew" "$T/live.tum"; } | vessels -q --live --poses - --record "$T/record" >"$T/live.sinew" 2>"$T/error"
vessels -q --replay "$T/record" <"$T/arm.sinew" >"$T/again.sinew"
is "$(sinew diff "$T/live.sinew" "$T/again.sinew" >/dev/null && echo same)" same "a record makes the same frames again"
# on ARGS: of the arm.
# shellcheck disable=SC2317 # fails calls it
on() {
    press -q "$@" <"$T/arm.sinew" >"$T/sink"
}
fails 1 "not with another wall" 'cavities' on --replay "$T/record" --cavity vein=10mmHg,artery=100mmHg --wall artery=400
fails 1 "nor without cavities" "was made with cavities .*, but this run has none" on --replay "$T/record"

# ---- a pressure that changes: less of it, less open
vessels -v --poses "$T/live.tum" <"$T/arm.sinew" 2>"$T/less" >"$T/sink"
last() {
    awk '$3 == "tissue" { at = $9 } END { print at + 0 }' "$1"
}
vessels -v --poses "$T/some.tum" <"$T/arm.sinew" 2>"$T/same" >"$T/sink"
is "$(awk -v less="$(last "$T/less")" -v same="$(last "$T/same")" 'BEGIN { print (less < same - 1) }')" 1 "set cavity vein=0: the vein has less in it"

# ---- what is refused
refuses() { # NAME PATTERN ARGS...
    refuses_name=$1 refuses_pattern=$2
    shift 2
    fails 2 "$refuses_name" "$refuses_pattern" on --poses "$T/some.tum" "$@"
}
refuses "a volume that there is not" "unknown volume 'vain'; did you mean 'vein'" --cavity vain=10mmHg
refuses "no pressure" "'vein'; expected NAME=PRESSURE, such as vein=10mmHg" --cavity vein
refuses "a unit that is none" "'vein=10mm'; expected a pressure from -1e7 to 1e7 Pa" --cavity vein=10mm
refuses "nothing" "--cavity '': expected NAME=PRESSURE" --cavity ''
refuses "a comma at the end" "''; expected NAME=PRESSURE" --cavity vein=10mmHg,
refuses "the same twice" "volume 'vein' is named twice" --cavity vein=1,vein=2
refuses "a wall of no cavity" "volume 'artery' is no cavity; expected --cavity artery=PRESSURE" --cavity vein=1 --wall artery=400
refuses "a wall below 0" "'vein=-1'; expected from 0 to 1e9 N/m" --cavity vein=1 --wall vein=-1
refuses "a resistance that is not a number" "'vein=nan'; expected from 0 to 1e15 Pa s/m3" --cavity vein=1 --outflow vein=nan
refuses "nothing but cavities" 'all tetrahedra are of cavities' --cavity tissue=1,vein=1,artery=1,bone=1
refuses "another method" 'with --method fem; expected --method tissue' --cavity vein=1 --method fem
{ head -n 2 "$T/some.tum"; echo 'method fem'; tail -n 2 "$T/some.tum"; } >"$T/fem.tum"
fails 1 "another method on the way" 'fem.tum:3: method fem with --cavity; expected method tissue' on --cavity vein=1 --poses "$T/fem.tum"
{ head -n 2 "$T/some.tum"; echo 'set cavity artery=1kPa'; } >"$T/set.tum"
fails 1 "a pressure of no cavity" "set.tum:3: .*volume 'artery' is no cavity" on --cavity vein=1 --poses "$T/set.tum"
fails 1 "a pressure where there is no cavity" 'set.tum:3: set cavity, but there is no cavity; expected --cavity' on --poses "$T/set.tum"

done_testing
