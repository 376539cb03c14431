/* The stable step of a box of which only a part is tissue (element_cut.h). Its mean gradient is
 *     H_kj = (m_kj + E_j.q_k)/(4 h_j),
 * of the slopes m and hourglass modes q of component k, with moments of the part in E_j; so in the modes, all of the
 * same mass, B B^T is that of the whole box times
 *     G = I + E E^T,   3 x 3,
 * and with G = L L^T the law's frequencies are those of L^T A L, A the matrix of the whole box (step.h). Forces go by
 * the part's share and mass by its inertia, which is no less: `by` is the one over the other. What hourglass modes add
 * (stability.h) is no longer apart from the law's, as both move these modes: the largest eigenvalue of the sum is at
 * most the sum of the largest, and |dF|^2 at most |G| times what it is of the slopes alone. In double. Owns nothing.
 *
 * What fills less than CUT_LEAST of its box has the mass of so much. Of all shapes of a given share, a corner cut
 * off by a plane has the smallest step: found by taking, again and again, the part of the box where the bound's slope
 * by the six moments is highest. With a CUT_LEAST of .03 the bound gives .607 of a whole cube's step at nu .3; with
 * .02 .584, where the true step is .595. */
#ifndef SINEW_STABILITY_CUT_H
#define SINEW_STABILITY_CUT_H

#include "physics/element_cut.h"
#include "physics/stability.h"

#define CUT_LEAST .03

typedef struct stability_gram {
    double at[3][3];
} stability_gram;

/* G. E_x has y, z and yz at modes xy, zx and xyz; and so on. */
ELEMENT_FUNCTION stability_gram stability_gram_of(element_cut c)
{
    const double xy = c.x * c.y + c.yz * c.zx, yz = c.y * c.z + c.zx * c.xy, zx = c.z * c.x + c.xy * c.yz;
    const stability_gram g = {{{1 + c.y * c.y + c.z * c.z + c.yz * c.yz, xy, zx},
                               {xy, 1 + c.z * c.z + c.x * c.x + c.zx * c.zx, yz},
                               {zx, yz, 1 + c.x * c.x + c.y * c.y + c.xy * c.xy}}};
    return g;
}

/* No less than its largest eigenvalue: the largest sum of a row. */
ELEMENT_FUNCTION double stability_gram_bound(const stability_gram *g)
{
    double most = 0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(g->at[i][0]) + fabs(g->at[i][1]) + fabs(g->at[i][2]));
    return most;
}

/* L, in place of G: positive definite, as all its eigenvalues are at least 1. */
ELEMENT_FUNCTION void stability_gram_root(stability_gram *g)
{
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 3; i++) {
            double sum = g->at[i][j];
            for (int k = 0; k < j; k++)
                sum -= g->at[i][k] * g->at[j][k];
            g->at[i][j] = i < j ? 0 : i == j ? sqrt(sum) : sum / g->at[j][j];
        }
}

/* From the matrix of the whole box, in place. */
ELEMENT_FUNCTION void stability_cut_matrix(element_cut c, double by, step_matrix *a)
{
    stability_gram l = stability_gram_of(c);
    double half[9][9];
    stability_gram_root(&l);
    for (int r = 0; r < 9; r++)
        for (int s = 0; s < 9; s++) {
            half[r][s] = 0;
            for (int k = s % 3; k < 3; k++)
                half[r][s] += a->at[r][s - s % 3 + k] * l.at[k][s % 3];
        }
    for (int r = 0; r < 9; r++)
        for (int s = 0; s <= r; s++) {
            double sum = 0;
            for (int k = r % 3; k < 3; k++)
                sum += half[r - r % 3 + k][s] * l.at[k][r % 3];
            a->at[r][s] = a->at[s][r] = by * sum;
        }
}

/* From those of the whole box: the same modes also move F, so what they add is counted with the law's. */
ELEMENT_FUNCTION stability_twists stability_cut_twists(element_cut c, double by, stability_twists t)
{
    const stability_gram g = stability_gram_of(c);
    const stability_twists to = {by * t.own, by * (t.own + stability_gram_bound(&g) * t.more)};
    return to;
}

#endif
