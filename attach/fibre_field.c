#include "fibre_field.h"

#include "attach/shape/laplace.h"
#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double last_part = 0.05, most_part = 0.15, least_voxels = 1.5, end_depth = 0.4, far_side = 0.5,
                    least_share = 0.1;
static const double least_conduction = 1e-3; /* of an element of which hardly anything is its own */

struct field {
    const body *b;
    double spacing[3], voxel; /* its longest side */
    int32_t *local;           /* nodes: number in the muscle at hand, -1 = none */
};

enum { END_NONE, END_FIRST, END_SECOND };

/* What is known of a connected component, stored at the first of its nodes. */
typedef struct piece {
    int32_t first, second; /* attachments, -1 = none */
    double most;           /* the highest potential */
    double volume;         /* m3 */
    double high;           /* the furthest place, by whatever is looked for */
    int64_t nodes, furthest;
    struct {
        double way, place[3], count; /* sums over its nodes */
    } slice[3];                      /* of the far end: the last, the one before, and the one before that */
    double out[3];                   /* unit: the way out of it; before: the piece's middle */
} piece;

struct muscle_field {
    const field *f;
    int32_t volume;
    const double *axis;     /* along which a piece without an attachment begins; NULL: where it is furthest out */
    const int64_t *element; /* its elements in the body */
    int64_t elements, nodes, capacity;
    int32_t *corner; /* elements x 8: local nodes */
    int32_t *node;   /* nodes: in the body */
    int32_t *part;   /* nodes: the attachment, -1 = none */
    int32_t *root;   /* nodes: the first of the piece */
    float *share;    /* elements; NULL: all are whole */
    bool *held;
    uint8_t *end;
    double *u;
    double *way;       /* nodes: how far along, 0 to 1 */
    double *direction; /* elements x 3 */
    double *mean;      /* nodes x 3 */
    piece *of;         /* nodes: at roots */
    laplace *potential;
};

field *field_create(const body *b, const double *spacing, err *e)
{
    field *f = mem_array(1, sizeof *f, "fibres", e);
    if (!f)
        return NULL;
    *f = (field){.b = b};
    for (int a = 0; a < 3; a++) {
        f->spacing[a] = spacing[a];
        f->voxel = fmax(f->voxel, spacing[a]);
    }
    f->local = mem_array(b->nodes, sizeof *f->local, "fibres", e);
    if (!f->local) {
        field_free(f);
        return NULL;
    }
    for (int64_t n = 0; n < b->nodes; n++)
        f->local[n] = -1;
    return f;
}

void field_free(field *f)
{
    if (!f)
        return;
    free(f->local);
    free(f);
}

/* ---- the muscle's nodes and pieces */

static int number_nodes(muscle_field *m, err *e)
{
    const body *b = m->f->b;
    for (int64_t i = 0; i < 8 * m->elements; i++) {
        int32_t node = b->node[8 * m->element[i / 8] + i % 8];
        if (m->f->local[node] < 0) {
            if (mem_grow(&m->node, &m->capacity, m->nodes + 1, sizeof *m->node, "fibres", e))
                return -1;
            m->f->local[node] = (int32_t)m->nodes;
            m->node[m->nodes++] = node;
        }
        m->corner[i] = m->f->local[node];
    }
    return 0;
}

static void find_pieces(muscle_field *m)
{
    for (int64_t n = 0; n < m->nodes; n++)
        m->root[n] = (int32_t)n;
    for (int64_t i = 0; i < 8 * m->elements; i++)
        body_join(m->root, m->corner[i], m->corner[i - i % 8]);
    for (int64_t n = 0; n < m->nodes; n++) {
        m->root[n] = body_root(m->root, (int32_t)n);
        m->of[n] = (piece){.first = -1, .second = -1, .high = -INFINITY};
    }
    for (int64_t i = 0; i < m->elements; i++)
        m->of[m->root[m->corner[8 * i]]].volume +=
            body_share(m->f->b, m->element[i], m->volume) * m->f->spacing[0] * m->f->spacing[1] * m->f->spacing[2];
}

/* The attachments of the nodes; takes the marks off them. */
static int take_parts(muscle_field *m, err *e)
{
    m->part = mem_array(m->nodes, sizeof *m->part, "fibres", e);
    for (int64_t n = 0; n < m->nodes; n++) {
        m->f->local[m->node[n]] = -1;
        if (m->part)
            m->part[n] = m->f->b->part[m->node[n]];
    }
    return m->part ? 0 : -1;
}

