#include "results/frame_choice.h"

#include "base/mem.h"
#include "mesh/bone.h"
#include "model/known.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SURFACE_CHUNK = 1024, PATTERNS = 4, LIST = 600 /* bytes of what a message lists */ };

/* Words for arrays: their names; `*` at the end of one for any rest, at its beginning for any surface. */
static const struct {
    const char *word, *pattern[PATTERNS + 1];
} words[] = {
    {"displacement", {"node.displacement"}},
    {"velocity", {"node.velocity"}},
    {"surfaces", {"*/vertex.displacement", "*/vertex.normal"}},
    {"bodies", {"body.*"}},
    {"forces", {"body.force", "body.torque", "probe.force", "probe.torque"}},
    {"probe", {"probe.*"}},
};

enum { WORDS = sizeof words / sizeof *words };

/* A bound surface whose displacement frames get. */
struct frame_surface {
    char array[MODEL_NAME];
    bound b;
    motion moves;
    bone carried;
    double *to; /* vertices x 3, m: of the frame being filled */
};

/* ---- what is offered */

static frame_array *find(const frame_choice *c, const char *name)
{
    for (int64_t i = 0; i < c->arrays; i++)
        if (!strcmp(c->array[i].name, name))
            return &c->array[i];
    return NULL;
}

int frame_choice_offer(frame_choice *c, const char *name, int flags, err *e)
{
    frame_array *had = find(c, name);
    if (had) {
        had->flags |= flags & FRAME_CHOICE_ALWAYS;
        return 0;
    }
    if (mem_grow(&c->array, &c->capacity, c->arrays + 1, sizeof *c->array, "the frames", e))
        return -1;
    frame_array *to = &c->array[c->arrays++];
    *to = (frame_array){.flags = flags};
    snprintf(to->name, sizeof to->name, "%s", name);
    return 0;
}

static void array_of(const char *name, char to[MODEL_NAME])
{
    snprintf(to, MODEL_NAME, "%.*s/vertex.displacement", SURFACE_NAME_MOST, name);
}

int frame_choice_offer_bound(frame_choice *c, const model *m, err *e)
{
    char name[MODEL_NAME], array[MODEL_NAME];
    for (int at = 0; model_surface(m, &at, name, sizeof name);) {
        array_of(name, array);
        if (surface_part(m, name, "vertex.element") && frame_choice_offer(c, array, FRAME_CHOICE_LISTED, e))
            return -1;
    }
    return 0;
}

/* ---- the list */

static bool fits(const char *name, const char *pattern)
{
    const size_t n = strlen(name), p = strlen(pattern);
    if (pattern[0] == '*')
        return n >= p && !strcmp(name + n - (p - 1), pattern + 1);
    if (pattern[p - 1] == '*')
        return !strncmp(name, pattern, p - 1);
    return !strcmp(name, pattern);
}

static bool is_of_word(const char *name, int word)
{
    for (int i = 0; words[word].pattern[i]; i++)
        if (fits(name, words[word].pattern[i]))
            return true;
    return false;
}

static bool is_meant(const char *name, const char *item)
{
    for (int w = 0; w < WORDS; w++)
        if (!strcmp(item, words[w].word))
            return is_of_word(name, w);
    return !strcmp(name, item);
}

static void list_one(char to[LIST], const char *name)
{
    const size_t n = strlen(to);
    if (n + strlen(name) + 8 < LIST)
        snprintf(to + n, LIST - n, "%s%s", n ? ", " : "", name);
}

static bool is_named(const frame_array *a)
{
    return !(a->flags & FRAME_CHOICE_EMPTY);
}

/* Lists what --frames can name: first the words that stand for arrays here, then the arrays. */
static void list_offered(const frame_choice *c, char to[LIST])
{
    to[0] = 0;
    for (int w = 0; w < WORDS; w++)
        for (int64_t i = 0; i < c->arrays; i++)
            if (is_named(&c->array[i]) && is_of_word(c->array[i].name, w)) {
                list_one(to, words[w].word);
                break;
            }
    for (int64_t i = 0; i < c->arrays; i++)
        if (is_named(&c->array[i]))
            list_one(to, c->array[i].name);
}

static int unknown(const frame_choice *c, const char *item, err *e)
{
    char there[LIST];
    list_offered(c, there);
    return err_option(e, "--frames",
                      "'%.80s': frames of this run have no such array; expected some of %s; each may have :f32 or :f64",
                      item, there);
}

