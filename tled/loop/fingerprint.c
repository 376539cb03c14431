#include "tled/loop/fingerprint.h"

#include "base/chars.h"
#include "base/checksum.h"
#include "base/mem.h"
#include "cli/tool.h"
#include "model/binary.h"
#include "model/hourglass_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void fingerprint_free(fingerprint *f)
{
    for (int64_t i = 0; i < f->parts; i++)
        free(f->part[i].name);
    free(f->part);
    free(f->options);
    *f = (fingerprint){0};
}

static int add(fingerprint *f, const char *kind, const char *name, uint32_t crc, err *e)
{
    char text[MODEL_NAME + 40];
    snprintf(text, sizeof text, "%s%s%s", kind, *name ? " " : "", name);
    if (MEM_ROOM(&f->part, &f->room, f->parts + 1, "checksums", e))
        return -1;
    f->part[f->parts] = (fingerprint_part){mem_text(text, e), crc};
    if (!f->part[f->parts].name)
        return -1;
    f->parts++;
    return 0;
}

/* Not compared: they are --hourglass of the run that wrote the frames, and this run's is. */
static bool is_control(const char *key)
{
    return !strcmp(key, "hourglass.control") || !strcmp(key, "hourglass.kappa");
}

static int add_model(fingerprint *f, const model *m, err *e)
{
    for (int i = 0; i < m->metas; i++)
        if (!is_control(m->meta[i].key) &&
            add(f, "meta", m->meta[i].key, checksum_add(0, m->meta[i].value, strlen(m->meta[i].value)), e))
            return -1;
    for (int i = 0; i < m->arrays.count; i++) {
        const item it = {.kind = ITEM_ARRAY, .array = m->arrays.v[i]};
        if (add(f, "array", it.array.name, binary_crc(&it), e))
            return -1;
    }
    return 0;
}

static int add_number(fingerprint *f, const char *name, double value, err *e)
{
    return add(f, name, "", checksum_add(0, &value, sizeof value), e);
}

static int add_control(fingerprint *f, hourglass_control control, err *e)
{
    char text[HOURGLASS_TEXT];
    hourglass_text(control, text);
    return add(f, "--hourglass", "", checksum_add(0, text, strlen(text)), e);
}

static int add_numbers(fingerprint *f, const fingerprint_run *run, err *e)
{
    const run_setup *r = run->setup;
    return (isfinite(r->end) && add_number(f, "--time to its end", r->end, e)) ||
                   add_number(f, "--every", r->every, e) || add_number(f, "--dt", r->rate, e) ||
                   add_number(f, "--damping", r->damping, e) || add_number(f, "--rest", r->rest, e) ||
                   add_number(f, "--time", (double)r->steps, e) || add_control(f, run->p->control, e) ||
                   (run->p->sliding && add_number(f, "--friction", run->p->sliding->ground.friction, e)) ||
                   (!run->p->sliding && run->p->self_contact &&
                    add_number(f, "--friction", run->p->self_contact->friction, e)) ||
                   (run->p->collider && add_number(f, "--repulsion", run->p->collider->stiffness, e))
               ? -1
               : 0;
}

static uint32_t crc_script(const script *s)
{
    uint32_t crc = 0;
    for (int64_t i = 0; i < s->curves; i++) {
        const script_curve *c = &s->curve[i];
        const int64_t what[] = {c->verb, c->volume, c->mask, c->key_count, c->node_count};
        crc = checksum_add(crc, what, sizeof what);
        crc = checksum_add(crc, s->time + c->key_first, (size_t)c->key_count * sizeof *s->time);
        crc = checksum_add(crc, s->value + 3 * c->key_first, (size_t)c->key_count * 3 * sizeof *s->value);
        if (c->node_count)
            crc = checksum_add(crc, s->node + c->node_first, (size_t)c->node_count * sizeof *s->node);
        if (c->triangle_count)
            crc = checksum_add(crc, s->corner + 3 * (int64_t)c->triangle_first,
                               3 * (size_t)c->triangle_count * sizeof *s->corner);
        if (c->verb == SCRIPT_PULL)
            crc = checksum_add(crc, &c->stiffness, sizeof c->stiffness);
        if (c->surface)
            crc = checksum_add(crc, c->surface, strlen(c->surface));
        if (c->is_smooth)
            crc = checksum_add(crc, "smooth", sizeof "smooth");
    }
    for (int64_t i = 0; i < s->terms; i++) {
        const script_term *t = &s->term[i];
        const int64_t what[] = {t->contract, t->express};
        crc = checksum_add(crc, what, sizeof what);
        crc = checksum_add(crc, &t->factor, sizeof t->factor);
    }
    if (s->times.rise > 0)
        crc = checksum_add(crc, &s->times, sizeof s->times);
    return crc;
}

static uint32_t crc_shape(const probe *p)
{
    const double size[] = {p->kind, p->radius, p->width, p->angle, p->thickness, p->edge};
    uint32_t crc = checksum_add(0, size, sizeof size);
    crc = checksum_add(crc, p->plane, (size_t)p->planes * 4 * sizeof *p->plane);
    return checksum_add(crc, p->corner, (size_t)p->corners * 3 * sizeof *p->corner);
}

static uint32_t crc_poses(const collider *c)
{
    uint32_t crc = checksum_add(0, c->time, (size_t)c->poses * sizeof *c->time);
    return checksum_add(crc, c->list, (size_t)c->poses * sizeof *c->list);
}

