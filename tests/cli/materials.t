#!/bin/sh
# Files of materials, as voxelise and tled-run read them, assignments by -m, and what is refused.
. "$(dirname "$0")/lib.sh"

awk -v nx=4 -v ny=4 -v nz=4 -v h=0.005 -v held=top -f tests/cli/block.awk >"$T/model"
awk -v nx=4 -v ny=4 -v nz=4 -v h=0.005 -v held=top -v E=5000 -v nu=0.3 -f tests/cli/block.awk >"$T/other"
awk -v x=20 -v y=20 -v z=20 -v held=top -f tests/cli/box.awk >"$T/box.obj"

moved() { # ARG...
    tled-run "$@" <"$T/model"
}
voxels() { # ARG...
    voxelise --unit mm -s 5 "$@" "$T/box.obj"
}
row() { # MODEL: its first material
    tled-run -q -n 1 --text <"$1" 2>/dev/null | awk '/^array material\./ { name = $2; getline; printf "%s=%s ", name, $0 }
        /^array node/ && name { exit }' | sed 's/material\.//g'
}

# ---- What changes, and only that.
printf '# softer\ntissue E=5000 nu=0.3\n' >"$T/file"
tled-run -q -n 50 -g 0,0,-9.81 <"$T/other" >"$T/want"
moved -q -n 50 -g 0,0,-9.81 --materials "$T/file" >"$T/out"
check "a file gives what a model with these values gives" sinew diff "$T/want" "$T/out"
moved -q -n 50 -g 0,0,-9.81 -m tissue.E=5000 -m tissue.nu=0.3 >"$T/out"
check "so does -m" sinew diff "$T/want" "$T/out"
moved -q -n 50 -g 0,0,-9.81 -m tissue.nu=0.3 --materials "$T/file" -m tissue.E=1 -m tissue.E=5e3 >"$T/out"
check "-m comes after the file, the last one counts" sinew diff "$T/want" "$T/out"
moved -q -n 50 -g 0,0,-9.81 >"$T/out"
sinew diff "$T/want" "$T/out" >"$T/stdout"
is $? 1 "and without them it moves another way"
printf 'tissue' >"$T/nothing"
moved -q -n 1 --materials "$T/nothing" >"$T/out" && moved -q -n 1 >"$T/want"
check "a name alone changes nothing" sinew diff "$T/want" "$T/out"

# ---- voxelise makes the table.
voxels -q >"$T/made"
want='name="tissue" law="neo-hookean" E=3000 nu=0.48999999999999999 density=1000 peak=30000'
attach -q <"$T/made" >"$T/held"
is "$(row "$T/held")" "$want " "the default: W&M's values, and a peak"
printf '\nfat density=950 E=2500 # the first\nbone nu=0.3\n' >"$T/two"
voxels -q --materials "$T/two" | attach -q >"$T/held"
is "$(row "$T/held")" 'name="fat" law="neo-hookean" E=2500 nu=0.48999999999999999 density=950 peak=30000 ' \
    "a file's first material is the skin's; what it does not say is the default"
is "$(sinew info --get axis.material <"$T/held")" 2 "and the second is there"
printf 'skin surfaces=skin,skull material=bone\n' >"$T/volumes"
voxels -q --materials "$T/two" --volumes "$T/volumes" >"$T/held"
check "a volume takes the material it names" sh -c "sinew info <'$T/held' | grep -q '^  skin .* bone$'"
printf 'skin surfaces=skin,skull material=bon\n' >"$T/volumes"
fails 1 "an unknown one is refused" "volumes:1: unknown material 'bon'; did you mean 'bone'\\? expected one of: fat, bone" \
    voxels --materials "$T/two" --volumes "$T/volumes"

# ---- What is refused, by both readers, with the line; no output may be left.
refuse() { # PATTERN FILE
    printf '%b' "$2" >"$T/bad"
    rm -f "$T/left"
    fails 1 "tled-run refuses: $(printf '%s' "$2" | cut -c 1-50)" "^tled-run: .*$1" \
        moved -q --materials "$T/bad" -o "$T/left"
    [ ! -e "$T/left" ] || not_ok "no output is left by it"
    [ "$(wc -l <"$T/stderr")" -eq 1 ] || not_ok "one message"
    fails 1 "so does voxelise" "^voxelise: .*$1" voxels -q --materials "$T/bad" -o "$T/left"
    [ ! -e "$T/left" ] || not_ok "no output is left by it"
}
refuse "bad:1: 'E=0' is not allowed; expected 0.001 to 1e12 Pa" 'tissue E=0\n'
refuse "bad:2: 'E=-3' is not allowed" '\ntissue nu=0 E=-3\n'
refuse "bad:1: 'E=3kPa' is not allowed" 'tissue E=3kPa\n'
refuse "bad:1: 'E=nan' is not allowed" 'tissue E=nan\n'
refuse "bad:1: 'nu=0.5' is not allowed; expected -0.99 to 0.4999" 'tissue nu=0.5\n'
refuse "bad:1: 'density=0' is not allowed; expected 0.001 to 1e6 kg/m3" 'tissue density=0\n'
refuse "bad:1: 'peak=-1' is not allowed; expected 0 to 1e12 Pa" 'tissue peak=-1\n'
refuse "bad:1: unknown key 'density_'; did you mean 'density'\\?" 'tissue density_=1\n'
refuse "bad:1: unknown law 'hookean'; expected one of: neo-hookean" 'tissue law=hookean\n'
refuse "bad:1: 'E' is given twice" 'tissue E=1 E=2\n'
refuse "bad:1: 'E=' without a value" 'tissue E= 3000\n'
refuse "bad:1: 'soft'; expected KEY=VALUE" 'tissue soft\n'
refuse "bad:1: 'E=3000' comes first; expected NAME" 'E=3000\n'
refuse "bad:2: material 'tissue' is given twice" 'tissue\ntissue E=1\n'
refuse "bad:1: a NUL byte" 'tissue E=\00003\n'
refuse "bad:1: control character 0x1b" 'tissue \0033[1m\n'
refuse "bad:1: word 1 is not UTF-8" 'ti\0377sue E=1\n'
fails 1 "voxelise refuses an empty file" "/dev/null: no material in it" voxels --materials /dev/null -o "$T/left"
fails 1 "a file that is not there" "none: .*No such file" moved --materials "$T/none"
fails 1 "a folder" "Is a directory" moved --materials "$T"
echo 'tisue E=1' >"$T/bad"
fails 1 "tled-run refuses a name that the model lacks" "bad:1: unknown material 'tisue'; did you mean 'tissue'\\?" \
    moved --materials "$T/bad"

for bad in 'tissue.E=-1|0.001 to 1e12 Pa' 'tissue.E=|expected MATERIAL.KEY=VALUE' 'tissue.E|expected MATERIAL.KEY=VALUE' \
    'E=3|expected MATERIAL.KEY=VALUE' 'tissue=3|expected MATERIAL.KEY=VALUE' "tisue.E=3|did you mean 'tissue'" \
    "tissue.dens=3|unknown key 'dens'" 'tissue.nu=half|-0.99 to 0.4999' 'tissue.law=mooney|unknown law' \
    'tissue.E=1e400|0.001 to 1e12 Pa' '|expected MATERIAL.KEY=VALUE'; do
    fails 2 "-m '${bad%%|*}' is refused" "^tled-run: -m.*: .*${bad#*|}" moved -m "${bad%%|*}"
done
done_testing
