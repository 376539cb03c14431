# The gate: which lines and branches the tests reach, and whether they notice when the code is wrong. tests/RELIABILITY.md has results.

.PHONY: coverage coverage-run compile-commands mutate cli-programs
# With one counter update at a time (tests/gate/covered), which is many times faster than atomic ones.
COVERAGE_FLAGS = -O0 -g --coverage -fprofile-update=single
coverage:
	.ci/setup check
	$(MAKE) $(JOBS) CC=gcc BUILD=$(BUILD)/coverage BIN=$(BUILD)/coverage/bin CFLAGS='$(COVERAGE_FLAGS)' WERROR= CUDA=no coverage-run

coverage-run: all unit
	@rm -rf $(BUILD)/counters && mkdir -p $(BUILD)/counters
	@$(ENVIRONMENT) $(PROVE) --exec tests/gate/covered $(UNIT) $(CLI) >$(BUILD)/tests.log 2>&1; echo $$? >$(BUILD)/tests.status
	@$(MAKE) --no-print-directory -s compile-commands | python3 -B tests/gate/coverage.py $(BUILD)
	@echo 'never reached: $(BUILD)/branches.txt'
	@[ "$$(cat $(BUILD)/tests.status)" -eq 0 ] || { sed -n '/^Test Summary Report/,$$p' $(BUILD)/tests.log; exit 1; }

# How each source is compiled, with CUDA and without: what neither lets through the preprocessor is not compiled.
compile-commands:
	@for cuda in no yes; do $(MAKE) --no-print-directory -nB V=1 CUDA=$$cuda NVCC=nvcc all unit | grep -e ' -c -o '; done

# FOLDER is all, or a folder or file (`make mutate tled` will do); the same SEED gives the same mutants; ONLY=3,17 tries some of them again.
FOLDER = $(or $(firstword $(filter attach bind common msds slice tled voxelise,$(MAKECMDGOALS))),all)
N = 60
SEED = 1
mutate:
	.ci/setup check
	@[ -e $(BUILD)/coverage/map.json ] || $(MAKE) coverage
	@env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL python3 -B tests/gate/mutate.py $(BUILD) '$(FOLDER)' '$(N)' '$(SEED)' $(if $(ONLY),'$(ONLY)')

# What tests/cli runs.
cli-programs: all $(COMPARE) $(FAULTS)
