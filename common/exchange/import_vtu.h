/* VTK's XML files of unstructured grids (.vtu), as VTK's "XML File Formats" describes them: one piece; data as ASCII,
 * inline base64, or appended, raw or base64, whole or in blocks of zlib; 32- or 64-bit headers, either order of bytes.
 * The file is held in memory while it is read.
 */
#ifndef SINEW_IMPORT_VTU_H
#define SINEW_IMPORT_VTU_H

#include "base/in.h"
#include "exchange/import_mesh.h"

/* Volumes from the cell data `volume` (else `material`), with the names of the field data volume.name; fibres from
 * `fibre`, normals of the skin from `normal`; rigid nodes where the point data `rigid`, and what the wishes name,
 * is not 0. -1 with e at file:line. */
int import_vtu(import_mesh *m, in *s, const import_wishes *wishes, notes *warnings, err *e);

#endif
