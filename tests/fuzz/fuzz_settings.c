/* Any lines as settings of live images: what is taken gives an image of the size that there was, and its own value can
 * be set again; what is not leaves everything as it was.
 */
// needs: slice/image/slice_settings.c slice/image/slice_session.c slice/image/slice_options.c slice/image/slice_view.c
// needs: slice/image/slice_grey.c slice/image/slice_cutter.c slice/image/slice_paper.c slice/image/slice_lanes.c
// needs: slice/image/slice_lanes_loops.c slice/image/slice_cells.c slice/image/slice_mesh.c slice/image/slice_cut.c
// needs: slice/image/slice_overlay.c slice/image/slice_coupling.c slice/image/slice_write.c slice/image/slice_files.c
#include "base/mem.h"
#include "slice/image/slice_settings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { SIDE = 8, LINES = 40 };

static void must(bool good)
{
    if (!good)
        abort();
}

static void make_volume(volume *v, err *e)
{
    *v = (volume){.type = VOLUME_U8, .size = {2, 3, 4}, .axis = {{9, 0, 0}, {0, 9, 0}, {0, 0, 9}}};
    must(!volume_make(v, e));
    for (int i = 0; i < 24; i++)
        ((uint8_t *)v->data)[i] = (uint8_t)(i * 10);
}

/* What slice_session_open makes, without a model. */
static void make_session(slice_session *s, const tool *t, err *e)
{
    volume v, labels;
    make_volume(&v, e);
    make_volume(&labels, e);
    *s =
        (slice_session){.t = t, .o = slice_options_default(), .placing.body = pose_none(), .slices = 1, .labels = true};
    s->o.rigid = true;
    s->o.labels = "labels";
    strcpy(s->probe, "linear:2cm,1cm");
    s->threads = pool_create(1, e);
    must(s->threads && !slice_cells_make(&s->cells, &v, (slice_window){0, 255}, s->threads, e));
    s->view.size = (slice_size){SIDE, SIDE};
    must(!slice_overlay_make(&s->overlay, &labels, &s->cells, s->view.size, e));
    volume_free(&v);
    volume_free(&labels);
    s->image = mem_array(SIDE * SIDE, 1, "an image", e);
    s->colour = mem_array(3 * SIDE * SIDE, 1, "an image", e);
    must(s->image && s->colour && !slice_session_set_view(s, e));
}

static void draw(slice_session *s, err *e)
{
    const pose at = pose_none();
    size_t size;
    s->writer.stream = out_memory(e);
    must(s->writer.stream && !slice_session_put(s, s->images, &at, NULL, e));
    out_bytes(s->writer.stream, &size);
    must(size > 3 * SIDE * SIDE && s->view.size.columns == SIDE && s->view.size.rows == SIDE);
    out_discard(s->writer.stream);
    s->writer.stream = NULL;
}

/* What must not change where a line is refused. */
static bool is_same(const slice_session *s, const slice_session *before)
{
    return s->o.gain == before->o.gain && s->o.tgc.count == before->o.tgc.count && s->thick == before->thick &&
           s->slices == before->slices && s->view.depth == before->view.depth &&
           s->view.pixel[0] == before->view.pixel[0] && !strcmp(s->probe, before->probe) &&
           s->labels == before->labels && s->frozen == before->frozen;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    slice_session s;
    opt_common quiet = {.quiet = true};
    const tool t = {.table = &slice_table, .common = &quiet};
    err e = {0};
    keyfile k;
    in *from = in_memory(data, size, "fuzz", &e);
    if (!from)
        return 0;
    make_session(&s, &t, &e);
    keyfile_open(&k, from);
    for (int i = 0; i < LINES && keyfile_next(&k, &e) > 0; i++) {
        const slice_session before = s;
        err wrong = {0};
        if (slice_settings_take(&s, &k, &wrong))
            must(is_same(&s, &before));
        else
            must(!slice_settings_take(&s, &k, &wrong));
        draw(&s, &e);
    }
    in_close(from);
    slice_session_close(&s, &e);
    return 0;
}
