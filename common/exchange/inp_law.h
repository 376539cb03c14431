/* The laws that Abaqus has too, as sinew export writes them and sinew import reads them: constants, most of which are
 * values of keys, then D1, D2 and so on of the volumetric energy (J - 1)^2 / D1 + (J - 1)^4 / D2 + ..., of which only
 * the first term is there, K = 2 / D1. Abaqus Analysis User's Guide, "Hyperelastic behavior". CalculiX takes a small D2
 * of its own for one of 0, so that nothing changes its volume by much: a large one leaves the term out in both. Owns
 * nothing.
 */
#ifndef SINEW_INP_LAW_H
#define SINEW_INP_LAW_H

#include "model/material_edit.h"
#include "model/materials.h"

#include <string.h>

/* D2 and D3 over D1, as they are written, and from which on such terms are none. */
static const double inp_no_term = 1e12, inp_least_no_term = 1e9;

enum { INP_KEYS = 6, INP_CONSTANTS = 9, INP_LINE = 8 }; /* the most of a row, and on a line */

typedef struct inp_law {
    const char *name, *law;  /* as *HYPERELASTIC has it; as we do */
    int terms;               /* its N, or 0: it has none */
    int keys;                /* constants before D1 */
    law_key key[INP_KEYS];   /* whose values they are; of E and nu C10 is mu/2 */
    int volumetric;          /* D1 and on */
    const char *words;       /* the names of all */
    const char *positive;    /* of the first and of D1 */
    const char *other_press; /* where J's energy is another: which; or NULL */
} inp_law;

static const inp_law inp_laws[] = {
    {"NEO HOOKE", "neo-hookean", 0, 1, {LAW_E}, 1, "C10, D1", "C10 or D1", NULL},
    {"MOONEY-RIVLIN", "mooney-rivlin", 0, 2, {LAW_c10, LAW_c01}, 1, "C10, C01, D1", "C10 or D1", NULL},
    {"YEOH", "yeoh", 0, 3, {LAW_c10, LAW_c20, LAW_c30}, 3, "C10, C20, C30, D1, D2, D3", "C10 or D1", NULL},
    {"ARRUDA-BOYCE",
     "arruda-boyce",
     0,
     2,
     {LAW_mu, LAW_lock},
     1,
     "mu, lambda_m, D",
     "mu or D",
     "K/2 ((J^2 - 1)/2 - ln J)"},
    {"OGDEN", "ogden", 1, 2, {LAW_mu1, LAW_a1}, 1, "mu1, alpha1, D1", "mu1 or D1", NULL},
    {"OGDEN",
     "ogden",
     2,
     4,
     {LAW_mu1, LAW_a1, LAW_mu2, LAW_a2},
     2,
     "mu1, alpha1, mu2, alpha2, D1, D2",
     "mu1 or D1",
     NULL},
    {"OGDEN",
     "ogden",
     3,
     6,
     {LAW_mu1, LAW_a1, LAW_mu2, LAW_a2, LAW_mu3, LAW_a3},
     3,
     "mu1, alpha1, mu2, alpha2, mu3, alpha3, D1, D2, D3",
     "mu1 or D1",
     NULL}};
enum { INP_LAWS = sizeof inp_laws / sizeof *inp_laws };
#define INP_LAW_NAMES "NEO HOOKE, MOONEY-RIVLIN, YEOH, ARRUDA-BOYCE or OGDEN of N=1 to 3" /* for messages */

/* What is said where J's energy is another. */
#define INP_OTHER_PRESS                                                                                                \
    "material %.200s: the volumetric energy of Abaqus's %s is %s, here K/2 (J - 1)^2: the same but for terms of (J - " \
    "1)^3 and on"

/* The first row of a law that has all keys whose bits are given, or NULL. */
static inline const inp_law *inp_law_of(const law_row *law, unsigned keys)
{
    for (int i = 0; i < INP_LAWS; i++) {
        unsigned left = keys & (law->group[0] | law->group[1] | law->optional);
        for (int k = 0; k < inp_laws[i].keys; k++)
            left &= ~(1U << inp_laws[i].key[k]);
        if (!strcmp(inp_laws[i].law, law->name) && (!left || !inp_laws[i].terms))
            return &inp_laws[i];
    }
    return NULL;
}

/* Returns how many constants. */
static inline int inp_law_write(const inp_law *of, const material *from, double constants[INP_CONSTANTS])
{
    for (int i = 0; i < of->keys; i++) {
        const double value = of->key[i] == LAW_E ? material_mu(from) / 2 : from->value[of->key[i]];
        constants[i] = isnan(value) ? 0 : value;
    }
    for (int i = 0; i < of->volumetric; i++)
        constants[of->keys + i] = (i ? inp_no_term : 1) * 2 / material_bulk(from);
    return of->keys + of->volumetric;
}

/* The way back; what is no key of the law becomes nan. */
static inline void inp_law_read(const inp_law *of, const double *constants, material *to)
{
    const law_moduli at = {2 * constants[0], 2 / constants[of->keys]};
    to->law = law_find(of->law);
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        to->value[k] = NAN;
    if (of->key[0] == LAW_E) {
        to->value[LAW_E] = law_young(at);
        to->value[LAW_nu] = law_poisson(at);
        return;
    }
    for (int i = 0; i < of->keys; i++)
        to->value[of->key[i]] = constants[i];
    to->value[LAW_K] = at.bulk;
}

#endif
