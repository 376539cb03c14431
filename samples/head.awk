# A head: skin and skull from polar equations about the middle of the head, and both zygomaticus major muscles, the ones that pull
# the corners of the mouth when one smiles: each a tube from the cheekbone, where it begins inside the skull, to the corner of the
# mouth. y is up, z forward, x to the head's left.
# Along a direction, a is the longitude from straight ahead, b the latitude, both in radians.

function tan(x)
{
    return sin(x) / cos(x)
}

# A smooth hill, 1 high at (a0, b0). It goes by the latitude's tangent, so that none reaches a pole.
function hill(a, b, a0, b0, wide, high)
{
    return exp(-((a - a0) / wide) ^ 2 - ((tan(b) - tan(b0)) * cos(b0) ^ 2 / high) ^ 2)
}

# The same on both sides of the face.
function hills(a, b, a0, b0, wide, high)
{
    return hill(a, b, a0, b0, wide, high) + hill(a, b, -a0, b0, wide, high)
}

function abs(x)
{
    return x < 0 ? -x : x
}

# A superellipsoid's distance along the direction.
function egg(dx, dy, dz, rx, ry, rz)
{
    return (abs(dx / rx) ^ 2.4 + abs(dy / ry) ^ 2.4 + abs(dz / rz) ^ 2.4) ^ (-1 / 2.4)
}

function skin(a, b, dx, dy, dz)
{
    return egg(dx, dy, dz, 72, 104, 92) \
        + 17 * hill(a, b, 0, -0.20, 0.13, 0.09) + 9 * hill(a, b, 0, -0.02, 0.09, 0.16) \
        + 4 * hill(a, b, 0, 0.28, 0.6, 0.09) - 5 * hills(a, b, 0.36, 0.1, 0.16, 0.1) \
        + 4 * hill(a, b, 0, -0.455, 0.22, 0.05) + 5 * hill(a, b, 0, -0.58, 0.19, 0.06) \
        - 2 * hill(a, b, 0, -0.515, 0.3, 0.025) + 10 * hill(a, b, 0, -0.86, 0.35, 0.16) \
        + 5 * hills(a, b, 0.75, -0.12, 0.25, 0.2) + 11 * hills(a, b, 1.65, -0.05, 0.12, 0.22) \
        - 10 * hills(a, b, 1.15, -0.8, 0.5, 0.35)
}

function skull(a, b, dx, dy, dz)
{
    return egg(dx, dy, dz, 65, 97, 84) \
        + 3 * hill(a, b, 0, 0.26, 0.6, 0.09) - 12 * hills(a, b, 0.4, 0.06, 0.17, 0.13) \
        - 4 * hill(a, b, 0, -0.18, 0.12, 0.12) + 4 * hills(a, b, 0.8, -0.08, 0.2, 0.11) \
        - 8 * hills(a, b, 0.6, -0.42, 0.25, 0.16) - 5 * hills(a, b, 0.3, -0.52, 0.2, 0.14) \
        + 6 * hill(a, b, 0, -0.86, 0.35, 0.16) - 10 * hills(a, b, 1.15, -0.8, 0.5, 0.35)
}

function polar(radius, a, b)
{
    X = radius * cos(b) * sin(a)
    Y = radius * sin(b)
    Z = radius * cos(b) * cos(a)
}

function radius_of(name, a, b,    dx, dy, dz)
{
    dx = cos(b) * sin(a)
    dy = sin(b)
    dz = cos(b) * cos(a)
    return name == "skin" ? skin(a, b, dx, dy, dz) : skull(a, b, dx, dy, dz)
}

# The line of a muscle, t from 0 to 1: from a little inside the cheekbone to the middle of the tissue at the corner of the mouth.
# side is 1 for the left muscle and -1 for the right one.
function muscle_line(t,    a, b, inner, outer, depth)
{
    a = side * (0.80 + (0.33 - 0.80) * t)
    b = -0.10 + (-0.51 + 0.10) * t
    inner = radius_of("skull", a, b)
    outer = radius_of("skin", a, b)
    depth = -0.05 + 0.45 * sin(PI / 2 * (t < 0.4 ? t / 0.4 : 1)) + 0.15 * t
    polar(inner + depth * (outer - inner), a, b)
}

# An ellipse, 9 x 6 mm, across the line: outward O and sideways S.
function point_muscle(u, i, rows,    t, x, y, z, tx, ty, tz, ox, oy, oz, sx, sy, sz, n, wide, thick)
{
    t = i == 0 ? 0 : i == rows ? 1 : (i - 1) / (rows - 2)
    muscle_line(t + 0.001)
    tx = X; ty = Y; tz = Z
    muscle_line(t)
    x = X; y = Y; z = Z
    tx -= x; ty -= y; tz -= z
    sx = ty * z - tz * y; sy = tz * x - tx * z; sz = tx * y - ty * x
    n = sqrt(sx * sx + sy * sy + sz * sz)
    sx /= n; sy /= n; sz /= n
    ox = sy * tz - sz * ty; oy = sz * tx - sx * tz; oz = sx * ty - sy * tx
    n = sqrt(ox * ox + oy * oy + oz * oz)
    wide = i == 0 || i == rows ? 0 : 4.5 * sin(2 * PI * u)
    thick = i == 0 || i == rows ? 0 : 3 * cos(2 * PI * u)
    X = x - wide * sx + thick * ox / n
    Y = y - wide * sy + thick * oy / n
    Z = z - wide * sz + thick * oz / n
}

function point(name, u, i, rows,    a, b)
{
    if (name ~ /^muscle/) {
        side = name ~ /left/ ? 1 : -1
        point_muscle(u, i, rows)
        return
    }
    a = 2 * PI * (u - 0.5)
    b = PI * (0.5 - i / rows)
    polar(radius_of(name, a, b), a, b)
}

BEGIN {
    PI = atan2(0, -1)
    begin("a head: skin, skull, left and right zygomaticus major")
    polar(radius_of("skin", 0.32, -0.515), 0.32, -0.515)
    print "# the mouth's left corner: " number(X) " " number(Y) " " number(Z)
    closed("skin", 96, 128)
    flush("skin", "skin")
    closed("skull", 64, 96)
    flush("skull", "bone")
    closed("muscle_zyg_left", 34, 24)
    flush("muscle_zyg_left", "muscle")
    closed("muscle_zyg_right", 34, 24)
    flush("muscle_zyg_right", "muscle")
}
