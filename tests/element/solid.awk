# A solid of nx x ny x nz hexahedra as Abaqus input, which CalculiX and sinew import read: nodes, elements, node sets and a material; the caller
# adds conditions and steps. Or, with load=ccx or load=script, a uniform traction on its side X0 or X1 instead, as what each node of it bears.
#   type      C3D8, C3D8I, C3D8R (8 nodes), C3D20, C3D20R (20)
#   shape     box: x by y by z, corner at the origin; cook: Cook's membrane, 48 x 44 to 16, z thick; trapezoids, parallelograms: a box whose inner
#             sections lean by 45 degrees in the plane xy; twisted: a box that turns by 90 degrees about x; cylinder: of radius x / 2 about z
#   unit      of these lengths, in m [1]
#   law       neo (default) with E and nu or mu and K; linear with E and nu; yeoh with c10, c20, c30 and K; rho [1000]
#   side force  of a load: X0 or X1; the total as "fx,fy,fz"; ramp and late: the times at which it is full and until which the script lasts
#   twist     of a script: a moment about x on the four edges' ends of that side, for ny = nz = 1
# Nodes are numbered along x, then y, then z, of a grid of half the elements' sides.
function place(a, b, c,    lean, t, u, v, m, s) { # of a corner, 0 to 1 along each axis: at px, py, pz
    px = a * x; py = b * y; pz = c * z
    if (shape == "cook") { px = 48 * a; py = 44 * a + b * (44 - 28 * a) }
    if (a > 0 && a < 1 && (shape == "trapezoids" || shape == "parallelograms")) {
        lean = shape == "trapezoids" && int(a * nx + .5) % 2 ? -1 : 1
        px += lean * (b - .5) * y
    }
    if (shape == "twisted") {
        t = a * atan2(0, -1) / 2
        u = (b - .5) * y; v = (c - .5) * z
        py = u * cos(t) - v * sin(t); pz = u * sin(t) + v * cos(t)
    }
    if (shape == "cylinder") {
        u = 2 * a - 1; v = 2 * b - 1
        m = u * u > v * v ? sqrt(u * u) : sqrt(v * v)
        px = py = 0
        if (m) {
            t = sin(u / m * atan2(0, -1) / 4) / cos(u / m * atan2(0, -1) / 4)
            s = sin(v / m * atan2(0, -1) / 4) / cos(v / m * atan2(0, -1) / 4)
            px = x / 2 * m * (m * t / sqrt(t * t + s * s) + (1 - m) * .75 * u / m)
            py = x / 2 * m * (m * s / sqrt(t * t + s * s) + (1 - m) * .75 * v / m)
        }
    }
}
function put(i, j, k,    qx, qy, qz) { # a node: a corner, or the middle of two
    place(int(i / 2) / nx, int(j / 2) / ny, int(k / 2) / nz)
    qx = px; qy = py; qz = pz
    place(int((i + 1) / 2) / nx, int((j + 1) / 2) / ny, int((k + 1) / 2) / nz)
    px = (px + qx) / 2 * unit; py = (py + qy) / 2 * unit; pz = (pz + qz) / 2 * unit
}
function node(i, j, k) { return 1 + i + (2 * nx + 1) * (j + (2 * ny + 1) * k) }
function is_used(i, j, k) { return quadratic ? i % 2 + j % 2 + k % 2 < 2 : i % 2 + j % 2 + k % 2 == 0 }
function add(set, n) { sets[set] = sets[set] n ",\n" }
function corner(i, j, k) { return " " node(i, j, k) "," }
function sides(j, n) { return j && j < 2 * n ? 2 : 1 } # elements on both sides of it, or on one
function share(j, k) { # of a uniform traction on a side, consistent with the shape functions
    if (!quadratic) return sides(j, ny) * sides(k, nz) / (4 * ny * nz)
    if (j % 2) return sides(k, nz) / (3 * ny * nz)
    if (k % 2) return sides(j, ny) / (3 * ny * nz)
    return -sides(j, ny) * sides(k, nz) / (12 * ny * nz)
}
function bear(i, j, k, fx, fy, fz,    at) {
    if (load == "ccx") {
        if (fx) printf "%d, 1, %.12g\n", node(i, j, k), fx
        if (fy) printf "%d, 2, %.12g\n", node(i, j, k), fy
        if (fz) printf "%d, 3, %.12g\n", node(i, j, k), fz
        return
    }
    put(i, j, k)
    at = sprintf("force %.12g,%.12g,%.12g %.3g", px, py, pz, 1e-4 * unit)
    printf "0 %s 0,0,0\n%g %s %.15g,%.15g,%.15g\n%g %s %.15g,%.15g,%.15g\n", at, ramp, at, fx, fy, fz, late, at, fx, fy, fz
}
function print_load(    i, j, k, w, f) {
    split(force, f, ",")
    i = side == "X0" ? 0 : 2 * nx
    for (k = 0; k <= 2 * nz; k++) for (j = 0; j <= 2 * ny; j++) {
        if (!is_used(i, j, k)) continue
        w = share(j, k)
        if (twist) {
            if (j % 2 == 0 && k % 2 == 0) bear(i, j, k, 0, 0, (j ? 1 : -1) * twist / (2 * y * unit))
        } else bear(i, j, k, w * f[1], w * f[2], w * f[3])
    }
}
function print_nodes(    i, j, k, n) {
    print "*NODE, NSET=NALL"
    for (k = 0; k <= 2 * nz; k++) for (j = 0; j <= 2 * ny; j++) for (i = 0; i <= 2 * nx; i++) {
        if (!is_used(i, j, k)) continue
        put(i, j, k)
        n = node(i, j, k)
        printf "%d, %.12g, %.12g, %.12g\n", n, px, py, pz
        if (i == 0) add("X0", n)
        if (i == 2 * nx) add("X1", n)
        if (j == 0) add("Y0", n)
        if (j == 2 * ny) add("Y1", n)
        if (k == 0) add("Z0", n)
        if (k == 2 * nz) add("Z1", n)
        if (i == 0 && j == 0 && k == 0) add("ORIGIN", n)
        if (i == 2 * nx && j == 2 * ny && k == 2 * nz) add("LAST", n)
    }
}
function print_elements(    i, j, k, line) {
    print "*ELEMENT, ELSET=SOLID, TYPE=" type
    for (k = 0; k < 2 * nz; k += 2) for (j = 0; j < 2 * ny; j += 2) for (i = 0; i < 2 * nx; i += 2) {
        line = ++element "," corner(i, j, k) corner(i + 2, j, k) corner(i + 2, j + 2, k) corner(i, j + 2, k)
        line = line corner(i, j, k + 2) corner(i + 2, j, k + 2) corner(i + 2, j + 2, k + 2) corner(i, j + 2, k + 2)
        if (quadratic) {
            line = line corner(i + 1, j, k) corner(i + 2, j + 1, k) "\n" corner(i + 1, j + 2, k) corner(i, j + 1, k)
            line = line corner(i + 1, j, k + 2) corner(i + 2, j + 1, k + 2) corner(i + 1, j + 2, k + 2) corner(i, j + 1, k + 2)
            line = line corner(i, j, k + 1) corner(i + 2, j, k + 1) corner(i + 2, j + 2, k + 1) corner(i, j + 2, k + 1)
        }
        sub(/,$/, "", line)
        print line
    }
}
function print_material() {
    if (mu == "" && law != "yeoh") { mu = E / (2 * (1 + nu)); K = E / (3 * (1 - 2 * nu)) }
    # D2 and D3 of 0 would be CalculiX's own, which are small: then nothing changes its volume by more than a little.
    if (law == "yeoh") printf "*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, YEOH\n%.15g, %.15g, %.15g, %.15g, 1e12, 1e12\n", c10, c20, c30, 2 / K
    else if (law == "linear") printf "*MATERIAL, NAME=TISSUE\n*ELASTIC\n%.15g, %.15g\n", E, nu
    else printf "*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, NEO HOOKE\n%.15g, %.15g\n", mu / 2, 2 / K
    printf "*DENSITY\n%.15g\n*SOLID SECTION, ELSET=SOLID, MATERIAL=TISSUE\n", rho == "" ? 1000 : rho
}
BEGIN {
    if (!unit) unit = 1
    quadratic = type ~ /^C3D20/
    if (load) { print_load(); exit }
    print_nodes()
    print_elements()
    for (set in sets) printf "*NSET, NSET=%s\n%s", set, sets[set]
    print_material()
}
