# Of a model in text with a frame: how many nodes have not moved, how many have, and how far nodes of one point of the lattice have come
# apart along x, in mm.
/^[a-z]/ {
    on = $2 == "node.lattice" ? "l" : $2 == "node.displacement" ? "u" : ""
    n = on ? 0 : n
    next
}
on == "l" { at[n++] = $1 " " $2 " " $3 }
on == "u" { u[n] = $1; still += $1 == 0 && $2 == 0 && $3 == 0; n++ }
END {
    for (i = 0; i < n; i++) {
        a = at[i]
        if (!(a in low) || u[i] < low[a]) low[a] = u[i]
        if (!(a in high) || u[i] > high[a]) high[a] = u[i]
        if (high[a] - low[a] > gap) gap = high[a] - low[a]
    }
    printf "%d %d %.3f\n", still, n - still, 1000 * gap
}
