/* Messages of OpenIGTLink (openigtlink.org, Documents/Protocol): their header, checksum, extended header and metadata;
 * what their contents are is in igtl_content.h. All numbers are big-endian.
 *
 *     bytes  0        2          14            34          42          50    58
 *            | version | type     | device name | time stamp | body size | CRC | body
 *
 * A body of header version 1 (protocols 1 and 2) is the content. Of version 2 (protocol 3) it is
 *
 *     size of the extended header (2), of the metadata's header (2), of the metadata (4), message id (4) | content |
 *     metadata's header: their number (2), and of each the size of its key (2), encoding (2), size (4) | keys, values
 *
 * A message that was read borrows the bytes that it was read from; a buffer owns its bytes.
 */
#ifndef SINEW_IGTL_H
#define SINEW_IGTL_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

enum { IGTL_HEADER = 58, IGTL_TYPE = 12, IGTL_DEVICE = 20, IGTL_EXTENDED = 12, IGTL_ASCII = 3 /* of IANA: US-ASCII */ };

typedef struct igtl_header {
    int version; /* 1 or 2 */
    char type[IGTL_TYPE + 1];
    char device[IGTL_DEVICE + 1];
    uint64_t stamp; /* s since 1970, with 32 bits behind the point; 0: not said */
    uint64_t size;  /* bytes of the body */
    uint64_t crc;   /* of the body */
} igtl_header;

typedef struct igtl_message {
    igtl_header header;
    uint32_t id; /* of header version 2; else 0 */
    const unsigned char *content;
    size_t size;                    /* of the content */
    const unsigned char *meta_head; /* the metadata's header; NULL: there are none */
    const unsigned char *meta;      /* keys and values */
    int metas;
} igtl_message;

/* Adds bytes to a checksum: CRC-64 of ECMA-182, x^64 + x^62 + ... (42F0E1EBA9EA3693), the highest bit first; of nothing
 * it is 0, and it is not inverted. */
uint64_t igtl_crc(uint64_t crc, const void *bytes, size_t size);

/* A time stamp as seconds since 1970, and the way back; what is negative or not finite becomes 0. */
double igtl_seconds(uint64_t stamp);
uint64_t igtl_stamp(double seconds);

/* Now, by the system's clock. */
uint64_t igtl_now(void);

/* Reads IGTL_HEADER bytes. -1 with e filled where this cannot be a header: its version is not 1 or 2, its type is not
 * made of printable characters or empty. place names the sender. */
int igtl_read_header(igtl_header *h, const unsigned char *bytes, const char *place, err *e);

/* Checks a body's checksum and divides it. -1 with e filled. */
int igtl_read_body(igtl_message *m, const igtl_header *h, const unsigned char *body, const char *place, err *e);

/* The metadata of index i (0 to m->metas - 1). Key and value are not terminated. */
typedef struct igtl_meta {
    const char *key, *value;
    size_t key_size, value_size;
} igtl_meta;
igtl_meta igtl_meta_at(const igtl_message *m, int i);

/* From the metadata of index i - 1 to that of index i, at once; for 0, *at may be anything. */
void igtl_meta_step(const igtl_message *m, int i, igtl_meta *at);

/* Bytes to send, or a content on its way to be one. Zeroed: empty. */
typedef struct igtl_buffer {
    unsigned char *at;
    int64_t size, room;
} igtl_buffer;

/* Makes room for `size` more bytes, counts them as there, and returns the first; NULL with e filled. */
unsigned char *igtl_add(igtl_buffer *b, int64_t size, err *e);
void igtl_buffer_free(igtl_buffer *b);

/* What a message says besides its content. Texts are borrowed; longer ones than their fields are cut. */
typedef struct igtl_about {
    int version;
    const char *type, *device;
    uint64_t stamp;
    uint32_t id;                  /* of version 2 */
    const char *const (*pair)[2]; /* metadata of version 2: keys and values in ASCII, less than 64 KiB each */
    int pairs;
} igtl_about;

/* Adds the whole message. -1 with e filled, and the buffer as it was. */
int igtl_write(igtl_buffer *to, const igtl_about *about, const void *content, int64_t size, err *e);

#endif
