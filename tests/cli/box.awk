# A box of x by y by z as an OBJ: its low x side (held=low) or its high z side (held=top) in the group skull, the others in
# skin. Corner at the origin.
function face(side, corners) {
    print (side == held ? "g skull" : "g skin") "\nf " corners
}
BEGIN {
    for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++) print "v", i * x, j * y, k * z
    face("low", "1 5 7 3")
    face("", "2 4 8 6")
    face("", "1 2 6 5")
    face("", "3 7 8 4")
    face("", "1 3 4 2")
    face("top", "5 6 8 7")
}
