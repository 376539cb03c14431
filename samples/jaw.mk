# A mouth that opens: the skull of a face is cut into skull and jaw (jaw.awk), and the jaw turns by 25 degrees about its condyles,
# which slide forward meanwhile. Into ../out: NAME.jaw.png, NAME.jaw.mp4 where there is ffmpeg, NAME.jaw.tsv (energies, and the
# force and the torque on the jaw).
#
#     make -C samples jaw                                          our head
#     make -C samples jaw FACE=face_zyg.obj JAW_SIDE=1.25          a face with groups skin and skull, as that of ArtiSynth
#
# The lips of our head are one piece, as it has no mouth. Those of a real face part, however near they are: --fraction opens slits
# (SLITS in voxelise(1)). Of ArtiSynth's face in voxels of 2.5 mm, 24 of 31,544 elements are folded at the end: 2 at the corners of the
# mouth, and most of the others along the cut between skull and jaw. Without slits 39 are folded.

JAW_SIDE = 2.5
JAW_EVERY = 0.01
# How a face is cut, what its tissue is, and how it is drawn.
ifneq ($(FACE),)
JAW_NAME := $(basename $(notdir $(FACE)))
JAW_CUT = -v forward=2 -v up=3 -v gap=11 -v jaw="300,-83 30,-78 18,-52 5,-40 -300,-40 -300,-400 300,-400"
JAW_SCRIPT = jaw.face.script
JAW_VOXELS =
JAW_TISSUE = -m tissue.nu=0.45
JAW_VIEW = --up z --front y
JAW_FILM = --up z --camera 25cm,52cm,-4cm,0,2cm,-7cm --angle 24
else
JAW_NAME = head
JAW_CUT =
JAW_SCRIPT = jaw.head.script
JAW_VOXELS = --materials head.materials
JAW_TISSUE =
JAW_VIEW =
JAW_FILM = --camera 36cm,4cm,62cm,0,-2cm,0 --angle 22
endif
JAW_OUT := $(OUT)/$(JAW_NAME).jaw

.PHONY: jaw
jaw: $(JAW_OUT).png $(JAW_OUT).tsv $(if $(shell command -v ffmpeg),$(JAW_OUT).mp4)

$(JAW_OUT).obj: jaw.awk $(or $(FACE),$(OUT)/head.obj) | $(OUT)
	LC_ALL=C awk $(JAW_CUT) -f jaw.awk $(or $(FACE),$(OUT)/head.obj) >$@
$(JAW_OUT).model: $(JAW_OUT).obj
	voxelise --unit mm -s $(JAW_SIDE) --fraction 4 $(JAW_VOXELS) $< | \
	    attach --fibre field --rigid skull,skull_jaw --part jaw=skull_jaw | sinew bind >$@
$(JAW_OUT).result: $(JAW_OUT).model $(JAW_SCRIPT)
	tled-run $(JAW_TISSUE) --script $(JAW_SCRIPT) -t 0.36 --every $(JAW_EVERY) --log $(JAW_OUT).part <$< >$@
	mv $(JAW_OUT).part $(JAW_OUT).tsv
$(JAW_OUT).tsv: $(JAW_OUT).result ;
$(JAW_OUT).png: $(JAW_OUT).result
	sinew render $(JAW_VIEW) --sheet rest,deformed@front,deformed,deformed@right -o $@ $<
$(JAW_OUT).mp4: $(JAW_OUT).result
	sinew render $(JAW_FILM) --frame all --format ppm --size 640x480 $< | \
	    ffmpeg -v error -y -f image2pipe -framerate 25 -i - -pix_fmt yuv420p $@
