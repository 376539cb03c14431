/* The outside of the elements as a mesh with edges. */
#include "base/mem.h"
#include "mesh/boundary.h"
#include "render/showing_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const uint8_t tissue[3] = {226, 205, 190}, edge[3] = {70, 62, 58};

/* Whether an element is muscle; arrays may be missing. */
typedef struct muscles {
    const int32_t *volume;
    const uint8_t *is;
} muscles;

static muscles muscles_of(const model *m)
{
    const model_array *volume = model_find(m, "element.volume"), *is = model_find(m, "volume.muscle");
    muscles found = {0};
    if (volume)
        found.volume = volume->i32;
    if (is)
        found.is = is->u8;
    return found;
}

static bool is_muscle(const muscles *x, int64_t element)
{
    return x->volume && x->is && x->is[x->volume[element]];
}

static double centre(const int32_t *node, int corners, const double *rest, int axis)
{
    double sum = 0;
    for (int n = 0; n < corners; n++)
        sum += rest[3 * (int64_t)node[n] + axis];
    return sum / corners;
}

static bool is_cut(const showing_want *w, const int32_t *node, int corners, const double *rest)
{
    for (int i = 0; i < w->cuts; i++) {
        double at = centre(node, corners, rest, w->cut[i].axis);
        if (w->cut[i].above ? at > w->cut[i].at : at < w->cut[i].at)
            return true;
    }
    return false;
}

/* The elements of one thing: what a cut leaves of all but what is shown by itself, or the muscles. */
static bool *choose(const model *m, const showing_want *w, int thing, const model_array *node, const double *rest,
                    err *e)
{
    muscles muscle = muscles_of(m);
    bool apart = w->things & SHOWING_MUSCLES;
    bool *keep = mem_array(node->rows, sizeof *keep, "elements", e);
    for (int64_t n = 0; keep && n < node->rows; n++) {
        bool is = apart && is_muscle(&muscle, n);
        keep[n] = thing == SHOWING_MUSCLES ? is : !is && !is_cut(w, &node->i32[n * node->columns], node->columns, rest);
    }
    return keep;
}

/* Vertices are the nodes that faces have, in the order in which they come. of_vertex: their nodes, handed over. */
static int32_t *number(const boundary *b, int64_t nodes, scene_mesh *to, err *e)
{
    int32_t *vertex = mem_array(nodes, sizeof *vertex, "nodes", e);
    int32_t *of_vertex = vertex ? mem_array(b->faces * b->corners, sizeof *of_vertex, "nodes", e) : NULL;
    to->corner = of_vertex ? mem_array(b->faces * b->corners, sizeof *to->corner, "faces", e) : NULL;
    for (int64_t c = 0; to->corner && c < b->faces * b->corners; c++) {
        int32_t *v = &vertex[b->node[c]];
        if (!*v) {
            of_vertex[to->vertices] = b->node[c];
            *v = (int32_t)++to->vertices;
        }
        to->corner[c] = (uint32_t)(*v - 1);
    }
    free(vertex);
    if (to->corner)
        return of_vertex;
    free(of_vertex);
    return NULL;
}

/* Positions of the vertices, and the edges of the faces. */
static int shape(const model *m, const showing_want *w, const boundary *b, const int32_t *of_vertex, scene_mesh *to,
                 err *e)
{
    const double *u;
    if (showing_moves(w, "elements", &u, e))
        return -1;
    const double *rest = model_find(m, "node.position")->f64;
    to->position = mem_array(3 * to->vertices, sizeof *to->position, "vertices", e);
    to->edges = to->position ? mem_array(b->faces, 1, "faces", e) : NULL;
    if (!to->edges)
        return -1;
    for (int64_t v = 0; v < to->vertices; v++)
        showing_place(rest, u, of_vertex[v], &to->position[3 * v]);
    memset(to->edges, b->corners == 4 ? 15 : 7, (size_t)b->faces);
    showing_linear(edge, to->edge_colour);
    return 0;
}

