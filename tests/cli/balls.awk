# Two balls of R mm as an OBJ, GAP mm apart along x, the right one OFF mm aside; n x 2n polygons each.
function ball(cx, cy,    i, j, b, t, p, a, c) {
    b = count
    printf "v %.9g %.9g %.9g\nv %.9g %.9g %.9g\n", cx, cy, R, cx, cy, -R
    count += 2
    for (i = 1; i < n; i++)
        for (j = 0; j < m; j++) {
            t = pi * i / n
            p = 2 * pi * j / m
            printf "v %.9g %.9g %.9g\n", cx + R * sin(t) * cos(p), cy + R * sin(t) * sin(p), R * cos(t)
            count++
        }
    for (j = 0; j < m; j++) {
        print "f", b + 1, b + 3 + j, b + 3 + (j + 1) % m
        print "f", b + 2, b + 3 + (n - 2) * m + (j + 1) % m, b + 3 + (n - 2) * m + j
    }
    for (i = 1; i < n - 1; i++)
        for (j = 0; j < m; j++) {
            a = b + 3 + (i - 1) * m + j
            c = b + 3 + (i - 1) * m + (j + 1) % m
            print "f", a, a + m, c + m, c
        }
}
BEGIN {
    pi = atan2(0, -1)
    if (!n) n = 24
    m = 2 * n
    print "g ball"
    ball(-R - GAP / 2, 0)
    ball(R + GAP / 2, OFF + 0)
}
