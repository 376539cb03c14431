# PST's figure 5 (c): polygons of a slice, a colour each. table: x, depth, colour; a block a polygon.
set size ratio -1
set yrange [] reverse
set xlabel 'across, mm'
set ylabel 'below the probe, mm'
unset grid
unset key
unset colorbox
set palette defined (0 '#e8796b', 2 '#f2b35e', 4 '#f5e27a', 6 '#8fce7e', 8 '#6bb7d6', 10 '#8f8fe0', 11 '#c98fd0')
set cbrange [0:11]
plot for [i = 0:polygons - 1] table index i using 1:2:3 with filledcurves closed lc palette, \
    for [i = 0:polygons - 1] table index i using 1:2 with lines lw 0.7 lc 'black'