muscle_field *field_open(field *f, int32_t volume, err *e)
{
    const body *b = f->b;
    muscle_field *m = mem_array(1, sizeof *m, "fibres", e);
    if (!m)
        return NULL;
    *m = (muscle_field){.f = f,
                        .volume = volume,
                        .element = &b->element[b->start[volume]],
                        .elements = b->start[volume + 1] - b->start[volume]};
    m->corner = mem_array(8 * m->elements, sizeof *m->corner, "fibres", e);
    const int failed = m->corner ? number_nodes(m, e) : -1;
    if (!take_parts(m, e) && !failed)
        return m;
    field_close(m);
    return NULL;
}

/* What the fibres are computed with. */
static int make_room(muscle_field *m, pool *threads, err *e)
{
    const body *b = m->f->b;
    m->direction = mem_array(3 * m->elements, sizeof *m->direction, "fibres", e);
    m->root = m->direction ? mem_array(m->nodes, sizeof *m->root, "fibres", e) : NULL;
    m->held = m->root ? mem_array(m->nodes, sizeof *m->held, "fibres", e) : NULL;
    m->end = m->held ? mem_array(m->nodes, sizeof *m->end, "fibres", e) : NULL;
    m->u = m->end ? mem_array(m->nodes, sizeof *m->u, "fibres", e) : NULL;
    m->way = m->u ? mem_array(m->nodes, sizeof *m->way, "fibres", e) : NULL;
    m->mean = m->way ? mem_array(3 * m->nodes, sizeof *m->mean, "fibres", e) : NULL;
    m->of = m->mean ? mem_array(m->nodes, sizeof *m->of, "fibres", e) : NULL;
    if (!m->of)
        return -1;
    find_pieces(m);
    bool shares = body_has_shares(b);
    m->share = shares ? mem_array(m->elements, sizeof *m->share, "fibres", e) : NULL;
    if (shares && !m->share)
        return -1;
    for (int64_t i = 0; m->share && i < m->elements; i++)
        m->share[i] = (float)fmax(body_share(b, m->element[i], m->volume), least_conduction);
    m->potential = laplace_create(threads, m->f->spacing, m->corner, m->elements, m->nodes, m->share, e);
    return m->potential ? 0 : -1;
}

void field_close(muscle_field *m)
{
    if (!m)
        return;
    laplace_free(m->potential);
    free(m->corner);
    free(m->node);
    free(m->part);
    free(m->root);
    free(m->share);
    free(m->held);
    free(m->end);
    free(m->u);
    free(m->way);
    free(m->direction);
    free(m->mean);
    free(m->of);
    free(m);
}

static piece *piece_of(const muscle_field *m, int64_t n)
{
    return &m->of[m->root[n]];
}

static int32_t part_of(const muscle_field *m, int64_t n)
{
    return m->part[n];
}

static bool make_unit(double *v, double least)
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int a = 0; a < 3; a++)
        v[a] = length > least ? v[a] / length : 0;
    return length > least;
}

/* ---- the ends */

static double toward(const muscle_field *m, int64_t n, const double *axis)
{
    const double *x = &m->f->b->position[3 * (int64_t)m->node[n]];
    return axis[0] * x[0] + axis[1] * x[1] + axis[2] * x[2];
}

