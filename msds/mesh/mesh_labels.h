/* What elements are made of: a model's table of volumes, all of one, or by the labels of an image. Each
 * element is of the label at its centre; what has none (0, or outside the image) is of the volume
 * `tissue`. The table of materials must be there.
 */
#ifndef SINEW_MESH_LABELS_H
#define SINEW_MESH_LABELS_H

#include "model/model.h"
#include "volume/volume.h"

/* Which labels have no tetrahedra on purpose, and are not told of. */
typedef struct mesh_without {
    bool (*is)(const void *context, int64_t label);
    const void *context;
} mesh_without;

/* Adds volume.* and element.volume. labels: NULL: all is tissue. given: the label of each element, in place of that at
 * its centre, or NULL. A label is named as the image names it, else labelN; two labels of one name are one volume. A
 * volume is of the material of its name, else of the first. -1 with e filled: labels that are not whole numbers, no
 * memory. where: the image's name. What labels the image or its names have, but no element, is noted, but for those of
 * without, which may be NULL. */
int mesh_label(model *m, const volume *labels, const char *where, const int64_t *given, const mesh_without *without,
               notes *warnings, err *e);

/* Names labels by "1=bone,2=vein". -1 with e filled (a usage error). */
int mesh_label_names(volume *labels, const char *list, err *e);

#endif
