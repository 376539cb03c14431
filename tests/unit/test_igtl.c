// OpenIGTLink's messages: bytes written out by hand from the specification, both ways; and what is wrong with others.
#include "link/big_endian.h"
#include "link/igtl_content.h"
#include "link/igtl_reader.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

/* The checksum bit by bit, as the standard defines it. */
static uint64_t crc_by_bits(const unsigned char *p, size_t size)
{
    uint64_t v = 0;
    for (size_t i = 0; i < size; i++)
        for (int bit = 7; bit >= 0; bit--) {
            const uint64_t out = (v >> 63 ^ (uint64_t)(p[i] >> bit)) & 1;
            v = v << 1 ^ (out ? 0x42f0e1eba9ea3693u : 0);
        }
    return v;
}

static void try_crc(void)
{
    unsigned char bytes[300];
    bool same = true, split = true;
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char)(i * 151 + i / 7);
    for (size_t n = 0; n <= sizeof bytes; n++) {
        same = same && igtl_crc(0, bytes, n) == crc_by_bits(bytes, n);
        split =
            split && igtl_crc(igtl_crc(0, bytes, n), bytes + n, sizeof bytes - n) == crc_by_bits(bytes, sizeof bytes);
    }
    ok(igtl_crc(0, "123456789", 9) == 0x6c40df5f0b497347u, "the checksum of '123456789' is the standard's");
    ok(same, "and of any bytes that of a division bit by bit");
    ok(split, "in any two pieces");
}

/* A message of header version 2 with one metadatum, byte by byte: STRING 'Say' of device 'Probe', id 7, "hi". */
static const unsigned char string_2[] = {
    0,   2,   'S', 'T', 'R',  'I', 'N', 'G', 0, 0, 0, 0, 0, 0, 'P', 'r', 'o',
    'b', 'e', 0,   0,   0,    0,   0,   0,   0, 0, 0, 0, 0, 0, 0,   0,   0, // version, type (12), device (20)
    0,   0,   0,   5,   0x80, 0,   0,   0,                                  // 5.5 s
    0,   0,   0,   0,   0,    0,   0,   33,                                 // 12 + 6 + 10 + 5 bytes
    0,   0,   0,   0,   0,    0,   0,   0,                                  // the checksum: filled in below
    0,   12,  0,   10,  0,    0,   0,   5,   0, 0, 0, 7,                    // the extended header
    0,   3,   0,   2,   'h',  'i',                                          // the content
    0,   1,   0,   3,   0,    3,   0,   0,   0, 2, // one metadatum: a key of 3 bytes, ASCII, a value of 2
    'k', 'e', 'y', 'v', '1',
};

static void fill_string_2(unsigned char to[sizeof string_2])
{
    memcpy(to, string_2, sizeof string_2);
    big_endian_put(to + 50, crc_by_bits(string_2 + 58, sizeof string_2 - 58), 8);
}

static void try_extended(void)
{
    static const char *const pair[][2] = {{"key", "v1"}};
    const igtl_about about = {
        .version = 2, .type = "STRING", .device = "Probe", .stamp = igtl_stamp(5.5), .id = 7, .pair = pair, .pairs = 1};
    unsigned char want[sizeof string_2];
    igtl_buffer content = {0}, whole = {0};
    igtl_header h;
    igtl_message m;
    const char *text = "";
    size_t size = 0;
    err e = {0};
    fill_string_2(want);
    ok(!igtl_write_string(&content, "hi", 2, &e) && !igtl_write(&whole, &about, content.at, content.size, &e),
       "a message of version 2 is written");
    ok(whole.size == (int64_t)sizeof want && !memcmp(whole.at, want, sizeof want), "its bytes are the specification's");
    ok(!igtl_read_header(&h, want, "x", &e) && !igtl_read_body(&m, &h, want + 58, "x", &e), "and it is read");
    ok(m.id == 7 && m.metas == 1 && igtl_seconds(h.stamp) == 5.5, "with its id and its time");
    const igtl_meta meta = igtl_meta_at(&m, 0);
    ok(meta.key_size == 3 && !memcmp(meta.key, "key", 3) && meta.value_size == 2 && !memcmp(meta.value, "v1", 2),
       "with its metadata");
    ok(!igtl_read_string(&m, &text, &size, "x", &e) && size == 2 && !memcmp(text, "hi", 2), "and its content");
    for (size_t at = 58; at < 70; at++) {
        unsigned char bad[sizeof want];
        memcpy(bad, want, sizeof bad);
        bad[at] = 0xff;
        big_endian_put(bad + 50, crc_by_bits(bad + 58, sizeof bad - 58), 8);
        err wrong = {0};
        igtl_read_header(&h, bad, "x", &wrong);
        if (at < 66)
            ok(igtl_read_body(&m, &h, bad + 58, "x", &wrong) == -1, "byte %zu of its sizes wrong: %s", at, wrong.text);
    }
    igtl_buffer_free(&content);
    igtl_buffer_free(&whole);
}

