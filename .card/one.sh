cd .card
(time timeout 200 ./test_msds_cuda > $OUT/cuda.log 2>&1) 2>&1 | grep real
grep -v "^ok" $OUT/cuda.log | grep -v differ | head -40
grep differ $OUT/cuda.log
grep tissue $OUT/cuda.log | head -60
timeout 100 ./test_msds_live > $OUT/live.log 2>&1; tail -1 $OUT/live.log; grep "^not" $OUT/live.log
timeout 120 ./bench_msds_card 1
command -v ncu; uname -r
timeout 60 compute-sanitizer ./test_msds_cuda small 2>&1 | tail -5
