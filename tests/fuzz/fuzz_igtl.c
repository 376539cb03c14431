/* Any bytes as a stream of OpenIGTLink, in pieces whose sizes the first byte decides: they come to the same messages
 * and errors as in one piece; each content is read, and what is read can be written and read again.
 */
// needs: common/link/track/track_pose.c
#include "link/big_endian.h"
#include "link/igtl_content.h"
#include "link/igtl_reader.h"
#include "link/track/track_pose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST = 1 << 16 };

static void must(bool good)
{
    if (!good)
        abort();
}

/* What reading did: -1 with a text, or 0 without. */
static bool read_well(int failed, err *e)
{
    must(failed == (e->status ? -1 : 0) && !e->status == !e->text[0]);
    *e = (err){0};
    return !failed;
}

static bool same(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static void try_poses(const igtl_message *m, err *e)
{
    track_pose p;
    int count = 0;
    if (track_kind_of(&m->header) == TRACK_KINDS || !read_well(track_pose_count(m, &count, "fuzz", e), e))
        return;
    for (int i = 0; i < count; i++)
        if (read_well(track_pose_read(m, i, &p, "fuzz", e), e)) {
            track_pose_status(m, &p);
            must(strlen(p.name) < TRACK_NAME && strlen(p.lost) < sizeof p.lost);
            for (int k = 0; k < 16 && !p.lost[0]; k++)
                must(isfinite(p.matrix[k]));
        }
}

/* What is read as a matrix is written as it was. */
static void try_transform(const igtl_message *m, igtl_buffer *b, err *e)
{
    double matrix[16], again[16];
    if (!read_well(igtl_read_transform(m, matrix, "fuzz", e), e))
        return;
    b->size = 0;
    must(!igtl_write_transform(b, matrix, e));
    const igtl_message copy = {.header = m->header, .content = b->at, .size = (size_t)b->size};
    must(!igtl_read_transform(&copy, again, "fuzz", e));
    for (int k = 0; k < 16; k++)
        must(same(matrix[k], again[k]));
}

static void try_image(const igtl_message *m, err *e)
{
    igtl_image image;
    if (!read_well(igtl_read_image(m, &image, "fuzz", e), e))
        return;
    must(image.pixels + image.pixels_size <= m->content + m->size && image.pixels_size > 0);
    for (int k = 0; k < 3; k++)
        must(image.part[k] + image.part[3 + k] <= image.size[k]);
}

static void try_surface(const igtl_message *m, err *e)
{
    igtl_surface s;
    if (!read_well(igtl_read_surface(m, &s, "fuzz", e), e))
        return;
    must(!s.points || s.point + 12 * s.points <= m->content + m->size);
    for (int64_t i = 0; i < s.triangles; i++)
        for (int k = 1; k < 4; k++)
            must(big_endian_get(s.triangle + 16 * i + 4 * k, 4) < (uint64_t)s.points);
}

/* Texts lie inside of the message. */
static bool inside(const igtl_message *m, const char *text, size_t size)
{
    const char *begin = (const char *)m->content;
    return text >= begin && size <= (size_t)(begin + m->size - text);
}

static void try_texts(const igtl_message *m, err *e)
{
    const char *text;
    size_t size;
    igtl_status status;
    igtl_command command;
    if (read_well(igtl_read_string(m, &text, &size, "fuzz", e), e))
        must(inside(m, text, size));
    if (read_well(igtl_read_status(m, &status, "fuzz", e), e))
        must(inside(m, status.text, status.text_size) && igtl_status_text(status.code));
    if (read_well(igtl_read_command(m, &command, "fuzz", e), e))
        must(inside(m, command.text, command.text_size));
    igtl_meta at;
    for (int i = 0; i < m->metas; i++) {
        igtl_meta_step(m, i, &at);
        must(at.value == at.key + at.key_size && at.key >= (const char *)m->content);
    }
}

static void try_rest(const igtl_message *m, err *e)
{
    char coordinates[IGTL_COORDINATES + 1];
    igtl_sensor sensor;
    uint32_t interval;
    int status;
    if (read_well(igtl_read_sensor(m, &sensor, "fuzz", e), e))
        must(sensor.count >= 0 && sensor.count <= IGTL_SENSOR_MOST);
    (void)read_well(igtl_read_answer(m, &status, "fuzz", e), e);
    if (read_well(igtl_read_start_tools(m, &interval, coordinates, "fuzz", e), e))
        must(strlen(coordinates) <= IGTL_COORDINATES);
}

/* As every kind of content, whatever its type says. */
static void try_contents(const igtl_message *m, igtl_buffer *b, err *e)
{
    try_poses(m, e);
    try_transform(m, b, e);
    try_image(m, e);
    try_surface(m, e);
    try_texts(m, e);
    try_rest(m, e);
}

/* ---- streams */

static bool wants(void *context, const igtl_header *h)
{
    (void)context;
    return h->type[0] != 'V'; /* one that nobody reads: VIDEO */
}

/* A sum of what comes. */
typedef struct heard {
    int64_t messages, wrong, skipped;
    uint64_t sum;
    bool lost, inside;
} heard;

static void take(igtl_reader *r, heard *to, igtl_buffer *b, bool contents)
{
    igtl_message m;
    err e = {0};
    for (igtl_got got; (got = igtl_reader_next(r, &m, &e)) != IGTL_MORE && !to->lost;) {
        must((got == IGTL_MESSAGE) == !e.status);
        e = (err){0};
        to->lost = got == IGTL_LOST;
        to->wrong += got == IGTL_WRONG;
        if (got != IGTL_MESSAGE)
            continue;
        to->messages++;
        to->sum = igtl_crc(to->sum ^ m.id, m.content, m.size);
        if (contents)
            try_contents(&m, b, &e);
    }
}

/* The stream in pieces of `piece` bytes. */
static heard hear(const uint8_t *data, size_t size, size_t piece, igtl_buffer *b, bool contents)
{
    heard to = {0};
    err e = {0};
    igtl_reader *r = igtl_reader_make(wants, NULL, MOST, "fuzz", &e);
    must(r != NULL);
    while (size && !to.lost) {
        size_t room;
        unsigned char *at = igtl_reader_room(r, &room);
        must(room > 0);
        size_t n = piece < size ? piece : size;
        n = n < room ? n : room;
        memcpy(at, data, n);
        igtl_reader_took(r, n);
        data += n;
        size -= n;
        take(r, &to, b, contents);
    }
    to.skipped = igtl_reader_skipped(r);
    to.inside = igtl_reader_inside(r);
    igtl_reader_free(r);
    return to;
}

/* The checksum of a stream's first message, so that mutations of contents are read too. */
static void mend(uint8_t *data, size_t size)
{
    if (size < IGTL_HEADER)
        return;
    const uint64_t body = big_endian_get(data + 42, 8);
    if (body <= size - IGTL_HEADER)
        big_endian_put(data + 50, igtl_crc(0, data + IGTL_HEADER, (size_t)body), 8);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    igtl_buffer b = {0};
    if (size < 1)
        return 0;
    const size_t piece = 1 + data[0] % 128u;
    uint8_t *copy = malloc(size);
    must(copy != NULL);
    memcpy(copy, data + 1, size - 1);
    if (data[0] < 128)
        mend(copy, size - 1);
    const heard one = hear(copy, size - 1, SIZE_MAX, &b, true), parts = hear(copy, size - 1, piece, &b, false);
    must(one.messages == parts.messages && one.wrong == parts.wrong && one.skipped == parts.skipped);
    must(one.sum == parts.sum && one.lost == parts.lost && (one.lost || one.inside == parts.inside));
    igtl_buffer_free(&b);
    free(copy);
    return 0;
}
