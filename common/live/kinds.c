#include "live/kinds.h"

void kinds_add(kinds *k, const err *e, const char *what)
{
    for (int i = 0; i < k->count; i++)
        if (k->form[i] == e->form)
            return;
    if (k->count == KINDS_MOST)
        return;
    k->form[k->count++] = e->form;
    notes_add(&k->told, "%s; the %s is skipped, and others like it are", e->text, what);
}

void kinds_take(kinds *k, notes *warnings)
{
    for (int i = 0; i < k->told.count; i++)
        notes_add(warnings, "%s", k->told.line[i]);
    notes_free(&k->told);
}
