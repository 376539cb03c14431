#include "model/material_elements.h"

#include "model/material_edit.h"

#include <inttypes.h>
#include <stdio.h>

#define KEY_ARRAY(key, unit, low, high, meaning) "element." #key,
const char *const material_elements_arrays[MATERIAL_ELEMENT_KEYS] = {LAW_KEYS(KEY_ARRAY) LAW_DENSITY_KEY(KEY_ARRAY)};

material_elements material_elements_of(const model *m)
{
    material_elements of = {.any = false};
    for (int k = 0; k < MATERIAL_ELEMENT_KEYS; k++) {
        const model_array *a = model_find(m, material_elements_arrays[k]);
        of.value[k] = a ? a->f64 : NULL;
        of.any |= a != NULL;
    }
    return of;
}

bool material_elements_has(const material_elements *of, int64_t element)
{
    for (int k = 0; of->any && k < MATERIAL_ELEMENT_KEYS; k++)
        if (of->value[k] && !isnan(of->value[k][element]))
            return true;
    return false;
}

void material_elements_put(const material_elements *of, int64_t element, material *to)
{
    for (int k = 0; of->any && k < MATERIAL_ELEMENT_KEYS; k++)
        if (of->value[k] && !isnan(of->value[k][element]))
            *material_edit_value(to, k) = of->value[k][element];
}

/* expected: what the value should be. */
static int wrong(const model *m, int key, int64_t i, double value, const char *expected, err *e)
{
    const model_array *a = model_find(m, material_elements_arrays[key]);
    return err_set(e, m->stream, m->stream ? model_line(a, i) : 0,
                   "%s, row %" PRId64 ": %g is not allowed; expected %s", a->name, i, value, expected);
}

/* The first key that element i has a value of. */
static int first_key(const material_elements *of, int64_t i)
{
    int k = 0;
    while (k < MATERIAL_ELEMENT_KEYS - 1 && (!of->value[k] || isnan(of->value[k][i])))
        k++;
    return k;
}

/* Whether fibres take its value: all but K's, where the law's shear is that of fibres. */
static bool is_of_fibres(const law_row *of, int key)
{
    return of->fibres && key < LAW_OWN_KEYS && law_keys(of) >> key & 1 && key != LAW_nu && key != LAW_K;
}

/* volume: its material. */
static int check_one(const model *m, const material_elements *of, int64_t i, const material *volume, err *e)
{
    char what[LAW_WORDS], expected[LAW_WORDS], words[KNOWN_WORDS + 64];
    material own = *volume;
    for (int k = 0; k < MATERIAL_ELEMENT_KEYS; k++) {
        const double value = of->value[k] ? of->value[k][i] : NAN;
        if (isnan(value))
            continue;
        snprintf(words, sizeof words, "nan, as its material, of the law %s, has no %s", volume->law->name,
                 law_key_name((law_key)k));
        if (is_of_fibres(volume->law, k))
            return wrong(m, k, i, value, "nan, as fibres have the values of their volume's material", e);
        if (isnan(*material_edit_value(&own, k)) || !material_edit_valid(k, value, words))
            return wrong(m, k, i, value, words, e);
        *material_edit_value(&own, k) = value;
    }
    const int key = first_key(of, i);
    if (law_refuses(own.law, own.value, what, expected))
        return err_set(e, m->stream, 0, "element, row %" PRId64 ": %s, %s; expected %s", i, own.law->name, what,
                       expected);
    if (isfinite(material_bulk(&own)) && material_mu(&own) > 0)
        return 0;
    return wrong(m, key, i, of->value[key][i], "what can be computed", e);
}

int material_elements_check(const model *m, const material *of_volume, err *e)
{
    const material_elements of = material_elements_of(m);
    const model_array *volume = of.any ? model_need(m, "element.volume", e) : NULL;
    if (!of.any)
        return 0;
    for (int64_t i = 0; volume && i < volume->rows; i++)
        if (material_elements_has(&of, i) && check_one(m, &of, i, &of_volume[volume->i32[i]], e))
            return -1;
    return volume ? 0 : -1;
}

materials_map materials_map_of(const model *m, const material *of_volume)
{
    const model_array *mix = model_find(m, "element.mix"), *mixture = model_find(m, "element.mixture");
    materials_map map = {
        .of_volume = of_volume, .volume = model_find(m, "element.volume")->i32, .own = material_elements_of(m)};
    if (mix && mixture) {
        map.mix = mix->i32;
        map.mixture = mixture->f32;
    }
    return map;
}

material_numbers materials_of_element(const materials_map *map, int64_t element)
{
    material of = map->of_volume[map->volume[element]];
    material_elements_put(&map->own, element, &of);
    const material_numbers own = material_numbers_of(&of);
    const int32_t mix = map->mix ? map->mix[element] : -1;
    if (mix < 0)
        return own;
    const material_numbers second = material_numbers_of(&map->of_volume[mix]);
    return material_mixed(&own, &second, map->mixture[element]);
}
