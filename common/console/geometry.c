#include "console/geometry.h"

#include "base/mem.h"
#include "console/json.h"
#include "mesh/boundary.h"
#include "mesh/motion.h"
#include "mesh/rigid_body.h"
#include "surface/triangulate.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { KIND_GEOMETRY = 2, KIND_POSITIONS = 3, PARTS_MOST = 200, COLOUR = 8 };

/* A mesh: some of a surface's vertices, or some nodes. */
typedef struct part {
    char name[MODEL_NAME], colour[COLOUR];
    const char *kind;
    int64_t vertices, triangles;
    float *rest;        /* vertices x 3, m */
    uint32_t *triangle; /* triangles x 3 */
    int32_t *from;      /* vertices: the surface's, or nodes */
    int surface;        /* -1: they are nodes */
    int32_t rigid;      /* the rigid body that it moves with; -1: none */
    bool moves;
} part;

struct geometry {
    const model *m;
    const double *node; /* x 3, m: at rest */
    bound *surfaces;
    char (*surface_name)[MODEL_NAME]; /* surfaces: what the views borrow */
    int surface_count;
    bool *bound;   /* surfaces: whether it is */
    motion *moves; /* surfaces: of those that are bound and drawn, by the frame at hand */
    int skin;      /* the surface that moves by itself; -1: none */
    part *parts;
    int count;
    bool face;
    double box[6], tissue[6], up[3];
};

/* ---- names */

static bool has(const char *name, const char *word)
{
    const size_t n = strlen(word);
    for (const char *p = name; *p; p++)
        if (!strncasecmp(p, word, n))
            return true;
    return false;
}

static const struct {
    const char *word, *kind, *colour;
} looks[] = {
    {"skin", "skin", "#d8a48f"},     {"bone", "bone", "#e6dfc8"},     {"skull", "bone", "#e6dfc8"},
    {"skeleton", "bone", "#e6dfc8"}, {"rigid", "bone", "#e6dfc8"},    {"jaw", "bone", "#e6dfc8"},
    {"mandible", "bone", "#e6dfc8"}, {"muscle", "muscle", "#b5524a"}, {"vein", "label", "#4f78c4"},
    {"artery", "label", "#c8473f"},  {"vessel", "label", "#a0538a"},  {"nerve", "label", "#d6c04a"},
};

/* of: the name of its surface, which counts where its own says nothing. */
static void look_of(part *p, const char *of)
{
    const size_t count = sizeof looks / sizeof *looks;
    static const char *const others[] = {"#5aa28c", "#b0803c", "#7f7fc0", "#8fa544", "#a06a8a", "#5f9ab5"};
    const char *colour = others[strlen(p->name) % (sizeof others / sizeof *others)];
    p->kind = "label";
    for (size_t i = 0; i < 2 * count; i++) {
        if (!has(i < count ? p->name : of, looks[i % count].word))
            continue;
        p->kind = looks[i % count].kind;
        colour = looks[i % count].colour;
        break;
    }
    snprintf(p->colour, COLOUR, "%s", colour);
}

/* ---- parts */

static part *add_part(geometry *g, const char *name, int of, bool moves)
{
    part *p = &g->parts[g->count++];
    snprintf(p->name, sizeof p->name, "%s", name);
    p->surface = of;
    p->rigid = -1;
    p->moves = moves;
    look_of(p, of < 0 ? name : g->surfaces[of].shape.name);
    return p;
}

/* Takes a vertex of the whole as one of the part: its number there. index: -1 where it was not taken yet. */
static uint32_t take_vertex(part *p, int32_t *index, int32_t vertex)
{
    if (index[vertex] < 0) {
        index[vertex] = (int32_t)p->vertices;
        p->from[p->vertices++] = vertex;
    }
    return (uint32_t)index[vertex];
}

static int take_face(part *p, const double *position, const int32_t *vertex, int64_t corners, int32_t *index,
                     int32_t *scratch, err *e)
{
    if (triangulate(position, vertex, corners, scratch, e))
        return -1;
    for (int64_t i = 0; i < 3 * (corners - 2); i++)
        p->triangle[3 * p->triangles + i] = take_vertex(p, index, vertex[scratch[i]]);
    p->triangles += corners > 2 ? corners - 2 : 0;
    return 0;
}

