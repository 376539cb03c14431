#include "model/material_edit.h"

#include "base/near.h"
#include "base/num.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define KEY_NAME(key, unit, low, high, meaning)  #key,
#define KEY_ARRAY(key, unit, low, high, meaning) "material." #key,
const char *const material_edit_names[MATERIAL_EDIT_NAMES] = {"law", LAW_KEYS(KEY_NAME) LAW_COMMON_KEYS(KEY_NAME)
                                                                         LAW_FIBRE_KEYS(KEY_NAME) "fibre"};
const char *const material_edit_arrays[LAW_ALL_KEYS] = {LAW_KEYS(KEY_ARRAY) LAW_COMMON_KEYS(KEY_ARRAY)
                                                            LAW_FIBRE_KEYS(KEY_ARRAY)};

double *material_edit_value(material *of, int key)
{
#define KEY_VALUE(key, unit, low, high, meaning) &of->key,
    double *const common[] = {LAW_COMMON_KEYS(KEY_VALUE)};
    if (key < LAW_OWN_KEYS)
        return &of->value[key];
    return key >= LAW_FIBRE_KEYS_FIRST ? &of->families[key - LAW_FIBRE_KEYS_FIRST] : common[key - LAW_OWN_KEYS];
}

double material_edit_stored(const material *of, int key)
{
    material own = *of;
    const double value = *material_edit_value(&own, key);
    if (key >= LAW_FIBRE_KEYS_FIRST)
        return fibre_kind_takes(of->fibre, key) ? value : NAN;
    return key >= LAW_OPTIONAL && value == 0 ? NAN : value;
}

static void clear_keys(material *of, unsigned keys)
{
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        if (keys >> k & 1)
            of->value[k] = NAN;
}

void material_edit_clear(material *of)
{
    clear_keys(of, ~0U);
}

bool material_edit_valid(int key, double value, char words[KNOWN_WORDS])
{
    const known *of = known_find(material_edit_arrays[key]);
    known_words(of, words);
    return value >= of->low && value <= of->high;
}

int material_edit_unknown(err *e, const char *place, int64_t line, const char *what, const char *name,
                          const char *const *names, int count)
{
    return line ? near_unknown(e, place, line, what, name, names, count)
                : near_option(e, place, what, name, names, count);
}

static int unknown_law(err *e, const char *place, int64_t line, const char *name)
{
    const char *names[LAW_MOST];
    const int count = law_names(names);
    return material_edit_unknown(e, place, line, "law", name, names, count);
}

static int unknown_kind(err *e, const char *place, int64_t line, const char *name)
{
    const char *names[FIBRE_KIND_MOST];
    const int count = fibre_kind_names(names);
    return material_edit_unknown(e, place, line, "fibre", name, names, count);
}

/* What is wrong with a row of a file, or, with line 0, in the option `place`; `words` are told as expected. */
static int wrong(err *e, const char *place, int64_t line, const char *what, const char *words)
{
    return line ? err_set(e, place, line, "%s; expected %s", what, words)
                : err_option(e, place, "%s; expected %s", what, words);
}

int material_edit_take(material_edit *r, int name, const char *text, const char *place, int64_t line, err *e)
{
    if (name == 0) {
        r->of.law = law_find(text);
        return r->of.law ? 0 : unknown_law(e, place, line, text);
    }
    if (name == MATERIAL_EDIT_FIBRE) {
        r->of.fibre = fibre_kind_find(text);
        return r->of.fibre || !strcmp(text, fibre_kind_none) ? 0 : unknown_kind(e, place, line, text);
    }
    double v;
    char words[KNOWN_WORDS], what[200];
    if (material_edit_valid(name - 1, num_double(text, &v) ? NAN : v, words)) {
        *material_edit_value(&r->of, name - 1) = v;
        return 0;
    }
    snprintf(what, sizeof what, "'%s=%.100s' is not allowed", material_edit_names[name], text);
    return wrong(e, place, line, what, words);
}

/* ---- whether a law has all its keys, and no other's */

/* "c10, c01, K or nu, density, peak". */
static void all_words(const law_row *of, char to[LAW_WORDS])
{
    law_words(of, -1, to);
    for (int k = LAW_OWN_KEYS; k < LAW_FIBRE_KEYS_FIRST; k++) {
        const size_t at = strlen(to);
        snprintf(to + at, LAW_WORDS - at, ", %s", law_key_name((law_key)k));
    }
}

/* lacking: the keys of one group. */
static int lacks(const law_row *of, const char *lacking, const char *place, int64_t line, err *e)
{
    char words[LAW_WORDS], what[200];
    law_words(of, -1, words);
    snprintf(what, sizeof what, "the law %s without %s", of->name, lacking);
    return wrong(e, place, line, what, words);
}

