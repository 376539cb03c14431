#include "base/mem.h"
#include "base/near.h"
#include "base/path.h"
#include "mesh/bound.h"
#include "surface/scale.h"
#include "surface/solid.h"
#include "surface/surface_region.h"
#include "surface/triangle.h"
#include "surface/triangulate.h"
#include "tled/problem/script.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* The name */

enum { SURFACES_TOLD = 100 };

/* The bound surfaces' names that somebody could mean. */
static int unknown_surface(const model *m, const keyfile *k, const char *word, err *e)
{
    char name[MODEL_NAME], *list[SURFACES_TOLD];
    int count = 0, status = 0;
    for (int at = 0; !status && count < SURFACES_TOLD && model_surface(m, &at, name, sizeof name);)
        if (surface_part(m, name, "vertex.element") && !(list[count++] = mem_text(name, e)))
            status = -1;
    if (!status && !count)
        status = keyfile_error(k, e, "'%.200s': the model has no bound surface; expected one from sinew bind", word);
    if (!status)
        status = near_unknown(e, k->name, k->line, "bound surface", word, (const char *const *)list, count);
    while (count)
        free(list[--count]);
    return status;
}

/* The model's surface of this name (n bytes), or else one that differs in upper and lower case only. */
static bool find_surface(const model *m, const char *word, size_t n, char *name)
{
    char other[MODEL_NAME];
    bool found = false;
    for (int at = 0; model_surface(m, &at, other, sizeof other);) {
        if (strlen(other) != n || strncasecmp(other, word, n) != 0)
            continue;
        const bool exact = !strncmp(other, word, n);
        if (!found || exact)
            memcpy(name, other, n + 1);
        found = true;
        if (exact)
            break;
    }
    return found;
}

int script_take_surface(script_curve *c, const model *m, const keyfile *k, char *name, err *e)
{
    char word[201] = "";
    bound b;
    const size_t n = strcspn(c->target, ":");
    memcpy(word, c->target, n < sizeof word ? n : sizeof word - 1);
    if (!find_surface(m, c->target, n, name))
        return unknown_surface(m, k, word, e);
    const int is_bound = bound_of(&b, m, name, e);
    if (is_bound < 0)
        return -1;
    if (!is_bound)
        return keyfile_error(k, e, "surface '%.200s' is not bound; expected one that sinew bind put into the model",
                             name);
    if (b.corners != 8)
        return keyfile_error(k, e, "surface '%.200s' is bound to tetrahedra; expected hexahedra", name);
    c->surface = name;
    return 0;
}

/* Its triangles: of faces with three corners and more, in their order */

typedef struct picker {
    script *s;
    const script_curve *c;
    surface from;
    const char *group; /* that faces must be of; NULL: any */
    uint8_t *in;       /* vertices: whether in the region of space that triangles must be in; NULL: anywhere */
    int32_t *cut;      /* corners of the face's triangles */
    int64_t room;
} picker;

static bool is_in(const picker *p, const int32_t *vertex, const int32_t *triangle)
{
    return !p->in || (p->in[vertex[triangle[0]]] && p->in[vertex[triangle[1]]] && p->in[vertex[triangle[2]]]);
}

static int add_triangle(script *s, const int32_t *vertex, const int32_t *triangle, double part, err *e)
{
    if (s->triangles >= INT32_MAX / 8)
        return err_set(e, NULL, 0, "the script's targets have more than %d triangles in all", INT32_MAX / 8);
    if (mem_grow(&s->corner, &s->corner_capacity, s->triangles + 1, 3 * sizeof *s->corner, "the script's triangles",
                 e) ||
        mem_grow(&s->part, &s->part_capacity, s->triangles + 1, sizeof *s->part, "the script's triangles", e))
        return -1;
    s->part[s->triangles] = part;
    for (int i = 0; i < 3; i++)
        s->corner[3 * s->triangles + i] = vertex[triangle[i]];
    s->triangles++;
    s->curve[s->curves - 1].triangle_count++;
    return 0;
}

static int add_triangles(picker *p, const int32_t *vertex, const int32_t *cut, int64_t count, double part, err *e)
{
    for (int64_t t = 0; t < count; t++)
        if (is_in(p, vertex, cut + 3 * t) && add_triangle(p->s, vertex, cut + 3 * t, part, e))
            return -1;
    return 0;
}

/* A quadrilateral cut by one diagonal and by the other. */
static const int32_t both_ways[12] = {0, 1, 2, 0, 2, 3, 0, 1, 3, 1, 2, 3};

