#!/bin/sh
# msds-run on a card, through its command line: the choice and what is said of it; on a card, frames of every method and of probes of
# every shape against the CPU's.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"

msds-mesh -q --nodes 13x9x7 --size 12cm,8cm,6cm --young 10000 --poisson 0.4 --density 1000 >"$T/block.sinew"
# press FROM TO: poses over the middle, each a millimetre deeper than the last.
press() {
    awk -v a="$1" -v b="$2" 'BEGIN { for (i = a; i <= b; i++) printf "%g .06 .04 %.4f 1 0 0 0\n", i / 60, .061 - .001 * i }'
}
press 1 10 >"$T/press.tum"
cat >"$T/wedge.obj" <<'OBJ'
v -10 -10 -20
v 10 -10 -20
v 10 10 -20
v -10 10 -20
v 0 -6 0
v 0 6 0
f 1 4 3 2
f 1 2 5
f 3 4 6
f 2 3 6 5
f 4 1 5 6
OBJ
run() { # ARG...
    msds-run --probe sphere:2cm --poses "$T/press.tum" "$@" <"$T/block.sinew"
}

# ---- The choice.
if ! run -q -d cuda >"$T/out" 2>"$T/err"; then
    run >"$T/auto" 2>"$T/said"
    is $? 0 "-d auto takes the CPU"
    if grep -q 'this build has no CUDA' "$T/err"; then
        why='this build has no CUDA back end; have: cpu$'
    else
        why='the cuda back end cannot be used here: [a-z]'
        check "-d auto says what it took, and why" grep -q ' cpu (cuda: ' "$T/said"
    fi
    fails 1 "-d cuda fails, and says why" "$why" run -d cuda
    is "$(grep -c 'msds-run: \(this build\|the cuda\)' "$T/stderr")" 1 "in one line"
    skip 1 "the rest: $(sed 's/.*: //' "$T/err" | head -n 1)"
    done_testing
fi
run >"$T/out" 2>"$T/err"
check "-d auto takes the card, and says so" grep -q ' cuda$' "$T/err"
sinew info <"$T/out" >"$T/info"
check "what ran is in provenance" grep -q '\[cuda,' "$T/info"
fails 1 "a card takes no rotations out, and says so" 'the CUDA back end has no elements that turn: --warp; expected -d cpu or auto' run -d cuda --method fem --warp
run --method fem --warp >"$T/out" 2>"$T/err"
check "-d auto knows" grep -q ' cpu (the one with elements that turn: --warp)$' "$T/err"

# ---- Against the CPU.
same() { # NAME TOLERANCE ARG...: over the largest displacement; 0: the same numbers
    name=$1 tolerance=$2
    shift 2
    run -q -d cpu "$@" >"$T/cpu"
    run -q -d cuda "$@" >"$T/cuda"
    most=$(sinew info --get node.displacement.max <"$T/cpu")
    near "$(awk -v m="$most" 'BEGIN { print (m > 1e-3) }')" 1 0 "$name moves: $most m"
    check "$name: as on the CPU, to $tolerance" sinew diff --only node.displacement,node.velocity \
        --abs "$(awk -v m="$most" -v t="$tolerance" 'BEGIN { print t * m }')" "$T/cpu" "$T/cuda"
    check "$name: and the force" sinew diff --rel 1e-5 --abs 1e-6 --only probe.force,probe.torque "$T/cpu" "$T/cuda"
}
for method in 'msds 0' 'fem 0' 'fem 1e-5 --exact' 'tissue 1e-5'; do
    # shellcheck disable=SC2086
    set -- $method
    method=$1 tolerance=$2
    shift 2
    same "$method $*" "$tolerance" --method "$method" "$@"
    same "$method $*, gravity" "$tolerance" --method "$method" "$@" -g 1,0,-5
    for probe in linear:4cm,1cm curved:4cm,60,14mm "convex:$T/wedge.obj"; do
        same "$method $*, ${probe%%:*}" "$tolerance" --method "$method" "$@" --probe "$probe" --unit mm
    done
