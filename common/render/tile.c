#include "render/tile.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* A pixel as its centre sees it. */
typedef struct sight {
    surface surface;
    float pixel, finer; /* m a pixel there, and its inverse */
    float open, key;    /* of the few rays of its own: shares of the ambient and of the key light that come through */
    float ambient, lit; /* the same, averaged with its like */
} sight;

/* What lies before it that is transparent: premultiplied, and how much shows through. */
typedef struct veil {
    vec colour;
    float through;
} veil;

/* Pixels that wait for a packet of rays of one class. */
typedef struct queue {
    int count;
    int pixel[EMBREE_RAYS];
} queue;

struct tile {
    sight sight[TILE_WIDTH * TILE_WIDTH];
    veil veil[TILE_WIDTH * TILE_WIDTH];
    queue queue[VIEW_CLASSES];
    int refine[EMBREE_RAYS / VIEW_SUBPIXELS], refining;
    int left, top; /* of the rim */
    const view *view;
    image *image;
    tile_count count;
};

tile *tile_create(err *e)
{
    return mem_array(1, sizeof(tile), "a part of a picture", e);
}

void tile_destroy(tile *t)
{
    free(t);
}

/* ---- rays from the eye */

/* Rays through places in the picture, and what they meet behind all that is transparent. */
static void look(tile *t, const float *x, const float *y, unsigned valid, surface *met, veil *before)
{
    const view *v = t->view;
    embree_packet p;
    embree_packet_clear(&p);
    for (int i = 0; i < EMBREE_RAYS; i++) {
        vec from, along;
        view_ray(v, x[i], y[i], &from, &along);
        p.from[0][i] = from.x;
        p.from[1][i] = from.y;
        p.from[2][i] = from.z;
        p.along[0][i] = along.x;
        p.along[1][i] = along.y;
        p.along[2][i] = along.z;
        before[i] = (veil){{0, 0, 0}, 1};
    }
    for (int layer = 0; valid && layer < VIEW_LAYERS; layer++) {
        embree_nearest(v->all, valid, &p, true);
        for (int i = 0; i < EMBREE_RAYS; i++) {
            if (!(valid >> i & 1))
                continue;
            surface_met(v, &p, i, x[i], y[i], &met[i]);
            t->count.rays++;
            float transparency = met[i].geometry == EMBREE_NONE ? 0 : surface_transparency(v, &met[i]);
            if (!(transparency > 0)) {
                valid &= ~(1u << i);
                continue;
            }
            transparency *= 1 - met[i].line;
            before[i].colour =
                vec_along(before[i].colour, surface_shade(v, &met[i], 1, 1), before[i].through * (1 - transparency));
            before[i].through *= transparency;
            met[i].geometry = p.geometry[i] = EMBREE_NONE;
            p.start[i] = p.end[i] * (1 + 1e-6f) + v->offset;
            p.end[i] = INFINITY;
        }
    }
}

static void set_pixel(sight *s, float size)
{
    s->pixel = size;
    s->finer = 1 / size;
}

static void look_at_block(tile *t, int column, int row)
{
    float x[EMBREE_RAYS], y[EMBREE_RAYS];
    surface met[EMBREE_RAYS];
    veil before[EMBREE_RAYS];
    for (int i = 0; i < EMBREE_RAYS; i++) {
        int right = t->left + column + i % VIEW_CELL, down = t->top + row + i / VIEW_CELL;
        x[i] = (float)right + .5f;
        y[i] = (float)down + .5f;
    }
    look(t, x, y, (1u << EMBREE_RAYS) - 1, met, before);
    for (int i = 0; i < EMBREE_RAYS; i++) {
        int at = (row + i / VIEW_CELL) * TILE_WIDTH + column + i % VIEW_CELL;
        sight *s = &t->sight[at];
        s->surface = met[i];
        t->veil[at] = before[i];
        s->open = s->key = s->ambient = s->lit = 1;
        if (met[i].geometry != EMBREE_NONE)
            set_pixel(s, view_pixel(t->view, met[i].place));
    }
}

/* ---- how much light reaches a place */

/* Where the rays of a queue's pixels begin, lifted off their surfaces, and the frames about their normals, number by
 * number for all, so that loops over them run in vector registers. */
typedef struct bundle {
    float from[3][EMBREE_RAYS], flat[3][EMBREE_RAYS], normal[3][EMBREE_RAYS];
    bool coherent; /* the normals are much the same, and so the rays about them */
} bundle;

