# PST's figure 9: bars of a mesh each. table: mesh, their MSDS and FEM, ours, ms.
set style data histograms
set style histogram clustered gap 1
set style fill solid 1 noborder
set boxwidth 0.9
set logscale y
set grid noxtics ytics
set format y '%g'
set ylabel 'ms a frame'
set key top left reverse Left
set xtics scale 0 font ',11'
set xrange [-0.7:3.7]
set yrange [0.1:5000]
plot table skip 1 using 2:xtic(1) lc '#9db7d8' title 'MSDS, paper', '' skip 1 using 3 lc '#e0a9a0' title 'FEM, paper', \
    '' skip 1 using 4 lc '#2f6db5' title 'MSDS, here', '' skip 1 using 5 lc '#c2483b' title 'FEM, here'
