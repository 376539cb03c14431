# How far from flat a side is: of the nodes at rest at z = at (m), the largest less the smallest place along z, over `side`.
$1 == "array" { rest = $2 == "node.position"; moved = $2 == "node.displacement"; next }
$1 == "crc" || $1 == "frame" || $1 == "end" { rest = moved = 0; next }
rest { z[++n] = $3 }
moved && (z[++m] - at) ^ 2 < 1e-16 { if (!count++ || $3 < low) low = $3; if (count == 1 || $3 > high) high = $3 }
END { printf "%.6g\n", (high - low) / side }
