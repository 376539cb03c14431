# Makes a model of lattice.awk one of tetrahedra: five a cell, of alternating parity so that they fit.
$1 == "axis" && $2 == "element" { print "axis element", 5 * $3; next }
/^meta lattice/ { next }
/^array element.lattice / { cells = 1; next }
/^array element.node / { cells = 0; nodes = 1; print "array element.node i32 @node element 4"; next }
/^[a-z]/ { cells = nodes = 0 }
cells { odd[n++] = ($1 + $2 + $3) % 2; next }
nodes && odd[e++] {
    print $1, $2, $3, $6 "\n" $1, $3, $4, $8 "\n" $6, $7, $8, $3 "\n" $5, $6, $8, $1 "\n" $1, $3, $8, $6
    next
}
nodes {
    print $1, $2, $4, $5 "\n" $2, $3, $4, $7 "\n" $5, $6, $7, $2 "\n" $5, $7, $8, $4 "\n" $2, $4, $5, $7
    next
}
{ print }
