/* Poses out of OpenIGTLink's messages: of a TRANSFORM or a POSITION one, of a TDATA one a tool; and whether its sender
 * says that it is tracked. Owns nothing.
 */
#ifndef SINEW_TRACK_POSE_H
#define SINEW_TRACK_POSE_H

#include "link/igtl_content.h"

enum { TRACK_NAME = 128 };

typedef enum track_kind { TRACK_TRANSFORM, TRACK_POSITION, TRACK_TOOLS, TRACK_KINDS } track_kind;

/* Which of these a message is; TRACK_KINDS: none. */
track_kind track_kind_of(const igtl_header *h);

typedef struct track_pose {
    track_kind kind;
    char name[TRACK_NAME]; /* the device's, or the tool's */
    uint64_t stamp;        /* as igtl_header has it */
    double matrix[16];     /* mm, in the sender's space */
    char lost[40];         /* why this is no pose, as "it is OUT_OF_VIEW"; "": it is one */
} track_pose;

/* How many poses a message of one of the kinds has, and which. PLUS's IGTL_DEVICE_NAME, in the metadata, is a name of
 * more than 20 bytes. A matrix of zeros, as trackers send where they see nothing, and one that is not finite, are no
 * poses. -1 with e filled, as igtl_content.h says. */
int track_pose_count(const igtl_message *m, int *count, const char *place, err *e);
int track_pose_read(const igtl_message *m, int i, track_pose *to, const char *place, err *e);

/* Adds what PLUS says of the pose in the metadata: TransformStatus, or a tool's name and Status, is OK, or MISSING,
 * OUT_OF_VIEW, OUT_OF_VOLUME ... */
void track_pose_status(const igtl_message *m, track_pose *to);

/* Whether the pose is the one that people call so: its name, or the 20 bytes of a longer name that a message has. */
bool track_pose_is(const track_pose *p, const char *name);

#endif
