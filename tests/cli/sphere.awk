# A closed sphere about the origin as an OBJ: -v r=RADIUS -v n=BANDS; quadrangles, and triangles at the poles.
BEGIN {
    pi = atan2(0, -1)
    print "g " (g ? g : "ball")
    print "v 0 0 " r
    print "v 0 0 " (-r)
    for (i = 1; i < n; i++)
        for (j = 0; j < 2 * n; j++)
            printf "v %.9g %.9g %.9g\n", r * sin(pi * i / n) * cos(pi * j / n), r * sin(pi * i / n) * sin(pi * j / n), r * cos(pi * i / n)
    for (j = 0; j < 2 * n; j++) {
        k = (j + 1) % (2 * n)
        last = 3 + (n - 2) * 2 * n
        print "f 1", 3 + j, 3 + k
        print "f 2", last + k, last + j
        for (i = 0; i < n - 2; i++) {
            a = 3 + i * 2 * n
            print "f", a + j, a + 2 * n + j, a + 2 * n + k, a + k
        }
    }
}
