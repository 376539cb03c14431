#include "model/materials.h"

#include "base/chars.h"
#include "base/keyfile.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "model/known.h"
#include "model/material_edit.h"
#include "model/material_elements.h"
#include "model/material_families.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One row of a file. */
typedef struct row {
    char *name;
    material of;
} row;

material materials_fallback(void)
{
    material of = {.law = law_at(0), .density = 1000, .peak = 30000};
    material_edit_clear(&of);
    of.value[LAW_E] = 3000;
    of.value[LAW_nu] = .49;
    for (int k = 0; k < LAW_FIBRE_KEYS_COUNT; k++)
        of.families[k] = NAN;
    return of;
}

static int row_parse(material_edit *r, keyfile *k, err *e)
{
    for (int at = 1; at < k->count; at++) {
        char *text;
        int name = keyfile_pair(k, at, material_edit_names, MATERIAL_EDIT_NAMES, &r->given, &text, e);
        if (name < 0 || material_edit_take(r, name, text, k->name, k->line, e))
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

/* ---- the table in a model */

/* The array of a key, made where there is none and materials may lack it. */
static model_array *key_array(model *m, int key, err *e)
{
    const char *name = material_edit_arrays[key];
    if (!material_edit_optional(key))
        return model_need(m, name, e);
    model_array *a = model_find(m, name);
    if (a)
        return a;
    a = model_add(m, name, e);
    for (int64_t i = 0; a && i < a->rows; i++)
        a->f64[i] = NAN;
    return a;
}

/* Writes row `at`: its law, its kind of fibres and the values of their keys, and of the others those in `given`. */
static int row_store(model *m, int64_t at, material of, uint64_t given, err *e)
{
    model_array *law = model_find(m, "material.law");
    if (!law && !(law = model_add(m, "material.law", e)))
        return -1;
    if ((given & 1 && model_set_text(law, at, of.law->name, e)) || material_families_store(m, at, &of, e))
        return -1;
    for (int k = 0; k < LAW_ALL_KEYS; k++) {
        const double value = material_edit_stored(&of, k);
        const bool none = isnan(value) && !model_find(m, material_edit_arrays[k]);
        if (material_edit_optional(k) ? none : !(given >> (k + 1) & 1))
            continue;
        model_array *a = key_array(m, k, e);
        if (!a)
            return -1;
        a->f64[at] = value;
    }
    return 0;
}

/* Removes the arrays of keys that no material has any more, and that of kinds of fibres if all are none. */
static void drop_unused(model *m)
{
    material_families_drop(m);
    for (int k = 0; k < LAW_ALL_KEYS; k++) {
        const model_array *a = material_edit_optional(k) ? model_find(m, material_edit_arrays[k]) : NULL;
        bool used = !a;
        for (int64_t i = 0; !used && i < a->rows; i++)
            used = !isnan(a->f64[i]);
        if (!used)
            model_remove(m, material_edit_arrays[k]);
    }
}

/* Bits of the optional keys that are given. */
static uint64_t optional_keys(const material *of)
{
    uint64_t keys = 0;
    for (int k = LAW_OPTIONAL; k < LAW_ALL_KEYS; k++)
        keys |= (uint64_t)!isnan(material_edit_stored(of, k)) << k;
    return keys;
}

int materials_put(model *m, const char *const *name, const material *of, int64_t count, err *e)
{
    uint64_t used = UINT64_C(1) << LAW_density | UINT64_C(1) << LAW_peak;
    for (int64_t i = 0; i < count; i++)
        used |= material_edit_keys(&of[i]) | optional_keys(&of[i]);
    if (model_axis_add(m, "material", count, e) || !model_add(m, "material.name", e) ||
        !model_add(m, "material.law", e))
        return -1;
    for (int k = 0; k < LAW_ALL_KEYS; k++)
        if (used >> k & 1 && !model_add(m, material_edit_arrays[k], e))
            return -1;
    for (int64_t i = 0; i < count; i++)
        if (model_set_text(model_find(m, "material.name"), i, name[i], e) || row_store(m, i, of[i], ~UINT64_C(0), e))
            return -1;
    return 0;
}

static int put_rows(model *m, const row *rows, int64_t count, err *e)
{
    const char **name = mem_array(count, sizeof *name, "materials", e);
    material *of = name ? mem_array(count, sizeof *of, "materials", e) : NULL;
    for (int64_t i = 0; of && i < count; i++) {
        name[i] = rows[i].name;
        of[i] = rows[i].of;
    }
    int status = of ? materials_put(m, name, of, count, e) : -1;
    free(of);
    free(name);
    return status;
}

int materials_make(model *m, const material *of, err *e)
{
    const char *const name = "tissue";
    material checked = *of;
    char words[KNOWN_WORDS];
    for (int k = 0; k < LAW_ALL_KEYS; k++) {
        const double value = material_edit_stored(&checked, k);
        if (!(material_edit_optional(k) && isnan(value)) && !material_edit_valid(k, value, words))
            return err_set(e, NULL, 0, "%s=%g is not allowed; expected %s", law_key_name((law_key)k), value, words);
    }
    return materials_put(m, &name, of, 1, e);
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

/* The rows of a file as far as they are read; owned. */
typedef struct row_list {
    row *row;
    int32_t count;
    int64_t capacity;
    lookup index; /* of their names */
} row_list;

static void rows_free(row_list *of)
{
    for (int32_t i = 0; i < of->count; i++)
        free(of->row[i].name);
    free(of->row);
    lookup_free(&of->index);
}

/* The line of `k`; what it does not give is of `usual`. */
static int read_row(row_list *to, keyfile *k, const material *usual, err *e)
{
    material_edit edit = {0};
    if (parse_name(k, e))
        return -1;
    if (lookup_find(&to->index, to->row, sizeof *to->row, k->word[0]) >= 0)
        return keyfile_error(k, e, "material '%.200s' is given twice; expected each name once", k->word[0]);
    if (mem_grow(&to->row, &to->capacity, (int64_t)to->count + 1, sizeof *to->row, "materials", e))
        return -1;
    row *r = &to->row[to->count];
    *r = (row){.of = *usual, .name = mem_text(k->word[0], e)};
    if (!r->name)
        return -1;
    to->count++;
    return lookup_add(&to->index, to->row, sizeof *to->row, to->count, e) || row_parse(&edit, k, e)
               ? -1
               : material_edit_apply(&r->of, &edit, k->name, k->line, e);
}

int materials_read_with(model *m, in *s, const material *fallback, err *e)
{
    const material usual = fallback ? *fallback : materials_fallback();
    keyfile k;
    row_list rows = {0};
    int more, status = -1;
    keyfile_open(&k, s);
    while ((more = keyfile_next(&k, e)) > 0)
        if (read_row(&rows, &k, &usual, e)) {
            more = -1;
            break;
        }
    if (!more && !rows.count)
        err_set(e, in_name(s), 0, "no material in it; expected lines NAME law=neo-hookean E=3000 ...");
    else if (!more)
        status = put_rows(m, rows.row, rows.count, e);
    rows_free(&rows);
    return status;
}

/* Where a model has the law of material i, for messages. 0: it has no lines. */
static int64_t line_of(const model *m, const model_array *law, int64_t i)
{
    return m->stream ? model_line(law, i) : 0;
}

/* The law that a model names. NULL with e filled: the table has none. */
static const law_row *law_of(const model *m, int64_t i, err *e)
{
    const char *names[LAW_MOST];
    const model_array *law = model_need(m, "material.law", e);
    const law_row *found = law ? law_find(law->str[i]) : NULL;
    if (law && !found)
        near_unknown(e, m->stream, line_of(m, law, i), "law", law->str[i], names, law_names(names));
    return found;
}

/* Row `at` as it stands in the model, unchecked: what is missing is nan. */
static int row_of(const model *m, int64_t at, material *to, err *e)
{
    if (!(to->law = law_of(m, at, e)) || material_families_kind(m, at, &to->fibre, e))
        return -1;
    for (int k = 0; k < LAW_ALL_KEYS; k++) {
        const model_array *a = model_find(m, material_edit_arrays[k]);
        *material_edit_value(to, k) = a ? a->f64[at] : NAN;
    }
    return 0;
}

static int change_row(model *m, int64_t at, const material_edit *edit, const char *place, int64_t line, err *e)
{
    material of;
    if (row_of(m, at, &of, e) || material_edit_apply(&of, edit, place, line, e) || row_store(m, at, of, edit->given, e))
        return -1;
    drop_unused(m);
    return 0;
}

/* One line of an override. index: of names, the strings of material.name; seen: 1 for the rows that had theirs. */
static int override_line(model *m, keyfile *k, const lookup *index, char *const *names, uint8_t *seen, err *e)
{
    material_edit r = {0};
    if (parse_name(k, e))
        return -1;
    int32_t at = lookup_find(index, names, sizeof *names, k->word[0]);
    if (at < 0)
        return materials_unknown(m, k->word[0], k->name, k->line, e);
    if (seen[at]++)
        return keyfile_error(k, e, "material '%.200s' is given twice; expected each name once", k->word[0]);
    return row_parse(&r, k, e) || (r.given && change_row(m, at, &r, k->name, k->line, e)) ? -1 : 0;
}

int materials_override(model *m, in *s, err *e)
{
    keyfile k;
    int more = -1;
    lookup index = {0};
    const model_array *array = model_need(m, "material.name", e);
    char *const *names = array ? array->str : NULL; /* stays where it is when a change of law adds arrays */
    uint8_t *seen = array ? mem_array(array->rows, 1, "materials", e) : NULL;
    int32_t rows = array ? (int32_t)num_clamp_int(array->rows, 0, INT32_MAX) : 0;
    if (!seen || lookup_add(&index, names, sizeof *names, rows, e)) {
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

/* "-m NAME", as messages name it. */
enum { PLACE = 220 };
static const char *place_of(const char *name, char to[PLACE])
{
    snprintf(to, PLACE, "-m %.200s", name);
    return to;
}

/* edit: of all materials. */
static int assign(const model *m, material_edit *edit, const char *which, const char *name, const char *text, err *e)
{
    char place[PLACE];
    int32_t at = materials_find(m, which);
    if (at < 0)
        return materials_unknown(m, which, "-m", 0, e);
    place_of(which, place);
    for (int i = 0; i < MATERIAL_EDIT_NAMES; i++)
        if (!strcmp(material_edit_names[i], name)) {
            edit[at].given |= UINT64_C(1) << i;
            return material_edit_take(&edit[at], i, text, place, 0, e);
        }
    return material_edit_unknown(e, place, 0, "key", name, material_edit_names, MATERIAL_EDIT_NAMES);
}

static int take_assignment(const model *m, material_edit *edit, const char *assignment, err *e)
{
    char *text = mem_text(assignment, e), *name, *value;
    if (!text)
        return -1;
    int status = assignment_cut(text, &name, &value)
                     ? err_option(e, "-m", "'%.200s'; expected MATERIAL.KEY=VALUE, such as tissue.E=3000", assignment)
                     : assign(m, edit, text, name, value, e);
    free(text);
    return status;
}

int materials_set(model *m, const char *const *assignment, int count, err *e)
{
    char place[PLACE];
    const model_array *names = model_need(m, "material.name", e);
    material_edit *edit = names ? mem_array(names->rows, sizeof *edit, "materials", e) : NULL;
    int status = edit ? 0 : -1;
    for (int i = 0; !status && i < count; i++)
        status = take_assignment(m, edit, assignment[i], e);
    for (int64_t i = 0; !status && i < model_count(m, "material"); i++)
        if (edit[i].given)
            status = change_row(m, i, &edit[i], place_of(model_find(m, "material.name")->str[i], place), 0, e);
    free(edit);
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
    return material_edit_unknown(e, place, line, "material", name, a ? (const char *const *)a->str : NULL, count);
}

/* ---- what a model has, checked */

static int row_wrong(const model *m, const model_array *a, int64_t i, int key, double value, const char *words, err *e)
{
    return err_set(e, m->stream, a && m->stream ? model_line(a, i) : 0,
                   "%s, row %" PRId64 ": %g is not allowed; expected %s", material_edit_arrays[key], i, value, words);
}

/* The value of a key of material i. absent: what it is where the model has none; nan: it must have one. */
static int value_of(const model *m, int64_t i, int key, double absent, double *value, err *e)
{
    const model_array *a =
        isnan(absent) ? model_need(m, material_edit_arrays[key], e) : model_find(m, material_edit_arrays[key]);
    if (!a && isnan(absent))
        return -1;
    char words[KNOWN_WORDS];
    *value = !a || isnan(a->f64[i]) ? absent : a->f64[i];
    return material_edit_valid(key, *value, words) ? 0 : row_wrong(m, a, i, key, *value, words, e);
}

/* Two values where the law has one key of two: `second`, of these, is told. */
static int both_given(const model *m, int64_t i, int first, int second, err *e)
{
    char words[LAW_WORDS];
    const model_array *a = model_find(m, material_edit_arrays[second]);
    snprintf(words, sizeof words, "nan, as material.%s has a value", law_key_name((law_key)first));
    return row_wrong(m, a, i, second, a->f64[i], words, e);
}

static int none_given(const model *m, int64_t i, const law_row *of, int group, err *e)
{
    char words[LAW_WORDS];
    const model_array *law = model_find(m, "material.law");
    law_words(of, group, words);
    return err_set(e, m->stream, line_of(m, law, i),
                   "material.law, row %" PRId64 ": %s without %s; expected one of them", i, of->name, words);
}

/* Of which key of a group the model has a value for material i: one alone. -1 with e filled. */
static int key_of_group(const model *m, int64_t i, const law_row *of, int group, err *e)
{
    const unsigned keys = of->group[group];
    const int first = law_next_key(keys, 0);
    int found = -1;
    if (law_next_key(keys, first + 1) < 0)
        return first;
    for (int k = first; k >= 0; k = law_next_key(keys, k + 1)) {
        const model_array *a = model_find(m, material_edit_arrays[k]);
        if (!a || isnan(a->f64[i]))
            continue;
        if (found >= 0)
            return both_given(m, i, found, k, e);
        found = k;
    }
    return found < 0 ? none_given(m, i, of, group, e) : found;
}

/* No value for a key that the law does not have. */
static int check_foreign(const model *m, int64_t i, const law_row *of, err *e)
{
    char words[LAW_WORDS];
    const unsigned own = law_keys(of);
    for (int k = 0; k < LAW_OWN_KEYS; k++) {
        const model_array *a = own >> k & 1 ? NULL : model_find(m, material_edit_arrays[k]);
        if (a && !isnan(a->f64[i])) {
            snprintf(words, sizeof words, "nan, as the law %s has no such key", of->name);
            return row_wrong(m, a, i, k, a->f64[i], words, e);
        }
    }
    return 0;
}

/* The keys that need not be there. */
static int take_optional(const model *m, int64_t i, material *to, err *e)
{
    for (int k = law_next_key(to->law->optional, 0); k >= 0; k = law_next_key(to->law->optional, k + 1)) {
        const model_array *a = model_find(m, material_edit_arrays[k]);
        if (a && !isnan(a->f64[i]) && value_of(m, i, k, NAN, &to->value[k], e))
            return -1;
    }
    return 0;
}

/* The families of material i: all keys of their kind, and no other's. */
static int families_of(const model *m, int64_t i, material *to, err *e)
{
    char words[LAW_WORDS];
    if (material_families_kind(m, i, &to->fibre, e))
        return -1;
    for (int k = LAW_FIBRE_KEYS_FIRST; k < LAW_ALL_KEYS; k++) {
        const model_array *a = model_find(m, material_edit_arrays[k]);
        const bool given = a && !isnan(a->f64[i]),
                   needs = to->fibre && to->fibre->needs >> (k - LAW_FIBRE_KEYS_FIRST) & 1;
        *material_edit_value(to, k) = NAN;
        if (given && !fibre_kind_takes(to->fibre, k)) {
            snprintf(words, sizeof words, "nan, as %s has no such key", to->fibre ? to->fibre->name : "fibre=none");
            return row_wrong(m, a, i, k, a->f64[i], words, e);
        }
        if ((given || needs) && value_of(m, i, k, NAN, material_edit_value(to, k), e))
            return -1;
    }
    return 0;
}

/* Values that are no material together. */
static int check_together(const model *m, int64_t i, const material *of, err *e)
{
    char what[LAW_WORDS], expected[LAW_WORDS];
    if (!law_refuses(of->law, of->value, what, expected))
        return 0;
    return err_set(e, m->stream, line_of(m, model_find(m, "material.law"), i),
                   "material.law, row %" PRId64 ": %s, %s; expected %s", i, of->law->name, what, expected);
}

/* "E=3000 with nu=0.3". */
static void values_words(const material *of, char *to, size_t size)
{
    to[0] = '\0';
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        if (!isnan(of->value[k])) {
            const size_t at = strlen(to);
            snprintf(to + at, size - at, "%s%s=%g", at ? " with " : "", law_key_name((law_key)k), of->value[k]);
        }
}

int materials_of(const model *m, int64_t i, material *to, err *e)
{
    char words[200];
    if (!(to->law = law_of(m, i, e)))
        return -1;
    material_edit_clear(to);
    for (int g = 0; g < LAW_GROUPS && to->law->group[g]; g++) {
        const int key = key_of_group(m, i, to->law, g, e);
        if (key < 0 || value_of(m, i, key, NAN, &to->value[key], e))
            return -1;
    }
    if (take_optional(m, i, to, e) || check_foreign(m, i, to->law, e) || check_together(m, i, to, e) ||
        families_of(m, i, to, e) || value_of(m, i, LAW_density, NAN, &to->density, e) ||
        value_of(m, i, LAW_peak, 0, &to->peak, e))
        return -1;
    for (int k = LAW_OPTIONAL; k < LAW_FIBRE_KEYS_FIRST; k++)
        if (value_of(m, i, k, law_key_usual((law_key)k), material_edit_value(to, k), e))
            return -1;
    if (isfinite(material_bulk(to)) && material_mu(to) > 0)
        return 0;
    values_words(to, words, sizeof words);
    return err_set(e, m->stream, 0, "material, row %" PRId64 ": %s is beyond what can be computed", i, words);
}

double material_young(const material *a)
{
    return isnan(a->value[LAW_E]) ? law_young(a->law->moduli(a->value)) : a->value[LAW_E];
}

double material_poisson(const material *a)
{
    return isnan(a->value[LAW_nu]) ? law_poisson(a->law->moduli(a->value)) : a->value[LAW_nu];
}

material_numbers material_numbers_of(const material *a)
{
    material_numbers to = {
        .form = material_form(a), .at_rest = a->law->moduli(a->value), .density = a->density, .peak = a->peak};
    material_coefficients(a, to.c);
    return to;
}

material_numbers material_mixed(const material_numbers *a, const material_numbers *b, double s)
{
    double same_a[FORM_NUMBERS], same_b[FORM_NUMBERS];
    material_numbers mixed = {.at_rest = {.mu = material_between(a->at_rest.mu, b->at_rest.mu, s),
                                          .bulk = material_between(a->at_rest.bulk, b->at_rest.bulk, s)},
                              .density = (1 - s) * a->density + s * b->density,
                              .peak = (1 - s) * a->peak + s * b->peak};
    mixed.form = form_of_both(a->form, a->c, b->form, b->c, same_a, same_b);
    if (mixed.form == FORM_COUNT)
        return *a;
    form_between(mixed.form, mixed.at_rest.mu, mixed.at_rest.bulk, same_a, same_b, s, mixed.c);
    return mixed;
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
    if (law && !material_elements_check(m, law, e))
        return law;
    free(law);
    return NULL;
}
