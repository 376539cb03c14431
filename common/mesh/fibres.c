#include "mesh/fibres.h"

#include "base/mem.h"
#include "model/materials.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of a volume that needs directions: its elements, those that it is the second of among them. */
typedef struct tally {
    int64_t all, lost, flat; /* lost: without a direction; flat: with one, but no normal that is not along it */
} tally;

static double length_of(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static void take(const float *array, int64_t element, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = array ? (double)array[3 * element + i] : 0;
}

/* Two families at an angle to the fibre: along cos a f +- sin a b, b across f and the normal. False: there is no such
 * plane. */
static bool spread(const float *normal, int64_t element, double angle, const double f[3], double family[2][3])
{
    double n[3], b[3];
    take(normal, element, n);
    for (int i = 0; i < 3; i++)
        b[i] = n[(i + 1) % 3] * f[(i + 2) % 3] - n[(i + 2) % 3] * f[(i + 1) % 3];
    const double across = length_of(b);
    if (!(across > 1e-3))
        return false;
    for (int i = 0; i < 3; i++) {
        family[0][i] = cos(angle) * f[i] + sin(angle) * b[i] / across;
        family[1][i] = cos(angle) * f[i] - sin(angle) * b[i] / across;
    }
    return true;
}

/* Fills the directions of a volume's fibres in an element; false: it has none, or not those of its families. */
static bool point(const fibres_view *f, int64_t element, const float *along, fibre_local *to)
{
    take(along, element, to->along);
    memset(to->family, 0, sizeof to->family);
    if (!(length_of(to->along) > 0))
        return false;
    if (to->of.angle > 0)
        return spread(f->normal, element, to->of.angle, to->along, to->family);
    memcpy(to->family[0], to->along, sizeof to->along);
    return true;
}

int fibres_at(const fibres_view *f, int64_t element, fibre_local to[2])
{
    const int32_t second = f->mix ? f->mix[element] : -1, volume[2] = {f->volume[element], second};
    const float *const along[2] = {f->along, f->mixalong};
    const double mixture = second < 0 ? 0 : (double)f->mixture[element];
    int count = 0;
    for (int i = 0; i < 2; i++)
        if (fibres_any(f, volume[i])) {
            to[count] = (fibre_local){.of = f->of[volume[i]], .share = i ? mixture : 1 - mixture, .is_second = i};
            point(f, element, along[i], &to[count++]);
        }
    return count;
}

static void count_element(const fibres_view *f, int64_t element, int32_t volume, const float *along, tally *to)
{
    if (!fibres_any(f, volume))
        return;
    fibre_local l = {.of = f->of[volume]};
    const bool pointed = point(f, element, along, &l), lost = !(length_of(l.along) > 0);
    to[volume].all++;
    to[volume].lost += lost;
    to[volume].flat += !pointed && !lost;
}

/* tally: volumes, zeroed. */
static void count_all(const fibres_view *f, int64_t elements, tally *to)
{
    for (int64_t i = 0; i < elements; i++) {
        count_element(f, i, f->volume[i], f->along, to);
        if (f->mix && f->mix[i] >= 0)
            count_element(f, i, f->mix[i], f->mixalong, to);
    }
}

static int check_volume(const fibres_view *f, const char *name, int32_t volume, const tally *t, err *e)
{
    if (!fibres_any(f, volume) || !t->all)
        return 0;
    const char *what = f->of[volume].c > 0 ? "the law fung" : "fibres that resist being stretched";
    if (!f->along)
        return err_set(e, NULL, 0,
                       "volume '%s' has %s, but the model has no element.fibre; "
                       "expected directions, as attach makes them (--fibre, --fibre-lines)",
                       name, what);
    if (t->lost == t->all)
        return err_set(e, NULL, 0,
                       "volume '%s' has %s, but no element of it has a direction; "
                       "expected directions, as attach makes them (--fibre, --fibre-lines)",
                       name, what);
    if (f->of[volume].c > 0 && t->lost)
        return err_set(e, NULL, 0,
                       "%lld of %lld elements of volume '%s' have no direction of fibres, which the law fung needs; "
                       "expected one in each, as attach makes them (--fibre, --fibre-lines)",
                       (long long)t->lost, (long long)t->all, name);
    if (f->of[volume].angle > 0 && t->flat + t->lost == t->all)
        return err_set(e, NULL, 0,
                       "volume '%s' has two families of fibres at an angle, in the plane across the normal, but its "
                       "elements have none; expected element.normal, as voxelise makes it for layers, or angle=0",
                       name);
    return 0;
}

static int check(const fibres_view *f, const model *m, int64_t volumes, err *e)
{
    const model_array *name = model_need(m, "volume.name", e);
    tally *t = name ? mem_array(volumes, sizeof *t, "the fibres", e) : NULL;
    int status = t ? 0 : -1;
    if (t)
        count_all(f, model_find(m, "element.volume")->rows, t);
    for (int64_t i = 0; !status && i < volumes; i++)
        status = check_volume(f, name->str[i], (int32_t)i, &t[i], e);
    free(t);
    return status;
}

static const float *floats_of(const model *m, const char *name)
{
    const model_array *a = model_find(m, name);
    return a ? a->f32 : NULL;
}

int fibres_make(fibres_view *to, const model *m, const material *of, err *e)
{
    const int64_t volumes = model_count(m, "volume");
    const materials_map map = materials_map_of(m, of);
    *to = (fibres_view){.volumes = volumes,
                        .volume = map.volume,
                        .mix = map.mix,
                        .mixture = map.mixture,
                        .along = floats_of(m, "element.fibre"),
                        .mixalong = floats_of(m, "element.mixfibre"),
                        .normal = floats_of(m, "element.normal")};
    bool any = false;
    for (int64_t i = 0; i < volumes; i++)
        any |= material_is_directed(&of[i]);
    if (!any)
        return 0;
    to->of = mem_array(volumes, sizeof *to->of, "the fibres", e);
    for (int64_t i = 0; to->of && i < volumes; i++)
        to->of[i] = material_fibres(&of[i]);
    return to->of ? check(to, m, volumes, e) : -1;
}

bool fibres_angled(const fibres_view *f)
{
    for (int64_t i = 0; f->of && i < f->volumes; i++)
        if (f->of[i].angle > 0)
            return true;
    return false;
}

void fibres_free(fibres_view *f)
{
    free(f->of);
    *f = (fibres_view){0};
}

void fibres_note(const fibres_view *f, const model *m, notes *to)
{
    const model_array *name = model_find(m, "volume.name");
    err e = {0};
    tally *t = f->of ? mem_array(name->rows, sizeof *t, "the fibres", &e) : NULL;
    if (!t)
        return;
    count_all(f, model_find(m, "element.volume")->rows, t);
    for (int64_t i = 0; i < name->rows; i++) {
        if (t[i].lost)
            notes_add(to,
                      "%lld of %lld elements of volume '%.200s' have no direction, so no fibres that resist being "
                      "stretched",
                      (long long)t[i].lost, (long long)t[i].all, name->str[i]);
        if (t[i].flat)
            notes_add(to,
                      "%lld of %lld elements of volume '%.200s' have no normal across their fibre, so no families "
                      "at an angle to it",
                      (long long)t[i].flat, (long long)t[i].all, name->str[i]);
    }
    free(t);
}
