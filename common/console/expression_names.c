#include "console/expression_names.h"

#include "base/keyfile.h"
#include "base/mem.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void expression_names_free(expression_names *x)
{
    for (int64_t i = 0; i < x->count; i++)
        free(x->name[i]);
    free(x->name);
    *x = (expression_names){0};
}

/* "NAME:", of which the colon is left out. */
static int add(expression_names *x, const char *word, err *e)
{
    const size_t n = strcspn(word, ":");
    if (MEM_ROOM(&x->name, &x->room, x->count + 1, "expressions", e))
        return -1;
    char *name = mem_array((int64_t)n + 2, 1, "expressions", e);
    if (!name)
        return -1;
    snprintf(name, n + 2, "@%s", word);
    x->name[x->count++] = name;
    return 0;
}

int expression_names_read(expression_names *x, const char *path, err *e)
{
    keyfile k;
    in *source = in_open(path, e);
    if (!source)
        return -1;
    keyfile_open(&k, source);
    int more;
    while ((more = keyfile_next(&k, e)) > 0)
        if (add(x, k.word[0], e)) {
            more = -1;
            break;
        }
    in_close(source);
    return more;
}
