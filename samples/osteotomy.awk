# Where a surgeon cuts the skull of head.awk, as closed boxes: the upper jaw as by Le Fort (name=maxilla), from under the nose to
# the line of the teeth, and the chin (name=chin); and the parts of the skin that are compared, a box each with their names
# (name=regions): what `sinew distance --region` takes. mm; y is up, z forward, x to the head's left.
#
#     awk -v name=maxilla -f osteotomy.awk >maxilla.obj

# A box whose polygons face outward.
function box(x0, y0, z0, x1, y1, z1,    i)
{
    print "g " name
    for (i = 0; i < 8; i++)
        print "v", (i % 2 ? x1 : x0), (int(i / 2) % 2 ? y1 : y0), (i > 3 ? z1 : z0)
    print "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6"
}

# A saw takes 2 mm of bone between the two.
BEGIN {
    if (name == "maxilla")
        box(-58, -48, 20, 58, -22, 120)
    if (name == "chin")
        box(-45, -115, 20, 45, -50, 120)
    if (name == "regions") {
        print "nose=-20,-22,60,20,10,130"
        print "upper_lip=-30,-50,60,30,-22,130"
        print "lower_lip=-30,-68,50,30,-50,130"
        print "chin=-30,-110,30,30,-68,130"
        print "cheeks=-75,-50,30,75,0,75"
    }
}
