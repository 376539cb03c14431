#include "console/images.h"

#include "base/mem.h"
#include "base/thread.h"
#include "console/jpeg.h"
#include "picture/png.h"
#include "picture/pnm.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { KIND_IMAGE = 1, KIND_PIXELS = 4, HEADER = 96 }; /* bytes before the JPEG, or the pixels */

struct images {
    images_plan plan;
    pthread_t reader;
    jpeg compressor;
    uint32_t count;
    pnm next;
    pthread_mutex_t lock; /* of the newest */
    pnm newest;
};

/* u32 kind, index, columns, rows; f64 time, plane x 9; then bytes. */
static mail *make_mail(images *i, int kind, const unsigned char *bytes, size_t size, err *e)
{
    const pnm *p = &i->next;
    const uint32_t head[4] = {(uint32_t)kind, i->count, (uint32_t)p->columns, (uint32_t)p->rows};
    const double time = i->plan.time(i->plan.context);
    mail *m = mail_make(false, HEADER + size, e);
    if (!m)
        return NULL;
    memcpy(m->bytes, head, sizeof head);
    memcpy(m->bytes + 16, &time, sizeof time);
    memcpy(m->bytes + 24, p->plane, sizeof p->plane);
    memcpy(m->bytes + HEADER, bytes, size);
    return m;
}

/* The JPEG, or grey or RGB as they came. */
static mail *mail_of_image(images *i, err *e)
{
    const pnm *p = &i->next;
    if (i->plan.raw(i->plan.context))
        return make_mail(i, KIND_PIXELS, p->pixel, (size_t)p->columns * (size_t)p->rows * (size_t)p->channels, e);
    if (jpeg_make(&i->compressor, p->pixel, p->columns, p->rows, p->channels, e))
        return NULL;
    return make_mail(i, KIND_IMAGE, i->compressor.bytes, i->compressor.size, e);
}

static void keep(images *i)
{
    pthread_mutex_lock(&i->lock);
    const pnm before = i->newest;
    i->newest = i->next;
    i->next = before;
    pthread_mutex_unlock(&i->lock);
}

static int show_all(images *i, in *s, err *e)
{
    int got;
    while ((got = pnm_next(s, &i->next, e)) > 0) {
        const bool wanted = i->plan.wants(i->plan.context);
        mail *m = wanted ? mail_of_image(i, e) : NULL;
        if (wanted && !m)
            return -1;
        i->count++;
        keep(i);
        if (m)
            i->plan.show(i->plan.context, m);
    }
    return got;
}

static void *read_all(void *context)
{
    images *i = context;
    err e = {0};
    in *s = in_take(i->plan.from, i->plan.tool, &e);
    if (!s)
        close(i->plan.from);
    if (!s || show_all(i, s, &e))
        i->plan.failed(i->plan.context, i->plan.tool, &e);
    in_close(s);
    return NULL;
}

images *images_open(const images_plan *plan, err *e)
{
    images *i = mem_array(1, sizeof *i, "images", e);
    if (!i) {
        close(plan->from);
        return NULL;
    }
    i->plan = *plan;
    pthread_mutex_init(&i->lock, NULL);
    const int code = thread_start(&i->reader, read_all, i);
    if (!code)
        return i;
    err_system(e, plan->tool, code, "cannot start a thread");
    close(plan->from);
    pthread_mutex_destroy(&i->lock);
    free(i);
    return NULL;
}

void images_close(images *i)
{
    if (!i)
        return;
    pthread_join(i->reader, NULL);
    pthread_mutex_destroy(&i->lock);
    jpeg_free(&i->compressor);
    pnm_free(&i->next);
    pnm_free(&i->newest);
    free(i);
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static int put_png(const pnm *p, out *to, err *e)
{
    const double each[2] = {1 / length(p->plane + 3), 1 / length(p->plane + 6)};
    const int64_t pixels = (int64_t)p->columns * p->rows;
    unsigned char *colour = mem_array(3 * pixels, 1, "a picture", e);
    for (int64_t at = 0; colour && at < 3 * pixels; at++)
        colour[at] = p->pixel[p->channels == 3 ? at : at / 3];
    const int failed = colour ? png_put_scaled(colour, p->columns, p->rows, 3, each, to, e) : -1;
    free(colour);
    return failed;
}

int images_save(images *i, const char *path, err *e)
{
    int failed = -1;
    pthread_mutex_lock(&i->lock);
    if (!i->newest.pixel || !i->newest.has_plane) {
        err_set(e, NULL, 0, "there is no image to save yet");
    } else {
        out *to = out_open(path, false, e);
        failed = to ? out_end(to, put_png(&i->newest, to, e), e) : -1;
    }
    pthread_mutex_unlock(&i->lock);
    return failed;
}
