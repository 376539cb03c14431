#include "msds/mesh/mesh_regions.h"

#include "base/mem.h"
#include "msds/mesh/mesh_shape.h"

#include <stdio.h>
#include <stdlib.h>

enum { NAME = 400 };

/* ---- which */

static int take_region(mesh_regions *r, const char *name, const volume *labels, err *e)
{
    if (r->count == MESH_REGIONS + 1)
        return err_usage(e, "--smooth: more than %d volumes; expected fewer", MESH_REGIONS);
    if (mesh_chosen_add(&r->of[r->count], labels, "--smooth", name, e))
        return -1;
    for (int i = 1; i < r->count; i++)
        if (mesh_chosen_has(&r->of[i], r->of[r->count].value[0]))
            return err_usage(e, "--smooth: '%s' stands twice; expected each once", name);
    r->count++;
    return 0;
}

static int take_regions(mesh_regions *r, const char *list, const volume *labels, err *e)
{
    size_t length;
    r->count = 1;
    for (const char *p = list; p; p = p[length] ? p + length + 1 : NULL) {
        char name[NAME];
        length = strcspn(p, ",");
        snprintf(name, sizeof name, "%.*s", length < NAME ? (int)length : NAME - 1, p);
        if (take_region(r, name, labels, e))
            return -1;
    }
    return 0;
}

static uint8_t region_of(const mesh_regions *r, int64_t label)
{
    for (int i = 1; i < r->count; i++)
        if (mesh_chosen_has(&r->of[i], label))
            return (uint8_t)i;
    return 0;
}

int mesh_regions_make(mesh_regions *r, const char *list, const volume *labels, const char *where, err *e)
{
    if (take_regions(r, list, labels, e))
        return -1;
    r->place = *labels;
    r->place.data = NULL;
    r->place.label = NULL;
    r->place.labels = 0;
    r->finder = volume_finder_of(labels);
    r->voxel = mem_array(volume_count(labels), 1, "regions", e);
    if (!r->voxel)
        return -1;
    int64_t last = 0, label;
    uint8_t region = region_of(r, last);
    for (int64_t i = 0; i < volume_count(labels); i++) {
        if (mesh_chosen_read(labels, i, where, &label, e))
            return -1;
        if (label != last)
            region = region_of(r, last = label);
        r->voxel[i] = region;
    }
    return 0;
}

void mesh_regions_free(mesh_regions *r)
{
    free(r->voxel);
    *r = (mesh_regions){0};
}

/* ---- shares */

/* The cubic B-spline, over its whole. */
static double spline(double x)
{
    const double d = fabs(x), left = fmax(2 - d, 0);
    return d < 1 ? 2. / 3 - d * d * (1 - d / 2) : left * left * left / 6;
}

/* Of one axis: the voxels that have a weight, those at the ends again beyond them. */
typedef struct taps {
    int64_t at[4];
    double weight[4];
} taps;

static void find_taps(taps *t, double voxel, int64_t size)
{
    const double at = fmin(fmax(voxel, -1), (double)size);
    for (int n = 0; n < 4; n++) {
        const int64_t i = (int64_t)floor(at) - 1 + n;
        t->at[n] = (int64_t)fmin(fmax((double)i, 0), (double)(size - 1));
        t->weight[n] = spline((double)i - at);
    }
}

/* share: of each region. */
static void find_shares(const mesh_regions *r, const double place[3], double share[MESH_REGIONS + 1])
{
    const int64_t *size = r->place.size;
    taps t[3];
    double voxel[3];
    volume_voxel(&r->finder, place, voxel);
    for (int a = 0; a < 3; a++)
        find_taps(&t[a], voxel[a], size[a]);
    for (int i = 0; i < r->count; i++)
        share[i] = 0;
    for (int k = 0; k < 4; k++)
        for (int j = 0; j < 4; j++) {
            const uint8_t *row = &r->voxel[(t[2].at[k] * size[1] + t[1].at[j]) * size[0]];
            const double weight = t[2].weight[k] * t[1].weight[j];
            for (int i = 0; i < 4; i++)
                share[row[t[0].at[i]]] += weight * t[0].weight[i];
        }
}

static int largest(const double *share, int count, int but)
{
    int most = but == 0 ? 1 : 0;
    for (int i = most + 1; i < count; i++)
        if (i != but && share[i] > share[most])
            most = i;
    return most;
}

int mesh_regions_at(const void *r, const double place[3])
{
    const mesh_regions *of = r;
    double share[MESH_REGIONS + 1];
    find_shares(of, place, share);
    return largest(share, of->count, -1);
}

double mesh_regions_normal(const mesh_regions *r, const double place[3], double to[3])
{
    double here[MESH_REGIONS + 1], share[MESH_REGIONS + 1];
    find_shares(r, place, here);
    const int most = largest(here, r->count, -1), next = largest(here, r->count, most);
    double along[3];
    for (int a = 0; a < 3; a++)
        to[a] = 0;
    for (int a = 0; a < 3; a++) {
        const double length = shape_length(r->finder.row[a]); /* 1/m, over planes of voxels */
        double fall = 0;
        for (int sign = -1; sign <= 1; sign += 2) {
            for (int i = 0; i < 3; i++)
                along[i] = place[i] + sign * .25 * r->finder.row[a][i] / (length * length);
            find_shares(r, along, share);
            fall -= sign * (share[most] - share[next]);
        }
        for (int i = 0; i < 3; i++)
            to[i] += fall * r->finder.row[a][i];
    }
    shape_unit(to);
    return here[most] - here[next];
}

/* ---- labels */

enum { AROUND = 3, BOX = (2 * AROUND + 1) * (2 * AROUND + 1) * (2 * AROUND + 1) };

static int64_t most_common(const int64_t *list, int count)
{
    int64_t most = 0;
    int times = 0;
    for (int i = 0; i < count; i++) {
        int same = 0;
        for (int j = 0; j < count; j++)
            same += list[j] == list[i];
        if (same > times || (same == times && list[i] < most)) {
            times = same;
            most = list[i];
        }
    }
    return most;
}

/* Of the voxels of region 0 that are `reach` away at most. Returns how many. */
static int collect(const mesh_regions *r, const volume *labels, const int64_t at[3], int reach, int64_t list[BOX])
{
    const int64_t *size = r->place.size;
    int count = 0;
    for (int64_t k = at[2] - reach; k <= at[2] + reach; k++)
        for (int64_t j = at[1] - reach; j <= at[1] + reach; j++)
            for (int64_t i = at[0] - reach; i <= at[0] + reach; i++) {
                const int64_t v = (k * size[1] + j) * size[0] + i;
                if (i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2] && !r->voxel[v])
                    list[count++] = (int64_t)volume_value(labels, v);
            }
    return count;
}

int64_t mesh_regions_label(const mesh_regions *r, const volume *labels, const double place[3], int region)
{
    const int64_t v = volume_nearest(labels, &r->finder, place), *size = r->place.size;
    int64_t list[BOX];
    int count = 0;
    if (v >= 0 && r->voxel[v] == region)
        return (int64_t)volume_value(labels, v);
    if (region)
        return r->of[region].value[0];
    const int64_t at[3] = {v % size[0], v / size[0] % size[1], v / size[0] / size[1]};
    for (int reach = 1; v >= 0 && reach <= AROUND && !count; reach++)
        count = collect(r, labels, at, reach, list);
    return most_common(list, count);
}
