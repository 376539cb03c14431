cd .card
for n in 4 3 5; do echo "== $n"; timeout 60 ./tb$n; done
echo == prof; timeout 60 ./tbp
timeout 100 ./test_msds_cuda > $OUT/cuda.log 2>&1
grep "^not" $OUT/cuda.log; tail -1 $OUT/cuda.log; grep -A1 "tissue\|methods" $OUT/cuda.log | grep "within\|differ\|changes"
timeout 100 ncu --clock-control none -k regex:newton --launch-skip 70 --launch-count 1 --section SpeedOfLight --section MemoryWorkloadAnalysis --section MemoryWorkloadAnalysis_Tables --section WarpStateStats --section InstructionStats ./tb4 2>&1 | grep -v "^==PROF==\|--------" | tail -120
