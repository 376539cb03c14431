#include "tled/tiles/tiles.h"

#include "base/mem.h"
#include "tled/contact/sliding.h"
#include "tled/tiles/bricks.h"
#include "tled/tiles/lattice_sheet.h"
#include "tled/tiles/places.h"
#include "tled/tiles/tile_split.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* What the tiles are made with. */
typedef struct cutter {
    tiles *t;
    const tled_problem *p;
    int32_t *part;      /* nodes: a node of the part that it belongs to; later, its tile */
    int32_t *at;        /* nodes x 3: its place in the lattice, from its part's first node */
    int32_t *order;     /* nodes: where it stands in the tiles' order */
    int64_t *seat;      /* a table of tiles by part and brick: tile, or -1 */
    int64_t seats;      /* a power of 2 */
    int32_t *brick;     /* tiles x 4: part and brick */
    int64_t capacity;   /* of brick */
    tile_pack here;     /* the tile being cut */
    tile_split split;   /* where nodes share places */
    atomic_bool shared; /* a place, of nodes or of cells */
    int32_t *place;     /* there, of the listed tile being cut: elements: its cell's place, or -1 */
    err *e;
} cutter;

void tiles_free(tiles *t)
{
    free(t->tile);
    free(t->list);
    free(t->pull);
    free(t->node);
    free(t->node_info);
    free(t->order);
    free(t->halo_node);
    free(t->halo_place);
    free(t->cell);
    free(t->cell_element);
    free(t->fibre);
    free(t->share);
    free(t->mixed);
    free(t->cut);
    free(t->mixfibre);
    free(t->extra);
    memset(t, 0, sizeof *t);
}

/* A place in the grid of a tile: of a node, or of the element whose low corner it is. */
static int32_t place_in(const cutter *c, int64_t which, int64_t node)
{
    int32_t at[3];
    for (int a = 0; a < 3; a++)
        at[a] = c->at[3 * node + a] - c->brick[4 * which + 1 + a] * c->t->brick[a] + 1;
    return at[0] + c->t->grid[0] * (at[1] + c->t->grid[1] * at[2]);
}

/* What the script does to a node, as bits. */
static uint32_t script_info(const tled_problem *p, int32_t n)
{
    uint32_t info = 0, extra = p->force_start[n + 1] > p->force_start[n];
    if (p->sliding && p->sliding->row[n] >= 0)
        return 1u << TILE_APART;
    for (int a = 0; a < 3; a++) {
        int32_t hold = p->hold[3 * (int64_t)n + a];
        info |= (uint32_t)(hold == HOLD_FREE) << (TILE_FREE + a);
        extra |= hold >= 0;
    }
    return info | extra << TILE_EXTRA;
}

static uint32_t info_of(const cutter *c, int32_t n, int32_t place)
{
    const tled_problem *p = c->p;
    uint32_t info = (uint32_t)place;
    for (int i = 0; i < 8 && p->corner[8 * (int64_t)n + i] < 8 * p->elements; i++)
        info |= 1u << (TILE_CORNERS + p->corner[8 * (int64_t)n + i] % 8);
    return info | script_info(p, n);
}

/* The nodes of each tile, as they come. */
static int list_nodes(cutter *c)
{
    tiles *t = c->t;
    free(t->tile);
    t->tile = mem_array(t->count + 1, sizeof *t->tile, "the tiles", c->e);
    if (!t->tile)
        return -1;
    for (int32_t n = 0; n < t->nodes; n++)
        t->tile[c->part[n]].nodes++;
    for (int64_t i = 0, first = 0; i < t->count; i++) {
        tile *to = &t->tile[i];
        to->node = (int32_t)first;
        first += to->nodes;
        to->nodes = 0;
    }
    for (int32_t n = 0; n < t->nodes; n++) {
        tile *to = &t->tile[c->part[n]];
        t->node[to->node + to->nodes++] = n;
    }
    return 0;
}

/* Sorts those of a tile by place. Returns whether no two share one, nor a cell. */
static bool sort_nodes(cutter *c, int64_t i)
{
    const tled_problem *p = c->p;
    const tile *own = &c->t->tile[i];
    int32_t *list = c->t->node + own->node;
    uint32_t key[TILE_PLACES];
    bool alone = true;
    if (own->nodes > TILE_PLACES)
        return false;
    for (int32_t k = 0; k < own->nodes; k++)
        key[k] = (uint32_t)place_in(c, i, list[k]);
    places_sort(list, key, own->nodes);
    for (int32_t k = 0; k < own->nodes; k++) {
        const int32_t *corner = p->corner + 8 * (int64_t)list[k];
        uint32_t corners = 0;
        alone &= !k || key[k] != key[k - 1];
        for (int m = 0; m < 8 && corner[m] < 8 * p->elements; m++) {
            alone &= !(corners >> corner[m] % 8 & 1);
            corners |= 1u << corner[m] % 8;
        }
    }
    return alone;
}

