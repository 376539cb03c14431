/* The places of what lies in a body: a file that people write gives a volume image (and with it the model and the
 * surfaces made from it) and other surfaces, such as a skeleton and a skin, their places in one frame. PST figures 2
 * and 8. One thing a line:
 *
 *     volume             move=10cm,0,1.2m turn=0,0,0.7071068,0.7071068
 *     surface skin.obj   unit=mm move=0,0,2mm
 *     surface vein.obj   unit=mm in=volume
 *     surface teeth.obj  unit=mm in=jaw
 *
 * A place p in the part is at turn(p) + move in the body; in=volume: it is first where the volume is; in= another name:
 * as in the volume, but it moves with that rigid body of the model. A body owns its parts.
 */
#ifndef SINEW_BODY_H
#define SINEW_BODY_H

#include "base/in.h"
#include "base/pose.h"

typedef struct body_part {
    char *file;     /* a name without a folder: beside the body's own file */
    double scale;   /* to metres */
    pose place;     /* in the body, the volume's taken in */
    bool in_volume; /* it goes where the volume goes; place says it already */
    char *rigid;    /* the name of the model's rigid body that it moves with, or NULL; then it is in the volume */
    int64_t line;   /* of the file */
} body_part;

typedef struct body {
    pose volume; /* 0 and no turn where the file does not say */
    body_part *part;
    int parts;
    int64_t room; /* for parts */
} body;

/* Reads such a file, or any of those of place/transform.h, which say where the volume is alone. frames: see there. -1
 * with e filled: file and line. */
int body_read(body *b, in *s, const char *frames, err *e);

/* The same of the file at a path, which may be FILE:FROMToTO. */
int body_open(body *b, const char *path, err *e);

void body_free(body *b);

/* The part whose file has the name of this path's; NULL: there is none. */
const body_part *body_find(const body *b, const char *path);

/* Takes points of a part's file (x 3, in its unit) to where they are in the frame of the volume and of its model, m. */
void body_place(const body *b, const body_part *part, double *position, int64_t points);

#endif