static void gather(const tile *t, const queue *q, bundle *b)
{
    vec sum = {0, 0, 0};
    memset(b, 0, sizeof *b);
    for (int i = 0; i < q->count; i++) {
        const sight *s = &t->sight[q->pixel[i]];
        const surface *on = &s->surface;
        vec from = vec_along(on->place, on->flat, t->view->offset + .02f * s->pixel);
        const vec part[3] = {from, on->flat, on->normal};
        float(*const column[3])[EMBREE_RAYS] = {b->from, b->flat, b->normal};
        for (int k = 0; k < 3; k++) {
            column[k][0][i] = part[k].x;
            column[k][1][i] = part[k].y;
            column[k][2][i] = part[k].z;
        }
        sum = vec_add(sum, on->normal);
    }
    b->coherent = vec_dot(sum, sum) > .9f * (float)(q->count * q->count);
}

/* Directions about +z as such about each normal. The frame comes from the normal in the eye's axes, where it is toward
 * the eye mostly and the frame turns smoothly with it (after Duff et al., Building an Orthonormal Basis, Revisited,
 * 2017). Those that then run into the face itself are mirrored out of it. */
static void turn_about(const view *v, const bundle *b, vec d, embree_packet *p)
{
    const vec r = v->unit_right, u = v->unit_up, f = v->forward;
    for (int i = 0; i < EMBREE_RAYS; i++) {
        float x = b->normal[0][i], y = b->normal[1][i], z = b->normal[2][i];
        float nx = x * r.x + y * r.y + z * r.z, ny = x * u.x + y * u.y + z * u.z, nz = -(x * f.x + y * f.y + z * f.z);
        float sign = nz < 0 ? -1.f : 1.f, a = -1 / (sign + nz), c = nx * ny * a;
        float dx = d.x * (1 + sign * nx * nx * a) + d.y * c + d.z * nx;
        float dy = d.x * sign * c + d.y * (sign + ny * ny * a) + d.z * ny;
        float dz = d.x * sign * nx + d.y * ny - d.z * nz;
        x = dx * r.x + dy * u.x + dz * f.x;
        y = dx * r.y + dy * u.y + dz * f.y;
        z = dx * r.z + dy * u.z + dz * f.z;
        float under = x * b->flat[0][i] + y * b->flat[1][i] + z * b->flat[2][i];
        float mirror = under < 0 ? -2 * under : 0;
        p->along[0][i] = x + mirror * b->flat[0][i];
        p->along[1][i] = y + mirror * b->flat[1][i];
        p->along[2][i] = z + mirror * b->flat[2][i];
    }
}

/* How many of the packet's rays come through, bit by bit. */
static unsigned come_through(tile *t, unsigned valid, embree_packet *p, bool coherent)
{
    unsigned through = 0;
    embree_blocked(t->view->solid, valid, p, coherent);
    for (int i = 0; i < EMBREE_RAYS; i++)
        through |= (unsigned)(p->end[i] > 0) << i;
    t->count.rays += EMBREE_RAYS;
    return through;
}

static void open_near(tile *t, const queue *q, const bundle *b, unsigned valid, int class)
{
    const view *v = t->view;
    int open[EMBREE_RAYS] = {0};
    embree_packet p;
    embree_packet_clear(&p);
    memcpy(p.from, b->from, sizeof p.from);
    for (int k = 0; k < VIEW_NEAR; k++) {
        turn_about(v, b, v->near_by[class][k], &p);
        for (int i = 0; i < EMBREE_RAYS; i++)
            p.end[i] = v->reach * v->near_length[class][k];
        unsigned through = come_through(t, valid, &p, b->coherent);
        for (int i = 0; i < EMBREE_RAYS; i++)
            open[i] += (int)(through >> i & 1);
    }
    for (int i = 0; i < q->count; i++)
        t->sight[q->pixel[i]].open = (float)open[i] / VIEW_NEAR;
}

static void reach_lamp(tile *t, const queue *q, const bundle *b, unsigned valid, int class)
{
    const vec lamp = t->view->lamp[class];
    embree_packet p;
    embree_packet_clear(&p);
    memcpy(p.from, b->from, sizeof p.from);
    for (int i = 0; i < EMBREE_RAYS; i++) {
        p.along[0][i] = lamp.x;
        p.along[1][i] = lamp.y;
        p.along[2][i] = lamp.z;
    }
    unsigned through = come_through(t, valid, &p, true);
    for (int i = 0; i < q->count; i++)
        t->sight[q->pixel[i]].key = (float)(through >> i & 1);
}

