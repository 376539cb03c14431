#include "render/trace.h"

#include "base/mem.h"
#include "render/tile.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

trace_options trace_defaults(void)
{
    return (trace_options){.background = {1, 1, 1, 1}, .edge_width = 1.1, .occlusion = .9, .reach = .16};
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- trees */

/* Where two meshes are in one plane rounding would choose between them anew at every pixel. So each is a little nearer
 * the eye than those before it: by a share of its distance, which moves nothing in the picture, or along parallel rays.
 * The share is above the rounding of distances and below what the rays of light are lifted by and pixels are wide. */
static double nearer_by(const scene *s, int64_t mesh)
{
    return (double)mesh * fmin(1e-5, 2e-4 / (double)s->meshes);
}

/* The mesh's places moved toward the eye; the caller's. */
static float *bring_nearer(const scene_mesh *m, const camera *c, double share, double size, err *e)
{
    float *to = mem_array(3 * m->vertices, sizeof *to, "a surface", e);
    for (int64_t i = 0; to && i < 3 * m->vertices; i++) {
        double way = c->orthographic ? -size * c->forward[i % 3] : c->eye[i % 3] - (double)m->position[i];
        to[i] = (float)((double)m->position[i] + share * way);
    }
    return to;
}

static int add_mesh(embree *tree, const scene *s, int64_t i, const camera *c, double size, bool solid, err *e)
{
    const scene_mesh *m = &s->mesh[i];
    int64_t faces = solid && m->transparency > 0 ? 0 : m->faces;
    float *moved = i > 0 && faces ? bring_nearer(m, c, nearer_by(s, i), size, e) : NULL;
    int bad = i > 0 && faces && !moved;
    if (!bad)
        bad = embree_add_faces(tree, m->corners, m->vertices, moved ? moved : m->position, faces, m->corner, e);
    free(moved);
    return bad ? -1 : 0;
}

/* size: of the scene, m. */
static int add_meshes(embree *tree, const scene *s, const camera *c, double size, bool solid, err *e)
{
    for (int64_t i = 0; i < s->meshes; i++)
        if (add_mesh(tree, s, i, c, size, solid, e))
            return -1;
    return 0;
}

/* By one thread: with more, the order of faces in the tree, and so which of two at one place is met, would change. */
static embree *make_tree(const scene *s, const camera *c, double size, bool solid, err *e)
{
    embree *tree = embree_create(1, e);
    int status = tree ? add_meshes(tree, s, c, size, solid, e) : -1;
    for (int64_t i = 0; !status && i < s->sphere_sets; i++)
        status = embree_add_spheres(tree, s->spheres[i].count, s->spheres[i].centre_radius, e);
    if (!status && !embree_commit(tree, e))
        return tree;
    embree_destroy(tree);
    return NULL;
}

static bool any_transparent(const scene *s)
{
    for (int64_t i = 0; i < s->meshes; i++)
        if (s->mesh[i].transparency > 0)
            return true;
    return false;
}

/* ---- tiles */

typedef struct job {
    view view;
    image *image;
    int columns;
    int window[4]; /* what a tile must meet to have anything in it */
    tile **tile;   /* one a thread */
    atomic_flag *taken;
    int threads;
    tile_count *count; /* one a tile of the picture */
} job;

static int take_tile(job *j)
{
    for (int i = 0;; i = (i + 1) % j->threads)
        if (!atomic_flag_test_and_set(&j->taken[i]))
            return i;
}

static void clear(const job *j, int left, int top)
{
    const image *im = j->image;
    int right = left + TILE_SIDE < im->width ? left + TILE_SIDE : im->width;
    int bottom = top + TILE_SIDE < im->height ? top + TILE_SIDE : im->height;
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++)
            memcpy(&im->pixel[4 * ((int64_t)y * im->width + x)], j->view.options->background, 4 * sizeof(float));
}

