/* The options of us-slice: their table, and which values and combinations are refused. Owns nothing. */
#ifndef SINEW_SLICE_OPTIONS_H
#define SINEW_SLICE_OPTIONS_H

#include "cli/opt.h"

typedef struct slice_options {
    opt_common common;
    bool rigid, live, force;
    int method;
    const char *poses, *transform, *body, *marker, *size, *probe, *labels, *cut, *thickness, *control, *record, *replay;
    opt_lengths depth, width, coupling;
    opt_numbers tgc, range, window;
    double gain;
    double rate; /* Hz; NAN: not given */
    int64_t regions;
} slice_options;

extern const opt_tool slice_table;

/* The options as they are before a command line is parsed. */
slice_options slice_options_default(void);

/* -1 with e filled (status 2). values: only what a line of a live run may change. */
int slice_options_check(const slice_options *o, err *e);
int slice_options_values(const slice_options *o, err *e);

/* m; `otherwise` where the option was not given. */
double slice_options_metres(const opt_lengths *l, double otherwise);

/* --thickness: m, and how many slices: 1 where it was not given. -1 with e filled. */
int slice_options_thickness(const slice_options *o, double *thickness, int *slices, err *e);

#endif
