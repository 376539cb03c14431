#include "slice/image/slice_options.h"

#include "live/spnav.h"
#include "slice/image/slice_cutter.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { SLICES = 5, SLICES_MOST = 99 };

#define TO(field) offsetof(slice_options, field)
static const opt option_list[] = {
    {OPT_INPUT, 0, "poses", "FILE", OPT_TEXT, TO(poses), 0, 0, NULL, OPT_FILE, "poses [default those of the frames]"},
    {OPT_INPUT, 0, "transform", "NAME", OPT_TEXT, TO(transform), 0, 0, NULL, 0, "which transform of a PLUS sequence"},
    {OPT_INPUT, 0, "rigid", NULL, OPT_FLAG, TO(rigid), 0, 0, NULL, 0, "read no model: the volume is not deformed"},
    {OPT_INPUT, 0, "body", "FILE", OPT_TEXT, TO(body), 0, 0, NULL, OPT_FILE, "where the volume lies for --poses"},
    {OPT_INPUT, 0, "marker", "FILE", OPT_TEXT, TO(marker), 0, 0, NULL, OPT_FILE,
     "where the probe's face is on the marker that --poses are of"},
    {OPT_RESULT, 0, "size", "COLUMNSxROWS", OPT_TEXT, TO(size), 0, 0, NULL, 0,
     "one side alone: to scale [pixels; default 512 columns]"},
    {OPT_ACTION, 0, "probe", "SHAPE", OPT_TEXT, TO(probe), 0, 0, "linear:|curved:|phased:", 0,
     "linear:W,T, curved:R,ANGLE,T or phased:ANGLE [default the probe that pressed]"},
    {OPT_ACTION, 0, "depth", "D", OPT_LENGTHS, TO(depth), 0, 1, NULL, 0, "depth along a beam [length; default 5cm]"},
    {OPT_ACTION, 0, "width", "W", OPT_LENGTHS, TO(width), 0, 1, NULL, 0, "width [length; default the probe's]"},
    {OPT_ACTION, 0, "thickness", "T[,N]", OPT_TEXT, TO(thickness), 0, 0, NULL, 0,
     "thickness of the beam: the mean of N slices, 5 if not given [length; default one slice]"},
    {OPT_ACTION, 0, "coupling", "GAP", OPT_LENGTHS, TO(coupling), 0, 1, NULL, 0,
     "dark where the face is farther than GAP from tissue [length; default off]"},
    {OPT_ACTION, 0, "gain", "DB", OPT_NUMBER, TO(gain), -200, 200, NULL, 0, "gain [dB; default 0]"},
    {OPT_ACTION, 0, "tgc", "DB,...", OPT_NUMBERS, TO(tgc), 1, 6, NULL, 0,
     "time-gain compensation: gains from face to depth [dB]"},
    {OPT_ACTION, 0, "dynamic-range", "DB[,DB]", OPT_NUMBERS, TO(range), 1, 2, NULL, 0,
     "dynamic range [dB; default 60,60]"},
    {OPT_ACTION, 0, "window", "LOW,HIGH", OPT_NUMBERS, TO(window), 2, 2, NULL, 0,
     "values of black and white [default 0,255 or extremes]"},
    {OPT_INPUT, 0, "labels", "FILE", OPT_TEXT, TO(labels), 0, 0, NULL, OPT_FILE, "tint what this label image marks"},
    {OPT_INPUT, 0, "live", NULL, OPT_FLAG, TO(live), 0, 0, NULL, 0, "show the newest frame and pose, as they come"},
    {OPT_INPUT, 0, "control", "FILE", OPT_TEXT, TO(control), 0, 0, NULL, OPT_FILE,
     "with --live, a FIFO of lines set KEY VALUE"},
    {OPT_INPUT, 0, "replay", "FILE", OPT_TEXT, TO(replay), 0, 0, NULL, OPT_FILE, "make the images of a record again"},
    {OPT_ACTION, 0, "rate", "HZ", OPT_NUMBER, TO(rate), 1, 1000, NULL, 0,
     "with --live, images a second while nothing new comes [Hz; default 60]"},
    {OPT_RESULT, 0, "record", "FILE", OPT_TEXT, TO(record), 0, 0, NULL, OPT_FILE | OPT_WRITES,
     "with --live, write down what images were made from"},
    {OPT_RESULT, 0, "force", NULL, OPT_FLAG, TO(force), 0, 0, NULL, 0, "write over a record that exists"},
    {OPT_RESULT, 0, "cut", "FILE.obj", OPT_TEXT, TO(cut), 0, 0, NULL, OPT_OUTPUT | OPT_WRITES,
     "write the polygons where the slice cuts tetrahedra"},
    {OPT_NUMERICS, 0, "method", "spans|paper", OPT_CHOICE, TO(method), 0, 0, "spans|paper", OPT_OUTPUT,
     "fill of rows; paper: Petrinec et al. [default spans]"},
    {OPT_NUMERICS, 0, "regions", "R", OPT_INT, TO(regions), 1, SLICE_SIDE_MOST, NULL, OPT_OUTPUT,
     "lists of tetrahedra [default 32]"},
    {0}};

