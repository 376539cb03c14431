#!/bin/sh
# What a message quotes of its input stands in the input: no words of ours, no lower case of a name, and no empty quotes.
# With SINEW_LONG all words of a line are damaged in two ways, else two in one way.
. "$(dirname "$0")/lib.sh"

have python3 || skip_all "no python3"
msds-mesh -q --nodes 5x5x3 --size 8cm,8cm,4cm >"$T/tets.sinew"
{
    awk -v x=20 -v y=20 -v z=20 -v held=low -f tests/cli/box.awk
    awk -v x=10 -v y=10 -v z=10 -f tests/cli/box.awk |
        awk '/^g/ { print "g muscle_A"; next } /^f/ { print "f", $2 + 8, $3 + 8, $4 + 8, $5 + 8; next } { print }'
} | voxelise -q --unit mm -s 5 - | attach -q >"$T/block.sinew"
is "$(python3 tests/cli/quoted.py "$T" ${SINEW_LONG:+all})" "many quotes, 0 wrong" "every quoted word stands in the file that it is said of"
done_testing
