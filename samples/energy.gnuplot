# The log of a run (tled-run --log): what the tissue holds, what was done to it, what is left over, and what remains of its motion.
set terminal pngcairo size 1500,1000 font 'DejaVu Sans,14'
set output picture
set datafile separator tab
set datafile missing 'nan'
set key autotitle columnheader below
set grid lt 1 lw 1 lc rgb '#cccccc'
set style data lines
set style line 1 lw 3 lc '#3b6fb6'
set style line 2 lw 3 lc '#c23b3b'
set style line 3 lw 3 lc '#3f9d4a'
set style line 4 lw 3 lc '#8a5fb0'
set style line 5 lw 3 lc '#d9892b'
set style line 6 lw 2 lc '#555555' dt 2
set bmargin 7
set multiplot layout 2,2 title name
set xlabel 'time, s'
set ylabel 'held, mJ'
plot table using 1:(1000 * column('strain/J')) ls 1 title 'strain', \
    '' using 1:(1000 * column('kinetic/J')) ls 2 title 'kinetic', \
    '' using 1:(1000 * column('hourglass/J')) ls 3 title 'hourglass'
set ylabel 'done since the start, mJ'
plot table using 1:(1000 * column('gravity/J')) ls 1 title 'gravity', \
    '' using 1:(1000 * column('muscles/J')) ls 2 title 'muscles', \
    '' using 1:(1000 * (column('forces/J') + column('displaced/J') + column('probe/J'))) ls 3 title 'other forces', \
    '' using 1:(1000 * column('damping/J')) ls 4 title 'damping, taken', \
    '' using 1:(1000 * column('balance/J')) ls 6 title 'left over'
set ylabel 'largest'
plot table using 1:(1000 * column('displacement/m')) ls 1 title 'displacement, mm', \
    '' using 1:(100 * column('speed/(m/s)')) ls 2 title 'speed, cm/s'
set ylabel 'ms'
set yrange [0:*]
plot table using 1:(1000 * column('stable/s')) ls 3 title 'stable step', \
    '' using 1:(1000 * column('dt/s')) ls 5 title 'step taken'
unset multiplot
