/* The command line of tled-run: its table, and the struct that it is read into. */
#ifndef SINEW_TLED_OPTIONS_H
#define SINEW_TLED_OPTIONS_H

#include "cli/opt.h"
#include "physics/hourglass_numbers.h"

struct options {
    opt_common common;
    int device, precision, coarse;
    double dt, seconds, rest, ramp, damping, every, log_every; /* below 0: not given */
    int64_t steps;                                             /* 0: not given */
    opt_numbers gravity, rise_fall;
    opt_list contract, material, tsv, results, frames;
    unsigned which; /* of results, once read */
    const char *script, *materials, *probe, *poses, *unit, *log, *hourglass;
    const char *activations, *expressions;
    int between; /* rows of activations: 0: linear, 1: smooth; below 0: not given */
    double repulsion;
    double friction;
    const char *checkpoint, *restart;
    double checkpoint_every;
    bool live, force;
    double rate; /* below 0: not given */
    const char *lines, *record, *replay, *body, *marker, *rigid_poses;
    const char *batch;
    hourglass_control control; /* what hourglass says, once checked */
};

extern const opt_tool options_table;
extern const struct options options_defaults;

#endif
