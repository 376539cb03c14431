# A block of nx x ny x nz hexahedra of side h (m) on a lattice, as a model in text, for bind and deform.
#   unit    source.unit (default mm; none: it has none)
#   frames  results: frame k (1, 2, ...) has the displacement k (A x + b), A and b as below
#   gap     an element to leave out
#   bone    name of a rigid surface that holds the nodes at x = 0
#   ends    the last line (default end)
BEGIN {
    if (unit == "") unit = "mm"
    if (ends == "") ends = "end"
    if (gap == "") gap = -1
    nodes = (nx + 1) * (ny + 1) * (nz + 1)
    elements = nx * ny * nz - (gap >= 0)
    print "%sinew 1 text"
    if (unit != "none") print "meta source.unit \"" unit "\""
    print "meta lattice.origin \"0 0 0\""
    printf "meta lattice.spacing \"%.17g %.17g %.17g\"\n", h, h, h
    print "axis node " nodes "\naxis element " elements
    print "array node.position f64 m node 3"
    for (k = 0; k <= nz; k++) for (j = 0; j <= ny; j++) for (i = 0; i <= nx; i++) {
        printf "%.17g %.17g %.17g\n", i * h, j * h, k * h
        x[n] = i * h; y[n] = j * h; z[n++] = k * h
    }
    print "array element.lattice i32 1 element 3"
    for (k = 0; k < nz; k++) for (j = 0; j < ny; j++) for (i = 0; i < nx; i++)
        if (e++ != gap) print i, j, k
    print "array element.node i32 @node element 8"
    row = nx + 1
    layer = row * (ny + 1)
    e = 0
    for (k = 0; k < nz; k++) for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) {
        n = i + row * j + layer * k
        if (e++ != gap)
            print n, n + 1, n + 1 + row, n + row, n + layer, n + 1 + layer, n + 1 + row + layer, n + row + layer
    }
    if (bone != "") {
        print "axis anchor 1\narray anchor.name str 1 anchor 1\n\"" bone "\"\narray node.anchor i32 @anchor node 1"
        for (n = 0; n < nodes; n++) print x[n] == 0 ? 0 : -1
    }
    for (f = 1; f <= frames; f++) {
        print "frame " f " " f / 100 "\narray node.displacement f64 m node 3"
        for (n = 0; n < nodes; n++)
            printf "%.17g %.17g %.17g\n", f * (.1 * x[n] - .2 * y[n] + .3 * z[n] + .001),
                f * (.05 * x[n] + .1 * y[n] - .002), f * (-.3 * x[n] + .2 * z[n])
    }
    print ends
}
