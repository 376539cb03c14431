#include "tled/loop/checkpoint.h"

#include "base/mem.h"
#include "base/path.h"
#include "base/replace.h"
#include "model/binary.h"
#include "model/stream.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

struct checkpoint {
    char *path, *before, *frames_path; /* FILE, FILE.1, FILE.frames; owned */
    fingerprint of_run;
    model body;            /* of FILE, but for where the run stands */
    fields fields;         /* of the state */
    int axes;              /* of the model */
    int lock;              /* a descriptor of FILE.frames, which holds the lock; -1: none */
    out *frames;           /* what is added goes here */
    int64_t count, length; /* of the frames: how many, and bytes */
    int arrays;            /* of each */
    bool stale;            /* FILE is damaged: it does not become FILE.1 */
    ino_t saved;           /* FILE, as it was saved */
    run_point point;
    double time; /* nan: there is no state */
    frame state;
};

/* ---- numbers of a point, in arrays of one row each */

/* The last numbers are not in those that were written without them. */
enum { NUMBERS = 21, COUNTS = 10 };
static const int numbers_before[] = {19, 18};

static const char frames_key[] = "checkpoint.frames"; /* by which FILE.frames is known for ours */

static const char axis_name[] = "checkpoint", number_name[] = "checkpoint.number", count_name[] = "checkpoint.count";

/* The places of a point's numbers, in the order of checkpoint.number. */
#define AT(member) offsetof(run_point, member)
static const size_t number_at[NUMBERS] = {AT(origin),
                                          AT(course.damping),
                                          AT(course.remaining),
                                          AT(course.closest),
                                          AT(moved_most),
                                          AT(course.relax.guess),
                                          AT(course.relax.low),
                                          AT(course.relax.high),
                                          AT(course.relax.frequency),
                                          AT(course.relax.lowest),
                                          AT(course.relax.time),
                                          AT(log.past.first),
                                          AT(log.past.gravity),
                                          AT(log.past.forces),
                                          AT(log.past.held),
                                          AT(log.past.muscles),
                                          AT(log.past.probe),
                                          AT(log.past.damping),
                                          AT(course.most_strain),
                                          AT(course.finer),
                                          AT(rate)};
#undef AT

static void put_point(const checkpoint *c, const run_point *p, double *number, int64_t *count)
{
    const int64_t counts[COUNTS] = {
        p->first,  p->course.from, p->course.closest_at, p->course.cuts, p->course.relax.states, c->count,
        c->length, c->arrays,      p->course.taken,      p->log.length};
    for (int i = 0; i < NUMBERS; i++)
        memcpy(number + i, (const char *)p + number_at[i], sizeof *number);
    memcpy(count, counts, sizeof counts);
}

static void take_point(checkpoint *c, const model_array *number, const int64_t *k)
{
    c->point = (run_point){.first = k[0],
                           .course.from = k[1],
                           .course.closest_at = k[2],
                           .course.cuts = (int)k[3],
                           .course.relax.states = (int)k[4],
                           .course.taken = k[8],
                           .log.length = k[9]};
    for (int i = 0; i < number->columns; i++)
        memcpy((char *)&c->point + number_at[i], number->f64 + i, sizeof *number->f64);
    c->count = k[5];
    c->length = k[6];
    c->arrays = (int)k[7];
}

/* ---- life */

char *checkpoint_file(const char *path, int i, err *e)
{
    static const char *const suffixes[CHECKPOINT_FILES] = {"", ".1", ".frames"};
    return path_join(path, strlen(path), suffixes[i], e);
}

/* Removes a file, unless there is none. */
static int remove_file(const char *path, err *e)
{
    return unlink(path) && errno != ENOENT
               ? err_system(e, path, errno, "belongs to a run that has ended: cannot remove")
               : 0;
}

/* The state first: with all of its frames, what is left can be gone on from. */
int checkpoint_remove(const checkpoint *c, err *e)
{
    struct stat s;
    if (!isnan(c->time)) {
        if (remove_file(c->before, e))
            return -1;
        const bool is_there = !stat(c->path, &s); /* what is there now may be the output, by mistake */
        if (!is_there && errno != ENOENT)
            return err_system(e, c->path, errno, "belongs to a run that has ended");
        if (is_there && s.st_ino == c->saved && remove_file(c->path, e))
            return -1;
    }
    return c->lock >= 0 ? remove_file(c->frames_path, e) : 0;
}

void checkpoint_close(checkpoint *c)
{
    if (!c)
        return;
    out_discard(c->frames);
    if (c->lock >= 0)
        close(c->lock);
    fingerprint_free(&c->of_run);
    model_free(&c->body);
    frame_free(&c->state);
    free(c->path);
    free(c->before);
    free(c->frames_path);
    free(c);
}

