#include "slice/image/slice_cutter.h"

#include "base/mem.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { NODES = 1024, TETS = 128 * SLICE_GROUP, PIECES = 64 }; /* of a chunk */

typedef struct scratch {
    slice_places places;
    int32_t *memory;
    atomic_flag busy;
} scratch;

/* Regions; none where end is not above first. */
typedef struct reach {
    int32_t first, end;
} reach;

struct slice_cutter {
    slice_setup s;
    slice_projection projection;
    slice_tets tets;
    slice_node *at; /* nodes */
    uint8_t *code;
    const double *displacement;
    int32_t *list;  /* tetrahedra that may meet the image; by chunks first, then all in a row */
    int64_t *chunk; /* how many a chunk has */
    int64_t count;
    void *piece; /* slice_piece or slice_paper_tet: of the list */
    int64_t room;
    reach *reach; /* the regions of each, close together */
    int64_t reach_room;
    int32_t *region; /* lists of the regions, one after another: indices of pieces */
    int64_t region_room;
    int64_t *start; /* regions + 1: where each begins */
    int32_t rows;   /* of a region */
    scratch *scratch;
    int scratches;
    slice_fill fill;
    uint8_t *image;
    int32_t *owner;
    slice_more *more;
    void *context;
};

/* ---- making one */

static int make_scratch(slice_cutter *c, scratch *s, err *e)
{
    int32_t stride = (c->s.size.columns + SLICE_LANES - 1) / SLICE_LANES * SLICE_LANES;
    int64_t size = (int64_t)stride * c->rows;
    s->memory = mem_array(4 * size + SLICE_LANES, sizeof *s->memory, "rows of an image", e);
    if (!s->memory)
        return -1;
    s->places = (slice_places){.stride = stride};
    for (int a = 0; a < 3; a++)
        s->places.at[a] = s->memory + a * size;
    s->places.owner = s->memory + 3 * size;
    atomic_flag_clear(&s->busy);
    return 0;
}

static int make_mesh(slice_cutter *c, err *e)
{
    const slice_mesh *m = c->s.mesh;
    c->at = mem_array(m->nodes, sizeof *c->at, "nodes", e);
    c->code = c->at ? mem_array(m->nodes, sizeof *c->code, "nodes", e) : NULL;
    c->list = c->code ? mem_array(m->tets, sizeof *c->list, "tetrahedra", e) : NULL;
    c->chunk = c->list ? mem_array(pool_chunks(m->tets, TETS), sizeof *c->chunk, "tetrahedra", e) : NULL;
    c->tets = (slice_tets){m->node, m->group, m->start, m->place, c->at, c->code};
    return c->chunk ? 0 : -1;
}

/* A piece of memory for each thread, so that none waits. */
static int make_scratches(slice_cutter *c, err *e)
{
    const int threads = pool_threads(c->s.threads);
    c->scratch = mem_array(threads, sizeof *c->scratch, "rows of an image", e);
    if (!c->scratch)
        return -1;
    for (; c->scratches < threads; c->scratches++)
        if (make_scratch(c, &c->scratch[c->scratches], e))
            return -1;
    return 0;
}

slice_cutter *slice_cutter_make(const slice_setup *s, err *e)
{
    slice_cutter *c = mem_array(1, sizeof *c, "an image", e);
    if (!c)
        return NULL;
    c->s = *s;
    c->s.regions = s->regions < s->size.rows ? s->regions : s->size.rows;
    c->rows = (s->size.rows + c->s.regions - 1) / c->s.regions;
    c->start = mem_array(c->s.regions + 1, sizeof *c->start, "regions", e);
    if (!c->start || make_scratches(c, e) || (s->mesh && make_mesh(c, e))) {
        slice_cutter_free(c);
        return NULL;
    }
    c->fill = (slice_fill){.shown = s->shown, .all = true, .black = s->cells->black};
    for (int32_t r = 0; r < s->size.rows; r++)
        c->fill.all &= s->shown[r].from[0] == 0 && s->shown[r].to[0] == s->size.columns;
    for (int a = 0; a < 3; a++)
        c->fill.end[a] = (s->cells->size[a] + .5) * SLICE_ONE;
    return c;
}

void slice_cutter_free(slice_cutter *c)
{
    if (!c)
        return;
    for (int i = 0; c->scratch && i < pool_threads(c->s.threads); i++)
        free(c->scratch[i].memory);
    free(c->scratch);
    free(c->start);
    free(c->region);
    free(c->piece);
    free(c->reach);
    free(c->chunk);
    free(c->list);
    free(c->code);
    free(c->at);
    free(c);
}

void slice_cutter_also(slice_cutter *c, slice_more *more, void *context)
{
    c->more = more;
    c->context = context;
}

