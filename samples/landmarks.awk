# How far landmarks of a face move, in the unit of its OBJ: a line for each expression, with its name and, for each landmark, the way's
# x, y, z and length. A landmark is the vertex of the skin (groups whose names begin with skin) nearest to its place in a list.
#   awk -f landmarks.awk LIST REST.obj EXPRESSION.obj...
# LIST: lines of a name and x, y, z; # begins a comment. All OBJs have the same vertices; an expression's name is its file's.
function put_heading(    i) {
    printf "expression"
    for (i = 1; i <= landmarks; i++)
        printf "\t%s.x\t%s.y\t%s.z\t%s", name[i], name[i], name[i], name[i]
    print ""
}
function find(    i, v, d, least) {
    for (i = 1; i <= landmarks; i++) {
        least = -1
        for (v in skin) {
            d = (x[v] - place[i, 1]) ^ 2 + (y[v] - place[i, 2]) ^ 2 + (z[v] - place[i, 3]) ^ 2
            if (least < 0 || d < least || (d == least && v + 0 < at[i])) {
                least = d
                at[i] = v + 0
            }
        }
    }
}
function put_row(    i, dx, dy, dz, file) {
    file = which
    sub(/.*\//, "", file)
    sub(/[.]obj$/, "", file)
    printf "%s", file
    for (i = 1; i <= landmarks; i++) {
        dx = moved[at[i], 1] - x[at[i]]
        dy = moved[at[i], 2] - y[at[i]]
        dz = moved[at[i], 3] - z[at[i]]
        printf "\t%.2f\t%.2f\t%.2f\t%.2f", dx, dy, dz, sqrt(dx * dx + dy * dy + dz * dz)
    }
    print ""
}
FNR == 1 {
    if (++file == 3) { find(); put_heading() }
    if (file > 3) put_row()
    which = FILENAME
    vertices = 0
}
file == 1 {
    sub(/#.*/, "")
    if (NF) { name[++landmarks] = $1; for (i = 1; i <= 3; i++) place[landmarks, i] = $(i + 1) }
    next
}
$1 == "v" && file == 2 { x[++vertices] = $2; y[vertices] = $3; z[vertices] = $4 }
$1 == "v" && file > 2 { vertices++; for (i = 1; i <= 3; i++) moved[vertices, i] = $(i + 1) }
$1 == "g" && file == 2 { is_skin = $2 ~ /^skin/ }
$1 == "f" && file == 2 && is_skin { for (i = 2; i <= NF; i++) skin[$i + 0] }
END { if (file > 2) put_row() }
