#include "link/igtl.h"

#include "base/mem.h"
#include "link/big_endian.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define SECOND 4294967296.0 /* 2^32: one second of a time stamp */

/* table[k][b]: the checksum of the byte b with k zeros behind it. Eight bytes are looked up at once (Kounavis and
 * Berry, A systematic approach to building high performance software-based CRC generators, 2005). A checksum is
 * linear: that of a byte is the sum of those of its bits, which are x^(64 + 8 k) to x^(71 + 8 k) modulo the
 * polynomial. */
#define BIT(byte, bit, power) ((power) * ((byte) >> (bit)&1u))
#define BYTE(b, p0, p1, p2, p3, p4, p5, p6, p7)                                                                        \
    (BIT(b, 0, p0) ^ BIT(b, 1, p1) ^ BIT(b, 2, p2) ^ BIT(b, 3, p3) ^ BIT(b, 4, p4) ^ BIT(b, 5, p5) ^ BIT(b, 6, p6) ^   \
     BIT(b, 7, p7))
#define BYTES_4(b, ...)                                                                                                \
    BYTE((b), __VA_ARGS__), BYTE((b) + 1, __VA_ARGS__), BYTE((b) + 2, __VA_ARGS__), BYTE((b) + 3, __VA_ARGS__)
#define BYTES_16(b, ...)                                                                                               \
    BYTES_4(b, __VA_ARGS__), BYTES_4((b) + 4, __VA_ARGS__), BYTES_4((b) + 8, __VA_ARGS__),                             \
        BYTES_4((b) + 12, __VA_ARGS__)
#define BYTES_64(b, ...)                                                                                               \
    BYTES_16(b, __VA_ARGS__), BYTES_16((b) + 16, __VA_ARGS__), BYTES_16((b) + 32, __VA_ARGS__),                        \
        BYTES_16((b) + 48, __VA_ARGS__)
#define BYTES(...)                                                                                                     \
    BYTES_64(0u, __VA_ARGS__), BYTES_64(64u, __VA_ARGS__), BYTES_64(128u, __VA_ARGS__), BYTES_64(192u, __VA_ARGS__)
static const uint64_t table[8][256] = {
    {BYTES(0x42f0e1eba9ea3693u, 0x85e1c3d753d46d26u, 0x493366450e42ecdfu, 0x9266cc8a1c85d9beu, 0x663d78ff90e185efu,
           0xcc7af1ff21c30bdeu, 0xda050215ea6c212fu, 0xf6fae5c07d3274cdu)},
    {BYTES(0xaf052a6b538edf09u, 0x1cfab53d0ef78881u, 0x39f56a7a1def1102u, 0x73ead4f43bde2204u, 0xe7d5a9e877bc4408u,
           0x8d5bb23b4692be83u, 0x5847859d24cf4b95u, 0xb08f0b3a499e972au)},
    {BYTES(0x23eef79f3ad718c7u, 0x47ddef3e75ae318eu, 0x8fbbde7ceb5c631cu, 0x5d875d127f52f0abu, 0xbb0eba24fea5e156u,
           0x34ed95a254a1f43fu, 0x69db2b44a943e87eu, 0xd3b656895287d0fcu)},
    {BYTES(0xe59c4cf90ce5976bu, 0x89c87819b0211845u, 0x516011d8c9a80619u, 0xa2c023b193500c32u, 0x0770a6888f4a2ef7u,
           0x0ee14d111e945deeu, 0x1dc29a223d28bbdcu, 0x3b8534447a5177b8u)},
    {BYTES(0x770a6888f4a2ef70u, 0xee14d111e945dee0u, 0x9ed943c87b618b53u, 0x7f42667b5f292035u, 0xfe84ccf6be52406au,
           0xbff97806d54eb647u, 0x3d0211e603775a1du, 0x7a0423cc06eeb43au)},
    {BYTES(0xf40847980ddd6874u, 0xaae06edbb250e67bu, 0x17303c5ccd4bfa65u, 0x2e6078b99a97f4cau, 0x5cc0f173352fe994u,
           0xb981e2e66a5fd328u, 0x31f324277d5590c3u, 0x63e6484efaab2186u)},
    {BYTES(0xc7cc909df556430cu, 0xcd69c0d04346b08bu, 0xd823604b2f675785u, 0xf2b6217df7249999u, 0xa79ca31047a305a1u,
           0x0dc9a7cb26ac3dd1u, 0x1b934f964d587ba2u, 0x37269f2c9ab0f744u)},
    {BYTES(0x6e4d3e593561ee88u, 0xdc9a7cb26ac3dd10u, 0xfbc4188f7c6d8cb3u, 0xb578d0f551312ff5u, 0x280140010b886979u,
           0x500280021710d2f2u, 0xa00500042e21a5e4u, 0x02fae1e3f5a97d5bu)},
};

