/* The material table of a model: the arrays material.name, material.law and one for each key (physics/law.h) that some
 * material has, read from files of lines `NAME law=neo-hookean E=3000 nu=0.49 density=1000 peak=30000` and from
 * assignments NAME.KEY=VALUE. All values are checked against the table of laws. The model owns its arrays, as ever.
 *
 * For the tool that makes volumes: materials_default or materials_make where no file is given, materials_read where
 * one is; materials_find looks up what a volume names. Which material a volume has that names none is that tool's
 * affair.
 *
 * For the tool that solves: materials_of_volumes or materials_of, and of each its form, its coefficients and its
 * moduli at rest.
 */
#ifndef SINEW_MATERIALS_H
#define SINEW_MATERIALS_H

#include "base/in.h"
#include "model/model.h"
#include "physics/fibre_kind.h"
#include "physics/law.h"
#include "physics/muscle_numbers.h"

#include <math.h>

typedef struct material {
    const law_row *law;
    double value[LAW_OWN_KEYS]; /* of the law's keys: LAW_E and so on, in their units; nan where it has no such key */
    double density, peak;       /* kg/m3, Pa */
    double optimum, passive, stiffening, straight; /* of its muscles; 0: not given, so the usual value, */
    double vmax, series;                           /* as of these (1/s, 1) */
    const fibre_kind *fibre;                       /* of its families of fibres; NULL: none */
    double families[LAW_FIBRE_KEYS_COUNT];         /* of that kind's keys: LAW_eta and so on; nan where not given */
} material;

/* Neo-Hookean, E 3000 Pa, nu 0.49, density 1000 kg/m3 (W&M section 4.2); peak 30000 Pa, which is not in the paper. */
material materials_fallback(void);

/* Makes the table: one material, `tissue`, of the defaults or of these values, which are
 * checked. The axis must not be there yet. */
int materials_default(model *m, err *e);
int materials_make(model *m, const material *of, err *e);

/* Makes the table: `count` materials of these names, unchecked. */
int materials_put(model *m, const char *const *name, const material *of, int64_t count, err *e);

/* Makes the table from a file, in its order; a key not given has the value of `fallback` (NULL: the default), if the
 * material's law has the same keys. A name given twice, a value out of range or an empty file is an error. */
int materials_read(model *m, in *s, err *e);
int materials_read_with(model *m, in *s, const material *fallback, err *e);

/* Changes an existing table from such a file: only the keys given change. Where the law changes to one of other keys,
 * the values of the old law's keys are dropped; a key drops the other of which a law takes one. An unknown name is an
 * error: nothing could be made of it. */
int materials_override(model *m, in *s, err *e);

/* The same, as -m asks: "NAME.KEY=VALUE" (KEY may be law), `count` of them, in any order; of one given twice the last
 * counts. NAME may hold dots. What is wrong is an error of the command line; materials before it may be changed. */
int materials_set(model *m, const char *const *assignment, int count, err *e);

/* The index of the material named so, or -1. */
int32_t materials_find(const model *m, const char *name);

/* "unknown material 'name'; ..." at place:line, with near names. line 0: place is an option of the command line.
 * Returns -1. */
int materials_unknown(const model *m, const char *name, const char *place, int64_t line, err *e);

/* Material i, checked: a model may have been edited by hand. A key of its law that has no value is an error, so is a
 * value of a key that its law does not have. No peak is 0; optional keys that are not given have their usual value. */
int materials_of(const model *m, int64_t i, material *to, err *e);

/* Of every volume, checked, as are the values that single elements have (material_elements.h); the caller frees them.
 * NULL with e filled. */
material *materials_of_volumes(const model *m, err *e);

/* What single elements have in place of their material's, by key (material_elements.h). */
typedef struct material_elements {
    const double *value[LAW_density + 1]; /* elements; nan where there is none; NULL: no element has one */
    bool any;
} material_elements;

material_elements material_elements_of(const model *m);

/* What elements are made of, looked up once: all borrowed from the model, which has element.volume, and of those of
 * the volumes. */
typedef struct materials_map {
    const material *of_volume;
    const int32_t *volume, *mix; /* mix NULL: no element is mixed */
    const float *mixture;
    material_elements own;
} materials_map;

materials_map materials_map_of(const model *m, const material *of_volume);

/* What an element is made of: of a material, or of two. */
typedef struct material_numbers {
    form form;
    double c[FORM_NUMBERS]; /* the form's coefficients, Pa; 0 where it has fewer */
    law_moduli at_rest;
    double density, peak; /* kg/m3, Pa */
} material_numbers;

material_numbers material_numbers_of(const material *a);

/* Of an element, from the materials of the volumes: its volume's, with the values that it has itself, or what lies
 * between that and its second volume's. */
material_numbers materials_of_element(const materials_map *map, int64_t element);

/* The curves of its muscles (physics/muscle_curves.h), from values that are given, as materials_of gives them. Returns
 * whether they differ from the plain ones, of optimum 1 without passive stress. */
bool material_muscle(const material *a, double curve[MUSCLE_NUMBERS]);

/* mu and K at rest, in Pa. */
static inline double material_mu(const material *a)
{
    return a->law->moduli(a->value).mu;
}
static inline double material_bulk(const material *a)
{
    return a->law->moduli(a->value).bulk;
}

/* E (Pa) and nu of small strains: as they were given, or those of mu and K. */
double material_young(const material *a);
double material_poisson(const material *a);

/* The form that steppers take, and its coefficients, FORM_NUMBERS of which the form's are set. */
static inline form material_form(const material *a)
{
    return a->law->form;
}
static inline void material_coefficients(const material *a, double *c)
{
    a->law->fill(a->value, c);
}

/* What of it needs a direction, and whether anything does. */
fibre_numbers material_fibres(const material *a);
static inline bool material_is_directed(const material *a)
{
    const fibre_numbers n = material_fibres(a);
    return fibre_numbers_any(&n);
}

/* A modulus of what is mixed of two materials, s the share of b: a^(1-s) b^s. Two materials side by side have the sum
 * of their shares along their border, and the inverse of the sum of their shares' inverses across it; this lies
 * between, whatever the border's direction, and does to the inverses what it does to the moduli. */
static inline double material_between(double a, double b, double s)
{
    return a == b ? a : exp((1 - s) * log(a) + s * log(b));
}

/* What is mixed of two materials, but for fibres: mu and K as above, density and peak by shares, in the first form that
 * expresses both laws (form_between). a, where none does. */
material_numbers material_mixed(const material_numbers *a, const material_numbers *b, double s);

#endif
