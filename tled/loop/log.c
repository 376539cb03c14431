#include "tled/loop/log.h"

#include "base/chars.h"
#include "base/clock.h"
#include "base/in.h"
#include "base/mem.h"
#include "base/num.h"
#include "base/path.h"
#include "model/rest_place.h"
#include "tled/contact/sliding_loads.h"
#include "tled/problem/bodies.h"
#include "tled/problem/film_strain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Quantity and unit; the last two go by the clock, and differ from run to run. Nodes' come after them, then what
 * elements are like. */
static const char heading[] =
    "time/s\tstep\tdt/s\tstable/s\tkinetic/J\tstrain/J\thourglass/J\tgravity/J\tforces/J\tdisplaced/J\tmuscles/"
    "J\tprobe/J\t"
    "damping/J\tbalance/J\tdisplacement/m\tspeed/(m/s)\tresidual/(m/s2)\tremaining\tsteps/(1/s)\telements/(1/s)";

static const char heading_muscles[] = "\tmuscles.falling";
static const char heading_end[] = "\tquality.j.centre\tquality.j.corner\tquality.folded\tquality.hourglass\n";

static const char trace[] = "node.displacement.at.";

static int place_of(const char *key, double *place, err *e)
{
    if (!strncmp(key, trace, sizeof trace - 1) && rest_place_of(key + sizeof trace - 1, place))
        return 0;
    return err_usage(e,
                     "--tsv '%.80s': expected %sX,Y,Z, three lengths between commas (metres, or with a unit), %s, %s "
                     "or %s",
                     key, trace, LOG_LEVEL, LOG_ACTIVATION, LOG_ENERGY);
}

static bool is_of_muscles(const char *key)
{
    return !strcmp(key, LOG_LEVEL) || !strcmp(key, LOG_ACTIVATION);
}

static bool is_of_materials(const char *key)
{
    return !strcmp(key, LOG_ENERGY);
}

static bool is_of_place(const char *key)
{
    return !is_of_muscles(key) && !is_of_materials(key);
}

int log_check_key(const char *key, err *e)
{
    double place[3];
    return is_of_place(key) ? place_of(key, place, e) : 0;
}

/* The name of a body as a part of a column's. */
static void put_name(const char *name, out *to)
{
    for (const char *c = name; *c; c++)
        out_write(to, (unsigned char)*c <= ' ' ? "_" : c, 1);
}

static void put_bodies_heading(const model *m, out *to)
{
    const model_array *name = model_find(m, "node.body") ? model_find(m, "body.name") : NULL;
    for (int64_t i = 0; name && i < 6 * name->rows; i++) {
        out_text(to, i / 3 % 2 ? "\tbody.torque." : "\tbody.force.");
        put_name(name->str[i / 6], to);
        out_format(to, ".%c/%s", "xyz"[i % 3], i / 3 % 2 ? "(N m)" : "N");
    }
}

/* "KEY.NAME", as the model has the name, and the unit. */
static int put_named(const char *key, const char *name, const char *unit, out *to, err *e)
{
    char *shown = mem_array(4 * (int64_t)strlen(name) + 1, 1, "the log", e);
    if (!shown)
        return -1;
    chars_escape(name, strlen(name), shown);
    out_format(to, "\t%s.%s%s", key, shown, unit);
    free(shown);
    return 0;
}

/* A column a muscle that is driven, by its name in the model; -c finds it by what is written here. */
static int put_muscles_heading(const run_log *l, const char *key, out *to, err *e)
{
    const model_array *names = model_find(l->m, "volume.name");
    for (int64_t i = 0; i < l->script->curves; i++) {
        const script_curve *c = &l->script->curve[i];
        if (c->verb == SCRIPT_CONTRACT && put_named(key, names->str[c->volume], "", to, e))
            return -1;
    }
    return 0;
}

static int put_materials_heading(const run_log *l, const char *key, out *to, err *e)
{
    const model_array *names = model_find(l->m, "material.name");
    for (int64_t i = 0; i < names->rows; i++)
        if (put_named(key, names->str[i], "/J", to, e))
            return -1;
    return 0;
}

static int put_key_heading(const run_log *l, const char *key, out *to, err *e)
{
    if (is_of_muscles(key))
        return put_muscles_heading(l, key, to, e);
    if (is_of_materials(key))
        return put_materials_heading(l, key, to, e);
    for (int a = 0; a < 3; a++)
        out_format(to, "\t%s.%c/m", key, "xyz"[a]);
    return 0;
}

static int put_heading(const run_log *l, out *to, err *e)
{
    out_text(to, heading);
    for (int i = 0; i < l->keys->count; i++)
        if (put_key_heading(l, l->keys->value[i], to, e))
            return -1;
    put_bodies_heading(l->m, to);
    if (account_has_muscles(l->p))
        out_text(to, heading_muscles);
    out_text(to, heading_end);
    return 0;
}

