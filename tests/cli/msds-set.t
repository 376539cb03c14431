#!/bin/sh
# Settings of msds-run that change between poses: each as its option, from the next frame on; and what is refused.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

msds-mesh -q --nodes 9x9x7 --size 8cm,8cm,6cm --young 10000 --poisson 0.4 --density 1000 >"$T/block.sinew"
awk 'BEGIN { for (i = 0; i < 5; i++) printf "%g .04 .04 %.4f 1 0 0 0\n", i / 60, .06 - .001 * i }' >"$T/five.tum"
head -n 4 "$T/five.tum" >"$T/four.tum"
sed -n 5p "$T/five.tum" >"$T/fifth.tum"

# set METHOD KEY VALUE [OPTIONS]: the first frame after the line is that of a run with the option, which begins with the frames before.
set_one() {
    method=$1 key=$2 value=$3 more=$4
    { cat "$T/four.tum"; echo "set $key $value"; cat "$T/fifth.tum"; } >"$T/set.tum"
    option="--$key $value" probe="--probe sphere:2cm"
    [ "$value" = none ] && option=
    [ "$key" = probe ] && probe=
    # shellcheck disable=SC2086
    {
        msds-run -q --method "$method" $more --probe sphere:2cm --poses "$T/set.tum" <"$T/block.sinew" >"$T/set.sinew"
        msds-run -q --method "$method" $more --probe sphere:2cm --poses "$T/four.tum" <"$T/block.sinew" |
            msds-run -q --method "$method" $more $probe $option --poses "$T/fifth.tum" >"$T/parts.sinew"
        msds-run -q --method "$method" $more --probe sphere:2cm --poses "$T/five.tum" <"$T/block.sinew" >"$T/without.sinew"
    }
    check "$method, set $key $value: as the option" sinew diff --rel 1e-6 --abs 1e-8 --only node.displacement,node.velocity,probe.force \
        "$T/set.sinew" "$T/parts.sinew"
    sinew diff --rel 1e-6 --abs 1e-9 --only node.displacement,probe.force "$T/set.sinew" "$T/without.sinew" >"$T/out" 2>&1
    is $? 1 "$method, set $key $value: which makes a difference"
}
set_one msds iterations 7
set_one msds rate 30
set_one msds dt .004
set_one msds mass lumped '--dt .001'
set_one msds mass stable '--dt .001 --mass lumped'
set_one msds damping .2
set_one msds spring-scale auto
set_one msds spring-scale 4mm
set_one msds repulsion 3
set_one msds gravity 0,0,-9.81
set_one msds probe linear:4cm,1cm
set_one msds probe none
set_one exact contact penalty
set_one exact repulsion .5 '--contact penalty'
set_one exact gravity 0,0,-9.81

# One that is refused ends the run, and says where; nothing else is taken over.
refuse() {
    { cat "$T/four.tum"; echo "$2"; cat "$T/fifth.tum"; } >"$T/bad.tum"
    fails 1 "$1" "bad.tum:5: $3" msds-run -q --probe sphere:2cm --poses "$T/bad.tum" -o "$T/left" <"$T/block.sinew"
}
refuse "a key that is none" 'set dampin .1' "unknown setting 'dampin'; did you mean 'damping'\\?"
refuse "an option that may not change" 'set threads 2' "unknown setting 'threads'; expected one of: iterations, rate"
refuse "no value" 'set damping' '1 words after set; expected set KEY VALUE'
refuse "more than a value" 'set gravity 0 0 1' '4 words after set; expected set KEY VALUE'
refuse "no number" 'set damping much' "--damping 'much': expected a number from 0 to 1e6"
refuse "nan" 'set dt nan' "--dt 'nan': expected a number"
refuse "past its range" 'set iterations 0' "--iterations '0': expected a whole number from 1 to 1e6"
refuse "no such word" 'set mass heavy' "--mass 'heavy': expected stable\\|lumped"
refuse "a step past all substeps" 'set mass lumped' '.*times the stable step; expected at most'
refuse "a length that is none" 'set spring-scale 0' '--spring-scale 0; expected a length above 0'
refuse "a shape with a file" 'set probe convex:p.obj' 'set probe convex:p.obj; expected a shape that needs no file'
refuse "no shape" 'set probe ball:2cm' '.*ball'
refuse "a skin that is not there" 'set skin-tension 1' 'set skin-tension, but there is no skin; expected --skin'
refuse "another verb" 'sit damping 1' '3 words; expected time tx'
check "no output is left" test ! -e "$T/left"

done_testing