static int keep_rest(part *p, const double *position, err *e)
{
    p->rest = mem_array(3 * p->vertices, sizeof *p->rest, "a mesh", e);
    for (int64_t i = 0; p->rest && i < 3 * p->vertices; i++)
        p->rest[i] = (float)position[3 * (int64_t)p->from[i / 3] + i % 3];
    return p->rest ? 0 : -1;
}

/* Room for so many triangles, of a whole of so many vertices; *index for take_vertex. */
static int make_room(part *p, int64_t triangles, int64_t vertices, int32_t **index, err *e)
{
    const int64_t most = vertices < 3 * triangles ? vertices : 3 * triangles;
    p->triangle = mem_array(3 * triangles, sizeof *p->triangle, "a mesh", e);
    p->from = mem_array(most, sizeof *p->from, "a mesh", e);
    *index = mem_array(vertices, sizeof **index, "a mesh", e);
    if (!p->triangle || !p->from || !*index)
        return -1;
    memset(*index, 0xff, (size_t)vertices * sizeof **index);
    return 0;
}

/* The faces of one group of a surface; group -1: all. */
static int fill_group(part *p, const surface *s, int32_t group, err *e)
{
    int64_t triangles = 0, longest = 3;
    int32_t *index = NULL;
    for (int64_t f = 0; f < s->faces; f++) {
        const int64_t corners = surface_end(s, f) - s->start[f];
        triangles += corners > 2 ? corners - 2 : 0;
        longest = corners > longest ? corners : longest;
    }
    int32_t *scratch = mem_array(3 * longest, sizeof *scratch, "a mesh", e);
    int failed = !scratch || make_room(p, triangles, s->vertices, &index, e);
    for (int64_t f = 0; f < s->faces && !failed; f++) {
        const int64_t corners = surface_end(s, f) - s->start[f];
        if (corners > 2 && (group < 0 || s->group[f] == group))
            failed = take_face(p, s->position, s->vertex + s->start[f], corners, index, scratch, e);
    }
    free(index);
    free(scratch);
    return failed || keep_rest(p, s->position, e) ? -1 : 0;
}

static int add_surface(geometry *g, int i, err *e)
{
    const surface *s = &g->surfaces[i].shape;
    const bool one = s->groups < 2 || g->count + s->groups >= PARTS_MOST;
    for (int32_t group = 0; group < (one ? 1 : s->groups); group++) {
        const char *name = s->groups && !one ? s->group_name[group] : s->name;
        if (s->groups == 1 && strcmp(s->group_name[0], "default") != 0)
            name = s->group_name[0];
        part *p = add_part(g, name, i, g->bound[i] || i == g->skin);
        if (fill_group(p, s, one ? -1 : group, e))
            return -1;
    }
    return 0;
}

/* The outside of all elements; it is the skin where no surface is. */
static int add_outside(geometry *g, bool has_skin, err *e)
{
    boundary b = {0};
    int32_t *index = NULL, scratch[6];
    part *p = add_part(g, has_skin ? "mesh" : "skin", -1, true);
    if (has_skin) {
        p->kind = "mesh";
        snprintf(p->colour, COLOUR, "%s", "#8c9aa5");
    }
    int failed = boundary_of(&b, g->m, NULL, NULL, e) ||
                 make_room(p, b.faces * (b.corners - 2), model_count(g->m, "node"), &index, e);
    for (int64_t f = 0; f < b.faces && !failed; f++)
        failed = take_face(p, g->node, b.node + b.corners * f, b.corners, index, scratch, e);
    free(index);
    boundary_free(&b);
    return failed || keep_rest(p, g->node, e) ? -1 : 0;
}

/* ---- the whole */

