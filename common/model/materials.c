#include "model/materials.h"

#include "base/chars.h"
#include "base/keyfile.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "model/known.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct key {
    const char *name, *array;
    double fallback, absent;
} key;

#define KEY_ROW(name, fallback, absent) {#name, "material." #name, fallback, absent},
static const key keys[] = {MATERIAL_KEYS(KEY_ROW)};

enum { KEYS = sizeof keys / sizeof *keys };

#define KEY_NAME(name, fallback, absent) #name,
static const char *const key_names[] = {"law", MATERIAL_KEYS(KEY_NAME)};

static const char *const law_names[MATERIAL_LAWS] = {
    [MATERIAL_NEO_HOOKEAN] = "neo-hookean", [MATERIAL_LINEAR] = "linear"};

/* One line of a file, or one row of the table. */
typedef struct row {
    char *name;
    uint64_t given; /* bits of key_names */
    material_law law;
    double value[KEYS];
} row;

#define VALUE_INDEX(name, fallback, absent) AT_##name,
enum { MATERIAL_KEYS(VALUE_INDEX) };

material materials_fallback(void)
{
#define VALUE_FALLBACK(name, fallback, absent) .name = (fallback),
    return (material){.law = MATERIAL_NEO_HOOKEAN, MATERIAL_KEYS(VALUE_FALLBACK)};
}

static row row_of(const material *of)
{
    row r = {.law = of->law};
#define VALUE_PUT(name, fallback, absent) r.value[AT_##name] = of->name;
    MATERIAL_KEYS(VALUE_PUT)
    return r;
}

static int law_of(const char *name)
{
    for (int i = 0; i < MATERIAL_LAWS; i++)
        if (!strcmp(law_names[i], name))
            return i;
    return -1;
}

/* Whether the table of known arrays allows it; words: what it expects. */
static bool valid(const key *k, double value, char words[KNOWN_WORDS])
{
    const known *of = known_find(k->array);
    known_words(of, words);
    return value >= of->low && value <= of->high;
}

/* An unknown name in a file, or, with line 0, in the option `place`. */
static int unknown(err *e, const char *place, int64_t line, const char *what, const char *name,
                   const char *const *names, int count)
{
    return line ? near_unknown(e, place, line, what, name, names, count)
                : near_option(e, place, what, name, names, count);
}

/* name: an index into key_names. place and line: as of unknown. */
static int row_take(row *r, int name, const char *text, const char *place, int64_t line, err *e)
{
    if (name == 0) {
        int law = law_of(text);
        if (law < 0)
            return unknown(e, place, line, "law", text, law_names, MATERIAL_LAWS);
        r->law = (material_law)law;
        return 0;
    }
    const key *k = &keys[name - 1];
    double v;
    char words[KNOWN_WORDS];
    bool good = valid(k, num_double(text, &v) ? NAN : v, words);
    if (!good && line)
        return err_set(e, place, line, "'%s=%.100s' is not allowed; expected %s", k->name, text, words);
    if (!good)
        return err_option(e, place, "'%s=%.100s' is not allowed; expected %s", k->name, text, words);
    r->value[name - 1] = v;
    return 0;
}

static int row_parse(row *r, keyfile *k, err *e)
{
    for (int at = 1; at < k->count; at++) {
        char *text;
        int name = keyfile_pair(k, at, key_names, KEYS + 1, &r->given, &text, e);
        if (name < 0 || row_take(r, name, text, k->name, k->line, e))
            return -1;
    }
    return 0;
}

/* The first word of the line, as a name. */
static int parse_name(const keyfile *k, err *e)
{
    if (strchr(k->word[0], '='))
        return keyfile_error(k, e, "'%.200s' comes first; expected NAME law=neo-hookean E=3000 ...", k->word[0]);
    return 0;
}

/* Writes what of the row is in `given` into the model's table. */
static int row_store(model *m, int64_t at, const row *r, uint64_t given, err *e)
{
    if (given & 1) {
        model_array *law = model_find(m, "material.law");
        if (!law && !(law = model_add(m, "material.law", e)))
            return -1;
        if (model_set_text(law, at, law_names[r->law], e))
            return -1;
    }
    for (int i = 0; i < KEYS; i++) {
        if (!(given >> (i + 1) & 1))
            continue;
        model_array *a = model_need(m, keys[i].array, e);
        if (!a)
            return -1;
        a->f64[at] = r->value[i];
    }
    return 0;
}

