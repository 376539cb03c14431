/* The transforms of a PLUS configuration: <CoordinateDefinitions><Transform From="Image" To="Probe" Matrix="..."/>, in
 * mm. Probe is what PLUS calls the marker on the probe. A transform that the file does not have itself is made of those
 * that it has, and of their inverses. From TransducerOrigin (or its pixels), the middle of the array on an image whose
 * x goes along its columns and whose y goes down, it becomes the probe's own frame; all else is taken as it is. It
 * keeps nothing.
 */
#ifndef SINEW_PLUS_CONFIG_H
#define SINEW_PLUS_CONFIG_H

#include "place/transform.h"

/* f->frames NULL: for a marker, TransducerOriginToProbe or ProbeToProbeMarker where the file leads to one of them. -1
 * with e filled, which says what transforms there are. */
int plus_config_read(const transform_file *f, pose *to, err *e);

#endif
