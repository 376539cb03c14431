/* What happens in a run of tled-run, and when: the script file, a track, -c and -g, all as curves. A curve is one verb
 * on one target, its keys a piecewise-linear function of the model's time; all lie in flat arrays that are ready to be
 * copied to a device, and evaluating them allocates nothing. The caller owns a script, zeroed to begin with.
 *
 * The value of a curve before its first key is 0; between keys it is linear, or, of a track, smooth; from the last key
 * on it holds. Two keys at one time make a jump, and at that time the later one counts. Times are the model's: a run
 * that goes on from a frame at 1 s begins at 1 s here too.
 */
#ifndef SINEW_SCRIPT_H
#define SINEW_SCRIPT_H

#include "base/keyfile.h"
#include "base/pose.h"
#include "model/model.h"
#include "tled/muscle/activation.h"
#include "tled/muscle/expressions.h"

typedef enum script_verb {
    SCRIPT_CONTRACT, /* value[0]: the level, 0 to 1, of muscle `volume` */
    SCRIPT_GRAVITY,  /* value: m/s2, on every node by its mass; at most one curve */
    SCRIPT_FORCE,    /* value: N in all, an equal share for each of its nodes */
    SCRIPT_DISPLACE, /* value: m from rest, for the components in `mask`, of each of its nodes */
    SCRIPT_PRESSURE, /* value[0]: Pa, against the outward normals of its triangles as they are deformed */
    SCRIPT_TRACTION, /* value: Pa, by the area of its triangles at rest */
    SCRIPT_PULL,     /* value: m, s (T - X): a spring from its nodes, in all at X, to T; s: the value of: */
    SCRIPT_SPRING,   /* value: s thrice, 1 while the pull that is the curve before it pulls, else 0 */
    SCRIPT_MOVE,   /* value: m, b of u = b + A X, what each of its nodes is displaced by; and the three curves after: */
    SCRIPT_TURN,   /* value: a column of A */
    SCRIPT_EXPRESS /* value[0]: the level, 0 to 1, of expression `volume`; its muscles get shares of it: script_term */
} script_verb;

/* Where a curve comes from. */
typedef enum script_origin { SCRIPT_OF_OPTION, SCRIPT_OF_FILE, SCRIPT_OF_TRACK } script_origin;

typedef struct script_curve {
    script_verb verb;
    int32_t volume; /* contract: index of the volume; express: of the expression; else -1 */
    uint32_t mask;  /* displace, move: bit a set: component a is prescribed, from the start of the run on */
    int32_t key_first, key_count;   /* in script.time and script.value; at least 1 key, but for a muscle that only
                                     * expressions contract; times never decreasing */
    int32_t node_first, node_count; /* in script.node, ascending: force, displace, pull, move */
    int32_t triangle_first, triangle_count; /* in script.corner: pressure, traction */
    double end;                             /* time of its last key, s */
    int64_t line;                           /* its first line in the script; 0: from the command line */
    double box[6];                          /* force, pull: x y z radius; by a box: low and high corner; m */
    double stiffness;                       /* pull: N/m */
    bool is_released;                       /* pull: since its last key */
    bool is_live;                           /* of a line that came live */
    int32_t own;    /* live: its two keys in `time` and `value`, the first of them + 1; 0: it has none yet */
    char *target;   /* as written, owned: for messages and to tell surfaces apart */
    char *surface;  /* pressure, traction: the bound surface's name in the model, owned; else NULL */
    bool is_region; /* of the surface: not the whole of it */
    script_origin from;
    bool is_smooth;    /* between its keys, whose times rise: a monotone cubic */
    int64_t term;      /* contract: the index of its first term, + 1; 0: none */
    activation active; /* contract: what follows its level, where that takes time (script.times); owned */
} script_curve;

/* A muscle's level is the sum of its own curve and of these, at most 1. */
typedef struct script_term {
    int64_t contract, express; /* curves */
    double factor;             /* 0 to 1 */
    int64_t next;              /* of the same muscle, the index + 1; 0: none */
} script_term;

