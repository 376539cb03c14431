// needs: slice/import/series.c slice/import/dicom_image.c slice/import/dicom_file.cc slice/import/dicom_pixels.c
// needs: slice/import/dicom_jpeg.c slice/import/dicom_colour.c slice/import/dicom_inflate.c
// needs: slice/import/dicom_jpeg2000.c slice/import/dicom_elements.c slice/import/dicom_lengths.c
/* Series put in order: oblique stacks in any order of files, and what is wrong with
 * them; times, kinds of data; scaled samples.
 */
#include "slice/import/series.h"

#include "tap.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDE = 3, HIGH = 2 };

static const double along_row[3] = {.6, 0, -.8}, along_column[3] = {0, 1, 0}, normal[3] = {.8, 0, .6};
static const series_wish any = {{(double)NAN, (double)NAN, (double)NAN}, -1, -1, NULL, NULL};

/* A file of `frames`, the first of which lies `at` mm along the normal, the others .5 mm each
 * behind it. Pixels count up from `value`. */
static dicom_image image_at(double at, int frames, int value)
{
    dicom_image d = {.series = "1.2", .columns = WIDE, .rows = HIGH, .frames = frames, .bytes = 1, .slope = 1};
    d.position = calloc(3 * (size_t)frames, sizeof *d.position);
    d.time = calloc((size_t)frames, sizeof *d.time);
    d.kind = calloc((size_t)frames, sizeof *d.kind);
    d.pixels = malloc((size_t)frames * WIDE * HIGH);
    if (!d.position || !d.time || !d.kind || !d.pixels)
        exit(1);
    d.spacing[0] = .25;
    d.spacing[1] = .75;
    d.spacing[2] = (double)NAN;
    d.placed = true;
    memcpy(d.along_row, along_row, sizeof along_row);
    memcpy(d.along_column, along_column, sizeof along_column);
    for (int f = 0; f < frames; f++)
        for (int a = 0; a < 3; a++)
            d.position[3 * f + a] = 7 * (a + 1) + (at + .5 * f) * normal[a];
    for (int i = 0; i < frames * WIDE * HIGH; i++)
        d.pixels[i] = (unsigned char)(value + i);
    return d;
}

static void add(series *s, const char *name, dicom_image d)
{
    err e = {0};
    if (series_add(s, name, &d, &e))
        exit(1);
}

/* Frees the series; what was wrong, or "". */
static const char *make(volume *v, series *s, const series_wish *wish)
{
    static err e;
    e = (err){0};
    *v = (volume){0};
    series_volume(v, s, wish, &e);
    series_free(s);
    return e.text;
}

static void refused(series *s, const series_wish *wish, const char *pattern, const char *name)
{
    volume v;
    const char *said = make(&v, s, wish);
    ok(strstr(said, pattern) != NULL, "%s: %s", name, said);
    volume_free(&v);
}

/* Slices at these places, named a, b, c... */
static series stack_of(const double *at, int count)
{
    series s = {0};
    for (int i = 0; i < count; i++) {
        char name[2] = {(char)('a' + i), 0};
        add(&s, name, image_at(at[i], 1, (int)lround(20 * at[i])));
    }
    return s;
}

static void test_order(void)
{
    series s = stack_of((const double[]){1, 0, 1.5, .5}, 4);
    volume v;
    const char *said = make(&v, &s, &any);
    ok(!*said && v.size[0] == WIDE && v.size[1] == HIGH && v.size[2] == 4 && v.type == VOLUME_U8, "a stack %s", said);
    near_(v.origin[2], 21, 1e-12, "begins at the first slice");
    near_(v.axis[0][2], -.25 * .8, 1e-12, "columns");
    near_(v.axis[1][1], .75, 1e-12, "rows");
    near_(v.axis[2][0], .5 * .8, 1e-12, "slices, by their places");
    bool right = v.data != NULL;
    for (int i = 0; right && i < 4 * WIDE * HIGH; i++)
        right = volume_value(&v, i) == 10 * (i / (WIDE * HIGH)) + i % (WIDE * HIGH);
    ok(right, "voxels in that order");
    volume_free(&v);
}

static void test_uneven(void)
{
    series s = stack_of((const double[]){0, .5, 1, 2, 2.5}, 5);
    refused(&s, &any, "1 missing between c and d; expected all 0.5 mm apart", "one is missing");
    s = stack_of((const double[]){0, .5, 1, 1, 1.5}, 5);
    refused(&s, &any, "c and d lie at one place", "one twice");
    s = stack_of((const double[]){0, .5, 1.1, 1.5, 2, 2.5}, 6);
    refused(&s, &any, "b and c lie 0.6 mm apart; c and d lie 0.4 mm apart", "one uneven");
    s = stack_of((const double[]){0, 0, 0, 1}, 4);
    refused(&s, &any, "lie at one place, as most do", "most at one place");
    s = stack_of((const double[]){0, .504, 1, 1.496, 2.001}, 5);
    volume v;
    const char *said = make(&v, &s, &any);
    ok(!*said, "two hundredths of the distance are even enough %s", said);
    volume_free(&v);
}

