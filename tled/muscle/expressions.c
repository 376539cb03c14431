#include "tled/muscle/expressions.h"

#include "base/keyfile.h"
#include "base/mem.h"
#include "base/near.h"
#include "tled/muscle/muscles.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

void expressions_free(expressions *x)
{
    for (int32_t i = 0; i < x->count; i++)
        free(x->list[i].name);
    free(x->list);
    free(x->part);
    lookup_free(&x->index);
    *x = (expressions){0};
}

static int32_t find(const expressions *x, const char *name)
{
    return x ? lookup_find(&x->index, x->list, sizeof *x->list, name) : -1;
}

static int unknown(const expressions *x, const char *name, const char *place, int64_t line, err *e)
{
    const char **list = mem_array(x->count, sizeof *list, "names", e);
    if (!list)
        return -1;
    for (int32_t i = 0; i < x->count; i++)
        list[i] = x->list[i].name;
    if (line)
        near_unknown(e, place, line, "expression", name, list, x->count);
    else
        near_option(e, place, "expression", name, list, x->count);
    free(list);
    return -1;
}

int32_t expressions_find(const expressions *x, const char *name, const char *place, int64_t line, err *e)
{
    static const char why[] = "expression '@%.200s', but no file of expressions was given; expected --expressions FILE";
    const int32_t at = find(x, name);
    if (at >= 0)
        return at;
    if (x)
        return unknown(x, name, place, line, e);
    return line ? err_set(e, place, line, why, name) : err_option(e, place, why, name);
}

/* ---- Reading */

typedef struct reader {
    expressions *x;
    const model *m;
    keyfile k;
    muscle_list named; /* by a word */
} reader;

/* Keeps the parts of the last expression in the order of volumes. */
static int add_part(reader *r, int32_t volume, double level, err *e)
{
    expressions *x = r->x;
    expression *of = &x->list[x->count - 1];
    if (MEM_ROOM(&x->part, &x->part_room, x->parts + 1, "expressions", e))
        return -1;
    int64_t at = x->parts;
    for (; at > of->first && x->part[at - 1].volume >= volume; at--)
        if (x->part[at - 1].volume == volume)
            return keyfile_error(&r->k, e, "muscle '%.200s' is named twice in '%.200s'; expected once",
                                 model_find(r->m, "volume.name")->str[volume], of->name);
    memmove(x->part + at + 1, x->part + at, (size_t)(x->parts - at) * sizeof *x->part);
    x->part[at] = (expression_part){volume, level};
    x->parts++;
    of->count++;
    return 0;
}

/* "MUSCLE=LEVEL", cut in place. */
static int take_word(reader *r, char *word, err *e)
{
    double level;
    char *equals = strrchr(word, '=');
    if (!equals || equals == word)
        return keyfile_error(&r->k, e, "'%.200s'; expected MUSCLE=LEVEL, such as zyg_*=.8", word);
    *equals = '\0';
    if (muscles_level(equals + 1, &level))
        return keyfile_error(&r->k, e, "level '%.200s' of %.200s; expected a number from 0 to 1", equals + 1, word);
    if (muscles_named(&r->named, r->m, word, r->k.name, r->k.line, e))
        return -1;
    for (int32_t i = 0; i < r->named.count; i++)
        if (add_part(r, r->named.volume[i], level, e))
            return -1;
    return 0;
}

/* The name, whose colon is cut off. */
static int take_name(reader *r, err *e)
{
    expressions *x = r->x;
    char *name = r->k.word[0], *colon = name + strlen(name) - 1;
    if (*colon != ':' || colon == name)
        return keyfile_error(&r->k, e, "'%.200s'; expected NAME: MUSCLE=LEVEL ..., such as smile: zyg_*=.8", name);
    *colon = '\0';
    if (strpbrk(name, "@=,*:"))
        return keyfile_error(&r->k, e, "name '%.200s'; expected one without '@', '=', ',', '*' and ':'", name);
    const int32_t other = find(x, name);
    if (other >= 0)
        return keyfile_error(&r->k, e, "'%.200s' is an expression of line %" PRId64 " already; expected another name",
                             name, x->list[other].line);
    if (x->count == INT32_MAX || MEM_ROOM(&x->list, &x->room, (int64_t)x->count + 1, "expressions", e))
        return -1;
    x->list[x->count] = (expression){mem_text(name, e), r->k.line, x->parts, 0};
    if (!x->list[x->count].name)
        return -1;
    x->count++;
    return lookup_add(&x->index, x->list, sizeof *x->list, x->count, e);
}

static int take_line(reader *r, err *e)
{
    if (take_name(r, e))
        return -1;
    if (r->k.count == 1)
        return keyfile_error(&r->k, e, "'%.200s' names no muscle; expected MUSCLE=LEVEL after it", r->k.word[0]);
    for (int i = 1; i < r->k.count; i++)
        if (take_word(r, r->k.word[i], e))
            return -1;
    return 0;
}

int expressions_read(expressions *x, in *source, const model *m, err *e)
{
    reader r = {.x = x, .m = m};
    int more;
    keyfile_open(&r.k, source);
    while ((more = keyfile_next(&r.k, e)) > 0)
        if (take_line(&r, e)) {
            more = -1;
            break;
        }
    muscles_free(&r.named);
    if (!more && !x->count)
        return err_set(e, in_name(source), 0, "nothing in it; expected lines NAME: MUSCLE=LEVEL ...");
    return more;
}
