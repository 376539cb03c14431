/* Names of labels in NRRD's keys, as Slicer writes them for its segmentations: SegmentN_Name, SegmentN_LabelValue. A
 * labels_in owns what it has gathered until it is given to a volume.
 */
#ifndef SINEW_NRRD_LABELS_H
#define SINEW_NRRD_LABELS_H

#include "volume/volume.h"

typedef struct labels_entry {
    int64_t number, value;
    bool valued;
    char *name;
} labels_entry;

typedef struct labels_in {
    labels_entry *entry;
    int64_t count, room;
} labels_in;

/* Takes in one key; any other is passed over. s: for the place of an error. */
int labels_in_take(labels_in *l, const in *s, const char *key, char *value, err *e);

/* Names the labels that have a name and a value. */
int labels_in_give(const labels_in *l, volume *v, err *e);
void labels_in_free(labels_in *l);

/* Writes the keys of a volume's labels. */
void labels_write(const volume *v, out *to);

#endif
