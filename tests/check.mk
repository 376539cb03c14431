# What stands around the tools: set-up, the demo, every check, installation. The top Makefile includes this last; its
# variables and pattern rules are used here. A bare machine has neither compiler nor libraries when make begins,
# so `demo` and `check` run .ci/setup and only then call make again for the rest.
#
# ---- What runs where. tests/check has the lists of parts; these are their times on two processors of an AMD EPYC with little else to do, from
# a clean clone and without a compiler cache. (On a busy machine each takes several times as long.)
#   make check      before every commit: the build by gcc, and by nvcc where it is, 220 s; clang-format 4 s, shellcheck 19 s, manual pages 3 s,
#                   shape 1 s; all unit and command tests, 230 s
#   .ci/run         that, nvcc's code hardly optimized (CUDA_QUICK=yes; the build takes 160 s), CUDA's kernels on a card that the processor
#                   plays, among the tests, and cppcheck of one combination of #ifdefs, clang's warnings, clang-tidy without its analyzer, the
#                   unit tests with ASan and UBSan, 2 s of each fuzz target, and the browser: about 13 minutes more
#   make check-all  that, with the build by clang, cppcheck of all combinations, clang's analyzer, all tests sanitized and 10 s of each fuzz target, and tsan, valgrind, 20 s of each live run and the slow tests: an hour or more
#   make soak       300 s of each fuzz target, tests that take many minutes with SINEW_LONG, ten minutes of each live run, tests/long/run1e6: hours
# What a test lacks (a program, data, a card) it names, and is skipped. .ci/setup check installs what is small, so that a visitor's results are
# compared with CalculiX, pydicom and DCMTK; VTK, Gmsh, gnuplot, ffmpeg, clang, cppcheck, valgrind and chromium come with .ci/setup check-all.

CLANG ?= clang
CLANG_TIDY ?= clang-tidy
CLANG_FORMAT ?= clang-format
# Of each fuzz target; `make fuzz SECONDS=60` for longer.
SECONDS ?= 5
# Tests that do much more where SINEW_LONG is set: make check-all runs those of SLOW so, which take at most a few minutes each then, and
# make soak those of SOAK, which take longer.
SLOW = $(addprefix tests/cli/,attach_surface.t element.t voxelise_exact.t voxelise_films.t voxelise_mixed.t) $(UNIT_TEST)voxelise_scan $(UNIT_TEST)voxelise_inside $(UNIT_TEST)checkpoint \
	$(addprefix tests/cli/,calculix.t conforming.t element-nvcc.t examples.t hostile.t killed.t msds-long.t msds-probe.t muscle.t) \
	$(addprefix tests/cli/,quoted.t readme.t samples.t shells.t slits.t tissue-laws.t tled.t us-bad.t us-import-packed.t us-private.t us-slice.t voxelise_strain.t) \
	tests/cli/self_contact.t
SOAK = $(UNIT_TEST)tled_emulated $(addprefix tests/cli/,calls.t faults.t memory.t restart.t streams.t threads.t)
UNIT_TEST = $(BUILD)/tests/unit/test_
# As many jobs as processors, unless make was told (then its job server serves the inner makes too).
JOBS = $(if $(findstring -j,$(MAKEFLAGS)),,-j$(shell nproc 2>/dev/null || echo 2))

