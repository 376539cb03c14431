# Compares CalculiX's displacements (its .dat, first file) with those of a model's last frame in text (second file).
# Prints, relative to CalculiX: the largest difference of a node over the largest displacement; the root mean square of
# all differences over that of all displacements; the difference at the node that moved furthest; and the largest
# difference of a node inside, that eight elements hold, as the first. Then the nodes that both have, and those inside.
function norm(a, b, c) {
    return sqrt(a * a + b * b + c * c)
}
NR == FNR {
    if (NF == 4 && $1 ~ /^[0-9]+$/) {
        x[$1] = $2; y[$1] = $3; z[$1] = $4
        size = norm($2, $3, $4)
        squares += size * size
        if (size > largest) { largest = size; furthest = $1 }
    }
    next
}
$1 == "array" { on = $2 == "node.displacement"; elements = $2 == "element.node"; node = 0; next }
$1 == "crc" || $1 == "frame" || $1 == "end" { on = elements = 0 }
elements { for (i = 1; i <= NF; i++) holds[$i + 1]++ }
on && ++node in x {
    off = norm($1 - x[node], $2 - y[node], $3 - z[node])
    sum += off * off
    both++
    if (off > worst) worst = off
    if (holds[node] == 8) { inside++; if (off > worst_inside) worst_inside = off }
    if (node == furthest) at_furthest = off
}
END {
    if (both) printf "%.6f %.6f %.6f %.6f %d %d\n", worst / largest, sqrt(sum / squares), at_furthest / largest, worst_inside / largest, both, inside
}
