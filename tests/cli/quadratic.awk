# The input file that sinew export -f inp writes for CalculiX, with quadratic elements: C3D20R in place of C3D8R, a new node in the middle
# of each edge, held where both ends of the edge are. The nodes that there were keep their numbers, and they alone are printed.
BEGIN {
    FS = ", *"
    ends = "1 2 2 3 3 4 4 1 5 6 6 7 7 8 8 5 1 5 2 6 3 7 4 8"
    split(ends, end, " ")
}
function middle(a, b, edge) {
    edge = a < b ? a " " b : b " " a
    if (!(edge in at)) {
        at[edge] = nodes + ++middles
        from[middles] = a
        to[middles] = b
    }
    return at[edge]
}
function write_elements(i, c) {
    for (i = 1; i <= elements; i++) {
        line[i] = element[i]
        split(element[i], n, ", *")
        for (c = 1; c <= 24; c += 2) line[i] = line[i] (c == 5 ? ",\n" : ", ") middle(n[1 + end[c]], n[1 + end[c + 1]])
    }
    print "*NODE, NSET=NMIDDLE"
    for (i = 1; i <= middles; i++)
        printf "%d, %.15g, %.15g, %.15g\n", nodes + i, (x[from[i]] + x[to[i]]) / 2, (y[from[i]] + y[to[i]]) / 2, (z[from[i]] + z[to[i]]) / 2
    print "*ELEMENT, TYPE=C3D20R, ELSET=EALL"
    for (i = 1; i <= elements; i++) print line[i]
    elements = 0
}
/^\*/ {
    if (elements) write_elements()
    if (section == "rigid") for (i = 1; i <= middles; i++) if (from[i] in rigid && to[i] in rigid) print nodes + i ","
    section = /^\*NODE, NSET=NALL/ ? "node" : /^\*ELEMENT/ ? "element" : /^\*NSET, NSET=RIGID/ ? "rigid" : ""
    if (section != "element") print
    next
}
section == "element" { element[++elements] = $0; next }
section == "node" { nodes = $1; x[$1] = $2; y[$1] = $3; z[$1] = $4 }
section == "rigid" { for (i = 1; i <= NF; i++) if ($i != "") rigid[$i] }
{ print }