/* How work on tiles, nodes and elements is dealt. */
enum { TILES = 16, CHUNK = 4096 };

static void sort_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cutter *c = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        if (!sort_nodes(c, i))
            atomic_store(&c->shared, true);
}

/* Those of each tile. Returns whether no two share a place. */
static bool sort_all(cutter *c)
{
    atomic_store(&c->shared, false);
    pool_run(c->p->threads, c->t->count, TILES, sort_work, c);
    return !atomic_load(&c->shared);
}

/* Splits the tiles in which some share places: c->part becomes the new ones. */
static int split_tiles(cutter *c)
{
    tiles *t = c->t;
    int32_t *first = mem_array(t->nodes, sizeof *first, "the tiles", c->e);
    int result = -1;
    if (!first || places_shared(t->nodes, c->part, c->at, first, c->e) ||
        tile_split_make(&c->split, c->p, t, first, c->part, c->e))
        goto out;
    int32_t *brick = mem_array(c->split.count, 4 * sizeof *brick, "the tiles", c->e);
    c->place = mem_array(c->p->elements, sizeof *c->place, "the tiles", c->e);
    if (!brick || !c->place) {
        free(brick);
        goto out;
    }
    for (int64_t i = 0; i < c->split.count; i++)
        memcpy(brick + 4 * i, c->brick + 4 * (int64_t)c->split.tile[i].brick, 4 * sizeof *brick);
    memset(c->place, 0xff, (size_t)c->p->elements * sizeof *c->place);
    free(c->brick);
    c->brick = brick;
    t->count = c->split.count;
    result = list_nodes(c);
    if (!result)
        sort_all(c);
out:
    free(first);
    return result;
}

static bool is_listed(const cutter *c, int64_t which)
{
    return c->split.tile && c->split.tile[which].listed;
}

static void info_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cutter *c = context;
    (void)chunk;
    for (int64_t k = from; k < to; k++) {
        const int32_t n = c->t->node[k], which = c->part[n];
        c->t->node_info[k] = info_of(c, n, is_listed(c, which) ? 0 : place_in(c, which, n)); /* 0: put_places */
        c->order[n] = (int32_t)k;
    }
}

/* The nodes in order of tiles, in each by place. */
static int order_nodes(cutter *c)
{
    tiles *t = c->t;
    t->nodes = c->p->nodes;
    t->node = mem_array(t->nodes, sizeof *t->node, "the tiles", c->e);
    t->node_info = mem_array(t->nodes, sizeof *t->node_info, "the tiles", c->e);
    if (!t->node || !t->node_info || list_nodes(c))
        return -1;
    if (!sort_all(c) && split_tiles(c))
        return -1;
    pool_run(c->p->threads, t->nodes, CHUNK, info_work, c);
    return 0;
}

/* Whether fibres of a volume do anything: they contract, have curves of their own or resist being stretched. */
static bool fibres_act(const tled_problem *p, int32_t volume)
{
    return p->volume[volume].contract >= 0 || p->volume[volume].curved || fibres_any(&p->fibres, volume);
}

static bool is_fibred(const cutter *c, int64_t element)
{
    const tled_problem *p = c->p;
    if (p->fibre && fibres_act(p, p->element_volume[element]))
        return true;
    return p->mixfibre && p->mix[element] >= 0 && fibres_act(p, p->mix[element]);
}

/* Lists over cells, as many as are counted. */
static int make_cell_lists(cutter *c)
{
    tiles *t = c->t;
    const tled_problem *p = c->p;
    t->cell = mem_array(t->cells, sizeof *t->cell, "the tiles", c->e);
    t->cell_element = mem_array(t->cells, sizeof *t->cell_element, "the tiles", c->e);
    t->fibre = mem_array(t->directions, 3 * sizeof *t->fibre, "the tiles", c->e);
    t->share = p->fraction ? mem_array(t->cells, sizeof *t->share, "the tiles", c->e) : NULL;
    t->mixed = p->mixed ? mem_array(t->cells, sizeof *t->mixed, "the tiles", c->e) : NULL;
    t->cut = p->cut.count ? mem_array(t->cells, sizeof *t->cut, "the tiles", c->e) : NULL;
    t->mixfibre = p->mixfibre ? mem_array(t->directions, 3 * sizeof *t->mixfibre, "the tiles", c->e) : NULL;
    return t->cell && t->cell_element && t->fibre && (t->share || !p->fraction) && (t->mixed || !p->mixed) &&
                   (t->cut || !p->cut.count) && (t->mixfibre || !p->mixfibre)
               ? 0
               : -1;
}