static void try_transform(void)
{
    static const double matrix[16] = {0, -1, 0, 10, 1, 0, 0, -20.5, 0, 0, 1, 30, 0, 0, 0, 1};
    static const float columns[12] = {0, 1, 0, -1, 0, 0, 0, 0, 1, 10, -20.5f, 30};
    unsigned char want[48], *p = want;
    igtl_buffer b = {0};
    double got[16];
    err e = {0};
    for (int i = 0; i < 12; i++) {
        uint32_t bits;
        memcpy(&bits, &columns[i], 4);
        p = big_endian_put(p, bits, 4);
    }
    ok(!igtl_write_transform(&b, matrix, &e) && b.size == 48 && !memcmp(b.at, want, 48),
       "a transform is 3 x 4 numbers, columns first");
    const igtl_message m = {.content = want, .size = sizeof want}, less = {.content = want, .size = 47};
    ok(!igtl_read_transform(&m, got, "x", &e) && !memcmp(got, matrix, sizeof got), "and is read so");
    ok(igtl_read_transform(&less, got, "x", &e) == -1 && strstr(e.text, "47 bytes; expected at least 48"), "%s",
       e.text);
    igtl_buffer_free(&b);
}

/* 3 x 2 pixels of 2 x 4 mm, the first at 10, 20, 30: the middle is 1 pixel to the right and half a one down. */
static void try_image(void)
{
    static const unsigned char pixels[6] = {1, 2, 3, 4, 5, 6};
    igtl_image i = {.components = 1,
                    .scalar = IGTL_UINT8,
                    .coordinates = IGTL_RAS,
                    .size = {3, 2, 1},
                    .matrix = {2, 0, 0, 10, 0, 4, 0, 20, 0, 0, 1, 30, 0, 0, 0, 1},
                    .pixels = pixels,
                    .pixels_size = 6,
                    .part = {0, 0, 0, 3, 2, 1}},
               back;
    igtl_buffer b = {0};
    err e = {0};
    ok(!igtl_write_image(&b, &i, &e) && b.size == 78, "an image is 72 bytes and its pixels");
    static const unsigned char head[12] = {0, 1, 1, 3, 1, 1, 0, 3, 0, 2, 0, 1};
    ok(!memcmp(b.at, head, 12), "version 1, one component, uint8, big-endian, RAS, its size");
    ok(big_endian_get_float(b.at + 48) == 12 && big_endian_get_float(b.at + 52) == 22 &&
           big_endian_get_float(b.at + 56) == 30,
       "its position is the middle, at (size - 1)/2");
    igtl_message m = {.content = b.at, .size = (size_t)b.size};
    ok(!igtl_read_image(&m, &back, "x", &e) && !memcmp(back.matrix, i.matrix, sizeof i.matrix) &&
           back.pixels_size == 6 && !memcmp(back.pixels, pixels, 6),
       "read back, it is the same");
    m.size--;
    ok(igtl_read_image(&m, &back, "x", &e) == -1 && strstr(e.text, "77 bytes"), "%s", e.text);
    igtl_buffer_free(&b);
}