static void test_unlike(void)
{
    static const char *const pattern[] = {"another size", "samples of another kind", "another orientation",
                                          "another distance between pixels", "samples of another kind"};
    for (int i = 0; i < 5; i++) {
        series s = stack_of((const double[]){0, .5, 1}, 3);
        dicom_image *d = &s.file[1].image;
        if (i == 0)
            d->rows = 1;
        d->negative = i == 1;
        d->along_row[1] += i == 2 ? .01 : 0;
        d->spacing[1] += i == 3 ? .01 : 0;
        d->slope = i == 4 ? 2 : 1;
        refused(&s, &any, pattern[i], "a file unlike the others");
    }
    series s = stack_of((const double[]){0, .5, 1}, 3);
    s.file[2].image.position[1] += .1;
    refused(&s, &any, "c lies 0.1 mm beside", "askew");
    s = stack_of((const double[]){0, .5}, 2);
    s.file[1].image.placed = false;
    refused(&s, &any, "b: one of several images has no position", "no position");
}

static void test_several(void)
{
    series_wish second = any;
    series s = stack_of((const double[]){0, .5, 3, 3.5, 4}, 5);
    for (int i = 2; i < 5; i++)
        snprintf(s.file[i].image.series, DICOM_UID, "1.3");
    refused(&s, &any, "2 series: 1: 2 files of 3 x 2 from a, 2: 3 files of 3 x 2 from c", "two series");
    s = stack_of((const double[]){0, .5, 3, 3.5, 4}, 5);
    for (int i = 2; i < 5; i++)
        snprintf(s.file[i].image.series, DICOM_UID, "1.3");
    second.number = 2;
    volume v;
    const char *said = make(&v, &s, &second);
    ok(!*said && v.size[2] == 3, "the second %s", said);
    volume_free(&v);
}

/* Six frames: two times of three, or two kinds of data. */
static series frames(bool times)
{
    series s = {0};
    dicom_image d = image_at(0, 6, 1);
    for (int f = 0; f < 6; f++) {
        memcpy(d.position + 3 * f, d.position + 3 * (f % 3), 3 * sizeof *d.position);
        d.time[f] = times ? .1 * (f / 3) : 0;
        snprintf(d.kind[f], DICOM_KIND, "%s", times || f < 3 ? "TISSUE_INTENSITY" : "FLOW_POWER");
    }
    add(&s, "a", d);
    return s;
}

static void test_choices(void)
{
    series_wish wish = any;
    volume v;
    series s = frames(true);
    refused(&s, &any, "volumes of 2 times; expected --time 1 to 2", "two times");
    s = frames(false);
    refused(&s, &any, "several kinds of data; expected --data, one of: FLOW_POWER, TISSUE_INTENSITY", "two kinds");
    s = frames(false);
    wish.kind = "FLOW";
    refused(&s, &wish, "no frames of FLOW", "none of that kind");
    for (int i = 0; i < 2; i++) {
        s = frames(i);
        wish.kind = i ? NULL : "FLOW_POWER";
        wish.time = i ? 2 : -1;
        const char *said = make(&v, &s, &wish);
        ok(!*said && v.size[2] == 3 && volume_value(&v, 0) == 19, "the second of either %s", said);
        volume_free(&v);
    }
}

static void test_scaled(void)
{
    series s = stack_of((const double[]){0, .5}, 2);
    volume v;
    for (int i = 0; i < 2; i++) {
        s.file[i].image.slope = 2;
        s.file[i].image.intercept = -3;
    }
    const char *said = make(&v, &s, &any);
    ok(!*said && v.type == VOLUME_F32 && volume_value(&v, 6) == 17, "scaled samples are floats %s", said);
    volume_free(&v);
}

static void test_alone(void)
{
    series s = stack_of((const double[]){0}, 1);
    series_wish wish = any;
    volume v;
    refused(&s, &any, "one slice, and no distance", "one slice");
    s = stack_of((const double[]){0}, 1);
    wish.spacing[2] = 2;
    const char *said = make(&v, &s, &wish);
    ok(!*said && v.size[2] == 1 && fabs(v.axis[2][2] - 1.2) < 1e-12, "whose distance is said %s", said);
    volume_free(&v);
    refused(&s, &any, "no DICOM images", "none");
}

int main(void)
{
    test_order();
    test_uneven();
    test_unlike();
    test_several();
    test_choices();
    test_scaled();
    test_alone();
    return done_testing();
}
