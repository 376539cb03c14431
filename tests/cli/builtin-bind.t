#!/bin/sh
# In bash, `bind` is a builtin that never reaches our program and says nothing: the next tool in the pipe must say so, whatever
# `pipefail` is, and `sinew bind` must do what is meant everywhere.
. "$(dirname "$0")/lib.sh"

awk -f samples/shape.awk -f samples/muscle.awk >"$T/muscle.obj"
export muscle="$T/muscle.obj"
# shellcheck disable=SC2016 # for the inner shell
make='voxelise -q --unit mm -s 1.5 "$muscle" | attach'
message="no model on stdin \(0 bytes\); if bash's builtin bind ran, write 'sinew bind'"

if have bash; then
    for next in 'tled-run -n 1' attach 'sinew bind' 'sinew info' 'sinew export -f vtu' "sinew deform \"\$muscle\""; do
        for pipefail in +o -o; do
            fails 1 "bash, set $pipefail pipefail: $make | bind | $next" "$message" \
                bash -c "set $pipefail pipefail; $make 2>/dev/null | bind 2>/dev/null | $next"
            is "$(tr -d '\000' <"$T/stdout" | grep -c node.position)" 0 "no model came out"
        done
    done
    fails 1 "bash: command bind is the builtin too" "$message" bash -c "$make | command bind 2>/dev/null | tled-run -n 1"
    check "bash: env bind is ours" bash -c "set -o pipefail; $make | env bind | sinew info"
    check "bash: sinew bind" bash -c "set -o pipefail; $make | sinew bind | tled-run -n 1 | sinew info"
    cp "$T/stdout" "$T/bash"
else
    skip 3 "no bash"
fi

check "sh: sinew bind" sh -c "$make | sinew bind | tled-run -n 1 | sinew info"
check "sh: the same result" test ! -e "$T/bash" -o "$(cat "$T/stdout")" = "$(cat "$T/bash" 2>/dev/null)"
if have make; then
    printf 'all:\n\t@voxelise -q --unit mm -s 1.5 %s | attach | sinew bind | tled-run -n 1 | sinew info\n' "$muscle" >"$T/Makefile"
    check "make: sinew bind" env -u MAKEFLAGS -u MAKELEVEL make -s -C "$T"
    if have bash; then
        sed 's/sinew bind/bind/' "$T/Makefile" >"$T/Makefile.bash"
        fails 2 "make with SHELL = bash: bind is the builtin" "$message" \
            env -u MAKEFLAGS -u MAKELEVEL make -s -C "$T" -f Makefile.bash SHELL=bash
    fi
else
    skip 2 "no make"
fi
done_testing
