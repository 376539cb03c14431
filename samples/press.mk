# A block of tissue that a ball presses, by springs and by finite elements: what each says, side by side.
#
#     make -C samples -f press.mk -j         into ../out: press.force, a table; VTU files for ParaView
#     make -C samples -f press.mk NODES=32x16x16 FEM=--exact SPRINGS='--spring-scale auto'
#
# As in samples/Makefile, the recipe's pipes need no `pipefail`.

OUT = ../out
NODES = 20x10x10
SIZE = 16cm,8cm,8cm
TISSUE = --young 10000 --poisson 0.45
PROBE = sphere:2cm
POSES = -v x=0.08 -v y=0.04 -v z=0.08 -v depth=0.015 -v seconds=2
SPRINGS =
FEM =
PATH := $(abspath $(or $(SINEW_BIN),../bin)):$(PATH)
export PATH

.DELETE_ON_ERROR:
.PHONY: all clean
all: $(OUT)/press.force $(OUT)/press.msds.vtu $(OUT)/press.fem.vtu

$(OUT)/press.model: | $(OUT)
	msds-mesh -q --nodes $(NODES) --size $(SIZE) $(TISSUE) --fix sides,zmin >$@
$(OUT)/press.tum: press.awk | $(OUT)
	LC_ALL=C awk $(POSES) -f press.awk >$@
$(OUT)/press.msds: $(OUT)/press.model $(OUT)/press.tum
	msds-run -q --method msds $(SPRINGS) --probe $(PROBE) --poses $(OUT)/press.tum <$< >$@
$(OUT)/press.fem: $(OUT)/press.model $(OUT)/press.tum
	msds-run -q --method fem $(FEM) --probe $(PROBE) --poses $(OUT)/press.tum <$< >$@
$(OUT)/press.%.vtu: $(OUT)/press.%
	sinew export -f vtu <$< >$@

# Of each frame: the force on the probe along z.
$(OUT)/press.%.force: $(OUT)/press.%
	sinew export -f model --text <$< | LC_ALL=C awk '$$1 == "frame" { time = $$3 } \
	    on { printf "%g %.4g\n", time, $$3; on = 0 } /^array probe.force / { on = 1 }' >$@
$(OUT)/press.force: $(OUT)/press.msds.force $(OUT)/press.fem.force
	{ echo '# s, N by springs, N by finite elements'; LC_ALL=C join $^; } >$@
$(OUT):
	mkdir -p $@

clean:
	rm -f $(addprefix $(OUT)/press.,model tum msds fem force msds.force fem.force msds.vtu fem.vtu)