/* Whether a tile has none of an element's corners before this one: so that each of its elements is found once. */
static bool is_first(const cutter *c, int64_t which, int32_t corner)
{
    const int32_t *node = c->p->element_node + corner / 8 * 8;
    for (int k = 0; k < corner % 8; k++)
        if (c->part[node[k]] == which)
            return false;
    return true;
}

/* Counts the elements at a tile's nodes, and lists them where there is room: those with fibres first. */
static void find_cells(cutter *c, int64_t i)
{
    tiles *t = c->t;
    const tled_problem *p = c->p;
    tile *to = &t->tile[i];
    int32_t plain = to->fibred;
    to->cells = to->fibred = 0;
    for (int32_t k = to->node; k < to->node + to->nodes; k++) {
        const int32_t *corner = p->corner + 8 * (int64_t)t->node[k];
        for (int m = 0; m < 8 && corner[m] < 8 * p->elements; m++) {
            if (!is_first(c, i, corner[m]))
                continue;
            const int64_t element = corner[m] / 8;
            const bool fibred = is_fibred(c, element);
            if (t->cell_element)
                t->cell_element[to->cell + (fibred ? to->fibred : plain++)] = (int32_t)element;
            to->cells++;
            to->fibred += fibred;
        }
    }
}

static void cells_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        find_cells(context, i);
}

/* The cells of each tile. */
static int list_cells(cutter *c)
{
    tiles *t = c->t;
    pool_run(c->p->threads, t->count, TILES, cells_work, c);
    for (int64_t i = 0; i < t->count; i++) {
        tile *to = &t->tile[i];
        if (t->cells > INT32_MAX - TILE_PLACES)
            return err_set(c->e, NULL, 0, "%lld elements are too many for this device", (long long)c->p->elements);
        to->cell = (int32_t)t->cells;
        to->direction = (int32_t)t->directions;
        t->cells += to->cells;
        t->directions += to->fibred;
    }
    if (make_cell_lists(c))
        return -1;
    pool_run(c->p->threads, t->count, TILES, cells_work, c);
    return 0;
}

/* One cell's information, but for its place. */
static void put_cell(cutter *c, int64_t which, int64_t at, int32_t place)
{
    tiles *t = c->t;
    const int64_t element = t->cell_element[at];
    const uint32_t own = c->part[c->p->element_node[8 * element]] == which;
    if (t->share)
        t->share[at] = c->p->fraction[element];
    if (t->mixed)
        t->mixed[at] = c->p->mixed[element];
    if (t->cut)
        t->cut[at] = (int32_t)cut_moments_row(&c->p->cut, element);
    t->cell[at] = (uint32_t)place | own << TILE_OWN | (uint32_t)c->p->element_volume[element] << TILE_VOLUME;
}

/* One more of a tile's halo; written where there is room. */
static void put_halo(cutter *c, tile *to, int32_t node, int32_t place)
{
    tiles *t = c->t;
    if (t->halo_node) {
        t->halo_node[to->halo + to->halos] = c->order[node];
        t->halo_place[to->halo + to->halos] = (uint16_t)place;
    }
    to->halos++;
}

/* Puts a tile's cells where they lie in the lattice. */
static void put_grid(cutter *c, int64_t i)
{
    const tile *to = &c->t->tile[i];
    for (int32_t k = to->cell; k < to->cell + to->cells; k++) {
        const int32_t *corner = c->p->element_node + 8 * (int64_t)c->t->cell_element[k];
        put_cell(c, i, k, place_in(c, i, corner[0]));
        for (int m = 0; m < 8; m++)
            c->here.node[place_in(c, i, corner[m])] = corner[m];
    }
}

/* A node's own place: the first of those that it has. */
static void put_places(cutter *c, const tile *to)
{
    for (int32_t k = to->node; k < to->node + to->nodes; k++) {
        uint32_t place = 0;
        while (c->here.node[place] != c->t->node[k])
            place++;
        c->t->node_info[k] = (c->t->node_info[k] & ~(uint32_t)TILE_PLACE) | place;
    }
}