static int table_make(model *m, const row *rows, int64_t count, err *e)
{
    if (model_axis_add(m, "material", count, e) || !model_add(m, "material.name", e) ||
        !model_add(m, "material.law", e))
        return -1;
    for (int i = 0; i < KEYS; i++)
        if (!model_add(m, keys[i].array, e))
            return -1;
    for (int64_t i = 0; i < count; i++)
        if (model_set_text(model_find(m, "material.name"), i, rows[i].name, e) ||
            row_store(m, i, &rows[i], ~UINT64_C(0), e))
            return -1;
    return 0;
}

int materials_make(model *m, const material *of, err *e)
{
    char name[] = "tissue";
    row r = row_of(of);
    char words[KNOWN_WORDS];
    for (int i = 0; i < KEYS; i++)
        if (!valid(&keys[i], r.value[i], words))
            return err_set(e, NULL, 0, "%s=%g is not allowed; expected %s", keys[i].name, r.value[i], words);
    r.name = name;
    return table_make(m, &r, 1, e);
}

int materials_default(model *m, err *e)
{
    material of = materials_fallback();
    return materials_make(m, &of, e);
}

int materials_read(model *m, in *s, err *e)
{
    return materials_read_with(m, s, NULL, e);
}

int materials_read_with(model *m, in *s, const material *fallback, err *e)
{
    material usual = materials_fallback();
    keyfile k;
    row *rows = NULL;
    lookup index = {0};
    int32_t count = 0;
    int64_t capacity = 0;
    int more, status = -1;
    keyfile_open(&k, s);
    while ((more = keyfile_next(&k, e)) > 0) {
        if (parse_name(&k, e))
            goto out;
        if (lookup_find(&index, rows, sizeof *rows, k.word[0]) >= 0) {
            keyfile_error(&k, e, "material '%.200s' is given twice; expected each name once", k.word[0]);
            goto out;
        }
        if (mem_grow(&rows, &capacity, (int64_t)count + 1, sizeof *rows, "materials", e))
            goto out;
        row *r = &rows[count];
        *r = row_of(fallback ? fallback : &usual);
        if (!(r->name = mem_text(k.word[0], e)))
            goto out;
        count++;
        if (lookup_add(&index, rows, sizeof *rows, count, e) || row_parse(r, &k, e))
            goto out;
    }
    if (more < 0)
        goto out;
    if (!count)
        err_set(e, in_name(s), 0, "no material in it; expected lines NAME law=neo-hookean E=3000 ...");
    else
        status = table_make(m, rows, count, e);
out:
    for (int32_t i = 0; i < count; i++)
        free(rows[i].name);
    free(rows);
    lookup_free(&index);
    return status;
}

/* One line of an override. index: of names' strings; seen: 1 for the rows that had theirs. */
static int override_line(model *m, keyfile *k, const lookup *index, const model_array *names, uint8_t *seen, err *e)
{
    row r = {0};
    if (parse_name(k, e))
        return -1;
    int32_t at = lookup_find(index, names->str, sizeof *names->str, k->word[0]);
    if (at < 0)
        return materials_unknown(m, k->word[0], k->name, k->line, e);
    if (seen[at]++)
        return keyfile_error(k, e, "material '%.200s' is given twice; expected each name once", k->word[0]);
    return row_parse(&r, k, e) || row_store(m, at, &r, r.given, e) ? -1 : 0;
}

int materials_override(model *m, in *s, err *e)
{
    keyfile k;
    int more = -1;
    lookup index = {0};
    const model_array *names = model_need(m, "material.name", e);
    uint8_t *seen = names ? mem_array(names->rows, 1, "materials", e) : NULL;
    int32_t rows = names ? (int32_t)num_clamp_int(names->rows, 0, INT32_MAX) : 0;
    if (!seen || lookup_add(&index, names->str, sizeof *names->str, rows, e)) {
        free(seen);
        return -1;
    }
    keyfile_open(&k, s);
    while ((more = keyfile_next(&k, e)) > 0)
        if (override_line(m, &k, &index, names, seen, e)) {
            more = -1;
            break;
        }
    lookup_free(&index);
    free(seen);
    return more;
}

/* "NAME.KEY=VALUE" cut in place: NAME is what is left of text. */
static int assignment_cut(char *text, char **name, char **value)
{
    char *equals = strchr(text, '=');
    if (!equals)
        return -1;
    *equals = '\0';
    char *dot = strrchr(text, '.');
    if (!dot || dot == text || !dot[1] || !equals[1])
        return -1;
    *dot = '\0';
    *name = dot + 1;
    *value = equals + 1;
    return 0;
}

