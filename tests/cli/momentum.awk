# Of a model in text with frames: the momentum along x, y and z in the last frame, and the sum of the nodes' sizes of it. Masses are an
# eighth of each element's share at each node, no less than -v least of it, as that of tled-run.
/^array / { name = $2; i = 0; next }
/^(crc|frame|end|axis|meta)/ { name = ""; next }
name == "element.node" { element[elements++] = $0 }
name == "element.fraction" { share[i++] = $1 < least ? least : $1 }
name == "node.velocity" { x[i] = $1; y[i] = $2; z[i++] = $3; nodes = i }
END {
    for (k = 0; k < elements; k++) {
        split(element[k], node, " ")
        for (j = 1; j <= 8; j++) mass[node[j]] += share[k] / 8
    }
    for (k = 0; k < nodes; k++) {
        px += mass[k] * x[k]
        py += mass[k] * y[k]
        pz += mass[k] * z[k]
        all += mass[k] * sqrt(x[k] ^ 2 + y[k] ^ 2 + z[k] ^ 2)
    }
    printf "%.12g %.12g %.12g %.12g\n", px, py, pz, all
}
