/* Images going out: a stream of PGM or PPM (each flushed as it is done, so that whoever shows them is not behind), or a
 * file each, PNG or PGM or PPM by the name's end, each whole under its name as soon as it is done. A comment in PGM and
 * PPM says where the image lies: nine numbers, m: the centre of pixel 0 0, the step to the next column, and to the next
 * row; and of a fan, after that word, four more: how far above the first row its tip is, the radii of its face and its
 * end (m), and the angle by which it opens (degrees). A PNG says how many pixels a metre has. The writer owns its
 * stream; begin with a zeroed one.
 */
#ifndef SINEW_SLICE_WRITE_H
#define SINEW_SLICE_WRITE_H

#include "base/out.h"
#include "cli/numbered.h"
#include "slice/image/slice_view.h"

typedef struct slice_writer {
    out *stream; /* NULL: files */
    numbered names;
} slice_writer;

/* path: NULL or "-": standard output, which may be no terminal; a pattern such as f_%04d.png: files; else one file for
 * all, of PGM or PPM: a name that ends in .png is refused. */
int slice_writer_open(slice_writer *w, const char *path, err *e);

/* One image of the view: rows x columns x channels (1 or 3). */
int slice_writer_put(slice_writer *w, int64_t index, const slice_plane *at, const slice_view *view,
                     const uint8_t *pixel, int channels, err *e);

/* Ends the stream; on an error that stands in e, no file is left of one. */
void slice_writer_close(slice_writer *w, err *e);

#endif
