/* What us-slice makes images with: the volume, the model, the view, and the settings that a live run may change. A
 * session owns all of it but the options and the tool; begin with a zeroed one.
 */
#ifndef SINEW_SLICE_SESSION_H
#define SINEW_SLICE_SESSION_H

#include "cli/tool.h"
#include "model/source.h"
#include "slice/image/slice_coupling.h"
#include "slice/image/slice_cutter.h"
#include "slice/image/slice_grey.h"
#include "slice/image/slice_options.h"
#include "slice/image/slice_overlay.h"
#include "slice/image/slice_view.h"
#include "slice/image/slice_write.h"
#include "volume/placing.h"

enum { SLICE_WORD = 200 }; /* bytes of the text of a setting */

#define SLICE_DEPTH .05 /* m: where --depth is not given */

typedef struct slice_session {
    const tool *t;
    slice_options o;                               /* the values that hold now */
    char probe[SLICE_WORD], thickness[SLICE_WORD]; /* the texts of two of them */
    bool labels, frozen;                           /* labels are shown; the image stays */
    pool *threads;
    slice_cells cells;
    slice_window window;
    uint32_t volume_crc, labels_crc; /* of what was read, where a record wants to know */
    source model;
    slice_mesh mesh;
    placing placing; /* of --body and --marker */
    slice_view view;
    slice_cutter *cutter;
    slice_grey grey;
    slice_coupling coupling;
    slice_overlay overlay;
    slice_writer writer;
    double thick; /* m */
    int slices;
    uint8_t *image, *colour, *one; /* rows x columns, x 3; a slice of several */
    uint16_t *sum;
    int64_t images;
    bool lit; /* some image was not black */
    notes warnings;
} slice_session;

/* Reads what there is before the first image; path: the volume. -1 with e filled. */
int slice_session_open(slice_session *s, const slice_options *o, const tool *t, const char *path, err *e);

/* Ends the output, whole only where e is empty. */
void slice_session_close(slice_session *s, err *e);

/* The array, depth or width of s->o changed; or gains and the coupling; or the thickness. -1 with e filled, and the
 * session draws as it did. The size of the image stays. */
int slice_session_set_view(slice_session *s, err *e);
int slice_session_set_grey(slice_session *s, err *e);
int slice_session_set_thickness(slice_session *s, err *e);

/* Makes and writes one image. from: where the probe is, in the volume's frame; displacement: nodes x 3, m; NULL: at
 * rest. */
int slice_session_put(slice_session *s, int64_t index, const pose *from, const double *displacement, err *e);

/* The displacement of a frame. NULL with e filled: it has none. */
const double *slice_session_displacement(const slice_session *s, const frame *f, err *e);

/* The pose of a frame. -1 with e filled: it has none. */
int slice_session_pose(const slice_session *s, const frame *f, pose *to, err *e);

#endif
