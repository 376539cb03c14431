/* The command line of msds-run: its table, and the struct that it is read into. */
#ifndef SINEW_MSDS_RUN_OPTIONS_H
#define SINEW_MSDS_RUN_OPTIONS_H

#include "cli/opt.h"

struct options {
    opt_common common;
    int device, method, mass, contact;
    bool exact, warp, residual, compare, live, force;
    const char *body, *marker, *control, *record, *replay, *haptics, *batch;
    const char *probe, *unit, *poses, *transform, *scale;
    int64_t iterations;
    double dt, damping, repulsion, friction, rate, skin_stiffness, skin_anchors, skin_tension;
    const char *skin, *cavity, *outflow, *wall;
    opt_numbers gravity;
    opt_list frames;
};

extern const opt_tool run_options_table;
extern const struct options run_options_defaults;

#endif