/* line: the first of the file, NULL where there is none. */
static int compare_heading(const run_log *l, const char *path, const char *line, err *e)
{
    size_t size;
    out *want = out_memory(e);
    if (!want)
        return -1;
    int failed = put_heading(l, want, e);
    const unsigned char *bytes = out_bytes(want, &size);
    failed = failed || out_failed(want, e) ? -1 : 0;
    if (!failed && (!line || strlen(line) + 1 != size || memcmp(line, bytes, size - 1) != 0))
        failed = err_set(e, path, 1,
                         "is not the heading of this run's log; expected the file and the --tsv that it began with");
    out_discard(want);
    return failed;
}

/* Whether the file that is continued begins with the heading of this run. A file shorter than `keep` is refused by
 * growing_open; what is not a regular file has no heading to check. */
static int check_heading(const run_log *l, const char *path, int64_t keep, err *e)
{
    char *line = NULL;
    struct stat s;
    const int there = path_look(path, &s, e);
    if (there < 1 || !S_ISREG(s.st_mode) || s.st_size < (off_t)keep)
        return there < 0 ? -1 : 0;
    in *file = in_open_plain(path, e);
    const int failed = !file || in_line(file, &line, NULL, e) == -2 || compare_heading(l, path, line, e) ? -1 : 0;
    in_close(file);
    return failed;
}

int log_open(run_log *l, const char *path, const opt_list *keys, const model *m, const log_point *from, err *e)
{
    l->keys = keys;
    l->m = m;
    for (int i = 0; i < keys->count; i++) {
        double place[3];
        if (!is_of_place(keys->value[i]))
            continue;
        if (place_of(keys->value[i], place, e))
            return -1;
        l->node[i] = rest_place_row(m, "node", place);
    }
    const int64_t keep = from ? from->length : 0;
    if (keep && check_heading(l, path, keep, e))
        return -1;
    l->file = growing_open(path, keep, e);
    return l->file ? 0 : -1;
}

/* Sends the rows, and begins anew. */
static int empty_rows(run_log *l, bool send, err *e)
{
    size_t size;
    const unsigned char *bytes = out_bytes(l->rows, &size);
    int bad = out_failed(l->rows, e);
    if (!bad && send && size)
        bad = growing_put(l->file, bytes, size, e);
    out_discard(l->rows);
    l->rows = bad ? NULL : out_memory(e);
    l->is_pending = false;
    return l->rows ? 0 : -1;
}

/* Where a key asks for energies by material. */
static int make_energies(run_log *l, err *e)
{
    bool wanted = false;
    for (int i = 0; i < l->keys->count; i++)
        wanted |= is_of_materials(l->keys->value[i]);
    if (!wanted)
        return 0;
    l->energy = mem_array(model_count(l->m, "material"), sizeof *l->energy, "the log", e);
    l->bone = mem_array(films_count(l->p), sizeof *l->bone, "the log", e);
    return l->energy && l->bone ? results_create(&l->results, l->m, 0, l->threads, e) : -1;
}

int log_begin(run_log *l, const tled_problem *p, pool *threads, err *e)
{
    l->p = p;
    l->threads = threads;
    l->began = clock_now();
    l->account = account_create(p, threads, e);
    l->rows = l->account ? out_memory(e) : NULL;
    if (!l->rows || make_energies(l, e))
        return -1;
    if (!growing_size(l->file) && put_heading(l, l->rows, e))
        return -1;
    return empty_rows(l, true, e);
}

int log_store(run_log *l, err *e)
{
    return growing_store(l->file, e);
}

log_point log_point_of(const run_log *l)
{
    return (log_point){account_past_of(l->account), growing_size(l->file)};
}

int log_resume(run_log *l, const tled_executor *b, tled_state *state, double time, const log_point *from, err *e)
{
    return account_resume(l->account, b, state, time, &from->past, e);
}

/* nan, where there is nothing to tell, is what plots leave out. */
static void put_number(out *to, double value)
{
    if (isfinite(value))
        out_format(to, "\t%.9g", value);
    else
        out_text(to, "\tnan");
}

/* inf is a share too: of strain energy that is none. */
static void put_share(out *to, double value)
{
    if (isinf(value))
        out_text(to, "\tinf");
    else
        put_number(to, value);
}

/* What the tissue pulls the bodies with. */
static int put_bodies(const run_log *l, err *e)
{
    const int32_t count = bodies_count(l->p);
    if (!count)
        return 0;
    body_load *load = mem_array(count, sizeof *load, "the log", e);
    const bodies_state now = account_bodies(l->account);
    const int failed =
        !load || bodies_loads(l->p, l->threads, &now, load, e) || sliding_loads(l->p, l->threads, &now, load, e) ? -1
                                                                                                                 : 0;
    for (int64_t i = 0; !failed && i < 6 * count; i++)
        put_number(l->rows, i / 3 % 2 ? load[i / 6].torque[i % 3] : load[i / 6].force[i % 3]);
    free(load);
    return failed;
}

