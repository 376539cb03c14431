#include "model/known.h"

#include "physics/law.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROW(name, type, unit, axis, few, most, flags, rule, low, high, maker, meaning)                                 \
    {name, type, unit, axis, few, most, flags, rule, low, high, maker, meaning},

/* material.KEY. nan: its law or its kind of fibres has no such key, or, of peak, none of its muscles contracts. */
#define KEY_ROW(key, unit, low, high, meaning)                                                                         \
    ROW("material." #key, MODEL_F64, unit, "material", 1, 1, LAW_##key == LAW_density ? 0 : KNOWN_NAN, KNOWN_FROM,     \
        low, high, "voxelise or msds-mesh", meaning)

/* element.KEY. nan: the material's. */
#define ELEMENT_ROW(key, unit, low, high, meaning)                                                                     \
    ROW("element." #key, MODEL_F64, unit, "element", 1, 1, KNOWN_NAN, KNOWN_FROM, low, high,                           \
        "hand or another program", meaning ", in place of its material's")

static const known rows[] = {KNOWN_ARRAYS(ROW, LAW_KEYS(KEY_ROW) LAW_COMMON_KEYS(KEY_ROW) LAW_FIBRE_KEYS(KEY_ROW),
                                          LAW_KEYS(ELEMENT_ROW) LAW_DENSITY_KEY(ELEMENT_ROW))};

enum { ROWS = sizeof rows / sizeof *rows };

/* The length of S in "S/vertex.position": what stands before the last slash. 0: the name is no surface's. */
static size_t surface_length(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash ? (size_t)(slash - name) : 0;
}

bool known_users(const char *name)
{
    return !strncmp(name, "x-", 2);
}

const known *known_find(const char *name)
{
    if (known_users(name))
        return NULL;
    size_t surface = surface_length(name);
    for (int i = 0; i < ROWS; i++) {
        bool any = rows[i].name[0] == '*';
        if (any ? surface && !strcmp(rows[i].name + 1, name + surface) : !strcmp(rows[i].name, name))
            return &rows[i];
    }
    return NULL;
}

const known *known_row(int i)
{
    return i >= 0 && i < ROWS ? &rows[i] : NULL;
}

/* 1e12, as people write it. */
static int put_bound(char *to, size_t size, double bound)
{
    char text[32];
    snprintf(text, sizeof text, "%.6g", bound);
    char *e = strchr(text, 'e');
    if (!e)
        return snprintf(to, size, "%s", text);
    *e = '\0';
    return snprintf(to, size, "%se%d", text, atoi(e + 1));
}

static void put_range(const known *k, char *to, size_t size)
{
    size_t n = (size_t)put_bound(to, size, k->low);
    if (k->high < (double)INT32_MAX || k->type == MODEL_F64) {
        n += (size_t)snprintf(to + n, size - n, " to ");
        n += (size_t)put_bound(to + n, size - n, k->high);
    } else
        n += (size_t)snprintf(to + n, size - n, " or more");
    if (strcmp(k->unit, "1") != 0)
        snprintf(to + n, size - n, " %s", k->unit);
}

void known_words(const known *k, char to[KNOWN_WORDS])
{
    to[0] = '\0';
    switch (k->rule) {
    case KNOWN_ANY:
        break;
    case KNOWN_FINITE:
        snprintf(to, KNOWN_WORDS, "finite numbers");
        break;
    case KNOWN_FROM:
        put_range(k, to, KNOWN_WORDS);
        break;
    case KNOWN_DIRECTION:
        snprintf(to, KNOWN_WORDS, "rows of length 1, to %g, or 0 0 0", KNOWN_LENGTH);
        break;
    case KNOWN_POSE:
        snprintf(to, KNOWN_WORDS, "a place and a quaternion of length 1, to %g", KNOWN_LENGTH);
        break;
    case KNOWN_WEIGHTS:
        snprintf(to, KNOWN_WORDS, "finite numbers; four must add to 1");
        break;
    case KNOWN_STARTS:
        snprintf(to, KNOWN_WORDS, "0 first, then each more than the one before");
        break;
    }
}

void known_expand(const char *pattern, const char *name, char *to, size_t size)
{
    const char *star = strchr(pattern, '*');
    if (!star)
        snprintf(to, size, "%s", pattern);
    else
        snprintf(to, size, "%.*s%.*s%s", (int)(star - pattern), pattern, (int)surface_length(name), name, star + 1);
}
