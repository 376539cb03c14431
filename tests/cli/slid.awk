# how far sliding nodes of the last frame are off, in voxels: by the field; by the sphere. h R nx ny
$1 == "meta" || $1 == "axis" || $1 == "crc" { next }
$1 == "array" { name = $2; row = 0; next }
$1 == "frame" { name = ""; next }
name == "node.position" { for (a = 0; a < 3; a++) X[row, a] = $(a + 1); row++ }
name == "node.displacement" { for (a = 0; a < 3; a++) u[row, a] = $(a + 1); row++ }
name == "slide.node" { node[count++] = $1 }
name == "field.first" { for (a = 0; a < 3; a++) first[a] = $(a + 1) }
name == "field.samples" { for (a = 0; a < 3; a++) n[a] = $(a + 1) }
name == "distance.value" { d[values++] = $1 }
function phi(x, y, z,   i, j, k, l, t, w, sum) {
  l[0] = x / h - first[0]; l[1] = y / h - first[1]; l[2] = z / h - first[2]
  for (i = 0; i < 3; i++) { c[i] = int(l[i]); t[i] = l[i] - c[i] }
  sum = 0
  for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++) {
    w = (i ? t[0] : 1 - t[0]) * (j ? t[1] : 1 - t[1]) * (k ? t[2] : 1 - t[2])
    sum += w * d[c[0] + i + n[0] * (c[1] + j + n[1] * (c[2] + k))]
  }
  return sum
}
function ball(x, y, z) { return sqrt((x - nx * h / 2) ^ 2 + (y - ny * h / 2) ^ 2 + (z + R) ^ 2) - R }
END {
  for (s = 0; s < count; s++) {
    m = node[s]
    off = phi(X[m, 0] + u[m, 0], X[m, 1] + u[m, 1], X[m, 2] + u[m, 2]) - phi(X[m, 0], X[m, 1], X[m, 2])
    away = ball(X[m, 0] + u[m, 0], X[m, 1] + u[m, 1], X[m, 2] + u[m, 2]) - ball(X[m, 0], X[m, 1], X[m, 2])
    if (off * off > worst * worst) worst = off
    if (away * away > far * far) far = away
  }
  printf "%.3g %.3g\n", worst / h, far / h
}
