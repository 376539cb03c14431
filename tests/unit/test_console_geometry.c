// What a page draws of a block of tetrahedra: its outside, closed, the right way out; and where it is in a frame.
// needs: common/console/around.c common/console/colouring.c common/console/geometry.c common/console/json.c
// needs: common/console/mailbox.c msds/mesh/mesh_tets.c
#include "console/around.h"
#include "console/colouring.h"
#include "msds_block.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static uint32_t word_at(const mail *m, size_t at)
{
    uint32_t word;
    memcpy(&word, m->bytes + at, sizeof word);
    return word;
}

static float number_at(const mail *m, size_t at)
{
    float number;
    memcpy(&number, m->bytes + at, sizeof number);
    return number;
}

/* The only mesh of a geometry: where its positions and triangles begin. */
typedef struct mesh_at {
    size_t position, triangle;
    uint32_t vertices, triangles;
} mesh_at;

static mesh_at find_mesh(const mail *m)
{
    const size_t length = word_at(m, 4), padded = (length + 3) / 4 * 4;
    char header[600] = "";
    mesh_at at = {.position = 8 + padded};
    snprintf(header, sizeof header, "%.*s", (int)length, (const char *)m->bytes + 8);
    const char *counts = strstr(header, "\"vertices\":");
    if (counts && sscanf(counts, "\"vertices\":%u,\"triangles\":%u", &at.vertices, &at.triangles) != 2)
        at.vertices = 0;
    at.triangle = at.position + 12 * (size_t)at.vertices;
    ok(strstr(header, "\"name\":\"skin\",\"kind\":\"skin\"") && strstr(header, "\"moves\":true"),
       "its outside is skin");
    ok(strstr(header, "\"up\":[0,0,1]") != NULL, "up is away from what is fixed");
    ok(m->size == at.triangle + 12 * (size_t)at.triangles, "the message has the size that its header says");
    return at;
}

/* By the divergence theorem: below 0 where triangles are turned inside. */
static double volume_of(const mail *m, const mesh_at *at)
{
    double volume = 0;
    for (uint32_t t = 0; t < at->triangles; t++) {
        double x[3][3];
        for (int c = 0; c < 3; c++)
            for (int a = 0; a < 3; a++)
                x[c][a] = (double)number_at(m, at->position + 12 * (size_t)word_at(m, at->triangle + 12 * t + 4 * c) +
                                                   4 * (size_t)a);
        for (int a = 0; a < 3; a++)
            volume += x[0][a] * (x[1][(a + 1) % 3] * x[2][(a + 2) % 3] - x[1][(a + 2) % 3] * x[2][(a + 1) % 3]) / 6;
    }
    return volume;
}

/* u = 0 at x = 0, and .01 m up at x = .1 m. */
static void try_positions(geometry *g, const model *m, const mail *scene, const mesh_at *at)
{
    const int64_t nodes = model_count(m, "node");
    const double *rest = model_find(m, "node.position")->f64;
    err e = {0};
    double *u = mem_array(3 * nodes, sizeof *u, "displacements", &e), off = 0, wrong = 0;
    for (int64_t n = 0; n < nodes; n++)
        u[3 * n + 2] = .1 * rest[3 * n];
    mail *is = geometry_positions(g, &(geometry_frame){.index = 7, .u = u}, &e);
    const size_t values = 12 + 32 + (6 * (size_t)at->vertices + 3) / 4 * 4;
    ok(word_at(is, 0) == 3 && word_at(is, 4) == 7 && word_at(is, 8) == 1, "positions of frame 7, of one mesh");
    ok(word_at(is, 12) == 0 && word_at(is, 16) == at->vertices, "of all its vertices");
    ok(is->size == values + 12 + (at->vertices + 3) / 4 * 4, "the message has its size");
    near_((double)number_at(is, values + 4), .01, 1e-7, "the scale's end is the largest displacement");
    for (uint32_t i = 0; i < 3 * at->vertices; i++) {
        int16_t share;
        memcpy(&share, is->bytes + 44 + 2 * (size_t)i, 2);
        const double low = (double)number_at(is, 20 + 4 * (i % 3)), high = (double)number_at(is, 32 + 4 * (i % 3));
        const double place = (low + high) / 2 + (high - low) / 2 * share / 32767;
        const size_t vertex = at->position + 12 * (size_t)(i / 3);
        const double x = (double)number_at(scene, vertex),
                     want = (double)number_at(scene, at->position + 4 * (size_t)i);
        off = fmax(off, fabs(place - want - (i % 3 == 2 ? .1 * x : 0)));
        if (i % 3 == 0)
            wrong = fmax(wrong, fabs(is->bytes[values + 12 + i / 3] / 255. - x / .1));
    }
    near_(off, 0, .11 / 65534 + 1e-8, "places are within half a step of 16 bits");
    near_(wrong, 0, .5 / 255 + 1e-5, "values within half a step of 8");
    mail_done(is);
    free(u);
}

