# shellcheck shell=sh
# Closed boxes as OBJ groups, and models of them, for the tests of voxelise.

# box NAMES X0 Y0 Z0 X1 Y1 Z1: its vertices are counted back from the end, so that boxes follow one another.
box() {
    printf 'g %s\n' "$1"
    for z in "$4" "$7"; do
        printf 'v %s %s %s\nv %s %s %s\nv %s %s %s\nv %s %s %s\n' \
            "$2" "$3" "$z" "$5" "$3" "$z" "$2" "$6" "$z" "$5" "$6" "$z"
    done
    printf 'f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3\n'
}

# soup FILE: the OBJ with every corner a vertex of its own.
soup() {
    awk '$1 == "v" { v[++n] = $0 }
        $1 == "g" { print }
        $1 == "f" {
            line = "f"
            for (i = 2; i <= NF; i++) { print v[$i < 0 ? n + 1 + $i : $i]; line = line " " i - NF - 1 }
            print line
        }' "$1"
}

# vox ARGS...: voxelise as text into $T/m.
vox() {
    voxelise -q --text --unit mm "$@" >"$T/m" 2>"$T/said"
}

# rows ARRAY: of $T/m, a line each.
rows() {
    awk -v a="$1" '$1 == "array" { on = $2 == a; next } /^[a-z]/ { on = 0 } on' "$T/m"
}
