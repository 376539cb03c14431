#include "voxelise/summary.h"

#include "base/mem.h"
#include "cli/listing.h"
#include "voxelise/report.h"

#include <math.h>
#include <stdlib.h>

/* Voxels of a volume, or samples of voxels. */
typedef struct lost {
    int64_t outside; /* of the volume of the level below */
    int64_t taken;   /* by other volumes; samples: or in a voxel that is no element */
    double kept;     /* %; nan: nothing is inside, as of a layer */
} lost;

static int64_t samples_of(const summary *s)
{
    return s->samples * s->samples * s->samples;
}

/* How many samples each volume has in the end: the caller frees them. */
static double *find_owned(const summary *s, err *e)
{
    const voxels *x = s->x;
    double *owned = mem_array(s->plan->volumes, sizeof *owned, "volumes", e);
    int64_t i = 0;
    for (int64_t r = 0; owned && r < x->runs; r++)
        for (int64_t end = i + x->run[r].to - x->run[r].from; i < end; i++) {
            const double whole = (double)samples_of(s) * (x->fraction ? (double)x->fraction[i] : 1);
            const int32_t other = x->mix ? x->mix[i] : -1;
            const double second = other >= 0 ? (double)x->mixture[i] : 0;
            owned[x->run[r].volume] += whole * (1 - second);
            if (other >= 0)
                owned[other] += whole * second;
        }
    return owned;
}

static lost find_lost(const summary *s, const double *owned, int32_t v)
{
    const climb_count *n = &s->x->count[v];
    const int64_t kept = s->x->fraction ? llround(owned[v]) : n->kept;
    lost l = {.outside = n->inside - n->reached, .taken = n->reached > kept ? n->reached - kept : 0, .kept = NAN};
    if (n->inside)
        l.kept = 100 * (double)(n->reached - l.taken) / (double)n->inside;
    return l;
}

/* Whether a muscle keeps at most half of its voxels, or has none at all (kept is nan). */
static bool keeps_half(const summary *s, int32_t v, const lost *l)
{
    return s->plan->volume[v].muscle && !(l->kept > 50);
}

static void add_row(const summary *s, int32_t v, const lost *l, bool mixes, text_table *t)
{
    const volumes_volume *a = &s->plan->volume[v];
    const climb_count *n = &s->x->count[v];
    text_table_cell(t, "%s", a->name);
    text_table_count(t, a->level);
    if (s->verbose)
        text_table_count(t, a->priority);
    text_table_cell(t, "%s", s->material[a->material]);
    text_table_count(t, n->kept);
    if (mixes)
        text_table_count(t, n->mixed);
    text_table_number(t, isnan(l->kept) ? NAN : (double)l->outside, 0);
    text_table_number(t, isnan(l->kept) ? NAN : (double)l->taken, 0);
    /* Rounded down: 100 % is all of it. */
    text_table_number(t, floor(l->kept), 0);
    text_table_cell(t, "%s", keeps_half(s, v, l) ? "!" : "");
    if (s->verbose)
        text_table_cell(t, "%s", a->surfaces);
}

enum { HEADS = 12 };

/* The headings: by centres or samples, with the second volumes of elements where there are any, and with -v. */
static void find_heads(const summary *s, const char *head[HEADS])
{
    const bool samples = s->x->fraction != NULL;
    int n = 0;
    head[n++] = "<volume";
    head[n++] = ">level";
    if (s->verbose)
        head[n++] = ">priority";
    head[n++] = "<material";
    head[n++] = ">elements";
    if (s->x->mix)
        head[n++] = ">second\nin";
    head[n++] = samples ? ">samples\noutside" : ">voxels\noutside";
    head[n++] = samples ? ">samples\nto others" : ">voxels\nto others";
    head[n++] = ">kept\n%";
    head[n++] = "<";
    if (s->verbose)
        head[n++] = "<surfaces";
    head[n] = NULL;
}

text_table *summary_table(const summary *s, err *e)
{
    const char *head[HEADS];
    find_heads(s, head);
    double *owned = find_owned(s, e);
    text_table *t = owned ? text_table_create(head, e) : NULL;
    for (int32_t v = 0; t && v < s->plan->volumes; v++) {
        const lost l = find_lost(s, owned, v);
        add_row(s, v, &l, s->x->mix != NULL, t);
    }
    free(owned);
    return t;
}

double summary_enclosed(const voxels *x)
{
    double sum = 0;
    for (int64_t i = 0; i < x->elements; i++)
        sum += (double)x->fraction[i];
    return sum;
}

/* ---- warnings */

/* Warns of what is wrong with one volume alone. Whether something is. */
static bool warn_of(const summary *s, int32_t v, notes *warnings)
{
    const volumes_volume *a = &s->plan->volume[v];
    const climb_count *n = &s->x->count[v];
    const int64_t layer = layers_at(s->layer, s->plan, v);
    const char *counted = s->x->fraction ? "sample" : "voxel";
    if (layer >= 0 && s->x->fraction)
        return report_layer_share(warnings, s->layer, layer, n, s->laminates, s->samples, s->g, s->unit);
    if (layer >= 0 && layers_is_thin(s->layer, layer, s->g))
        report_layer(warnings, s->layer, layer, v, s->x, s->g, s->unit);
    else if (n->inside == 0)
        notes_add(warnings,
                  "%s has no voxel: no centre is inside it (it is thinner than a voxel, or off the lattice%s)", a->name,
                  s->boxed ? " or the --box" : "");
    else if (n->reached == 0)
        notes_add(warnings, "%s is ignored: all of it is outside the volumes of level %d (%lld %s%s)", a->name,
                  a->level - 1, (long long)n->inside, counted, n->inside == 1 ? "" : "s");
    else if (n->kept == 0 && n->mixed == 0)
        notes_add(warnings, "%s has no voxel: other volumes take all of it (%lld %s%s)", a->name, (long long)n->reached,
                  counted, n->reached == 1 ? "" : "s");
    else
        return false;
    return true;
}

int summary_warn(const summary *s, notes *warnings, err *e)
{
    listing half = {0};
    double *owned = find_owned(s, e);
    if (!owned)
        return -1;
    for (int32_t v = 0; v < s->plan->volumes; v++) {
        const lost l = find_lost(s, owned, v);
        if (!warn_of(s, v, warnings) && keeps_half(s, v, &l))
            listing_add(&half, "%s (%.0f %%)", s->plan->volume[v].name, floor(l.kept));
    }
    free(owned);
    if (half.count)
        notes_add(warnings,
                  "%lld %s at most half of %s voxels, the rest being outside of the level below or in other volumes: "
                  "%s; move the surfaces inward, use smaller voxels (-s), or set priorities (--volumes)",
                  (long long)half.count, half.count == 1 ? "muscle keeps" : "muscles keep",
                  half.count == 1 ? "its" : "their", listing_text(&half));
    return 0;
}