static int make_body(checkpoint *c, const fingerprint_run *run, err *e)
{
    const model *m = run->m;
    for (int i = 0; i < m->axis_count; i++)
        if (model_axis_add(&c->body, m->axes[i].name, m->axes[i].count, e))
            return -1;
    return fingerprint_make(&c->of_run, run, e) || fingerprint_put(&c->of_run, &c->body, e) ||
                   model_axis_add(&c->body, axis_name, 1, e) ||
                   !model_add_as(&c->body, number_name, MODEL_F64, "1", axis_name, NUMBERS, e) ||
                   !model_add_as(&c->body, count_name, MODEL_I64, "1", axis_name, COUNTS, e)
               ? -1
               : 0;
}

static checkpoint *create(const char *path, const fingerprint_run *run, err *e)
{
    checkpoint *c = mem_array(1, sizeof *c, "the checkpoint", e);
    if (!c)
        return NULL;
    c->lock = -1;
    c->time = NAN;
    c->fields = run->p->fields;
    c->axes = run->m->axis_count;
    c->path = checkpoint_file(path, 0, e);
    c->before = checkpoint_file(path, 1, e);
    c->frames_path = checkpoint_file(path, 2, e);
    if (c->path && c->before && c->frames_path && !make_body(c, run, e))
        return c;
    checkpoint_close(c);
    return NULL;
}