/* Tissue and muscle, a colour a face. */
static int paint(const model *m, const boundary *b, scene_mesh *to, int *seen, err *e)
{
    muscles muscle = muscles_of(m);
    float colour[2][3];
    showing_linear(tissue, colour[0]);
    showing_linear(showing_green, colour[1]);
    to->face_colour = mem_array(3 * b->faces, sizeof *to->face_colour, "faces", e);
    for (int64_t f = 0; to->face_colour && f < b->faces; f++) {
        bool is = is_muscle(&muscle, b->element[f]);
        memcpy(&to->face_colour[3 * f], colour[is], sizeof colour[is]);
        *seen |= is ? SHOWING_MUSCLES : 0;
    }
    return to->face_colour ? 0 : -1;
}

/* Values of elements are the faces', those of nodes the vertices'. */
static double *values(const field *f, const boundary *b, const int32_t *of_vertex, scene_mesh *to, err *e)
{
    int64_t count = f->of_elements ? b->faces : to->vertices;
    float **colour = f->of_elements ? &to->face_colour : &to->vertex_colour;
    double *value = mem_array(count, sizeof *value, "values", e);
    if (f->of_elements != (to->face_colour != NULL)) {
        free(to->face_colour);
        to->face_colour = NULL;
    }
    if (value && !*colour)
        *colour = mem_array(3 * count, sizeof **colour, "values", e);
    if (!*colour) {
        free(value);
        return NULL;
    }
    for (int64_t n = 0; value && n < count; n++)
        value[n] = f->value[f->of_elements ? b->element[n] : of_vertex[n]];
    return value;
}

static int add_outside(showing *to, const model *m, const showing_want *w, int thing, const boundary *b, err *e)
{
    const char *name = showing_things[thing == SHOWING_MUSCLES ? 2 : 1];
    scene_mesh mesh = {.corners = b->corners, .faces = b->faces};
    double *value = NULL;
    mesh.label = mem_text(name, e);
    uint64_t cleared = showing_cleared(w, name);
    mesh.transparency = cleared ? .85f : 0;
    int32_t *of_vertex = mesh.label ? number(b, model_count(m, "node"), &mesh, e) : NULL;
    int seen = thing;
    bool made = of_vertex && !shape(m, w, b, of_vertex, &mesh, e) && !paint(m, b, &mesh, &seen, e);
    if (made && w->field) {
        value = values(w->field, b, of_vertex, &mesh, e);
        made = value != NULL;
    }
    free(of_vertex);
    if (made) {
        to->seen |= seen;
        to->cleared |= cleared;
        return showing_add(to, &mesh, value, e);
    }
    free(value);
    scene_mesh_free(&mesh);
    return -1;
}

static int add_thing(showing *to, const model *m, const showing_want *w, int thing, err *e)
{
    const model_array *node = model_need(m, "element.node", e);
    const model_array *rest = node ? model_need(m, "node.position", e) : NULL;
    bool *keep = rest ? choose(m, w, thing, node, rest->f64, e) : NULL;
    bool apart = keep && thing == SHOWING_VOXELS && w->things & SHOWING_MUSCLES;
    bool *muscle = apart ? choose(m, w, SHOWING_MUSCLES, node, rest->f64, e) : NULL;
    boundary b = {0};
    const bool made = keep && (muscle || !apart);
    int bad = made ? boundary_of(&b, m, keep, muscle, e) : -1;
    if (!bad && b.faces)
        bad = add_outside(to, m, w, thing, &b, e);
    free(keep);
    free(muscle);
    boundary_free(&b);
    return bad;
}

int showing_elements(showing *b, const model *m, const showing_want *want, err *e)
{
    if (want->things & SHOWING_MUSCLES && !(showing_there(m) & SHOWING_MUSCLES))
        return err_set(e, NULL, 0, "the model has no muscles; expected a volume of a muscle* surface");
    if (want->things & SHOWING_VOXELS && add_thing(b, m, want, SHOWING_VOXELS, e))
        return -1;
    return want->things & SHOWING_MUSCLES ? add_thing(b, m, want, SHOWING_MUSCLES, e) : 0;
}
