/* The CRC-32 of gzip and PNG, as zlib's crc32() computes it, several times faster where the processor multiplies
 * polynomials (x86-64 with PCLMULQDQ, or VPCLMULQDQ and AVX-512; asked at run time). Keeps nothing.
 */
#ifndef SINEW_CHECKSUM_H
#define SINEW_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

/* The checksum of what crc is the checksum of (0: nothing) and then these bytes. */
uint32_t checksum_add(uint32_t crc, const void *bytes, size_t size);

#endif
