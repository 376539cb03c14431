// needs: tests/bench/bench.c slice/contour/contour.c slice/contour/cubes.c slice/contour/contour_shape.c
/* `make bench-images`: us-import of 153 DICOM slices, us-segment, and us-surface to 250,000 triangles and
 * more, whole commands and the step that the paper names, all on one thread, beside a probe of the
 * machine: CSV. Usage: bench_images BIN FOLDER [SERIES]; what is read stands in FOLDER meanwhile; SERIES
 * is a folder of DICOM files to be read as well.
 */
#include "base/mem.h"
#include "slice/contour/contour.h"
#include "tests/bench/bench.h"
#include "volume/nrrd.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* SIDE: of the volume that surfaces are made of; the slices are as large as the fetal head's, of which tests know. */
enum { ROUNDS = 9, COLUMNS = 211, ROWS = 232, SLICES = 153, SIDE = 160, PATH = 400 };

typedef struct subject {
    bench all;
    const char *bin, *real;
    char series[PATH], volume[PATH], labels[PATH];
    float *samples; /* SIDE^3 */
    bench_bytes taken;
} subject;

/* ---- what is read, from equations */

static double speckle(uint32_t *state)
{
    *state = *state * 1664525U + 1013904223U;
    return (double)(*state >> 8) / (1 << 24);
}

static void put_number(FILE *f, uint32_t n, int bytes)
{
    for (; bytes; bytes--, n >>= 8)
        putc((int)(n & 255), f);
}

static void put_text(FILE *f, uint32_t tag, const char *vr, const char *text)
{
    size_t length = strlen(text);
    put_number(f, tag >> 16, 2);
    put_number(f, tag, 2);
    fputs(vr, f);
    put_number(f, (uint32_t)(length + length % 2), 2);
    fputs(text, f);
    if (length % 2)
        putc(*vr == 'U' ? 0 : ' ', f);
}

static void put_short(FILE *f, uint32_t tag, uint32_t n)
{
    put_number(f, tag >> 16, 2);
    put_number(f, tag, 2);
    fputs("US", f);
    put_number(f, 2, 2);
    put_number(f, n, 2);
}

/* A slice of a fan of speckle, black around it, in 16 bits with sign as the fetal head has them. */
static void put_slice(const char *path, int k, err *e)
{
    static const uint32_t shape[][2] = {{0x00280002, 1},  {0x00280010, ROWS}, {0x00280011, COLUMNS}, {0x00280100, 16},
                                        {0x00280101, 16}, {0x00280102, 15},   {0x00280103, 1}};
    FILE *f = fopen(path, "wb");
    char place[64];
    uint32_t state = (uint32_t)k;
    if (!f) {
        err_set(e, path, 0, "cannot write");
        return;
    }
    snprintf(place, sizeof place, "0\\0\\%.3f", .501 * k);
    for (int i = 0; i < 128; i++)
        putc(0, f);
    fputs("DICM", f);
    put_text(f, 0x00020010, "UI", "1.2.840.10008.1.2.1");
    put_text(f, 0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.6.1");
    put_text(f, 0x0020000E, "UI", "2.25.42");
    put_text(f, 0x00200032, "DS", place);
    put_text(f, 0x00200037, "DS", "1\\0\\0\\0\\1\\0");
    put_text(f, 0x00280004, "CS", "MONOCHROME2");
    put_text(f, 0x00280030, "DS", "0.501\\0.501");
    for (size_t i = 0; i < sizeof shape / sizeof *shape; i++)
        put_short(f, shape[i][0], shape[i][1]);
    put_number(f, 0x7FE0, 2);
    put_number(f, 0x0010, 2);
    fputs("OW", f);
    put_number(f, 0, 2);
    put_number(f, 2 * ROWS * COLUMNS, 4);
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < COLUMNS; x++) {
            bool fan = fabs(x - COLUMNS / 2.) < 30 + .35 * y && hypot(x - COLUMNS / 2., y) < .75 * ROWS;
            put_number(f, fan ? (uint32_t)(20 + 60 * speckle(&state) * speckle(&state)) : 0, 2);
        }
    if (fclose(f))
        err_set(e, path, 0, "cannot write");
}

static void write_series(const subject *s, err *e)
{
    mkdir(s->series, 0777);
    for (int k = 0; k < SLICES && !e->status; k++) {
        char path[PATH + 20];
        snprintf(path, sizeof path, "%s/im%03d.dcm", s->series, k * 64 % SLICES);
        put_slice(path, k, e);
    }
}

/* A ball with waves on it: about 250,000 triangles at level 100. */
static float wavy(int x, int y, int z)
{
    double r = sqrt(pow(x - 79.3, 2) + pow(y - 79.6, 2) + pow(z - 79.9, 2));
    return (float)(100 + 12 * (66 - r + 6 * sin(.4 * x) * sin(.37 * y) * sin(.41 * z)));
}

static int write_volume(const volume *v, const char *path, err *e)
{
    out *o = out_open(path, false, e);
    if (!o)
        return -1;
    if (nrrd_write(v, false, o, e)) {
        out_discard(o);
        return -1;
    }
    return out_close(o, e);
}

