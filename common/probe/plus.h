/* The frames of a tracked sequence as PLUS writes them into the header of a MetaImage or NRRD file: keys
 * Seq_FrameNNNN_…Transform (4 x 4, mm), …TransformStatus and …Timestamp. A reader has one frame at a time and
 * allocates nothing; the stream stays the caller's.
 */
#ifndef SINEW_PLUS_H
#define SINEW_PLUS_H

#include "base/in.h"
#include "place/links.h"

enum { PLUS_TRANSFORMS = 16 };

typedef struct plus_frame {
    int64_t number, line; /* -1: none; the line of its last key */
    double time;          /* s; nan: not given */
    int count;
    links_transform transform[PLUS_TRANSFORMS];
} plus_frame;

typedef struct plus {
    in *source;
    bool nrrd, ended;
    int64_t width;                         /* columns of its images, 0: not known yet */
    char orientation[8];                   /* UltrasoundImageOrientation, as far as it fits; "": not said yet */
    char from[LINKS_NAME], to[LINKS_NAME]; /* what is asked for; "": not chosen yet */
    plus_frame frame;                      /* as far as its keys were read */
    char *held;                            /* the stream's line, which begins the frame after; NULL: none */
    int64_t skipped;                       /* frames that were not tracked */
} plus;

/* transform: "ProbeToReference", or NULL (see poses.h). */
int plus_open(plus *p, in *source, const char *transform, err *e);

/* The next tracked frame: its time, s, its line, and what takes `from` to `to`, 16
 * numbers in mm. 1, 0 at the end, -1. */
int plus_next(plus *p, double *time, int64_t *line, double m[16], err *e);

#endif
