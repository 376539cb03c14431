#include "slice/import/dicom_inflate.h"

#define ZLIB_CONST
#include "base/mem.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { HEAD = 132, META = 2, SYNTAX = 0x10, PIECE = 1 << 16 };

static unsigned two(const unsigned char *p)
{
    return p[0] | (unsigned)p[1] << 8;
}

/* The end of the file's own head, which is always explicit and little-endian, and where in it the syntax is told; 0: no
 * head that says that the rest is deflated. */
static size_t end_of_head(const unsigned char *bytes, size_t size, size_t *syntax)
{
    static const char deflated[] = "1.2.840.10008.1.2.1.99";
    size_t at = HEAD;
    *syntax = 0;
    while (at < size && size - at >= 12 && two(bytes + at) == META) {
        const unsigned char *p = bytes + at;
        bool wide = !memcmp(p + 4, "OB", 2) || !memcmp(p + 4, "UN", 2);
        size_t head = wide ? 12 : 8;
        size_t length = wide ? two(p + 8) | (size_t)two(p + 10) << 16 : two(p + 6);
        if (length > size - at - head)
            return 0;
        if (two(p + 2) == SYNTAX && length >= sizeof deflated - 1 && !memcmp(p + head, deflated, sizeof deflated - 1))
            *syntax = at + head;
        at += head + length;
    }
    return *syntax ? at : 0;
}

bool dicom_is_deflated(const unsigned char *bytes, size_t size)
{
    size_t syntax;
    return end_of_head(bytes, size, &syntax) != 0;
}

typedef struct growing {
    unsigned char *bytes; /* owned */
    int64_t size, capacity;
} growing;

static int inflate_rest(growing *to, const unsigned char *from, size_t size, const char *name, err *e)
{
    z_stream z = {0};
    if (inflateInit2(&z, -MAX_WBITS) != Z_OK)
        return err_memory(e, "decompressing");
    int code = Z_OK, failed = 0;
    while (code == Z_OK) {
        failed = MEM_ROOM(&to->bytes, &to->capacity, to->size + PIECE, "a file", e);
        if (failed)
            break;
        uInt part = size < PIECE ? (uInt)size : PIECE;
        int64_t room = to->capacity - to->size < 1 << 30 ? to->capacity - to->size : 1 << 30;
        if (!z.avail_in) {
            z.next_in = from;
            z.avail_in = part;
            from += part;
            size -= part;
        }
        z.next_out = to->bytes + to->size;
        z.avail_out = (uInt)room;
        code = inflate(&z, Z_NO_FLUSH);
        to->size += room - z.avail_out;
    }
    inflateEnd(&z);
    if (!failed && code != Z_STREAM_END)
        return err_set(e, name, 0, "not whole, or damaged: deflated elements that do not end");
    return failed;
}

int dicom_inflate(const unsigned char *bytes, size_t size, unsigned char **plain, size_t *plain_size, const char *name,
                  err *e)
{
    size_t syntax, head = end_of_head(bytes, size, &syntax);
    growing to = {0};
    if (!head)
        return 0;
    if (mem_grow(&to.bytes, &to.capacity, (int64_t)head + PIECE, sizeof *to.bytes, "a file", e) || !to.bytes)
        return -1;
    memcpy(to.bytes, bytes, head);
    memset(to.bytes + syntax + strlen("1.2.840.10008.1.2.1"), 0, strlen(".99"));
    to.size = (int64_t)head;
    if (inflate_rest(&to, bytes + head, size - head, name, e)) {
        free(to.bytes);
        return -1;
    }
    *plain = to.bytes;
    *plain_size = (size_t)to.size;
    return 1;
}