static uint32_t crc_start(const tled_problem *p, int64_t next_frame)
{
    const uint32_t crc = checksum_add(0, &next_frame, sizeof next_frame);
    return fields_crc(&p->fields, &p->at_start, checksum_add(crc, &p->start, sizeof p->start));
}

int fingerprint_make(fingerprint *f, const fingerprint_run *run, err *e)
{
    const tled_problem *p = run->p;
    const collider *c = p->collider;
    const size_t size = sizeof SINEW_VERSION + strlen(run->options) + 1;
    f->options = mem_array((int64_t)size, 1, "options", e);
    if (!f->options)
        return -1;
    snprintf(f->options, size, "%s %s", SINEW_VERSION, run->options);
    chars_mend(f->options);
    return add_numbers(f, run, e) || add_model(f, run->m, e) || add(f, "script", "", crc_script(p->script), e) ||
                   (c && (add(f, "probe", "", crc_shape(&c->shape), e) || add(f, "poses", "", crc_poses(c), e))) ||
                   add(f, "start", "", crc_start(p, run->next_frame), e)
               ? -1
               : 0;
}

/* ---- in a model, and from one */

static const char options_key[] = "checkpoint.options", part_name[] = "checkpoint.part", crc_name[] = "checkpoint.crc";

int fingerprint_put(const fingerprint *f, model *to, err *e)
{
    if (model_meta_set(to, options_key, f->options, e) || model_axis_add(to, part_name, f->parts, e))
        return -1;
    model_array *name = model_add_as(to, part_name, MODEL_STR, "1", part_name, 1, e);
    for (int64_t i = 0; name && i < f->parts; i++)
        if (model_set_text(name, i, f->part[i].name, e))
            return -1;
    const model_array *sum = name ? model_add_as(to, crc_name, MODEL_I64, "1", part_name, 1, e) : NULL;
    for (int64_t i = 0; sum && i < f->parts; i++)
        sum->i64[i] = f->part[i].crc;
    return sum ? 0 : -1;
}

/* Where an option begins, or what ran. */
static bool begins(const char *word)
{
    return *word == '[' || (*word == '-' && (word[1] == '-' || (word[1] >= 'A' && word[1] <= 'z')));
}

/* The first option in which two texts differ: its place in each, and how long it is up to the word that does. */
static void find_option(const char *text[2], int size[2])
{
    size_t at = 0, begin = 0;
    for (; text[0][at] && text[0][at] == text[1][at]; at++)
        if (begins(text[0] + at) && begins(text[1] + at) && at && text[0][at - 1] == ' ')
            begin = at;
    bool ends = strchr(" ", text[0][at]) && strchr(" ", text[1][at]); /* one has a word more */
    for (int i = 0; i < 2; i++) {
        size_t from = ends ? at + (text[i][at] == ' ') : begin, differs = ends ? from : at;
        size[i] = (int)(differs - from + strcspn(text[i] + differs, " "));
        text[i] += from;
    }
}

static int compare_options(const char *there, const char *here, const char *place, err *e)
{
    const char *text[] = {there, here};
    int size[2];
    if (!strcmp(there, here))
        return 0;
    const int version = (int)strcspn(there, " "), ours = (int)strcspn(here, " ");
    if (version != ours || strncmp(there, here, (size_t)ours) != 0)
        return err_set(e, place, 0,
                       "was written by version %.*s, and this is version %.*s; expected a checkpoint of this version: "
                       "continue with that version, or begin the run anew",
                       version, there, ours, here);
    find_option(text, size);
    return err_set(e, place, 0, "was saved by a run with other options, '%.*s'; expected '%.*s'", size[0], text[0],
                   size[1], text[1]);
}

static bool has(char *const *name, int64_t names, const char *wanted)
{
    for (int64_t i = 0; i < names; i++)
        if (!strcmp(name[i], wanted))
            return true;
    return false;
}

static const fingerprint_part *find_part(const fingerprint *f, const char *name)
{
    for (int64_t i = 0; i < f->parts; i++)
        if (!strcmp(f->part[i].name, name))
            return &f->part[i];
    return NULL;
}

static int differ(const char *place, const char *name, const char *how, err *e)
{
    return err_set(e, place, 0,
                   "belongs to another run: %s %s; expected the command that made it, with the same model and files",
                   name, how);
}

int fingerprint_compare(const fingerprint *f, const model *from, const char *place, err *e)
{
    const char *there = model_meta_of(from, options_key);
    const model_array *name = model_find(from, part_name), *sum = model_find(from, crc_name);
    if (!there || !name || name->type != MODEL_STR || name->columns != 1 || !sum || sum->type != MODEL_I64 ||
        sum->columns != 1 || sum->rows != name->rows)
        return err_set(e, place, 0, "is not a checkpoint; expected one that tled-run wrote");
    if (compare_options(there, f->options, place, e))
        return -1;
    for (int64_t i = 0; i < name->rows; i++) {
        const fingerprint_part *here = find_part(f, name->str[i]);
        if (!here || here->crc != sum->i64[i])
            return differ(place, name->str[i], here ? "differs" : "is missing now", e);
    }
    for (int64_t i = 0; i < f->parts; i++)
        if (!has(name->str, name->rows, f->part[i].name))
            return differ(place, f->part[i].name, "is new", e);
    return 0;
}