int64_t slice_cutter_list(const slice_cutter *c, const int32_t **list)
{
    *list = c->list;
    return c->count;
}

const slice_piece *slice_cutter_piece(const slice_cutter *c, int64_t i, slice_piece *room)
{
    if (c->s.method != SLICE_PAPER)
        return &((const slice_piece *)c->piece)[i];
    c->s.lanes->cut(&c->tets, c->s.cells, c->list + i, 1, c->s.size.rows, room);
    return room;
}

slice_piece *slice_cutter_pieces(const slice_cutter *c, int64_t *count, err *e)
{
    slice_piece *p = mem_array(c->count, sizeof *p, "pieces of an image", e);
    *count = c->count;
    if (p)
        c->s.lanes->cut(&c->tets, c->s.cells, c->list, c->count, c->s.size.rows, p);
    return p;
}

/* ---- the tetrahedra that meet the slice */

static void project(void *context, int64_t chunk, int64_t from, int64_t to)
{
    slice_cutter *c = context;
    (void)chunk;
    c->s.lanes->project(&c->projection, c->s.mesh->rest, c->displacement, from, to, c->at, c->code);
}

static void meet(void *context, int64_t chunk, int64_t from, int64_t to)
{
    slice_cutter *c = context;
    c->chunk[chunk] = c->s.lanes->meet(&c->tets, from, to, c->list + from);
}

static void gather(slice_cutter *c)
{
    c->count = 0;
    for (int64_t i = 0; i < pool_chunks(c->s.mesh->tets, TETS); i++) {
        memmove(c->list + c->count, c->list + i * TETS, (size_t)c->chunk[i] * sizeof *c->list);
        c->count += c->chunk[i];
    }
}

static const slice_piece *piece_at(const slice_cutter *c, int64_t i)
{
    return c->s.method == SLICE_PAPER ? &((const slice_paper_tet *)c->piece)[i].piece
                                      : &((const slice_piece *)c->piece)[i];
}

static reach reach_of(const slice_cutter *c, const slice_piece *p)
{
    const uint32_t rows = (uint32_t)c->rows; /* unsigned divides sooner */
    if (p->first >= p->end)
        return (reach){0, 0};
    return (reach){(int32_t)((uint32_t)p->first / rows), (int32_t)((uint32_t)(p->end - 1) / rows) + 1};
}

static void cut(void *context, int64_t chunk, int64_t from, int64_t to)
{
    slice_cutter *c = context;
    (void)chunk;
    if (c->s.method == SLICE_PAPER)
        slice_paper_make(&c->tets, c->s.cells, c->list + from, to - from, c->projection.last,
                         (slice_paper_tet *)c->piece + from);
    else
        c->s.lanes->cut(&c->tets, c->s.cells, c->list + from, to - from, c->s.size.rows,
                        (slice_piece *)c->piece + from);
    for (int64_t i = from; i < to; i++)
        c->reach[i] = reach_of(c, piece_at(c, i));
}

static int make_pieces(slice_cutter *c, err *e)
{
    size_t size = c->s.method == SLICE_PAPER ? sizeof(slice_paper_tet) : sizeof(slice_piece);
    pool_run(c->s.threads, c->s.mesh->nodes, NODES, project, c);
    pool_run(c->s.threads, c->s.mesh->tets, TETS, meet, c);
    gather(c);
    if ((c->count > c->room && mem_grow(&c->piece, &c->room, c->count, size, "pieces of an image", e)) ||
        MEM_ROOM(&c->reach, &c->reach_room, c->count, "pieces of an image", e))
        return -1;
    pool_run(c->s.threads, c->count, PIECES, cut, c);
    return 0;
}

/* ---- the regions' lists */

/* Counts, or (place) writes, each piece in the regions that it reaches: ascending in each. */
static void deal(slice_cutter *c, int64_t *at, bool place)
{
    for (int64_t i = 0; i < c->count; i++)
        for (int32_t r = c->reach[i].first; r < c->reach[i].end; r++) {
            if (place)
                c->region[at[r]] = (int32_t)i;
            at[r]++;
        }
}

static int make_regions(slice_cutter *c, err *e)
{
    int64_t *start = c->start, before = 0;
    memset(start, 0, (size_t)(c->s.regions + 1) * sizeof *start);
    deal(c, start, false);
    for (int r = 0; r <= c->s.regions; r++) {
        int64_t here = start[r];
        start[r] = before;
        before += here;
    }
    if (MEM_ROOM(&c->region, &c->region_room, before, "regions of an image", e))
        return -1;
    deal(c, start, true);
    memmove(start + 1, start, (size_t)c->s.regions * sizeof *start);
    start[0] = 0;
    return 0;
}

/* ---- rows */