/* A block that is .8 of its length along x; and speeds of up to .3 m/s. */
static void try_colours(const model *m)
{
    const int64_t nodes = model_count(m, "node");
    const double *rest = model_find(m, "node.position")->f64;
    err e = {0};
    frame f = {0};
    double *u = mem_array(3 * nodes, sizeof *u, "displacements", &e), off = 0;
    colouring_room room;
    if (colouring_room_make(&room, m, &e) || !room.results) {
        ok(false, "room for colours: %s", e.text);
        return;
    }
    const double *value = room.value;
    model_array *v = frame_add(&f, m, "node.velocity", &e);
    geometry_frame plain = {.u = u}, quality = {.u = u}, speed = {.u = u};
    for (int64_t n = 0; n < nodes; n++)
        u[3 * n] = -.2 * rest[3 * n];
    for (int64_t n = 0; v && n < nodes; n++)
        v->f64[3 * n + 1] = -3 * rest[3 * n];
    colouring_fill(COLOURING_DISPLACEMENT, &room, &f, &plain);
    ok(!plain.value, "displacements need no values");
    colouring_fill(COLOURING_QUALITY, &room, &f, &quality);
    for (int64_t n = 0; quality.value && n < nodes; n++)
        off = fmax(off, fabs(value[n] - .8));
    ok(quality.value == value && off < 1e-12, "the quality is J at each node, to %g", off);
    ok(quality.low > .69 && quality.low < .8 + 1e-12 && quality.high >= .8, "within round ends");
    colouring_fill(COLOURING_SPEED, &room, &f, &speed);
    near_(speed.value ? value[nodes - 1] : 0, 3 * rest[3 * (nodes - 1)], 1e-12, "the speed is a velocity's length");
    near_(speed.high, .5, 1e-12, "up to 1, 2 or 5 times a power of ten");
    geometry_frame stress = {.u = u}, stretch = {.u = u}, fibre = {.u = u};
    colouring_fill(COLOURING_STRESS, &room, &f, &stress);
    ok(!stress.value, "no stress without displacements in the frame");
    memcpy(frame_add(&f, m, "node.displacement", &e)->f64, u, 3 * (size_t)nodes * sizeof *u);
    const double young = model_find(m, "material.E")->f64[0], poisson = model_find(m, "material.nu")->f64[0];
    const double mises = .2 * young / (1 + poisson);
    colouring_fill(COLOURING_STRESS, &room, &f, &stress);
    off = 0;
    for (int64_t n = 0; stress.value && n < nodes; n++)
        off = fmax(off, fabs(value[n] / mises - 1));
    ok(stress.value == value && off < 1e-6, "von Mises' stress, 2 mu times the strain, to %g", off);
    ok(stress.low == 0 && stress.high >= mises && stress.high <= 2.5 * mises, "up to a round end");
    colouring_fill(COLOURING_STRETCH, &room, &f, &stretch);
    near_(stretch.value ? value[0] : 0, 1, 1e-6, "the largest stretch is that of the sides");
    colouring_fill(COLOURING_FIBRE, &room, &f, &fibre);
    near_(fibre.value ? value[0] : 0, 1, 0, "where there are no fibres it is 1");
    char words[COLOURING_WORDS];
    colouring_words(words);
    ok(!strcmp(words, "own, displacement, speed, quality, stress, stretch, stretch.fibre, energy"), "all: %s", words);
    ok(colouring_find("blue") < 0 && colouring_find("quality") == COLOURING_QUALITY, "by name");
    frame_free(&f);
    free(u);
    colouring_room_free(&room);
}

static void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    ok(f && fputs(text, f) >= 0 && !fclose(f), "%s", path);
}

/* A scene of what is around the model, where the body.txt is found to fit it. */
static geometry *make_around(around *a, const char *file, model *m, bool face, err *e)
{
    char path[60];
    snprintf(path, sizeof path, "%s", file);
    const console_case is = {.body = path};
    *e = (err){0};
    geometry *g = around_read(a, &is, m, e) ? NULL : geometry_make(m, face, "", e);
    a->body_path = file;
    if (!g || !around_attach(a, m, g, e))
        return g;
    geometry_free(g);
    return NULL;
}

