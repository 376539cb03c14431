/* Where the probe is, frame by frame, from a stream: lines `time tx ty tz qx qy qz qw` (TUM's: s, m, a unit quaternion,
 * scalar last), controls between them (`method NAME`, `set KEY VALUE`), comments; or the header of a PLUS sequence file
 * (MetaImage or NRRD), whose matrices are in mm. One line is read for each event, and no more. The stream stays the
 * caller's; nothing is allocated, and there is nothing to free. Lines that come live: live/lines.h.
 */
#ifndef SINEW_POSES_H
#define SINEW_POSES_H

#include "base/keyfile.h"
#include "base/pose.h"
#include "probe/plus.h"

typedef enum poses_kind { POSES_POSE, POSES_CONTROL } poses_kind;

typedef struct poses_event {
    poses_kind kind;
    int64_t line;
    double time; /* s; of a pose */
    pose at;     /* of the middle of the probe's face; +z into the tissue, +x along the image's columns */
} poses_event;

typedef struct poses {
    keyfile lines;
    bool sequence; /* PLUS */
    plus frames;
    double last; /* the time of the pose before; -inf: there was none */
} poses;

/* Takes the words of k as a pose. -1 with e filled: see poses_next; the order of times is not looked at. */
int poses_take(const keyfile *k, poses_event *to, err *e);

/* Looks at the first byte. transform: which of a sequence's, such as "ProbeToReference", composed from those
 * that it has; NULL: the first that it can give of ImageToReference, ProbeToReference, ImageToTracker,
 * ProbeToTracker. An image's frame (columns, rows, normal; pixels) becomes a probe's at the middle of its
 * first row; any other is taken as it is. */
int poses_open(poses *p, in *source, const char *transform, err *e);

/* The next event; of a control, its words are those of p->lines, and what they mean is the caller's to know. 1: there
 * is one; 0: the end; -1: e filled, with the line: what is not a number or not finite, a quaternion that is not of
 * length 1, a matrix that is not a rotation, a time before that of the pose before. Frames of a sequence that were not
 * tracked are left out and counted in p->frames.skipped. */
int poses_next(poses *p, poses_event *to, err *e);

#endif