static int choose(frame_array *a, const char *type, err *e)
{
    const known *k = known_find(a->name);
    const bool narrow = !strcmp(type, "f32"), is_double = !k || k->type == MODEL_F64;
    if (!is_double && !strcmp(type, "f64"))
        return err_usage(e, "--frames %s:f64: it is computed as f32; expected it without :f64", a->name);
    if (a->listed && a->narrow != (narrow && is_double))
        return err_usage(e, "--frames: %s is listed as f32 and as f64; expected one of them", a->name);
    a->wanted = a->listed = true;
    a->narrow = narrow && is_double;
    return 0;
}

/* One NAME[:TYPE], which is cut. */
static int read_item(frame_choice *c, char *item, err *e)
{
    char *colon = strrchr(item, ':');
    bool any = false;
    const char *type = colon ? colon + 1 : "";
    if (colon && strcmp(type, "f32") != 0 && strcmp(type, "f64") != 0)
        return err_usage(e, "--frames '%.80s': type '%.20s'; expected f32 or f64", item, type);
    if (colon)
        *colon = 0;
    for (int64_t i = 0; i < c->arrays; i++) {
        if (!is_meant(c->array[i].name, item))
            continue;
        any = true;
        if (!is_named(&c->array[i]))
            return err_option(e, "--frames", "'%.80s': %s says nothing here; expected %s", item, c->array[i].name,
                              c->empty);
        if (choose(&c->array[i], type, e))
            return -1;
    }
    return any ? 0 : unknown(c, item, e);
}

/* One value of the option: items between commas. */
static int read_value(frame_choice *c, const char *value, err *e)
{
    char *copy = mem_text(value, e), *at = copy;
    int failed = copy ? 0 : -1;
    while (!failed && at) {
        char *comma = strchr(at, ',');
        if (comma)
            *comma = 0;
        failed = read_item(c, at, e);
        at = comma ? comma + 1 : NULL;
    }
    free(copy);
    return failed;
}

int frame_choice_read(frame_choice *c, const opt_list *list, err *e)
{
    c->is_given = list->count > 0;
    for (int64_t i = 0; i < c->arrays; i++)
        c->array[i].wanted =
            c->is_given ? (c->array[i].flags & FRAME_CHOICE_ALWAYS) != 0 : !(c->array[i].flags & FRAME_CHOICE_LISTED);
    for (int i = 0; i < list->count; i++)
        if (read_value(c, list->value[i], e))
            return -1;
    return 0;
}

bool frame_choice_has(const frame_choice *c, const char *name)
{
    const frame_array *a = find(c, name);
    return a && a->wanted;
}

bool frame_choice_narrow(const frame_choice *c, const char *name)
{
    const frame_array *a = find(c, name);
    return a && a->wanted && a->narrow;
}

bool frame_choice_has_of(const frame_choice *c, const char *beginning)
{
    for (int64_t i = 0; i < c->arrays; i++)
        if (c->array[i].wanted && !strncmp(c->array[i].name, beginning, strlen(beginning)))
            return true;
    return false;
}

/* ---- bound surfaces */

static bool is_bound(const frame_array *a)
{
    return a->wanted && a->flags & FRAME_CHOICE_LISTED;
}

bool frame_choice_moves(const frame_choice *c)
{
    for (int64_t i = 0; i < c->arrays; i++)
        if (is_bound(&c->array[i]))
            return true;
    return false;
}

static int open_surface(struct frame_surface *s, const model *m, const char *array, err *e)
{
    char name[MODEL_NAME];
    snprintf(name, sizeof name, "%.*s", (int)(strrchr(array, '/') - array), array);
    snprintf(s->array, sizeof s->array, "%s", array);
    return bound_of(&s->b, m, name, e) < 0 || bone_find(&s->carried, &s->b, m, e) ||
                   motion_open(&s->moves, &s->b, model_count(m, "node"), model_count(m, "element"), e)
               ? -1
               : 0;
}

int frame_choice_open(frame_choice *c, const model *m, err *e)
{
    int64_t count = 0;
    for (int64_t i = 0; i < c->arrays; i++)
        count += is_bound(&c->array[i]);
    c->surface = count ? mem_array(count, sizeof *c->surface, "the surfaces", e) : NULL;
    if (count && !c->surface)
        return -1;
    for (int64_t i = 0; i < c->arrays; i++)
        if (is_bound(&c->array[i]) && open_surface(&c->surface[c->surfaces++], m, c->array[i].name, e))
            return -1;
    return 0;
}

static void move_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const struct frame_surface *s = context;
    (void)chunk;
    for (int64_t v = from; v < to; v++)
        bone_displacement(&s->carried, &s->moves, v, s->to + 3 * v);
}

