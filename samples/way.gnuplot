# How a place moves (sinew info --tsv node.displacement.at.X,Y,Z --tsv node.displacement.max), and the largest displacement of all.
set terminal pngcairo size 1100,650 font 'DejaVu Sans,14'
set output picture
set datafile separator tab
set key below
set grid lt 1 lw 1 lc rgb '#cccccc'
set style data lines
set title name
set xlabel 'time, s'
set ylabel 'displacement, mm'
plot table using 2:(1000 * $3) skip 1 lw 3 lc '#3b6fb6' title 'x', \
    '' using 2:(1000 * $4) skip 1 lw 3 lc '#c23b3b' title 'y', \
    '' using 2:(1000 * $5) skip 1 lw 3 lc '#3f9d4a' title 'z', \
    '' using 2:(1000 * $6) skip 1 lw 2 dt 2 lc '#555555' title 'the largest of all'