static scratch *take_scratch(slice_cutter *c)
{
    for (int i = 0;; i = (i + 1) % c->scratches)
        if (!atomic_flag_test_and_set(&c->scratch[i].busy))
            return &c->scratch[i];
}

static void sample_rows(slice_cutter *c, const slice_places *p, int32_t first, int32_t end)
{
    const int64_t columns = c->s.size.columns;
    for (int32_t r = first; r < end; r++) {
        const int64_t from = (int64_t)(r - first) * p->stride, to = r * columns;
        const int32_t *x = p->at[0] + from, *y = p->at[1] + from, *z = p->at[2] + from;
        c->s.lanes->sample(c->s.cells, x, y, z, columns, c->image + to);
        if (c->more)
            c->more(c->context, x, y, z, columns, to);
        if (p->owner)
            memcpy(c->owner + to, p->owner + from, (size_t)columns * sizeof *c->owner);
    }
}

static void draw_regions(void *context, int64_t chunk, int64_t from, int64_t to)
{
    slice_cutter *c = context;
    scratch *s = take_scratch(c);
    slice_places places = s->places;
    (void)chunk;
    if (!c->owner)
        places.owner = NULL;
    for (int64_t r = from; r < to; r++) {
        int32_t first = (int32_t)r * c->rows, end = first + c->rows;
        end = end < c->s.size.rows ? end : c->s.size.rows;
        const int32_t *list = c->region + c->start[r];
        int64_t count = c->start[r + 1] - c->start[r];
        if (first >= end)
            continue;
        if (c->s.method == SLICE_PAPER && c->s.mesh)
            slice_paper_fill(c->s.lanes, &c->fill, c->piece, list, count, first, end, &places);
        else
            c->s.lanes->fill(&c->fill, list, count, first, end, &places);
        sample_rows(c, &places, first, end);
    }
    atomic_flag_clear(&s->busy);
}

/* ---- images */

static void set_projection(slice_cutter *c, const slice_plane *at)
{
    slice_projection *p = &c->projection;
    const double *u = at->column, *v = at->row;
    double n[3], u2 = 0, v2 = 0, n2 = 0;
    for (int a = 0; a < 3; a++) {
        n[a] = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
        u2 += u[a] * u[a];
        v2 += v[a] * v[a];
        n2 += n[a] * n[a];
    }
    memcpy(p->origin, at->origin, sizeof p->origin);
    for (int a = 0; a < 3; a++) {
        p->axis[0][a] = u[a] / u2;
        p->axis[1][a] = v[a] / v2;
        p->axis[2][a] = n[a] / sqrt(n2);
    }
    p->last[0] = c->s.size.columns - 1;
    p->last[1] = c->s.size.rows - 1;
}

/* The rigid volume is one piece, larger than the image. */
static int make_whole(slice_cutter *c, const slice_plane *at, err *e)
{
    const double w = c->s.size.columns, h = c->s.size.rows;
    double columns[3], rows[3], place[3];
    if ((c->room < 1 && mem_grow(&c->piece, &c->room, 1, sizeof(slice_piece), "pieces of an image", e)) ||
        MEM_ROOM(&c->reach, &c->reach_room, 1, "pieces of an image", e))
        return -1;
    c->reach[0] = (reach){0, (c->s.size.rows + c->rows - 1) / c->rows};
    slice_piece *p = c->piece;
    *p = (slice_piece){.corners = 4,
                       .end = c->s.size.rows,
                       .u = {-1, w, w, -1},
                       .v = {-1, -1, h, h},
                       .from = {0, -1, 0, -1},
                       .to = {0, h, 0, h},
                       .start = {0, w, 0, -1}};
    slice_cells_place(c->s.cells, at->origin, place);
    for (int a = 0; a < 3; a++) {
        columns[a] = rows[a] = 0;
        for (int b = 0; b < 3; b++) {
            columns[a] += c->s.cells->axis[a][b] * at->column[b];
            rows[a] += c->s.cells->axis[a][b] * at->row[b];
        }
        p->place[a] = SLICE_ONE * place[a];
        p->across[a] = SLICE_ONE * columns[a];
        p->down[a] = SLICE_ONE * rows[a];
    }
    c->count = 1;
    return 0;
}

int slice_cutter_image(slice_cutter *c, const slice_plane *at, const double *displacement, uint8_t *image,
                       int32_t *owner, err *e)
{
    c->displacement = displacement;
    c->image = image;
    c->owner = owner;
    set_projection(c, at);
    if (c->s.mesh ? make_pieces(c, e) : make_whole(c, at, e))
        return -1;
    if (make_regions(c, e))
        return -1;
    c->fill.piece = c->piece;
    pool_run(c->s.threads, c->s.regions, 1, draw_regions, c);
    return 0;
}
