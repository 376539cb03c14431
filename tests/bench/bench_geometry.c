/* How fast the geometry is read, passed on and worked on: OBJ files, models through a pipe, attach and bind on the real
 * face, with a probe of the machine in the same run. Lines of CSV on stdout; the rounds are interleaved, so that what
 * disturbs the machine for a while disturbs all alike. `bench_geometry [BIN face.obj [ROUNDS]]`: the tools in BIN are
 * run too, where the face is there.
 */
// needs: tests/bench/bench.c
#include "base/checksum.h"
#include "base/mem.h"
#include "model/stream.h"
#include "surface/obj.h"

#include "bench.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum { PROBE = 64 << 20 };

/* ---- OBJ: a scan's surface from an equation, bumps on a ball, in the forms that exporters write */

enum { ROWS = 700 }; /* vertices: 2 ROWS x ROWS */

static void put_vertex(out *to, const char *word, int i, int j, double scale)
{
    double u = 2 * M_PI * j / (2 * ROWS), v = M_PI * (i + .5) / ROWS;
    double r = scale * (1 + .1 * sin(7 * u) * sin(5 * v) + .01 * sin(61 * u + 43 * v));
    out_format(to, "%s %.6f %.6f %.6f\n", word, r * sin(v) * cos(u), r * sin(v) * sin(u), r * cos(v));
}

static void put_corner(out *to, int vertex, bool textures, bool normals)
{
    if (textures)
        out_format(to, "%d/%d/%d", vertex, vertex, vertex);
    else if (normals)
        out_format(to, "%d//%d", vertex, vertex);
    else
        out_format(to, "%d", vertex);
}

static void put_scan(out *to, bool textures, bool normals)
{
    out_text(to, "# a scan\ng skin\n");
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < 2 * ROWS; j++)
            put_vertex(to, "v", i, j, 95.);
    for (int n = 0; textures && n < 2 * ROWS * ROWS; n++)
        out_format(to, "vt %.6f %.6f\n", n % ROWS / (double)ROWS, n / ROWS / (2. * ROWS));
    for (int i = 0; normals && i < ROWS; i++)
        for (int j = 0; j < 2 * ROWS; j++)
            put_vertex(to, "vn", i, j, 1.);
    for (int i = 0; i + 1 < ROWS; i++)
        for (int j = 0; j < 2 * ROWS; j++) {
            int a = 2 * ROWS * i + j + 1, b = 2 * ROWS * i + (j + 1) % (2 * ROWS) + 1;
            int corner[6] = {a, a + 2 * ROWS, b, b, a + 2 * ROWS, b + 2 * ROWS};
            for (int c = 0; c < 6; c++) {
                out_text(to, c % 3 ? " " : "f ");
                put_corner(to, corner[c], textures, normals);
                out_text(to, c % 3 == 2 ? "\n" : "");
            }
        }
}

/* Reads the OBJ at a path. */
static double read_obj(const char *path)
{
    err e = {0};
    obj o = {0};
    double from = bench_clock();
    in *s = in_open(path, &e);
    bench_must(s && !obj_read(&o, s, &e), &e);
    double took = bench_clock() - from;
    in_close(s);
    obj_free(&o);
    return took;
}

/* ---- models through a pipe: one end is a thread that only copies */

typedef struct pipe_end {
    int fd;
    const unsigned char *bytes;
    size_t size;
} pipe_end;

static void *feed(void *argument)
{
    pipe_end *p = argument;
    for (size_t at = 0; at < p->size;) {
        size_t n = p->size - at < 1 << 18 ? p->size - at : 1 << 18;
        ssize_t done = write(p->fd, p->bytes + at, n);
        if (done <= 0)
            break;
        at += (size_t)done;
    }
    close(p->fd);
    return NULL;
}

static void *drain(void *argument)
{
    pipe_end *p = argument;
    unsigned char *buffer = malloc(1 << 18);
    while (buffer && read(p->fd, buffer, 1 << 18) > 0)
        ;
    free(buffer);
    close(p->fd);
    return NULL;
}

/* A pipe's ends; the one that the models take is known by its path. */
static void make_pipe(int fd[2], char path[32], int own)
{
    err e = {0};
    bench_must(pipe(fd) == 0, &e);
    snprintf(path, 32, "/dev/fd/%d", fd[own]);
}

/* Bytes through a pipe from one thread to another: what any tool can reach at most. */
static double copy_pipe(const unsigned char *bytes, size_t size)
{
    int fd[2];
    char path[32];
    pthread_t thread;
    make_pipe(fd, path, 0);
    pipe_end end = {fd[1], bytes, size}, other = {fd[0], NULL, 0};
    double from = bench_clock();
    pthread_create(&thread, NULL, feed, &end);
    drain(&other);
    pthread_join(thread, NULL);
    return bench_clock() - from;
}

static double read_model(const unsigned char *bytes, size_t size)
{
    err e = {0};
    model m = {0};
    int fd[2];
    char path[32];
    pthread_t thread;
    make_pipe(fd, path, 0);
    pipe_end end = {fd[1], bytes, size};
    double from = bench_clock();
    pthread_create(&thread, NULL, feed, &end);
    in *s = in_open(path, &e);
    close(fd[0]);
    model_reader *r = s ? model_reader_open(s, &e) : NULL;
    bench_must(r && !model_read(r, &m, &e), &e);
    double took = bench_clock() - from;
    model_reader_close(r);
    in_close(s);
    pthread_join(thread, NULL);
    model_free(&m);
    return took;
}

