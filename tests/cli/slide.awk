# Lets the lowest nodes of tests/cli/block.awk's block, of nx x ny elements of side h (m), slide on a plane there.
#   R      on a sphere of this radius below it, whose top is the middle of the block's lower face
#   lifts  1: they may come off
#   body   instead: the field that there is moves with a body of this name, which holds no node
$1 == "axis" && $2 == "node" { nodes = $3 }
$1 == "end" && body != "" {
    print "axis body 1\narray body.name str 1 body 1\n\"" body "\"\narray body.centre f64 m body 3\n0 0 0\narray node.body i32 @body node 1"
    for (i = 0; i < nodes; i++) print -1
    print "array field.body i32 @body field 1\n0"
}
$1 == "end" && body == "" {
    count = (nx + 1) * (ny + 1)
    print "axis slide " count "\narray slide.node i32 @node slide 1"
    for (i = 0; i < count; i++) print i
    print "array slide.field i32 @field slide 1"
    for (i = 0; i < count; i++) print 0
    if (lifts) {
        print "array slide.lifts u8 1 slide 1"
        for (i = 0; i < count; i++) print 1
    }
    around = R ? 8 : 2
    low = R ? 20 : 2
    x = nx + 1 + 2 * around
    y = ny + 1 + 2 * around
    z = low + 1 + around
    print "axis field 1\narray field.first i32 1 field 3\n" (-around) " " (-around) " " (-low)
    print "array field.samples i32 1 field 3\n" x, y, z
    print "axis distance " x * y * z "\narray distance.value f32 m distance 1"
    for (k = 0; k < z; k++) for (j = 0; j < y; j++) for (i = 0; i < x; i++)
        printf "%.9g\n", R ? sqrt(((i - around - nx / 2) * h) ^ 2 + ((j - around - ny / 2) * h) ^ 2 + ((k - low) * h + R) ^ 2) - R : (k - low) * h
}
{ print }
