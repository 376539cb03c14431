# What R regions cost (PST section IV): gnuplot -e "data='out/regions.dat'; picture='out/regions.png'" tests/bench/regions.plot
set terminal pngcairo size 700,420
set output picture
set logscale xy
set xtics (1, 2, 4, 8, 16, 32, 64, 128, 256, 512)
set xlabel 'regions R'
set ylabel 'ms an image, one thread'
set key top right
set grid
plot data using 1:3 with linespoints title "the paper's steps", data using 1:2 with linespoints title 'spans'
