# A volume image of an upper arm, as ultrasound would have it: 64 x 32 x 48 mm, NRRD in text, skin at the low end of z. Speckled muscle
# under fat and fascia; a vein, dark and wide; an artery, dark in a bright wall; the bright top of a bone, with its shadow. All of them run
# along y, in curves. Made from equations and a random generator of its own, the same everywhere.

# Uniform in 0 to 1 (Park and Miller's).
function uniform()
{
    seed = (seed * 16807) % 2147483647
    return seed / 2147483647
}

# How far (x, z) is from a circle's middle, in radii.
function off(x, z, cx, cz, rx, rz)
{
    return sqrt(((x - cx) / rx) ^ 2 + ((z - cz) / rz) ^ 2)
}

function tissue(x, y, z,    d, wave)
{
    wave = 1.2 * sin(x / 9 + y / 13) + .5 * sin(x / 4 - y / 7)
    if ((d = off(x, z, 24 + 2 * sin(y / 12), 17, 5, 3.6)) < 1)
        return 9
    if (d < 1.12)
        return 120
    if ((d = off(x, z, 40 - 1.5 * sin(y / 10), 19, 3.4, 3.4)) < 1)
        return 11
    if (d < 1.3)
        return 190
    if ((d = off(x, z, 33, 46, 11, 9)) < .88)
        return 3
    if (d < 1)
        return 245
    if (z > 46 - 9 * sqrt(1 - ((x - 33) / 11) ^ 2 > 0 ? 1 - ((x - 33) / 11) ^ 2 : 0) && x > 22 && x < 44)
        return 6
    if (z < 1.6)
        return 210
    if (z < 6 + wave)
        return 105
    if (z < 6.9 + wave)
        return 200
    return 78 + 22 * sin(2.1 * (z + .25 * x + .6 * wave))
}

BEGIN {
    nx = 128; ny = 64; nz = 96; h = .5
    seed = 20111
    print "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: " nx " " ny " " nz
    print "space directions: (" h ",0,0) (0," h ",0) (0,0," h ")\nkinds: domain domain domain\nencoding: text"
    print "space origin: (" h / 2 "," h / 2 "," h / 2 ")\n"
    for (k = 0; k < nz; k++)
        for (j = 0; j < ny; j++) {
            line = ""
            for (i = 0; i < nx; i++) {
                level = tissue((i + .5) * h, (j + .5) * h, (k + .5) * h)
                # Rayleigh's distribution, in the logarithm that a scanner shows.
                level += 14 * log(-log(1 - uniform()) + .02) + 6
                line = line (level < 0 ? 0 : level > 255 ? 255 : int(level)) " "
            }
            print line
        }
}
