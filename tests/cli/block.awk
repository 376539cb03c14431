# A block of nx x ny x nz elements of side h (m), or of sides hx, hy, hz, as a model in text, without voxelise: corner at the origin.
#   held    low: nodes at x = 0 are rigid, of surface skull_left; top: those of the highest z, of skull_top; else none
#   muscle  1: it is one volume muscle_all, fibres along x; else skin
#   E nu    of its material, tissue (default 3000, 0.45)
#   cut     of which elements only the lower half is enclosed: sides, those at all sides but x = 0; all; else none
#   moments 1: their strain is the mean over that half
function column(name, type, unit, value) {
    print "array " name " " type " " unit " " substr(name, 1, index(name, ".") - 1) " 1"
    print value
}
function is_cut(i, j, k) {
    return cut == "all" || (cut == "sides" && (i == nx - 1 || j == 0 || j == ny - 1 || k == 0 || k == nz - 1))
}
function shares() {
    print "array element.fraction f32 1 element 1"
    for (k = 0; k < nz; k++) for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) {
        print is_cut(i, j, k) ? .5 : 1
        if (is_cut(i, j, k)) number[cuts++] = i + nx * (j + ny * k)
    }
    if (!moments) return
    print "axis cut " cuts
    print "array cut.element i32 @element cut 1"
    for (n = 0; n < cuts; n++) print number[n]
    print "array cut.moments f32 1 cut 7"
    for (n = 0; n < cuts; n++) print "0 0 -.5 0 0 0 0"
}
BEGIN {
    if (E == "") E = 3000
    if (nu == "") nu = 0.45
    if (hx == "") hx = h
    if (hy == "") hy = h
    if (hz == "") hz = h
    nodes = (nx + 1) * (ny + 1) * (nz + 1)
    elements = nx * ny * nz
    print "%sinew 1 text\nmeta source.unit \"m\"\nmeta lattice.origin \"0 0 0\""
    printf "meta lattice.spacing \"%.17g %.17g %.17g\"\n", hx, hy, hz
    print "axis node " nodes "\naxis element " elements "\naxis volume 1\naxis material 1\naxis anchor 2"
    print "array node.position f64 m node 3"
    for (k = 0; k <= nz; k++) for (j = 0; j <= ny; j++) for (i = 0; i <= nx; i++) {
        printf "%.17g %.17g %.17g\n", i * hx, j * hy, k * hz
        hold[n++] = held == "low" && i == 0 ? 0 : held == "top" && k == nz ? 1 : -1
    }
    print "array node.rigid u8 1 node 1"
    for (n = 0; n < nodes; n++) print (hold[n] >= 0) + 0
    print "array node.anchor i32 @anchor node 1"
    for (n = 0; n < nodes; n++) print hold[n]
    print "array anchor.name str 1 anchor 1\n\"skull_left\"\n\"skull_top\""
    print "array element.node i32 @node element 8"
    row = nx + 1
    layer = row * (ny + 1)
    for (k = 0; k < nz; k++) for (j = 0; j < ny; j++) for (i = 0; i < nx; i++) {
        n = i + row * j + layer * k
        print n, n + 1, n + 1 + row, n + row, n + layer, n + 1 + layer, n + 1 + row + layer, n + row + layer
    }
    print "array element.volume i32 @volume element 1"
    for (n = 0; n < elements; n++) print 0
    if (muscle) {
        print "array element.fibre f32 1 element 3"
        for (n = 0; n < elements; n++) print "1 0 0"
    }
    if (cut) shares()
    column("volume.name", "str", "1", muscle ? "\"muscle_all\"" : "\"skin\"")
    column("volume.level", "i32", "1", 0)
    column("volume.priority", "i32", "1", 0)
    column("volume.material", "i32", "@material", 0)
    column("volume.muscle", "u8", "1", muscle + 0)
    column("material.name", "str", "1", "\"tissue\"")
    column("material.law", "str", "1", "\"neo-hookean\"")
    column("material.E", "f64", "Pa", E)
    column("material.nu", "f64", "1", nu)
    column("material.density", "f64", "kg/m3", 1000)
    column("material.peak", "f64", "Pa", 30000)
    print "end"
}