/* The nodes of an element. */
static void mark_element(const bound *b, int64_t element, uint8_t *node)
{
    for (int c = 0; c < b->corners; c++)
        node[b->node[b->corners * element + c]] = 1;
}

void frame_choice_mark(const frame_choice *c, uint8_t *node)
{
    for (int64_t i = 0; i < c->surfaces; i++) {
        const struct frame_surface *s = &c->surface[i];
        for (int64_t v = 0; v < s->b.shape.vertices; v++) {
            mark_element(&s->b, s->b.element[v], node);
            if (s->carried.node[v] >= 0)
                node[s->carried.node[v]] = 1;
        }
        for (int64_t k = 0; k < s->moves.entries; k++)
            mark_element(&s->b, s->moves.element[k], node);
    }
}

int frame_choice_add_surfaces(const frame_choice *c, frame *f, const model *m, const double *displacement,
                              pool *threads, err *e)
{
    for (int64_t i = 0; i < c->surfaces; i++) {
        struct frame_surface *s = &c->surface[i];
        model_array *there = frame_find(f, s->array); /* of an earlier frame, whose memory this one takes */
        const model_array *a = there ? there : frame_add(f, m, s->array, e);
        if (!a)
            return -1;
        s->to = a->f64;
        motion_set(&s->moves, displacement, threads);
        bone_set(&s->carried, f);
        pool_run(threads, a->rows, SURFACE_CHUNK, move_work, s);
    }
    return 0;
}

/* ---- a frame */

static bool is_dropped(const model_array *a, const void *context)
{
    const frame_array *had = find(context, a->name);
    return had && !had->wanted;
}

void frame_choice_take(const frame_choice *c, frame *f)
{
    if (c->is_given)
        frame_remove_all(f, is_dropped, c);
    for (int i = 0; i < f->arrays.count && (c->is_given || c->follows); i++) {
        const frame_array *is = find(c, f->arrays.v[i].name);
        f->arrays.v[i].narrow = is && is->narrow && f->arrays.v[i].type == MODEL_F64;
    }
}

/* ---- frames behind others */

/* Lists the arrays of a frame, as --frames names them. */
static void list_had(const frame *f, char to[LIST])
{
    char item[MODEL_NAME + 4];
    to[0] = 0;
    for (int i = 0; i < f->arrays.count; i++) {
        const model_array *a = &f->arrays.v[i];
        snprintf(item, sizeof item, "%s%s", a->name, a->narrow ? ":f32" : "");
        list_one(to, item);
    }
}

static int differs(const frame_choice *c, const frame *before, const char *name, bool had, const char *where, err *e)
{
    char all[LIST];
    list_had(before, all);
    return err_set(e, where, 0, "its frames have %s%s, and those to come have %s; expected %s%s", had ? "" : "no ",
                   name, had ? "not" : "it", c->is_given ? "the same --frames: " : "--frames ", all);
}

/* An array that is not offered cannot be in a frame to come. */
static int follow_old(const frame_choice *c, const frame *before, const char *where, err *e)
{
    for (int i = 0; i < before->arrays.count; i++) {
        const char *name = before->arrays.v[i].name;
        if (!find(c, name))
            return err_set(e, where, 0,
                           "its frames have %s, which frames of this run cannot have; expected a model without frames, "
                           "or the options that they were made with",
                           name);
    }
    return 0;
}

static int follow_type(const frame_choice *c, frame_array *is, const model_array *had, const char *where, err *e)
{
    if (c->is_given && is->narrow != had->narrow)
        return err_set(e, where, 0, "its frames have %s as %s, and those to come as %s; expected the same --frames",
                       is->name, had->narrow ? "f32" : "f64", is->narrow ? "f32" : "f64");
    is->narrow = had->narrow;
    return 0;
}

int frame_choice_follow(frame_choice *c, const frame *before, const char *where, err *e)
{
    if (follow_old(c, before, where, e))
        return -1;
    for (int64_t i = 0; i < c->arrays; i++) {
        frame_array *is = &c->array[i];
        const model_array *had = frame_find(before, is->name);
        if (!had != !is->wanted && !(is->flags & FRAME_CHOICE_PERHAPS))
            return differs(c, before, is->name, had != NULL, where, e);
        if (had && follow_type(c, is, had, where, e))
            return -1;
    }
    c->follows = true;
    return 0;
}

void frame_choice_free(frame_choice *c)
{
    for (int64_t i = 0; i < c->surfaces; i++) {
        bone_free(&c->surface[i].carried);
        motion_free(&c->surface[i].moves);
    }
    free(c->surface);
    free(c->array);
    *c = (frame_choice){0};
}