/* Whether its corners all turn one way. */
static bool is_convex(const surface *from, const int32_t *vertex)
{
    double first[3] = {0}, other[3] = {0};
    bool convex = true;
    for (int i = 0; i < 4; i++) {
        const int32_t *corner = both_ways + 3 * i;
        triangle_normal(from->position + 3 * (int64_t)vertex[corner[0]],
                        from->position + 3 * (int64_t)vertex[corner[1]],
                        from->position + 3 * (int64_t)vertex[corner[2]], i ? other : first);
        convex &= !i || first[0] * other[0] + first[1] * other[1] + first[2] * other[2] > 0;
    }
    return convex;
}

static int add_face(picker *p, int64_t face, err *e)
{
    const surface *from = &p->from;
    const int64_t count = surface_end(from, face) - from->start[face];
    const int32_t *vertex = from->vertex + from->start[face];
    if (count < 3 || (p->group && !surface_in_group(from->group_name[from->group[face]], p->group)))
        return 0;
    if (count == 4 && is_convex(from, vertex))
        return add_triangles(p, vertex, both_ways, 4, .5, e);
    if (3 * count > p->room && mem_grow(&p->cut, &p->room, 3 * count, sizeof *p->cut, "a polygon", e))
        return -1;
    if (triangulate(from->position, vertex, count, p->cut, e))
        return -1;
    return add_triangles(p, vertex, p->cut, count - 2, 1, e);
}

static int no_triangle(const picker *p, const keyfile *k, err *e)
{
    const char *name = p->c->surface, *region = script_region(p->c);
    if (p->in && path_is_obj(region))
        return keyfile_error(k, e,
                             "no triangle of '%.100s' lies inside of %.200s; expected a closed surface around some, in "
                             "the model's place and unit, or --unit",
                             name, region);
    if (p->in)
        return keyfile_error(k, e,
                             "no triangle of '%.100s' lies in the box %.200s; expected X0,Y0,Z0,X1,Y1,Z1 around some, "
                             "in metres or with suffixes",
                             name, region);
    if (p->group)
        return near_unknown(e, k->name, k->line, "group of polygons", p->group, (const char *const *)p->from.group_name,
                            p->from.groups < INT32_MAX ? (int)p->from.groups : INT32_MAX);
    return keyfile_error(k, e, "surface '%.200s' has no triangle; expected some", name);
}

static int check_closed(const script *s, const script_curve *c, const surface *from, const keyfile *k, err *e)
{
    char open[SOLID_OPEN];
    if (solid_open(from, s->corner + 3 * (int64_t)c->triangle_first, s->part + c->triangle_first, c->triangle_count,
                   open, e))
        return -1;
    if (*open)
        return keyfile_error(k, e,
                             "surface '%.200s' is not closed: %s; expected each edge between two triangles that face "
                             "the same way, or a region: SURFACE:GROUP, SURFACE:X0,Y0,Z0,X1,Y1,Z1 or SURFACE:FILE.obj",
                             c->surface, open);
    return 0;
}

/* Regions of space */

static int mark_inside(picker *p, const model *m, const keyfile *k, err *e)
{
    err found = {0};
    const num_unit unit = scale_unit(p->s->unit, m, e);
    if (!unit)
        return -1;
    if (surface_region_in_file(script_region(p->c), scale_of(unit), p->from.position, p->from.vertices, 1, NULL, p->in,
                               &found))
        return keyfile_error(k, e, "%.500s", found.text);
    return 0;
}

static int mark_region(picker *p, const model *m, const keyfile *k, err *e)
{
    const char *region = script_region(p->c);
    const bool by_box = region && surface_region_is_box(region), by_file = region && path_is_obj(region);
    if (!by_box && !by_file) {
        p->group = region;
        return 0;
    }
    if (!(p->in = mem_array(p->from.vertices, sizeof *p->in, "the vertices", e)))
        return -1;
    if (by_file)
        return mark_inside(p, m, k, e);
    surface_region_in_box(p->from.position, p->from.vertices, p->c->box, p->in);
    return 0;
}

int script_take_triangles(script *s, const model *m, const keyfile *k, err *e)
{
    const script_curve *c = &s->curve[s->curves - 1];
    picker p = {.s = s, .c = c};
    int status = surface_of(m, c->surface, &p.from, e) || mark_region(&p, m, k, e) ? -1 : 0;
    for (int64_t i = 0; i < p.from.faces && !status; i++)
        status = add_face(&p, i, e);
    free(p.cut);
    if (!status && !c->triangle_count)
        status = no_triangle(&p, k, e);
    free(p.in);
    if (!status && c->verb == SCRIPT_PRESSURE && !c->is_region)
        status = check_closed(s, c, &p.from, k, e);
    return status;
}
