# A comb as an OBJ of one surface: -v n=TEETH of .06 along x, as far apart, 8 deep, on a back of 2; through 4.
function corner(x, y) {
    at[m++] = x " " y
}
BEGIN {
    corner(0, 0)
    corner(.12 * n, 0)
    for (i = n - 1; i >= 0; i--) {
        corner(.12 * (i + 1), 10)
        corner(.12 * i + .06, 10)
        corner(.12 * i + .06, 2)
        corner(.12 * i, 2)
    }
    for (k = 0; k < 2; k++)
        for (i = 0; i < m; i++) print "v", at[i], 4 * k
    printf "g skin\nf"
    for (i = 1; i <= m; i++) printf " %d", i
    printf "\nf"
    for (i = m; i > 0; i--) printf " %d", m + i
    print ""
    for (i = 1; i <= m; i++) print "f", i, m + i, m + i % m + 1, i % m + 1
}
