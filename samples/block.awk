# A block of skin, 60 x 60 x 4.5 mm, with a flat muscle that rises through it: W&M's third model. Voxels of 1.5 mm give 4800
# elements and 6724 nodes. Two patches of its underside are rigid: one holds the muscle's lower end, the other the
# far side.

# One 5 mm cell of a side: 4 corners.
function quad(ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz)
{
    face(vertex(ax, ay, az) " " vertex(bx, by, bz) " " vertex(cx, cy, cz) " " vertex(dx, dy, dz))
}

function is_rigid(x)
{
    return x < -10 || x >= 20
}

function underside(rigid,    x, y)
{
    for (x = -30; x < 30; x += 5)
        for (y = -30; y < 30; y += 5)
            if (is_rigid(x) == rigid)
                quad(x, y, -H, x, y + 5, -H, x + 5, y + 5, -H, x + 5, y, -H)
}

# The muscle: an ellipse 12 x 2.4 mm drawn from below the first patch to just under the top; its ends are caps.
function point(name, u, i, rows,    along, wide, thick)
{
    along = i == 0 ? 0 : i == rows ? 1 : (i - 1) / (rows - 2)
    wide = i == 0 || i == rows ? 0 : 6 * sin(2 * PI * u)
    thick = i == 0 || i == rows ? 0 : 1.2 * cos(2 * PI * u)
    X = -20 + 38 * along
    Y = wide
    Z = -2.4 + 3.4 * along + thick
}

BEGIN {
    PI = atan2(0, -1)
    H = 2.25
    begin("a block of skin with a flat muscle")
    for (x = -30; x < 30; x += 5) {
        for (y = -30; y < 30; y += 5)
            quad(x, y, H, x + 5, y, H, x + 5, y + 5, H, x, y + 5, H)
        quad(x, -30, -H, x + 5, -30, -H, x + 5, -30, H, x, -30, H)
        quad(x + 5, 30, -H, x, 30, -H, x, 30, H, x + 5, 30, H)
        quad(-30, x + 5, -H, -30, x, -H, -30, x, H, -30, x + 5, H)
        quad(30, x, -H, 30, x + 5, -H, 30, x + 5, H, 30, x, H)
    }
    underside(0)
    flush("skin", "skin")
    underside(1)
    flush("rigid_patches", "bone")
    closed("muscle_flat", 22, 24)
    flush("muscle_flat", "muscle")
}
