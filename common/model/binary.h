/* The binary encoding of a model: a magic and a version, then blocks with a checksum each, little-endian. See
 * sinew-model(5). No state but the source's.
 */
#ifndef SINEW_BINARY_H
#define SINEW_BINARY_H

#include "model/item.h"

extern const encoding binary_encoding;

enum { BINARY_FIRST = 0x89 }; /* the first byte, for sniffing */

/* The checksum of the item's binary block. */
uint32_t binary_crc(const item *it);

#endif
