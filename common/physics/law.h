/* The laws of tissue: a table. A law has a name, keys, which a material gives values, and a form (forms.h), whose
 * coefficients come of these values. Files of materials, assignments, models, messages and manuals take laws and keys
 * from here. To add a law is to add its row, and a key that no other law has. Owns nothing; all is constant.
 */
#ifndef SINEW_LAW_H
#define SINEW_LAW_H

#include "physics/fibre_numbers.h"
#include "physics/forms.h"

#include <stdbool.h>

/* X(key, unit, low, high, meaning). New keys go last: the order is that of arrays in a model and of messages.
 * What lies outside of low to high, both included, is a slip of the pen; a nu below 0 (auxetic) is a material too, and
 * toward .5 the bulk modulus grows without bound and the step shrinks to nothing. */
#define LAW_KEYS(X)                                                                                                    \
    X(E, "Pa", 1e-3, 1e12, "Young's modulus")                                                                          \
    X(nu, "1", -.99, .4999, "Poisson's ratio")                                                                         \
    X(c10, "Pa", 1e-3, 1e12, "coefficient of I1bar - 3")                                                               \
    X(c01, "Pa", 0, 1e12, "coefficient of I2bar - 3")                                                                  \
    X(K, "Pa", 1e-3, 1e12, "bulk modulus")                                                                             \
    X(c20, "Pa", -1e12, 1e12, "coefficient of (I1bar - 3)^2")                                                          \
    X(c30, "Pa", 0, 1e12, "coefficient of (I1bar - 3)^3")                                                              \
    X(mu, "Pa", 1e-3, 1e12, "shear modulus of chains that never lock")                                                 \
    X(lock, "1", 1, 1e3, "stretch at which chains lock")                                                               \
    X(c1, "Pa", 1e-3, 1e12, "factor of the exponential of I1bar - 3")                                                  \
    X(c2, "1", 0, 1e3, "factor of I1bar - 3 in the exponent")                                                          \
    X(mu1, "Pa", 1e-3, 1e12, "shear modulus at rest of the first term of stretches")                                   \
    X(a1, "1", -100, 100, "exponent of the first term of stretches")                                                   \
    X(mu2, "Pa", 1e-3, 1e12, "shear modulus at rest of the second term of stretches")                                  \
    X(a2, "1", -100, 100, "exponent of the second term of stretches")                                                  \
    X(mu3, "Pa", 1e-3, 1e12, "shear modulus at rest of the third term of stretches")                                   \
    X(a3, "1", -100, 100, "exponent of the third term of stretches")                                                   \
    X(c, "Pa", 1e-3, 1e12, "factor of the exponential of strains")                                                     \
    X(bf, "1", 1e-3, 1e3, "factor of the strain along the fibre in the exponent")                                      \
    X(bt, "1", 1e-3, 1e3, "factor of strains across the fibre in the exponent")                                        \
    X(bfs, "1", 1e-3, 1e3, "factor of shear along the fibre in the exponent")

#define LAW_DENSITY_KEY(X) X(density, "kg/m3", 1e-3, 1e6, "mass density at rest")

/* The same of what every material may have, whatever its law. Those after peak are optional: they shape the curves of a
 * muscle (muscle_curves.h, muscle_series.h), and have a usual value where they are not given. */
#define LAW_COMMON_KEYS(X)                                                                                             \
    LAW_DENSITY_KEY(X)                                                                                                 \
    X(peak, "Pa", 0, 1e12, "peak active stress of its muscles")                                                        \
    X(optimum, "1", .5, 2, "stretch at which its muscles are strongest, 1 if not given")                               \
    X(passive, "1", 0, 10, "factor of the passive stress of its muscles, over peak, 0 if not given")                   \
    X(stiffening, "1", .1, 20, "exponent of the passive stress of its muscles, 6.6 if not given")                      \
    X(straight, "1", 1, 2, "stretch over optimum from which passive stress is linear, 1.4 if not given")               \
    X(vmax, "1/s", 0, 1e3, "lengths by which its muscles shorten in a second without load, 0 (no limit) if not given") \
    X(series, "1", 1e-3, 1, "strain at peak stress of the spring in series with muscles of vmax, 0.04 if not given")