/* The tooth is the first mesh: it lies at z = 40 mm, and 5 mm above that where its body went up so far. */
static void try_tooth(const geometry *g, const model *m)
{
    err e = {0};
    frame f = {.index = 3};
    memcpy(frame_add(&f, m, "body.pose", &e)->f64, (double[]){0, 0, .005, 0, 0, 0, 1}, 7 * sizeof(double));
    mail *scene = geometry_mail(g, &e);
    ok(strstr((const char *)scene->bytes + 8, "\"name\":\"tooth\"") != NULL, "it has its name");
    near_((double)number_at(scene, 8 + (word_at(scene, 4) + 3) / 4 * 4 + 8), .04, 1e-7, "and lies where body.txt says");
    const int64_t nodes = model_count(m, "node");
    double *u = mem_array(3 * nodes, sizeof *u, "displacements", &e);
    double *value = mem_array(nodes, sizeof *value, "values", &e);
    mail *is = geometry_positions(g, &(geometry_frame){.index = 3, .rigid = &f, .u = u}, &e);
    ok(word_at(is, 8) == 2 && word_at(is, 16) == 4, "two meshes move, the first of four vertices");
    near_((double)number_at(is, 20 + 8), .045, 1e-7, "which went 5 mm up");
    mail_done(is);
    is = geometry_positions(g, &(geometry_frame){.u = u, .value = value, .high = 1}, &e);
    near_((double)number_at(is, 20 + 8), .04, 1e-7, "and not without a pose; colours of tissue leave it out");
    mail_done(is);
    mail_done(scene);
    free(u);
    free(value);
    frame_free(&f);
}

/* A tooth that goes with a rigid body, in a body in which the model lies 1 m along x. */
static void try_rigid(model *m)
{
    char folder[] = "/tmp/sinew-around-XXXXXX", tooth[60], file[60];
    err e = {0};
    around a = {0};
    ok(mkdtemp(folder) != NULL, "a folder");
    snprintf(tooth, sizeof tooth, "%s/tooth.obj", folder);
    snprintf(file, sizeof file, "%s/body.txt", folder);
    write_text(tooth, "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n");
    write_text(file, "volume move=1,0,0\nsurface tooth.obj unit=mm in=jaw move=0,0,4cm\n");
    ok(!make_around(&a, file, m, true, &e) && strstr(e.text, "body.txt:2: 'jaw': the model has no rigid bodies"), "%s",
       e.text);
    around_free(&a);
    model_axis_add(m, "body", 1, &e);
    model_set_text(model_add(m, "body.name", &e), 0, "jam", &e);
    model_add(m, "node.body", &e);
    ok(!make_around(&a, file, m, true, &e) && strstr(e.text, "body.txt:2: ") && strstr(e.text, "jam"), "%s", e.text);
    around_free(&a);
    model_set_text(model_find(m, "body.name"), 0, "jaw", &e);
    for (int face = 0; face < 2; face++) {
        geometry *g = make_around(&a, file, m, face, &e);
        if (ok(g != NULL, "a scene with a tooth %s", e.text))
            try_tooth(g, m);
        geometry_free(g);
        around_free(&a);
    }
    unlink(tooth);
    unlink(file);
    ok(!rmdir(folder), "nothing else was made");
}

int main(void)
{
    const tets block = {{5, 4, 3}, {.1, .06, .04}, 1e4, .3, 1000, 2, false};
    model m = {0};
    err e = {0};
    tets_make(&block, &m);
    geometry *g = geometry_make(&m, false, "", &e);
    if (!ok(g != NULL, "a scene of a block %s", e.text))
        return done_testing();
    mail *scene = geometry_mail(g, &e);
    const mesh_at at = find_mesh(scene);
    ok(at.triangles == 2 * 2 * (4 * 3 + 3 * 2 + 4 * 2), "two triangles a side of a cell: %u", at.triangles);
    ok(at.vertices == at.triangles / 2 + 2, "its surface is a sphere's: %u vertices", at.vertices);
    near_(volume_of(scene, &at), .1 * .06 * .04, 1e-9, "it encloses the block, turned outward");
    try_positions(g, &m, scene, &at);
    try_colours(&m);
    mail_done(scene);
    geometry_free(g);
    try_rigid(&m);
    model_free(&m);
    return done_testing();
}
