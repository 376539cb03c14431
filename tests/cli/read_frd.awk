# What CalculiX read, from its results' file (.frd): each node's number and place, then each element's number and nodes.
/^ *2C/ { nodes = 1; next }
/^ *3C/ { elements = 1; next }
/^ -3/ { nodes = elements = 0 }
nodes && /^ -1/ { print "node", substr($0, 4, 10) + 0, substr($0, 14, 12) + 0, substr($0, 26, 12) + 0, substr($0, 38, 12) + 0 }
elements && /^ -1/ { if (line) print line; line = "element " (substr($0, 4, 10) + 0) }
elements && /^ -2/ { for (at = 4; at < length($0); at += 10) line = line " " (substr($0, at, 10) + 0) }
END { if (line) print line }
