# The mean over a plane side of what moved: reads a model in text whose last frame has node.displacement; prints the mean displacement along
# axis c (1, 2, 3) of the nodes whose place at rest has coordinate `at` (m) along axis `on`, over the area of a grid of rectangles: of nodes at
# the rim a half, of those at its corners a quarter.
$1 == "array" { rest = $2 == "node.position"; moved = $2 == "node.displacement"; next }
$1 == "crc" || $1 == "frame" || $1 == "end" { rest = moved = 0; next }
rest { n++; for (i = 1; i <= 3; i++) x[n, i] = $i }
moved { u[++m] = $c }
END {
    p = on % 3 + 1
    q = p % 3 + 1
    for (i = 1; i <= m; i++) {
        if ((x[i, on] - at) ^ 2 > 1e-16) continue
        side[++count] = i
        if (count == 1 || x[i, p] < p0) p0 = x[i, p]
        if (count == 1 || x[i, p] > p1) p1 = x[i, p]
        if (count == 1 || x[i, q] < q0) q0 = x[i, q]
        if (count == 1 || x[i, q] > q1) q1 = x[i, q]
    }
    for (i = 1; i <= count; i++) {
        k = side[i]
        w = (x[k, p] > p0 && x[k, p] < p1 ? 2 : 1) * (x[k, q] > q0 && x[k, q] < q1 ? 2 : 1)
        weights += w
        sum += w * u[k]
    }
    printf "%.9g\n", sum / weights
}