const opt_tool slice_table = {
    .name = "us-slice",
    .usage = "[options] volume < result > images\n--rigid --poses FILE [options] volume > images",
    .purpose = "Makes ultrasound images of a volume image as the results of a model deform it:\na stream of PGM or "
               "PPM, or files, also PNG.",
    .note = "Lengths are in m, unless they have a suffix (" NUM_UNITS_LIST "), e.g. 5cm.",
    .example = "us-slice --depth 5cm -o image_%04d.png volume.nrrd < out.sinew",
    .operands = "volume",
    .operands_min = 1,
    .operands_max = 1,
    .threaded = true,
    .reads_volumes = true,
    .options = option_list,
};

double slice_options_metres(const opt_lengths *l, double otherwise)
{
    return l->count ? num_length_in(l->value[0], num_unit_of("m"), num_unit_of("m")) : otherwise;
}

slice_options slice_options_default(void)
{
    return (slice_options){.regions = SLICE_REGIONS, .rate = (double)NAN};
}

/* Of an image of tissue; a slip of the units is mostly not. */
static bool is_side(double length)
{
    return length >= .999e-6 && length <= 10;
}

/* What only a live run has, and what it cannot have. */
static int check_live(const slice_options *o, err *e)
{
    if (o->live && o->replay)
        return err_usage(e, "--live with --replay; expected one of them");
    if (!o->live && (o->control || o->record || o->rate == o->rate))
        return err_usage(e, "--control, --record and --rate are for --live; expected --live too");
    if (!o->live && spnav_refuse(o->poses, e))
        return -1;
    if (o->force && !o->record)
        return err_usage(e, "--force without --record, whose file may be written over");
    if (o->replay && (o->poses || o->transform))
        return err_usage(e, "--poses with --replay: poses are those of the record; expected one of them");
    if (o->live && o->transform)
        return err_usage(e, "--transform with --live, which takes poses as lines");
    if (o->live && !o->rigid && ((o->poses && !strcmp(o->poses, "-")) || (o->control && !strcmp(o->control, "-"))))
        return err_usage(e, "standard input holds the model; expected a FIFO for --poses and --control, or --rigid");
    return 0;
}

int slice_options_check(const slice_options *o, err *e)
{
    if (check_live(o, e))
        return -1;
    if (o->rigid && !o->poses && !o->replay)
        return err_usage(e, "--rigid without --poses; expected where the probe is");
    if (o->rigid && o->coupling.count && o->coupling.value[0].value != 0)
        return err_usage(e, "--coupling with --rigid: there is no tissue that the face could touch");
    if (o->rigid && o->cut)
        return err_usage(e, "--cut with --rigid: there are no tetrahedra to cut");
    if (o->body && !o->poses && !o->replay)
        return err_usage(e, "--body without --poses, whose frame it is; poses in frames are in the volume's");
    if (o->marker && o->replay)
        return err_usage(e, "--marker with --replay: the record has the poses as they were used; expected one of them");
    if (o->marker && !o->poses)
        return err_usage(e, "--marker without --poses, which are of the marker; poses in frames are of the face");
    if (o->transform && !o->poses)
        return err_usage(e, "--transform without --poses");
    if (slice_options_values(o, e))
        return -1;
    if (o->window.count && !(o->window.value[0] < o->window.value[1]))
        return err_usage(e, "--window %g,%g; expected LOW below HIGH", o->window.value[0], o->window.value[1]);
    return 0;
}

int slice_options_values(const slice_options *o, err *e)
{
    if (!is_side(slice_options_metres(&o->depth, 1)))
        return err_usage(e, "--depth: %g m; expected 1 um to 10 m", slice_options_metres(&o->depth, 1));
    if (!is_side(slice_options_metres(&o->width, 1)))
        return err_usage(e, "--width: %g m; expected 1 um to 10 m", slice_options_metres(&o->width, 1));
    const double gap = slice_options_metres(&o->coupling, 0);
    if (gap != 0 && !is_side(gap))
        return err_usage(e, "--coupling: %g m; expected 1 um to 10 m, or 0: every beam is coupled", gap);
    for (int i = 0; i < o->range.count; i++)
        if (!(o->range.value[i] >= 1 && o->range.value[i] <= 200))
            return err_usage(e, "--dynamic-range %g; expected 1 to 200 dB", o->range.value[i]);
    for (int i = 0; i < o->tgc.count; i++)
        if (!(o->tgc.value[i] >= -200 && o->tgc.value[i] <= 200))
            return err_usage(e, "--tgc %g; expected -200 to 200 dB", o->tgc.value[i]);
    return 0;
}

int slice_options_thickness(const slice_options *o, double *thickness, int *slices, err *e)
{
    char copy[64];
    num_length length;
    int64_t count = SLICES;
    const char *text = o->thickness;
    *slices = 1;
    if (!text)
        return 0;
    if (strlen(text) >= sizeof copy)
        return err_usage(e, "--thickness %.60s; expected T or T,N, as 3mm,5", text);
    char *comma = strchr(strcpy(copy, text), ',');
    if (comma)
        *comma++ = '\0';
    if (num_length_of(copy, &length) || (comma && num_int(comma, 1, SLICES_MOST, &count)))
        return err_usage(e, "--thickness %.60s; expected T or T,N, as 3mm,5, with N from 1 to %d", text, SLICES_MOST);
    *thickness = num_length_in(length, num_unit_of("m"), num_unit_of("m"));
    *slices = (int)count;
    return *thickness > 0 ? 0 : err_usage(e, "--thickness %.60s; expected more than 0", text);
}
