#define ELEMENT_SINGLE
#include "fibre_single.h"

#include "physics/fibre.h"

static element_vector vector_of(const double a[3])
{
    const element_vector v = {(float)a[0], (float)a[1], (float)a[2]};
    return v;
}

void fibre_single(const fibre_local *l, const double h[9], float p[9])
{
    const fibre_numbers *n = &l->of;
    const fibre_invariants q = fibre_numbers_fung(n);
    const fibre_set s = {{(float)n->k1, (float)n->k2, (float)n->kappa},
                         {(float)n->c, (float)q.all, (float)q.along, (float)q.both},
                         vector_of(l->along),
                         {vector_of(l->family[0]), vector_of(l->family[1])},
                         fibre_numbers_families(n),
                         n->c > 0};
    float at[9];
    element_tensor g, stress;
    for (int i = 0; i < 9; i++)
        at[i] = (float)h[i];
    memcpy(&g, at, sizeof g);
    stress = fibre_stress(g, &s, 1);
    memcpy(p, &stress, sizeof stress);
}
