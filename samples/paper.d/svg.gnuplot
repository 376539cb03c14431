# Before each plot of samples/paper: SVG for a page that may be light or dark, so with no ground of its own; what is black is turned light
# for the dark one (page.awk). Letters are large, as telephones show it small. (With `ready` samples/*.gnuplot choose no terminal.)
ready = 1
set terminal svg size 480,height dynamic font 'DejaVu Sans,sans-serif,14'
set output picture
set datafile separator tab
set border 3
set tics nomirror
set grid lc '#d0d4d9'
