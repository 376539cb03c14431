# Cuts the bone of a face into skull and jaw: an OBJ whose faces of the group `skull` become those of skull, of skull_jaw, or of
# skull_gap. Seen from the side, with coordinate `forward` to the right and `up` upward (columns 1 to 3), a face
# belongs to the jaw if its middle lies in the polygon `jaw`; it is in the gap if that lies within `gap` of the polygon's sides (as
# between the teeth, where tissue slides on bone), or in the polygon `free` (as the neck, where there is no bone).
#
#     awk -f jaw.awk head.obj >jaw.obj          the head of head.awk
#     awk -v forward=2 -v up=3 -v jaw="300,-83 30,-78 ..." -v free="" -v gap=11 -f jaw.awk face.obj >jaw.obj

function read_polygon(text, name,    list, i, n, point)
{
    n = split(text, list, " ")
    for (i = 1; i <= n; i++) {
        split(list[i], point, ",")
        U[name, i] = point[1]
        W[name, i] = point[2]
    }
    sides[name] = n
}

# By crossings of a ray along u.
function is_in(name, u, w,    i, j, odd)
{
    odd = 0
    for (i = 1; i <= sides[name]; i++) {
        j = i % sides[name] + 1
        if ((W[name, i] > w) != (W[name, j] > w) &&
            u < U[name, i] + (w - W[name, i]) / (W[name, j] - W[name, i]) * (U[name, j] - U[name, i]))
            odd = !odd
    }
    return odd
}

# The square of the distance from the nearest side.
function away(name, u, w,    i, j, x, y, t, d, least)
{
    least = 1e30
    for (i = 1; i <= sides[name]; i++) {
        j = i % sides[name] + 1
        x = U[name, j] - U[name, i]
        y = W[name, j] - W[name, i]
        t = ((u - U[name, i]) * x + (w - W[name, i]) * y) / (x * x + y * y)
        t = t < 0 ? 0 : t > 1 ? 1 : t
        d = (u - U[name, i] - t * x) ^ 2 + (w - W[name, i] - t * y) ^ 2
        least = d < least ? d : least
    }
    return least
}

function part_of(u, w)
{
    if (is_in("free", u, w) || away("jaw", u, w) < gap * gap)
        return "skull_gap"
    return is_in("jaw", u, w) ? "skull_jaw" : "skull"
}

BEGIN {
    if (!forward) {
        forward = 3
        up = 2
        gap = 9
        jaw = "300,-47 30,-44 16,-25 4,-12 -8,-12 -14,-30 -10,-55 10,-75 30,-300 300,-300"
        free = "-14,-30 -10,-55 10,-75 30,-300 -300,-300 -300,-50 -30,-50 -24,-30"
    }
    read_polygon(jaw, "jaw")
    read_polygon(free, "free")
}

$1 == "v" {
    at[++vertices, 1] = $2
    at[vertices, 2] = $3
    at[vertices, 3] = $4
}

$1 == "g" {
    group = $2
    written = ""
}

$1 == "f" && group == "skull" {
    u = w = 0
    for (i = 2; i <= NF; i++) {
        split($i, corner, "/")
        v = corner[1] < 0 ? vertices + 1 + corner[1] : corner[1]
        u += at[v, forward] / (NF - 1)
        w += at[v, up] / (NF - 1)
    }
    part = part_of(u, w)
    if (part != written)
        print "g " part
    written = part
}

{ print }