/* Those of a listed tile where there is room: in the order in which tile_split found that there is. */
static void put_packed(cutter *c, int64_t i)
{
    const tile *to = &c->t->tile[i];
    for (int32_t k = to->node; k < to->node + to->nodes; k++)
        for (int m = 0, corner; (corner = lattice_sheet_corner(c->p, c->t->node[k], m)) >= 0; m++) {
            int32_t *place = &c->place[corner / 8];
            if (*place < 0)
                *place = tile_pack_add(&c->here, c->p->element_node + corner / 8 * 8);
        }
    put_places(c, to);
    for (int32_t k = to->cell; k < to->cell + to->cells; k++)
        put_cell(c, i, k, c->place[c->t->cell_element[k]]);
}

/* The rows of a listed tile's nodes, once its cells have places; forgets these. */
static void put_pulls(cutter *c, int64_t i)
{
    const tiles *t = c->t;
    const tile *of = &t->tile[i];
    uint16_t *row = t->list ? t->pull + 8 * (int64_t)t->list[i] : NULL;
    for (int32_t k = 0; row && k < of->nodes; k++)
        for (int m = 0; m < 8; m++, row++) {
            const int32_t corner = lattice_sheet_corner(c->p, t->node[of->node + k], m);
            *row = (uint16_t)(corner < 0 ? (int)TILE_NO_PULL : corner % 8 << TILE_PULL | c->place[corner / 8]);
        }
    for (int32_t k = of->cell; k < of->cell + of->cells; k++)
        c->place[t->cell_element[k]] = -1;
}

/* Finds what stands around a tile. Counts its halo, or fills it too where there is room. */
static void cut_tile(cutter *c, int64_t i)
{
    tile *to = &c->t->tile[i];
    const int *grid = c->t->grid;
    tile_pack_begin(&c->here, grid);
    if (is_listed(c, i)) {
        put_packed(c, i);
        put_pulls(c, i);
    } else {
        put_grid(c, i);
    }
    to->halos = 0;
    for (int32_t at = 0; at < grid[0] * grid[1] * grid[2]; at++) {
        const int32_t node = c->here.node[at];
        if (node < 0 || (c->part[node] == i && (int32_t)(c->t->node_info[c->order[node]] & TILE_PLACE) == at))
            continue;
        put_halo(c, to, node, at);
    }
}

/* Where the lists of listed tiles begin, if there are any. */
static int list_lists(cutter *c)
{
    tiles *t = c->t;
    for (int64_t i = 0; i < t->count; i++)
        t->listed += is_listed(c, i) ? t->tile[i].nodes : 0;
    if (!t->listed)
        return 0;
    t->list = mem_array(t->count, sizeof *t->list, "the tiles", c->e);
    t->pull = mem_array(t->listed, 8 * sizeof *t->pull, "the tiles", c->e);
    if (!t->list || !t->pull)
        return -1;
    for (int64_t i = 0, next = 0; i < t->count; i++) {
        t->list[i] = is_listed(c, i) ? (int32_t)next : -1;
        next += is_listed(c, i) ? t->tile[i].nodes : 0;
    }
    return 0;
}

/* Cells that a kernel computes alike stand together, as threads of a warp that take different ways take them one after
 * the other: cells that are mixed stand first, and of both kinds those that are cut; then by place. */
static uint32_t cell_key(const cutter *c, int64_t which, int64_t element)
{
    const tled_problem *p = c->p;
    const uint32_t is_plain = !p->mixed || p->mixed[element] < 0, is_whole = cut_moments_row(&p->cut, element) < 0;
    return (is_plain << 1 | is_whole) << TILE_CORNERS | (uint32_t)place_in(c, which, p->element_node[8 * element]);
}

static void sort_cells(cutter *c, int64_t i)
{
    tiles *t = c->t;
    tile *to = &t->tile[i];
    uint32_t key[TILE_PLACES];
    int32_t *list = t->cell_element + to->cell;
    for (int part = 0; part < 2; part++) {
        int32_t first = part ? to->fibred : 0, count = part ? to->cells - to->fibred : to->fibred;
        for (int32_t k = 0; k < count; k++)
            key[k] = (uint32_t)list[first + k];
        if (is_listed(c, i)) /* several may have one place */
            places_sort(list + first, key, count);
        for (int32_t k = 0; k < count; k++)
            key[k] = cell_key(c, i, list[first + k]);
        places_sort(list + first, key, count);
    }
    for (int32_t k = 0; k < 3 * to->fibred; k++) {
        t->fibre[3 * (int64_t)to->direction + k] = c->p->fibre[3 * (int64_t)list[k / 3] + k % 3];
        if (t->mixfibre)
            t->mixfibre[3 * (int64_t)to->direction + k] = c->p->mixfibre[3 * (int64_t)list[k / 3] + k % 3];
    }
}

