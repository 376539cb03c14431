# PST's figure 6: a section of the skin (black) that a ball (green) deforms; the anchors (red) pull it back to where it was (dashed).
# table: x, z at rest, x, z now, mm, along the skin's middle row; ball: its radius and the x and z of its centre, mm.
if (exists('ready')) {
    set key below
} else {
    set terminal pngcairo size 1200,520 font 'DejaVu Sans,15'
    set output picture
    set key top right
}
set size ratio -1
set xrange [-45:45]
set yrange [-22:12]
set xlabel 'mm'
set ylabel 'mm'
set object 1 circle at ball_x, ball_z size ball_r fc '#3f9d4a' fs transparent solid 0.35 border lc '#2c7a36'
plot table using 3:4:($1 - $3):($2 - $4) with vectors nohead lw 1 lc '#c23b3b' title 'anchors', \
    '' using 1:2 with lines lw 2 dt 2 lc '#777777' title 'at rest', \
    '' using 3:4 with lines lw 3 lc '#000000' title 'skin'
