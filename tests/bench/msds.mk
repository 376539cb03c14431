# `make bench-msds`: frames of msds-run's solvers at the sizes of PST's Table I, beside its figures and a probe of the machine; CSV.
.PHONY: bench-msds
BENCH_MSDS = $(BUILD)/tests/bench/bench_msds
$(eval $(call test_program,tests/bench/bench_msds))
bench-msds: $(BENCH_MSDS)
	@$(BENCH_MSDS) $(shell nproc)

# How far springs are from the FEM at those sizes: CSV.
.PHONY: compare-msds
compare-msds: all
	@tests/bench/msds_compare $(BIN)
