/* The maths of one triangle of the wall of a cavity: a membrane in plane stress, and the pressure on it. Where this is
 * included, stable_number is as in stable.h, and stable_root(a) gives the square root.
 *
 * F has two columns, 3 numbers each, one after the other: what the unit vectors t1, t2 of the plane at rest become. The
 * membrane is Saint Venant's and Kirchhoff's of a material that keeps its volume: with E = (F^T F - 1)/2 and Young's
 * modulus times thickness k, S = 2/3 k (tr E 1 + E) + S0. Of S and E there are the elements 11, 22 and 12. S0 is a
 * prestress. Owns nothing.
 */
#ifndef SINEW_WALL_H
#define SINEW_WALL_H

#include "msds/problem/stable.h"

STABLE_FUNCTION stable_number wall_dot(const stable_number a[3], const stable_number b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

STABLE_FUNCTION void wall_cross(const stable_number a[3], const stable_number b[3], stable_number to[3])
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

/* S of a strain, without S0. */
STABLE_FUNCTION void wall_law(const stable_number strain[3], stable_number k, stable_number s[3])
{
    const stable_number trace = strain[0] + strain[1];
    s[0] = k * 2 / 3 * (trace + strain[0]);
    s[1] = k * 2 / 3 * (trace + strain[1]);
    s[2] = k * 2 / 3 * strain[2];
}

/* F S. */
STABLE_FUNCTION void wall_along(const stable_number f[6], const stable_number s[3], stable_number to[6])
{
    for (int a = 0; a < 3; a++) {
        to[a] = f[a] * s[0] + f[3 + a] * s[2];
        to[3 + a] = f[a] * s[2] + f[3 + a] * s[1];
    }
}

/* g: F less t, so that small strains keep their digits. Gives s, and the first Piola-Kirchhoff stress in N/m. */
STABLE_FUNCTION void wall_stress(const stable_number t[6], const stable_number g[6], stable_number k,
                                 const stable_number s0[3], stable_number s[3], stable_number to[6])
{
    const stable_number strain[3] = {wall_dot(t, g) + wall_dot(g, g) / 2,
                                     wall_dot(t + 3, g + 3) + wall_dot(g + 3, g + 3) / 2,
                                     (wall_dot(t, g + 3) + wall_dot(t + 3, g) + wall_dot(g, g + 3)) / 2};
    stable_number f[6];
    for (int i = 0; i < 6; i++)
        f[i] = t[i] + g[i];
    wall_law(strain, k, s);
    for (int i = 0; i < 3; i++)
        s[i] += s0[i];
    wall_along(f, s, to);
}

/* What the stress changes by along d. Of s, only what pulls stiffens: a wall that is pressed would buckle. */
STABLE_FUNCTION void wall_tangent(const stable_number f[6], const stable_number d[6], const stable_number s[3],
                                  stable_number k, stable_number to[6])
{
    const stable_number none = k * 0, strain[3] = {wall_dot(f, d), wall_dot(f + 3, d + 3),
                                                   (wall_dot(f, d + 3) + wall_dot(f + 3, d)) / 2};
    stable_number by[3], more[6], pulls[3] = {stable_larger(s[0], none), stable_larger(s[1], none), s[2]};
    const stable_number most = stable_root(pulls[0] * pulls[1]);
    pulls[2] = stable_larger(-stable_larger(-pulls[2], -most), -most);
    wall_law(strain, k, by);
    wall_along(f, by, to);
    wall_along(d, pulls, more);
    for (int i = 0; i < 6; i++)
        to[i] += more[i];
}

/* What the three corners' shares of a pressure's force, p a/3 with a the normal times the area, change by along ways of
 * these: the symmetric part, which is all where the wall has no border. edge: from corner 0 to 1 and 2. */
STABLE_FUNCTION void wall_follow(const stable_number edge[6], const stable_number way[9], stable_number p,
                                 stable_number to[9])
{
    stable_number opposite[3][3], by[6], sum[3], a[3], b[3], turned[3]; /* opposite: edges, as they turn */
    for (int i = 0; i < 3; i++) {
        by[i] = way[3 + i] - way[i];
        by[3 + i] = way[6 + i] - way[i];
        sum[i] = way[i] + way[3 + i] + way[6 + i];
        opposite[0][i] = edge[3 + i] - edge[i];
        opposite[1][i] = -edge[3 + i];
        opposite[2][i] = edge[i];
    }
    wall_cross(by, edge + 3, a);
    wall_cross(edge, by + 3, b);
    for (int c = 0; c < 3; c++) {
        wall_cross(opposite[c], sum, turned);
        for (int i = 0; i < 3; i++)
            to[3 * c + i] = p / 12 * (a[i] + b[i] - turned[i]);
    }
}

#endif
