# Sinew. `make demo` and `make check` are the two commands to begin with; `make help` lists the rest.

CC = cc
NVCC ?= $(shell command -v nvcc 2>/dev/null || ls /usr/local/cuda/bin/nvcc 2>/dev/null)
CUDA ?= $(if $(NVCC),yes,no)
CUDA_HOME ?= $(if $(NVCC),$(abspath $(dir $(realpath $(NVCC)))/..))
PREFIX ?= /usr/local
BUILD ?= build
BIN ?= bin

# The warning set, for gcc and clang alike; `make WERROR=` to live with them.
WARN = -Wall -Wextra -Wpedantic -Wshadow -Wvla -Wconversion -Wno-sign-conversion -Wstrict-prototypes \
       -Wmissing-prototypes -Wpointer-arith -Wcast-qual -Wwrite-strings -Wundef -Wformat=2
WERROR = -Werror
OPT = -O3
# No contraction: a fused multiply-add that one compiler makes and another does not would change results.
CFLAGS = $(OPT) $(DEBUG)
# -g1, functions and lines alone, takes a fifth less of the time.
DEBUG = -g
CSTD = -std=c11 -D_XOPEN_SOURCE=700 -D_DEFAULT_SOURCE -ffp-contract=off -fno-math-errno -pthread
CPPFLAGS = -Icommon -I. -isystem /usr/include/freetype2 $(foreach folder,$(lastword $(wildcard /usr/include/openjpeg-2.*)),-isystem $(folder))
ALL_CFLAGS = $(CSTD) $(WARN) $(WERROR) $(CFLAGS) $(VARIANT) $(CPPFLAGS) -MMD -MP
LDLIBS = -lz -lm -pthread
EMBREE = -lembree3
# DCMTK is C++, and so is the one file that uses it.
CXX = $(if $(findstring clang,$(CC)),$(subst clang,clang++,$(CC)),c++)
DICOM = -ldcmjpeg -ldcmjpls -ldcmimgle -ldcmdata -loflog -lofstd -lstdc++ -lopenjp2
PICTURES = -lpng -lfreetype
COLLIDE = -lccd
WEB = -lcivetweb -lturbojpeg

TOOLS = voxelise attach bind tled-run msds-mesh msds-run us-import us-segment us-surface us-slice \
	sinew sinew-materials sinew-deform sinew-results sinew-info sinew-diff sinew-distance sinew-poses sinew-register sinew-export sinew-import sinew-render sinew-console sinew-igtl-out sinew-igtl-in

# `make V=1` shows whole commands.
ifeq ($(V),1)
run = $(2)
else
run = @echo "  $(1)"; $(2)
endif

