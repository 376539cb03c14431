# A muscle alone: a cylinder, radius 3.95 mm, 19.6 mm long, along (1, 2, 6), held at one end. Voxels of 1.5 mm give the 280
# elements and 480 nodes of W&M's cylindrical muscle. The faces of the end are in two groups: `rigid_end` marks
# them, `muscle` is what they bound.

function point(name, u, i, rows,    along, out)
{
    along = L * (i == 0 ? -0.5 : i == rows ? 0.5 : (i - 1) / (rows - 2) - 0.5)
    out = i == 0 || i == rows ? 0 : R
    X = along * AX + out * (cos(2 * PI * u) * BX + sin(2 * PI * u) * CX)
    Y = along * AY + out * (cos(2 * PI * u) * BY + sin(2 * PI * u) * CY)
    Z = along * AZ + out * (cos(2 * PI * u) * BZ + sin(2 * PI * u) * CZ)
}

BEGIN {
    PI = atan2(0, -1)
    R = 3.95
    L = 19.6
    # The axis A, and B, C across it.
    AX = 1 / sqrt(41); AY = 2 / sqrt(41); AZ = 6 / sqrt(41)
    BX = 2 / sqrt(5); BY = -1 / sqrt(5); BZ = 0
    CX = BY * AZ - BZ * AY; CY = BZ * AX - BX * AZ; CZ = BX * AY - BY * AX
    begin("a cylindrical muscle, held at one end")
    closed("muscle", 14, 64)
    # Rows of faces come one after the other: the first 64 are the end's.
    flush_first(64, "muscle rigid_end", "bone")
    flush("muscle", "muscle")
}
