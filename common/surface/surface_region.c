#include "surface/surface_region.h"

#include "base/path.h"
#include "surface/solid.h"
#include "surface/triangle_tree.h"

#include <math.h>
#include <string.h>

bool surface_region_is_box(const char *text)
{
    return strchr(text, ',') && !path_is_obj(text);
}

/* Coordinates are products and sums with roundings. */
static double rounding_of(const double *position, int64_t vertices)
{
    double largest = 0;
    for (int64_t i = 0; i < 3 * vertices; i++)
        largest = fmax(largest, fabs(position[i]));
    return 1e-12 * largest;
}

void surface_region_in_box(const double *position, int64_t vertices, const double box[6], uint8_t *inside)
{
    const double near = rounding_of(position, vertices), *low = box, *high = box + 3;
    for (int64_t v = 0; v < vertices; v++) {
        const double *x = position + 3 * v;
        inside[v] = true;
        for (int a = 0; a < 3; a++)
            inside[v] &= x[a] >= low[a] - near && x[a] <= high[a] + near;
    }
}

typedef struct marker {
    const triangle_tree *body;
    const double *position;
    double metre;
    uint8_t *inside;
} marker;

static void mark(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const marker *m = context;
    (void)chunk;
    for (int64_t v = from; v < to; v++) {
        const double *x = m->position + 3 * v;
        m->inside[v] = triangle_tree_holds(m->body, (double[3]){x[0] * m->metre, x[1] * m->metre, x[2] * m->metre});
    }
}

enum { VERTICES = 256 }; /* in a chunk */

int surface_region_in_file(const char *file, double scale, const double *position, int64_t vertices, double metre,
                           pool *threads, uint8_t *inside, err *e)
{
    trimesh b = {0};
    triangle_tree *body =
        solid_read(&b, file, scale, e) ? NULL : triangle_tree_create(b.position, b.corner, b.triangles, e);
    trimesh_free(&b);
    if (!body)
        return -1;
    marker m = {.body = body, .position = position, .metre = metre};
    m.inside = inside;
    pool_run(threads, vertices, VERTICES, mark, &m);
    triangle_tree_destroy(body);
    return 0;
}
