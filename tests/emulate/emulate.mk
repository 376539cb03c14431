# An emulated card, and the programs that test kernels on it: where there is g++, for x86-64. Nothing of CUDA is wanted.
# $(BUILD)/emulate has kernels as g++ makes them: each access of theirs a call (-fsanitize=thread), which comes to shadow.cc.

EMULATE_CXX ?= $(if $(filter x86_64,$(shell uname -m)),$(shell command -v g++))
EMULATE_CARD := $(addprefix $(BUILD)/emulate/,$(addsuffix .o,common/solve/card fibres shadow shared telling streams))
EMULATE_CU := $(addprefix tled/cuda/,cuda_march cuda_single cuda_double cuda_look) $(addprefix tests/emulate/,wrong any_single any_double)
EMULATE_TLED := $(EMULATE_CARD) $(addprefix $(BUILD)/emulate/,$(addsuffix .o,$(EMULATE_CU) tled/cuda/cuda_march_double tled/cuda/march)) \
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

EMULATE_MSDS := $(EMULATE_CARD) $(addprefix $(BUILD)/emulate/,msds/cuda/cuda_frames.o tests/emulate/emulated_frames.o)

# Elsewhere they are unit tests as others are, and skip.
EMULATED := $(if $(EMULATE_CXX),$(addprefix tests/unit/test_,tled_emulated msds_emulated))
ifneq ($(EMULATED),)
$(EMULATED:%=$(BUILD)/%.o): CPPFLAGS += -DSINEW_EMULATED
$(BUILD)/tests/unit/test_tled_emulated: $(EMULATE_TLED)
$(BUILD)/tests/unit/test_msds_emulated: $(EMULATE_MSDS)
define emulated_program
$(BUILD)/$(1): $(BUILD)/$(1).o $(call needs,$(1).c) $(MAIN_OBJ) $(LIB)
	$$(call run,LD $$@,$$(EMULATE_CXX) $$(CFLAGS) $$(LDFLAGS) -fsanitize=address -fsanitize=undefined -o $$@ $$(filter-out $$(LIB),$$^) $$(LIB) $$(AS_NEEDED) $$(EMBREE) $$(PICTURES) $$(COLLIDE) $$(LDLIBS))
endef
$(foreach program,$(EMULATED),$(eval $(call emulated_program,$(program))))
endif
