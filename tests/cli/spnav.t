#!/bin/sh
# --poses spnav:...: a 3D mouse, whose daemon is faked by its protocol, drives us-slice --live, msds-run --live and tled-run --live; where the probe
# begins; a daemon that sends what is no event, goes away and comes back; what is refused. State and bytes are looked at, never times.
. "$(dirname "$0")/lib.sh"

have python3 || skip_all "no python3"
fake=$PWD/tests/cli/spacenavd.py
msds-mesh -q --text --nodes 5x5x5 --size 4cm,4cm,4cm --young 10000 --poisson 0.4 --density 1000 >"$T/block.sinew"
awk -v nx=2 -v ny=2 -v nz=2 -v h=0.005 -v held=low -f tests/cli/block.awk >"$T/tled.sinew"
cd "$T" || exit 1
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 4 4 4' \
        'space directions: (1,0,0) (0,1,0) (0,0,1)' 'encoding: text' 'space origin: (0,0,0)' ''
    awk 'BEGIN { for (k = 0; k < 64; k++) print k }'
} >v.nrrd
printf '0 .02 .02 .06 1 0 0 0\n' >above.tum # down on the block
printf '0 0 0 0 0 0 0 1\n' >zero.tum
mkfifo puck control
SPNAV_SOCKET=$T/socket
export SPNAV_SOCKET

# daemon: begins; descriptor 3 is what it does.
daemon() {
    python3 "$fake" "$SPNAV_SOCKET" <puck >heard 2>daemon.err &
    daemon=$!
    exec 3>puck
    tries=0
    while [ ! -S "$SPNAV_SOCKET" ] && [ "$tries" -lt 500 ]; do
        tries=$((tries + 1))
        sleep .02
    done
}
# until_seen FILE PATTERN: waits until a line matches; fails after 10 s.
# shellcheck disable=SC2317 # called by name
until_seen() {
    tries=0
    while ! grep -Eq -e "$2" "$1" 2>/dev/null; do
        tries=$((tries + 1))
        [ "$tries" -lt 500 ] || return 1
        sleep .02
    done
}
# end NAME: the run ends by SIGINT, and the daemon with its input.
end() {
    kill -INT "$run"
    wait "$run"
    is $? 0 "$1: SIGINT is a normal end"
    exec 3>&-
    wait "$daemon"
    is "$(cat heard daemon.err)" 0 "$1: nothing was said to the daemon"
}

# ---- What is refused.
slice="us-slice --rigid --probe linear:2mm,1mm --size 8x8"
# shellcheck disable=SC2086 # options
{
    fails 1 "no daemon" "$T/socket: cannot connect: No such file or directory; expected spacenavd to run" \
        $slice --live --poses spnav:joystick,start=zero.tum v.nrrd
    fails 2 "us-slice that is not live" "spnav:joystick without --live; expected both" $slice --poses spnav:joystick v.nrrd
    fails 2 "a probe that is nowhere" "where the probe begins is not said; expected start=FILE" $slice --live --poses spnav: v.nrrd
    fails 2 "controls from a 3D mouse" "poses alone" $slice --live --poses control --control spnav: v.nrrd
    fails 2 "a key that is not there" "unknown 'sped='.*speed=LENGTH" $slice --live --poses spnav:sped=1,start=zero.tum v.nrrd
}
# shellcheck disable=SC2016 # for the inner shell
{
    fails 2 "msds-run that is not live" "without --live" sh -c 'msds-run --probe sphere:1cm --poses spnav: <block.sinew'
    fails 2 "tled-run that is not live" "without --live" sh -c 'tled-run --probe sphere:1cm --poses spnav: <tled.sinew'
}

# ---- us-slice: a joystick, whose poses are those of its events.
daemon
# shellcheck disable=SC2086 # options
$slice -q --live --poses spnav:joystick,reach=7mm,turn=90,start=zero.tum --record a.rec -o a.pgm v.nrrd 2>said &
run=$!
check "the probe begins where start= says" until_seen a.rec 'pose=0,0,0,0,0,0,1( |$)'
echo 'motion 350 0 0 0 0 0' >&3
check "the puck to the right is +x" until_seen a.rec 'pose=0.007,0,0,'
echo 'motion 0 -350 0 0 0 0' >&3
check "down is +z, into the tissue" until_seen a.rec 'pose=0,0,0.007,'
echo 'motion 0 0 -350 0 0 0' >&3
check "toward the user is +y" until_seen a.rec 'pose=0,0.007,0,'
printf 'newer\nmotion 0 0 0 350 0 0\n' >&3
check "a turn, after types of newer daemons" until_seen a.rec 'pose=0,0,0,0.7071[0-9]*,0,0,0.7071'
printf 'garbage\nmotion 175 0 0 0 0 0\nhalf\n' >&3
check "an event after garbage" until_seen a.rec 'pose=0.0035,0,0,'
echo drop >&3
check "the daemon goes away" until_seen said 'socket: spacenavd went away; the probe stays where it is until it is back'
check "in the midst of an event" until_seen said 'spnav:[0-9]*: the event is cut'
echo back >&3
check "and comes back" until_seen said 'spacenavd is back'
echo 'motion 350 0 0 0 0 0' >&3
check "and the probe goes on" until_seen a.rec 'pose=0.0105,0,0,'
end us-slice
# shellcheck disable=SC2086 # options
check "its record is replayed" $slice -q --replay a.rec -o b.pgm v.nrrd
check "to the same bytes" cmp a.pgm b.pgm

# ---- msds-run: a mouse, which a control puts to its place.
daemon
msds-run --live --text --probe sphere:1cm --poses spnav:mouse,speed=4cm --control control --record m.rec <block.sinew >m.sinew 2>said &
run=$!
exec 4>control
cat above.tum >&4
check "a pose through --control" until_seen m.rec 'pose=0.02,0.02,0.06,1,0,0,0 '
echo 'motion 0 -350 0 0 0 0' >&3
check "a deflection moves it down" until_seen m.rec 'pose=0.02,0.02,0.05[0-9]*,1,0,0,0 '
tries=0
while ! tail -n 1 m.rec | grep -q 'pose=0.02,0.02,0.0[34]' && [ "$tries" -lt 200 ]; do # it is said again and again, as spacenavd does
    echo 'motion 0 -350 0 0 0 0' >&3
    tries=$((tries + 1))
    sleep .02
done
check "on and on" until_seen m.rec 'pose=0.02,0.02,0.0[34]'
printf 'motion 0 0 0 0 0 0\npress 0\nrelease 0\n' >&3
# shellcheck disable=SC2016 # for the inner shell
check "the first button brings it back" sh -c 'tries=0
    until tail -n 1 m.rec | grep -q pose=0.02,0.02,0.06,1,0,0,0; do tries=$((tries + 1)); [ "$tries" -lt 500 ] || exit 1; sleep .02; done'
end msds-run
exec 4>&-
is "$(awk '/^frame/ { for (i = 1; i <= NF; i++) if (sub(/^pose=/, "", $i)) { split($i, p, ","); bad += p[1] != .02 || p[2] != .02 || p[3] > .06 } }
    END { print bad + 0 }' m.rec)" 0 "straight down, and no other way"

# ---- tled-run.
daemon
tled-run --live --text --probe sphere:2mm --poses spnav:joystick,reach=3mm,start=zero.tum --record t.rec <tled.sinew >t.sinew 2>said &
run=$!
echo 'motion 350 0 0 0 0 0' >&3
check "tled-run takes its poses too" until_seen t.rec 'pose=0.003,0,0,'
end tled-run
done_testing