static void draw_tile(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)from, (void)to;
    job *j = context;
    int left = (int)(chunk % j->columns) * TILE_SIDE, top = (int)(chunk / j->columns) * TILE_SIDE;
    const int *w = j->window;
    if (left >= w[2] || top >= w[3] || left + TILE_SIDE <= w[0] || top + TILE_SIDE <= w[1]) {
        clear(j, left, top);
        return;
    }
    int mine = take_tile(j);
    j->count[chunk] = tile_draw(j->tile[mine], &j->view, left, top, j->image);
    atomic_flag_clear(&j->taken[mine]);
}

static int make_tiles(job *j, int64_t tiles, int threads, err *e)
{
    j->count = mem_array(tiles, sizeof *j->count, "parts of a picture", e);
    j->tile = mem_array(threads, sizeof(tile *), "parts of a picture", e);
    j->taken = mem_array(threads, sizeof *j->taken, "parts of a picture", e);
    if (!j->count || !j->tile || !j->taken)
        return -1;
    for (; j->threads < threads; j->threads++) {
        atomic_flag_clear(&j->taken[j->threads]);
        j->tile[j->threads] = tile_create(e);
        if (!j->tile[j->threads])
            return -1;
    }
    return 0;
}

static void free_tiles(job *j)
{
    for (int i = 0; i < j->threads; i++)
        tile_destroy(j->tile[i]);
    free(j->tile);
    free(j->taken);
    free(j->count);
}

/* ---- all of it */

static bool camera_usable(const camera *c)
{
    double sum = c->half_height;
    for (int i = 0; i < 3; i++)
        sum += c->eye[i] + c->right[i] + c->up[i] + c->forward[i];
    return isfinite(sum) && c->half_height > 0;
}

static void count_scene(const scene *s, trace_report *r)
{
    for (int64_t i = 0; i < s->meshes; i++)
        r->faces += s->mesh[i].faces;
    for (int64_t i = 0; i < s->sphere_sets; i++)
        r->spheres += s->spheres[i].count;
}

static int draw(job *j, pool *p, trace_report *r, err *e)
{
    j->columns = (int)pool_chunks(j->image->width, TILE_SIDE);
    int64_t tiles = j->columns * pool_chunks(j->image->height, TILE_SIDE);
    int status = make_tiles(j, tiles, pool_threads(p), e);
    if (!status)
        pool_run(p, tiles, 1, draw_tile, j);
    for (int64_t i = 0; !status && i < tiles; i++) {
        r->rays += j->count[i].rays;
        r->covered += j->count[i].covered;
    }
    free_tiles(j);
    return status;
}

static int trace_scene(const scene *s, const camera *c, image *im, pool *p, const trace_options *o, trace_report *r,
                       err *e)
{
    double low[3], high[3], size = 0, begin = now();
    if (!scene_bounds(s, low, high)) {
        image_fill(im, o->background);
        return 0;
    }
    for (int a = 0; a < 3; a++)
        size = fmax(size, high[a] - low[a]);
    embree *all = make_tree(s, c, size, false, e), *solid = all;
    if (all && any_transparent(s))
        solid = make_tree(s, c, size, true, e);
    r->build = now() - begin;
    job j = {.view = {.scene = s, .options = o, .all = all, .solid = solid}, .image = im};
    int status = -1;
    if (all && solid) {
        view_set(&j.view, c, im, low, high);
        view_window(&j.view, c, low, high, j.window);
        status = draw(&j, p, r, e);
    }
    r->trace = now() - begin - r->build;
    if (solid != all)
        embree_destroy(solid);
    embree_destroy(all);
    return status;
}

int trace(const scene *s, const camera *c, image *im, pool *p, const trace_options *o, trace_report *report, err *e)
{
    trace_report r = {0};
    if (scene_check(s, e))
        return -1;
    if (!camera_usable(c))
        return err_set(e, NULL, 0, "the camera is not finite, or sees no height");
    count_scene(s, &r);
    int status = trace_scene(s, c, im, p, o, &r, e);
    if (report)
        *report = r;
    return status;
}
