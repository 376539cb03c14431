# A ball of soft tissue, radius 100 mm, in a rigid bowl: W&M's first model. Voxels of 12.5 mm give 2176 elements and 2849
# nodes.

function point(name, u, i, rows)
{
    X = R * sin(PI * i / rows) * sin(2 * PI * u)
    Y = R * cos(PI * i / rows)
    Z = R * sin(PI * i / rows) * cos(2 * PI * u)
}

BEGIN {
    PI = atan2(0, -1)
    R = 100
    begin("a ball, radius 100 mm")
    closed("skin", 32, 64)
    # The lowest 12 rows of faces hold it: all below 38 mm under the middle.
    flush_first(20 * 64, "skin", "skin")
    flush("rigid_bowl", "bone")
}
