#!/bin/sh
# Every tool's failure is seen at the end of a pipe, once, and by its own status, in bash, dash, zsh, busybox sh and make, with no
# pipefail; and with pipefail where what fails hands on no model. sinew(7), PIPES, says so. All of it in bash and make; every fourth pipe in the other
# shells, and with SINEW_LONG all there too.
. "$(dirname "$0")/lib.sh"

# ---- What is good, and what is bad.
mkdir "$T/here"
cd "$T/here" || exit 1
{
    printf 'v %s\n' '0 0 0' '40 0 0' '40 20 0' '0 20 0' '0 0 20' '40 0 20' '40 20 20' '0 20 20'
    printf 'g skull\nf 1 5 8 4\ng skin\n'
    printf 'f %s\n' '2 3 7 6' '1 4 3 2' '5 6 7 8' '1 2 6 5' '3 4 8 7'
} >box.obj
sed '$d' box.obj >open.obj
awk -v nx=10 -v ny=4 -v nz=4 -v h=0.0025 -v held=low -v muscle=1 -f "$ROOT/tests/cli/block.awk" >muscle.sinew
voxelise -q --unit mm -s 10 box.obj >voxels.sinew
attach -q <voxels.sinew | sinew bind | tled-run -q -g 0,0,-9.81 -n 5 >run.sinew
sed '$d' <"$ROOT/tests/cli/small.sinew" >cut.sinew
awk -v what=labels -f "$ROOT/samples/arm.awk" >labels.nrrd
awk -v what=vein -f "$ROOT/samples/arm.awk" >vein.obj
awk -v what=poses -v hz=5 -f "$ROOT/samples/arm.awk" >press.tum
echo '0 0 0 0 1 0 0' >bad.tum
msds-mesh -q --nodes 9x4x5 --like labels.nrrd | sinew bind -q --unit mm vein.obj >arm.sinew
check "what is good" test -s run.sinew -a -s arm.sinew

# Status, messages that are wanted, and a command whose first stage fails (or the last, where it is the only one).
cat >"$T/models" <<'END'
1|1|voxelise -q --unit mm -s 10 open.obj | attach | sinew bind | tled-run -n 1 | sinew info
1|1|attach -q --rigid-file none.obj < voxels.sinew | sinew bind | tled-run -n 1 | sinew info
1|1|sinew bind none.obj < voxels.sinew | tled-run -n 1 | sinew deform box.obj
3|1|tled-run -q -d cpu --dt .00035 -c all=1 -t .2 --ramp .01 < muscle.sinew | sinew info
3|1|tled-run -q -d cpu --dt .00035 -c all=1 -t .2 --ramp .01 < muscle.sinew | sinew export -f vtu
3|1|tled-run -q -d cpu --dt .00035 -c all=1 -t .2 --ramp .01 < muscle.sinew | sinew deform box.obj
3|1|tled-run -q -d cpu --dt .00035 -c all=1 -t .2 --ramp .01 < muscle.sinew | sinew render
2|1|tled-run -q -d cpu --dt .00035 -c all=1 -t .2 --ramp .01 < muscle.sinew | sinew diff - muscle.sinew
1|1|msds-mesh --nodes 3x3x3 --like none.nrrd | sinew bind --unit mm vein.obj | msds-run --probe sphere:2cm --poses press.tum | us-slice --depth 5cm labels.nrrd
1|1|msds-run -q --probe sphere:2cm --poses bad.tum < arm.sinew | us-slice --depth 5cm labels.nrrd
1|1|sinew import --unit m -f inp none.inp | attach | sinew info
1|1|sinew import --unit m -f inp box.obj | tled-run -n 1 | sinew info
1|1|sinew export -f model cut.sinew | attach | sinew info
1|1|attach -q < cut.sinew | sinew bind | sinew info
1|2|nonesuch-tool | attach | sinew info
2|1|attach --strictness 7 < voxels.sinew | sinew bind | sinew info
2|1|attach --nonesuch < voxels.sinew | sinew bind | sinew info
1|2|us-import none | us-segment -n vein --low 1 > out
1|2|us-segment -n vein --low 1 none.nrrd | us-surface -l vein > out
1|2|us-surface -l vein none.nrrd | voxelise --unit mm -s 5 - > out
1|1|us-slice --rigid --poses press.tum --depth 5cm none.nrrd > out
1|1|sinew deform none.obj < run.sinew > out
1|1|sinew info < cut.sinew
1|1|sinew export -f vtu < cut.sinew > out
1|1|sinew render < cut.sinew > out
2|1|sinew diff cut.sinew cut.sinew
END
# The same, where what goes on is no model, and cat takes anything.
cat >"$T/others" <<'END'
us-import none
us-segment -n vein --low 1 none.nrrd
us-surface -l vein none.nrrd
us-slice --rigid --poses press.tum --depth 5cm none.nrrd
sinew deform none.obj < run.sinew
sinew info < cut.sinew
sinew export -f vtu < cut.sinew
sinew render < cut.sinew
END

