# A work-precision figure, as SVG, of the CSV that tests/bench/accuracy prints: error (%, without its sign) against wall time (s), both in logarithms,
# a panel for each problem and a line for each program, device and precision.
#   awk -f tests/bench/accuracy_svg.awk out/accuracy.csv >out/accuracy.svg
function log10(v) { return log(v) / log(10) }
function text(x, y, what, more) { printf "<text x=\"%.1f\" y=\"%.1f\"%s>%s</text>\n", x, y, more, what }
function rule(x1, y1, x2, y2, colour) { printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x1, y1, x2, y2, colour }
function across(t) { return left + wide * (log10(t) - t0) / (t1 - t0) }
function down(e) { return top + high * (e1 - log10(e)) / (e1 - e0) }
function axes(name,    d) {
    text(left + wide / 2, top - 10, name, " text-anchor=\"middle\" font-weight=\"bold\"")
    for (d = t0; d <= t1; d++) {
        rule(across(10 ^ d), top, across(10 ^ d), top + high, "#ddd")
        text(across(10 ^ d), top + high + 16, 10 ^ d, " text-anchor=\"middle\"")
    }
    for (d = e0; d <= e1; d++) {
        rule(left, down(10 ^ d), left + wide, down(10 ^ d), "#ddd")
        text(left - 6, down(10 ^ d) + 4, 10 ^ d, " text-anchor=\"end\"")
    }
    text(left + wide / 2, top + high + 34, "wall time, s", " text-anchor=\"middle\"")
}
BEGIN {
    FS = ","
    split("#c22 #e80 #2a2 #07c #73b #555 #0aa #a50", colours, " ")
    wide = 290; high = 300; top = 40; gap = 60
    t0 = -2; t1 = 2; e0 = -1; e1 = 1
}
/^#/ || $1 == "problem" { next }
{
    error = $11 < 0 ? -$11 : $11 + 0
    if (error < .01) error = .01
    if (!($1 in panel)) { panel[$1] = panels++; name[panels] = $1 }
    key = $2 ($2 ~ /^tled/ ? ", " $3 ", " $4 : $3 == "cuda" ? ", cuda" : "")
    if (!(key in series)) { series[key] = ++lines; label[lines] = key }
    n = ++points[$1, key]
    time[$1, key, n] = $8; off[$1, key, n] = error
    while (log10($8) < t0) t0--
    while (log10($8) > t1) t1++
    while (log10(error) < e0) e0--
    while (log10(error) > e1) e1++
}
END {
    width = panels * (wide + gap) + 20
    height = top + high + 60 + 18 * int((lines + panels - 1) / panels)
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12\">\n", width, height
    printf "<title>Error against wall time: %d problems, %d programs</title>\n<rect width=\"%d\" height=\"%d\" fill=\"white\"/>\n", panels, lines, width, height
    for (p = 1; p <= panels; p++) {
        left = gap + (p - 1) * (wide + gap)
        axes(name[p] ": error, %")
        for (s = 1; s <= lines; s++) {
            count = points[name[p], label[s]]
            if (!count) continue
            path = marks = ""
            for (i = 1; i <= count; i++) {
                x = across(time[name[p], label[s], i]); y = down(off[name[p], label[s], i])
                path = path sprintf("%.1f,%.1f ", x, y)
                marks = marks sprintf("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x, y, colours[s])
            }
            printf "<polyline points=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\"/>\n%s", path, colours[s], marks
        }
    }
    for (s = 1; s <= lines; s++) {
        left = gap + ((s - 1) % panels) * (wide + gap)
        y = top + high + 58 + 18 * int((s - 1) / panels)
        printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>\n", left, y - 4, colours[s]
        text(left + 10, y, label[s], "")
    }
    print "</svg>"
}
