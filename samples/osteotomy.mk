# An osteotomy planned on the head: two pieces of its skull are cut out by closed OBJs (osteotomy.awk) and moved
# (osteotomy.poses), and the skin is predicted. Into ../out: osteotomy.obj, the predicted face; osteotomy.moved.txt, how far
# each part of the skin goes; osteotomy.voxels.txt, how far the prediction is from that of coarser voxels; osteotomy.png.
#
#     make -C samples osteotomy
#     make -C samples osteotomy OSTEOTOMY_SIDE=4 OSTEOTOMY_COARSE=5

OSTEOTOMY_SIDE = 5
OSTEOTOMY_COARSE = 7
OSTEOTOMY := $(OUT)/osteotomy
# Where a piece ends, tissue that is held by both sides of the cut is sheared by as much as the piece moves: finer voxels fold there.
OSTEOTOMY_RUN = -t 0.7 --rigid-poses osteotomy.poses
REGIONS = $(shell awk -v name=regions -f osteotomy.awk | sed 's/^/--region /')

.PHONY: osteotomy
osteotomy: $(OSTEOTOMY).moved.txt $(OSTEOTOMY).voxels.txt $(OSTEOTOMY).png

$(OSTEOTOMY).%.cut.obj: osteotomy.awk | $(OUT)
	LC_ALL=C awk -v name=$* -f $< >$@
$(OSTEOTOMY).result: SIDE = $(OSTEOTOMY_SIDE)
$(OSTEOTOMY).coarse.result: SIDE = $(OSTEOTOMY_COARSE)
$(OSTEOTOMY).result $(OSTEOTOMY).coarse.result: $(OUT)/head.obj $(OSTEOTOMY).maxilla.cut.obj $(OSTEOTOMY).chin.cut.obj osteotomy.poses
	voxelise --unit mm -s $(SIDE) --fraction 4 --materials head.materials $< | \
	    attach --fibre field --part maxilla=$(OSTEOTOMY).maxilla.cut.obj --part chin=$(OSTEOTOMY).chin.cut.obj | sinew bind | \
	    tled-run $(OSTEOTOMY_RUN) >$@
$(OSTEOTOMY).obj $(OSTEOTOMY).coarse.obj: %.obj: %.result $(OUT)/head.obj
	sinew deform $(OUT)/head.obj <$< >$@
$(OSTEOTOMY).moved.txt: $(OUT)/head.obj $(OSTEOTOMY).obj
	sinew distance --unit mm --of skin --to skin --both $(REGIONS) $^ >$@
$(OSTEOTOMY).voxels.txt: $(OSTEOTOMY).coarse.obj $(OSTEOTOMY).obj
	sinew distance --unit mm --of skin --to skin $(REGIONS) $^ >$@
$(OSTEOTOMY).png: $(OSTEOTOMY).result
	sinew render --sheet rest,deformed,deformed@right -o $@ $<
