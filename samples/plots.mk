# Plots of a run: where its energy comes from and goes (tled-run --log), and how a place moves (sinew info --tsv). Needs gnuplot.
#
#     make -C samples plots                  of the muscle and the block, into ../out: NAME.energy.png, NAME.way.png
#     make -C samples plots PLOTS=head       of any of the shapes, or of OBJ files in IN=folder

PLOTS = muscle block
# Whose way is drawn, by its place at rest; lengths with units.
place.muscle = 3mm,5mm,9mm
place.block = 0,0,2mm
place.sphere = 0,0,-100mm
PLACE = 0,0,0
LOG_EVERY = 0.001

.PHONY: plots
plots: $(PLOTS:%=$(OUT)/%.energy.png) $(PLOTS:%=$(OUT)/%.way.png)

# One run gives both tables; a log appears as the run goes, so it is named anew once it is whole.
$(OUT)/%.way.tsv $(OUT)/%.log.tsv &: $(OUT)/%.model
	tled-run $(or $(run.$*),$(RUN)) --every 0.002 --log $(OUT)/$*.log.part --log-every $(LOG_EVERY) <$< | \
	    sinew info --tsv node.displacement.at.$(or $(place.$*),$(PLACE)) --tsv node.displacement.max >$(OUT)/$*.way.tsv
	mv $(OUT)/$*.log.part $(OUT)/$*.log.tsv
$(OUT)/%.energy.png: $(OUT)/%.log.tsv energy.gnuplot
	gnuplot -e "table = '$<'; picture = '$@'; name = '$*'" energy.gnuplot
$(OUT)/%.way.png: $(OUT)/%.way.tsv way.gnuplot
	gnuplot -e "table = '$<'; picture = '$@'; name = '$*'" way.gnuplot
