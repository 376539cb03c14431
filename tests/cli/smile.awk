# The rest and the deformed face, line by line (paste -d' '): how far the skull's vertices moved, and the skin's vertex
# nearest to the lower end of muscle_zyg_xneg, which is the mouth's corner. Millimetres; y forward, z up.
$1 == "v" {
    n++
    for (a = 0; a < 3; a++) {
        rest[n, a] = $(2 + a)
        move[n, a] = $(6 + a) - $(2 + a)
    }
}
$1 == "g" { group = $2 }
$1 == "f" {
    corners = NF / 2
    for (i = 2; i <= corners; i++) {
        split($i, index_of, "/")
        of[group, index_of[1]] = 1
    }
}
function size(v) { return sqrt(move[v, 0] ^ 2 + move[v, 1] ^ 2 + move[v, 2] ^ 2) }
END {
    low = 1e9
    for (v = 1; v <= n; v++) {
        if (("skull", v) in of && size(v) > skull)
            skull = size(v)
        if (size(v) > most)
            most = size(v)
        if (("muscle_zyg_xneg", v) in of && rest[v, 2] < low) {
            low = rest[v, 2]
            end = v
        }
    }
    near = 1e9
    for (v = 1; v <= n; v++)
        if (("skin", v) in of) {
            d = (rest[v, 0] - rest[end, 0]) ^ 2 + (rest[v, 1] - rest[end, 1]) ^ 2 + (rest[v, 2] - rest[end, 2]) ^ 2
            if (d < near) {
                near = d
                corner = v
            }
        }
    printf "mouth corner at %.1f %.1f %.1f moves %.3f %.3f %.3f mm\n", rest[corner, 0], rest[corner, 1], rest[corner, 2],
        move[corner, 0], move[corner, 1], move[corner, 2]
    printf "largest move %.3f mm, skull's largest %.4f mm\n", most, skull
    if (move[corner, 2] > .5 && move[corner, 1] < 0)
        print "mouth up and back"
    if (skull == 0)
        print "skull still"
}
