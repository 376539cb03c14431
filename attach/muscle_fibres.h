/* The fibres of muscles, by the rule that each has (fibre_rule.h), and what of a muscle will not contract. Keeps
 * nothing. */
#ifndef SINEW_MUSCLE_FIBRES_H
#define SINEW_MUSCLE_FIBRES_H

#include "base/pool.h"
#include "muscle.h"

/* Fills element.fibre (and element.mixfibre) of what muscle_find has found, with the muscles' surfaces; an element that
 * lies at the contraction centre gets the axis. Adds muscle.fibre, which says the rule that each has, unless `asked`,
 * the values of --fibre, gives one to all. Notes the muscles that can have no centre or no fibres. threads: NULL for
 * the caller alone. -1 with e filled. */
int muscle_fibres(model *m, const opt_list *asked, pool *threads, muscles *list, notes *warnings, err *e);

#endif
