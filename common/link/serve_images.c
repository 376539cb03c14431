#include "link/serve_images.h"

#include "base/mem.h"
#include "base/space.h"
#include "base/thread.h"
#include "link/igtl_content.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct serve_images {
    serve_images_plan plan;
    int image, place; /* devices */
    pthread_t thread;
    atomic_bool ended;
    atomic_llong count;
    igtl_buffer content;
};

/* ---- where an image lies */

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* A matrix of three columns and a place, m in LPS. */
static void fill(const double *const column[3], const double place[3], double matrix[16])
{
    const double *const all[4] = {column[0], column[1], column[2], place};
    for (int c = 0; c < 4; c++) {
        double to[3];
        space_point_to_mm(all[c], SPACE_RAS, to);
        for (int r = 0; r < 3; r++)
            matrix[4 * r + c] = to[r] + 0.0; /* never -0 */
        matrix[12 + c] = c == 3;
    }
}

/* The axis across is as long as a pixel is wide: the image has one layer. */
static void find_across(const pnm *p, double across[3])
{
    const double *x = p->plane + 3, *z = p->plane + 6;
    const double size = length(z);
    for (int a = 0; a < 3; a++)
        across[a] = (x[(a + 1) % 3] * z[(a + 2) % 3] - x[(a + 2) % 3] * z[(a + 1) % 3]) / size;
}

void serve_images_matrix(const pnm *p, double matrix[16])
{
    double across[3];
    find_across(p, across);
    fill((const double *const[3]){p->plane + 3, p->plane + 6, across}, p->plane, matrix);
}

/* m, from the first row's centre up to the face: half a row, but of a fan what its comment says. */
static double above(const pnm *p)
{
    return p->has_fan ? p->fan[0] - p->fan[1] : .5 * length(p->plane + 6);
}

void serve_images_probe(const pnm *p, double matrix[16])
{
    double axis[3][3], place[3];
    find_across(p, axis[1]);
    const double *x = p->plane + 3, *z = p->plane + 6, wide = length(x), tall = length(z);
    for (int a = 0; a < 3; a++) {
        axis[0][a] = x[a] / wide / 1e3; /* of length 1, in a matrix whose unit is mm */
        axis[1][a] /= -wide * 1e3;
        axis[2][a] = z[a] / tall / 1e3;
        place[a] = p->plane[a] + .5 * (p->columns - 1) * x[a] - above(p) * z[a] / tall;
    }
    fill((const double *const[3]){axis[0], axis[1], axis[2]}, place, matrix);
}

/* ---- what is put on the board */

static int put(serve_images *s, int device, uint64_t stamp, err *e)
{
    const int failed = serve_board_put(s->plan.board, device, stamp, atomic_load(&s->count), &s->content, e);
    s->content.size = 0;
    return failed;
}

static int put_matrix(serve_images *s, int device, const double matrix[16], uint64_t stamp, err *e)
{
    return igtl_write_transform(&s->content, matrix, e) || put(s, device, stamp, e) ? -1 : 0;
}

/* The image first: it is what is waited for. */
static int put_image(serve_images *s, const pnm *p, err *e)
{
    const uint64_t stamp = igtl_now();
    const int64_t pixels = (int64_t)p->columns * p->rows * p->channels;
    double matrix[16];
    igtl_image i = {.components = p->channels,
                    .scalar = IGTL_UINT8,
                    .coordinates = IGTL_RAS,
                    .size = {p->columns, p->rows, 1},
                    .pixels = p->pixel,
                    .pixels_size = (size_t)pixels,
                    .part = {0, 0, 0, p->columns, p->rows, 1}};
    if (!p->has_plane || !(length(p->plane + 3) > 0) || !(length(p->plane + 6) > 0))
        return err_set(e, s->plan.path, 0,
                       "image %lld does not say where it lies; expected images as us-slice streams them",
                       (long long)atomic_load(&s->count));
    serve_images_matrix(p, i.matrix);
    if (igtl_write_image(&s->content, &i, e) || put(s, s->image, stamp, e) ||
        put_matrix(s, s->place, i.matrix, stamp, e))
        return -1;
    serve_us_saw(s->plan.us, p->columns, p->rows, p->has_fan ? p->fan[2] - p->fan[1] : p->rows * length(p->plane + 6));
    if (s->plan.probe < 0)
        return 0;
    serve_images_probe(p, matrix);
    return put_matrix(s, s->plan.probe, matrix, stamp, e);
}

/* ---- the thread */

/* Waits until there is a writer, or the end is asked for (false). */
static bool wait_for_writer(const serve_images *s, int fd)
{
    struct pollfd p[2] = {{.fd = fd, .events = POLLIN}, {.fd = s->plan.stop, .events = POLLIN}};
    int n;
    do
        n = poll(p, 2, -1);
    while (n < 0 && errno == EINTR);
    return !p[1].revents;
}

/* The stream, or NULL: e filled, unless the end was asked for. A FIFO that is opened so does not wait for a writer. */
static in *open_stream(const serve_images *s, err *e)
{
    if (!strcmp(s->plan.path, "-"))
        return in_open("-", e);
    const int fd = open(s->plan.path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        err_system(e, s->plan.path, errno, "cannot open");
        return NULL;
    }
    const bool goes_on = wait_for_writer(s, fd);
    const int flags = fcntl(fd, F_GETFL);
    if (goes_on && (flags < 0 || fcntl(fd, F_SETFL, flags & ~O_NONBLOCK)))
        err_system(e, s->plan.path, errno, "cannot read");
    in *from = goes_on && !e->form ? in_take(fd, s->plan.path, e) : NULL;
    if (!from)
        close(fd);
    return from;
}

static int read_images(serve_images *s, in *from, err *e)
{
    pnm p = {0};
    int got;
    in_watch(from, s->plan.stop);
    while ((got = pnm_next(from, &p, e)) > 0 && !put_image(s, &p, e))
        atomic_fetch_add(&s->count, 1);
    pnm_free(&p);
    return got ? -1 : 0;
}

static void *read_all(void *context)
{
    serve_images *s = context;
    err e = {0};
    in *from = open_stream(s, &e);
    if (from && !read_images(s, from, &e) && !atomic_load(&s->count))
        err_set(&e, in_name(from), 0, "no image; expected those that us-slice streams");
    if (e.form)
        s->plan.failed(s->plan.context, &e);
    in_close(from);
    atomic_store(&s->ended, true);
    serve_board_wake(s->plan.board);
    return NULL;
}

serve_images *serve_images_open(const serve_images_plan *plan, err *e)
{
    serve_images *s = mem_array(1, sizeof *s, "images", e);
    if (!s)
        return NULL;
    s->plan = *plan;
    s->image = serve_board_add(plan->board, "IMAGE", "Image_Reference", e);
    s->place = s->image < 0 ? -1 : serve_board_add(plan->board, "TRANSFORM", "ImageToReference", e);
    const int code = s->place < 0 ? 0 : thread_start(&s->thread, read_all, s);
    if (s->place >= 0 && !code)
        return s;
    if (code)
        err_system(e, plan->path, code, "cannot start a thread");
    free(s);
    return NULL;
}

bool serve_images_ended(serve_images *s)
{
    return atomic_load(&s->ended);
}

int64_t serve_images_count(serve_images *s)
{
    return atomic_load(&s->count);
}

void serve_images_close(serve_images *s)
{
    if (!s)
        return;
    pthread_join(s->thread, NULL);
    igtl_buffer_free(&s->content);
    free(s);
}
