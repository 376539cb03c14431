#include "bind/side.h"

#include "base/mem.h"
#include "surface/coincident.h"
#include "surface/triangulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of a voxel's shortest side: what is so near to the point is its own surface. */
static const double own = 1e-3;

/* Vertices that are asked which way normals point. */
enum { ASKED = 1000, MOST = 216 };

static const char surface_key[] = "slits.surface", groups_key[] = "slits.groups";

/* ---- the surfaces of level 0 */

/* Tells whether a group has one of the names in the metadata. */
static bool bounds(const char *names, const char *group)
{
    char name[256];
    for (const char *p = names; *p;) {
        const size_t length = strcspn(p, " ");
        if (length && length < sizeof name) {
            memcpy(name, p, length);
            name[length] = '\0';
            if (surface_in_group(group, name))
                return true;
        }
        p += length + strspn(p + length, " ");
    }
    return false;
}

typedef struct triangles {
    uint32_t *corner;
    int32_t *cut;
    int64_t count, capacity, cut_capacity;
} triangles;

static int add_face(triangles *t, const surface *s, int64_t face, err *e)
{
    const int32_t *vertex = &s->vertex[s->start[face]];
    const int64_t corners = surface_end(s, face) - s->start[face], count = corners - 2;
    if (count < 1)
        return 0;
    if (mem_grow(&t->cut, &t->cut_capacity, 3 * count, sizeof *t->cut, "triangles", e) ||
        mem_grow(&t->corner, &t->capacity, 3 * (t->count + count), sizeof *t->corner, "triangles", e) ||
        triangulate(s->position, vertex, corners, t->cut, e))
        return -1;
    for (int64_t i = 0; i < 3 * count; i++)
        t->corner[3 * t->count + i] = (uint32_t)vertex[t->cut[i]];
    t->count += count;
    return 0;
}

static int add_faces(side *s, const surface *from, const char *groups, err *e)
{
    triangles t = {0};
    float *position = mem_array(3 * from->vertices, sizeof *position, "vertices", e);
    int status = position ? 0 : -1;
    for (int64_t i = 0; !status && i < 3 * from->vertices; i++)
        position[i] = (float)from->position[i];
    for (int64_t f = 0; !status && f < from->faces; f++)
        if (bounds(groups, from->group_name[from->group[f]]))
            status = add_face(&t, from, f, e);
    if (!status)
        status = embree_add_faces(s->surface, 3, from->vertices, position, t.count, t.corner, e);
    free(position);
    free(t.corner);
    free(t.cut);
    return status;
}

/* ---- elements beside slits */

static int find_beside(side *s, const model *m, err *e)
{
    const model_array *node = model_need(m, "element.node", e), *position = model_need(m, "node.position", e);
    int32_t *place = mem_array(position->rows, sizeof *place, "nodes", e);
    int32_t *count = place ? mem_array(position->rows, sizeof *count, "nodes", e) : NULL;
    int status = count && coincident_places(position->f64, position->rows, place, e) >= 0 ? 0 : -1;
    s->beside = status ? NULL : mem_array(node->rows, sizeof *s->beside, "elements", e);
    for (int64_t n = 0; s->beside && n < position->rows; n++)
        count[place[n]]++;
    for (int64_t i = 0; s->beside && i < 8 * node->rows; i++)
        s->beside[i / 8] = s->beside[i / 8] || count[place[node->i32[i]]] > 1;
    free(place);
    free(count);
    return s->beside ? 0 : -1;
}

int side_create(side *s, const model *m, const nearest *to, int threads, err *e)
{
    const char *name = model_meta_of(m, surface_key), *groups = model_meta_of(m, groups_key);
    const model_array *inside = model_find(m, "element.inside");
    surface from;
    *s = (side){.to = to, .cell = model_find(m, "element.lattice")->i32, .inside = inside ? inside->f32 : NULL};
    if (cut_moments_of(&s->cut, m, e))
        return -1;
    if (!name || !groups)
        return 0;
    if (surface_of(m, name, &from, e))
        return -1;
    s->surface = embree_create(threads, e);
    if (s->surface && !add_faces(s, &from, groups, e) && !embree_commit(s->surface, e) && !find_beside(s, m, e))
        return 0;
    side_free(s);
    return -1;
}

void side_free(side *s)
{
    if (s->surface)
        embree_destroy(s->surface);
    free(s->beside);
    *s = (side){0};
}

/* ---- which way normals point */

void side_place(const side *s, int32_t element, double place[3])
{
    const lattice *l = &s->to->grid;
    const float *middle = s->inside || !s->cut.count ? NULL : cut_moments_at(&s->cut, element);
    for (int a = 0; a < 3; a++) {
        const double half = middle ? (double)middle[a] / 2 : 0;
        const double at = s->inside ? (double)s->inside[3 * (int64_t)element + a] : .5 + half;
        place[a] = l->origin[a] + l->spacing[a] * (s->cell[3 * (int64_t)element + a] + at);
    }
}