# ---- test programs: the library, and the objects that a line `// needs: a/b.c c/d.c` in the source names.
UNIT_SRC := $(wildcard tests/unit/test_*.c)
FUZZ_SRC := $(wildcard tests/fuzz/fuzz_*.c)
ON_EMULATED = $(UNIT_TEST)tled_emulated $(UNIT_TEST)msds_emulated
UNIT := $(filter-out $(ON_EMULATED),$(UNIT_SRC:%.c=$(BUILD)/%))
FUZZ := $(FUZZ_SRC:%.c=$(BUILD)/%)
# Each fuzz target with a plain main, which tries the inputs that it is given: no libFuzzer, any compiler.
REPLAY := $(FUZZ_SRC:tests/fuzz/fuzz_%.c=$(BUILD)/tests/fuzz/replay_%)
# Embree and the rest only for those that turn out to use them. (A variable: the comma.)
AS_NEEDED = -Wl,--as-needed
# SOURCE|NEEDED, of all such lines: read at once, since a shell for each program takes seconds each time that make begins.
NEEDED := $(shell awk '/^\/\/ needs:/ { for (i = 3; i <= NF; i++) print FILENAME "|" $$i }' $(wildcard tests/*/*.c))
# A star stands for all such files; tled/*/*.c: all but the main and what only cards use.
needs = $(call objects,$(wildcard $(patsubst tled/*/*.c,$(filter-out tled/run/tled-run.c,$(TLED_SRC)),$(patsubst $(1)|%,%,$(filter $(1)|%,$(NEEDED))))))

# $(1): the program; $(2): flags; $(3), $(4): its source, where that has another name, and an object more.
define test_program
$(BUILD)/$(1): $(BUILD)/$(or $(3),$(1)).o $(4) $(call needs,$(or $(3),$(1)).c) $(MAIN_OBJ) $(LIB_CUDA) $(LIB)
	$$(call run,LD $$@,$$(CC) $$(CSTD) $$(CFLAGS) $$(LDFLAGS) $(2) -o $$@ $$^ $$(AS_NEEDED) $$(EMBREE) $$(PICTURES) $$(WEB) $$(COLLIDE) $$(DICOM) $$(CUDA_LIBS) $$(LDLIBS))
endef
TEST_TOOLS := compare_pictures list_voxels peak long_stream reader
COMPARE := $(TEST_TOOLS:%=$(BUILD)/tests/cli/%) $(REPLAY)
$(foreach tool,$(TEST_TOOLS),$(eval $(call test_program,tests/cli/$(tool))))
include tests/emulate/emulate.mk
$(foreach source,$(filter-out $(EMULATED),$(UNIT_SRC:.c=)),$(eval $(call test_program,$(source))))
$(foreach source,$(FUZZ_SRC:.c=),$(eval $(call test_program,$(source),-fsanitize=fuzzer)))
$(foreach source,$(FUZZ_SRC:tests/fuzz/fuzz_%.c=%),$(eval $(call test_program,tests/fuzz/replay_$(source),,tests/fuzz/fuzz_$(source),$(BUILD)/tests/fuzz/driver.o)))

# To optimize these takes longer than they take to run; but for some, which then run for seconds more.
UNIT_LONG := $(addprefix tests/unit/test_,slice.c tetra.c voxelise_inside.c)
$(patsubst %.c,$(BUILD)/%.o,$(filter-out $(UNIT_LONG),$(UNIT_SRC))): CFLAGS := $(CFLAGS:-O3=-O1)

# What makes programs fail: libraries to preload.
FAULTS := $(patsubst tests/%.c,$(BUILD)/tests/%.so,$(wildcard tests/faults/*.c)) $(if $(LIB_CUDA),$(BUILD)/tests/faults/wreck_card.so)
$(BUILD)/tests/faults/%.so: tests/faults/%.c tests/faults/next.h
	@mkdir -p $(@D)
	$(call run,LD $@,$(CC) $(CSTD) -D_GNU_SOURCE $(WARN) $(WERROR) -O2 -fPIC -shared -o $@ $< -ldl)
$(BUILD)/tests/faults/wreck_card.so: tests/faults/wreck_card.cu
	@mkdir -p $(@D)
	$(call run,NVCC $<,$(NVCC) $(NVCC_FLAGS) -Xcompiler -fPIC -shared -o $@ $<)

.PHONY: setup demo check check-all check-ci soak unit check-unit check-cli check-tests check-emulated check-slow check-soak check-live check-link check-run1e6
setup:
	.ci/setup check

demo:
	.ci/setup demo
	$(MAKE) $(JOBS) CUDA_QUICK=$(QUICK) all
	SINEW_BIN=$(BIN) samples/demo out

# The second example: an arm's vessels under a probe, with plots where there is gnuplot.
.PHONY: arm
arm: all
	SINEW_BIN=$(BIN) samples/arm out/arm

# The figures and tables of both papers, beside what they print: out/paper/paper.html, and the same as text.
.PHONY: paper
paper: all $(addprefix $(BUILD)/tests/bench/bench_,tled msds msds_card slice)
	SINEW_BIN=$(BIN) BENCH=$(BUILD)/tests/bench samples/paper out/paper

# Expressions of a real face, FACE=FILE.obj: out/NAME.expressions.png, and how far the corners of its mouth move (samples/expressions.mk).
.PHONY: expressions
expressions: all
	$(MAKE) -C samples expressions OUT=../out FACE=$(abspath $(FACE)) SINEW_BIN=$(abspath $(BIN))

# The third: from an ultrasound volume to images of it as a probe presses it, with a video where there is ffmpeg.
.PHONY: scan
scan: all
	SINEW_BIN=$(BIN) samples/scan out/scan

# A probe and a face to be moved by hand, on a page in a browser: cases from equations, and sinew console on them. THREE: the folder of
# another copy of three.js.
.PHONY: console
console:
	$(if $(THREE),.ci/setup demo,.ci/setup console)
	$(MAKE) $(JOBS) all
	SINEW_BIN=$(BIN) samples/console out/console
	$(BIN)/sinew console $(if $(THREE),--three $(THREE)) out/console

# The pictures in README.md: small, since they are kept in the repository; make demo and make scan leave larger ones. The first one,
# samples/expressions.png, is what `make expressions` leaves of ArtiSynth's face.
.PHONY: picture
picture: demo scan
	$(BIN)/sinew render --view front --cut x=0 --sheet rest,voxels,front,deformed --size 1200x400 -o samples/face.png out/smile.sinew
	cd out/scan && ../../$(BIN)/us-slice -q --depth 38mm --width 56mm --size 400 -o picture_%d.png arm.nrrd <arm.sinew
	cp out/scan/picture_0.png samples/vein_open.png
	cp out/scan/picture_45.png samples/vein_closed.png
	rm out/scan/picture_*.png
	SINEW_BIN=$(BIN) samples/console out/console
	SINEW_BIN=$(BIN) /usr/bin/python3 tests/browser/console_pictures.py out/console samples

CHECK = BUILD=$(BUILD) JOBS='$(JOBS)' tests/check
# Without a card, kernels are only to be seen to compile: machine code that is hardly optimised. make install makes it anew; check-all
# has it as it is installed.
QUICK := $(if $(wildcard /dev/nvidia0),no,yes)
check:
	.ci/setup check
	CUDA_QUICK=$(QUICK) MAKE='$(MAKE)' $(CHECK) check

check-all:
	.ci/setup check-all
	MAKE='$(MAKE)' $(CHECK) all

# For .ci/run, which has done the set-up.
check-ci:
	CUDA_QUICK=yes MAKE='$(MAKE)' $(CHECK) ci

soak:
	.ci/setup check-all
	MAKE='$(MAKE)' $(CHECK) soak

unit: $(UNIT) $(COMPARE) $(FAULTS)

# CUDA's kernels on a card that the processor plays: apart, since g++ takes a minute or two to compile them for it.
check-emulated: $(ON_EMULATED)
	$(ENVIRONMENT) $(PROVE) $^

# ---- the tests, as TAP under prove; V=1 shows every line
PROVE = prove $(if $(V),-v) $(or $(JOBS),-j2)
# A shell ignores signals for the commands that it runs in the background; tests want their default actions.
SIGNALS := $(shell env --default-signal=INT,QUIT,PIPE true 2>/dev/null && echo env --default-signal=INT,QUIT,PIPE)
ENVIRONMENT = $(SIGNALS) SINEW_BIN=$(BIN) BUILD=$(BUILD) CC='$(CC)' NVCC='$(NVCC)' MAKE='$(MAKE)'
CLI = $(sort $(wildcard tests/cli/*.t))

check-unit: unit
	$(ENVIRONMENT) $(PROVE) $(UNIT)

check-cli: all $(COMPARE) $(FAULTS)
	$(ENVIRONMENT) $(PROVE) $(CLI)

# EMULATED_TOO=yes: check-emulated's programs with them, of which tled's takes one processor for as long as many of these take the other.
check-tests: all unit $(if $(EMULATED_TOO),$(ON_EMULATED))
	$(ENVIRONMENT) $(PROVE) $(filter-out unit all,$^) $(UNIT) $(CLI)

check-slow: all unit
	$(ENVIRONMENT) SINEW_LONG=1 $(PROVE) $(SLOW)

# Runs with threads, and runs that are killed, are repeated a hundred times.
check-soak: all unit $(UNIT_TEST)tled_emulated
	$(ENVIRONMENT) SINEW_LONG=1 REPEATS=100 $(PROVE) $(SOAK)

# OpenIGTLink, with Debian's library on the other side.
check-link: all
	$(ENVIRONMENT) $(PROVE) $(sort $(wildcard tests/link/*.t))

# Live runs, each of so many seconds, and so many short ones that are recorded and replayed.
LIVE_SECONDS ?= 20
LIVE_SESSIONS ?= 4
check-live: all
	$(ENVIRONMENT) prove $(if $(V),-v) --exec python3 tests/long/live.py :: $(BIN) $(LIVE_SECONDS) $(LIVE_SESSIONS)

check-run1e6: all
	SINEW_BIN=$(BIN) tests/long/run1e6 5

# Every output of this build's tools beside those of another build, for changes that change no results.
.PHONY: same
same: all
	$(if $(WITH),,$(error expected WITH=FOLDER, a folder with the tools of another build))
	tests/same $(BIN) $(WITH)

# ---- benchmarks: CSV, on standard output and in out/bench.csv, a table each; tests/bench keeps one of each machine
.PHONY: bench bench-tled bench-table1 bench-voxelise bench-geometry bench-msds bench-msds_card bench-images bench-slice bench-contact bench-fraction bench-accuracy bench-console bench-jobs compare-msds
BENCHES = voxelise geometry tled msds msds_card images slice
BENCH_HEAD = $(wildcard $(or $(SINEW_SHARED),../shared)/data/ultrasound/fetal-head)
BENCH_FACE = $(wildcard $(or $(SINEW_SHARED),../shared)/data/face/face_zyg.obj)
BENCH_MODELS = $(if $(BENCH_FACE),$(foreach side,5 2.5 1.25 0.625,$(BUILD)/tests/bench/face_$(side)mm))
TRIANGLES ?= 100000
$(foreach name,$(BENCHES),$(eval $(call test_program,tests/bench/bench_$(name))))
# What a card can do at most, for what is compared with it.
$(BUILD)/tests/bench/bench_tled.o: $(BUILD)/cuda-$(CUDA)
ifeq ($(CUDA),yes)
$(BUILD)/tests/bench/bench_tled.o: CPPFLAGS += -DSINEW_CUDA
$(BUILD)/tests/bench/bench_tled: $(BUILD)/tests/bench/card_roof.o
endif
bench: all $(BENCHES:%=$(BUILD)/tests/bench/bench_%)
	@mkdir -p out
	@{ tests/bench/machine; for name in $(BENCHES) table1 contact; do echo "# $$name"; \
	    $(MAKE) --no-print-directory -s bench-$$name || echo '# failed'; done; } | tee out/bench.csv
	@! grep -q '^# failed' out/bench.csv
bench-tled: all $(BUILD)/tests/bench/bench_tled $(BENCH_MODELS)
	@$(BUILD)/tests/bench/bench_tled $(shell nproc) 5 all runs .3 $(BENCH_MODELS) nu=0.45 $(filter %_0.625mm,$(BENCH_MODELS))
# W&M's Table 1 on our samples.
bench-table1: all $(BUILD)/tests/bench/bench_tled
	@tests/bench/table1 $(BIN) $(BUILD)/tests/bench/bench_tled $(BUILD)/tests/bench/table1 $(shell nproc)
# What slits, sliding and skin that touches itself add to a step, on a real face with muscles: on the CPU, and on a card if there is one.
CONTACT_FACE = $(wildcard $(or $(SINEW_SHARED),../shared)/data/face/face_all.obj)
CONTACT_SIDES = 2.5
CONTACT_SIDES_CARD = 2.5 1.25
CONTACT_MODELS = $(BUILD)/tests/bench/contact-models
CONTACT_RUN = tests/bench/contact $(BIN) $(CONTACT_FACE) $(CONTACT_MODELS) $(shell nproc)
bench-contact: all
	@rm -rf $(CONTACT_MODELS) # of other tools, maybe
	@$(if $(CONTACT_FACE),$(CONTACT_RUN) 3 cpu $(CONTACT_SIDES),echo '# skipped: no face_all.obj in SINEW_SHARED')
	@! nvidia-smi >/dev/null 2>&1 || $(if $(CONTACT_FACE),$(CONTACT_RUN) 7 cuda $(CONTACT_SIDES_CARD),true)
$(BUILD)/tests/bench/face_%mm: all
	@mkdir -p $(@D)
	@$(BIN)/voxelise -q --unit mm -s $* $(BENCH_FACE) | $(BIN)/attach -q -o $@
# The steps of voxelise on a closed scan.
bench-voxelise: $(BUILD)/tests/bench/bench_voxelise
	@$(BUILD)/tests/bench/bench_voxelise $(TRIANGLES) $(BUILD)
# Reading OBJ, models through pipes, attach and bind on the real face.
bench-geometry: all $(BUILD)/tests/bench/bench_geometry
	@$(BUILD)/tests/bench/bench_geometry $(BIN) $(BENCH_FACE)
# Frames of msds-run's solvers at the sizes of PST's Table I, beside its figures.
bench-msds: $(BUILD)/tests/bench/bench_msds
	@$(BUILD)/tests/bench/bench_msds $(shell nproc)
# Images of us-slice at the sizes of PST's Tables I and II, beside their figures; out/regions.png where there is gnuplot.
bench-slice: all $(BUILD)/tests/bench/bench_slice
	@mkdir -p out
	@$(BUILD)/tests/bench/bench_slice $(shell nproc) 5 out/regions.dat >out/slice.csv && cat out/slice.csv
	@! command -v gnuplot >/dev/null || gnuplot -e "data='out/regions.dat'; picture='out/regions.png'" tests/bench/regions.plot
	@! command -v python3 >/dev/null || python3 tests/bench/live.py $(BIN) $(shell nproc) out/slice.csv
# Whole pipes by stage, beside the machine's limits; OLD=FOLDER of other tools: beside those, too. Many minutes on a slow machine, and so no part of bench.
JOBS_RUN = OLD='$(OLD)' /usr/bin/python3 tests/bench/jobs.py $(BIN) $(shell nproc) 3 $(CONTACT_FACE) $(BUILD)/tests/bench/jobs-files
JOBS_SIDES = 2.5 1.25
JOBS_SIDES_CARD = 2.5 1.25 .625
bench-jobs: all
	@tests/bench/machine
	@$(if $(CONTACT_FACE),$(JOBS_RUN) cpu $(JOBS_SIDES),echo '# skipped: no face_all.obj in SINEW_SHARED')
	@! nvidia-smi >/dev/null 2>&1 || $(if $(CONTACT_FACE),$(JOBS_RUN) cuda $(JOBS_SIDES_CARD),true)
# What the console's page shows a second, in headless chromium: the delay from a pose to its image; PST's Table II; W&M's Table 1.
bench-console: all
	@SINEW_BIN=$(BIN) /usr/bin/python3 tests/browser/bench_console.py
# The same on a card, where there is one, and with half a million nodes.
bench-msds_card: $(BUILD)/tests/bench/bench_msds_card
	@$(BUILD)/tests/bench/bench_msds_card
# DICOM to volumes, labels and surfaces.
bench-images: all $(BUILD)/tests/bench/bench_images
	@$(BUILD)/tests/bench/bench_images $(BIN) $(BUILD) $(BENCH_HEAD)
# No time, but how far springs are from the FEM at those sizes.
compare-msds: all
	@tests/bench/msds_compare $(BIN)
# No time, but how fast models converge, by centres and by shares; it takes many minutes, and is no part of bench.
bench-fraction: all
	@tests/bench/fraction $(BIN) $(BENCH_FACE)
	@tests/bench/border $(BIN) 16 32 64
# Error against wall time beside CalculiX: ten minutes on two quiet processors, and so no part of bench; a table and a figure in out.
bench-accuracy: all
	@mkdir -p out
	@{ tests/bench/accuracy $(BIN) $(shell nproc) || echo '# failed'; } | tee out/accuracy.csv
	@! grep -q '^# failed' out/accuracy.csv
	@awk -f tests/bench/accuracy_svg.awk out/accuracy.csv >out/accuracy.svg

include tests/gate/gate.mk

# ---- other builds, each in its own folder. With -g1 what is said has lines, and all compiles in half the time of -g.
.PHONY: clang sanitize fuzz fuzz-run
# (CUDA's kernels, and their card that a processor plays, are compiled by nvcc and g++ whoever compiles the rest: once is enough.)
# Its warnings are the same whether it optimizes or not, which takes two thirds of the time: CLANG_FLAGS=-O0 for these alone.
CLANG_FLAGS = -O3 -g1
clang:
	$(MAKE) $(JOBS) CC=$(CLANG) BUILD=$(BUILD)/clang BIN=$(BUILD)/clang/bin CFLAGS='$(CLANG_FLAGS)' CUDA=no EMULATE_CXX= all unit

# A sanitizer's complaint is exit status 99, which no test expects. An allocation that is too large is refused, as it is without.
SANITIZE = -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
sanitize:
	ASAN_OPTIONS=exitcode=99:allocator_may_return_null=1 UBSAN_OPTIONS=exitcode=99:print_stacktrace=1 SINEW_SANITIZED=1 \
	    $(MAKE) $(JOBS) BUILD=$(SANITIZED) BIN=$(SANITIZED)/bin CFLAGS='$(SANITIZE)' CUDA=no EMULATE_CXX= $(SANITIZE_GOAL)
SANITIZE_GOAL = check-tests
SANITIZED = $(BUILD)/sanitize$(if $(filter no,$(AVX512)),-avx2)

# Data races: what has threads, under ThreadSanitizer. (Embree, which is not built so, is seen from outside only.)
.PHONY: tsan tsan-run
TSAN = -O1 -g1 -fsanitize=thread -fno-omit-frame-pointer
TSAN_UNIT = $(patsubst %,$(BUILD)/tests/unit/test_%,pool lines spnav frame_writer frame_queue tled_step tled_run tled_live msds_run msds_live slice voxelise_voxels)
tsan:
	TSAN_OPTIONS=exitcode=99 SINEW_SANITIZED=1 REPEATS=1 $(MAKE) $(JOBS) BUILD=$(BUILD)/tsan BIN=$(BUILD)/tsan/bin CFLAGS='$(TSAN)' CUDA=no tsan-run
tsan-run: all $(TSAN_UNIT)
	$(ENVIRONMENT) prove $(if $(V),-v) $(TSAN_UNIT) tests/cli/threads.t tests/cli/live-slice.t tests/cli/live-msds.t tests/cli/live-tled.t tests/cli/spnav.t tests/cli/batch.t tests/cli/batch-msds.t

# Every tool under valgrind's memcheck; and in a browser, the HTML pages that samples/paper and man/html make, and the console's page.
.PHONY: check-valgrind valgrind browser
check-valgrind:
	.ci/setup valgrind
	$(MAKE) $(JOBS) valgrind
valgrind: all
	$(ENVIRONMENT) prove $(if $(V),-v) tests/cli/valgrind.sh
browser: all
	$(ENVIRONMENT) prove $(if $(V),-v) tests/cli/browser.sh tests/browser/console_page.sh tests/browser/console_live.sh

FUZZ_FLAGS = -O1 -g1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
fuzz:
	$(MAKE) $(JOBS) CC=$(CLANG) BUILD=$(BUILD)/fuzz BIN=$(BUILD)/fuzz/bin CFLAGS='$(FUZZ_FLAGS)' CUDA=no \
	    SECONDS=$(SECONDS) fuzz-run
fuzz-run: $(FUZZ)
	$(PROVE) --exec 'tests/fuzz/run $(SECONDS)' $(FUZZ)

# ---- lints
.PHONY: lint lint-cppcheck lint-tidy lint-tidy-quick lint-format lint-shell lint-man lint-shape
FOLDERS = $(filter-out $(BUILD)/ $(BIN)/ out/,$(wildcard */))
# None found: something is wrong, and a lint of nothing would pass.
found = $(or $(sort $(shell find $(FOLDERS) -name '$(1)')),$(error no $(1) in $(FOLDERS)))
SOURCES := $(call found,*.c)
HEADERS := $(call found,*.h)
CUDA_FILES = $(call found,*.cu) $(call found,*.cuh)
# Each file that begins as a script does, and those that scripts read.
SCRIPTS := $(or $(sort $(shell grep -rlIE '^\#!/(usr/)?bin/(env )?(ba)?sh' .ci man samples tests) $(wildcard tests/cli/*.sh) $(filter-out %.awk %.gnuplot %.css,$(wildcard samples/paper.d/*))),$(error no scripts))
lint: lint-cppcheck lint-tidy lint-format lint-shell lint-man lint-shape

# One stamp a file, so that only what changed is read again, and in parallel. (No C is compiled by nvcc: without -U half of the time of files
# that have element.h goes into what such a compiler would see.)
#
# CPPCHECK_DEFINES: defines of the one combination of #ifdefs that is looked at, such as GCC_DEFINES; without, cppcheck tries up to twelve,
# which takes five times as long.
GCC_DEFINES = -D__GNUC__=12 -D__x86_64__ -D__SSE2__ -D__BYTE_ORDER__=1234 -D__ORDER_LITTLE_ENDIAN__=1234
CPPCHECK_DEFINES =
CPPCHECK = cppcheck --quiet --std=c11 -U__CUDACC__ --enable=warning,performance,portability --inline-suppr --error-exitcode=1 --suppress=missingIncludeSystem
lint-cppcheck: $(SOURCES:%.c=$(BUILD)/cppcheck/%.ok)
$(BUILD)/cppcheck/%.ok: %.c $(HEADERS)
	@mkdir -p $(@D)
	$(call run,CPPCHECK $<,$(CPPCHECK) $(CPPCHECK_DEFINES) $(CPPFLAGS) $<)
	@touch $@

# clang-tidy, and the warnings of clang itself, which are errors as in a build by clang. lint-tidy-quick: all but clang's analyzer, which
# takes three quarters of the time.
lint-tidy: $(SOURCES:%.c=$(BUILD)/tidy/%.ok)
lint-tidy-quick: $(SOURCES:%.c=$(BUILD)/tidy-quick/%.ok)
tidy = $(call run,TIDY $<,$(CLANG_TIDY) --quiet $(1) $< -- $(CSTD) $(WARN) $(CPPFLAGS) 2>$(@:.ok=.err) || { cat $(@:.ok=.err) >&2; exit 1; })
$(BUILD)/tidy/%.ok: %.c .clang-tidy tests/.clang-tidy $(HEADERS)
	@mkdir -p $(@D)
	$(call tidy)
	@touch $@
$(BUILD)/tidy-quick/%.ok: %.c .clang-tidy tests/.clang-tidy $(HEADERS)
	@mkdir -p $(@D)
	$(call tidy,'--checks=-clang-analyzer-*')
	@touch $@

lint-format:
	@$(CLANG_FORMAT) --dry-run -Werror $(SOURCES) $(HEADERS) $(call found,*.cc) $(CUDA_FILES) $(call found,*.js)

lint-shell: $(SCRIPTS:%=$(BUILD)/shellcheck/%.ok)
$(BUILD)/shellcheck/%.ok: % $(filter %.sh,$(SCRIPTS))
	@mkdir -p $(@D)
	$(call run,SHELLCHECK $<,shellcheck --external-sources --source-path=SCRIPTDIR $<)
	@touch $@

lint-man:
	@tests/pages $(wildcard man/*.[157])

# What no compiler sees: tests/shape says what.
lint-shape: all
	@BUILD=$(BUILD) tests/shape

# ---- the manual pages as HTML
.PHONY: html
html:
	.ci/setup html
	@man/html out/man
	@echo out/man/index.html

# ---- installation
.PHONY: install uninstall
INSTALL = install
BINDIR = $(DESTDIR)$(PREFIX)/bin
MANDIR = $(DESTDIR)$(PREFIX)/share/man
SAMPLEDIR = $(DESTDIR)$(PREFIX)/share/doc/sinew/samples
COMPLETIONDIR = $(DESTDIR)$(PREFIX)/share/bash-completion/completions
# Debian's packages have another folder for these, and its zsh does not read this one below /usr.
ZSH_COMPLETIONS = $(PREFIX)/share/zsh/site-functions
ZSHDIR = $(DESTDIR)$(ZSH_COMPLETIONS)
# `bind` has none in bash: bash-completion has a file of that name, for the shell's builtin.
COMPLETIONS = $(filter-out bind,$(TOOLS))
PAGES = $(wildcard man/*.[157])
# The console's page, as it lies.
PAGEDIR = $(DESTDIR)$(PREFIX)/share/sinew/console
PAGE_FILES = $(wildcard common/console/page/*.*)
# Files of materials, which sinew materials lists; in the folder of samples too.
PRESETDIR = $(DESTDIR)$(PREFIX)/share/sinew/materials
PRESETS = $(wildcard samples/*.materials)
SAMPLES = $(filter-out samples/demo samples/arm samples/scan samples/console samples/paper samples/paper.d samples/igtl,$(wildcard samples/*))

install: all
	$(INSTALL) -d $(BINDIR) $(COMPLETIONDIR) $(ZSHDIR) $(SAMPLEDIR)/igtl $(PAGEDIR) $(PRESETDIR) $(MANDIR)/man1 $(MANDIR)/man5 $(MANDIR)/man7
	$(INSTALL) -m 755 $(TOOLS:%=$(BIN)/%) $(BINDIR)
	ln -sf voxelise $(BINDIR)/voxelize
	for section in 1 5 7; do $(INSTALL) -m 644 man/*.$$section $(MANDIR)/man$$section || exit 1; done
	$(INSTALL) -m 644 $(SAMPLES) $(SAMPLEDIR)
	$(INSTALL) -m 644 $(wildcard samples/igtl/*.xml samples/igtl/*.py) $(SAMPLEDIR)/igtl
	$(INSTALL) -m 644 $(PRESETS) $(PRESETDIR)
	$(if $(PAGE_FILES),$(INSTALL) -m 644 $(PAGE_FILES) $(PAGEDIR))
	for tool in $(COMPLETIONS); do $(BIN)/$$tool --table bash >$(COMPLETIONDIR)/$$tool || exit 1; done
	for tool in $(TOOLS); do $(BIN)/$$tool --table zsh >$(ZSHDIR)/_$$tool || exit 1; done
	ln -sf voxelise.1 $(MANDIR)/man1/voxelize.1
	ln -sf voxelise $(COMPLETIONDIR)/voxelize
	chmod 644 $(COMPLETIONS:%=$(COMPLETIONDIR)/%) $(TOOLS:%=$(ZSHDIR)/_%)

uninstall:
	rm -f $(TOOLS:%=$(BINDIR)/%) $(COMPLETIONS:%=$(COMPLETIONDIR)/%) $(TOOLS:%=$(ZSHDIR)/_%) \
	    $(BINDIR)/voxelize $(MANDIR)/man1/voxelize.1 $(COMPLETIONDIR)/voxelize \
	    $(foreach page,$(PAGES),$(MANDIR)/man$(subst .,,$(suffix $(page)))/$(notdir $(page)))
	rm -rf $(SAMPLEDIR) $(PAGEDIR) $(PRESETDIR)
	rmdir $(dir $(SAMPLEDIR)) $(dir $(PAGEDIR)) 2>/dev/null || :

.PHONY: help
help:
	@printf '%s\n' \
	'make              the tools, into $(BIN)/' \
	'make demo         set-up, build, and the head sample through the whole pipeline, into out/' \
	'make arm          an arm under a probe, by springs and by finite elements, into out/arm' \
	'make scan         from an ultrasound volume to images of it under a probe, into out/scan' \
	'make console      a page in a browser on an arm and a patient under a probe, and a head, live; cases in out/console' \
	'make paper        the figures and tables of both papers, beside what they print; out/paper/paper.html' \
	'make expressions  FACE=FILE.obj: smile, frown, pucker, disgust, an open jaw, ooh and blow of a real face; out/NAME.expressions.png' \
	'make picture      the pictures in README.md, anew: replaces samples/*.png' \
	'' \
	'make check        set-up, the build, all tests, and small lints: run it before each commit; 13 minutes on two processors' \
	'make check-all    that, and clang, sanitizers, fuzzers, clang-tidy, cppcheck, valgrind, a browser, slow tests; an hour or more' \
	'make soak         the long runs: fuzzing, a fault at every call, a hundred repeats, live runs, a million steps; hours' \
	'make check-ci     what continuous integration runs (.ci/run): check, and a fixed list of the parts of check-all' \
	'' \
	'make setup        installs by apt what make check needs (through sudo if not root), and names it' \
	'make check-unit   the unit tests            make check-cli   the tests of the commands' \
	'make check-tests  both, with the counts     make check-slow  slow tests, at their full length' \
	'make check-emulated   kernels of CUDA on a card that the processor plays; it takes three minutes' \
	'make check-link   poses, images and surfaces by OpenIGTLink, with a library that is not ours on the other side' \
	'make check-live   live runs of LIVE_SECONDS=$(LIVE_SECONDS) each, and LIVE_SESSIONS=$(LIVE_SESSIONS) that are recorded and replayed' \
	'make same WITH=FOLDER   what the outputs of this build differ in from those of the tools in FOLDER' \
	'make lint         clang-format, shellcheck, manual pages, shape; and cppcheck and clang-tidy, which take minutes' \
	'make lint-NAME    one of them: cppcheck, tidy (tidy-quick: without the analyzer), format, shell, man, shape' \
	'make clang        the tools and unit tests, built by clang' \
	'make sanitize     the tests under ASan and UBSan' \
	'make tsan         the tests of threads under ThreadSanitizer' \
	'make fuzz         every fuzz target for SECONDS=$(SECONDS) each' \
	'make check-valgrind  set-up, and every tool under valgrind, on small inputs' \
	'make coverage     the lines and branches that make check reaches, by folder; those never reached in $(BUILD)/coverage/branches.txt' \
	'make mutate       changes the code of FOLDER=all at N=$(N) places, one at a time, and names the changes that no test notices' \
	'make browser      the HTML pages of make paper and make html, and the console, in headless chromium' \
	'' \
	'make bench        how long things take, beside a probe of the machine; into out/bench.csv' \
	'make bench-voxelise, -geometry, -tled, -table1, -msds, -slice, -images, -contact   its parts (TRIANGLES=100000: of the scan)' \
	'make compare-msds    how far springs are from finite elements' \
	'make bench-fraction  how fast models converge, by centres and by shares' \
	'make bench-accuracy  error against wall time, beside CalculiX; out/accuracy.csv and out/accuracy.svg' \
	'make bench-jobs      whole pipes by stage, beside the machine; OLD=FOLDER of tools: beside those, too' \
	'make bench-console   what the page of sinew console shows a second, in headless chromium' \
	'make html         set-up, and the manual pages as HTML, into out/man' \
	'make install      into PREFIX=$(PREFIX) (DESTDIR is heeded); make uninstall takes it away' \
	'make deb          set-up, and a Debian package of what make install installs, into out/' \
	'make deb-check    that, installed, tried and removed in a bare system of its own (by mmdebstrap, from the network)' \
	'make clean        removes what was built' \
	'' \
	'CC, CFLAGS, BUILD, BIN, CUDA=no, WERROR= are the variables to know.'
