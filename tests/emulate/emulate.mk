# An emulated card, and the program that tests kernels on it: where there is g++, for x86-64. Nothing of CUDA is wanted.
# $(BUILD)/emulate has tled's CUDA as g++ makes it: each access of theirs a call (-fsanitize=thread), which comes to shadow.cc.

EMULATE_CXX ?= $(if $(filter x86_64,$(shell uname -m)),$(shell command -v g++))
EMULATE_CU := $(addprefix tled/cuda/,cuda_march cuda_single cuda_double cuda_look) common/solve/card $(addprefix tests/emulate/,wrong any_single any_double)
EMULATE_OBJ := $(addprefix $(BUILD)/emulate/,$(addsuffix .o,$(EMULATE_CU) tled/cuda/cuda_march_double fibres shadow shared telling streams tled/cuda/march)) \
	$(addprefix $(BUILD)/tled/cuda/,march_units.o march_cells.o march_near.o march_tips.o) \
	$(addprefix $(BUILD)/tled/tiles/,bricks.o places.o lattice_sheet.o tile_parts.o tile_split.o tiles.o)
EMULATE_FLAGS = -std=c++17 -g -Wall $(WERROR) -Itests/emulate $(CPPFLAGS) -MMD -MP
EMULATE_CU_FLAGS = -O1 -g1 -mavx2 -mfma -fsanitize=thread,undefined -fno-sanitize-recover=undefined -fno-math-errno -Wno-sign-compare \
	-Wno-unknown-pragmas -Wno-unused-function

$(BUILD)/emulate/%.o: %.cu
	@mkdir -p $(@D)
	$(call run,EMULATE $<,$(EMULATE_CXX) $(EMULATE_FLAGS) $(EMULATE_CU_FLAGS) -ffp-contract=$(EMULATE_CONTRACT) -x c++ -c -o $@ $<)
$(BUILD)/emulate/%_double.o: EMULATE_CU_FLAGS += -DMARCH_DOUBLE
$(BUILD)/emulate/%_double.o: %.cu
	@mkdir -p $(@D)
	$(call run,EMULATE $<,$(EMULATE_CXX) $(EMULATE_FLAGS) $(EMULATE_CU_FLAGS) -ffp-contract=$(EMULATE_CONTRACT) -x c++ -c -o $@ $<)
EMULATE_CONTRACT = off
$(addprefix $(BUILD)/emulate/tled/cuda/,cuda_march.o cuda_march_double.o cuda_look.o): EMULATE_CONTRACT = fast
# However small, a frame has its own memory on the card.
$(addprefix $(BUILD)/emulate/,$(patsubst %,%.o,tled/cuda/cuda_single tled/cuda/cuda_double tests/emulate/any_single tests/emulate/any_double)): EMULATE_CU_FLAGS += -DFRAME_DIRECT=0

$(BUILD)/emulate/%.o: tests/emulate/%.cc
	@mkdir -p $(@D)
	$(call run,EMULATE $<,$(EMULATE_CXX) $(EMULATE_FLAGS) -O3 -Wextra -c -o $@ $<)

# Whatever its shape, a model marches here; and its units may be told to wait for too few.
$(BUILD)/emulate/tled/cuda/march.o: tled/cuda/march.c
	@mkdir -p $(@D)
	$(call run,CC $<,$(CC) $(ALL_CFLAGS) -DMARCH_SPARSE=1e9 -Dmarch_near_find=near_find_tried -c -o $@ $<)

# Elsewhere it is a unit test as others are, and skips.
EMULATED := $(if $(EMULATE_CXX),tests/unit/test_tled_emulated)
ifneq ($(EMULATED),)
$(BUILD)/$(EMULATED).o: CPPFLAGS += -DSINEW_EMULATED
$(BUILD)/$(EMULATED): $(BUILD)/$(EMULATED).o $(EMULATE_OBJ) $(call needs,$(EMULATED).c) $(MAIN_OBJ) $(LIB)
	$(call run,LD $@,$(EMULATE_CXX) $(CFLAGS) $(LDFLAGS) -fsanitize=address -fsanitize=undefined -o $@ $^ $(AS_NEEDED) $(EMBREE) $(PICTURES) $(COLLIDE) $(LDLIBS))
endif