static int open_surfaces(geometry *g, const char *skin, err *e)
{
    char name[MODEL_NAME] = "";
    int at = 0, count = 0;
    while (model_surface(g->m, &at, name, sizeof name))
        count++;
    g->surfaces = mem_array(count, sizeof *g->surfaces, "surfaces", e);
    g->surface_name = mem_array(count, sizeof *g->surface_name, "surfaces", e);
    g->bound = mem_array(count, sizeof *g->bound, "surfaces", e);
    g->moves = mem_array(count, sizeof *g->moves, "surfaces", e);
    g->parts = mem_array(PARTS_MOST + count + 1, sizeof *g->parts, "surfaces", e);
    if (!g->surfaces || !g->surface_name || !g->bound || !g->moves || !g->parts)
        return -1;
    at = 0;
    while (model_surface(g->m, &at, name, sizeof name)) {
        char *kept = memcpy(g->surface_name[g->surface_count], name, sizeof name);
        const int is = bound_of(&g->surfaces[g->surface_count], g->m, kept, e);
        if (is < 0)
            return -1;
        if (!strcmp(name, skin))
            g->skin = g->surface_count;
        if (is && motion_open(&g->moves[g->surface_count], &g->surfaces[g->surface_count], model_count(g->m, "node"),
                              model_count(g->m, "element"), e))
            return -1;
        g->bound[g->surface_count++] = is > 0;
    }
    return 0;
}

static void begin_box(double box[6])
{
    for (int a = 0; a < 3; a++) {
        box[a] = DBL_MAX;
        box[3 + a] = -DBL_MAX;
    }
}

/* The i-th coordinate of points that are x 3. */
static void grow_box(double box[6], int64_t i, double x)
{
    box[i % 3] = fmin(box[i % 3], x);
    box[3 + i % 3] = fmax(box[3 + i % 3], x);
}

static void find_boxes(geometry *g)
{
    begin_box(g->box);
    begin_box(g->tissue);
    for (int i = 0; i < g->count; i++)
        for (int64_t v = 0; v < 3 * g->parts[i].vertices; v++)
            grow_box(g->box, v, (double)g->parts[i].rest[v]);
    for (int64_t i = 0; i < 3 * model_count(g->m, "node"); i++)
        grow_box(g->tissue, i, g->node[i]);
}

/* A face is upright along y. What a probe presses is held at its far side: up is the axis along which the held nodes
 * are farthest from the middle. */
static void find_up(geometry *g)
{
    const model_array *rigid = model_find(g->m, "node.rigid");
    const int64_t nodes = model_count(g->m, "node");
    double held[3] = {0}, all[3] = {0}, count = 0;
    int axis = 1;
    for (int64_t n = 0; n < nodes; n++)
        for (int a = 0; a < 3; a++) {
            const bool is = rigid && rigid->u8[n];
            all[a] += g->node[3 * n + a] / (double)nodes;
            held[a] += is ? g->node[3 * n + a] : 0;
            count += is && !a;
        }
    if (g->face || count < 1) {
        g->up[1] = 1;
        return;
    }
    for (int a = 0; a < 3; a++)
        if (fabs(all[a] - held[a] / count) > fabs(all[axis] - held[axis] / count))
            axis = a;
    g->up[axis] = all[axis] < held[axis] / count ? -1 : 1;
}

static int fill(geometry *g, const char *skin, err *e)
{
    bool has_skin = false;
    const model_array *node = model_need(g->m, "node.position", e);
    if (!node || open_surfaces(g, skin, e))
        return -1;
    g->node = node->f64;
    for (int i = 0; i < g->surface_count; i++)
        if (add_surface(g, i, e))
            return -1;
    for (int i = 0; i < g->count; i++)
        has_skin |= !strcmp(g->parts[i].kind, "skin");
    if (add_outside(g, has_skin, e))
        return -1;
    find_boxes(g);
    find_up(g);
    return 0;
}

geometry *geometry_make(const model *m, bool face, const char *skin, err *e)
{
    geometry *g = mem_array(1, sizeof *g, "a scene", e);
    if (!g)
        return NULL;
    g->m = m;
    g->face = face;
    g->skin = -1;
    if (!fill(g, skin, e))
        return g;
    geometry_free(g);
    return NULL;
}

void geometry_free(geometry *g)
{
    if (!g)
        return;
    for (int i = 0; i < g->count; i++) {
        free(g->parts[i].rest);
        free(g->parts[i].triangle);
        free(g->parts[i].from);
    }
    for (int i = 0; i < g->surface_count && g->moves; i++)
        motion_free(&g->moves[i]);
    free(g->moves);
    free(g->parts);
    free(g->surfaces);
    free(g->surface_name);
    free(g->bound);
    free(g);
}

void geometry_attach(geometry *g, const char *name, int32_t body)
{
    for (int i = 0; i < g->count; i++) {
        part *p = &g->parts[i];
        if (p->surface < 0 || p->moves || strcmp(g->surfaces[p->surface].shape.name, name) != 0)
            continue;
        p->rigid = body;
        p->moves = true;
    }
}

