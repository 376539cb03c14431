# Thin plates as an OBJ of one surface: -v n=COUNT of .06 along x, as far apart, 10 x 4.
BEGIN {
    print "g skin"
    for (i = 0; i < n; i++) {
        for (c = 0; c < 8; c++) print "v", .12 * i + .06 * (c % 2), 10 * (int(c / 2) % 2), 4 * int(c / 4)
        print "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4\nf -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3"
    }
}
