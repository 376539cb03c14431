#include "inspect/info_names.h"

#include "base/chars.h"
#include "base/mem.h"
#include "physics/law.h"

#include <stdlib.h>
#include <string.h>

static int put_text(const char *text, out *to, err *e)
{
    const size_t n = strlen(text);
    char *shown = mem_array(4 * (int64_t)n + 1, 1, "a name", e);
    if (!shown)
        return -1;
    chars_show(text, n, shown);
    out_text(to, shown);
    free(shown);
    return 0;
}

static int put_name(const char *name, out *to, err *e)
{
    if (put_text(name, to, e))
        return -1;
    out_text(to, "\n");
    return 0;
}

/* A row a line, columns between tabs. */
static int put_strings(const model_array *a, out *to, err *e)
{
    const int64_t values = a->rows * a->columns;
    for (int64_t i = 0; i < values; i++) {
        if (put_text(a->str[i], to, e))
            return -1;
        out_text(to, (i + 1) % a->columns ? "\t" : "\n");
    }
    return 0;
}

static int put_muscles(const model *m, out *to, err *e)
{
    const model_array *volume = model_find(m, "muscle.volume"), *name = model_find(m, "volume.name");
    if (!volume || !name || !volume->data)
        return 1;
    for (int64_t i = 0; i < volume->rows; i++)
        if (put_name(name->str[volume->i32[i]], to, e))
            return -1;
    return 0;
}

static int put_key_of(const char *name, const char *key, out *to, err *e)
{
    if (put_text(name, to, e))
        return -1;
    out_format(to, ".%s\n", key);
    return 0;
}

/* NAME.KEY, as -m of tled-run takes it: the law, its keys, those that every material has, and those of fibres. */
static int put_keys_of(const char *name, const char *law, out *to, err *e)
{
    const law_row *of = law_find(law);
    if (put_key_of(name, "law", to, e))
        return -1;
    for (int k = 0; k < LAW_ALL_KEYS; k++) {
        if (k < LAW_OWN_KEYS && !(of && law_keys(of) >> k & 1))
            continue;
        if (k == LAW_FIBRE_KEYS_FIRST && put_key_of(name, "fibre", to, e))
            return -1;
        if (put_key_of(name, law_key_name((law_key)k), to, e))
            return -1;
    }
    return 0;
}

static int put_keys(const model *m, out *to, err *e)
{
    const model_array *name = model_find(m, "material.name"), *law = model_find(m, "material.law");
    if (!name || !law)
        return 1;
    for (int64_t i = 0; i < name->rows; i++)
        if (put_keys_of(name->str[i], law->str[i], to, e))
            return -1;
    return 0;
}

static int put_surfaces(const model *m, out *to, err *e)
{
    char name[MODEL_NAME];
    for (int at = 0; model_surface(m, &at, name, sizeof name);)
        if (put_name(name, to, e))
            return -1;
    return 0;
}

/* Those of the body, then those of frames. */
static int put_arrays(const source *s, out *to, err *e)
{
    const model_arrays *const lists[] = {&s->body.arrays, s->frames ? &s->frame.arrays : NULL};
    for (int l = 0; l < 2 && lists[l]; l++)
        for (int i = 0; i < lists[l]->count; i++)
            if (put_name(lists[l]->v[i].name, to, e))
                return -1;
    return 0;
}

/* Whether the words of a row, which are names between spaces, have this one. */
static bool has_word(const char *row, const char *word, size_t n)
{
    for (const char *p = row; *p; p += strcspn(p, " "), p += strspn(p, " "))
        if (strcspn(p, " ") == n && !strncmp(p, word, n))
            return true;
    return false;
}

static int put_word(const char *word, size_t n, out *to, err *e)
{
    char *name = mem_array((int64_t)n + 1, 1, "a name", e);
    if (!name)
        return -1;
    memcpy(name, word, n);
    const int status = put_name(name, to, e);
    free(name);
    return status;
}

/* The groups of a surface, in their order, each once. */
static int put_groups_of(const model_array *a, out *to, err *e)
{
    for (int64_t i = 0; i < a->rows; i++)
        for (const char *p = a->str[i]; *p; p += strcspn(p, " "), p += strspn(p, " ")) {
            const size_t n = strcspn(p, " ");
            bool before = false;
            for (int64_t k = 0; k < i && !before; k++)
                before = has_word(a->str[k], p, n);
            if (n && !before && put_word(p, n, to, e))
                return -1;
        }
    return 0;
}

static int put_groups(const model *m, out *to, err *e)
{
    static const char ending[] = "/group.name";
    for (int i = 0; i < m->arrays.count; i++) {
        const model_array *a = &m->arrays.v[i];
        const size_t n = strlen(a->name);
        if (a->type == MODEL_STR && n > strlen(ending) && !strcmp(a->name + n - strlen(ending), ending) &&
            put_groups_of(a, to, e))
            return -1;
    }
    return 0;
}

int info_names(const source *s, const char *key, out *to, err *e)
{
    const model_array *a = source_find(s, key);
    if (a)
        return a->type == MODEL_STR ? put_strings(a, to, e) : 1;
    if (!strcmp(key, INFO_NAMES_MUSCLES))
        return put_muscles(&s->body, to, e);
    if (!strcmp(key, INFO_NAMES_KEYS))
        return put_keys(&s->body, to, e);
    if (!strcmp(key, "surface.name"))
        return put_surfaces(&s->body, to, e);
    if (!strcmp(key, "group.name"))
        return put_groups(&s->body, to, e);
    if (!strcmp(key, "array.name"))
        return put_arrays(s, to, e);
    return 1;
}