/* The intensities, as 8 bits; and five labels, which are the ball's parts as a person would cut it. */
static void write_volumes(subject *s, err *e)
{
    volume v = {.type = VOLUME_U8, .size = {SIDE, SIDE, SIDE}, .axis = {{.5, 0, 0}, {0, .5, 0}, {0, 0, .5}}};
    s->samples = mem_array((int64_t)SIDE * SIDE * SIDE, sizeof *s->samples, "samples", e);
    if (volume_make(&v, e))
        return;
    unsigned char *voxel = v.data;
    for (int64_t i = 0; i < volume_count(&v); i++) {
        float value = wavy((int)(i % SIDE), (int)(i / SIDE % SIDE), (int)(i / SIDE / SIDE));
        s->samples[i] = value;
        voxel[i] = (unsigned char)fminf(fmaxf(value, 0), 255);
    }
    if (!write_volume(&v, s->volume, e)) {
        for (int64_t i = 0; i < volume_count(&v); i++)
            voxel[i] = voxel[i] < 100 ? 0 : (unsigned char)(1 + i / SIDE / SIDE * 5 / SIDE);
        write_volume(&v, s->labels, e);
    }
    volume_free(&v);
}

static void remove_all(const subject *s)
{
    for (int k = 0; k < SLICES; k++) {
        char path[PATH + 20];
        snprintf(path, sizeof path, "%s/im%03d.dcm", s->series, k);
        remove(path);
    }
    rmdir(s->series);
    remove(s->volume);
    remove(s->labels);
}

/* ---- the rounds */

static double triangles(const bench_bytes *b)
{
    double count = 0;
    for (size_t i = 1; i < b->size; i++)
        count += b->bytes[i] == 'f' && b->bytes[i - 1] == '\n';
    return count;
}

static void time_command(subject *s, const char *name, const bench_command *c, const char *unit, double amount)
{
    double took = bench_run(c, NULL, &s->taken);
    bench_take(&s->all, name, *unit == 't' ? triangles(&s->taken) : amount, unit, took);
}

static void time_import(subject *s)
{
    const double voxels = (double)COLUMNS * ROWS * SLICES;
    const bench_command packed = {s->bin, "us-import", {"-q", s->series, NULL}};
    const bench_command raw = {s->bin, "us-import", {"-q", "--raw", s->series, NULL}};
    const bench_command head = {s->bin, "us-import", {"-q", s->real, NULL}};
    time_command(s, "us-import, 153 slices of 211 x 232 (asked: .3 s)", &packed, "voxel", voxels);
    time_command(s, "us-import --raw, the same", &raw, "voxel", voxels);
    if (s->real)
        time_command(s, "us-import, the fetal head", &head, "voxel", voxels);
}

static void time_surfaces(subject *s)
{
    const double voxels = (double)SIDE * SIDE * SIDE;
    const bench_command level = {s->bin, "us-surface", {"-q", "-i", "100", s->volume, NULL}};
    const bench_command filtered = {s->bin, "us-surface", {"-q", "-i", "100", "--smooth", "0.5mm", s->volume, NULL}};
    const bench_command five = {s->bin, "us-surface", {"-q", "-l", "all", "--smooth", "0.5mm", s->labels, NULL}};
    const bench_command taubin = {s->bin, "us-surface", {"-q", "-l", "all", "--taubin", "10", s->labels, NULL}};
    const bench_command grow = {
        s->bin, "us-segment", {"-q", "-n", "a", "--low", "100", "--seed-voxel", "80,80,80", s->volume}};
    time_command(s, "us-surface, a level (asked: 250000 triangles in .15 s; the paper: 243224 in 2 s)", &level,
                 "triangle", 0);
    time_command(s, "us-surface, the same, filtered before", &filtered, "triangle", 0);
    time_command(s, "us-surface, five labels, filtered before", &five, "triangle", 0);
    time_command(s, "us-surface, five labels, Taubin's smoothing after", &taubin, "triangle", 0);
    time_command(s, "us-segment, from a seed", &grow, "voxel", voxels);
}

static void time_marching(subject *s, const cubes *table, err *e)
{
    const int64_t size[3] = {SIDE, SIDE, SIDE};
    contour c = {0};
    double start = bench_clock();
    contour_make(&c, s->samples, size, 100, table, e);
    bench_take(&s->all, "marching cubes alone", (double)c.triangles, "triangle", bench_clock() - start);
    contour_free(&c);
}

int main(int argc, char **argv)
{
    static subject s;
    err e = {0};
    cubes *table = cubes_create(&e);
    if (argc < 3)
        err_set(&e, NULL, 0, "expected BIN FOLDER [SERIES]");
    bench_must(!e.status, &e);
    s.bin = argv[1];
    s.real = argc > 3 ? argv[3] : NULL;
    snprintf(s.series, sizeof s.series, "%.300s/bench_images", argv[2]);
    snprintf(s.volume, sizeof s.volume, "%.300s/bench_images.nrrd", argv[2]);
    snprintf(s.labels, sizeof s.labels, "%.300s/bench_images.labels.nrrd", argv[2]);
    write_series(&s, &e);
    if (!e.status)
        write_volumes(&s, &e);
    for (int round = 0; round < ROUNDS && !e.status; round++) {
        bench_probe(&s.all);
        time_import(&s);
        time_surfaces(&s);
        time_marching(&s, table, &e);
    }
    remove_all(&s);
    bench_must(!e.status, &e);
    bench_print(&s.all);
    free(table);
    free(s.samples);
    free(s.taken.bytes);
    return 0;
}
