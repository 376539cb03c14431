# What a model in text is a mesh of, whatever the numbers of its nodes and elements: a line for each element, with its volume's name and the
# places of its corners in their order, and a line for each rigid node. For sort.
$1 == "array" { what = $2; row = 0; next }
$1 == "crc" || $1 == "frame" || $1 == "end" || $1 == "axis" { what = ""; next }
what == "node.position" { at[row++] = sprintf("%.9g,%.9g,%.9g", $1 + 0, $2 + 0, $3 + 0) }
what == "node.rigid" { rigid[row++] = $1; nodes = row }
what == "element.node" { for (i = 1; i <= NF; i++) node[row, i] = $i; corners = NF; elements = ++row }
what == "element.volume" { volume[row++] = $1 }
what == "volume.name" { name[row++] = $0 }
END {
    for (e = 0; e < elements; e++) {
        printf "element %s", name[volume[e]]
        for (i = 1; i <= corners; i++) printf " %s", at[node[e, i]]
        print ""
    }
    for (n = 0; n < nodes; n++) if (rigid[n]) print "rigid", at[n]
}