static double write_model(const model *m)
{
    err e = {0};
    int fd[2];
    char path[32];
    pthread_t thread;
    make_pipe(fd, path, 1);
    pipe_end end = {fd[0], NULL, 0};
    double from = bench_clock();
    pthread_create(&thread, NULL, drain, &end);
    out *o = out_open(path, false, &e);
    close(fd[1]);
    model_writer *w = o ? model_writer_open(o, false, &e) : NULL;
    bench_must(w && !model_write(w, m, &e) && !model_write_end(w, &e), &e);
    bench_must(!out_close(o, &e), &e);
    pthread_join(thread, NULL);
    double took = bench_clock() - from;
    model_writer_close(w);
    return took;
}

/* As many elements as the face has at 0.625 mm. */
static void make_model(model *m)
{
    err e = {0};
    const int64_t nodes = 1700000, elements = 1550000;
    bench_must(!model_axis_add(m, "node", nodes, &e) && !model_axis_add(m, "element", elements, &e) &&
                   !model_axis_add(m, "volume", 3, &e),
               &e);
    static const char *const names[] = {"node.position", "node.lattice", "element.node", "element.lattice",
                                        "element.volume"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        model_array *a = model_add(m, names[i], &e);
        bench_must(a != NULL, &e);
        for (int64_t n = 0; n < a->rows * a->columns; n++)
            if (a->type == MODEL_F64)
                a->f64[n] = 1e-3 * (double)(n % 1237);
            else
                a->i32[n] = (int32_t)(strcmp(names[i], "element.volume") ? n % 1500000 : n % 3);
    }
}

/* ---- all of it */

static double sum(uint32_t (*checksum)(uint32_t, const void *, size_t), const unsigned char *bytes)
{
    uint32_t crc = 0;
    double from = bench_clock();
    for (size_t at = 0; at < PROBE; at += 1 << 18)
        crc = checksum(crc, bytes + at, 1 << 18);
    double took = bench_clock() - from;
    bench_use(crc);
    return took;
}

static uint32_t of_zlib(uint32_t crc, const void *bytes, size_t size)
{
    return (uint32_t)crc32(crc, bytes, (uInt)size);
}

static const char *const forms[] = {"obj read, corners v", "obj read, corners v//vn", "obj read, corners v/vt/vn"};
enum { FORMS = sizeof forms / sizeof *forms };

/* The forms as files, which the caller removes. */
static void write_scans(char path[FORMS][64], double *size)
{
    for (int i = 0; i < FORMS; i++) {
        err e = {0};
        snprintf(path[i], 64, "%s/sinew-bench-%d-%d.obj", "/tmp", (int)getpid(), i);
        out *o = out_open(path[i], false, &e);
        bench_must(o != NULL, &e);
        put_scan(o, i == 2, i > 0);
        size[i] = (double)out_count(o);
        bench_must(!out_close(o, &e), &e);
    }
}

static void tools(bench *b, int rounds, const char *bin, const char *face)
{
    bench_bytes plain = {0}, attached = {0}, bound = {0};
    bench_command voxelise = {bin, "voxelise", {"-q", "--unit", "mm", "-s", "0.625", face, NULL}};
    bench_command attach = {bin, "attach", {"-q", NULL}}, bind = {bin, "bind", {"-q", NULL}};
    bench_run(&voxelise, NULL, &plain);
    for (int i = 0; i < rounds; i++) {
        bench_take(b, "probe: copy through a pipe", (double)plain.size, "B", copy_pipe(plain.bytes, plain.size));
        bench_take(b, "attach, face at 0.625 mm, pipes included", 1, "run", bench_run(&attach, &plain, &attached));
        bench_take(b, "bind, face at 0.625 mm, pipes included", 1, "run", bench_run(&bind, &attached, &bound));
    }
    free(plain.bytes);
    free(attached.bytes);
    free(bound.bytes);
}

int main(int argc, char **argv)
{
    int rounds = argc > 3 ? atoi(argv[3]) : 5;
    err e = {0};
    bench b = {0};
    model m = {0};
    char path[FORMS][64];
    double size[FORMS];
    bench_bytes stream = {0};
    unsigned char *bytes = mem_array(PROBE, 1, "a probe", &e);
    bench_must(bytes != NULL, &e);
    for (size_t i = 0; i < PROBE; i++)
        bytes[i] = (unsigned char)(i * 2654435761u >> 13);
    make_model(&m);
    bench_stream(&m, &stream);
    write_scans(path, size);
    for (int round = 0; round < rounds; round++) {
        bench_probe(&b);
        bench_take(&b, "probe: copy through a pipe", (double)stream.size, "B", copy_pipe(stream.bytes, stream.size));
        bench_take(&b, "crc32 of zlib", PROBE, "B", sum(of_zlib, bytes));
        bench_take(&b, "crc32 of blocks", PROBE, "B", sum(checksum_add, bytes));
        for (int i = 0; i < FORMS; i++)
            bench_take(&b, forms[i], size[i], "B", read_obj(path[i]));
        bench_take(&b, "model read from a pipe", (double)stream.size, "B", read_model(stream.bytes, stream.size));
        bench_take(&b, "model write to a pipe", (double)stream.size, "B", write_model(&m));
    }
    for (int i = 0; i < FORMS; i++)
        unlink(path[i]);
    if (argc > 2 && !access(argv[2], R_OK))
        tools(&b, rounds, argv[1], argv[2]);
    bench_print(&b);
    free(bytes);
    free(stream.bytes);
    model_free(&m);
    return 0;
}
