#include "slice/image/slice_write.h"

#include "base/mem.h"
#include "picture/png.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int slice_writer_open(slice_writer *w, const char *path, err *e)
{
    *w = (slice_writer){0};
    if (path && strchr(path, '%'))
        return numbered_of(&w->names, path, "", e);
    const char *end = path ? strrchr(path, '.') : NULL;
    if (end && !strcmp(end, ".png"))
        return err_usage(e, "-o '%s': PNG images are written to a file each; expected a name such as image_%%04d.png",
                         path);
    w->stream = out_open(path, false, e);
    if (!w->stream)
        return -1;
    if (!out_is_terminal(w->stream))
        return 0;
    return err_option(e, "stdout", "is a terminal, and an image is not for reading; expected -o FILE or a pipe");
}

static void put_comment(const slice_plane *at, const slice_view *view, out *to)
{
    const double *list[3] = {at->origin, at->column, at->row};
    const slice_probe *p = &view->probe;
    out_text(to, "# us-slice:");
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            out_format(to, " %.9g", list[i][a]);
    if (p->array != SLICE_LINEAR)
        out_format(to, " fan %.9g %.9g %.9g %.9g", p->radius + view->corner[1], p->radius, p->radius + view->depth,
                   p->angle * 180 / M_PI);
    out_text(to, "\n");
}

static void put_pnm(const slice_plane *at, const slice_view *view, const uint8_t *pixel, int channels, out *to)
{
    out_format(to, "P%d\n", channels == 3 ? 6 : 5);
    put_comment(at, view, to);
    out_format(to, "%d %d\n255\n", (int)view->size.columns, (int)view->size.rows);
    out_write(to, pixel, (size_t)view->size.columns * (size_t)view->size.rows * (size_t)channels);
}

static int put_png(const slice_view *view, const uint8_t *pixel, int channels, out *to, err *e)
{
    const int columns = view->size.columns, rows = view->size.rows;
    const int64_t count = (int64_t)columns * rows;
    const double each[2] = {1 / view->pixel[0], 1 / view->pixel[1]};
    if (channels == 3)
        return png_put_scaled(pixel, columns, rows, 3, each, to, e);
    uint8_t *colour = mem_array(3 * count, 1, "a picture", e);
    for (int64_t i = 0; colour && i < count; i++)
        memset(colour + 3 * i, pixel[i], 3);
    const int bad = colour ? png_put_scaled(colour, columns, rows, 3, each, to, e) : -1;
    free(colour);
    return bad;
}

int slice_writer_put(slice_writer *w, int64_t index, const slice_plane *at, const slice_view *view,
                     const uint8_t *pixel, int channels, err *e)
{
    if (w->stream) {
        put_pnm(at, view, pixel, channels, w->stream);
        out_flush(w->stream);
        return out_failed(w->stream, e);
    }
    char *name = numbered_name(&w->names, index, e);
    out *to = name ? out_open(name, false, e) : NULL;
    const char *end = name ? strrchr(name, '.') : NULL;
    const bool png = end && !strcmp(end, ".png");
    free(name);
    if (!to)
        return -1;
    if (!png)
        put_pnm(at, view, pixel, channels, to);
    return out_end(to, png && put_png(view, pixel, channels, to, e), e);
}

void slice_writer_close(slice_writer *w, err *e)
{
    if (w->stream && e->status && out_is_file(w->stream))
        out_discard(w->stream);
    else if (w->stream)
        out_close(w->stream, e);
    *w = (slice_writer){0};
}
