#include "surface/embree.h"

#include "base/mem.h"

#include <embree3/rtcore.h>

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(sizeof(embree_packet) == sizeof(struct RTCRayHit16) &&
                   offsetof(embree_packet, along) == offsetof(struct RTCRayHit16, ray.dir_x) &&
                   offsetof(embree_packet, end) == offsetof(struct RTCRayHit16, ray.tfar) &&
                   offsetof(embree_packet, normal) == offsetof(struct RTCRayHit16, hit.Ng_x) &&
                   offsetof(embree_packet, item) == offsetof(struct RTCRayHit16, hit.primID) &&
                   offsetof(embree_packet, geometry) == offsetof(struct RTCRayHit16, hit.geomID),
               "a packet of rays is Embree's");

/* What Embree calls back with for a geometry of boxes; it must stay where it is until the tree is gone. */
typedef struct boxes {
    embree_box *box;
    const void *context;
} boxes;

struct embree {
    RTCDevice device;
    RTCScene scene;
    boxes boxes;
    float **spheres; /* of each geometry of spheres, owned */
    int64_t sphere_sets, sphere_capacity;
};

static int trouble(RTCDevice device, const char *what, err *e)
{
    enum RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE)
        return 0;
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        return err_memory(e, what);
    return err_set(e, NULL, 0, "Embree could not make %s (its error %d)", what, (int)code);
}

embree *embree_create(int threads, err *e)
{
    embree *b = mem_array(1, sizeof *b, "a tree of boxes", e);
    if (!b)
        return NULL;
    char settings[64];
    snprintf(settings, sizeof settings, "threads=%d", threads < 1 ? 1 : threads);
    b->device = rtcNewDevice(settings);
    if (b->device)
        b->scene = rtcNewScene(b->device);
    if (trouble(b->device, "a device", e)) {
        embree_destroy(b);
        return NULL;
    }
    rtcSetSceneFlags(b->scene, RTC_SCENE_FLAG_ROBUST);
    return b;
}

void embree_destroy(embree *b)
{
    if (!b)
        return;
    if (b->scene)
        rtcReleaseScene(b->scene);
    if (b->device)
        rtcReleaseDevice(b->device);
    for (int64_t i = 0; i < b->sphere_sets; i++)
        free(b->spheres[i]);
    free(b->spheres);
    free(b);
}

static int attach(embree *b, RTCGeometry geometry, const char *what, err *e)
{
    if (geometry) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(b->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    return trouble(b->device, what, e);
}

static void give_bounds(const struct RTCBoundsFunctionArguments *a)
{
    const boxes *b = a->geometryUserPtr;
    float low[3], high[3];
    b->box(b->context, a->primID, low, high);
    a->bounds_o->lower_x = low[0];
    a->bounds_o->lower_y = low[1];
    a->bounds_o->lower_z = low[2];
    a->bounds_o->upper_x = high[0];
    a->bounds_o->upper_y = high[1];
    a->bounds_o->upper_z = high[2];
}

int embree_add_boxes(embree *b, int64_t count, embree_box *box, const void *context, err *e)
{
    RTCGeometry geometry = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_USER);
    b->boxes = (boxes){box, context};
    if (geometry) {
        rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)count);
        rtcSetGeometryUserData(geometry, &b->boxes);
        rtcSetGeometryBoundsFunction(geometry, give_bounds, NULL);
    }
    return attach(b, geometry, "boxes", e);
}

/* Copies an array into a buffer of Embree's own, which has the padding that it reads beyond the end. */
static int give_array(const embree *b, RTCGeometry geometry, enum RTCBufferType type, enum RTCFormat format,
                      const void *array, size_t size, int64_t count, err *e)
{
    void *to = geometry && count ? rtcSetNewGeometryBuffer(geometry, type, 0, format, size, (size_t)count) : NULL;
    if (to)
        memcpy(to, array, size * (size_t)count);
    return trouble(b->device, "room for a surface", e);
}