typedef struct script {
    script_curve *curve;
    double *time;    /* keys: s */
    double *value;   /* keys x 3 */
    int32_t *node;   /* a component of a node is displaced by one curve at most */
    int32_t *corner; /* triangles x 3: vertices of the curve's surface, counter-clockwise from outside */
    double *part;    /* triangles: .5 for those of a convex quadrilateral, which is cut both ways; else 1 */
    char *file;      /* the name of the file read, owned; NULL: none was */
    char *track;     /* the same of the track */
    script_term *term;
    const expressions *expressions; /* that lines and options may use, borrowed; NULL: none */
    activation_times times;         /* rise 0: the activation of a muscle is its level, at once */
    const char *unit;               /* of the OBJ files of its regions, borrowed; NULL: the model's source.unit */
    int64_t curves, keys, nodes, triangles, terms;
    int64_t curve_capacity, time_capacity, value_capacity, node_capacity, corner_capacity, part_capacity;
    int64_t term_capacity;
} script;

void script_free(script *s);

/* Adds a script file; m: the rest model. -1 with e filled at the first thing that is wrong: file:line. The same target
 * in the file and on the command line is an error, whichever comes first. */
int script_read(script *s, in *source, const model *m, err *e);

/* Adds -c: "MUSCLE=LEVEL,...", from 0 at time 0 up to LEVEL at `ramp` s (0: at once). MUSCLE may end in '*' for any
 * rest, or be @EXPRESSION. What is wrong with it is an error of the command line, as with -g. */
int script_add_contract(script *s, const model *m, const char *list, double ramp, err *e);

/* Adds a track: a header, "time" and targets as those of -c, and rows of times that rise and levels, between tabs; or a
 * log of tled-run with columns of levels. smooth: a monotone cubic between rows. -1 with e filled: file:line. */
int script_read_track(script *s, in *source, const model *m, bool smooth, err *e);

/* Adds -g: from 0 at time 0 up to g (3, m/s2) at `ramp` s (0: at once). */
int script_add_gravity(script *s, const double *g, double ramp, err *e);

/* Of the whole script: refuses a muscle that the script, a track and -c drive by two of them, warns where levels of one
 * add up to more than 1, and finds the activations, for which s->times is set. -1 with e filled. */
int script_check_levels(script *s, const model *m, notes *warnings, err *e);

/* Whether the levels of a muscle add up to more than 1 at a time (s): of the first such, its volume, and how much; or
 * -1. */
int32_t script_over(const script *s, double time, double *sum);

/* The level of a muscle's curve at a time, which its activation follows. */
double script_level_at(const script *s, int64_t curve, double time);

/* Of the whole script: whether its muscles can contract. A muscle does that has an element with a fibre and a node that
 * is not rigid; one whose level stays 0 need not. Warns of those that cannot, by the script's line or as of -c; where
 * none can, -1 with e filled: nothing would come of any. */
int script_check_muscles(const script *s, const model *m, notes *warnings, err *e);

/* Live: from when a line holds, and until when what it displaces, and a target that pulls, go there in a straight line;
 * where the tissue is now. */
typedef struct script_now {
    double from, until;         /* s */
    const double *displacement; /* nodes x 3, m; NULL: at rest */
} script_now;

/* Whether a line is one of scripts that come live: now VERB ..., pull ..., release ID. */
bool script_is_now(const keyfile *k);

/* Takes such a line: its value holds from now on, whatever the script said of the target from now on. *anew: set where
 * curves came or went (tled_problem_reload); those that live lines made and that do nothing any more go then. -1 with e
 * filled: the script is as it was. */
int script_take_now(script *s, const model *m, const keyfile *k, const script_now *now, bool *anew, err *e);

/* Adds curves of value 0 for gravity, and each muscle that can contract, where the script has none: lines that come
 * live then change values alone. -1 with e filled. */
int script_add_idle(script *s, const model *m, err *e);

/* Ends all pulls now, and stops what live lines displace where they have it now. Returns how many pulls there were. */
int64_t script_release_all(script *s, const script_now *now);

/* Sets to 0 all that live lines have set, and activations, which then follow their levels from there. */
void script_forget_all(script *s, const script_now *now);

/* The curve at a time: 3 values (contract: the first counts). Not of a move, nor of its turn. */
void script_value(const script *s, const script_curve *c, double time, double *value);