# Every .c of these folders is the library, but for what mains begin and end with, and say on standard error: that is linked beside it.
MAIN_SRC := common/cli/tool.c common/cli/progress.c
MAIN_OBJ := $(MAIN_SRC:%.c=$(BUILD)/%.o)
LINK_LIB := $(addprefix common/link/,address.c socket.c igtl.c igtl_content.c igtl_reader.c)
LIB_SRC := $(filter-out $(MAIN_SRC) common/cli/sinew.c common/results/sinew-results.c common/render/sinew-render.c common/place/sinew-register.c common/render/render_%,$(wildcard common/base/*.c common/physics/*.c common/cli/*.c common/model/*.c common/frames/*.c common/surface/*.c common/mesh/*.c common/place/*.c common/volume/*.c common/probe/*.c common/live/*.c) $(LINK_LIB) $(wildcard common/solve/*.c common/picture/*.c common/results/*.c common/render/*.c))
LIB_OBJ := $(LIB_SRC:%.c=$(BUILD)/%.o)
LIB := $(BUILD)/libsinew.a

.PHONY: all
all: $(TOOLS:%=$(BIN)/%) $(BIN)/voxelize

# The American spelling of the name runs the same tool.
$(BIN)/voxelize: $(BIN)/voxelise
	@ln -sf voxelise $@

$(LIB): $(LIB_OBJ)
	@rm -f $@
	@ar rcs $@ $^

$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	$(call run,CC $<,$(CC) $(ALL_CFLAGS) -c -o $@ $<)

$(BUILD)/%.o: %.cc
	@mkdir -p $(@D)
	$(call run,CXX $<,$(CXX) -std=c++17 -Wall -Wextra $(WERROR) $(CFLAGS) -fno-sanitize=vptr -ffp-contract=off -pthread $(CPPFLAGS) -MMD -MP -c -o $@ $<)

# CUDA: machine code for sm_90, and for the rest from sm_75 on what the driver compiles. As with C, no multiply and add is fused,
# so that a card computes what a processor does. Objects are linked by cc, so they must not want C++'s library.
CUDA_ARCH = -gencode arch=compute_90,code=sm_90 -gencode arch=compute_75,code=compute_75
CUDA_FUSED = false
# -lineinfo for profilers: it makes code three times as large, which each run loads first.
CUDA_LINES =
NVCC_FLAGS = -std=c++17 -O3 $(CUDA_LINES) -fmad=$(CUDA_FUSED) $(CUDA_ARCH) -Werror all-warnings \
	-Xcompiler -fno-threadsafe-statics,-fno-exceptions,-fno-rtti,-ffp-contract=off,-fno-math-errno,-pthread,-Wall
# CUDA_QUICK=yes: what is only to be seen to compile, as where no card is, in a fifth of the time; it would run slowly.
CUDA_QUICK ?= no
MARCH_ARCH = -gencode arch=compute_90,code=compute_90
ifeq ($(CUDA_QUICK),yes)
CUDA_ARCH = -gencode arch=compute_90,code=sm_90
MARCH_ARCH =
NVCC_FLAGS += $(if $(shell $(NVCC) --help 2>/dev/null | grep -e -Ofc),-Ofc max)
endif
# As on the CPU: numbers of single precision that are too small to be normal are zero.
$(BUILD)/tled/cuda/cuda_single.o: NVCC_FLAGS += -ftz=true
$(BUILD)/msds/cuda/cuda_%.o: NVCC_FLAGS += -ftz=true
# The results of these need not have the bytes of the processor, so they may fuse; the march is for cards from sm_90 on, and is compiled
# for each precision.
MARCH_OBJ := $(addprefix $(BUILD)/tled/cuda/,cuda_march.o cuda_march_double.o)
$(BUILD)/tled/cuda/cuda_look.o $(MARCH_OBJ): CUDA_FUSED = true
$(MARCH_OBJ): NVCC_FLAGS += -ftz=true
$(MARCH_OBJ): CUDA_ARCH = -gencode arch=compute_90,code=sm_90 $(MARCH_ARCH)
CUDA_SRC := $(wildcard common/solve/*.cu tled/cuda/*.cu msds/cuda/*.cu)
CUDA_OBJ := $(CUDA_SRC:%.cu=$(BUILD)/%.o) $(BUILD)/tled/cuda/cuda_march_double.o
$(if $(filter-out yes no,$(CUDA)),$(error CUDA is '$(CUDA)'; expected yes or no))
ifeq ($(CUDA),yes)
LIB_CUDA := $(BUILD)/libsinew-cuda.a
CUDA_LIBS := -L$(CUDA_HOME)/lib64 -lcudart_static -ldl -lrt -lpthread
endif

# What only cards use, in C, is in it too.
CUDA_ONLY := $(wildcard tled/tiles/*.c tled/cuda/*.c msds/cuda/*.c)
$(BUILD)/libsinew-cuda.a: $(CUDA_OBJ) $(CUDA_ONLY:%.c=$(BUILD)/%.o)
	@rm -f $@
	@ar rcs $@ $^

define nvcc
	$(if $(NVCC),,$(error there is no nvcc for CUDA=yes; expected NVCC with its path, or CUDA=no))
	@mkdir -p $(@D)
	$(call run,NVCC $<$1,$(NVCC) $(NVCC_FLAGS)$1 -Icommon -I. -MMD -MP -MF $(@:.o=.d) -c -o $@ $<)
	@objcopy -w -N 'tmpxft_*' $@ # the name of a temporary file: the same source is to give the same bytes
endef
$(BUILD)/%.o: %.cu $(BUILD)/quick-$(CUDA_QUICK)
	$(nvcc)
$(BUILD)/%_double.o: %.cu $(BUILD)/quick-$(CUDA_QUICK)
	$(call nvcc, -DMARCH_DOUBLE)

$(BUILD)/quick-$(CUDA_QUICK):
	@mkdir -p $(@D)
	@rm -f $(BUILD)/quick-*
	@touch $@

# Which of the two is built is known to few files, made again when that changes.
KNOW_CUDA := $(addprefix $(BUILD)/,tled/loop/executors.o tests/unit/test_tled_cuda.o msds/run/msds_executors.o tests/unit/test_msds_cuda.o)
$(BUILD)/cuda-$(CUDA):
	@mkdir -p $(@D)
	@rm -f $(BUILD)/cuda-yes $(BUILD)/cuda-no
	@touch $@
$(KNOW_CUDA): $(BUILD)/cuda-$(CUDA)
$(KNOW_CUDA): CPPFLAGS += $(if $(LIB_CUDA),-DSINEW_CUDA)

# Loops of the solvers that are compiled several times: SOURCE.c becomes SOURCE.A.o, SOURCE.B.o ..., where A and B are words, joined by -, that
# each have flags. Which one runs is chosen at run time, and all instruction sets (common/solve/vectors.h) give the same bytes.
# AVX512=no: without AVX-512, in a folder of its own (BUILD), for a build that is only to be tested: two thirds of the time.
AVX512 ?= yes
SETS := plain $(if $(filter x86_64,$(shell uname -m)),avx2 $(if $(filter no,$(AVX512)),,avx512))
CPPFLAGS += $(if $(filter no,$(AVX512)),-DVECTORS_WITHOUT_AVX512)
PRECISIONS := double single
flags_plain :=
flags_avx2 := -mavx2 -DVECTORS=avx2
flags_avx512 := -mavx512f -mavx512vl -mavx512dq -mavx512bw -mprefer-vector-width=512 -DVECTORS=avx512
flags_double :=
flags_single := -DELEMENT_SINGLE
# The forms that steppers are compiled for, as NAME/name.
FORMS := $(shell sed -n 's|^ *X.with, \([A-Z_]*\), \([a-z_]*\),.*|\1/\2|p' common/physics/forms.h)
$(foreach form,$(FORMS),$(eval flags_$(notdir $(form)) := -DCPU_FORM=$(patsubst %/,%,$(dir $(form)))))
variants_tled/cpu/cpu_lanes.c := $(foreach form,$(notdir $(FORMS)),$(foreach set,$(SETS),$(PRECISIONS:%=$(set)-%-$(form))))
variants_msds/cpu/lanes_loops.c := $(SETS)
variants_slice/image/slice_lanes_loops.c := $(SETS)

# $(1): the source; $(2): the variant. (No psabi: vectors are passed between functions of one file only.)
define variant
$(BUILD)/$(basename $(1)).$(2).o: VARIANT = -Wno-psabi $(foreach word,$(subst -, ,$(2)),$(flags_$(word)))
$(BUILD)/$(basename $(1)).$(2).o: $(1)
	@mkdir -p $$(@D)
	$$(call run,CC $$< ($(2)),$$(CC) $$(ALL_CFLAGS) -c -o $$@ $$<)
endef
$(foreach source,$(patsubst variants_%,%,$(filter variants_%,$(.VARIABLES))),$(foreach name,$(variants_$(source)),$(eval $(call variant,$(source),$(name)))))

# A tool: its main is the file of its name; what else its folder holds belongs to it.
objects = $(foreach file,$(1),$(addprefix $(BUILD)/$(basename $(file)),$(or $(patsubst %,.%.o,$(variants_$(file))),.o)))
VOXELISE_SRC := $(wildcard voxelise/*.c voxelise/surfaces/*.c)
ATTACH_SRC := $(wildcard attach/*.c attach/shape/*.c)
BIND_MODULES := $(filter-out bind/bind.c bind/sinew-deform.c,$(wildcard bind/*.c))
TLED_SRC := $(wildcard tled/muscle/*.c tled/problem/*.c tled/contact/*.c tled/cpu/*.c tled/coarse/*.c tled/loop/*.c tled/run/*.c)
MSDS_MESH_SRC := $(wildcard msds/mesh/*.c)
MSDS_RUN_SRC := $(wildcard msds/problem/*.c msds/cpu/*.c msds/tangent/*.c msds/run/*.c)
IMPORT_SRC := $(wildcard slice/import/*.c) slice/import/dicom_file.cc
SEGMENT_SRC := slice/contour/us-segment.c $(wildcard slice/contour/segment_*.c)
SURFACE_SRC := slice/contour/us-surface.c $(wildcard slice/contour/contour*.c) slice/contour/cubes.c
SLICE_SRC := $(wildcard slice/image/*.c)
INFO_MODULES := $(wildcard common/inspect/info_*.c)
PLAN_SRC := $(wildcard common/plan/*.c)
DISTANCE_MODULES := $(wildcard common/inspect/distance_*.c)
PRESET_MODULES := $(wildcard common/inspect/preset_*.c)
EXPORT_MODULES := $(wildcard common/exchange/export_*.c)
IMPORT_MODULES := $(wildcard common/exchange/import_*.c)
RENDER_MODULES := $(wildcard common/render/render_*.c)
CONSOLE_SRC := $(wildcard common/console/*.c common/console/programs/*.c)
IGTL_IN_SRC := $(wildcard common/link/track/*.c)
SERVE_MODULES := $(wildcard common/link/serve_*.c)

define tool
$(BIN)/$(1): $(call objects,$(2)) $(MAIN_OBJ) $(4) $(LIB)
	@mkdir -p $$(@D)
	$$(call run,LD $$@,$$(CC) $$(CSTD) $$(CFLAGS) $$(LDFLAGS) -o $$@ $$^ $(3) $(5) $$(LDLIBS))
endef
$(eval $(call tool,voxelise,$(VOXELISE_SRC),$$(EMBREE)))
$(eval $(call tool,attach,$(ATTACH_SRC)))
$(eval $(call tool,bind,bind/bind.c $(BIND_MODULES),$$(EMBREE)))
$(eval $(call tool,sinew-deform,bind/sinew-deform.c $(filter-out bind/side.c bind/touch.c bind/touch_%.c,$(BIND_MODULES))))
$(eval $(call tool,tled-run,$(TLED_SRC),,$(LIB_CUDA),$(CUDA_LIBS)))
$(eval $(call tool,msds-mesh,$(MSDS_MESH_SRC)))
$(eval $(call tool,msds-run,$(MSDS_RUN_SRC),$$(COLLIDE),$(LIB_CUDA),$(CUDA_LIBS)))
$(eval $(call tool,us-import,$(IMPORT_SRC),$$(DICOM)))
$(eval $(call tool,us-segment,$(SEGMENT_SRC)))
$(eval $(call tool,us-surface,$(SURFACE_SRC)))
$(eval $(call tool,us-slice,$(SLICE_SRC),$$(PICTURES)))
$(eval $(call tool,sinew,common/cli/sinew.c))
$(eval $(call tool,sinew-materials,common/inspect/sinew-materials.c $(PRESET_MODULES)))
$(eval $(call tool,sinew-results,common/results/sinew-results.c))
$(eval $(call tool,sinew-info,common/inspect/sinew-info.c $(INFO_MODULES)))
$(eval $(call tool,sinew-diff,common/inspect/sinew-diff.c))
$(eval $(call tool,sinew-distance,common/inspect/sinew-distance.c $(DISTANCE_MODULES)))
$(eval $(call tool,sinew-poses,$(PLAN_SRC)))
$(eval $(call tool,sinew-register,common/place/sinew-register.c))
$(eval $(call tool,sinew-export,common/exchange/sinew-export.c $(EXPORT_MODULES)))
$(eval $(call tool,sinew-import,common/exchange/sinew-import.c $(IMPORT_MODULES)))
$(eval $(call tool,sinew-render,common/render/sinew-render.c $(RENDER_MODULES),$$(EMBREE) $$(PICTURES)))
$(eval $(call tool,sinew-console,$(CONSOLE_SRC),$$(WEB) $$(PICTURES)))
$(eval $(call tool,sinew-igtl-in,$(IGTL_IN_SRC)))
$(eval $(call tool,sinew-igtl-out,common/link/sinew-igtl-out.c $(SERVE_MODULES)))

.PHONY: clean
clean:
	rm -rf $(BUILD) $(BIN) out

include tests/check.mk
include debian/package.mk

-include $(shell find $(BUILD) -path $(BUILD)/mutate -prune -o -name '*.d' -type f -print 2>/dev/null)
