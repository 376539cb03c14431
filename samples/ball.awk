# A ball of hexahedra that conform to its surface, as Abaqus input, in metres: a cube of n^3 cells mapped onto it (W&M section
# 4.3 has 13^3 = 2197 elements).
#   awk -v n=13 -v r=0.1 -v E=3000 -v nu=0.4 -v rho=1000 -f samples/ball.awk
# holds what the cube's top side becomes: the part of the surface where z is the largest of |x|, |y| and z. A place on the cube, m from its middle (1: on its surface), goes to radius m r on
# the ball at the surface, lines of equal angles on its six sides, and more like the cube the nearer to the middle: `core` (of
# which 0.6 gives the longest stable step) is how large that cube is.
function tangent(x) {
    x *= atan2(0, -1) / 4
    return sin(x) / cos(x)
}
function largest(a, b, c) {
    if (a < 0) a = -a
    if (b < 0) b = -b
    if (c < 0) c = -c
    return a > b ? (a > c ? a : c) : (b > c ? b : c)
}
BEGIN {
    if (!n) n = 13
    if (!r) r = 0.1
    if (!E) E = 3000
    if (nu == "") nu = 0.4
    if (!rho) rho = 1000
    if (!core) core = 0.6
    print "*HEADING\nA ball of " n "^3 hexahedra\n*NODE, NSET=NALL"
    for (k = 0; k <= n; k++)
        for (j = 0; j <= n; j++)
            for (i = 0; i <= n; i++) {
                x = 2 * i / n - 1; y = 2 * j / n - 1; z = 2 * k / n - 1
                m = largest(x, y, z)
                at_x = at_y = at_z = 0
                if (m) {
                    tx = tangent(x / m); ty = tangent(y / m); tz = tangent(z / m)
                    share = m * m / sqrt(tx * tx + ty * ty + tz * tz)
                    at_x = r * ((1 - m) * core * x + share * tx)
                    at_y = r * ((1 - m) * core * y + share * ty)
                    at_z = r * ((1 - m) * core * z + share * tz)
                }
                printf "%d, %.15g, %.15g, %.15g\n", ++node, at_x, at_y, at_z
                if (k == n) held[++holds] = node
            }
    print "*ELEMENT, TYPE=C3D8R, ELSET=BALL"
    w = n + 1
    for (k = 0; k < n; k++)
        for (j = 0; j < n; j++)
            for (i = 1; i <= n; i++) {
                a = (k * w + j) * w + i; b = a + w * w
                printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++element, a, a + 1, a + w + 1, a + w, b, b + 1, b + w + 1, b + w
            }
    print "*NSET, NSET=TOP"
    for (i = 1; i <= holds; i++) printf "%d,\n", held[i]
    printf "*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, NEO HOOKE\n%.15g, %.15g\n*DENSITY\n%.15g\n", E / (4 * (1 + nu)), 6 * (1 - 2 * nu) / E, rho
    print "*SOLID SECTION, ELSET=BALL, MATERIAL=TISSUE\n*BOUNDARY\nTOP, 1, 3"
}
