# PST's Tables I and II and figure 9 of what bench_msds and bench_slice write, commas between: -v part=times, bars, rates or words. With
# rates, lines `MESH,SPRINGS,FEM` are the frames a second that were drawn, and those of bench_console.py what the console showed.

BEGIN {
    OFS = "\t"
    meshes = split("20x10x10 24x12x12 28x14x14 32x16x16", mesh, " ")
    split("2000 3456 5488 8192", printed_nodes, " ")
    split("7695 13915 22815 34875", printed_tetrahedra, " ")
    split("10 17 27 40", printed_msds, " ")
    split("30 60 100 150", printed_fem, " ")
    split("0.1 0.2 0.2 0.3", printed_collision, " ")
    split("14 16 20 23", printed_sampling, " ")
    split("20 16 15 12", rate_msds, " ")
    split("15 10 6.8 5.0", rate_fem, " ")
    split("12 10 8.6 8.5", drawn_msds, " ")
    split("8.6 7.4 5.5 4.3", drawn_fem, " ")
}

NF == 3 { drawn[$1] = $2 " (" $3 ")" }

# bench_msds: mesh,nodes,tetrahedra,springs,method,threads,frames,best,median
$1 ~ /^[0-9]+x/ && NF == 12 { nodes[$1] = $2; tetrahedra[$1] = $3; ms[$5, $1] = $9 }

# bench_slice: mesh,tetrahedra,in_the_image,what,threads,images,best,median
$1 ~ /^[0-9]+x/ && NF == 11 { slices = 1; image[$4, $5 == 1 ? 1 : "all", $1] = $8; frame[$4, $1] = 1000 / $8 }

# bench_console.py: mesh,surfaces,method,triangles,frames,images,drawn a second: what is shown is as often as the rarer of both.
$1 ~ /^[0-9]+x/ && NF == 7 {
    consoles++
    triangles = $4 > triangles ? $4 : triangles
    shown[$2, $3, $1] = $2 == "with" && $7 < $6 ? $7 : $6
}

function printed(head, of,    i, line)
{
    line = head
    for (i = 1; i <= meshes; i++)
        line = line OFS of[i]
    print line
}

function ours(head, kind,    i, line)
{
    line = head
    for (i = 1; i <= meshes; i++)
        line = line OFS value(kind, i)
    print line
}

function value(kind, i,    m)
{
    m = mesh[i]
    if (kind == "nodes")
        return nodes[m]
    if (kind == "tetrahedra")
        return tetrahedra[m]
    if (kind == "x msds")
        return sprintf("%.3g", printed_msds[i] / ms["msds", m])
    if (kind == "x fem")
        return sprintf("%.3g", printed_fem[i] / ms["fem 20 cg", m])
    if (kind == "x collision")
        return sprintf("%.3g", printed_collision[i] / ms["collision", m])
    if (kind == "x spans")
        return sprintf("%.3g", printed_sampling[i] / image["spans", "all", m])
    if (kind == "spans")
        return sprintf("%.3g", image["spans", "all", m])
    if (kind == "steps")
        return sprintf("%.3g", image["paper's steps", 1, m])
    if (kind == "rate")
        return slices ? sprintf("%.0f (%.0f)", frame["frame: msds and image", m], frame["frame: fem 20 cg and image", m]) : "-"
    if (kind == "drawn")
        return drawn[m]
    if (kind == "without" || kind == "with")
        return sprintf("%.3g (%.3g)", shown[kind, "msds", m], shown[kind, "fem", m])
    return sprintf(ms[kind, m] < 1000 ? "%.3g" : "%.0f", ms[kind, m])
}

function head(    i, line)
{
    line = "mesh"
    for (i = 1; i <= meshes; i++)
        line = line OFS mesh[i]
    print line
}

# The slope of log t against log n: 1 is linear.
function power(of,    i, x, y, sx, sy, sxx, sxy)
{
    for (i = 1; i <= meshes; i++) {
        x = log(printed_nodes[i])
        y = log(of[i])
        sx += x
        sy += y
        sxx += x * x
        sxy += x * y
    }
    return (meshes * sxy - sx * sy) / (meshes * sxx - sx * sx)
}

function times()
{
    head()
    printed("nodes, paper", printed_nodes)
    ours("nodes", "nodes")
    printed("tetrahedra, paper", printed_tetrahedra)
    ours("tetrahedra", "tetrahedra")
    printed("MSDS, paper", printed_msds)
    ours("MSDS", "msds")
    ours("times as fast", "x msds")
    printed("FEM, paper", printed_fem)
    ours("FEM", "fem 20 cg")
    ours("times as fast", "x fem")
    ours("FEM, solved exactly", "fem exact")
    ours("FEM, solved exactly, the first frame", "first exact frame")
    printed("collision response, paper", printed_collision)
    ours("collision response", "collision")
    ours("times as fast", "x collision")
    printed("volume sampling, paper", printed_sampling)
    ours("volume sampling, spans", "spans")
    ours("times as fast", "x spans")
    ours("volume sampling, the steps of theirs, one thread", "steps")
}

function rates(    i, without, with)
{
    head()
    for (i = 1; i <= meshes; i++) {
        without[i] = rate_msds[i] " (" rate_fem[i] ")"
        with[i] = drawn_msds[i] " (" drawn_fem[i] ")"
    }
    printed("without visualisation, paper", without)
    ours("without visualisation", "rate")
    if (consoles)
        ours("images in sinew console, without surfaces", "without")
    printed("with visualisation, paper", with)
    ours("with visualisation, by rays on the processor", "drawn")
    if (consoles)
        ours("in sinew console, with " triangles " triangles", "with")
}

function bars(    i)
{
    print "mesh", "MSDS, paper", "FEM, paper", "MSDS", "FEM"
    for (i = 1; i <= meshes; i++)
        print mesh[i], printed_msds[i], printed_fem[i], ms["msds", mesh[i]], ms["fem 20 cg", mesh[i]]
}

function words(    i, springs, elements)
{
    for (i = 1; i <= meshes; i++) {
        springs[i] = ms["msds", mesh[i]]
        elements[i] = ms["fem 20 cg", mesh[i]]
    }
    printf "The paper finds that time grows linearly with nodes. Fitted to its figures, it grows as their power "
    printf "%.2f for springs and %.2f for finite elements; here as %.2f and %.2f. ", \
        power(printed_msds), power(printed_fem), power(springs), power(elements)
    printf "It finds springs more than three times faster than finite elements: "
    printf "%.2f times at %s and %.2f times at %s; here it is %.2f and %.2f times.\n", \
        printed_fem[1] / printed_msds[1], mesh[1], printed_fem[meshes] / printed_msds[meshes], mesh[meshes], \
        elements[1] / springs[1], elements[meshes] / springs[meshes]
}

END {
    if (part == "times")
        times()
    else if (part == "bars")
        bars()
    else if (part == "rates")
        rates()
    else if (part == "words")
        words()
}
