# Boxes as an OBJ, a group each: -v boxes='NAME X0,X1,Y0,Y1,Z0,Z1,NX,NY; ...', whose lower and upper sides are NX x NY polygons.
function put(x0, x1, y0, y1, z0, z1, n, m,    i, j, b, q, a, Q) {
    b = count
    Q = (n + 1) * (m + 1)
    for (q = 0; q < 2; q++)
        for (j = 0; j <= m; j++)
            for (i = 0; i <= n; i++) {
                print "v", x0 + (x1 - x0) * i / n, y0 + (y1 - y0) * j / m, q ? z1 : z0
                count++
            }
    for (j = 0; j < m; j++)
        for (i = 0; i < n; i++) {
            a = b + 1 + j * (n + 1) + i
            print "f", a, a + n + 1, a + n + 2, a + 1
            print "f", a + Q, a + Q + 1, a + Q + n + 2, a + Q + n + 1
        }
    for (i = 0; i < n; i++) {
        a = b + 1 + i
        print "f", a, a + 1, a + 1 + Q, a + Q
        a += m * (n + 1)
        print "f", a, a + Q, a + Q + 1, a + 1
    }
    for (j = 0; j < m; j++) {
        a = b + 1 + j * (n + 1)
        print "f", a, a + Q, a + Q + n + 1, a + n + 1
        a += n
        print "f", a, a + n + 1, a + Q + n + 1, a + Q
    }
}
BEGIN {
    boxed = split(boxes, box, "; *")
    for (k = 1; k <= boxed; k++) {
        split(box[k], word, " ")
        split(word[2], at, ",")
        print "g", word[1]
        put(at[1], at[2], at[3], at[4], at[5], at[6], at[7], at[8])
    }
}