static double inward(const side *s, int32_t element, const double *point, const double *normal)
{
    double place[3], sum = 0;
    side_place(s, element, place);
    for (int a = 0; a < 3; a++)
        sum += (place[a] - point[a]) * normal[a];
    return sum;
}

/* Newell's, at each corner. */
static void add_normal(const surface *of, int64_t face, double *normal)
{
    double n[3] = {0};
    const int64_t from = of->start[face], to = surface_end(of, face);
    for (int64_t c = from; c < to; c++) {
        const double *p = &of->position[3 * (int64_t)of->vertex[c]];
        const double *q = &of->position[3 * (int64_t)of->vertex[c + 1 < to ? c + 1 : from]];
        for (int a = 0; a < 3; a++)
            n[a] += (p[(a + 1) % 3] - q[(a + 1) % 3]) *
                    (p[(a + 2) % 3] + q[(a + 2) % 3] - 2 * of->position[3 * (int64_t)of->vertex[from] + (a + 2) % 3]);
    }
    for (int64_t c = from; c < to; c++)
        for (int a = 0; a < 3; a++)
            normal[3 * (int64_t)of->vertex[c] + a] += n[a];
}

/* Most of the vertices that lie by no slit say which way is inward. */
static bool points_outward(const side *s, const surface *of, const double *normal)
{
    const int64_t step = of->vertices / ASKED + 1;
    int64_t inside = 0, outside = 0;
    for (int64_t v = 0; v < of->vertices; v += step) {
        const int32_t element = nearest_element(s->to, &of->position[3 * v]);
        const double way = inward(s, element, &of->position[3 * v], &normal[3 * v]);
        inside += !s->beside[element] && way > 0;
        outside += !s->beside[element] && way < 0;
    }
    return outside > inside;
}

double *side_normals(const side *s, const surface *of, const model *m, err *e)
{
    const char *groups = model_meta_of(m, groups_key);
    double *normal = mem_array(3 * of->vertices, sizeof *normal, "normals", e);
    if (!normal)
        return NULL;
    for (int64_t f = 0; f < of->faces; f++)
        if (bounds(groups, of->group_name[of->group[f]]))
            add_normal(of, f, normal);
    const double sign = points_outward(s, of, normal) ? -1 : 1;
    for (int64_t i = 0; i < 3 * of->vertices; i++)
        normal[i] *= sign;
    return normal;
}

/* ---- one point */

bool side_sees(const embree *faces, const double place[3], const double point[3], double near)
{
    double length = 0;
    embree_packet p;
    embree_packet_clear(&p);
    for (int a = 0; a < 3; a++) {
        p.from[a][0] = (float)place[a];
        p.along[a][0] = (float)(point[a] - place[a]);
        length += (point[a] - place[a]) * (point[a] - place[a]);
    }
    length = sqrt(length);
    if (length <= near)
        return true;
    p.start[0] = 0;
    p.end[0] = (float)(1 - near / length);
    embree_blocked(faces, 1, &p, false);
    return p.end[0] >= 0;
}

static bool sees(const side *s, int32_t element, const double *point)
{
    const double *h = s->to->grid.spacing;
    double place[3];
    side_place(s, element, place);
    return side_sees(s->surface, place, point, own * fmin(h[0], fmin(h[1], h[2])));
}

typedef struct candidate {
    double distance2;
    int32_t element;
} candidate;

static int by_distance(const void *a, const void *b)
{
    const candidate *p = a, *q = b;
    if (p->distance2 != q->distance2)
        return p->distance2 < q->distance2 ? -1 : 1;
    return (p->element > q->element) - (p->element < q->element);
}

/* The elements of the voxels about one, by the distances of their centres. */
static int find_candidates(const side *s, const double *point, int32_t about, candidate *list)
{
    const lattice *l = &s->to->grid;
    int count = 0;
    for (int n = 0; n < 27; n++) {
        int64_t cell[3];
        double d2 = 0;
        for (int a = 0, way = n; a < 3; a++, way /= 3) {
            cell[a] = (int64_t)s->cell[3 * (int64_t)about + a] + way % 3 - 1;
            const double d = l->origin[a] + l->spacing[a] * ((double)cell[a] + .5) - point[a];
            d2 += d * d;
        }
        int32_t element = lattice_element(&s->to->map, cell[0], cell[1], cell[2]);
        for (; element >= 0 && count < MOST; element = lattice_next(&s->to->map, element))
            list[count++] = (candidate){d2, element};
    }
    qsort(list, (size_t)count, sizeof *list, by_distance);
    return count;
}

int32_t side_element(const side *s, const double *point, const double *normal, int32_t element)
{
    candidate list[MOST];
    int32_t seen = -1;
    if (!s->beside || !s->beside[element])
        return element;
    const int count = find_candidates(s, point, element, list);
    for (int i = 0; i < count; i++) {
        if (!sees(s, list[i].element, point))
            continue;
        seen = seen < 0 ? list[i].element : seen;
        const bool flat = !normal || (normal[0] == 0 && normal[1] == 0 && normal[2] == 0);
        if (flat || inward(s, list[i].element, point, normal) > 0)
            return list[i].element;
    }
    return seen < 0 ? element : seen;
}
