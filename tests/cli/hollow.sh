# shellcheck shell=sh
# A quarter of a tube in plane strain and an eighth of a hollow sphere, as OBJ, for the tests of borders by Lame's solutions: group
# skin_in at the radius $inner, skin_out at $outer (mm), at the planes between x, y and z = 0 and at these.
inner=11.3 outer=20

# tube H: a voxel thick.
tube() {
    awk -v h="$1" -v a="$inner" -v b="$outer" 'BEGIN {
        pi = atan2(0, -1); m = 512
        for (k = 0; k < 2; k++)
            for (j = 0; j < 2; j++)
                for (i = 0; i <= m; i++) {
                    r = j ? b : a; x = r * cos(pi / 2 * i / m); y = r * sin(pi / 2 * i / m)
                    printf "v %.12g %.12g %.12g\n", i == m ? 0 : x, i ? y : 0, k * h
                }
        print "g skin_in"
        for (i = 1; i <= m; i++) { f = i; c = i + 2 * (m + 1); print "f", f, c, c + 1, f + 1 }
        print "g skin_out"
        for (i = 1; i <= m; i++) {
            f = i + m + 1; c = i + 3 * (m + 1); print "f", f, f + 1, c + 1, c
            print "f", i, i + 1, i + 1 + m + 1, i + m + 1
            print "f", i + 2 * (m + 1), i + 3 * (m + 1), i + 1 + 3 * (m + 1), i + 1 + 2 * (m + 1)
        }
        print "f", 1, m + 2, 3 * m + 4, 2 * m + 3
        print "f", m + 1, 3 * m + 3, 4 * m + 4, 2 * m + 2
    }'
}
# ball H: of triangles with sides of a voxel or less.
ball() {
    awk -v h="$1" -v a="$inner" -v b="$outer" '
        function at(r, i, j, k) {
            if (!((r, i, j) in number)) {
                l = sqrt(i * i + j * j + k * k)
                printf "v %.12g %.12g %.12g\n", r * i / l, r * j / l, r * k / l
                number[r, i, j] = ++count
            }
            return number[r, i, j]
        }
        function face(a, b, c, out) { list[++faces] = out ? a " " b " " c : c " " b " " a }
        function shell(r, out) {
            for (i = 0; i < m; i++)
                for (j = 0; i + j < m; j++) {
                    k = m - i - j
                    face(at(r, i + 1, j, k - 1), at(r, i, j + 1, k - 1), at(r, i, j, k), out)
                    if (k > 1)
                        face(at(r, i + 1, j, k - 1), at(r, i + 1, j + 1, k - 2), at(r, i, j + 1, k - 1), out)
                }
        }
        function side(a, b, c, d) { list[++faces] = a " " b " " c " " d }
        BEGIN {
            m = int(2 * b / h); if (m < 24) m = 24
            shell(a, 0); inner = faces; shell(b, 1)
            for (i = 0; i < m; i++) {
                side(at(a, 0, m - i, i), at(a, 0, m - i - 1, i + 1), at(b, 0, m - i - 1, i + 1), at(b, 0, m - i, i))
                side(at(a, i, 0, m - i), at(a, i + 1, 0, m - i - 1), at(b, i + 1, 0, m - i - 1), at(b, i, 0, m - i))
                side(at(a, m - i, i, 0), at(a, m - i - 1, i + 1, 0), at(b, m - i - 1, i + 1, 0), at(b, m - i, i, 0))
            }
            print "g skin_in"
            for (i = 1; i <= faces; i++) { if (i == inner + 1) print "g skin_out"; print "f", list[i] }
        }'
}
# within X1 Y1 Z1 [Z0]: a box of a plane.
within() {
    printf -- '-1e-3mm,-1e-3mm,%smm,%smm,%smm,%smm' "${4--1e-3}" "$1" "$2" "$3"
}
plus() {
    awk -v a="$1" -v b="$2" 'BEGIN { printf "%.9g", a + b }'
}
# planes SHAPE H: the lines of a script that hold the sides at the planes of symmetry.
planes() {
    echo "0 displace $(within 1e-3 99 99) 0,-,-"
    echo "0 displace $(within 99 1e-3 99) -,0,-"
    echo "0 displace $(within 99 99 1e-3) -,-,0"
    [ "$1" = ball ] || echo "0 displace $(within 99 99 "$(plus "$2" 1e-3)" "$(plus "$2" -1e-3)") -,-,0"
}
# below A B FACTOR NAME: A times the factor is at most B.
below() {
    check "$4 ($1, $2)" awk -v a="$1" -v b="$2" -v f="$3" 'BEGIN { exit !(a * f <= b) }'
}
