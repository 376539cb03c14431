# Closed surfaces from equations, as OBJ: what the shapes in this folder share. A shape calls begin(), then closed() for each
# surface, whose points its own function point() gives, or vertex() and face() by itself, and flush() after each
# group. Points, texture coordinates and normals that are written alike are one.

# As few digits as read back the same to a nanometre (of millimetres); no negative zero.
function number(x)
{
    x = sprintf("%.6f", x)
    sub(/0+$/, "", x)
    sub(/\.$/, "", x)
    return x == "-0" ? "0" : x
}

# The index of "TYPE text", written when it is new.
function index_of(type, text)
{
    if (!((type, text) in known)) {
        known[type, text] = ++count[type]
        print type " " text
    }
    return known[type, text]
}

function vertex(x, y, z)
{
    return index_of("v", number(x) " " number(y) " " number(z))
}

function texture(u, v)
{
    return index_of("vt", number(u) " " number(v))
}

function normal(x, y, z,    length_)
{
    length_ = sqrt(x * x + y * y + z * z)
    return index_of("vn", number(x / length_) " " number(y / length_) " " number(z / length_))
}

# Faces wait until the group's vertices are written.
function face(text)
{
    faces[++waiting] = "f " text
}

function flush(group, material)
{
    flush_first(waiting, group, material)
}

# Only the first n faces that wait.
function flush_first(n, group, material,    i)
{
    print "g " group
    print "usemtl " material
    for (i = 1; i <= n; i++)
        print faces[i]
    for (i = n + 1; i <= waiting; i++)
        faces[i - n] = faces[i]
    waiting -= n
}

function begin(title)
{
    print "# " title
    print "# millimetres; made by samples/*.awk from equations"
}

# One corner of a grid: P holds its points, N its normals.
function corner(i, j, rows, columns,    at)
{
    at = i SUBSEP j % columns
    return P[at] "/" texture(j / columns, 1 - i / rows) "/" N[at]
}

# A surface like a globe: point(name, u, i, rows) puts its place into X, Y, Z, with u from 0 to 1 around and i from 0 to rows from
# pole to pole; at the poles, u must not matter. Seen from outside, u runs to the right and i down.
function closed(name, rows, columns,    i, j, k, at, top, bottom, left, right)
{
    for (i = 0; i <= rows; i++)
        for (j = 0; j < columns; j++) {
            at = i SUBSEP j
            point(name, j / columns, i, rows)
            P[at] = vertex(X, Y, Z)
            PX[at] = X
            PY[at] = Y
            PZ[at] = Z
        }
    for (i = 0; i <= rows; i++)
        for (j = 0; j < columns; j++) {
            # At a pole: across it, to the opposite side of the first row.
            top = (i > 0 ? i - 1 : 1) SUBSEP (i > 0 ? j : (j + columns / 2) % columns)
            bottom = (i < rows ? i + 1 : rows - 1) SUBSEP (i < rows ? j : (j + columns / 2) % columns)
            k = i == 0 ? 1 : i == rows ? rows - 1 : i
            left = k SUBSEP (i > 0 && i < rows ? (j + columns - 1) % columns : (j + columns - int(columns / 4)) % columns)
            right = k SUBSEP (i > 0 && i < rows ? (j + 1) % columns : (j + int(columns / 4)) % columns)
            cross_normal(i SUBSEP j, PX[bottom] - PX[top], PY[bottom] - PY[top], PZ[bottom] - PZ[top],
                PX[right] - PX[left], PY[right] - PY[left], PZ[right] - PZ[left])
        }
    for (i = 0; i < rows; i++)
        for (j = 0; j < columns; j++)
            if (i == 0)
                face(corner(i, j, rows, columns) " " corner(i + 1, j, rows, columns) " " corner(i + 1, j + 1, rows, columns))
            else if (i == rows - 1)
                face(corner(i, j, rows, columns) " " corner(i + 1, j, rows, columns) " " corner(i, j + 1, rows, columns))
            else
                face(corner(i, j, rows, columns) " " corner(i + 1, j, rows, columns) " " \
                    corner(i + 1, j + 1, rows, columns) " " corner(i, j + 1, rows, columns))
}

function cross_normal(at, ax, ay, az, bx, by, bz)
{
    N[at] = normal(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
}