/* Opens FILE.frames and locks it. */
static int open_frames(checkpoint *c, int flags, err *e)
{
    struct stat s, named;
    c->lock = open(c->frames_path, O_RDWR | O_CLOEXEC | flags, 0666);
    if (c->lock < 0)
        return err_system(e, c->frames_path, errno, flags ? "cannot create" : "cannot open");
    if (fstat(c->lock, &s))
        return err_system(e, c->frames_path, errno, "cannot open");
    if (!S_ISREG(s.st_mode))
        return err_set(e, c->frames_path, 0, "is not a regular file; expected one, or a new name");
    if (flock(c->lock, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK)
        return err_set(e, c->frames_path, 0, "another run is using it; expected one run at a time");
    const bool is_there = !stat(c->frames_path, &named);
    if (!is_there && errno != ENOENT)
        return err_system(e, c->frames_path, errno, "cannot open");
    if (!is_there || named.st_ino != s.st_ino || named.st_dev != s.st_dev)
        return err_set(e, c->frames_path, 0, "another run was using it until now; expected one run at a time");
    return 0;
}

static void begin_frames(out *to)
{
    char key[sizeof frames_key], text[] = "1";
    memcpy(key, frames_key, sizeof key);
    binary_encoding.write_begin(to);
    binary_encoding.write(to, &(item){.kind = ITEM_META, .key = key, .text = text});
}

/* What stands under the name of FILE.frames, without a FILE, is what is left of a run that was killed as it began;
 * anything else is not ours to empty. */
static int check_frames(const checkpoint *c, err *e)
{
    unsigned char found[256];
    size_t size = 0;
    ssize_t n = pread(c->lock, found, sizeof found, 0);
    out *head = out_memory(e);
    if (!head)
        return -1;
    begin_frames(head);
    const unsigned char *want = out_bytes(head, &size);
    int bad = out_failed(head, e);
    if (!bad && (n < 0 || memcmp(found, want, (size_t)n < size ? (size_t)n : size) != 0))
        bad = err_set(e, c->frames_path, 0, "exists, and is not a checkpoint; expected another name for --checkpoint");
    out_discard(head);
    return bad;
}

/* Whether something is there to go on from. */
static int check_none(const checkpoint *c, err *e)
{
    const char *const paths[] = {c->path, c->before};
    struct stat s;
    for (int i = 0; i < 2; i++)
        if (!lstat(paths[i], &s))
            return err_set(e, paths[i], 0,
                           "exists already; expected --restart, to go on from a checkpoint, or another name");
        else if (errno != ENOENT && errno != ENOTDIR)
            return err_system(e, paths[i], errno, "cannot create");
    return 0;
}

/* From here on frames are added, after the first `length` bytes. */
static int start_adding(checkpoint *c, err *e)
{
    if (ftruncate(c->lock, (off_t)c->length) || lseek(c->lock, (off_t)c->length, SEEK_SET) < 0)
        return err_system(e, c->frames_path, errno, "cannot write");
    int fd = fcntl(c->lock, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (fd < 0)
        return err_system(e, c->frames_path, errno, "cannot open");
    c->frames = out_take(fd, c->frames_path, e);
    if (!c->frames)
        close(fd);
    return c->frames ? 0 : -1;
}

checkpoint *checkpoint_begin(const char *path, const fingerprint_run *run, err *e)
{
    checkpoint *c = create(path, run, e);
    if (!c)
        return NULL;
    /* Twice: before anything is made, and once no other run can make one. */
    if (check_none(c, e) || open_frames(c, O_CREAT, e) || check_none(c, e) || check_frames(c, e) || start_adding(c, e))
        goto fail;
    /* Before the name of a state that counts on it is. */
    if (replace_store_names(c->frames_path, c->frames_path, e))
        goto fail;
    begin_frames(c->frames);
    for (int i = 0; i < c->axes; i++) {
        const model_axis *a = &c->body.axes[i];
        binary_encoding.write(c->frames, &(item){.kind = ITEM_AXIS, .key = a->name, .number = a->count});
    }
    return c;
fail:
    checkpoint_close(c);
    return NULL;
}

/* ---- adding and saving */

int checkpoint_add(checkpoint *c, const frame *f, err *e)
{
    binary_encoding.write(c->frames, &(item){.kind = ITEM_FRAME, .number = f->index, .time = f->time});
    for (int i = 0; i < f->arrays.count; i++)
        binary_encoding.write(c->frames, &(item){.kind = ITEM_ARRAY, .array = f->arrays.v[i]});
    c->count++;
    c->arrays = f->arrays.count;
    return out_failed(c->frames, e);
}

/* FILE becomes FILE.1, and stays FILE until there is a new one, where the file system has links. */
static int step_down(const checkpoint *c, err *e)
{
    if (unlink(c->before) && errno != ENOENT)
        return err_system(e, c->before, errno, "cannot remove");
    if (link(c->path, c->before) && errno != ENOENT && rename(c->path, c->before) && errno != ENOENT)
        return err_system(e, c->before, errno, "cannot create");
    return 0;
}

static int write_state(const checkpoint *c, const frame *state, err *e)
{
    out *o = out_open(c->path, false, e);
    model_writer *w = o ? model_writer_open(o, false, e) : NULL;
    const int failed = !w || model_write(w, &c->body, e) || model_write_frame(w, state, e) || model_write_end(w, e) ||
                       out_sync(o, e) || (!c->stale && step_down(c, e));
    model_writer_close(w);
    return out_end(o, failed, e);
}

int checkpoint_save(checkpoint *c, const run_point *at, double time, const field_values *state, err *e)
{
    struct stat s;
    frame f = {.index = at->first, .time = time};
    bool whole = !out_sync(c->frames, e) && !fields_lend(&c->fields, FIELD_IN_CHECKPOINTS, state, &f, &c->body, e);
    if (whole && fstat(c->lock, &s))
        whole = !err_system(e, c->frames_path, errno, "cannot write");
    if (whole)
        c->length = (int64_t)s.st_size;
    put_point(c, at, model_find(&c->body, number_name)->f64, model_find(&c->body, count_name)->i64);
    int bad = !whole || write_state(c, &f, e) ? -1 : 0;
    frame_free(&f);
    if (bad)
        return -1;
    c->stale = false;
    c->time = time;
    if (stat(c->path, &s))
        return err_system(e, c->path, errno, "cannot read");
    c->saved = s.st_ino;
    return 0;
}

double checkpoint_saved(const checkpoint *c)
{
    return c->time;
}

/* ---- going on */

static const model_array *find_row(const model *m, const char *name, model_type type, int columns)
{
    const model_array *a = model_find(m, name);
    return a && a->type == type && a->columns == columns && a->rows == 1 ? a : NULL;
}

/* All of it, to its end. Returns -1 with e filled; *foreign: it is whole, but not this run's. */
static int read_state(checkpoint *c, const char *path, bool *foreign, err *e)
{
    model m = {0};
    frame none = {0};
    int result = -1;
    in *s = in_open_plain(path, e);
    model_reader *r = s ? model_reader_open(s, e) : NULL;
    if (!r || model_read(r, &m, e) || model_read_frame(r, &m, &c->state, e) < 0 ||
        model_read_frame(r, &m, &none, e) < 0)
        goto out;
    *foreign = true;
    if (fingerprint_compare(&c->of_run, &m, path, e))
        goto out;
    const model_array *number = find_row(&m, number_name, MODEL_F64, NUMBERS);
    for (int i = 0; !number && i < 2; i++)
        number = find_row(&m, number_name, MODEL_F64, numbers_before[i]);
    const model_array *count = find_row(&m, count_name, MODEL_I64, COUNTS);
    if (!number || !count || !fields_fit(&c->fields, FIELD_IN_CHECKPOINTS, &c->state)) {
        err_set(e, path, 0, "is not a checkpoint; expected one that tled-run wrote");
        goto out;
    }
    take_point(c, number, count->i64);
    c->time = c->state.time;
    result = 0;
out:
    frame_free(&none);
    model_free(&m);
    model_reader_close(r);
    in_close(s);
    return result;
}

static int misplaced(const item_source *s, const item *it, err *e)
{
    return item_error(s, it, e, "does not belong in the frames of a checkpoint");
}

/* The next frame of FILE.frames. -1 with e filled. */
static int read_frame(item_source *s, int arrays, frame *f, err *e)
{
    item it = {0};
    int bad = 0;
    for (int i = -1; !bad && i < arrays; i++) {
        item_free(&it);
        bad = binary_encoding.read(s, &it, e);
        if (!bad && it.kind != (i < 0 ? ITEM_FRAME : ITEM_ARRAY))
            bad = misplaced(s, &it, e);
        if (!bad && i < 0)
            *f = (frame){.index = it.number, .time = it.time};
        else if (!bad && !model_arrays_take(&f->arrays, &it.array, e))
            bad = -1;
    }
    item_free(&it);
    return bad;
}

/* Reads the first `count` frames, and gives each to take, which may be NULL. */
static int read_frames(const checkpoint *c, checkpoint_frame *take, void *context, err *e)
{
    frame f = {0};
    item it = {0};
    in *stream = in_open_plain(c->frames_path, e);
    item_source s = {.s = stream, .how = &binary_encoding};
    int bad = !stream || s.how->begin(&s, e) || s.how->read(&s, &it, e);
    if (!bad && (it.kind != ITEM_META || strcmp(it.key, frames_key) != 0))
        bad = misplaced(&s, &it, e);
    for (int i = 0; !bad && i < c->axes; i++) {
        item_free(&it);
        bad = s.how->read(&s, &it, e);
        if (!bad)
            bad = it.kind != ITEM_AXIS ? misplaced(&s, &it, e) : model_axis_add(&s.axes, it.key, it.number, e);
    }
    for (int64_t i = 0; !bad && i < c->count; i++) {
        bad = read_frame(&s, c->arrays, &f, e) || (take && take(context, &f, e));
        frame_free(&f);
    }
    item_free(&it);
    model_free(&s.axes);
    in_close(stream);
    return bad ? -1 : 0;
}

/* Whether the state at path is whole, this run's, and all its frames are there. */
static int try_state(checkpoint *c, const char *path, bool *foreign, err *e)
{
    struct stat s;
    *foreign = false;
    if (read_state(c, path, foreign, e))
        return -1;
    *foreign = false;
    if (fstat(c->lock, &s))
        return err_system(e, c->frames_path, errno, "cannot read");
    if ((int64_t)s.st_size < c->length)
        return err_set(e, c->frames_path, 0, "has %lld bytes; expected %lld", (long long)s.st_size,
                       (long long)c->length);
    return read_frames(c, NULL, NULL, e);
}

/* FILE or FILE.1. */
static int choose_state(checkpoint *c, notes *warnings, err *e)
{
    bool foreign;
    err first = {0}, second = {0};
    if (!try_state(c, c->path, &foreign, &first))
        return 0;
    if (!foreign && !try_state(c, c->before, &foreign, &second)) {
        c->stale = true;
        notes_add(warnings, "%s; the run goes on from the checkpoint before it, %s, at %.6g s", first.text, c->before,
                  c->time);
        return 0;
    }
    c->time = NAN;
    if (second.status && access(c->before, F_OK) == 0)
        return err_set(e, NULL, 0, "%.450s; and %.450s", first.text, second.text);
    *e = first;
    return -1;
}

checkpoint *checkpoint_resume(const char *path, const fingerprint_run *run, notes *warnings, err *e)
{
    struct stat s;
    checkpoint *c = create(path, run, e);
    if (!c)
        return NULL;
    if (access(c->path, F_OK) && access(c->before, F_OK)) {
        err_system(e, c->path, errno, "cannot open");
        goto fail;
    }
    if (open_frames(c, 0, e) || choose_state(c, warnings, e))
        goto fail;
    if (!stat(c->path, &s))
        c->saved = s.st_ino;
    else if (errno != ENOENT) {
        err_system(e, c->path, errno, "cannot open");
        goto fail;
    }
    return c;
fail:
    checkpoint_close(c);
    return NULL;
}

const run_point *checkpoint_take(const checkpoint *c, tled_problem *p)
{
    fields_read(&c->fields, FIELD_IN_CHECKPOINTS, &c->state, &p->at_start);
    p->start = c->state.time;
    return &c->point;
}

int checkpoint_replay(checkpoint *c, checkpoint_frame *take, void *context, err *e)
{
    return read_frames(c, take, context, e) || start_adding(c, e) ? -1 : 0;
}
