/* PST's skin: a surface as a mass-spring-damper system of its own, apart from the tissue. Each edge of its triangles
 * is a spring and damper (equation 1); each vertex is held at its place at rest by an anchor of length zero, whose
 * force is -k x - gamma v, since it has no direction of its own; and the probe pushes vertices out (section V,
 * figures 6 and 7). As the paper says, a large repulsion may push the surface away from the probe, and then it
 * oscillates; a small one lets the probe in. This one is as large as brings a vertex to the probe's surface by the
 * end of the step, and takes its speed into the probe. The skin goes with the probe only, not with the tissue.
 *
 * Springs at their lengths do not resist at first what goes across them, and a dent ends like a crater. Skin is under
 * tension, so an edge pulls across itself as well, by a share of its stiffness: t k (u_other - u), which is nothing
 * at rest. Only ratios show: of that to the anchors, which is how wide a dent is. Inertia is what a step of dt is
 * stable with, in any configuration; the anchors' damping is that with which no mode oscillates: with inertia m,
 * anchors a and gamma = c k in the springs, gamma_a >= 2 sqrt(m a) and gamma_a c >= 2 m give every mode a + l, damped
 * by gamma_a + c l, at least its critical damping. The creator owns it; it borrows the surface, which the model
 * keeps.
 */
#ifndef SINEW_SKIN_H
#define SINEW_SKIN_H

#include "base/pool.h"
#include "msds/problem/msds_executor.h"
#include "surface/surface.h"

typedef struct skin {
    surface shape; /* borrowed, as is position */
    skin_options options;
    pool *threads;
    const double *position; /* vertices x 3, m */
    int64_t vertices, edges, triangles;
    int32_t *triangle;               /* triangles x 3; owned, as is all below */
    int64_t *start;                  /* vertices + 1: their springs */
    skin_spring *spring;             /* twice the edges */
    double *inertia, *anchor, *held; /* vertices: kg; N/m; N s/m: the anchor's damping */
    double *u, *v, *next_u, *next_v; /* vertices x 3: m, m/s */
    double oscillates;               /* the least share of critical damping that any anchor has: at least 1 */
    const skin_device *device;       /* that takes the steps; NULL, as it is made: the processor does */
    skin_state *on_device;           /* owned, once it has taken one: u and v are there then */
} skin;

/* Makes s (zeroed) of the surface at rest. -1 with e filled, and s to be freed all the same: no memory, no
 * triangles, an edge of no length. */
int skin_make(skin *s, const surface *shape, const skin_options *o, pool *threads, err *e);
void skin_free(skin *s);

/* Takes other options; the skin stays as it is. -1 with e filled, as for all below: the device failed. */
int skin_change(skin *s, const skin_options *o, err *e);

/* Back to rest. */
int skin_reset(skin *s, err *e);

/* Steps on, with the probe where it is (NULL: none). The same bytes for any count of threads, and on a device, which
 * may not be done when this returns. */
int skin_step(skin *s, const probe_placed *at, int64_t count, err *e);

/* Waits for the steps, and brings the displacements back: to be called before they are looked at. */
int skin_fetch(skin *s, err *e);

/* Unit normals of the vertices as they are now, the mean of their triangles' by area: vertices x 3; 0 where there
 * are none. */
void skin_normals(const skin *s, double *to);

/* The largest displacement, m; not finite where it diverged. */
double skin_largest(const skin *s);

#endif