static int assign(model *m, const char *which, const char *name, const char *text, err *e)
{
    char place[220];
    int32_t at = materials_find(m, which);
    if (at < 0)
        return materials_unknown(m, which, "-m", 0, e);
    snprintf(place, sizeof place, "-m %.200s", which);
    for (int i = 0; i <= KEYS; i++) {
        row r = {0};
        if (!strcmp(key_names[i], name))
            return row_take(&r, i, text, place, 0, e) ? -1 : row_store(m, at, &r, UINT64_C(1) << i, e);
    }
    return unknown(e, place, 0, "key", name, key_names, KEYS + 1);
}

int materials_set(model *m, const char *assignment, err *e)
{
    if (!model_need(m, "material.name", e))
        return -1;
    char *text = mem_text(assignment, e), *name, *value;
    if (!text)
        return -1;
    int status = -1;
    if (assignment_cut(text, &name, &value))
        err_option(e, "-m", "'%.200s'; expected MATERIAL.KEY=VALUE, such as tissue.E=3000", assignment);
    else
        status = assign(m, text, name, value, e);
    free(text);
    return status;
}

int32_t materials_find(const model *m, const char *name)
{
    const model_array *a = model_find(m, "material.name");
    for (int64_t i = 0; a && i < a->rows; i++)
        if (chars_mean(name, a->str[i]))
            return (int32_t)i;
    return -1;
}

int materials_unknown(const model *m, const char *name, const char *place, int64_t line, err *e)
{
    const model_array *a = model_find(m, "material.name");
    int count = a ? (int)num_clamp_int(a->rows, 0, INT32_MAX) : 0;
    return unknown(e, place, line, "material", name, a ? (const char *const *)a->str : NULL, count);
}

/* The value of key k of material i, or what the table says where there is none. */
static int value_of(const model *m, int64_t i, const key *k, double *value, err *e)
{
    const model_array *a = isnan(k->absent) ? model_need(m, k->array, e) : model_find(m, k->array);
    if (!a && isnan(k->absent))
        return -1;
    char words[KNOWN_WORDS];
    *value = !a || isnan(a->f64[i]) ? k->absent : a->f64[i];
    if (valid(k, *value, words))
        return 0;
    return err_set(e, m->stream, a && m->stream ? model_line(a, i) : 0,
                   "%s, row %" PRId64 ": %g is not allowed; expected %s", k->array, i, *value, words);
}

int materials_of(const model *m, int64_t i, material *to, err *e)
{
    const model_array *law = model_need(m, "material.law", e);
    if (!law)
        return -1;
    int which = law_of(law->str[i]);
    if (which < 0)
        return near_unknown(e, "material.law", 0, "law", law->str[i], law_names, MATERIAL_LAWS);
    to->law = (material_law)which;
#define VALUE_TAKE(name, fallback, absent)                                                                             \
    if (value_of(m, i, &keys[AT_##name], &to->name, e))                                                                \
        return -1;
    MATERIAL_KEYS(VALUE_TAKE)
    if (!isfinite(material_bulk(to)) || !(material_mu(to) > 0))
        return err_set(e, m->stream, 0, "material, row %" PRId64 ": E=%g with nu=%g is beyond what can be computed", i,
                       to->E, to->nu);
    return 0;
}

material material_mixed(const material *a, const material *b, double s)
{
    const double mu = material_between(material_mu(a), material_mu(b), s);
    const double bulk = material_between(material_bulk(a), material_bulk(b), s);
    return (material){.law = a->law,
                      .E = 9 * bulk * mu / (3 * bulk + mu),
                      .nu = (3 * bulk - 2 * mu) / (2 * (3 * bulk + mu)),
                      .density = (1 - s) * a->density + s * b->density,
                      .peak = (1 - s) * a->peak + s * b->peak};
}

material *materials_of_volumes(const model *m, err *e)
{
    const model_array *of = model_need(m, "volume.material", e);
    material *law = of ? mem_array(of->rows, sizeof *law, "materials", e) : NULL;
    for (int64_t v = 0; law && v < of->rows; v++)
        if (materials_of(m, of->i32[v], &law[v], e)) {
            free(law);
            return NULL;
        }
    return law;
}

materials_map materials_map_of(const model *m, const material *of_volume)
{
    const model_array *mix = model_find(m, "element.mix"), *mixture = model_find(m, "element.mixture");
    materials_map map = {.of_volume = of_volume, .volume = model_find(m, "element.volume")->i32};
    if (mix && mixture) {
        map.mix = mix->i32;
        map.mixture = mixture->f32;
    }
    return map;
}

material materials_of_element(const materials_map *map, int64_t element)
{
    const material *own = &map->of_volume[map->volume[element]];
    const int32_t second = map->mix ? map->mix[element] : -1;
    return second < 0 || map->of_volume[second].law != own->law
               ? *own
               : material_mixed(own, &map->of_volume[second], map->mixture[element]);
}
