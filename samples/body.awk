# The body around the ultrasound volume of patient.awk: an upper arm and the bone in it, from equations. In its own frame the arm lies
# along x, and its volume somewhere in it, turned by a right angle about y. Millimetres.
# LC_ALL=C awk -v what=WHAT -f body.awk writes
#     skin        the arm's skin, closed, OBJ: fine where the volume is
#     skeleton    the bone, with thicker ends, OBJ
#     place       body.txt: where all of them are

# A point of the volume's axes in the body's, turned about y so that z becomes x.
function vertex(x, y, z)
{
    printf "v %.6g %.6g %.6g\n", z + 150, y, -x + 40
}

function power(x, n)
{
    return x < 0 ? -(-x) ^ n : x ^ n
}

# How wide the arm is at z, as a share of its width at the volume: less at the elbow (z below 0), and round at both ends.
function share(z,    s, end)
{
    s = z < 0 ? 1 - .22 * (z / 150) ^ 2 : 1 + .12 * (z / 150) ^ 2
    end = z < 0 ? (-z - 118) / 32 : (z - 112) / 38
    return end > 0 ? s * sqrt(1 - end * end > 0 ? 1 - end * end : 0) : s
}

# The bone's radius at z.
function thick(z,    d)
{
    d = z < 0 ? (-z - 75) / 45 : (z - 80) / 40
    return 7.6 + (d > 0 ? 8 * d * d * (3 - 2 * d) : 0)
}

# Rings of places (x, y) at each z, closed at both ends by a point.
function ring(kind, z,    i, a, s)
{
    for (i = 0; i < around; i++) {
        a = 2 * pi * i / around
        if (kind == "skin") {
            s = share(z)
            vertex(48 * s * power(cos(a), .5), 33 + 34 * s * power(sin(a), .5), z)
        } else {
            vertex(thick(z) * cos(a), 30 + thick(z) * sin(a), z)
        }
    }
}

function tube(kind, list,    n, r, i, a, at)
{
    n = split(list, at, " ")
    print "g " kind
    for (r = 1; r <= n; r++)
        ring(kind, at[r])
    vertex(0, kind == "skin" ? 33 : 30, at[1] - (kind == "skin" ? .2 : 6))
    vertex(0, kind == "skin" ? 33 : 30, at[n] + (kind == "skin" ? .2 : 6))
    for (i = 1; i <= around; i++) {
        a = i % around + 1
        for (r = 0; r + 1 < n; r++)
            print "f", r * around + i, r * around + a, (r + 1) * around + a, (r + 1) * around + i
        print "f", n * around + 1, a, i
        print "f", n * around + 2, (n - 1) * around + i, (n - 1) * around + a
    }
}

# Where rings are: so far apart, and closer together about the volume.
function places(from, to, far, near,    z, text)
{
    for (z = from; z < to; z += (z > -34 && z < 34) ? near : far)
        text = text " " z
    return text " " to
}

BEGIN {
    pi = atan2(0, -1)
    if (what == "skin") {
        around = 96
        tube("skin", places(-149.6, -118, 2.5, 2) " " places(-115, 110, 5, 2.5) " " places(113, 149.6, 2.5, 2))
    } else if (what == "skeleton") {
        around = 32
        tube("skeleton", places(-118, 118, 6, 6))
    } else {
        print "# Where the volume and the surfaces around it are: BODIES in us-slice(1). z of the volume is x of the body."
        print "volume               move=150mm,0,40mm turn=0,0.70710678118654752,0,0.70710678118654752"
        print "surface skin.obj     unit=mm"
        print "surface skeleton.obj unit=mm"
    }
}