static int check_keys(const law_row *of, unsigned has, const char *place, int64_t line, err *e)
{
    char words[LAW_WORDS], what[200];
    const int foreign = law_next_key(has & ~law_keys(of), 0);
    if (foreign >= 0) {
        all_words(of, words);
        snprintf(what, sizeof what, "'%s' is not a key of the law %s", law_key_name((law_key)foreign), of->name);
        return wrong(e, place, line, what, words);
    }
    for (int g = 0; g < LAW_GROUPS && of->group[g]; g++) {
        const int first = law_next_key(has & of->group[g], 0);
        const int second = first < 0 ? -1 : law_next_key(has & of->group[g], first + 1);
        law_words(of, g, words);
        if (first < 0)
            return lacks(of, words, place, line, e);
        if (second < 0)
            continue;
        snprintf(what, sizeof what, "the law %s with both %s and %s", of->name, law_key_name((law_key)first),
                 law_key_name((law_key)second));
        return wrong(e, place, line, what, words);
    }
    return 0;
}

/* Values that are no material together. */
static int check_together(const material *of, const char *place, int64_t line, err *e)
{
    char what[LAW_WORDS], expected[LAW_WORDS], all[LAW_WORDS + 64];
    if (!law_refuses(of->law, of->value, what, expected))
        return 0;
    snprintf(all, sizeof all, "the law %s, %s", of->law->name, what);
    return wrong(e, place, line, all, expected);
}

/* ---- whether fibres have all keys of their kind, and no other's */

/* given: bits of the keys of fibres. */
static int check_fibres(const material *of, unsigned given, const char *place, int64_t line, err *e)
{
    const unsigned takes = of->fibre ? of->fibre->takes : 0, needs = of->fibre ? of->fibre->needs : 0;
    char words[LAW_WORDS], what[200];
    for (int k = 0; k < LAW_FIBRE_KEYS_COUNT; k++) {
        const char *name = law_key_name((law_key)(LAW_FIBRE_KEYS_FIRST + k));
        const bool foreign = given >> k & 1 && !(takes >> k & 1), lacks = needs >> k & 1 && isnan(of->families[k]);
        if (!foreign && !lacks)
            continue;
        if (foreign && !of->fibre) {
            snprintf(what, sizeof what, "'%s' without fibres", name);
            return wrong(e, place, line, what, "fibre=quadratic or fibre=hgo with it");
        }
        fibre_kind_words(takes, words);
        if (foreign)
            snprintf(what, sizeof what, "'%s' is not a key of fibre=%s", name, of->fibre->name);
        else
            snprintf(what, sizeof what, "fibre=%s without %s", of->fibre->name, name);
        return wrong(e, place, line, what, words);
    }
    return 0;
}

/* What the edit makes of the families. given: bits of law_key. */
static int apply_fibres(material *to, const material_edit *edit, uint64_t given, const char *place, int64_t line,
                        err *e)
{
    if (edit->given >> MATERIAL_EDIT_FIBRE & 1)
        to->fibre = edit->of.fibre;
    for (int k = 0; k < LAW_FIBRE_KEYS_COUNT; k++)
        if (given >> (LAW_FIBRE_KEYS_FIRST + k) & 1)
            to->families[k] = edit->of.families[k];
        else if (!fibre_kind_takes(to->fibre, LAW_FIBRE_KEYS_FIRST + k))
            to->families[k] = NAN;
    return check_fibres(to, (unsigned)(given >> LAW_FIBRE_KEYS_FIRST) & ((1U << LAW_FIBRE_KEYS_COUNT) - 1), place, line,
                        e);
}

unsigned material_edit_keys(const material *of)
{
    unsigned has = 0;
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        if (!isnan(of->value[k]))
            has |= 1U << k;
    return has;
}

int material_edit_apply(material *to, const material_edit *edit, const char *place, int64_t line, err *e)
{
    const uint64_t given = edit->given >> 1;
    const unsigned own = (unsigned)given & ((1U << LAW_OWN_KEYS) - 1);
    const law_row *law = edit->given & 1 ? edit->of.law : to->law;
    material from = edit->of;
    if (!law_keys_equal(law, to->law))
        material_edit_clear(to);
    to->law = law;
    for (int g = 0; g < LAW_GROUPS; g++)
        if (own & law->group[g])
            clear_keys(to, law->group[g]);
    for (int k = 0; k < LAW_FIBRE_KEYS_FIRST; k++)
        if (given >> k & 1)
            *material_edit_value(to, k) = *material_edit_value(&from, k);
    return check_keys(law, material_edit_keys(to) | own, place, line, e) || check_together(to, place, line, e) ||
                   apply_fibres(to, edit, given, place, line, e)
               ? -1
               : 0;
}

void material_edit_words(const model *m, int64_t i, char to[MATERIAL_EDIT_WORDS])
{
    const model_array *kind = model_find(m, "material.fibre");
    to[0] = '\0';
    for (int k = 0; k < LAW_ALL_KEYS; k++) {
        const size_t at = strlen(to);
        const model_array *a = model_find(m, material_edit_arrays[k]);
        if (a && !isnan(a->f64[i]))
            snprintf(to + at, MATERIAL_EDIT_WORDS - at, "%s%s=%.7g", at ? " " : "", law_key_name((law_key)k),
                     a->f64[i]);
        if (k == LAW_FIBRE_KEYS_FIRST - 1 && kind && strcmp(kind->str[i], fibre_kind_none) != 0)
            snprintf(to + strlen(to), MATERIAL_EDIT_WORDS - strlen(to), " fibre=%s", kind->str[i]);
    }
}
