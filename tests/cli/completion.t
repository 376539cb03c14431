#!/bin/sh
# Completion in bash and zsh, made of the option tables: real shells at a pseudo-terminal are asked what they offer.
. "$(dirname "$0")/lib.sh"

have python3 || skip_all "no python3"
tools="voxelise attach bind tled-run msds-mesh msds-run us-import us-segment us-surface us-slice sinew-materials sinew-deform sinew-results sinew-info sinew-diff sinew-distance sinew-poses sinew-igtl-out sinew-register sinew-export sinew-import sinew-render sinew-console sinew-igtl-in"
mkdir "$T/bash" "$T/zsh" "$T/here" "$T/here/sub"
for tool in $tools sinew; do
    "$tool" --table zsh >"$T/zsh/_$tool"
    # As installed: bash's own bind has none.
    [ "$tool" = bind ] || "$tool" --table bash >"$T/bash/$tool"
done
ln -s voxelise "$T/bash/voxelize"
for file in face.obj face.txt head.obj.gz 'two words.obj' a.nrrd b.mhd; do
    : >"$T/here/$file"
done
cp tests/cli/small.sinew "$T/here/small"
# Names are a stranger's.
# shellcheck disable=SC2016 # that is the name
sed '/^crc/d; s/"muscle_a"/"muscle_$(touch pwned) `touch pwned`;x"/' tests/cli/small.sinew >"$T/here/rude"
printf '%%sinew 1 text\naxis material 1\narray material.name str 1 material 1\n"tissue"\narray material.law str 1 material 1\n"mooney-rivlin"\nend\n' \
    >"$T/here/rubber"
gzip -c tests/cli/small.sinew >"$T/here/small.gz"
head -c 300 tests/cli/small.sinew >"$T/here/cut"
mkfifo "$T/here/pipe"
ln -s small "$T/here/-"

# What is asked, and what is to be offered.
cat >"$T/asked" <<'END'
tled-run -d |auto cpu cuda
tled-run --device c|cpu cuda
tled-run --pre|--precision
tled-run --probe |convex: curved: linear: sphere:
tled-run --dt |
tled-run --script f|face.obj face.txt
sinew export -f |inp model msh obj vtu
sinew-export --frame |all last rest undeformed
sinew-deform --format=p|pc2
voxelize --unit |cm in m mm um
voxelise --unit |cm in m mm um
voxelise f|face.obj
voxelise -n 3 h|head.obj.gz
msds-mesh --like |a.nrrd b.mhd sub
us-slice |a.nrrd b.mhd sub
us-slice --probe |curved: linear: phased:
attach --fibre |auto axis centre field round shape
sinew de|deform
sinew |--help --version attach bind console deform diff distance export help igtl-in igtl-out import info materials msds-mesh msds-run poses register render results tled-run us-import us-segment us-slice us-surface voxelise
sinew help def|deform
sinew bind --u|--unit
sinew bind f|face.obj
sinew info --t|--tsv
sinew render --format |png ppm
tled-run -c |
tled-run < small -c |muscle_a
tled-run < small.gz --contract |muscle_a
tled-run < small --contract=|muscle_a
tled-run < small -c mu|muscle_a
tled-run < small -c muscle_a=0.4,|muscle_a
tled-run < small -m T|Tissue.E Tissue.angle Tissue.density Tissue.eta Tissue.fibre Tissue.k1 Tissue.k2 Tissue.kappa Tissue.law Tissue.nu Tissue.optimum Tissue.passive Tissue.peak Tissue.series Tissue.stiffening Tissue.straight Tissue.vmax
tled-run < small -m tissue.l|tissue.law
tled-run < rubber -m |tissue.K tissue.angle tissue.c01 tissue.c10 tissue.density tissue.eta tissue.fibre tissue.k1 tissue.k2 tissue.kappa tissue.law tissue.nu tissue.optimum tissue.passive tissue.peak tissue.series tissue.stiffening tissue.straight tissue.vmax
tled-run < face.txt -c |
tled-run < cut -c |
tled-run < sub -c |
tled-run < - -d cpu -c |
tled-run < rude -c |muscle_$(touch pwned) `touch pwned`;x
sinew tled-run < small -c |muscle_a
sinew export small -f obj --surface |s
sinew-render small --show vo|voxels
sinew-render small --clear s|s skin surface
sinew info small --get mus|muscle.centre muscle.name muscle.volume
sinew-diff small small --only volume.m|volume.material volume.muscle
attach < small --rigid |edge lip skin
msds-mesh < small --fix s|sides skin
END
for shell in bash zsh; do
    if ! have $shell; then
        skip 1 "no $shell"
        continue
    fi
    for tool in $tools sinew; do
        file=$T/bash/$tool
        [ $shell = zsh ] && file=$T/zsh/_$tool
        [ ! -e "$file" ] || $shell -n "$file" >>"$T/wrong" 2>&1
    done
    is "$(cat "$T/wrong" 2>/dev/null)" "" "$shell: every script is one"
    set --
    while IFS='|' read -r line _; do
        set -- "$@" "$line"
    done <"$T/asked"
    for tool in $tools; do
        [ "$shell $tool" = "bash bind" ] || set -- "$@" "$tool --"
    done
    folder=$T/$shell
    harness=$ROOT/tests/cli/complete.py
    # shellcheck disable=SC2016 # for the inner shell
    check "$shell: it answers" sh -c 'cd "$1" && shift && exec python3 "$@"' - "$T/here" "$harness" $shell "$folder" "$@"
    # bash says it with what is there, and with what follows a name
    sed -E 's/\\//g; s/^--(format|contract)=//; s/^muscle_a=0.4,//; s/([a-zA-Z0-9_x])[=.]( |$)/\1\2/g' "$T/stdout" >"$T/offered"
    number=0
    while IFS='|' read -r line want; do
        number=$((number + 1))
        is "$(sed -n "${number}p" "$T/offered")" "$want" "$shell: $line"
    done <"$T/asked"
    # Every option that the usage names is offered.
    for tool in $tools; do
        [ "$shell $tool" = "bash bind" ] && continue
        number=$((number + 1))
        is "$(sed -n "${number}p" "$T/offered")" \
            "$(options_of "$tool" | grep -e '^--' | tr '\n' ' ' | sed 's/ $//')" \
            "$shell: $tool --"
    done
done
# What no shell can be asked at its prompt: a FIFO that nobody writes to, a file that is not there; and a cursor before the model.
if have bash; then
    while IFS='|' read -r words want; do
        # shellcheck disable=SC2016 # for the inner shell
        is "$(cd "$T/here" && timeout 180 bash -c '. "$1/tled-run"; compopt() { :; }; COMP_WORDS=($2) COMP_CWORD=2; COMP_WORDS[2]=; _sinew_complete_tled_run
            echo "${COMPREPLY[*]}"' - "$T/bash" "$words" 2>&1)" "$want" "bash: $words"
    done <<'END'
tled-run -c X < small|muscle_a=
tled-run -c X < nonesuch|
tled-run -c X < pipe|
tled-run -c X < /dev/zero|
END
fi
is "$(ls "$T/here/pwned" 2>/dev/null)" "" "no name of a model was run"
done_testing
