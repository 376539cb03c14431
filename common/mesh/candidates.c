#include "mesh/candidates.h"

#include "base/mem.h"

#include <embree3/rtcore.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Boxes and rays are floats: a conversion errs by 2^-24 of the number, Embree's slab test by little more. */
static const double float_slack = 0x1p-21, least_slack = 1e-3;
/* Beyond this no ray starts, and Embree would not take the box. */
static const double farthest = 1e12;

struct candidates {
    RTCDevice device;
    RTCScene scene;
};

/* What Embree calls back with while it builds. */
typedef struct boxes {
    candidates_box *box;
    const void *context;
    double slack;
} boxes;

/* A ray's list goes along with it in Embree's context, which must come first. */
typedef struct ray_context {
    struct RTCIntersectContext embree;
    candidates_list *list;
} ray_context;

static float outward(double x, double slack, float toward)
{
    x += (double)toward * (slack + fabs(x) * float_slack);
    x = x > farthest ? farthest : x < -farthest ? -farthest : x;
    return nextafterf((float)x, toward * INFINITY);
}

static void give_bounds(const struct RTCBoundsFunctionArguments *a)
{
    const boxes *b = a->geometryUserPtr;
    double low[3], high[3];
    b->box(b->context, a->primID, low, high);
    a->bounds_o->lower_x = outward(low[0], b->slack, -1);
    a->bounds_o->lower_y = outward(low[1], b->slack, -1);
    a->bounds_o->lower_z = outward(low[2], b->slack, -1);
    a->bounds_o->upper_x = outward(high[0], b->slack, 1);
    a->bounds_o->upper_y = outward(high[1], b->slack, 1);
    a->bounds_o->upper_z = outward(high[2], b->slack, 1);
}

/* Takes the item down and does not accept it as a hit, so that Embree goes on to the next. */
static void take_item(const struct RTCOccludedFunctionNArguments *a)
{
    candidates_list *list = ((ray_context *)(void *)a->context)->list;
    err ignored = {0};
    if (list->count == list->capacity &&
        mem_grow(&list->item, &list->capacity, list->count + 1, sizeof *list->item, "candidates", &ignored)) {
        list->lost = true;
        return;
    }
    list->item[list->count++] = a->primID;
}

static int embree_error(RTCDevice device, const char *what, err *e)
{
    enum RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE)
        return 0;
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        return err_memory(e, what);
    return err_set(e, NULL, 0, "Embree could not make %s (its error %d)", what, (int)code);
}

static int build(candidates *c, int64_t count, boxes *b, err *e)
{
    RTCGeometry geometry = rtcNewGeometry(c->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)count);
    rtcSetGeometryUserData(geometry, b);
    rtcSetGeometryBoundsFunction(geometry, give_bounds, NULL);
    rtcSetGeometryOccludedFunction(geometry, take_item);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(c->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(c->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(c->scene);
    return embree_error(c->device, "its tree of boxes", e);
}

candidates *candidates_create(int64_t count, candidates_box *box, const void *context, double reach, int threads,
                              err *e)
{
    if (count < 0 || count >= UINT32_MAX) {
        err_set(e, NULL, 0, "%lld polygons; at most %u can be searched", (long long)count, UINT32_MAX - 1);
        return NULL;
    }
    candidates *c = mem_array(1, sizeof *c, "the tree of boxes", e);
    if (!c)
        return NULL;
    char settings[64];
    snprintf(settings, sizeof settings, "threads=%d", threads < 1 ? 1 : threads);
    c->device = rtcNewDevice(settings);
    boxes b = {box, context, least_slack + reach * float_slack};
    if (c->device)
        c->scene = rtcNewScene(c->device);
    if (embree_error(c->device, "a device", e) || build(c, count, &b, e)) {
        candidates_destroy(c);
        return NULL;
    }
    return c;
}

void candidates_destroy(candidates *c)
{
    if (!c)
        return;
    if (c->scene)
        rtcReleaseScene(c->scene);
    if (c->device)
        rtcReleaseDevice(c->device);
    free(c);
}

static int by_number(const void *a, const void *b)
{
    const uint32_t *i = a, *j = b;
    return (*i > *j) - (*i < *j);
}

/* Ascending, each once: Embree promises neither, and an item met twice would turn inside out for the caller. */
static void sort_items(candidates_list *list)
{
    int64_t kept = 0;
    if (list->count)
        qsort(list->item, (size_t)list->count, sizeof *list->item, by_number);
    for (int64_t i = 0; i < list->count; i++)
        if (!kept || list->item[kept - 1] != list->item[i])
            list->item[kept++] = list->item[i];
    list->count = kept;
}

int candidates_ray(const candidates *c, const double *from, const double *direction, candidates_list *list, err *e)
{
    struct RTCRay ray = {
        .org_x = (float)from[0],
        .org_y = (float)from[1],
        .org_z = (float)from[2],
        .dir_x = (float)direction[0],
        .dir_y = (float)direction[1],
        .dir_z = (float)direction[2],
        .tfar = INFINITY,
        .mask = UINT32_MAX,
    };
    ray_context context = {.list = list};
    rtcInitIntersectContext(&context.embree);
    list->count = 0;
    list->lost = false;
    rtcOccluded1(c->scene, &context.embree, &ray);
    if (list->lost)
        return err_memory(e, "candidates");
    sort_items(list);
    return 0;
}

void candidates_list_free(candidates_list *list)
{
    free(list->item);
    *list = (candidates_list){0};
}