/* The squared distance from node n to another place, m2. */
static double apart(const muscle_field *m, int64_t n, const double *place)
{
    const double *x = &m->f->b->position[3 * (int64_t)m->node[n]];
    double d[3] = {x[0] - place[0], x[1] - place[1], x[2] - place[2]};
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/* The node of each piece that is furthest along the axis, or else from its middle. */
static void find_furthest(muscle_field *m)
{
    for (int64_t n = 0; n < m->nodes; n++) {
        piece *p = piece_of(m, n);
        p->nodes++;
        for (int a = 0; a < 3; a++)
            p->out[a] += m->f->b->position[3 * (int64_t)m->node[n] + a];
    }
    for (int64_t n = 0; n < m->nodes; n++)
        for (int a = 0; a < 3 && m->root[n] == n; a++)
            m->of[n].out[a] /= (double)m->of[n].nodes;
    for (int64_t n = 0; n < m->nodes; n++) {
        piece *p = piece_of(m, n);
        const double far = m->axis ? toward(m, n, m->axis) : apart(m, n, p->out);
        if (far > p->high) {
            p->high = far;
            p->furthest = n;
        }
    }
}

/* Sets the first end of each component: its largest attachment (attachments are numbered from the largest), or, where
 * it has none, the nodes about the one that is furthest out. Returns whether every component has one. */
static bool find_first(muscle_field *m)
{
    bool all = true;
    double reach = m->f->voxel * m->f->voxel;
    for (int64_t n = 0; n < m->nodes; n++) {
        piece *p = piece_of(m, n);
        int32_t part = part_of(m, n);
        if (part >= 0 && (p->first < 0 || part < p->first))
            p->first = part;
    }
    find_furthest(m);
    for (int64_t n = 0; n < m->nodes; n++) {
        const piece *p = piece_of(m, n);
        const double *from = &m->f->b->position[3 * (int64_t)m->node[p->furthest]];
        bool is = p->first < 0 ? apart(m, n, from) <= reach : part_of(m, n) == p->first;
        m->end[n] = is ? END_FIRST : END_NONE;
        all = all && p->first >= 0;
    }
    return all;
}

/* How far along the muscle each node is, from the first end. */
static int find_way(muscle_field *m, err *e)
{
    for (int64_t n = 0; n < m->nodes; n++) {
        m->held[n] = m->end[n] == END_FIRST;
        m->u[n] = 0;
        piece_of(m, n)->most = 0;
    }
    if (laplace_solve(m->potential, m->held, 1, m->u, e))
        return -1;
    for (int64_t n = 0; n < m->nodes; n++)
        piece_of(m, n)->most = fmax(piece_of(m, n)->most, m->u[n]);
    for (int64_t n = 0; n < m->nodes; n++) {
        double most = piece_of(m, n)->most;
        m->way[n] = most > 0 ? 1 - sqrt(fmax(1 - m->u[n] / most, 0)) : 0;
    }
    return 0;
}

static double length_of(const piece *p)
{
    return sqrt(2 * p->most);
}

/* The radius of a rod of the same volume and length. */
static double width_of(const piece *p)
{
    return sqrt(p->volume / (M_PI * length_of(p)));
}

/* How long a slice of the far end is, of the whole way. */
static double slice_of(const muscle_field *m, const piece *p)
{
    return fmin(fmax(last_part, fmax(least_voxels * m->f->voxel, width_of(p)) / length_of(p)), most_part);
}

/* Which slice a node is in, 0 the last; -1: none. */
static int slice_at(const muscle_field *m, int64_t n)
{
    const piece *p = piece_of(m, n);
    double at = p->most > 0 ? (1 - m->way[n]) / slice_of(m, p) : INFINITY;
    return at < 3 ? (int)at : -1;
}

/* The way on from the slices' middles, at the end of a parabola through them; where
 * one is empty, from what there is. */
static void find_out(piece *p)
{
    double s[3], slope[3];
    for (int i = 0; i < 3; i++)
        s[i] = p->slice[i].way / p->slice[i].count;
    for (int i = 0; i < 3; i++)
        slope[i] = (2 - s[(i + 1) % 3] - s[(i + 2) % 3]) / ((s[i] - s[(i + 1) % 3]) * (s[i] - s[(i + 2) % 3]));
    for (int a = 0; a < 3; a++) {
        p->out[a] = 0;
        for (int i = 0; i < 3; i++)
            p->out[a] += slope[i] * p->slice[i].place[a] / p->slice[i].count;
    }
    make_unit(p->out, 0);
}

/* The far end of a component: the nodes that lie furthest out, in the direction in which the middles of its last slices
 * go on. The highest potential alone would be on the outer side of a bend. */
static void find_far(muscle_field *m)
{
    for (int64_t n = 0; n < m->nodes; n++)
        memset(m->of[n].slice, 0, sizeof m->of[n].slice);
    for (int64_t n = 0; n < m->nodes; n++) {
        int i = slice_at(m, n);
        piece *p = piece_of(m, n);
        for (int a = 0; i >= 0 && a < 3; a++)
            p->slice[i].place[a] += m->f->b->position[3 * (int64_t)m->node[n] + a];
        if (i >= 0) {
            p->slice[i].way += m->way[n];
            p->slice[i].count++;
        }
    }
    for (int64_t n = 0; n < m->nodes; n++)
        if (m->root[n] == n && m->of[n].most > 0) {
            find_out(&m->of[n]);
            m->of[n].high = -INFINITY;
        }
    for (int64_t n = 0; n < m->nodes; n++)
        if (slice_at(m, n) >= 0)
            piece_of(m, n)->high = fmax(piece_of(m, n)->high, toward(m, n, piece_of(m, n)->out));
}

static bool is_last(const muscle_field *m, int64_t n)
{
    const piece *p = piece_of(m, n);
    return slice_at(m, n) >= 0 &&
           toward(m, n, p->out) >= p->high - fmax(least_voxels * m->f->voxel, end_depth * width_of(p));
}

/* Where there is no attachment, the far end is the first, from then on. */
static void turn_round(muscle_field *m)
{
    find_far(m);
    for (int64_t n = 0; n < m->nodes; n++)
        if (piece_of(m, n)->first < 0)
            m->end[n] = is_last(m, n) ? END_FIRST : END_NONE;
}

static int find_second(muscle_field *m, const attachment *of, int64_t count, err *e)
{
    double *way = mem_array(count, sizeof *way, "attachments", e);
    if (!way)
        return -1;
    for (int64_t n = 0; n < m->nodes; n++)
        if (part_of(m, n) >= 0)
            way[part_of(m, n)] += m->way[n] / (double)of[part_of(m, n)].nodes;
    for (int64_t n = 0; n < m->nodes; n++) {
        piece *p = piece_of(m, n);
        int32_t part = part_of(m, n);
        if (part >= 0 && part != p->first && (p->second < 0 || part < p->second) && way[part] >= far_side &&
            (double)of[part].nodes >= least_share * (double)of[p->first].nodes)
            p->second = part;
    }
    find_far(m);
    for (int64_t n = 0; n < m->nodes; n++) {
        const piece *p = piece_of(m, n);
        if (m->end[n] == END_NONE && (p->second >= 0 ? part_of(m, n) == p->second : is_last(m, n)))
            m->end[n] = END_SECOND;
    }
    free(way);
    return 0;
}

/* ---- directions */

/* The directions of the gradient, toward the first end. What is a thousandth of the mean has none. */
static int find_directions(muscle_field *m, err *e)
{
    for (int64_t n = 0; n < m->nodes; n++) {
        m->held[n] = m->end[n] != END_NONE;
        m->u[n] = m->end[n] == END_SECOND;
    }
    if (laplace_solve(m->potential, m->held, 0, m->u, e))
        return -1;
    for (int64_t i = 0; i < m->elements; i++) {
        double *d = &m->direction[3 * i], length = length_of(piece_of(m, m->corner[8 * i]));
        laplace_gradient(m->potential, i, m->u, d);
        for (int a = 0; a < 3; a++)
            d[a] = -d[a];
        make_unit(d, length > 0 ? 1e-3 / length : 0);
    }
    return 0;
}

static bool has_direction(const muscle_field *m, int64_t i)
{
    const double *d = &m->direction[3 * i];
    return d[0] != 0 || d[1] != 0 || d[2] != 0;
}

/* Means at nodes, then of those in each element, or (lacking) only in those that have none.
 * Returns how many changed from none to some. */
static int64_t spread(muscle_field *m, bool lacking)
{
    int64_t gained = 0;
    memset(m->mean, 0, 3 * (size_t)m->nodes * sizeof *m->mean);
    for (int64_t i = 0; i < 24 * m->elements; i++)
        m->mean[3 * m->corner[i / 3] + i % 3] += (m->share ? m->share[i / 24] : 1) * m->direction[3 * (i / 24) + i % 3];
    for (int64_t n = 0; n < m->nodes; n++)
        make_unit(&m->mean[3 * n], 1e-9);
    for (int64_t i = 0; i < m->elements; i++) {
        bool had = has_direction(m, i);
        double sum[3] = {0};
        for (int c = 0; c < 24; c++)
            sum[c % 3] += m->mean[3 * m->corner[8 * i + c / 3] + c % 3];
        if ((had && lacking) || !make_unit(sum, 1e-9))
            continue;
        memcpy(&m->direction[3 * i], sum, sizeof sum);
        gained += !had;
    }
    return gained;
}

int field_fibres(muscle_field *m, pool *threads, const attachment *of, int64_t count, const double *axis, err *e)
{
    m->axis = axis;
    if (make_room(m, threads, e))
        return -1;
    if (!find_first(m)) {
        if (find_way(m, e))
            return -1;
        turn_round(m);
    }
    if (find_way(m, e) || find_second(m, of, count, e) || find_directions(m, e))
        return -1;
    spread(m, false);
    while (spread(m, true))
        ;
    for (int64_t i = 0; i < 3 * m->elements; i++)
        body_fibre(m->f->b, m->element[i / 3], m->volume)[i % 3] = (float)m->direction[i];
    return 0;
}
