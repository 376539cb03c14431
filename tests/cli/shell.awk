# The surface of a box from the origin to x, y, z (mm) as an OBJ, by n x n squares a side, each side a group of its own (x0, x1, ...
# z1) with vertices of its own. Squares are cut into 4 triangles at their middles, so that none has a preferred diagonal.
#   skip    a side to leave out; turn: 1: faces point inwards; quads: 1: squares stay whole, but for those of z1
function at(side, a, b,    axis, end, p, q, s) {
    axis = substr("xyz", 1 + int(side / 2), 1)
    end = side % 2
    p[axis == "x" ? "y" : "x"] = a
    p[axis == "z" ? "y" : "z"] = b
    p[axis] = end
    printf "v %.17g %.17g %.17g\n", p["x"] * x, p["y"] * y, p["z"] * z
    return ++count
}
BEGIN {
    for (side = 0; side < 6; side++) {
        name = substr("xyz", 1 + int(side / 2), 1) side % 2
        if (name == skip) continue
        print "g " name
        flip = (side % 2 == 0) != (int(side / 2) == 1) != (turn == 1)
        for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
            c[0] = at(side, i / n, j / n)
            c[1] = at(side, (i + 1) / n, j / n)
            c[2] = at(side, (i + 1) / n, (j + 1) / n)
            c[3] = at(side, i / n, (j + 1) / n)
            if (quads && side < 5) {
                print "f " (flip ? c[3] " " c[2] " " c[1] " " c[0] : c[0] " " c[1] " " c[2] " " c[3])
                continue
            }
            m = at(side, (i + .5) / n, (j + .5) / n)
            for (k = 0; k < 4; k++)
                print "f " m " " (flip ? c[(k + 1) % 4] " " c[k] : c[k] " " c[(k + 1) % 4])
        }
    }
}
