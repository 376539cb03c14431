#include "inspect/info_quality.h"

#include "inspect/info_stats.h"
#include "mesh/element_place.h"
#include "results/energy.h"

#include <inttypes.h>
#include <string.h>

enum { CENTRE, CORNER, FOLDED, ELEMENT, PLACE, HOURGLASS, KEYS = INFO_QUALITY_KEYS };

const char *const info_quality_keys[KEYS] = {"quality.j.centre", "quality.j.corner", "quality.folded",
                                             "quality.element",  "quality.place",    "quality.hourglass"};

static int which(const char *key)
{
    int i = 0;
    while (i < KEYS && strcmp(key, info_quality_keys[i]) != 0)
        i++;
    return i;
}

const char *info_quality_unit(const char *key)
{
    const int i = which(key);
    if (i == KEYS)
        return NULL;
    return i == PLACE ? "m" : "";
}

/* .node NULL: there are no elements. */
static quality_mesh mesh_of(const source *s)
{
    const model_array *node = model_find(&s->body, "element.node"), *rest = model_find(&s->body, "node.position");
    return node && rest ? (quality_mesh){node->i32, node->columns, node->rows, rest->f64, NULL} : (quality_mesh){0};
}

bool info_quality_look(const source *s, quality *to)
{
    const quality_mesh m = mesh_of(s);
    const model_array *u = s->frames ? frame_find(&s->frame, "node.displacement") : NULL;
    if (!m.node || (s->frames && !u))
        return false;
    *to = quality_look(&m, u ? u->f64 : NULL, 0, m.elements);
    return true;
}

static int no_value(const source *s, const char *key, const char *why, err *e)
{
    return err_set(e, source_name(s), 0, "no key '%.80s': %s", key, why);
}

/* The share in the last frame. */
static int put_hourglass(const source *s, const char *key, out *to, err *e)
{
    energy of;
    err why = {0};
    if (!s->frames)
        return no_value(s, key, "the model has no frames; they come from tled-run", e);
    if (energy_of(&of, &s->body, &s->frame, &why))
        return no_value(s, key, why.text, e);
    info_put_number(quality_hourglass(of.hourglass, of.strain, of.scale), MODEL_F64, to);
    return 0;
}

/* What is wrong with a model that has no J. */
static int no_quality(const source *s, const char *key, err *e)
{
    const model_array *node = model_find(&s->body, "element.node");
    if (!node || !model_find(&s->body, "node.position"))
        return no_value(s, key, "the model has no elements; they come from voxelise, msds-mesh or sinew import", e);
    return no_value(s, key, "the last frame has no node.displacement; it comes from tled-run or msds-run", e);
}

static bool look_once(const source *s, info_quality_seen *seen)
{
    if (seen->looks != s->frames + 1) {
        seen->looks = s->frames + 1;
        seen->is_known = info_quality_look(s, &seen->of);
    }
    return seen->is_known;
}

static void put_place(const source *s, int64_t element, out *to)
{
    double place[3];
    element_place(&s->body, element, place);
    for (int a = 0; a < 3; a++) {
        out_text(to, a ? " " : "");
        info_put_number(place[a], MODEL_F64, to);
    }
}

int info_quality(const source *s, info_quality_seen *seen, const char *key, out *to, err *e)
{
    const int i = which(key);
    const quality *q = &seen->of;
    if (i == KEYS)
        return 1;
    if (i == HOURGLASS)
        return put_hourglass(s, key, to, e);
    if (!look_once(s, seen))
        return no_quality(s, key, e);
    if ((i == ELEMENT || i == PLACE) && q->element < 0)
        return no_value(s, key, "the model has no elements", e);
    if (i == CENTRE || i == CORNER)
        info_put_number(i == CENTRE ? q->centre : q->corner, MODEL_F64, to);
    if (i == FOLDED || i == ELEMENT)
        out_format(to, "%" PRId64, i == FOLDED ? q->folded : q->element);
    if (i == PLACE)
        put_place(s, q->element, to);
    return 0;
}