done
same "a penalty" 1e-5 --method fem --contact penalty
same "a penalty, exactly" 1e-5 --method fem --exact --contact penalty
same "a penalty, tissue" 1e-5 --method tissue --contact penalty

# ---- Frames of what is asked for: the numbers of all.
printf 'v 40 30 40\nv 80 30 45\nv 60 60 50\nf 1 2 3\n' >"$T/vessel.obj"
sinew bind -q --unit mm "$T/vessel.obj" <"$T/block.sinew" >"$T/bound.sinew" 2>"$T/said"
bound() { # ARG...
    msds-run -q -d cuda --probe sphere:2cm --poses "$T/press.tum" "$@" <"$T/bound.sinew"
}
for method in 'msds' 'fem --exact'; do
    # shellcheck disable=SC2086
    set -- $method
    bound --method "$@" >"$T/all"
    bound --method "$@" --frames displacement,velocity,probe >"$T/named"
    bound --method "$@" --frames displacement:f32,surfaces >"$T/f32"
    bound --method "$@" --frames surfaces,probe.force >"$T/surfaces"
    check "$method: all by name" sinew diff --only node.displacement,node.velocity,probe.force,probe.pose "$T/all" "$T/named"
    check "$method: f32 is rounded" sinew diff --only node.displacement --rel node.displacement=5.97e-8 "$T/all" "$T/f32"
    sinew deform -q --unit mm "$T/vessel.obj" <"$T/all" >"$T/want"
    for chosen in f32 surfaces; do
        sinew deform -q --unit mm "$T/vessel.obj" <"$T/$chosen" >"$T/got"
        check "$method, $chosen: a vessel is where sinew deform moves it" cmp "$T/got" "$T/want"
    done
done
check "and has moved" sh -c "! cmp -s '$T/got' '$T/vessel.obj'"

# ---- A probe that leaves, and stays away: frames find rest, and stay there.
awk 'BEGIN { for (i = 0; i < 40; i++) printf "%g .06 .04 %.4f 1 0 0 0\n", i / 60, i < 4 ? .06 - .001 * i : .08 }' >"$T/leave.tum"
for exact in '' --exact; do
    # shellcheck disable=SC2086
    check "a probe that leaves $exact" run -d cuda --residual --method fem $exact --poses "$T/leave.tum" -o "$T/leave.sinew"
    is "$(awk '/ 0.65 s: / { sub(/.*residual /, ""); print $0 + 0 < 1e-5 }' "$T/stderr")" 1 "and leaves nothing but what is slight"
    check "lets go of the tissue" awk -v u="$(sinew info --get node.displacement.max "$T/leave.sinew")" 'BEGIN { exit !(u < 1e-8) }'
done

# ---- Methods that change, and going on.
{ press 1 3; echo 'method fem'; press 4 6; echo 'method msds'; press 7 10; } >"$T/both.tum"
same "methods change" 0 --poses "$T/both.tum"
same "methods change, exactly" 1e-5 --exact --poses "$T/both.tum"
{ echo 'method tissue'; press 1 3; echo 'method fem'; press 4 6; echo 'method tissue'; press 7 10; } >"$T/tissue.tum"
same "methods change, tissue" 1e-5 --poses "$T/tissue.tum"
run -q -d cuda --method fem --exact >"$T/whole"
press 1 4 >"$T/first.tum"
press 5 10 >"$T/last.tum"
run -q -d cuda --method fem --exact --poses "$T/first.tum" |
    msds-run -q -d cuda --method fem --exact --probe sphere:2cm --poses "$T/last.tum" >"$T/parts"
check "in two parts: the same" sinew diff --rel 1e-4 --abs 1e-8 --only node.displacement "$T/whole" "$T/parts"
different=0
for _ in 1 2 3 4 5; do
    run -q -d cuda --method fem --exact | cmp -s - "$T/whole" || different=1
done
is "$different" 0 "the same bytes, run after run"
run -q -d cuda --method tissue >"$T/whole"
different=0
for _ in 1 2 3 4 5; do
    run -q -d cuda --method tissue | cmp -s - "$T/whole" || different=1
done
is "$different" 0 "the same bytes of tissue, run after run"
done_testing