const double *geometry_box(const geometry *g)
{
    return g->box;
}

const double *geometry_up(const geometry *g)
{
    return g->up;
}

const double *geometry_tissue(const geometry *g)
{
    return g->tissue;
}

int64_t geometry_skin(const geometry *g)
{
    return g->skin < 0 ? 0 : g->surfaces[g->skin].shape.vertices;
}

/* ---- messages */

static size_t padded(size_t size)
{
    return (size + 3) & ~(size_t)3;
}

static out *make_header(const geometry *g, err *e)
{
    out *o = out_memory(e);
    if (!o)
        return NULL;
    out_text(o, "{\"meshes\":[");
    for (int i = 0; i < g->count; i++) {
        const part *p = &g->parts[i];
        out_format(o, "%s{\"id\":%d,\"name\":", i ? "," : "", i);
        json_text(p->name, o);
        out_format(o, ",\"kind\":\"%s\",\"vertices\":%lld,\"triangles\":%lld,\"colour\":\"%s\",\"moves\":%s}", p->kind,
                   (long long)p->vertices, (long long)p->triangles, p->colour, p->moves ? "true" : "false");
    }
    out_text(o, "],\"box\":");
    json_numbers(g->box, 6, o);
    out_text(o, ",\"up\":");
    json_numbers(g->up, 3, o);
    out_text(o, "}");
    return o;
}

static unsigned char *put(unsigned char *at, const void *bytes, size_t size)
{
    if (size)
        memcpy(at, bytes, size);
    return at + size;
}

static unsigned char *put_u32(unsigned char *at, int64_t value)
{
    const uint32_t word = (uint32_t)value;
    return put(at, &word, sizeof word);
}

mail *geometry_mail(const geometry *g, err *e)
{
    size_t length, size = 8;
    out *header = make_header(g, e);
    if (!header)
        return NULL;
    const unsigned char *text = out_bytes(header, &length);
    size += padded(length);
    for (int i = 0; i < g->count; i++)
        size += 12 * (size_t)(g->parts[i].vertices + g->parts[i].triangles);
    mail *m = mail_make(false, size, e);
    if (m) {
        unsigned char *at = put_u32(put_u32(m->bytes, KIND_GEOMETRY), (int64_t)length);
        put(at, text, length);
        at += padded(length);
        for (int i = 0; i < g->count; i++) {
            at = put(at, g->parts[i].rest, 12 * (size_t)g->parts[i].vertices);
            at = put(at, g->parts[i].triangle, 12 * (size_t)g->parts[i].triangles);
        }
    }
    out_discard(header);
    return m;
}

/* What a rigid motion displaces a place by, m. */
static void displace_rigidly(const pose *moved, const float *rest, double to[3])
{
    const double x[3] = {(double)rest[0], (double)rest[1], (double)rest[2]};
    pose_apply(moved, x, to);
    for (int a = 0; a < 3; a++)
        to[a] -= x[a];
}

/* The displacements of a part's vertices: d x 3, m; and their lengths' largest. */
static double displace(const geometry *g, const part *p, const geometry_frame *f, float *d)
{
    const pose moved = rigid_body_pose(p->rigid < 0 ? NULL : f->rigid, p->rigid);
    double largest = 0;
    for (int64_t i = 0; i < p->vertices; i++) {
        double x[3] = {0};
        if (p->rigid >= 0)
            displace_rigidly(&moved, p->rest + 3 * i, x);
        else if (p->surface < 0)
            memcpy(x, f->u + 3 * (int64_t)p->from[i], sizeof x);
        else if (p->surface != g->skin)
            motion_displacement(&g->moves[p->surface], p->from[i], x);
        else if (f->skin)
            memcpy(x, f->skin + 3 * (int64_t)p->from[i], sizeof x);
        for (int a = 0; a < 3; a++)
            d[3 * i + a] = (float)x[a];
        largest = fmax(largest, sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]));
    }
    return largest;
}

static void find_part_box(const part *p, const float *d, float box[6])
{
    for (int a = 0; a < 3; a++) {
        box[a] = FLT_MAX;
        box[3 + a] = -FLT_MAX;
    }
    for (int64_t i = 0; i < 3 * p->vertices; i++) {
        const float x = p->rest[i] + d[i];
        box[i % 3] = fminf(box[i % 3], x);
        box[3 + i % 3] = fmaxf(box[3 + i % 3], x);
    }
}

