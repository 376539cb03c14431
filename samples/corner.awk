# How far the corners of a face's mouth move, in the unit of its OBJ: x, y, z and length, of the left and the right one.
#   awk -f corner.awk REST.obj MOVED.obj
# A corner is the vertex of the skin nearest to the lower end of zygomaticus major (groups muscle_zyg*, a tube a side; z is up).
$1 == "g" { group = $2 }
$1 != "v" && $1 != "f" { next }
FNR == NR && $1 == "v" { x[++n] = $2; y[n] = $3; z[n] = $4; next }
$1 == "v" { moved[++m] = $2 " " $3 " " $4; next }
FNR == NR && group ~ /^muscle_zyg/ {
    for (i = 2; i <= NF; i++) { v = $i + 0; side = x[v] > 0; if (!(v in of)) { of[v] = side; if (!(side in low) || z[v] < low[side]) low[side] = z[v]; if (!(side in high) || z[v] > high[side]) high[side] = z[v] } }
}
FNR == NR && group == "skin" { for (i = 2; i <= NF; i++) skin[$i + 0] }
function nearest(side,    v, count, cx, cy, cz, d, least, at) {
    for (v in of)
        if (of[v] == side && z[v] < low[side] + .1 * (high[side] - low[side])) { count++; cx += x[v]; cy += y[v]; cz += z[v] }
    least = -1
    for (v in skin) {
        d = (x[v] - cx / count) ^ 2 + (y[v] - cy / count) ^ 2 + (z[v] - cz / count) ^ 2
        if (least < 0 || d < least || (d == least && v + 0 < at)) { least = d; at = v + 0 }
    }
    return at
}
END {
    for (side = 1; side >= 0; side--) {
        at = nearest(side); split(moved[at], to)
        dx = to[1] - x[at]; dy = to[2] - y[at]; dz = to[3] - z[at]
        printf "%s%.2f\t%.2f\t%.2f\t%.2f", side ? "" : "\t", dx, dy, dz, sqrt(dx * dx + dy * dy + dz * dz)
    }
    print ""
}
