#!/bin/sh
# What sinew igtl-out serves, received by Debian's libopenigtlink: every message, its checksum, pixels to the byte, centres.
# shellcheck source=tests/link/peer.sh
. "$(dirname "$0")/peer.sh"

peer receive
cat >"$T/tri.obj" <<'END'
g top
v 2 2 1
v 9 2 1
v 9 7 1.5
v 2 7 6
f 1 2 3 4
END
cd "$T" || exit 1
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 10 8' \
        'space directions: (1,0,0) (0,1,0) (0,0,1)' 'encoding: text' 'space origin: (0,0,0)' ''
    awk 'BEGIN { for (i = 0; i < 960; i++) print (i * 37) % 256 }'
} >v.nrrd
msds-mesh -q --nodes 5x4x4 --like v.nrrd --fix zmax | sinew bind -q --unit mm tri.obj >bound.sinew
awk 'BEGIN { for (i = 0; i < 12; i++) print i / 60, .0055, .004, .0002 * i - .001, 0, 0, 0, 1 }' >press.tum
check "a model with a bound surface is pressed" \
    sh -c 'msds-run -q --method fem --probe linear:6mm,4mm --poses press.tum <bound.sinew >result.sinew'
sinew deform -q --unit mm tri.obj <result.sinew >moved.obj
us-slice -q -o last_%02d.pgm --size 30x16 --probe linear:6mm,4mm,1mm --depth 8mm v.nrrd <result.sinew

# The client is there before the input begins.
mkfifo input images
# shellcheck disable=SC2094 # a FIFO
sinew igtl-out --listen 0 --pass --images images <input 2>said | us-slice -q --size 30x16 --probe linear:6mm,4mm,1mm --depth 8mm v.nrrd >images &
exec 5<>input
# seen PATTERN FILE: waits until a line matches, 10 s at most.
seen() {
    tries=0
    until grep -q -e "$1" "$2" 2>/dev/null || [ $tries -eq 500 ]; do
        tries=$((tries + 1))
        sleep .02
    done
}
seen 'listens on' said
./receive 127.0.0.1 "$(sed -n 's/.*listens on 127.0.0.1:\([0-9]*\)$/\1/p' said)" pixels >got 5>&- &
seen CAPABILITY got
cat result.sinew >&5
exec 5>&-
wait

is "$(grep -c wrong got)" 0 "every checksum is right, and every content, to the library"
is "$(cut -d ' ' -f 1,2 got | sort -u | tr '\n' ';')" \
    "CAPABILITY peer;IMAGE Image_Reference;POLYDATA tri;SENSOR ProbeForce;SENSOR ProbeTorque;STATUS sinew;STRING ProbeForce;TRANSFORM ImageToReference;TRANSFORM ProbeToReference;" \
    "all that is served comes"
check "the last image's pixels, to the byte" sh -c 'tail -c 480 last_11.pgm | cmp - pixels'
# Its place: the middle of 30 x 16 pixels of .2 x .5 mm, below the pose at 5.5 4 1.2 mm.
is "$(grep '^IMAGE' got | tail -n 1)" \
    "IMAGE Image_Reference 30 16 1 components 1 type 3 system 1 spacing 0.2 0.5 matrix -1 0 0 0 0 1 0 1 0 -5.5 -4 5.2" "its size and its centre, in RAS"
is "$(grep 'ImageToReference' got | tail -n 1)" "TRANSFORM ImageToReference -0.2 0 0 0 0 0.5 0 0.2 0 -2.6 -4 1.45" "where its first pixel is"
is "$(grep 'ProbeToReference' got | tail -n 1)" "TRANSFORM ProbeToReference -1 0 0 0 -1 0 0 0 1 -5.5 -4 1.2" "the probe"
is "$(grep '^POLYDATA' got | tail -n 1)" \
    "POLYDATA tri points $(awk '/^v/ { printf "%.4f %.4f %.4f ", -$2, -$3, $4 }' moved.obj)polygons 3 3" "the surface, where sinew deform has it"
is "$(grep -c '^SENSOR ProbeForce 3 N ' got)" "$(grep -c '^STRING ProbeForce force ' got)" "forces in newton, and as text"
is "$(grep '^STATUS' got | cut -d ' ' -f 3,4 | uniq | tr '\n' ';')" "13 starting:;1 OK:;19 ending:;" "it says when it begins and ends"
done_testing