/* -32767 is the box's lower corner, 32767 its upper one. */
static void put_places(const part *p, const float *d, const float box[6], unsigned char *at)
{
    for (int64_t i = 0; i < 3 * p->vertices; i++) {
        const float middle = (box[i % 3] + box[3 + i % 3]) / 2, half = (box[3 + i % 3] - box[i % 3]) / 2;
        const float share = half > 0 ? (p->rest[i] + d[i] - middle) / half : 0;
        const int16_t word = (int16_t)lrintf(32767 * share);
        memcpy(at + 2 * i, &word, 2);
    }
}

/* The value of a part's vertex: of its node, or by its shares of nodes'; of a displacement its length. */
static double value_of(const geometry *g, const part *p, const geometry_frame *f, const float *d, int64_t i)
{
    double share[8], sum = 0;
    if (!f->value)
        return sqrt((double)(d[3 * i] * d[3 * i] + d[3 * i + 1] * d[3 * i + 1] + d[3 * i + 2] * d[3 * i + 2]));
    if (p->surface < 0)
        return f->value[p->from[i]];
    if (p->rigid >= 0 || p->surface == g->skin)
        return f->low;
    const bound *b = &g->surfaces[p->surface];
    const int corners = bound_shares(b, p->from[i], share);
    for (int k = 0; k < corners; k++)
        sum += share[k] * f->value[b->node[(int64_t)corners * b->element[p->from[i]] + k]];
    return sum;
}

static void put_values(const geometry *g, const part *p, const geometry_frame *f, const float *d, unsigned char *at)
{
    for (int64_t i = 0; i < p->vertices && f->high > f->low; i++) {
        const double share = (value_of(g, p, f, d, i) - f->low) / (f->high - f->low);
        at[i] = (unsigned char)lrint(255 * fmin(fmax(share, 0), 1));
    }
}

/* What a part of so many vertices takes. */
static size_t part_size(int64_t vertices)
{
    return 32 + padded(6 * (size_t)vertices) + 12 + padded((size_t)vertices);
}

static unsigned char *put_part(const geometry *g, int id, const geometry_frame *f, const float *d, unsigned char *at)
{
    const part *p = &g->parts[id];
    const float low = (float)f->low, high = (float)f->high;
    float box[6];
    find_part_box(p, d, box);
    at = put_u32(put_u32(at, id), p->vertices);
    at = put(at, box, sizeof box);
    put_places(p, d, box, at);
    at += padded(6 * (size_t)p->vertices);
    at = put(put(at, &low, sizeof low), &high, sizeof high);
    at = put_u32(at, p->vertices);
    put_values(g, p, f, d, at);
    return at + padded((size_t)p->vertices);
}

mail *geometry_positions(const geometry *g, const geometry_frame *is, err *e)
{
    size_t size = 12;
    int64_t vertices = 0, moving = 0;
    geometry_frame f = *is;
    double largest = 0;
    for (int i = 0; i < g->count; i++) {
        vertices += g->parts[i].vertices;
        if (g->parts[i].moves && ++moving)
            size += part_size(g->parts[i].vertices);
    }
    mail *m = mail_make(false, size, e);
    float *d = m ? mem_array(3 * vertices, sizeof *d, "positions", e) : NULL, *each = d;
    if (!d) {
        mail_done(m);
        return NULL;
    }
    for (int i = 0; i < g->surface_count; i++)
        if (g->bound[i] && i != g->skin)
            motion_set(&g->moves[i], f.u, NULL);
    for (int i = 0; i < g->count; each += 3 * g->parts[i++].vertices)
        if (g->parts[i].moves)
            largest = fmax(largest, displace(g, &g->parts[i], &f, each));
    f.high = f.value ? f.high : largest;
    f.low = f.value ? f.low : 0;
    unsigned char *at = put_u32(put_u32(put_u32(m->bytes, KIND_POSITIONS), f.index), moving);
    each = d;
    for (int i = 0; i < g->count; each += 3 * g->parts[i++].vertices)
        if (g->parts[i].moves)
            at = put_part(g, i, &f, each, at);
    free(d);
    return m;
}
