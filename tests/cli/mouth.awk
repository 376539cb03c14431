# Of a model of the real face in text: slices of elements across x, within -v half=MM of the middle, in which upper and lower lip are not
# joined by faces where y is above 61 mm, in front of the teeth: how many are open, of how many, and the middles of those that are shut.
# Why 61: the mouth's corner closes at x = +-19.91 where y is 60.2, at 19.98 where it is 60.4, and past 20 from 60.5 on. Of the voxel of
# 1.25 mm about x = +-19.4, y = 60.6, z = -81.9 this is the last .1 mm. With --fraction 8 the slit ends there, so that this voxel joins the
# lips, though it is open for the most of it; with --fraction 4 and by centres it is parted.
function root(i) { while (up[i] != i) i = up[i] = up[up[i]]; return i }
function face(e, list,    q, n, i, j, t) {
    split(list, n, " ")
    for (i = 1; i < 4; i++) for (j = i + 1; j <= 4; j++) if (n[j] + 0 < n[i] + 0) { t = n[i]; n[i] = n[j]; n[j] = t }
    t = n[1] "," n[2] "," n[3] "," n[4]
    if (t in first) up[root(e)] = root(first[t]); else first[t] = e
}
{ gsub(/"/, "") }
/^meta lattice.origin/ { for (a = 1; a <= 3; a++) o[a] = $(a + 2) * 1000 }
/^meta lattice.spacing/ { h = $3 * 1000 }
/^[a-z]/ { on = $1 == "array" ? $2 : ""; n = 0; next }
on == "element.node" { node[n++] = $0 }
on == "element.lattice" { cell[n++] = $0 }
END {
    for (e in cell) {
        split(cell[e], c)
        x = o[1] + (c[1] + .5) * h; y = o[2] + (c[2] + .5) * h; z = o[3] + (c[3] + .5) * h
        if (x < -half || x > half || y < 61 || z < -95 || z > -70) continue
        up[e] = e; slice[c[1]] = 1
        split(node[e], q)
        face(e, q[1] " " q[2] " " q[6] " " q[5]); face(e, q[4] " " q[3] " " q[7] " " q[8])
        face(e, q[1] " " q[2] " " q[3] " " q[4]); face(e, q[5] " " q[6] " " q[7] " " q[8])
        if (z > -70 - h) top[e] = 1
        if (z < -95 + h) bottom[e] = 1
    }
    for (e in top) { split(cell[e], c); upper[c[1] "," root(e)] = 1 }
    for (e in bottom) { split(cell[e], c); if ((c[1] "," root(e)) in upper) shut[c[1]] = 1 }
    for (i in slice) { all++; open += !(i in shut); if (i in shut) list = list " " o[1] + (i + .5) * h }
    print open + 0, all list
}
