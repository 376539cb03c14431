/* The one table of rules that give muscles their fibres: --fibre, the report, what is stored in muscle.fibre and
 * attach(1) have the names from here. Without --fibre a muscle has the first rule, in the order of the rows, that
 * applies to it.
 */
#ifndef SINEW_FIBRE_RULE_H
#define SINEW_FIBRE_RULE_H

#include "attach/shape/ring.h"
#include "cli/opt.h"
#include "fibre_field.h"
#include "muscle.h"
#include "muscle_shape.h"

#include <pthread.h>

/* The voxels of all muscles. Marks on their nodes, which are here and in body.part, are one muscle's at a time: the
 * lock's. */
typedef struct fibre_voxels {
    pthread_mutex_t lock;
    field *of; /* made when a rule first needs it; the creator of this frees it */
} fibre_voxels;

/* What a rule knows of a muscle. */
typedef struct fibre_case {
    const model *m;
    const body *b;
    const muscle *of;
    int32_t index;       /* of the muscle */
    muscle_shape *shape; /* NULL: the model has no closed surface of it */
    const ring *ring;    /* NULL: it is none */
    fibre_voxels *voxels;
    pool *threads; /* NULL: this thread alone, as other threads have other muscles */
    bool is_left;  /* it is more than one thread is for: nothing was filled, and all of them are to do it */
} fibre_case;

typedef struct fibre_rule {
    const char *name;
    const char *what; /* one line, for the manual */
    bool (*applies)(const fibre_case *c);
    /* Fills the fibres of the muscle's elements; those that stay 0 0 0 get its axis. NULL: muscle_fibres.c sets them
     * one by one. -1 with e filled. */
    int (*fill)(fibre_case *c, err *e);
} fibre_rule;

extern const fibre_rule fibre_rules[MUSCLE_RULES];

/* The first row that applies. Some row always does. */
muscle_fibre fibre_rule_for(const fibre_case *c);

/* Sets `asked` of each muscle from the values of --fibre, the last that names it: RULE for all, or MUSCLE,...=RULE, a
 * muscle's name in any case, with or without muscle_ at its start, a '*' at its end for any rest. -1 with e filled
 * where a value names no rule or no muscle. */
int fibre_rules_asked(muscles *list, const opt_list *values, err *e);

/* Whether the values name rules, whatever muscles there are. -1 with e filled. */
int fibre_rules_check(const opt_list *values, err *e);

/* Whether all muscles were asked for by one value without names, as every version of attach can have made them. */
bool fibre_rules_single(const opt_list *values);

#endif