static void flush(tile *t, int class)
{
    const trace_options *o = t->view->options;
    queue *q = &t->queue[class];
    unsigned valid = (1u << q->count) - 1;
    if (!valid)
        return;
    bundle b;
    gather(t, q, &b);
    if (o->occlusion > 0 && !o->draft)
        open_near(t, q, &b, valid, class);
    if (o->shadows)
        reach_lamp(t, q, &b, valid, class);
    q->count = 0;
}

static void enqueue(tile *t, int at, int class)
{
    queue *q = &t->queue[class];
    if (t->sight[at].surface.geometry == EMBREE_NONE)
        return;
    q->pixel[q->count++] = at;
    if (q->count == EMBREE_RAYS)
        flush(t, class);
}

/* Pixels of one place in the cells send their rays in one direction, in packets that lie close together: within squares
 * of the picture as large as a packet has of them. */
static void light_all(tile *t)
{
    enum { SQUARE = VIEW_CELL * VIEW_CELL, FROM = TILE_RIM - 2, TO = TILE_WIDTH - TILE_RIM + 3 };
    for (int row = FROM; row < TO; row += SQUARE)
        for (int column = FROM; column < TO; column += SQUARE)
            for (int y = row; y < TO && y < row + SQUARE; y++)
                for (int x = column; x < TO && x < column + SQUARE; x++)
                    enqueue(t, y * TILE_WIDTH + x,
                            (t->top + y + VIEW_CELL) % VIEW_CELL * VIEW_CELL + (t->left + x + VIEW_CELL) % VIEW_CELL);
    for (int class = 0; class < VIEW_CLASSES; class ++)
        flush(t, class);
}

/* Whether b goes on from a much as a plane would. */
static bool alike(const sight *a, const surface *b, float slack, float turn)
{
    return b->geometry != EMBREE_NONE && vec_dot(a->surface.normal, b->normal) > turn &&
           fabsf(vec_dot(a->surface.flat, vec_sub(b->place, a->surface.place))) < slack * a->pixel;
}

/* The mean over the cell about a pixel, of what is like it. */
static void average(tile *t, int at)
{
    sight *s = &t->sight[at];
    float open = 0, key = 0, count = 0;
    for (int dy = -1; dy < VIEW_CELL - 1; dy++)
        for (int dx = -1; dx < VIEW_CELL - 1; dx++) {
            const sight *n = &t->sight[at + dy * TILE_WIDTH + dx];
            if (!alike(s, &n->surface, 4, .85f))
                continue;
            open += n->open;
            key += n->key;
            count++;
        }
    s->ambient = 1 - (float)t->view->options->occlusion * (1 - open / count);
    s->lit = key / count;
}

static void average_all(tile *t)
{
    for (int y = TILE_RIM - 1; y < TILE_WIDTH - TILE_RIM + 1; y++)
        for (int x = TILE_RIM - 1; x < TILE_WIDTH - TILE_RIM + 1; x++)
            if (t->sight[y * TILE_WIDTH + x].surface.geometry != EMBREE_NONE)
                average(t, y * TILE_WIDTH + x);
}

/* ---- colours */

static void compose(const view *v, const surface *s, const veil *before, float ambient, float key, float share,
                    float *rgba)
{
    const float *ground = v->options->background;
    vec behind = vec_of(ground);
    float alpha = ground[3];
    if (s->geometry != EMBREE_NONE) {
        behind = surface_shade(v, s, ambient, key);
        alpha = 1;
    }
    vec c = vec_along(before->colour, behind, before->through);
    rgba[0] += share * c.x;
    rgba[1] += share * c.y;
    rgba[2] += share * c.z;
    rgba[3] += share * (1 - before->through + before->through * alpha);
}

static float *pixel_of(const tile *t, int at)
{
    int x = t->left + at % TILE_WIDTH, y = t->top + at / TILE_WIDTH;
    return &t->image->pixel[4 * ((int64_t)y * t->image->width + x)];
}

/* The pixel or neighbour that a place seen within it is most like: its light is taken for the place. */
static const sight *likest(const tile *t, int at, const surface *s)
{
    static const int beside[9] = {
        0, -1, 1, -TILE_WIDTH, TILE_WIDTH, -TILE_WIDTH - 1, -TILE_WIDTH + 1, TILE_WIDTH - 1, TILE_WIDTH + 1};
    const float good = .2f;
    const sight *best = NULL;
    float least = INFINITY;
    for (int k = 0; k < 9 && least > good; k++) {
        const sight *n = &t->sight[at + beside[k]];
        if (n->surface.geometry == EMBREE_NONE)
            continue;
        vec apart = vec_scale(vec_sub(s->place, n->surface.place), n->finer);
        float badness = 8 * (1 - vec_dot(n->surface.normal, s->normal)) + fabsf(vec_dot(n->surface.flat, apart)) +
                        .05f * vec_dot(apart, apart);
        if (badness < least) {
            least = badness;
            best = n;
        }
    }
    return best;
}

