# A model of hexahedra, as text and given twice, whose rigid nodes are those of its boundary where z is the largest of |x|, |y| and z: as
# ball.awk holds its ball.
#   awk -f samples/outermost.awk MODEL MODEL
function held(i) {
    return shared[i] < 8 && z[i] > 0 && z[i] * z[i] >= x[i] * x[i] * within && z[i] * z[i] >= y[i] * y[i] * within
}
BEGIN { within = 1 - 1e-9 }
$1 == "crc" { next }
$1 == "array" { what = $2; row = 0; if (NR > FNR) print; next }
$1 == "frame" || $1 == "end" || $1 == "axis" { what = "" }
NR == FNR && what == "node.position" { x[row] = $1; y[row] = $2; z[row++] = $3 }
NR == FNR && what == "element.node" { for (i = 1; i <= 8; i++) shared[$i]++ }
NR == FNR { next }
what == "node.rigid" { print held(row++) + 0; next }
{ print }
