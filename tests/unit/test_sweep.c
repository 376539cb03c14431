// needs: slice/import/sweep.c
/* Sweeps: planes cut from a known function, tilted and uneven, put together again. */
#include "slice/import/sweep.h"

#include "tap.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDE = 60, HIGH = 50, FRAMES = 40 };

static double truth(double x, double y, double z)
{
    return 120 + 40 * sin(x / 4) + 30 * cos(y / 5) + 20 * sin(z / 3);
}

/* Frames that turn and shift a little as they go: pixels of .5 mm. */
static void cut(sweep *s, volume *images)
{
    err e = {0};
    *images = (volume){.type = VOLUME_U8, .size = {WIDE, HIGH, FRAMES}};
    s->one = calloc(FRAMES, sizeof *s->one);
    s->count = FRAMES;
    if (!s->one || volume_make(images, &e))
        exit(1);
    for (int f = 0; f < FRAMES; f++) {
        double angle = .002 * f, c = .5 * cos(angle), n = .5 * sin(angle);
        double m[12] = {c, 0, 0, 3, 0, .5, 0, -7 + .01 * f, n, 0, 0, .4 * f + .1 * sin(f)};
        s->one[f].image = f;
        memcpy(s->one[f].m, m, sizeof m);
        for (int r = 0; r < HIGH; r++)
            for (int k = 0; k < WIDE; k++) {
                double x = m[0] * k + m[3], y = .5 * r + m[7], z = m[8] * k + m[11];
                ((unsigned char *)images->data)[(f * HIGH + r) * WIDE + k] = (unsigned char)floor(truth(x, y, z) + .5);
            }
    }
}

/* The largest and mean difference from the truth, over voxels that have a value. */
static void compare(const volume *v, double *most, double *mean, int64_t *count)
{
    *most = *mean = 0;
    *count = 0;
    for (int64_t i = 0; i < volume_count(v); i++) {
        double got = volume_value(v, i);
        double at[3] = {(double)(i % v->size[0]), (double)(i / v->size[0] % v->size[1]),
                        (double)(i / v->size[0] / v->size[1])},
               p[3];
        volume_place(v, at, p);
        double off = fabs(got - truth(1e3 * p[0], 1e3 * p[1], 1e3 * p[2]));
        if (!(got > 0))
            continue;
        *most = fmax(*most, off);
        *mean += off;
        ++*count;
    }
    *mean /= (double)*count;
}

static void test_truth(const sweep *s, const volume *images, bool linear, int64_t fill, double voxel, double allowed)
{
    volume v = {0};
    sweep_wish wish = {linear, fill, voxel, 0};
    int64_t filled[2] = {0}, count;
    double most, mean;
    err e = {0};
    ok(!sweep_volume(&v, s, images, &wish, filled, &e), "%s, gaps to %d, voxels of %g mm %s",
       linear ? "linear" : "nearest", (int)fill, voxel, e.text);
    compare(&v, &most, &mean, &count);
    ok(mean < allowed && most < 12 * allowed, "%d voxels: off by %.3g, at most %.3g", (int)count, mean, most);
    ok(count == filled[0] + filled[1], "as many as were counted: %d and %d", (int)filled[0], (int)filled[1]);
    ok((voxel < .5) <= (filled[1] > 0) && (fill || !filled[1]),
       "gaps are filled where there are some, and only if asked");
    volume_free(&v);
}

static void test_refused(const sweep *s, const volume *images)
{
    volume v = {0}, few = *images;
    sweep_wish wish = {true, 0, 1e-5, 0};
    int64_t filled[2];
    err e = {0}, e2 = {0};
    ok(sweep_volume(&v, s, images, &wish, filled, &e) == -1 && strstr(e.text, "more than memory holds"),
       "voxels too small: %s", e.text);
    volume_free(&v);
    few.size[2] = 5;
    wish.voxel = 1;
    ok(sweep_volume(&v, s, &few, &wish, filled, &e2) == -1 && strstr(e2.text, "images of 5"),
       "frames without images: %s", e2.text);
    volume_free(&v);
}

