/* The material table of a model: the arrays material.name, material.law and one a key (MATERIAL_KEYS), read from
 * files of lines `NAME law=neo-hookean E=3000 nu=0.49 density=1000 peak=30000` and from assignments NAME.KEY=VALUE. All
 * values are checked against one table of keys. The model owns its arrays, as ever.
 *
 * For the tool that makes volumes: materials_default or materials_make where no file is given, materials_read where one
 * is; materials_find looks up what a volume names. Which material a volume has that names none is that tool's affair.
 */
#ifndef SINEW_MATERIALS_H
#define SINEW_MATERIALS_H

#include "base/in.h"
#include "model/model.h"

#include <math.h>

/* Neo-Hookean: tled-run's. Linear: isotropic linear elasticity with Cauchy's small strain, msds-run's FEM (PST section
 * III); it is what the first becomes where strains are small, with the same E and nu. */
typedef enum material_law { MATERIAL_NEO_HOOKEAN, MATERIAL_LINEAR, MATERIAL_LAWS } material_law;

/* X(key, default, where the model has none). E, nu and density: W&M section 4.2; peak is not in the paper. What is
 * allowed is in the table of known arrays, material.KEY: a nu below 0 (auxetic) is a material too; toward .5 the bulk
 * modulus grows without bound and the step shrinks to nothing. What lies outside is a slip of the pen. */
#define MATERIAL_KEYS(X)                                                                                               \
    X(E, 3000, NAN)                                                                                                    \
    X(nu, 0.49, NAN)                                                                                                   \
    X(density, 1000, NAN)                                                                                              \
    X(peak, 30000, 0)

typedef struct material {
    material_law law;
    double E, nu, density, peak; /* Pa, 1, kg/m3, Pa */
} material;

/* Neo-Hookean, and each key's default. */
material materials_fallback(void);

/* Makes the table: one material, `tissue`, of the defaults or of these values, which are
 * checked. The axis must not be there yet. */
int materials_default(model *m, err *e);
int materials_make(model *m, const material *of, err *e);

/* Makes the table from a file, in its order; a key not given has the default, or that of `fallback` (NULL: the
 * default). A name given twice, a value out of range or an empty file is an error. */
int materials_read(model *m, in *s, err *e);
int materials_read_with(model *m, in *s, const material *fallback, err *e);

/* Changes an existing table from such a file: only the keys given change. An unknown name is an error: nothing
 * could be made of it. */
int materials_override(model *m, in *s, err *e);

/* Changes one value, as -m asks: "NAME.KEY=VALUE" (KEY may be law). NAME may hold dots. What is wrong with it is an
 * error of the command line. */
int materials_set(model *m, const char *assignment, err *e);

/* The index of the material named so, or -1. */
int32_t materials_find(const model *m, const char *name);

/* "unknown material 'name'; ..." at place:line, with near names. line 0: place is an option of the command line.
 * Returns -1. */
int materials_unknown(const model *m, const char *name, const char *place, int64_t line, err *e);

/* Material i, checked: a model may have been edited by hand. A missing array or a nan is an error, but for peak (0). */
int materials_of(const model *m, int64_t i, material *to, err *e);

/* Of every volume, checked; the caller frees them. NULL with e filled. */
material *materials_of_volumes(const model *m, err *e);

/* What elements are made of, looked up once: all borrowed from the model, which has element.volume, and of those of the
 * volumes. */
typedef struct materials_map {
    const material *of_volume;
    const int32_t *volume, *mix; /* mix NULL: no element is mixed */
    const float *mixture;
} materials_map;

materials_map materials_map_of(const model *m, const material *of_volume);

/* An element's material, from those of the volumes: its volume's, or one between those of the two that it is mixed
 * of. */
material materials_of_element(const materials_map *map, int64_t element);

/* mu and K, in Pa. */
static inline double material_mu(const material *a)
{
    return a->E / (2 * (1 + a->nu));
}
static inline double material_bulk(const material *a)
{
    return a->E / (3 * (1 - 2 * a->nu));
}

/* A modulus of what is mixed of two materials, s the share of b: a^(1-s) b^s. Two materials side by side have the sum
 * of their shares along their border, and the inverse of the sum of their shares' inverses across it; this lies
 * between, whatever the border's direction, and does to the inverses what it does to the moduli. */
static inline double material_between(double a, double b, double s)
{
    return a == b ? a : exp((1 - s) * log(a) + s * log(b));
}

/* What is mixed of two materials of one law: mu and K as above, density and peak by shares. */
material material_mixed(const material *a, const material *b, double s);

#endif
