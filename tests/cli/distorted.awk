# A cube of n^3 hexahedra, of side `size` (m), as Abaqus input: nodes inside stand up to `by` of a cell's side away from their places in
# the lattice, along each axis, the same ones in every run. Its top is held.
function next_share() {
    seed = (seed * 16807) % 2147483647
    return 2 * seed / 2147483647 - 1
}
function place(i, inside) {
    return size * (i + (inside ? by * next_share() : 0)) / n
}
BEGIN {
    seed = 12345
    print "*NODE, NSET=NALL"
    for (k = 0; k <= n; k++)
        for (j = 0; j <= n; j++)
            for (i = 0; i <= n; i++) {
                inside = i && j && k && i < n && j < n && k < n
                printf "%d, %.15g, %.15g, %.15g\n", ++node, place(i, inside), place(j, inside), place(k, inside)
            }
    print "*ELEMENT, TYPE=C3D8R, ELSET=CUBE"
    w = n + 1
    for (k = 0; k < n; k++)
        for (j = 0; j < n; j++)
            for (i = 1; i <= n; i++) {
                a = (k * w + j) * w + i; b = a + w * w
                printf "%d, %d, %d, %d, %d,\n%d, %d, %d, %d\n", ++element, a, a + 1, a + w + 1, a + w, b, b + 1, b + w + 1, b + w
            }
    printf "*NSET, NSET=TOP, GENERATE\n%d, %d\n", n * w * w + 1, w * w * w
    print "*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, NEO HOOKE\n517.241379310345, 0.0002\n*DENSITY\n1000"
    print "*SOLID SECTION, ELSET=CUBE, MATERIAL=TISSUE\n*BOUNDARY\nTOP, 1, 3"
}
