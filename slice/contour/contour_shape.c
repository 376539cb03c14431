/* What can be done to a contour once it is made. */
#include "base/mem.h"
#include "slice/contour/contour.h"

#include <math.h>
#include <stdlib.h>

/* The volume under the triangles, each vertex moved by `by` along its way outward. Positions are taken from the first
 * vertex's, so that little is lost where the surface lies far out. */
static double volume_at(const contour *c, double by)
{
    double sum = 0;
    for (int64_t t = 0; t < c->triangles; t++) {
        double p[3][3];
        for (int k = 0; k < 3; k++) {
            int64_t v = c->triangle[3 * t + k];
            for (int i = 0; i < 3; i++)
                p[k][i] = c->position[3 * v + i] - c->position[i] + by * (double)c->outward[3 * v + i];
        }
        sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
               p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sum / 6;
}

double contour_volume(const contour *c)
{
    return volume_at(c, 0);
}

/* One step of every vertex towards (share > 0) or away from the mean of its neighbours. In a closed surface each edge
 * is of two triangles that run along it both ways, so that going round the triangles meets each neighbour once. */
static void step(const contour *c, const int32_t *neighbours, double *sum, double share, double *of)
{
    for (int64_t i = 0; i < 3 * c->vertices; i++)
        sum[i] = 0;
    for (int64_t t = 0; t < 3 * c->triangles; t++) {
        int64_t from = c->triangle[t], to = c->triangle[t % 3 == 2 ? t - 2 : t + 1];
        for (int i = 0; i < 3; i++)
            sum[3 * from + i] += of[3 * to + i];
    }
    for (int64_t v = 0; v < c->vertices; v++)
        for (int i = 0; i < 3; i++)
            of[3 * v + i] += share * (sum[3 * v + i] / neighbours[v] - of[3 * v + i]);
}

int contour_smooth(contour *c, int passes, err *e)
{
    static const double share[2] = {.5, -.53};
    int64_t count = 3 * c->vertices;
    int32_t *neighbours = mem_array(c->vertices, sizeof *neighbours, "neighbours", e);
    double *sum = mem_array(count, sizeof *sum, "smoothing", e),
           *outward = mem_array(count, sizeof *outward, "smoothing", e);
    const bool made = neighbours && sum && outward;
    if (made) {
        for (int64_t t = 0; t < 3 * c->triangles; t++)
            neighbours[c->triangle[t]]++;
        for (int64_t i = 0; i < count; i++)
            outward[i] = (double)c->outward[i];
        for (int pass = 0; pass < 2 * passes; pass++) {
            step(c, neighbours, sum, share[pass % 2], c->position);
            step(c, neighbours, sum, share[pass % 2], outward);
        }
        for (int64_t i = 0; i < count; i++)
            c->outward[i] = (float)outward[i];
    }
    free(neighbours);
    free(sum);
    free(outward);
    return made ? 0 : -1;
}

/* A cubic in [-most, most], from its values at -most, -most/3, most/3 and most (Lagrange). */
static double cubic(const double y[4], double x)
{
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        double term = y[i], xi = -1 + 2. / 3 * i;
        for (int j = 0; j < 4; j++)
            if (j != i)
                term *= (x - (-1 + 2. / 3 * j)) / (xi - (-1 + 2. / 3 * j));
        sum += term;
    }
    return sum;
}

double contour_fill(contour *c, double volume, double most)
{
    double y[4], low = -1, high = 1;
    for (int i = 0; i < 4; i++)
        y[i] = volume_at(c, most * (-1 + 2. / 3 * i)) - volume;
    for (int i = 0; i < 60; i++) { /* it grows with the distance */
        double middle = (low + high) / 2;
        if (cubic(y, middle) < 0)
            low = middle;
        else
            high = middle;
    }
    double by = most * (low + high) / 2;
    for (int64_t i = 0; i < 3 * c->vertices; i++)
        c->position[i] += by * (double)c->outward[i];
    return by;
}
