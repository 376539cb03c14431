# Of a model of hexahedra with results, as text: its volume (m3), how far its middle and its furthest node have moved in the last
# frame (m), and the shortest edge of an element (m).
function side(e, a, b, c, d) { # the two triangles of a face, seen from outside
    return triangle(e, a, b, c) + triangle(e, a, c, d)
}
function triangle(e, a, b, c,    i, j, k) {
    i = n[e, a]; j = n[e, b]; k = n[e, c]
    return (x[i] * (y[j] * z[k] - z[j] * y[k]) + y[i] * (z[j] * x[k] - x[j] * z[k]) + z[i] * (x[j] * y[k] - y[j] * x[k])) / 6
}
function edge(e, a, b,    i, j, square) {
    i = n[e, a]; j = n[e, b]
    square = (x[i] - x[j]) ^ 2 + (y[i] - y[j]) ^ 2 + (z[i] - z[j]) ^ 2
    if (!shortest || square < shortest) shortest = square
}
$1 == "array" { what = $2; row = 0; next }
$1 == "crc" || $1 == "frame" || $1 == "end" || $1 == "axis" { what = ""; next }
what == "node.position" { x[row] = $1; y[row] = $2; z[row++] = $3 }
what == "element.node" { for (i = 0; i < 8; i++) n[row, i] = $(i + 1); elements = ++row }
what == "node.displacement" { u[row] = $1; v[row] = $2; w[row++] = $3; nodes = row }
END {
    for (e = 0; e < elements; e++) {
        own = side(e, 0, 3, 2, 1) + side(e, 4, 5, 6, 7) + side(e, 0, 1, 5, 4) + side(e, 1, 2, 6, 5) + side(e, 2, 3, 7, 6) + side(e, 3, 0, 4, 7)
        volume += own
        for (i = 0; i < 4; i++) {
            edge(e, i, (i + 1) % 4); edge(e, i + 4, (i + 1) % 4 + 4); edge(e, i, i + 4)
        }
        for (i = 0; i < 8; i++) {
            a += own * u[n[e, i]] / 8; b += own * v[n[e, i]] / 8; c += own * w[n[e, i]] / 8
        }
    }
    for (i = 0; i < nodes; i++) {
        far = sqrt(u[i] * u[i] + v[i] * v[i] + w[i] * w[i])
        if (far > most) most = far
    }
    printf "%.6g %.6g %.6g %.6g\n", volume, sqrt(a * a + b * b + c * c) / volume, most, sqrt(shortest)
}
