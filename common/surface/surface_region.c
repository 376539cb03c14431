#include "surface/surface_region.h"

#include "base/path.h"
#include "surface/scale.h"
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

int surface_region_name(const char **at, char *name, size_t size)
{
    const size_t n = strcspn(*at, ",:");
    if (!n && **at != ',')
        return 0;
    if (!n || n >= size)
        return -1;
    memcpy(name, *at, n);
    name[n] = '\0';
    *at += n;
    if (**at != ',')
        return 1;
    ++*at;
    return **at && **at != ':' ? 1 : -1;
}

static int box_of_option(const char *option, const char *text, num_unit unit, double box[6], err *e)
{
    num_length list[6];
    if (num_lengths_of(text, list, 6) != 6)
        return err_usage(e, "%s '%.200s': expected a region X0,Y0,Z0,X1,Y1,Z1, lengths, or FILE.obj, a closed surface",
                         option, text);
    for (int i = 0; i < 6; i++)
        box[i] = num_length_in(list[i], unit, num_unit_of("m"));
    for (int a = 0; a < 3; a++)
        if (!(box[a] < box[3 + a]))
            return err_usage(e, "%s '%.200s': the box is empty; expected X0,Y0,Z0,X1,Y1,Z1 with X0 below X1 and so on",
                             option, text);
    return 0;
}

int surface_region_of_option(const char *option, const char *text, num_unit unit, const double *position,
                             int64_t vertices, pool *threads, uint8_t *inside, err *e)
{
    double box[6];
    err found = {0};
    if (!text) {
        memset(inside, 1, (size_t)vertices);
        return 0;
    }
    if (path_is_obj(text)) {
        if (!surface_region_in_file(text, scale_of(unit), position, vertices, 1, threads, inside, &found))
            return 0;
        return err_set(e, NULL, 0, "%s: %.600s", option, found.text);
    }
    if (box_of_option(option, text, unit, box, e))
        return -1;
    surface_region_in_box(position, vertices, box, inside);
    return 0;
}