/* All curves at a time, 3 values a curve. */
void script_values(const script *s, double time, double *value);

/* Adds moves of bodies from a file of lines BODY time tx ty tz qx qy qz qw, poses in the frame in which the model lies
 * at `place`. -1 with e filled. */
int script_read_poses(script *s, in *source, const model *m, const pose *place, err *e);

/* The time of the last key of all, and of the last activation (s): from there on nothing changes. 0 where there are no
 * curves. */
double script_end(const script *s);

/* What script.c and the other files of scripts share. */

/* The curve of the same verb and target, or -1. */
int64_t script_find(const script *s, const script_curve *like);

/* Where a curve comes from, by name: "-c", or a file's. */
const char *script_place(const script *s, const script_curve *c);

/* Appends a copy of c, which has no keys, nodes or triangles, with its own copies of the texts. Returns its index or
 * -1. */
int64_t script_add(script *s, const script_curve *c, err *e);

/* Makes room for `more` keys. */
int script_reserve(script *s, int64_t more, err *e);

/* The region of a surface in SURFACE[:REGION], or NULL: surface_region.h says of what kind it is. */
const char *script_region(const script_curve *c);

/* The bound surface that c->target names, SURFACE[:REGION], into `name` (MODEL_NAME bytes). Sets c->surface to it. */
int script_take_surface(script_curve *c, const model *m, const keyfile *k, char *name, err *e);

/* Appends to s->corner the triangles of the curve added last: of the region, whose OBJ file is read, or, which must be
 * closed for a pressure, the whole. */
int script_take_triangles(script *s, const model *m, const keyfile *k, err *e);

/* Appends nodes to s->node as those of the curve added last: those in a ball; in a box; that a rigid surface holds, as
 * c says. near (m): how far past its sides a node may be along each axis (script_near). -1 with e filled: there are
 * none. */
int script_nodes_in_ball(script *s, const model *m, const keyfile *k, const double near[3], const script_curve *c,
                         err *e);
int script_nodes_in_box(script *s, const model *m, const keyfile *k, const double near[3], const script_curve *c,
                        err *e);
int script_nodes_of_surface(script *s, const model *m, const keyfile *k, const script_curve *c, err *e);
int script_nodes_of_body(script *s, const model *m, const keyfile *k, int32_t body, err *e);
void script_near(const model *m, double near[3]);

/* Of a curve, from now on: from `was` to `value` (3), in the time that `now` says. -1 with e filled. */
int script_hold(script *s, int64_t curve, const script_now *now, const double *was, const double *value, err *e);

/* How many of its keys are not after a time. */
int32_t script_keys(const script *s, const script_curve *c, double time);

/* A move at a time: the 12 values of its four curves. */
void script_move_values(const script *s, const script_curve *c, double time, double *value);

/* Of a move, from now on: where it is now, or where it was at rest, still. */
void script_move_stop(script *s, int64_t curve, const script_now *now, bool at_rest);

/* Takes a curve out, whose keys are its own or none. */
void script_drop(script *s, int64_t curve);

/* Gives a curve that has no keys its first: 0 at time 0, and the value (3) at `ramp` s (0: only that, at 0). */
int script_ramp(script *s, int64_t curve, double ramp, const double *value, err *e);

/* A smooth curve at a time between keys low - 1 and low. */
double script_smooth(const script *s, const script_curve *c, int32_t low, double time);

/* Adds to a span that begins at span->from, and has no key of the curve in it, what the curve adds to a level there. */
void script_add_span(const script *s, const script_curve *c, double factor, activation_span *span);

/* Adds a curve of a muscle, or of an expression, where there is none; an expression's gets its muscles: all, or those
 * that have curves. Returns its index, or -1. */
int64_t script_add_levels(script *s, const model *m, const script_curve *c, bool all, err *e);

/* Puts the activations of muscles in place of their curves' values; or adds what expressions add to these. */
void script_muscle_values(const script *s, double time, double *value);

/* Finds the activation of a muscle's curve; from: anew from a time on (s), where it goes on from its value; -INFINITY:
 * from the first key on. */
int script_follow(script *s, int64_t curve, double from, err *e);

#endif
