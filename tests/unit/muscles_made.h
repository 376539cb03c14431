/* Muscles and their fibres, as attach makes them. */
#ifndef SINEW_MUSCLES_MADE_H
#define SINEW_MUSCLES_MADE_H

#include "attach/muscle_fibres.h"

static inline int muscles_made(model *m, const opt_list *asked, pool *threads, muscles *list, notes *warnings, err *e)
{
    return muscle_find(m, asked, list, warnings, e) || muscle_fibres(m, asked, threads, list, warnings, e) ? -1 : 0;
}

#endif