static void try_surface(void)
{
    static const double position[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const int32_t triangle[] = {0, 1, 2};
    igtl_buffer b = {0};
    igtl_surface s;
    err e = {0};
    ok(!igtl_write_surface(&b, position, 3, triangle, 1, &e) && b.size == 40 + 36 + 16, "a surface is written");
    igtl_message m = {.content = b.at, .size = (size_t)b.size};
    ok(!igtl_read_surface(&m, &s, "x", &e) && s.points == 3 && s.triangles == 1 && big_endian_get(s.triangle, 4) == 3 &&
           big_endian_get_float(s.point + 12) == 1,
       "and read");
    b.at[40 + 36 + 15] = 3;
    ok(igtl_read_surface(&m, &s, "x", &e) == -1 && strstr(e.text, "polygon 0"), "%s", e.text);
    igtl_buffer_free(&b);
}

static void try_command(void)
{
    static const char text[] = "<Command Name=\"SetUsParameter\"/>";
    const igtl_command c = {.id = 258, .name = "SetUsParameter", .text = text, .text_size = sizeof text - 1};
    igtl_command back;
    igtl_buffer b = {0};
    err e = {0};
    ok(!igtl_write_command(&b, &c, &e) && b.size == 138 + (int64_t)sizeof text - 1,
       "a command is 138 bytes and its text");
    static const unsigned char id[4] = {0, 0, 1, 2}, encoding_size[6] = {0, 3, 0, 0, 0, 32};
    ok(!memcmp(b.at, id, 4) && !strcmp((char *)b.at + 4, "SetUsParameter") && !memcmp(b.at + 132, encoding_size, 6),
       "its id, its name of 128 bytes, ASCII, its size");
    igtl_message m = {.content = b.at, .size = (size_t)b.size};
    ok(!igtl_read_command(&m, &back, "x", &e) && back.id == 258 && !strcmp(back.name, c.name) &&
           back.text_size == c.text_size && !memcmp(back.text, text, back.text_size),
       "read back, it is the same");
    m.size--;
    ok(igtl_read_command(&m, &back, "x", &e) == -1, "one byte less: %s", e.text);
    igtl_buffer_free(&b);
}

static void try_rest(void)
{
    const igtl_tool tool = {.name = "Stylus", .type = 2, .matrix = {1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1}};
    const igtl_status status = {
        .code = IGTL_TIME_OUT, .subcode = -2, .name = "Lost", .text = "no camera", .text_size = 9};
    const igtl_sensor sensor = {.count = 3, .unit = IGTL_NEWTON, .value = {1, -2, .5}};
    static const double position[3] = {1, 2, 3}, quaternion[4] = {.5, .5, .5, .5};
    igtl_buffer b = {0};
    igtl_tool tool_back;
    igtl_status status_back;
    igtl_sensor sensor_back;
    double p[3], q[4];
    int count = 0;
    err e = {0};
    ok(!igtl_write_tool(&b, &tool, &e) && !igtl_write_tool(&b, &tool, &e) && b.size == 140, "a tool is 70 bytes");
    igtl_message m = {.content = b.at, .size = 140};
    ok(!igtl_count_tools(&m, &count, "x", &e) && count == 2, "two tools");
    igtl_read_tool(&m, 1, &tool_back);
    ok(!strcmp(tool_back.name, "Stylus") && tool_back.type == 2 &&
           !memcmp(tool_back.matrix, tool.matrix, sizeof tool.matrix),
       "read back, the second is the same");
    b.size = 0;
    ok(!igtl_write_status(&b, &status, &e) && b.size == 40 && b.at[1] == 7 && b.at[2] == 255, "a status");
    m = (igtl_message){.content = b.at, .size = 40};
    ok(!igtl_read_status(&m, &status_back, "x", &e) && status_back.subcode == -2 && status_back.text_size == 9 &&
           !strcmp(status_back.name, "Lost"),
       "read back, it is the same");
    ok(!strcmp(igtl_status_text(7), "time out or connection lost") && !strcmp(igtl_status_text(20), "unknown code"),
       "codes have words");
    b.size = 0;
    ok(!igtl_write_sensor(&b, &sensor, &e) && b.size == 34 && b.at[0] == 3 && b.at[2] == 2 && b.at[3] == 0xc4,
       "a sensor: newtons, to the first power");
    m = (igtl_message){.content = b.at, .size = 34};
    ok(!igtl_read_sensor(&m, &sensor_back, "x", &e) && sensor_back.value[1] == -2, "read back");
    b.size = 0;
    ok(!igtl_write_position(&b, position, quaternion, &e) && b.size == 28, "a position");
    m = (igtl_message){.content = b.at, .size = 28};
    ok(!igtl_read_position(&m, p, q, "x", &e) && p[2] == 3 && q[3] == .5, "read back");
    m.size = 24;
    ok(!igtl_read_position(&m, p, q, "x", &e) && fabs(q[3] - .5) < 1e-7,
       "three numbers of a quaternion give the fourth");
    m.size = 12;
    ok(!igtl_read_position(&m, p, q, "x", &e) && q[0] == 0 && q[3] == 1, "none: it is not turned");
    igtl_buffer_free(&b);
}

static bool wants_string(void *context, const igtl_header *h)
{
    (void)context;
    return !strcmp(h->type, "STRING");
}

/* What a stream gives, fed in pieces of this size: a letter for each message (m), what was wrong (w), lost (l). */
static void read_all(igtl_reader *r, const unsigned char *bytes, size_t size, size_t piece, char *to)
{
    for (size_t at = 0; at < size;) {
        size_t room, n = size - at < piece ? size - at : piece;
        unsigned char *into = igtl_reader_room(r, &room);
        n = n < room ? n : room;
        memcpy(into, bytes + at, n);
        igtl_reader_took(r, n);
        at += n;
        igtl_message m;
        err e = {0};
        igtl_got got = igtl_reader_next(r, &m, &e);
        for (; got != IGTL_MORE && got != IGTL_LOST; got = igtl_reader_next(r, &m, &e)) {
            *to++ = got == IGTL_MESSAGE ? 'm' : 'w';
            e = (err){0};
        }
        if (got == IGTL_LOST) {
            *to++ = 'l';
            break;
        }
    }
    *to = '\0';
}

static void try_reader(void)
{
    unsigned char stream[3 * sizeof string_2 + 1000], *p = stream;
    igtl_buffer other = {0};
    char got[40];
    err e = {0};
    igtl_reader *r = igtl_reader_make(wants_string, NULL, 1000, "peer", &e);
    const igtl_about about = {.version = 1, .type = "IMAGE", .device = ""},
                     none = {.version = 1, .type = "STRING", .device = "keep"};
    unsigned char filler[300] = {0};
    ok(!igtl_write(&other, &about, filler, sizeof filler, &e) && !igtl_write(&other, &about, filler, 0, &e) &&
           !igtl_write(&other, &none, filler, 0, &e),
       "messages of other types, and without a body");
    read_all(r, other.at + IGTL_HEADER + 300 + IGTL_HEADER, IGTL_HEADER, IGTL_HEADER, got);
    ok(!strcmp(got, "m"), "the first message of a stream may have no body");
    fill_string_2(p);
    p += sizeof string_2;
    memcpy(p, other.at, (size_t)other.size);
    p += other.size;
    fill_string_2(p);
    p[80] ^= 1;
    p += sizeof string_2;
    fill_string_2(p);
    p += sizeof string_2;
    for (size_t piece = 1; piece < 400; piece += piece < 70 ? 1 : 37) {
        igtl_reader_begin(r);
        read_all(r, stream, (size_t)(p - stream), piece, got);
        if (strcmp(got, "mmwm") != 0 || igtl_reader_inside(r))
            break;
    }
    ok(!strcmp(got, "mmwm"),
       "a stream in pieces of any size: a message, one without a body, one with a wrong checksum, one (%s)", got);
    ok(!igtl_reader_inside(r) && igtl_reader_skipped(r) > 0, "what is not wanted is passed over");
    igtl_reader_begin(r);
    read_all(r, stream, 100, 100, got);
    ok(igtl_reader_inside(r), "a message that was cut is known");
    igtl_reader_begin(r);
    fill_string_2(stream);
    big_endian_put(stream + 42, (uint64_t)1 << 63, 8);
    read_all(r, stream, sizeof string_2, 7, got);
    ok(!strcmp(got, "l"), "a body of 2^63 bytes ends the stream");
    igtl_reader_begin(r);
    big_endian_put(stream + 42, 1001, 8);
    read_all(r, stream, sizeof string_2, 7, got);
    ok(!strcmp(got, "w"), "one of more bytes than its type may have is skipped");
    igtl_reader_begin(r);
    read_all(r, (const unsigned char *)"GET / HTTP/1.1\r\nHost: example.org\r\nUser-Agent: curl/7.88.1\r\n\r\n", 61, 61,
             got);
    ok(!strcmp(got, "l"), "what is no OpenIGTLink ends the stream");
    igtl_reader_free(r);
    igtl_buffer_free(&other);
}

int main(void)
{
    try_crc();
    try_extended();
    try_transform();
    try_image();
    try_surface();
    try_command();
    try_rest();
    try_reader();
    return done_testing();
}
