#!/bin/sh
# sinew igtl-out: every message, against a client in Python that is written from the specification; slow clients, many, and what is no OpenIGTLink;
# what it passes on, and how it ends.
. "$(dirname "$0")/lib.sh"
have python3 || skip_all "no python3"

cat >"$T/tri.obj" <<'END'
g top
v 2 2 1
v 9 2 1
v 9 7 1.5
v 2 7 6
f 1 2 3 4
END
msds-mesh -q --nodes 5x4x4 --size 11mm,9mm,7mm --fix zmax 2>"$T/said" | sinew bind -q --unit mm "$T/tri.obj" >"$T/bound.sinew" || diag_file "$T/said"
awk 'BEGIN { for (i = 0; i < 12; i++) print i / 60, .0055, .004, .0002 * i - .001, 0, 0, 0, 1 }' >"$T/press.tum"
check "a model with a bound surface is pressed" \
    msds-run -q --method fem --probe linear:6mm,4mm --poses "$T/press.tum" --text -o "$T/result.sinew" <"$T/bound.sinew"
sinew deform -q --unit mm "$T/tri.obj" <"$T/result.sinew" >"$T/moved.obj"

timeout 100 python3 tests/cli/igtl_out.py "$SINEW_BIN/sinew-igtl-out" "$T" >"$T/talk" 2>&1
talked=$?
while IFS= read -r line; do
    case $line in
    ok\ *) ok "${line#ok }" ;;
    not\ ok\ *) not_ok "${line#not ok }" ;;
    *) diag "$line" ;;
    esac
done <"$T/talk"
is "$talked" 0 "the conversation went to its end"

# ---- The command line.
fails 2 "two inputs on standard input" "standard input is one of them" sinew igtl-out --images - --poses -
fails 2 "--pass without a model" "there is none with --images -" sinew igtl-out --images - --pass
fails 2 "-o" "nothing is written but the model" sinew igtl-out -o "$T/x"
fails 2 "an address that is none" "expected" sinew igtl-out --listen 1.2.3.4.5:80 --images -
fails 1 "a control that is a file" "tri.obj: is no FIFO; expected one that us-slice --live --control reads" \
    sinew igtl-out --listen 0 --images - --control "$T/tri.obj"
fails 1 "images that are not there" "none: cannot open: No such file" sinew igtl-out --listen 0 --poses - --images "$T/none"

# ---- Pressed, sliced and served by one command line: what is passed on makes the images that are served.
cd "$T" || exit 1
mkfifo images
{
    printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 10 8' \
        'space directions: (1,0,0) (0,1,0) (0,0,1)' 'encoding: text' 'space origin: (0,0,0)' ''
    awk 'BEGIN { for (i = 0; i < 960; i++) print (i * 37) % 256 }'
} >v.nrrd
timeout 10 sh -c 'sinew igtl-out --listen 0 --pass --images images <result.sinew 2>said |
    us-slice -q --probe linear:6mm,4mm,1mm v.nrrd >images'
is "$(grep -c '12 frames, 12 images; 0 clients' said)" 1 "frames go on to us-slice, whose images come back"
done_testing
