# A case, as sinew(7) describes one: from a patient's DICOM files to labels, surfaces, and a mesh that a probe presses.
#
#     make -C samples case                     our own arm, into ../out/case
#     make -C samples case PATIENT=folder      a folder of DICOM files, with LABELS that suit it
#
# LABELS: names; label.NAME: how us-segment finds it; SURFACE: how surfaces are smoothed; NODES: of the mesh.

CASE = $(OUT)/case
PATIENT = $(CASE)/dicom
LABELS = bone vein artery
label.bone = --low 210 --largest
label.vein = --high 45 --seed 9,11,0mm
label.artery = --high 45 --seed -8,14,0mm
SURFACE = --smooth 0.8mm
NODES = 20x14x12
PRESS = --method fem --probe sphere:12mm

.PHONY: case
case: $(CASE)/pressed.obj

$(CASE)/dicom: patient.awk
	mkdir -p $@
	LC_ALL=C awk -v folder=$@ -f patient.awk
	touch $@
$(CASE)/volume.nrrd: $(PATIENT)
	mkdir -p $(CASE)
	us-import -o $@ $<
# One label after the other, each onto those before.
$(CASE)/labels.nrrd: $(CASE)/volume.nrrd
	rm -f $@ $@.*
	set -e; onto=; $(foreach name,$(LABELS),us-segment -n $(name) $(label.$(name)) $$onto -o $@.$(name) $<; onto='--onto $@.$(name)'; ) \
	    mv $@.$(lastword $(LABELS)) $@; rm -f $@.*
$(CASE)/surfaces.obj: $(CASE)/labels.nrrd
	us-surface -l all $(SURFACE) -o $@ $<
$(CASE)/mesh.sinew: $(CASE)/volume.nrrd $(CASE)/surfaces.obj
	msds-mesh --like $< --nodes $(NODES) --fix ymax | sinew bind --unit mm $(CASE)/surfaces.obj >$@
# A ball, whose lowest point is what the poses say, comes down on the vein, 7 mm deep, and goes up again.
$(CASE)/poses.tum:
	mkdir -p $(CASE)
	LC_ALL=C awk 'BEGIN { for (i = 0; i <= 20; i++) { s = i / 20; printf "%g 0.009 %.6f 0 -0.70710678 0 0 0.70710678\n", i / 20, \
	    -.002 + .009 * 4 * s * (1 - s) } }' >$@
$(CASE)/pressed.sinew: $(CASE)/mesh.sinew $(CASE)/poses.tum
	msds-run $(PRESS) --poses $(CASE)/poses.tum <$< >$@
$(CASE)/pressed.obj: $(CASE)/pressed.sinew $(CASE)/surfaces.obj
	sinew deform --frame 10 $(CASE)/surfaces.obj <$< >$@