int embree_add_faces(embree *b, int corners, int64_t vertices, const float *position, int64_t faces,
                     const uint32_t *corner, err *e)
{
    bool quads = corners == 4;
    RTCGeometry geometry = rtcNewGeometry(b->device, quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
    int failed = give_array(b, geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, position, 3 * sizeof *position,
                            vertices, e) ||
                 give_array(b, geometry, RTC_BUFFER_TYPE_INDEX, quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3, corner,
                            (size_t)corners * sizeof *corner, faces, e);
    return attach(b, geometry, "a surface", e) || failed ? -1 : 0;
}

/* ---- spheres */

/* Embree's own are met ray by ray, not packet by packet, which takes twice as long
 * for the small ones that many nodes are. */

/* The rows of a packet of any number of rays, as of an embree_packet. */
enum { FROM = 0, START = 3, ALONG = 4, END = 8, NORMAL = 12, U = 15, V, ITEM, GEOMETRY, INSTANCE };

/* Rays number by number, as Embree hands them over, in packets of any size up to EMBREE_RAYS. */
typedef struct lanes {
    const float *from[3], *along[3], *start;
    float *end;
    const int *valid;
} lanes;

static lanes lanes_of(void *rays, const int *valid, size_t n)
{
    float *f = rays, *from = f + FROM * n, *along = f + ALONG * n;
    return (lanes){
        {from, from + n, from + 2 * n}, {along, along + n, along + 2 * n}, f + START * n, f + END * n, valid};
}

/* Where each of n rays meets the sphere, in multiples of along, and for which it is so: -1, else 0. The middle of what
 * is within the sphere comes first and half of it then: exact from afar too. */
static inline void meet(const lanes *l, size_t n, const float *sphere, float *restrict at, int *restrict met)
{
    const float x = sphere[0], y = sphere[1], z = sphere[2], square = sphere[3] * sphere[3];
    const float *fx = l->from[0], *fy = l->from[1], *fz = l->from[2];
    const float *ax = l->along[0], *ay = l->along[1], *az = l->along[2], *start = l->start, *end = l->end;
    const int *valid = l->valid;
    for (size_t i = 0; i < n; i++) {
        float cx = x - fx[i], cy = y - fy[i], cz = z - fz[i];
        float share = 1 / (ax[i] * ax[i] + ay[i] * ay[i] + az[i] * az[i]);
        float middle = (cx * ax[i] + cy * ay[i] + cz * az[i]) * share;
        float px = cx - middle * ax[i], py = cy - middle * ay[i], pz = cz - middle * az[i];
        float half = (square - (px * px + py * py + pz * pz)) * share;
        float h = sqrtf(fabsf(half)), least = start[i], most = end[i];
        float first = middle - h, last = middle + h;
        float a = first >= least ? first : last;
        at[i] = a;
        met[i] = valid[i] & -((half >= 0) & (last >= least) & (a <= most));
    }
}

static void meet_all(const lanes *l, size_t n, const float *sphere, float *at, int *met)
{
    if (n == EMBREE_RAYS)
        meet(l, EMBREE_RAYS, sphere, at, met);
    else
        meet(l, n, sphere, at, met);
}

static const float *sphere_of(const void *spheres, unsigned item)
{
    return (const float *)spheres + 4 * (size_t)item;
}

static void sphere_bounds(const struct RTCBoundsFunctionArguments *a)
{
    const float *s = sphere_of(a->geometryUserPtr, a->primID);
    a->bounds_o->lower_x = s[0] - s[3];
    a->bounds_o->lower_y = s[1] - s[3];
    a->bounds_o->lower_z = s[2] - s[3];
    a->bounds_o->upper_x = s[0] + s[3];
    a->bounds_o->upper_y = s[1] + s[3];
    a->bounds_o->upper_z = s[2] + s[3];
}

static void sphere_nearest(const struct RTCIntersectFunctionNArguments *a)
{
    const float *s = sphere_of(a->geometryUserPtr, a->primID);
    alignas(64) float at[EMBREE_RAYS];
    alignas(64) int met[EMBREE_RAYS];
    const size_t n = a->N;
    const lanes l = lanes_of(a->rayhit, a->valid, n);
    float *number = (float *)(void *)a->rayhit;
    uint32_t *index = (uint32_t *)(void *)a->rayhit;
    meet_all(&l, n, s, at, met);
    for (size_t i = 0; i < n; i++) {
        if (!met[i])
            continue;
        l.end[i] = at[i];
        for (size_t k = 0; k < 3; k++)
            number[(NORMAL + k) * n + i] = l.from[k][i] + at[i] * l.along[k][i] - s[k];
        number[U * n + i] = number[V * n + i] = 0;
        index[ITEM * n + i] = a->primID;
        index[GEOMETRY * n + i] = a->geomID;
        index[INSTANCE * n + i] = a->context->instID[0];
    }
}

static void sphere_blocks(const struct RTCOccludedFunctionNArguments *a)
{
    alignas(64) float at[EMBREE_RAYS];
    alignas(64) int met[EMBREE_RAYS];
    const size_t n = a->N;
    const lanes l = lanes_of(a->ray, a->valid, n);
    meet_all(&l, n, sphere_of(a->geometryUserPtr, a->primID), at, met);
    for (size_t i = 0; i < n; i++)
        l.end[i] = met[i] ? -INFINITY : l.end[i];
}

int embree_add_spheres(embree *b, int64_t count, const float *centre_radius, err *e)
{
    if (mem_grow(&b->spheres, &b->sphere_capacity, b->sphere_sets + 1, sizeof *b->spheres, "spheres", e))
        return -1;
    float *copy = mem_array(4 * count, sizeof *copy, "spheres", e);
    if (!copy)
        return -1;
    memcpy(copy, centre_radius, 4 * (size_t)count * sizeof *copy);
    b->spheres[b->sphere_sets++] = copy;
    RTCGeometry geometry = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_USER);
    if (geometry) {
        rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)count);
        rtcSetGeometryUserData(geometry, copy);
        rtcSetGeometryBoundsFunction(geometry, sphere_bounds, NULL);
        rtcSetGeometryIntersectFunction(geometry, sphere_nearest);
        rtcSetGeometryOccludedFunction(geometry, sphere_blocks);
    }
    return attach(b, geometry, "spheres", e);
}

