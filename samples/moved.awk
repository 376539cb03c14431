# A model with one frame, as text, in which nodes have moved as CalculiX says.
#   awk -f samples/moved.awk CALCULIX.dat MODEL
NR == FNR { if (NF == 4 && $1 ~ /^[0-9]+$/) moved[$1] = $2 " " $3 " " $4; next }
$1 == "crc" { next }
$1 == "array" { on = $2 == "node.displacement"; node = 0; print; next }
$1 == "frame" || $1 == "end" || $1 == "axis" { on = 0 }
on { print moved[++node]; next }
{ print }
