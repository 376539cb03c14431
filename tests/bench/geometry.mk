# `make bench-geometry`: reading OBJ, models through pipes, attach and bind on the real face, beside a probe of the machine; CSV.
.PHONY: bench-geometry
BENCH_GEOMETRY = $(BUILD)/tests/bench/bench_geometry
$(eval $(call test_program,tests/bench/bench_geometry))
bench-geometry: all $(BENCH_GEOMETRY)
	@$(BENCH_GEOMETRY) $(BIN) $(or $(SINEW_SHARED),../shared)/data/face/face_zyg.obj