static void test_read(void)
{
    static const char text[] =
        "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\n"
        "Seq_Frame0000_ProbeToTrackerTransform = 1 0 0 10 0 1 0 20 0 0 1 30 0 0 0 1\n"
        "Seq_Frame0000_ProbeToTrackerTransformStatus = OK\nSeq_Frame0000_Timestamp = 1\n"
        "Seq_Frame0001_ProbeToTrackerTransform = 1 0 0 10 0 1 0 20 0 0 1 31 0 0 0 1\n"
        "Seq_Frame0001_ProbeToTrackerTransformStatus = INVALID\nSeq_Frame0001_Timestamp = 2\n"
        "Seq_Frame0002_ProbeToTrackerTransform = 0 -1 0 10 1 0 0 20 0 0 1 32 0 0 0 1\n"
        "Seq_Frame0002_ProbeToTrackerTransformStatus = OK\nSeq_Frame0002_Timestamp = 3\nElementDataFile = LOCAL\n";
    const double calibration[16] = {.5, 0, 0, -1, 0, .25, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    sweep s = {0}, none = {0};
    err e = {0}, e2 = {0};
    ok(sweep_is(text, sizeof text - 1) && !sweep_is(text, 40), "tracked frames are told by their keys");
    in *source = in_memory(text, sizeof text - 1, "sweep", &e);
    ok(source && !sweep_read(&s, source, NULL, calibration, &e), "read %s", e.text);
    in_close(source);
    ok(s.count == 2 && s.skipped == 1 && s.one[1].image == 2, "what was not tracked is left out");
    const double *m = s.count == 2 ? s.one[1].m : calibration;
    ok(m[0] == 0 && m[1] == -.25 && m[3] == 10 && m[4] == .5 && m[7] == 19 && m[11] == 32,
       "pixels to the tracker's mm");
    source = in_memory(text, sizeof text - 1, "sweep", &e);
    ok(source && sweep_read(&none, source, NULL, NULL, &e2) == -1 && strstr(e2.text, "--calibration"),
       "no calibration: %s", e2.text);
    in_close(source);
    sweep_free(&s);
    sweep_free(&none);
}

/* Images stored with their columns and rows the other way round lie where they did. */
static void test_flipped(sweep *s, volume *images)
{
    int64_t count = WIDE * HIGH;
    for (int f = 0; f < FRAMES; f++)
        for (int64_t i = 0; i < count / 2; i++) {
            unsigned char *a = (unsigned char *)images->data + f * count, kept = a[i];
            a[i] = a[count - 1 - i];
            a[count - 1 - i] = kept;
        }
    s->flipped[0] = s->flipped[1] = true;
    sweep_unflip(s, images->size);
    test_truth(s, images, true, 8, .5, 2);
    sweep_unflip(s, images->size);
    test_truth(s, images, true, 8, .5, 2);
}

/* What UltrasoundImageOrientation says; -1: refused, 0 to 3: columns, rows flipped. */
static int orientation(const char *said)
{
    char text[400];
    err e = {0};
    sweep s = {0};
    snprintf(text, sizeof text,
             "ObjectType = Image\nNDims = 3\n%s%s\nDimSize = 4 3 1\n"
             "Seq_Frame0000_ImageToTrackerTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
             "Seq_Frame0000_ImageToTrackerTransformStatus = OK\nSeq_Frame0000_Timestamp = 1\nElementDataFile = LOCAL\n",
             *said ? "UltrasoundImageOrientation = " : "", said);
    in *source = in_memory(text, strlen(text), "sweep", &e);
    int code = source ? sweep_read(&s, source, NULL, NULL, &e) : -2;
    int flipped = s.flipped[0] + 2 * s.flipped[1];
    in_close(source);
    sweep_free(&s);
    if (code == -1 && !strstr(e.text, "expected MF, MN, UF or UN"))
        code = -2;
    return code ? code : flipped;
}

static void test_orientation(void)
{
    static const struct {
        const char *said;
        int is;
    } known[] = {{"MF", 0}, {"UF", 1}, {"MN", 2}, {"un", 3}, {"UNA", 3}, {"XX", 0}, {"", 0}, {"FM", -1}, {"M", -1}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        ok(orientation(known[i].said) == known[i].is, "orientation '%s'", known[i].said);
}

int main(void)
{
    sweep s = {0};
    volume images;
    err e = {0};
    cut(&s, &images);
    near_(sweep_voxel(&s, &images, &e), .5, 1e-9, "voxels as large as pixels, where frames are near");
    test_truth(&s, &images, true, 0, .5, 2);
    test_truth(&s, &images, true, 8, .5, 2);
    test_truth(&s, &images, false, 8, .5, 3);
    test_truth(&s, &images, true, 8, .25, 1.5);
    test_refused(&s, &images);
    test_read();
    test_orientation();
    test_flipped(&s, &images);
    sweep_free(&s);
    volume_free(&images);
    return done_testing();
}