int embree_commit(embree *b, err *e)
{
    rtcCommitScene(b->scene);
    return trouble(b->device, "its tree of boxes", e);
}

typedef struct pair_context {
    embree_take_pair *take;
    void *context;
} pair_context;

/* Embree gives a scene against itself: each pair both ways, and each item with itself. */
static void give_pairs(void *context, struct RTCCollision *pair, unsigned pairs)
{
    const pair_context *c = context;
    for (unsigned i = 0; i < pairs; i++)
        if (pair[i].primID0 < pair[i].primID1)
            c->take(c->context, pair[i].primID0, pair[i].primID1);
}

void embree_pairs(const embree *b, embree_take_pair *take, void *context)
{
    pair_context c = {take, context};
    rtcCollide(b->scene, b->scene, give_pairs, &c);
}

void embree_packet_clear(embree_packet *p)
{
    memset(p, 0, sizeof *p);
    for (int i = 0; i < EMBREE_RAYS; i++) {
        p->end[i] = INFINITY;
        p->mask[i] = UINT32_MAX;
        p->geometry[i] = p->instance[i] = EMBREE_NONE;
    }
}

/* Embree wants -1 for each ray that counts, 0 for others. */
static void begin(struct RTCIntersectContext *c, bool coherent, unsigned valid, int *each)
{
    for (int i = 0; i < EMBREE_RAYS; i++)
        each[i] = -(int)(valid >> i & 1);
    rtcInitIntersectContext(c);
    c->flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
}

/* Where a processor has no vectors of 16 numbers, Embree takes a packet's rays one by one and does not look at `each`,
 * but passes over rays that end before they start. So those that do not count end there meanwhile; to: where they
 * ended. */
static void end_others(embree_packet *p, unsigned valid, float *to)
{
    for (int i = 0; i < EMBREE_RAYS; i++) {
        to[i] = p->end[i];
        p->end[i] = valid >> i & 1 ? p->end[i] : -INFINITY;
    }
}

static void put_others_back(embree_packet *p, unsigned valid, const float *from)
{
    for (int i = 0; i < EMBREE_RAYS; i++)
        p->end[i] = valid >> i & 1 ? p->end[i] : from[i];
}

void embree_nearest(const embree *b, unsigned valid, embree_packet *p, bool coherent)
{
    struct RTCIntersectContext c;
    alignas(64) int each[EMBREE_RAYS];
    float end[EMBREE_RAYS];
    begin(&c, coherent, valid, each);
    end_others(p, valid, end);
    rtcIntersect16(each, b->scene, &c, (struct RTCRayHit16 *)(void *)p);
    put_others_back(p, valid, end);
}

void embree_blocked(const embree *b, unsigned valid, embree_packet *p, bool coherent)
{
    struct RTCIntersectContext c;
    alignas(64) int each[EMBREE_RAYS];
    float end[EMBREE_RAYS];
    begin(&c, coherent, valid, each);
    end_others(p, valid, end);
    rtcOccluded16(each, b->scene, &c, (struct RTCRay16 *)(void *)p);
    put_others_back(p, valid, end);
}