/* The same of families of fibres, by their kind (fibre_kind.h). */
#define LAW_FIBRE_KEYS(X)                                                                                              \
    X(eta, "Pa", 1e-3, 1e12, "stiffness of the fibres")                                                                \
    X(k1, "Pa", 1e-3, 1e12, "stiffness of the fibres at rest")                                                         \
    X(k2, "1", 0, 1e4, "how fast the fibres stiffen")                                                                  \
    X(kappa, "1", 0, 1. / 3, "dispersion of the fibres, from all in one direction to all alike")                       \
    X(angle, "degree", 0, 90, "of two families to the fibre, either side, in the plane across the normal")

#define LAW_KEY_INDEX(key, unit, low, high, meaning) LAW_##key,
/* LAW_E and so on; those of laws first, those of fibres last. */
typedef enum law_key {
    LAW_KEYS(LAW_KEY_INDEX) LAW_COMMON_KEYS(LAW_KEY_INDEX) LAW_FIBRE_KEYS(LAW_KEY_INDEX) LAW_ALL_KEYS
} law_key;
enum {
    LAW_OWN_KEYS = LAW_density, /* how many are of laws */
    LAW_OPTIONAL = LAW_optimum, /* the first that is */
    LAW_FIBRE_KEYS_FIRST = LAW_eta,
    LAW_FIBRE_KEYS_COUNT = LAW_ALL_KEYS - LAW_FIBRE_KEYS_FIRST
};
#undef LAW_KEY_INDEX

_Static_assert((int)LAW_OWN_KEYS <= 32, "keys of laws are bits of an unsigned");

enum { LAW_GROUPS = 5 }; /* the most groups of keys of any law */

/* At rest: the shear and the bulk modulus, Pa. */
typedef struct law_moduli {
    double mu, bulk;
} law_moduli;

enum { LAW_WORDS = 160 }; /* of messages on laws */

typedef struct law_row {
    const char *name;
    form form;
    unsigned group[LAW_GROUPS]; /* bits 1 << LAW_E and so on: of each group exactly one key must be given; then 0 */
    unsigned optional;          /* such bits of keys that need not be given, and are 0 then */
    law_moduli (*moduli)(const double *value);
    void (*fill)(const double *value, double *c); /* value: LAW_OWN_KEYS, nan where none; c: FORM_NUMBERS */
    /* Fills the numbers of fibres, if the law's shear is that of fibres: the form's coefficients lack them, and each
     * element needs a direction. NULL: the law has none. */
    void (*fibres)(const double *value, fibre_numbers *to);
    /* Whether values that are each in their range are no material together; what and expected say so. NULL: all are
     * one. */
    bool (*refuses)(const double *value, char what[LAW_WORDS], char expected[LAW_WORDS]);
    const char *meaning, *energy, *source; /* for the manual, a line each */
} law_row;

/* E (Pa) and nu of small strains. */
static inline double law_young(law_moduli at)
{
    return 9 * at.bulk * at.mu / (3 * at.bulk + at.mu);
}
static inline double law_poisson(law_moduli at)
{
    return (3 * at.bulk - 2 * at.mu) / (2 * (3 * at.bulk + at.mu));
}

/* Row i, or NULL past the last. Row 0 is the default. */
const law_row *law_at(int i);

/* NULL: there is none. */
const law_row *law_find(const char *name);

/* The first that has the form, or NULL. */
const law_row *law_of_form(form f);

/* Of all laws, in order; returns how many. */
enum { LAW_MOST = 16 };
int law_names(const char *to[LAW_MOST]);

/* Bits of the keys that the law has. */
unsigned law_keys(const law_row *of);

/* The lowest key in such bits, from `from` on; -1: none. */
int law_next_key(unsigned keys, int from);

/* Whether two laws have the same keys, so that values of one are values of the other: a key means the same in
 * each law that has it. */
bool law_keys_equal(const law_row *a, const law_row *b);

const char *law_key_name(law_key key);
const char *law_key_unit(law_key key);

/* The value of an optional key that is not given; nan of others. */
double law_key_usual(law_key key);

/* Whether law_row.refuses refuses the values. */
bool law_refuses(const law_row *of, const double *value, char what[LAW_WORDS], char expected[LAW_WORDS]);

/* "c10, c20, K or nu, [c30]": the keys of one group, or, where group is -1, of all groups, and those that are optional.
 */
void law_words(const law_row *of, int group, char to[LAW_WORDS]);

#endif
