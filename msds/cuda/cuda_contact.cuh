/* Contact on the card, a node at a time: contacts.c's rules, and what a frame leaves to look at. Everything is static.
 */
#ifndef SINEW_CUDA_CONTACT_CUH
#define SINEW_CUDA_CONTACT_CUH

#include "msds/cuda/cuda_tissue.cuh"
#include "msds/problem/newton.h"

#define CHUNK_NODE(chunk) ((chunk)*GRID_THREADS + (int32_t)threadIdx.x)

static __device__ inline float square_away(const tissue_frame *f, float4 place, float4 u)
{
    const float x = place.x + u.x - f->centre[0], y = place.y + u.y - f->centre[1], z = place.z + u.z - f->centre[2];
    return x * x + y * y + z * z;
}

static __device__ inline double contact_along(const tissue_contact *c, float4 f)
{
    return c->way[0] * (double)f.x + c->way[1] * (double)f.y + c->way[2] * (double)f.z;
}

static __device__ inline float4 contact_add(const tissue_contact *c, float4 f, double amount)
{
    f.x += (float)(amount * c->way[0]);
    f.y += (float)(amount * c->way[1]);
    f.z += (float)(amount * c->way[2]);
    return f;
}

/* Whether a node is in the ball that is looked through. */
static __device__ inline bool contact_candidate(const tissue *t, const tissue_frame *f, int32_t n, float4 u)
{
    return f->touched && n < t->nodes && t->kind[n] == TISSUE_FREE &&
           square_away(f, t->place[n], u) < f->wide * f->wide;
}

/* Where the probe is from a node that stands at its place and `from`. */
static __device__ inline probe_touch contact_at(const tissue *t, const tissue_frame *f, int32_t n, const double from[3])
{
    const double x[3] = {t->position[3 * (int64_t)n] + from[0], t->position[3 * (int64_t)n + 1] + from[1],
                         t->position[3 * (int64_t)n + 2] + from[2]};
    return probe_at(&f->probe, x);
}

/* Lists a node, or not, with the force of the frame before. slack: over the probe's size, of those with a force and
 * those without; follows: a node with a force is listed wherever it is. */
static __device__ inline void contact_consider(const tissue *t, const tissue_frame *f, int32_t n, const double from[3],
                                               double held_slack, double slack, bool follows)
{
    const probe_touch at = contact_at(t, f, n, from);
    const double force = fmax(0., t->held[n]);
    if (!(follows && force > 0) && !(at.depth > -(force > 0 ? held_slack : slack) * f->probe.shape.size))
        return;
    tissue_contact c;
    for (int a = 0; a < 3; a++)
        c.way[a] = at.way[a], c.from[a] = from[a];
    c.depth = at.depth;
    c.force = force;
    t->contact[n] = c;
    t->listed[n] = 1;
}

/* Notes the force of a node for the next frame. */
static __device__ inline void contact_hold(const tissue *t, int32_t n)
{
    const double force = t->listed[n] ? t->contact[n].force : 0;
    t->held[n] = t->listed[n] && !(force > 0) ? -1 : force;
}

/* The force and torque of a node on the probe. */
static __device__ inline void contact_wrench(const tissue *t, const tissue_frame *f, int32_t n, const double u[3],
                                             double force[3], double torque[3])
{
    const tissue_contact *c = &t->contact[n];
    double x[3];
    for (int a = 0; a < 3; a++) {
        force[a] = -c->force * c->way[a];
        x[a] = t->position[3 * (int64_t)n + a] + u[a];
    }
    probe_torque(&f->probe, x, force, torque);
}

/* A chunk's part of what a frame leaves to look at; u: of the node. */
static __device__ inline void sight_parts(const tissue *t, const tissue_frame *f, int32_t chunk, const double u[3],
                                          grid_scratch *s)
{
    const int32_t n = CHUNK_NODE(chunk);
    double force[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
    const double square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    const bool listed = n < t->nodes && t->listed[n];
    double *part = t->part + PART_FORCE * t->chunks + chunk;
    if (listed)
        contact_wrench(t, f, n, u, force, torque);
    for (int a = 0; a < 3; a++) {
        const double sum[2] = {grid_block_sum(force[a], s), grid_block_sum(torque[a], s)};
        if (threadIdx.x == 0)
            part[a * t->chunks] = sum[0], part[(3 + a) * t->chunks] = sum[1];
    }
    const double most = grid_block_most(square, s);
    const int pressed = __syncthreads_count(listed && t->contact[n].force > 0),
              broken = __syncthreads_count(!isfinite(square));
    if (threadIdx.x == 0) {
        t->part[PART_PRESSED * t->chunks + chunk] = pressed;
        t->part[PART_LARGEST * t->chunks + chunk] = most;
        t->part[PART_BROKEN * t->chunks + chunk] = broken;
    }
}

static __device__ inline void sight_parts(const tissue *t, const tissue_frame *f, int32_t chunk, float4 u,
                                          grid_scratch *s)
{
    const double precise[3] = {(double)u.x, (double)u.y, (double)u.z};
    sight_parts(t, f, chunk, precise, s);
}

/* By one block, after a barrier. */
static __device__ inline void sight_sum(const tissue *t, double residual, int solves, grid_scratch *s)
{
    msds_reading reading;
    for (int a = 0; a < 3; a++) {
        reading.force[a] = grid_total(t->part + (PART_FORCE + a) * t->chunks, t->chunks, s);
        reading.torque[a] = grid_total(t->part + (PART_TORQUE + a) * t->chunks, t->chunks, s);
    }
    reading.contacts = (int64_t)grid_total(t->part + PART_PRESSED * t->chunks, t->chunks, s);
    reading.largest = sqrt(grid_most(t->part + PART_LARGEST * t->chunks, t->chunks, s));
    reading.finite = grid_total(t->part + PART_BROKEN * t->chunks, t->chunks, s) == 0;
    reading.residual = residual;
    reading.solves = solves;
    reading.met =
        *(const volatile bool *)&t->outcome->reading.met || reading.contacts > 0; /* any block may have set it */
    if (threadIdx.x == 0)
        t->outcome->reading = reading;
}

#endif
