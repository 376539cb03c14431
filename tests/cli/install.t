#!/bin/sh
# make install into a folder of its own, the tools run from there, and make uninstall leaves nothing. And every page, table and
# completion agrees with its tool.
. "$(dirname "$0")/lib.sh"

have make || skip_all "no make"
root=$T/root
tools="voxelise attach bind tled-run msds-mesh msds-run us-import us-segment us-surface us-slice sinew sinew-materials sinew-deform sinew-results sinew-info sinew-diff sinew-distance sinew-poses sinew-igtl-out sinew-register sinew-export sinew-import sinew-render sinew-console sinew-igtl-in"

# on ROOT's PREFIX: what was built for the tests, nothing else.
# shellcheck disable=SC2317 # called by name
make_here() {
    env -u MAKEFLAGS -u MAKELEVEL make -s BIN="$SINEW_BIN" DESTDIR="$root" PREFIX=/usr "$@"
}

check "make install" make_here install
is "$(cd "$root/usr/bin" && echo *)" "$(for tool in $tools voxelize; do echo "$tool"; done | LC_ALL=C sort | tr '\n' ' ' | sed 's/ $//')" \
    "usr/bin has the tools and nothing else"
is "$(find "$root" -type f ! -path '*/bin/*' ! -perm 644)" "" "what is not a tool is 644"
for tool in $tools; do
    "$tool" --help >"$T/help"
    is "$(awk 'length > 80' "$T/help")" "" "$tool: its help has 80 columns"
    is "$(awk '/^(Input|What happens|Numerics|Output|Common):$/ { printf "%s", $0 }' "$T/help" |
        grep -cE '^(Input:)?(What happens:)?(Numerics:)?(Output:)?Common:$')" 1 "$tool: its groups are in their order"
    is "$(sed -n '1s/:.*//p' "$T/help") $(sed -n '/^Example:$/,/^$/p' "$T/help" | grep -cE "^  .*${tool#sinew-}( |$)") $(tail -n 1 "$T/help")" \
        "usage 1 Manual: man $tool, man 7 sinew" "$tool: from how it is called to an example and the manual"
    # Units and defaults: [UNIT], [default X] or [UNIT; default X], at the end of what is said of an option.
    is "$(awk 'function said() {
            sub(/^ +/, "", option)
            text = substr(option, index(option, "  "))
            if (text ~ /\[/ && text !~ /^[^[]* \[(([^];[]+; )?default [^];[]+|[^];[]+)\]$/) print option
            option = ""
        }
        /^[A-Z].*:$/ { inside = 1 }
        !/^  / || /^  (-|    --)/ { said() }
        inside && /^  / { option = option $0 }
        /^Common/ { inside = 1 }
        /^(Lengths|Example)/ { inside = 0 }
        END { said() }' "$T/help")" "" "$tool: units and defaults have one form"
    page=$root/usr/share/man/man1/$tool.1
    check "$tool: its page" test -s "$page"
    is "$("$tool" --table mdoc)" "$(sed -n '/^\.\\" synopsis$/,/^\.\\" end synopsis$/{/^\.\\"/!p;}' "$page")" \
        "$tool: the page's synopsis is what --table mdoc says"
done
check "sinew-lines(5), sinew-model(5) and sinew(7)" test -s "$root/usr/share/man/man5/sinew-lines.5" -a -s "$root/usr/share/man/man5/sinew-model.5" -a -s "$root/usr/share/man/man7/sinew.7"
check "sinew-laws(7), sinew-performance(7) and sinew-tled(7)" test -s "$root/usr/share/man/man7/sinew-laws.7" -a -s "$root/usr/share/man/man7/sinew-performance.7" -a -s "$root/usr/share/man/man7/sinew-tled.7"

# The front command finds the others beside itself, not on PATH, called by any name that leads to it.
ln -s "$root/usr/bin/sinew" "$T/link"
for tool in voxelise attach bind tled-run msds-mesh msds-run us-import us-segment us-surface us-slice materials deform results info diff distance poses igtl-out register export import render console igtl-in; do
    check "sinew $tool runs from its own folder" env PATH=/usr/bin:/bin "$root/usr/bin/sinew" "$tool" --version
    is "$(sed 's/ (.*//' "$T/stdout")" "$("$tool" -V 2>/dev/null | sed 's/ (.*//' | grep . || echo "sinew-$tool")" "and is $tool"
done
is "$(cd samples && sha256sum -- *.materials)" "$(cd "$root/usr/share/sinew/materials" && sha256sum -- *.materials)" "files of materials lie beside the tools"
is "$(cd / && "$root/usr/bin/sinew" materials --tsv presets | sed -n '2s/\t.*//p')" "$root/usr/share/sinew/materials/arm.materials" "where sinew materials finds them"
check "through a symbolic link" env PATH=/usr/bin:/bin "$T/link" info --version
rm "$root/usr/bin/sinew-info"
fails 1 "a tool that is not there" "cannot run .*usr/bin/sinew-info: No such file" "$root/usr/bin/sinew" info --version
fails 2 "a tool that is none" "no tool 'inof'; did you mean 'info'\?" sinew inof
fails 2 "no tool" "^usage: sinew TOOL" sinew
is "$(sinew help)" "$(sinew --help)" "help: the list of tools"
is "$(sinew help sinew)" "$(sinew --help)" "help sinew: the same"
for tool in info tled-run voxelize sinew-diff; do
    is "$(sinew help $tool)" "$(sinew $tool --help)" "help $tool: the tool's help"
done
fails 2 "help on a tool that is none" "no tool 'inof'; did you mean 'info'\?" sinew help inof
fails 2 "help on two" "help info: extra operand 'diff'; expected one tool" sinew help info diff

# The American spelling of a name is a link.
is "$(readlink "$root/usr/bin/voxelize") $(readlink "$root/usr/share/man/man1/voxelize.1") $("$root/usr/bin/voxelize" -V | sed 's/ (.*//')" \
    "voxelise voxelise.1 voxelise" "voxelize runs voxelise, and has its page"

# What completion offers: completion.t.
for tool in $tools; do
    check "$tool: zsh's completion" grep -q "^#compdef $tool\( voxelize\)*$" "$root/usr/share/zsh/site-functions/_$tool"
    [ "$tool" = bind ] || check "$tool: bash's" grep -q "^complete .* $tool\( voxelize\)*$" "$root/usr/share/bash-completion/completions/$tool"
done
check "no completion for the shell's bind" test ! -e "$root/usr/share/bash-completion/completions/bind"

check "make uninstall" make_here uninstall
is "$(find "$root" ! -type d)" "" "and nothing is left"
done_testing