/* The pixels that wait, by several rays each. */
static void refine(tile *t)
{
    const view *v = t->view;
    float x[EMBREE_RAYS], y[EMBREE_RAYS];
    unsigned valid = 0;
    surface met[EMBREE_RAYS];
    veil before[EMBREE_RAYS];
    for (int i = 0; i < EMBREE_RAYS; i++) {
        int k = i / VIEW_SUBPIXELS, at = t->refine[k < t->refining ? k : 0];
        int right = t->left + at % TILE_WIDTH, down = t->top + at / TILE_WIDTH;
        x[i] = (float)right + v->subpixel[i % VIEW_SUBPIXELS][0];
        y[i] = (float)down + v->subpixel[i % VIEW_SUBPIXELS][1];
        valid |= (unsigned)(k < t->refining) << i;
    }
    look(t, x, y, valid, met, before);
    for (int k = 0; k < t->refining; k++) {
        float rgba[4] = {0, 0, 0, 0};
        for (int i = k * VIEW_SUBPIXELS; i < (k + 1) * VIEW_SUBPIXELS; i++) {
            const sight *s = met[i].geometry == EMBREE_NONE ? NULL : likest(t, t->refine[k], &met[i]);
            const float ambient = s ? s->ambient : 1;
            compose(v, &met[i], &before[i], ambient, s ? s->lit : 1, 1.f / VIEW_SUBPIXELS, rgba);
        }
        memcpy(pixel_of(t, t->refine[k]), rgba, sizeof rgba);
    }
    t->refining = 0;
}

static bool differ(vec a, vec b)
{
    return fabsf(a.x - b.x) > .03f || fabsf(a.y - b.y) > .03f || fabsf(a.z - b.z) > .03f;
}

/* Whether something ends between two neighbours. */
static bool border(const tile *t, int a, int b)
{
    const sight *s = &t->sight[a], *n = &t->sight[b];
    const veil *before = &t->veil[a], *beside = &t->veil[b];
    if (t->view->solid != t->view->all &&
        (fabsf(before->through - beside->through) > .02f || differ(before->colour, beside->colour)))
        return true;
    if (s->surface.geometry == EMBREE_NONE)
        return n->surface.geometry != EMBREE_NONE;
    return !alike(s, &n->surface, 1.5f, .97f) || differ(s->surface.colour, n->surface.colour);
}

static void finish(tile *t, int at)
{
    const sight *s = &t->sight[at];
    t->count.covered += s->surface.geometry != EMBREE_NONE || t->veil[at].through < 1;
    if (!t->view->options->draft && (border(t, at, at - 1) || border(t, at, at + 1) || border(t, at, at - TILE_WIDTH) ||
                                     border(t, at, at + TILE_WIDTH))) {
        t->refine[t->refining++] = at;
        if (t->refining == EMBREE_RAYS / VIEW_SUBPIXELS)
            refine(t);
        return;
    }
    float rgba[4] = {0, 0, 0, 0};
    compose(t->view, &s->surface, &t->veil[at], s->ambient, s->lit, 1, rgba);
    memcpy(pixel_of(t, at), rgba, sizeof rgba);
}

tile_count tile_draw(tile *t, const view *v, int left, int top, image *im)
{
    t->view = v;
    t->image = im;
    t->left = left - TILE_RIM;
    t->top = top - TILE_RIM;
    t->count = (tile_count){0};
    for (int row = 0; row < TILE_WIDTH; row += VIEW_CELL)
        for (int column = 0; column < TILE_WIDTH; column += VIEW_CELL)
            look_at_block(t, column, row);
    if ((v->options->occlusion > 0 && !v->options->draft) || v->options->shadows) {
        light_all(t);
        average_all(t);
    }
    for (int y = TILE_RIM; y < TILE_RIM + TILE_SIDE && t->top + y < im->height; y++)
        for (int x = TILE_RIM; x < TILE_RIM + TILE_SIDE && t->left + x < im->width; x++)
            finish(t, y * TILE_WIDTH + x);
    if (t->refining)
        refine(t);
    return t->count;
}
