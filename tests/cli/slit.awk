# A block of 40 x 40 x 40 with a slit, as an OBJ of one surface: -v w=WIDTH, 20 deep from the top, at x = 20, through the whole block;
# -v turn=ANGLE about z, in degrees; -v name=GROUP of the slit's walls.
function corner(x, y, z,    c, s) {
    c = cos(turn * atan2(0, -1) / 180)
    s = sin(turn * atan2(0, -1) / 180)
    printf "v %.15g %.15g %s\n", c * x - s * y, s * x + c * y, z
}
BEGIN {
    n = split("0 0,40 0,40 40," 20 + w / 2 " 40," 20 + w / 2 " 20," 20 - w / 2 " 20," 20 - w / 2 " 40,0 40", at, ",")
    for (k = 0; k < 2; k++)
        for (i = 1; i <= n; i++) {
            split(at[i], q, " ")
            corner(q[1], k * 40, q[2])
        }
    print "g skin"
    printf "f"
    for (i = 1; i <= n; i++) printf " %d", i
    printf "\nf"
    for (i = n; i > 0; i--) printf " %d", n + i
    print ""
    for (i = 1; i <= n; i++) {
        j = i % n + 1
        print "g", (i >= 4 && i <= 6 && name) ? name : "skin"
        print "f", i, n + i, n + j, j
    }
}