uint64_t igtl_crc(uint64_t crc, const void *bytes, size_t size)
{
    const unsigned char *p = bytes;
    for (; size >= 8; p += 8, size -= 8) {
        const uint64_t v = crc ^ big_endian_get(p, 8);
        crc = 0;
        for (int k = 0; k < 8; k++)
            crc ^= table[k][v >> (8 * k) & 255];
    }
    for (; size; p++, size--)
        crc = crc << 8 ^ table[0][(crc >> 56 ^ *p) & 255];
    return crc;
}

double igtl_seconds(uint64_t stamp)
{
    return (double)(stamp >> 32) + (double)(stamp & UINT32_MAX) / SECOND;
}

uint64_t igtl_stamp(double seconds)
{
    if (!(seconds > 0) || !(seconds < SECOND))
        return 0;
    const double whole = floor(seconds);
    return (uint64_t)whole << 32 | (uint64_t)((seconds - whole) * SECOND);
}

uint64_t igtl_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_REALTIME, &t);
    return (uint64_t)t.tv_sec << 32 | (uint64_t)((double)t.tv_nsec * 1e-9 * SECOND);
}

/* Whether a field is printable text, filled up with zeros. */
static bool is_text(const unsigned char *field, size_t size)
{
    size_t n = 0;
    while (n < size && field[n] >= ' ' && field[n] < 127)
        n++;
    const size_t text = n;
    while (n < size && !field[n])
        n++;
    return text > 0 && n == size;
}

int igtl_read_header(igtl_header *h, const unsigned char *bytes, const char *place, err *e)
{
    h->version = (int)big_endian_get(bytes, 2);
    big_endian_get_text(h->type, bytes + 2, IGTL_TYPE);
    big_endian_get_text(h->device, bytes + 14, IGTL_DEVICE);
    h->stamp = big_endian_get(bytes + 34, 8);
    h->size = big_endian_get(bytes + 42, 8);
    h->crc = big_endian_get(bytes + 50, 8);
    if (h->version != 1 && h->version != 2)
        return err_set(e, place, 0, "no OpenIGTLink: the version of a header is %d; expected 1 or 2", h->version);
    if (!is_text(bytes + 2, IGTL_TYPE))
        return err_set(e, place, 0, "no OpenIGTLink: the type of a message is no text");
    return 0;
}

/* Metadata's header and keys and values in the `size` bytes after the content. */
static int read_meta(igtl_message *m, const unsigned char *from, size_t head, size_t size)
{
    if (!head && !size)
        return 0;
    const size_t count = head < 2 ? 0 : (size_t)big_endian_get(from, 2);
    size_t sum = 0;
    if (head < 2 || 2 + 8 * count > head)
        return -1;
    for (size_t i = 0; i < count; i++)
        sum += (size_t)big_endian_get(from + 2 + 8 * i, 2) + (size_t)big_endian_get(from + 6 + 8 * i, 4);
    if (sum > size)
        return -1;
    m->meta_head = from;
    m->meta = from + head;
    m->metas = (int)count;
    return 0;
}

static int read_extended(igtl_message *m, const unsigned char *body, size_t size)
{
    if (size < IGTL_EXTENDED)
        return -1;
    const size_t extended = (size_t)big_endian_get(body, 2), head = (size_t)big_endian_get(body + 2, 2);
    const size_t meta = (size_t)big_endian_get(body + 4, 4);
    m->id = (uint32_t)big_endian_get(body + 8, 4);
    if (extended < IGTL_EXTENDED || extended + head + meta > size)
        return -1;
    m->content = body + extended;
    m->size = size - extended - head - meta;
    return read_meta(m, m->content + m->size, head, meta);
}

