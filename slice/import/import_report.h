/* What us-import --report says: what the volume is, what was used and what was left out, by name and never by value.
 * Everything but the elements is plain numbers.
 */
#ifndef SINEW_IMPORT_REPORT_H
#define SINEW_IMPORT_REPORT_H

#include "cli/tool.h"
#include "slice/import/dicom_image.h"
#include "slice/import/import_files.h"
#include "volume/volume.h"

typedef struct import_report {
    import_kind kind;
    dicom_elements elements; /* of DICOM files; owned */
    int64_t burned, unsaid;  /* files that say that annotation is burned in, that say nothing of it */
    bool own_frame, private_geometry;
} import_report;

int import_print(const import_report *r, const volume *v, const tool *t, err *e);

#endif
