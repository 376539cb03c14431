# Expressions of a real face as a contact sheet: smile, frown, pucker, disgust, an open jaw, ooh and blow, of face.expressions, by all
# the muscles that it has and with its lips open. Into ../out: NAME.expressions.png; NAME.expressions.tsv, how far the corners of its mouth move
# (x, y, z and length in the OBJ's unit, of the left and the right one); NAME.landmarks.tsv, how far the landmarks of EXPRESSIONS_LANDMARKS
# move.
#
#     make expressions FACE=face_all.obj                   the face of ArtiSynth, with 34 muscles
#     make expressions FACE=face_all.obj EXPRESSIONS_SIDE=1.25
#
# The lips, in a box, touch each other, and may slide on the teeth and come off them; of another face EXPRESSIONS_LIPS=auto takes all
# that is about its mouth, EXPRESSIONS_LIPS= lets nothing touch, EXPRESSIONS_SLIDE= lets nothing slide, and EXPRESSIONS_LANDMARKS names its own landmarks.
#
# The skull is cut into skull and jaw as in jaw.mk. Tissue and muscles are those of face.materials.

EXPRESSIONS_SIDE = 2.5
EXPRESSIONS_SLITS = on
EXPRESSIONS_LIPS = skin:-28,50,-102,28,90,-65
EXPRESSIONS_SLIDE = skull,skull_jaw:-22,40,-108,22,75,-58
EXPRESSIONS_TISSUE = -m muscle.peak=3e5
EXPRESSIONS_RUN = --precision single --rise-fall 0.01,0.04 -t 3.2 --every 0.05
EXPRESSIONS_FRAMES = smile:7 frown:16 pucker:25 disgust:34 jaw-open:43 ooh:54 blow:63
EXPRESSIONS_LANDMARKS = face.landmarks
EXPRESSIONS := $(OUT)/$(basename $(notdir $(or $(FACE),face))).expressions
empty :=
comma := ,

.PHONY: expressions
expressions: $(EXPRESSIONS).png $(EXPRESSIONS).tsv $(EXPRESSIONS:.expressions=.landmarks).tsv

$(EXPRESSIONS).model: $(if $(FACE),$(JAW_OUT).obj) face.materials
	$(if $(FACE),,$(error no face; expected FACE=FILE.obj, a face with groups skin, skull and muscle_*))
	voxelise --unit mm -s $(EXPRESSIONS_SIDE) --fraction 4 --slits $(EXPRESSIONS_SLITS) --materials face.materials $< | \
	    attach --rigid skull,skull_jaw --part jaw=skull_jaw $(if $(EXPRESSIONS_SLIDE),--slide-off $(EXPRESSIONS_SLIDE)) | \
	    sinew bind $(if $(EXPRESSIONS_LIPS),--self-contact $(EXPRESSIONS_LIPS)) >$@
$(EXPRESSIONS).script: expressions.face.script | $(OUT)
	sed 's/ face:/ $(JAW_NAME).jaw:/' $< >$@
$(EXPRESSIONS).result: $(EXPRESSIONS).model $(EXPRESSIONS).script face.expressions
	tled-run $(EXPRESSIONS_TISSUE) --script $(EXPRESSIONS).script --expressions face.expressions $(EXPRESSIONS_RUN) <$< >$@
$(EXPRESSIONS).png: $(EXPRESSIONS).result
	sinew render --up z --size 1600x860 --sheet \
	    rest=rest@front$(subst $(empty) $(empty),,$(foreach f,$(EXPRESSIONS_FRAMES),$(comma)$(subst :,=front:,$(f)))) -o $@ $<
$(EXPRESSIONS).tsv: $(EXPRESSIONS).result corner.awk
	for f in $(EXPRESSIONS_FRAMES); do \
	    sinew deform -q --frame $${f#*:} $(JAW_OUT).obj <$< >$@.obj && \
	    printf '%s\t' $${f%:*} && LC_ALL=C awk -f corner.awk $(JAW_OUT).obj $@.obj || exit 1; done >$@
	rm -f $@.obj
$(EXPRESSIONS:.expressions=.landmarks).tsv: $(EXPRESSIONS).result landmarks.awk $(EXPRESSIONS_LANDMARKS)
	rm -rf $@.d && mkdir $@.d
	for f in $(EXPRESSIONS_FRAMES); do \
	    sinew deform -q --frame $${f#*:} $(JAW_OUT).obj <$< >$@.d/$${f%:*}.obj || exit 1; done
	LC_ALL=C awk -f landmarks.awk $(EXPRESSIONS_LANDMARKS) $(JAW_OUT).obj \
	    $(foreach f,$(EXPRESSIONS_FRAMES),$@.d/$(firstword $(subst :, ,$(f))).obj) >$@
	rm -r $@.d
