# The rows of bench_tled that are steps, beside what W&M's Table 1 says, and what the project was given. For tests/bench/table1.
BEGIN {
    print "model,printed_elements,printed_nodes,elements,nodes,device,threads,precision,ms,printed_gtx460_ms,times_as_fast," \
        "sofa_h200_ms_as_given,niftysim_kernels_h200_ms_as_given,niftysim_loop_h200_ms_as_given"
    printed["sphere"] = "2176,2849"; ms["sphere"] = .187; given["sphere"] = ".0104,.0089,.069"
    printed["muscle"] = "280,480"; ms["muscle"] = .205; given["muscle"] = ",,"
    printed["block"] = "4800,6724"; ms["block"] = .342; given["block"] = ",,"
    printed["face"] = "12267,15516"; ms["face"] = .542; given["face"] = ".0120,.0095,.149"
}
NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
$at["what"] == "step" {
    name = $1
    sub(/\.model$/, "", name)
    took = $at["median_us_a_step"] / 1000
    printf "%s,%s,%s,%s,%s,%s,%s,%.4g,%s,%.3g,%s\n", name, printed[name], $at["elements"], $at["nodes"], $at["device"],
        $at["threads"], $at["precision"], took, ms[name], ms[name] / took, given[name]
}