/* Tiles side by side, each thread with a tile of its own that is being cut; listed ones use what is of elements. */
static void cut_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cutter *c = context;
    cutter own = {
        .t = c->t, .p = c->p, .part = c->part, .at = c->at, .order = c->order, .brick = c->brick, .split = c->split};
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        if (!is_listed(&own, i))
            cut_tile(&own, i);
}

static void cut_all(cutter *c)
{
    pool_run(c->p->threads, c->t->count, TILES, cut_work, c);
    for (int64_t i = 0; c->split.tile && i < c->t->count; i++)
        if (is_listed(c, i))
            cut_tile(c, i);
}

static void sort_cells_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        sort_cells(context, i);
}

static int cut_tiles(cutter *c)
{
    tiles *t = c->t;
    pool_run(c->p->threads, t->count, TILES, sort_cells_work, c);
    cut_all(c);
    for (int64_t i = 0; i < t->count; t->halos += t->tile[i++].halos) {
        if (t->halos > INT32_MAX - TILE_PLACES)
            return err_set(c->e, NULL, 0, "%lld nodes are too many for this device", (long long)c->p->nodes);
        t->tile[i].halo = (int32_t)t->halos;
    }
    t->halo_node = mem_array(t->halos, sizeof *t->halo_node, "the tiles", c->e);
    t->halo_place = mem_array(t->halos, sizeof *t->halo_place, "the tiles", c->e);
    if (!t->halo_node || !t->halo_place || list_lists(c))
        return -1;
    cut_all(c);
    return 0;
}

static int list_extras(tiles *t, const tled_problem *p, err *e)
{
    t->extras = 0;
    for (int64_t k = 0; k < t->nodes; k++)
        t->extras += t->node_info[k] >> TILE_EXTRA & 1;
    t->extra = mem_array(t->extras, sizeof *t->extra, "the tiles", e);
    if (!t->extra)
        return -1;
    tile_extra *to = t->extra;
    for (int32_t k = 0; k < t->nodes; k++)
        if (t->node_info[k] >> TILE_EXTRA & 1) {
            int64_t n = t->node[k];
            const int32_t *hold = p->hold + 3 * n;
            *to++ = (tile_extra){.node = k,
                                 .hold = {hold[0], hold[1], hold[2]},
                                 .force = p->force_start[n],
                                 .forces = p->force_start[n + 1] - p->force_start[n],
                                 .rest = {p->position[3 * n], p->position[3 * n + 1], p->position[3 * n + 2]}};
        }
    return 0;
}

int tiles_reload(tiles *t, const tled_problem *p, err *e)
{
    const uint32_t kept = (1u << TILE_FREE) - 1;
    for (int64_t k = 0; k < t->nodes; k++)
        t->node_info[k] = (t->node_info[k] & kept) | script_info(p, t->node[k]);
    free(t->extra);
    return list_extras(t, p, e);
}

int tiles_make(tiles *t, const tled_problem *p, const int brick[3], err *e)
{
    memset(t, 0, sizeof *t);
    cutter c = {.t = t, .p = p, .e = e};
    int result = -1;
    for (int a = 0; a < 3; a++) {
        t->brick[a] = brick[a];
        t->grid[a] = brick[a] + 2;
    }
    if (p->volumes > TILE_VOLUMES)
        return err_set(e, NULL, 0, "%d volumes are too many for this device; expected at most %d", p->volumes,
                       TILE_VOLUMES);
    c.part = mem_array(p->nodes, sizeof *c.part, "the tiles", e);
    c.at = mem_array(p->nodes, 3 * sizeof *c.at, "the tiles", e);
    c.order = mem_array(p->nodes, sizeof *c.order, "the tiles", e);
    if (!c.part || !c.at || !c.order)
        goto out;
    if (places_find(p, c.part, c.at, e) || bricks_find(p, c.at, t->brick, c.part, &c.brick, &t->count, e) ||
        order_nodes(&c) || list_cells(&c) || cut_tiles(&c) || list_extras(t, p, e))
        goto out;
    result = 0;
out:
    free(c.part);
    free(c.at);
    free(c.order);
    free(c.brick);
    free(c.place);
    tile_split_free(&c.split);
    return result;
}