/* In as many digits as it has, where a track may be read from the log. */
static void put_time(const run_log *l, double time)
{
    char text[NUM_TEXT];
    bool whole = false;
    for (int i = 0; i < l->keys->count; i++)
        whole |= is_of_muscles(l->keys->value[i]);
    num_text(time, false, text);
    if (whole)
        out_text(l->rows, text);
    else
        out_format(l->rows, "%.9g", time);
}

static void put_muscles(const run_log *l, bool levels, double time)
{
    char text[NUM_TEXT];
    for (int64_t i = 0; i < l->script->curves; i++) {
        if (l->script->curve[i].verb != SCRIPT_CONTRACT)
            continue;
        num_text(levels ? script_level_at(l->script, i, time) : account_curves(l->account)[3 * i], false, text);
        out_format(l->rows, "\t%s", text);
    }
}

static void put_energies(const run_log *l)
{
    for (int64_t i = 0; i < films_count(l->p); i++)
        l->bone[i] = films_bone(l->p, i, account_curves(l->account));
    results_energies(l->results, account_displacement(l->account), l->bone, l->energy);
    for (int64_t i = 0; i < model_count(l->m, "material"); i++)
        put_number(l->rows, l->energy[i]);
}

static void put_key(const run_log *l, int key, double time)
{
    const char *name = l->keys->value[key];
    const double *moved = account_displacement(l->account) + 3 * l->node[key];
    if (is_of_muscles(name))
        put_muscles(l, !strcmp(name, LOG_LEVEL), time);
    else if (is_of_materials(name))
        put_energies(l);
    else
        for (int a = 0; a < 3; a++)
            put_number(l->rows, moved[a]);
}

static int put_row(run_log *l, const log_row *row, const account_sums *s, err *e)
{
    const double took = clock_now() - l->began - l->own;
    const double rate = took > 0 && row->taken > l->steps ? (double)(row->taken - l->steps) / took : NAN;
    const double values[] = {row->dt,
                             row->stable,
                             s->kinetic,
                             s->tissue.strain,
                             s->tissue.hourglass,
                             s->gravity,
                             s->forces,
                             s->held,
                             s->muscles,
                             s->probe,
                             s->damping,
                             s->balance,
                             s->displacement,
                             s->speed,
                             s->acceleration,
                             row->remaining,
                             rate,
                             rate * (double)l->p->elements};
    put_time(l, row->time);
    out_format(l->rows, "\t%lld", (long long)row->step);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        put_number(l->rows, values[i]);
    for (int i = 0; i < l->keys->count; i++)
        put_key(l, i, row->time);
    if (put_bodies(l, e))
        return -1;
    if (account_has_muscles(l->p))
        out_format(l->rows, "\t%lld", (long long)s->falling);
    put_number(l->rows, s->tissue.quality.centre);
    put_number(l->rows, s->tissue.quality.corner);
    out_format(l->rows, "\t%lld", (long long)s->tissue.quality.folded);
    put_share(l->rows, quality_hourglass(s->tissue.hourglass, s->tissue.strain, s->tissue.scale));
    out_text(l->rows, "\n");
    l->steps = row->taken;
    l->own = 0;
    l->began = clock_now();
    return 0;
}

int log_read(run_log *l, const tled_executor *b, tled_state *state, const log_row *row, bool shown, err *e)
{
    double there;
    const account_sums *s = account_read(l->account, b, state, row->time, row->damping, &there, e);
    if (!s)
        return -1;
    l->own += clock_now() - there;
    if (shown && put_row(l, row, s, e))
        return -1;
    l->last = *row;
    l->unshown = shown ? NULL : s;
    l->is_pending = true;
    return out_failed(l->rows, e);
}

int log_save(run_log *l, err *e)
{
    const double from = clock_now();
    account_save(l->account);
    const int result = empty_rows(l, true, e);
    l->own += clock_now() - from;
    return result;
}

int log_restore(run_log *l, err *e)
{
    if (!l->is_pending)
        return 0;
    account_restore(l->account);
    return empty_rows(l, false, e);
}

int log_end(run_log *l, err *e)
{
    if (l->unshown && put_row(l, &l->last, l->unshown, e))
        return -1;
    l->unshown = NULL;
    return empty_rows(l, true, e);
}

int log_close(run_log *l, err *e)
{
    account_destroy(l->account);
    results_destroy(l->results);
    free(l->energy);
    free(l->bone);
    l->results = NULL;
    l->energy = NULL;
    l->bone = NULL;
    out_discard(l->rows);
    l->account = NULL;
    l->rows = NULL;
    growing *file = l->file;
    l->file = NULL;
    return growing_close(file, e);
}