int igtl_read_body(igtl_message *m, const igtl_header *h, const unsigned char *body, const char *place, err *e)
{
    *m = (igtl_message){.header = *h, .content = body, .size = (size_t)h->size};
    const uint64_t crc = igtl_crc(0, body, (size_t)h->size);
    if (crc != h->crc)
        return err_set(e, place, 0, "%s '%s': the checksum is %016llx, its header says %016llx", h->type, h->device,
                       (unsigned long long)crc, (unsigned long long)h->crc);
    if (h->version >= 2 && read_extended(m, body, m->size))
        return err_set(e, place, 0, "%s '%s': the extended header or metadata do not fit into its %llu bytes", h->type,
                       h->device, (unsigned long long)h->size);
    return 0;
}

igtl_meta igtl_meta_at(const igtl_message *m, int i)
{
    const unsigned char *at = m->meta;
    igtl_meta to = {0};
    for (int k = 0; k <= i; k++) {
        const unsigned char *head = m->meta_head + 2 + 8 * k;
        to.key_size = (size_t)big_endian_get(head, 2);
        to.value_size = (size_t)big_endian_get(head + 4, 4);
        to.key = (const char *)at;
        to.value = (const char *)at + to.key_size;
        at += to.key_size + to.value_size;
    }
    return to;
}

unsigned char *igtl_add(igtl_buffer *b, int64_t size, err *e)
{
    const int64_t need = b->size + size;
    if (MEM_ROOM(&b->at, &b->room, need > 0 ? need : 1, "a message", e)) /* of nothing there is a first byte, too */
        return NULL;
    b->size += size;
    return b->at + b->size - size;
}

void igtl_buffer_free(igtl_buffer *b)
{
    free(b->at);
    *b = (igtl_buffer){0};
}

/* Bytes of keys and values. */
static int64_t meta_size(const igtl_about *a)
{
    int64_t sum = 0;
    for (int i = 0; i < a->pairs; i++)
        sum += (int64_t)(strlen(a->pair[i][0]) + strlen(a->pair[i][1]));
    return sum;
}

static void put_meta(unsigned char *to, const igtl_about *a)
{
    unsigned char *text = to + 2 + 8 * (size_t)a->pairs;
    to = big_endian_put(to, (uint64_t)a->pairs, 2);
    for (int i = 0; i < a->pairs; i++) {
        const size_t key = strlen(a->pair[i][0]), value = strlen(a->pair[i][1]);
        to = big_endian_put(to, key, 2);
        to = big_endian_put(to, IGTL_ASCII, 2);
        to = big_endian_put(to, value, 4);
        text = big_endian_put_text(text, a->pair[i][0], key);
        text = big_endian_put_text(text, a->pair[i][1], value);
    }
}

int igtl_write(igtl_buffer *to, const igtl_about *a, const void *content, int64_t size, err *e)
{
    const bool extended = a->version >= 2;
    const int64_t head = extended && a->pairs ? 2 + 8 * (int64_t)a->pairs : 0, meta = head ? meta_size(a) : 0;
    const int64_t body = size + head + meta + (extended ? IGTL_EXTENDED : 0);
    unsigned char *at = igtl_add(to, IGTL_HEADER + body, e), *p = at;
    if (!at)
        return -1;
    p = big_endian_put(p, (uint64_t)a->version, 2);
    p = big_endian_put_text(p, a->type, IGTL_TYPE);
    p = big_endian_put_text(p, a->device, IGTL_DEVICE);
    p = big_endian_put(p, a->stamp, 8);
    p = big_endian_put(p, (uint64_t)body, 8) + 8;
    if (extended) {
        p = big_endian_put(p, IGTL_EXTENDED, 2);
        p = big_endian_put(p, (uint64_t)head, 2);
        p = big_endian_put(p, (uint64_t)meta, 4);
        p = big_endian_put(p, a->id, 4);
    }
    if (size)
        memcpy(p, content, (size_t)size);
    if (head)
        put_meta(p + size, a);
    big_endian_put(at + 50, igtl_crc(0, at + IGTL_HEADER, (size_t)body), 8);
    return 0;
}
