// needs: common/volume/samples.c slice/contour/segment_region.c slice/import/crop.c
/* Boxes of samples, labels, the Gaussian filter, regions and crops. */
#include "slice/contour/segment_region.h"
#include "slice/import/crop.h"
#include "volume/samples.h"

#include "tap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static volume make(volume_type type, int64_t x, int64_t y, int64_t z)
{
    volume v = {.type = type, .size = {x, y, z}, .axis = {{2, 0, 0}, {0, 3, 0}, {0, 0, 4}}};
    err e = {0};
    if (volume_make(&v, &e))
        exit(1);
    return v;
}

/* A point filtered is a Gaussian of the variance asked for, whichever axis. */
static void test_filter(void)
{
    int64_t size[3] = {41, 37, 39};
    double sigma[3] = {2, 1.5, 2.5}, middle[3] = {20, 18, 19}, moment[3] = {0}, sum = 0;
    float *value = calloc((size_t)(41 * 37 * 39), sizeof *value);
    err e = {0};
    if (!value)
        exit(1);
    value[(19 * 37 + 18) * 41 + 20] = 1;
    ok(!samples_filter(value, size, sigma, &e), "filtered");
    for (int i = 0; i < 41 * 37 * 39; i++) {
        int at[3] = {i % 41, i / 41 % 37, i / 41 / 37};
        sum += (double)value[i];
        for (int a = 0; a < 3; a++)
            moment[a] += (double)value[i] * pow(at[a] - middle[a], 2);
    }
    near_(sum, 1, 1e-5, "it keeps the sum");
    for (int a = 0; a < 3; a++)
        near_(sqrt(moment[a]), sigma[a], .03 * sigma[a], "and spreads it by sigma, cut at three");
    for (int i = 0; i < 41 * 37 * 39; i++)
        value[i] = 5;
    samples_filter(value, size, sigma, &e);
    near_((double)value[0], 5, 1e-4, "what is even stays so, at the corner too");
    free(value);
}

static void test_labels(void)
{
    volume v = make(VOLUME_I16, 5, 4, 3);
    int16_t *data = v.data;
    samples_label *list;
    err e = {0};
    data[(1 * 4 + 2) * 5 + 1] = data[(1 * 4 + 2) * 5 + 2] = data[(2 * 4 + 3) * 5 + 4] = -7;
    data[0] = 300;
    ok(samples_labels(&v, &list, &e) == 2, "two labels");
    ok(list[0].value == -7 && list[0].count == 3 && list[1].value == 300 && list[1].count == 1,
       "by value, with their counts");
    const samples_box *b = &list[0].box;
    ok(b->low[0] == 1 && b->high[0] == 5 && b->low[1] == 2 && b->high[1] == 4 && b->low[2] == 1 && b->high[2] == 3,
       "and boxes");
    float mark[4 * 2 * 2], all[5 * 4 * 3];
    samples_box whole = samples_whole(&v);
    samples_mark(&v, b, -7, mark);
    ok(mark[0] == 1 && mark[1] == 1 && mark[2] == 0 && mark[15] == 1, "marked in a box");
    samples_take(&v, &whole, all);
    ok(all[0] == 300 && all[59] == -7, "taken as they are");
    free(list);
    volume_free(&v);
    v = make(VOLUME_F32, 2, 2, 2);
    ok(samples_labels(&v, &list, &e) == -1 && e.status == 1, "numbers that are not whole are no labels: %s", e.text);
    volume_free(&v);
}

static void test_crop(void)
{
    volume v = make(VOLUME_U8, 5, 4, 3);
    unsigned char *data = v.data;
    for (int i = 0; i < 60; i++)
        data[i] = (unsigned char)i;
    crop_to(&v, &(samples_box){{1, 2, 1}, {4, 4, 3}});
    const unsigned char want[] = {31, 32, 33, 36, 37, 38, 51, 52, 53, 56, 57, 58};
    ok(v.size[0] == 3 && v.size[1] == 2 && v.size[2] == 2 && !memcmp(v.data, want, sizeof want),
       "the part that is kept");
    ok(v.origin[0] == 2 && v.origin[1] == 6 && v.origin[2] == 4, "and where it lies");
    volume_free(&v);
}

static int count_of(const uint8_t *mask, int size)
{
    int sum = 0;
    for (int i = 0; i < size; i++)
        sum += mask[i];
    return sum;
}

static void test_regions(void)
{
    uint8_t mask[6 * 6 * 6] = {0};
    region r = {.mask = mask, .size = {6, 6, 6}};
    err e = {0};
    for (int z = 1; z < 5; z++)
        for (int y = 1; y < 5; y++)
            for (int x = 1; x < 5; x++)
                mask[(z * 6 + y) * 6 + x] = x == 1 || x == 4 || y == 1 || y == 4 || z == 1 || z == 4;
    mask[0] = mask[1] = 1; /* the shell's corner touches neither by a face */
    ok(!region_largest(&r, &e) && count_of(mask, 216) == 56 && !mask[0], "the largest of two parts");
    ok(!region_fill(&r, &e) && count_of(mask, 216) == 64, "and its hole filled");
    ok(region_flood(&r, 0, 0, 3, &e) == 216 - 64, "what is around it, counted");
    ok(region_flood(&r, 0, 0, 3, &e) == 0, "once only");
    region_free(&r);
}

typedef struct planes {
    const float *from;
    float *to;
    int64_t area, taken, given;
    bool in_order;
} planes;

static void take(void *context, int64_t z, float *plane)
{
    planes *p = context;
    memcpy(plane, p->from + z * p->area, (size_t)p->area * sizeof *plane);
    p->in_order &= z == p->taken++;
}

static void give(void *context, int64_t z, const float *plane)
{
    planes *p = context;
    memcpy(p->to + z * p->area, plane, (size_t)p->area * sizeof *plane);
    p->in_order &= z == p->given++;
}

/* Plane by plane, the same bits as all at once, wherever it begins and ends. */
static void test_planes(double x, double y, double z, int64_t from, int64_t to)
{
    enum { X = 9, Y = 7, Z = 11, ALL = X * Y * Z };
    static float value[ALL], want[ALL], got[ALL];
    const int64_t size[3] = {X, Y, Z};
    const double sigma[3] = {x, y, z};
    const int64_t reach = samples_reach(z), first = from > reach ? from - reach : 0;
    err e = {0};
    uint32_t seed = 3;
    for (int i = 0; i < ALL; i++) {
        seed = seed * 1664525U + 1013904223U;
        want[i] = value[i] = (float)(seed >> 16);
    }
    planes p = {value, got, X * Y, first, from, true};
    const samples_planes each = {take, give, &p};
    ok(!samples_filter(want, size, sigma, &e) && !samples_filter_planes(&each, size, sigma, from, to, &e),
       "filtered by %g %g %g voxels", x, y, z);
    ok(p.in_order && p.given == to && p.taken <= Z, "planes are taken and given in order");
    ok(!memcmp(got + from * X * Y, want + from * X * Y, (size_t)((to - from) * X * Y) * sizeof *got),
       "planes %d to %d have the same bits", (int)from, (int)to - 1);
}

int main(void)
{
    test_filter();
    test_planes(1.2, .8, 1.5, 0, 11);
    test_planes(1.2, .8, 1.5, 3, 9);
    test_planes(0, 0, 0, 0, 11);
    test_planes(.4, 0, 11, 0, 11);
    test_planes(2, 2, .3, 10, 11);
    test_labels();
    test_crop();
    test_regions();
    return done_testing();
}
