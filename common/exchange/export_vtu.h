/* VTK's XML file for unstructured grids (.vtu), as VTK's "XML File Formats" describes it: UInt64 headers, zlib, raw
 * appended data; and the collection (.pvd) that ParaView reads for frames. All in SI units. The out is the caller's.
 */
#ifndef SINEW_EXPORT_VTU_H
#define SINEW_EXPORT_VTU_H

#include "base/out.h"
#include "exchange/export_shape.h"

/* Writes the shape with all arrays of numbers over its points and cells, of the model and the frame; strings of tables
 * as field data. deformed: the points stand where the frame moved them. */
int export_vtu(const export_shape *x, bool deformed, out *to, err *e);

/* A collection, entry by entry. file: relative to the collection. */
void export_pvd_begin(out *to);
void export_pvd_add(out *to, double time, const char *file);
void export_pvd_end(out *to);

#endif
