# What bench_msds_card writes (commas between): the median of a frame beside PST's Table I.
BEGIN { OFS = "\t"; print "mesh", "method", "ms, paper", "ms", "times as fast" }
$1 ~ /^[0-9]+x/ { print $1, $5, $11 == "" ? "-" : $11, $9, $11 == "" ? "-" : sprintf("%.3g", $11 / $9) }
