#include "volume/body.h"

#include "base/keyfile.h"
#include "base/mem.h"
#include "base/num.h"
#include "base/path.h"
#include "base/pose.h"
#include "place/transform.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS_MOST = 1000 };

enum { KEY_MOVE, KEY_TURN, KEY_UNIT, KEY_IN };
static const char *const keys[] = {"move", "turn", "unit", "in"};

/* ---- the file */

typedef struct line {
    pose place;
    double scale; /* 0: not given */
    bool in_volume;
    const char *rigid; /* borrowed from the line; or NULL */
} line;

static int take_move(const keyfile *k, const char *text, double to[3], err *e)
{
    num_length list[3];
    if (num_lengths_of(text, list, 3) != 3)
        return keyfile_error(k, e, "move=%.100s; expected three lengths X,Y,Z, metres without a suffix", text);
    for (int a = 0; a < 3; a++)
        to[a] = num_length_in(list[a], num_unit_of("m"), num_unit_of("m"));
    return 0;
}

static int take_turn(const keyfile *k, const char *text, double to[4], err *e)
{
    double q[4];
    if (num_list(text, q, 4) != 4 || !pose_is_unit(pose_unit(q)))
        return keyfile_error(k, e, "turn=%.100s; expected a unit quaternion X,Y,Z,W, its length 1 to within 0.01",
                             text);
    memcpy(to, q, sizeof q);
    return 0;
}

static int take_key(const keyfile *k, int key, const char *value, bool surface, line *l, err *e)
{
    if (key == KEY_MOVE)
        return take_move(k, value, l->place.position, e);
    if (key == KEY_TURN)
        return take_turn(k, value, l->place.quaternion, e);
    if (!surface)
        return keyfile_error(k, e, "%s= of the volume; expected move= or turn=", keys[key]);
    if (key == KEY_UNIT) {
        num_unit unit = num_unit_of(value);
        if (!unit)
            return keyfile_error(k, e, "unit=%.100s; expected " NUM_UNITS, value);
        l->scale = num_length_in((num_length){1, unit}, unit, num_unit_of("m"));
        return 0;
    }
    l->in_volume = strcmp(value, "body") != 0;
    l->rigid = l->in_volume && strcmp(value, "volume") != 0 ? value : NULL;
    return 0;
}

static int take_keys(keyfile *k, int from, bool surface, line *l, err *e)
{
    uint64_t seen = 0;
    *l = (line){.place = pose_none()};
    for (int i = from; i < k->count; i++) {
        char *value;
        int key = keyfile_pair(k, i, keys, sizeof keys / sizeof *keys, &seen, &value, e);
        if (key < 0 || take_key(k, key, value, surface, l, e))
            return -1;
    }
    return 0;
}

static int take_surface(body *b, keyfile *k, err *e)
{
    line l;
    if (k->count < 2 || strchr(k->word[1], '='))
        return keyfile_error(k, e, "a surface without a file; expected surface FILE.obj unit=mm ...");
    if (strchr(k->word[1], '/'))
        return keyfile_error(k, e, "'%.200s': expected the name of a file in the folder of this one", k->word[1]);
    if (b->parts == PARTS_MOST)
        return keyfile_error(k, e, "more than %d surfaces", PARTS_MOST);
    if (take_keys(k, 2, true, &l, e))
        return -1;
    if (!(l.scale > 0))
        return keyfile_error(k, e, "'%.200s' without unit=; expected " NUM_UNITS, k->word[1]);
    if (MEM_ROOM(&b->part, &b->room, b->parts + 1, "the parts of a body", e))
        return -1;
    body_part *part = &b->part[b->parts++];
    *part = (body_part){.file = mem_text(k->word[1], e),
                        .scale = l.scale,
                        .place = l.place,
                        .in_volume = l.in_volume,
                        .rigid = l.rigid ? mem_text(l.rigid, e) : NULL,
                        .line = k->line};
    return part->file && (part->rigid || !l.rigid) ? 0 : -1;
}

/* Parts in the volume go where it goes, once it is known. */
static void place_parts(body *b)
{
    for (int i = 0; i < b->parts; i++)
        if (b->part[i].in_volume)
            b->part[i].place = pose_compose(&b->volume, &b->part[i].place);
}

/* A line of the file: a surface, or where the volume is, which is said once. */
static int take_line(body *b, keyfile *k, bool *placed, err *e)
{
    line l;
    if (!strcmp(k->word[0], "surface"))
        return take_surface(b, k, e);
    if (strcmp(k->word[0], "volume") != 0)
        return keyfile_error(k, e, "'%.100s'; expected volume or surface", k->word[0]);
    if (*placed)
        return keyfile_error(k, e, "the volume is placed twice; expected once");
    if (take_keys(k, 1, false, &l, e))
        return -1;
    b->volume = l.place;
    *placed = true;
    return 0;
}

static int read_words(body *b, in *s, err *e)
{
    keyfile k;
    int got;
    bool placed = false;
    keyfile_open(&k, s);
    while ((got = keyfile_next(&k, e)) > 0)
        if (take_line(b, &k, &placed, e)) {
            got = -1;
            break;
        }
    if (got < 0)
        body_free(b);
    else
        place_parts(b);
    return got;
}

static int read_bytes(body *b, const transform_file *f, err *e)
{
    if (f->frames || transform_is(f->bytes, f->size))
        return transform_read(f, &b->volume, e);
    in *s = in_memory(f->bytes, (size_t)f->size, f->name, e);
    const int failed = s ? read_words(b, s, e) : -1;
    in_close(s);
    return failed;
}

int body_read(body *b, in *s, const char *frames, err *e)
{
    char *bytes = NULL;
    transform_file f = {.name = in_name(s), .frames = frames, .use = TRANSFORM_BODY};
    *b = (body){.volume = pose_none()};
    if (in_peek(s, e) == -2) /* steps over a byte order mark */
        return -1;
    f.size = in_all(s, &bytes, e);
    f.bytes = bytes;
    const int failed = f.size < 0 ? -1 : read_bytes(b, &f, e);
    free(bytes);
    return failed;
}

int body_open(body *b, const char *path, err *e)
{
    const char *frames;
    *b = (body){.volume = pose_none()};
    char *file = transform_path(path, &frames, e);
    in *s = file ? in_open(file, e) : NULL;
    const int failed = s ? body_read(b, s, frames, e) : -1;
    in_close(s);
    free(file);
    return failed;
}

const body_part *body_find(const body *b, const char *path)
{
    const char *name = path + path_folder(path);
    for (int i = 0; i < b->parts; i++)
        if (!strcmp(b->part[i].file, name))
            return &b->part[i];
    return NULL;
}

void body_place(const body *b, const body_part *part, double *position, int64_t points)
{
    for (int64_t i = 0; i < points; i++) {
        double *x = position + 3 * i, in_body[3];
        for (int a = 0; a < 3; a++)
            x[a] *= part->scale;
        pose_apply(&part->place, x, in_body);
        pose_apply_inverse(&b->volume, in_body, x);
    }
}

void body_free(body *b)
{
    for (int i = 0; i < b->parts; i++) {
        free(b->part[i].file);
        free(b->part[i].rigid);
    }
    free(b->part);
    *b = (body){0};
}
