# Cross-sections against the probe's depth, pressing only, springs beside finite elements; and the force under them.
set terminal pngcairo size 1400,900 font 'DejaVu Sans,15'
set output picture
set datafile separator tab
set key bottom left
set grid lc '#dddddd'
set style line 1 lw 3 lc '#3b6fb6'
set style line 2 lw 3 lc '#c23b3b'
set style line 3 lw 3 lc '#555555'
down(t, d) = t <= 1 && d >= 0 ? d : NaN
stats table using 3 every ::1::1 name 'vein' nooutput
stats table using 4 every ::1::1 name 'artery' nooutput
set multiplot layout 2,2
set xrange [0:*]
set ylabel 'cross-section, % of rest'
set yrange [-5:110]
set title 'springs (msds)'
plot table using (down($1, $2)):(100 * $3 / vein_max) skip 1 with lines ls 1 title 'vein', \
    '' using (down($1, $2)):(100 * $4 / artery_max) skip 1 with lines ls 2 title 'artery'
set title 'finite elements (fem, exact)'
plot table using (down($1, $2)):(100 * $5 / vein_max) skip 1 with lines ls 1 title 'vein', \
    '' using (down($1, $2)):(100 * $6 / artery_max) skip 1 with lines ls 2 title 'artery'
unset title
unset key
set xlabel 'depth of the probe, mm'
set ylabel 'force, N'
set yrange [0:*]
plot table using (down($1, $2)):7 skip 1 with lines ls 3
plot table using (down($1, $2)):8 skip 1 with lines ls 3
unset multiplot
