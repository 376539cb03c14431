// Images as us-slice streams them: read one after the other with their places, and what is none refused; and as JPEG.
// needs: common/console/jpeg.c
#include "console/jpeg.h"
#include "picture/pnm.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

static void refuses(const char *bytes, const char *part)
{
    err e = {0};
    pnm p = {0};
    in *s = in_memory(bytes, strlen(bytes), "images", &e);
    int got;
    while ((got = pnm_next(s, &p, &e)) > 0)
        ;
    ok(got < 0 && strstr(e.text, part), "%s", e.text);
    pnm_free(&p);
    in_close(s);
}

static void try_stream(void)
{
    static const char bytes[] = "P5\n# us-slice: 1 2 3 .5 0 0 0 -1e-3 0\n2 3\n255\nabcdef"
                                "P6\n# another\n1 2\n255\nABCDEF"
                                "P5\n# us-slice: 1 2 3 x\n1 1\n255\nz"
                                "P5\n# us-slice: 1 2 3 4 5 6 7 8 9 fan .5 .25 2 60\n1 1\n255\nz";
    err e = {0};
    pnm p = {0};
    in *s = in_memory(bytes, sizeof bytes - 1, "images", &e);
    ok(pnm_next(s, &p, &e) == 1 && p.columns == 2 && p.rows == 3 && p.channels == 1, "a grey image");
    ok(p.has_plane && p.plane[0] == 1 && p.plane[3] == .5 && p.plane[7] == -1e-3 && p.plane[8] == 0, "its place");
    ok(!p.has_fan, "of no fan");
    ok(!memcmp(p.pixel, "abcdef", 6), "its pixels");
    ok(pnm_next(s, &p, &e) == 1 && p.columns == 1 && p.rows == 2 && p.channels == 3 && !p.has_plane, "one of colours");
    ok(!memcmp(p.pixel, "ABCDEF", 6), "its pixels");
    ok(pnm_next(s, &p, &e) == 1 && !p.has_plane, "a place that is none");
    ok(pnm_next(s, &p, &e) == 1 && p.has_plane && p.has_fan && p.fan[0] == .5 && p.fan[3] == 60, "a fan");
    ok(pnm_next(s, &p, &e) == 0 && !*e.text, "the end");
    pnm_free(&p);
    in_close(s);
}

/* Its header has the size: bytes behind the marker of the frame, SOF0. */
static void try_jpeg(int channels)
{
    enum { COLUMNS = 33, ROWS = 17 };
    unsigned char *pixel = malloc((size_t)COLUMNS * ROWS * 3);
    jpeg j = {0};
    err e = {0};
    for (int i = 0; i < COLUMNS * ROWS * channels; i++)
        pixel[i] = (unsigned char)(i * 7);
    ok(!jpeg_make(&j, pixel, COLUMNS, ROWS, channels, &e), "%d channels as JPEG: %zu bytes", channels, j.size);
    const unsigned char *at = j.bytes;
    while (at + 10 < j.bytes + j.size && !(at[0] == 0xff && at[1] == 0xc0))
        at++;
    ok(at[5] * 256 + at[6] == ROWS && at[7] * 256 + at[8] == COLUMNS && at[9] == channels, "of its size");
    ok(!jpeg_make(&j, pixel, COLUMNS / 2, ROWS, channels, &e), "a smaller one after it");
    jpeg_free(&j);
    free(pixel);
}

int main(void)
{
    try_stream();
    refuses("P4\n1 1\n255\nz", "neither PGM nor PPM");
    refuses("P5\n1\n255\nz", "an image without a size");
    refuses("P5\n-1 1\n255\nz", "an image without a size");
    refuses("P5\n99999 1\n255\nz", "an image without a size");
    refuses("P5\n1 1\n65535\nzz", "other levels than 255");
    refuses("P5\n2 2\n255\nabc", "cut short");
    refuses("P5\n", "an image without a size");
    refuses("P5\n1 1\n255\nzjunk", "neither PGM nor PPM");
    try_jpeg(1);
    try_jpeg(3);
    return done_testing();
}
