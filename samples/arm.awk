# A block of an upper arm, from equations: a vein and an artery beside it run along y, over bone. x is across, z up; millimetres.
# The top is z = 0, the middle of the probe's face at rest is the origin. `awk -v what=WHAT -f arm.awk` writes
#     labels      the block as a label volume, NRRD: 1 tissue, 2 vein, 3 artery, 4 bone
#     vein, artery, bone, skin    the surfaces, OBJ; the middle ring of each tube is at y = 0
#     poses       a linear array that presses -v deep=12 mm down in a second, stays half a second, and lets go: TUM lines, -v hz=60 a second
#     areas       reads an OBJ of a tube, moved or not: the area of its middle ring, mm2

# Each tube: its middle, and half its width and height.
function tubes()
{
    split("-7 -13 5 3.4", vein)
    split("7 -14 3.4 3.4", artery)
    split("0 -30 8 8", bone)
    around = 48
    rings = 17
    from = -20
    to = 20
}

function inside(t, x, z)
{
    return ((x - t[1]) / t[3]) ^ 2 + ((z - t[2]) / t[4]) ^ 2 < 1
}

# A millimetre a voxel; all labels are characters, so that any awk writes them.
function labels(    i, j, k, x, z, row)
{
    printf "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 80 40 40\nspace: left-posterior-superior\n"
    printf "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (-39.5,-19.5,-39.5)\nencoding: raw\n\n"
    for (k = 0; k < 40; k++) {
        row = ""
        z = k - 39.5
        for (i = 0; i < 80; i++) {
            x = i - 39.5
            row = row sprintf("%c", inside(vein, x, z) ? 2 : inside(artery, x, z) ? 3 : inside(bone, x, z) ? 4 : 1)
        }
        for (j = 0; j < 40; j++)
            printf "%s", row
    }
}

function tube(name, t,    r, i, a, n)
{
    print "g " name
    for (r = 0; r < rings; r++)
        for (i = 0; i < around; i++) {
            a = 2 * pi * i / around
            printf "v %.6g %.6g %.6g\n", t[1] + t[3] * cos(a), from + (to - from) * r / (rings - 1), t[2] + t[4] * sin(a)
        }
    n = rings * around
    printf "v %g %g %g\nv %g %g %g\n", t[1], from, t[2], t[1], to, t[2]
    for (i = 1; i <= around; i++) {
        a = i % around + 1
        for (r = 0; r + 1 < rings; r++)
            print "f", r * around + i, (r + 1) * around + i, (r + 1) * around + a, r * around + a
        print "f", n + 1, i, a
        print "f", n + 2, n - around + a, n - around + i
    }
}

# The arm's skin, wider than the block, and round.
function skin(    i, j, x, y, n, m)
{
    n = 97
    m = 65
    print "g skin"
    for (j = 0; j < m; j++)
        for (i = 0; i < n; i++) {
            x = -60 + 120 * i / (n - 1)
            y = -40 + 80 * j / (m - 1)
            printf "v %.6g %.6g %.6g\n", x, y, sqrt(75 * 75 - x * x) - 75
        }
    for (j = 0; j + 1 < m; j++)
        for (i = 1; i < n; i++)
            print "f", j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i
}

# Half a millimetre above the skin at first. Metres, seconds; turned about x, so that +z looks down.
function poses(    i, t, d)
{
    deep = deep ? deep : 12
    hz = hz ? hz : 60
    for (i = 0; i <= 2.5 * hz; i++) {
        t = i / hz
        d = t < 1 ? (deep + .5) * t - .5 : t < 1.5 ? deep : t < 2 ? deep - (deep + .5) * 2 * (t - 1.5) : -.5
        printf "%.6f 0 0 %.7f 1 0 0 0\n", t, -d / 1000
    }
}

BEGIN {
    pi = 3.14159265358979
    tubes()
    if (what == "labels")
        labels()
    else if (what == "vein")
        tube("vein", vein)
    else if (what == "artery")
        tube("artery", artery)
    else if (what == "bone")
        tube("bone", bone)
    else if (what == "skin")
        skin()
    else if (what == "poses")
        poses()
    else if (what != "areas") {
        print "arm.awk: -v what=" what "; expected labels, vein, artery, bone, skin, poses or areas" >"/dev/stderr"
        exit failed = 1
    }
    if (what != "areas")
        exit
}

$1 == "v" {
    row = int(count / around)
    count = count + 1
    if (row == int(rings / 2)) {
        x[++n] = $2
        z[n] = $4
    }
}

END {
    if (failed || what != "areas")
        exit failed
    for (i = 1; i <= n; i++)
        area += (x[i] * z[i % n + 1] - x[i % n + 1] * z[i]) / 2
    printf "%.4f\n", area
}