# in_shell NAME COMMAND: runs it there; make's own words are not the tools'.
in_shell() {
    case $1 in
    busybox) busybox sh -c "$2" ;;
    make)
        printf '.DELETE_ON_ERROR:\nout:\n\t@%s\n' "$2" >Makefile
        env -u MAKEFLAGS -u MAKELEVEL make -s 2>"$T/made"
        made=$?
        sed -n 's/^make: \*\*\* .* Error \([0-9]*\)$/\1/p' "$T/made" >"$T/status"
        grep -v '^make: ' "$T/made" >&2
        [ "$made" -eq 0 ] || return "$(cat "$T/status")"
        ;;
    *) "$1" -c "$2" ;;
    esac
}
for shell in bash dash zsh busybox make; do
    if ! have $shell; then
        skip 3 "no $shell"
        continue
    fi
    case $shell in
    bash | make) each=1 ;;
    *) [ "$SINEW_LONG" ] && each=1 || each=4 ;;
    esac
    awk -v each="$each" 'NR % each == 0' "$T/models" >"$T/pipes"
    wrong=
    while IFS='|' read -r status lines command; do
        rm -f out
        in_shell $shell "$command" >"$T/stdout" 2>"$T/stderr" </dev/null
        got=$?
        said=$(wc -l <"$T/stderr" | tr -d ' ')
        [ "$got" -eq "$status" ] && [ "$said" -eq "$lines" ] && continue
        wrong="$wrong$command: status $got, wanted $status; $said lines, wanted $lines: $(head -n 3 "$T/stderr")
"
    done <"$T/pipes"
    is "$wrong" "" "$shell: every tool's failure comes out at the end, said once"
    if [ $shell = make ]; then
        in_shell make 'sinew export -f vtu < cut.sinew > out' 2>/dev/null
        check "make: .DELETE_ON_ERROR leaves no half target" test ! -e out
        have bash || continue
    fi
    fail_first='set -o pipefail; '
    if [ $shell != make ] && ! in_shell $shell "$fail_first true" 2>/dev/null; then
        skip 1 "$shell has no pipefail"
        continue
    fi
    awk -v each="$each" 'NR % each == 0' "$T/others" >"$T/last"
    wrong=
    while read -r command; do
        if [ $shell = make ]; then
            printf 'SHELL = bash\n.SHELLFLAGS = -o pipefail -c\nall:\n\t@%s | cat > out\n' "$command" >Makefile
            env -u MAKEFLAGS -u MAKELEVEL make -s >/dev/null 2>&1 && wrong="$wrong$command; "
        else
            in_shell $shell "$fail_first$command | cat > out" >/dev/null 2>&1 </dev/null && wrong="$wrong$command; "
        fi
    done <"$T/last"
    is "$wrong" "" "$shell: with pipefail, a tool that hands on no model is seen through cat"
done
done_testing
