/* What happens in a run of tled-run, and when: the script file, -c and -g, all as curves. A curve is one verb on one
 * target, its keys a piecewise-linear function of the model's time; all lie in flat arrays that are ready to be
 * copied to a device, and evaluating them allocates nothing. The caller owns a script, zeroed to begin with.
 *
 * The value of a curve before its first key is 0; between keys it is linear; from the last key on it holds. Two keys
 * at one time make a jump, and at that time the later one counts. Times are the model's: a run that goes on from a
 * frame at 1 s begins at 1 s here too.
 */
#ifndef SINEW_SCRIPT_H
#define SINEW_SCRIPT_H

#include "base/in.h"
#include "model/model.h"

typedef enum script_verb {
    SCRIPT_CONTRACT, /* value[0]: the level, 0 to 1, of muscle `volume` */
    SCRIPT_GRAVITY,  /* value: m/s2, on every node by its mass; at most one curve */
    SCRIPT_FORCE,    /* value: N in all, an equal share for each of its nodes */
    SCRIPT_DISPLACE  /* value: m from rest, for the components in `mask`, of each of its nodes */
} script_verb;

typedef struct script_curve {
    script_verb verb;
    int32_t volume;                 /* contract: index of the volume; else -1 */
    uint32_t mask;                  /* displace: bit a set: component a is prescribed, from the start of the run on */
    int32_t key_first, key_count;   /* in script.time and script.value; at least 1 key, times never decreasing */
    int32_t node_first, node_count; /* in script.node, ascending; 0 for contract and gravity */
    double end;                     /* time of its last key, s */
    int64_t line;                   /* its first line in the script; 0: from the command line */
    double box[6];                  /* force: x y z radius; displace by box: low and high corner; m */
    char *target;                   /* as written, owned: for messages and to tell surfaces apart */
} script_curve;

typedef struct script {
    script_curve *curve;
    double *time;  /* keys: s */
    double *value; /* keys x 3 */
    int32_t *node; /* a component of a node is displaced by one curve at most */
    char *file;    /* the name of the file read, owned; NULL: none was */
    int64_t curves, keys, nodes;
    int64_t curve_capacity, time_capacity, value_capacity, node_capacity;
} script;

void script_free(script *s);

/* Adds a script file; m: the rest model. -1 with e filled at the first thing that is wrong: file:line. The same target
 * in the file and on the command line is an error, whichever comes first. */
int script_read(script *s, in *source, const model *m, err *e);

/* Adds -c: "MUSCLE=LEVEL,...", from 0 at time 0 up to LEVEL at `ramp` s (0: at once). What is wrong with it is an error
 * of the command line, as with -g. */
int script_add_contract(script *s, const model *m, const char *list, double ramp, err *e);

/* Adds -g: from 0 at time 0 up to g (3, m/s2) at `ramp` s (0: at once). */
int script_add_gravity(script *s, const double *g, double ramp, err *e);

/* Of the whole script: whether its muscles can contract. A muscle does that has an element with a fibre and a node that
 * is not rigid; one whose level stays 0 need not. Warns of those that cannot, by the script's line or as of -c; where
 * none can, -1 with e filled: nothing would come of any. */
int script_check_muscles(const script *s, const model *m, notes *warnings, err *e);

/* The curve at a time: 3 values (contract: the first counts). */
void script_value(const script *s, const script_curve *c, double time, double *value);

/* The time of the last key of all (s): from there on nothing changes. 0 where there are no curves. */
double script_end(const script *s);

/* The volume of the muscle so named, the prefix muscle_ given or not: its index, or -1 with e filled at place:line.
 * line 0: place is an option of the command line. */
int32_t script_muscle(const model *m, const char *name, const char *place, int64_t line, err *e);

/* What script.c and script_read.c share. */

/* The curve of the same verb and target, or -1. */
int64_t script_find(const script *s, const script_curve *like);

/* Appends a copy of c, which has no keys or nodes, with its own copy of the target. Returns its index or -1. */
int64_t script_add(script *s, const script_curve *c, err *e);

/* Makes room for `more` keys. */
int script_reserve(script *s, int64_t more, err *e);

/* A level: a number from 0 to 1. Returns 0 or -1. */
int script_level(const char *text, double *level);

#endif
