# An octant of a thick sphere, of radii a and b (m), as Abaqus input: three patches of n x n elements, one for each side of a cube, and nr layers.
# With script=1, a script for tled-run that holds the octant's three planes and moves the inner surface out to `stretch` times its radius by
# `ramp` (s), and lasts until `late`.
function tangent(s) { return sin(s * atan2(0, -1) / 4) / cos(s * atan2(0, -1) / 4) }
function vertex(side, i, j, k,    u, v, s, r, key) {
    u = tangent(i / n); v = tangent(j / n)
    s = 1 / sqrt(1 + u * u + v * v)
    r = a + (b - a) * k / nr
    dx = (side == 0 ? 1 : side == 1 ? v : u) * s
    dy = (side == 1 ? 1 : side == 2 ? v : u) * s
    dz = (side == 2 ? 1 : side == 0 ? v : u) * s
    key = sprintf("%.9f %.9f %.9f", r / b * dx, r / b * dy, r / b * dz)
    if (!(key in known)) {
        known[key] = ++count
        x[count] = r * dx; y[count] = r * dy; z[count] = r * dz
        if (k == 0) inner[count] = 1
    }
    return known[key]
}
function free_at(place, move) { return place < 1e-9 ? "-" : sprintf("%.12g", move) }
function key_of(t, c, share) {
    printf "%g displace %.15g,%.15g,%.15g,%.15g,%.15g,%.15g %s,%s,%s\n", t, x[c], y[c], z[c], x[c], y[c], z[c],
        free_at(x[c], share * x[c]), free_at(y[c], share * y[c]), free_at(z[c], share * z[c])
}
BEGIN {
    for (side = 0; side < 3; side++) for (k = 0; k < nr; k++) for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
        line = ++element
        for (d = 0; d < 2; d++) line = line ", " vertex(side, i, j, k + d) ", " vertex(side, i + 1, j, k + d) ", " vertex(side, i + 1, j + 1, k + d) ", " vertex(side, i, j + 1, k + d)
        elements = elements line "\n"
        if (k == 0) quads = quads vertex(side, i, j, 0) " " vertex(side, i, j + 1, 0) " " vertex(side, i + 1, j + 1, 0) " " vertex(side, i + 1, j, 0) " "
    }
    if (obj) { # four triangles an element, about its middle, so that its corners bear alike
        n = split(quads, word, " ")
        for (c = 1; c <= count; c++) if (c in inner) { printf "v %.15g %.15g %.15g\n", x[c], y[c], z[c]; number[c] = ++vertices }
        for (q = 0; q < n; q += 4) {
            mx = my = mz = 0
            for (i = 1; i <= 4; i++) { c = word[q + i]; mx += x[c] / 4; my += y[c] / 4; mz += z[c] / 4 }
            printf "v %.15g %.15g %.15g\n", mx, my, mz
        }
        print "g inner"
        for (q = 0; q < n; q += 4) {
            middle = vertices + q / 4 + 1
            for (i = 1; i <= 4; i++) print "f", number[word[q + i]], number[word[q + i % 4 + 1]], middle
        }
        exit
    }
    if (script) {
        print "0 displace 0,0,0,0," b "," b " 0,-,-\n0 displace 0,0,0," b ",0," b " -,0,-\n0 displace 0,0,0," b "," b ",0 -,-,0"
        if (pressure) {
            printf "0 pressure inner:inner 0\n%g pressure inner:inner %.9g\n%g pressure inner:inner %.9g\n", ramp, pressure, late, pressure
            exit
        }
        for (c = 1; c <= count; c++) if (c in inner) { key_of(0, c, 0); key_of(ramp, c, stretch - 1); key_of(late, c, stretch - 1) }
        exit
    }
    print "*NODE, NSET=NALL"
    for (c = 1; c <= count; c++) printf "%d, %.15g, %.15g, %.15g\n", c, x[c], y[c], z[c]
    printf "*ELEMENT, ELSET=SOLID, TYPE=C3D8\n%s", elements
    mu = E / (2 * (1 + nu)); K = E / (3 * (1 - 2 * nu))
    printf "*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, NEO HOOKE\n%.15g, %.15g\n*DENSITY\n1000\n*SOLID SECTION, ELSET=SOLID, MATERIAL=TISSUE\n", mu / 2, 2 / K
}
