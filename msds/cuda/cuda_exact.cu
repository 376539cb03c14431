/* Exact frames on the card: equilibrium to a tolerance, by conjugate gradients that cycles of multigrid
 * precondition, all of a frame in one launch. As the CPU's (exact.h), a node of contact is kept on its side of a
 * plane: those that are on it (active) are held there, and let go of where they would have to be pulled; those that
 * pass it are taken in; until neither happens. The displacement and what is left of the load are in double; a search
 * for what to add to it is in single precision.
 */
#include "msds/cuda/cuda_cycle.cuh"

enum {
    ROUNDS = 4,   /* of a frame, each with the nodes that the last one pushed into the probe: as on the CPU */
    SEARCH = 100, /* iterations of one search */
    TURNS = 200,  /* searches and changes of contact in a round */
    STAGES = 3,   /* of a solve, each to a tolerance that is sharper by `sharper` */
    CHANGES = 12  /* of contact by a tolerance that is not yet the last */
};

/* msds_cpu.c's and contacts.c's; a search goes so far down at once, which single precision can do. */
static const double missed = 1e-6, sharper = 1e-2, search_depth = 1e-4;

static __device__ double sum_of(const tissue *t, tissue_part which, grid_scratch *s)
{
    return grid_total(t->part + which * t->chunks, t->chunks, s);
}

static __device__ void count_part(const tissue *t, tissue_part which, int32_t chunk, bool counts)
{
    const int count = __syncthreads_count(counts);
    if (threadIdx.x == 0)
        t->part[which * t->chunks + chunk] = count;
}

/* How far a contact has still to go. */
static __device__ inline double still_to_go(const tissue *t, int32_t n)
{
    const tissue_contact *c = &t->contact[n];
    const double *u = t->precise + 3 * (int64_t)n;
    double gone = 0;
    for (int a = 0; a < 3; a++)
        gone += c->way[a] * (u[a] - c->from[a]);
    return c->depth - gone;
}

static __device__ inline float4 single(const double *u)
{
    return {(float)u[0], (float)u[1], (float)u[2], 0};
}

/* Lists the nodes near the probe; active: those that press it, or are in it. */
static __device__ void find_contacts(const tissue *t, const tissue_frame *f, const tissue_exact *x)
{
    for (int32_t n = blockIdx.x * GRID_THREADS + threadIdx.x; n < t->nodes; n += gridDim.x * GRID_THREADS) {
        const double *u = t->precise + 3 * (int64_t)n;
        t->listed[n] = 0;
        x->active[n] = 0;
        if (!contact_candidate(t, f, n, single(u)))
            continue;
        contact_consider(t, f, n, u, CONTACT_NEAR_BY, CONTACT_NEAR_BY, true);
        x->active[n] = t->listed[n] && (t->contact[n].force > 0 || t->contact[n].depth > 0);
    }
    grid_barrier(t->arrived);
}

/* Prescribed contact: active nodes go to their planes. */
static __device__ void impose(const tissue *t, const tissue_frame *f, const tissue_exact *x)
{
    for (int32_t n = blockIdx.x * GRID_THREADS + threadIdx.x; n < t->nodes && !f->penalty;
         n += gridDim.x * GRID_THREADS)
        if (x->active[n]) {
            const double by = still_to_go(t, n);
            for (int a = 0; a < 3; a++)
                t->precise[3 * (int64_t)n + a] += by * t->contact[n].way[a];
        }
    grid_barrier(t->arrived);
}

/* What the elements pull a node with. A field without strain is one without force: so differences to
 * the neighbours stand for the diagonal, and what single precision of the matrix leaves is a share
 * of the strain, not of the displacement. */
static __device__ inline void pulled_precisely(const tissue *t, int32_t n, double y[3])
{
    const int32_t slice = n / LANES, lane = n % LANES, last = t->start[slice + 1];
    const double *u = t->precise + 3 * (int64_t)n;
    const double own[3] = {u[0], u[1], u[2]};
    y[0] = y[1] = y[2] = 0;
#pragma unroll 2
    for (int32_t slot = t->start[slice]; slot < last; slot++) {
        const double *other = t->precise + 3 * (int64_t)t->neighbour[slot * LANES + lane];
        const float *k = t->block + (int64_t)slot * 9 * LANES + lane;
        const double d[3] = {other[0] - own[0], other[1] - own[1], other[2] - own[2]};
        for (int a = 0; a < 3; a++)
            y[a] += (double)k[3 * a * LANES] * d[0] + (double)k[(3 * a + 1) * LANES] * d[1] +
                    (double)k[(3 * a + 2) * LANES] * d[2];
    }
}

static __device__ inline double square(const double v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/* What is left of the load, for the search; the forces of contact; and the squares PART_LEFT, PART_LOAD, PART_PULLS. */
static __device__ void find_left(const tissue *t, const tissue_frame *f, const tissue_exact *x, grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        double y[3] = {0, 0, 0}, left[3] = {0, 0, 0}, load[3] = {0, 0, 0};
        if (n < t->nodes) {
            const float4 w = t->weight[n];
            pulled_precisely(t, n, y);
            load[0] = (double)w.x, load[1] = (double)w.y, load[2] = (double)w.z;
            for (int a = 0; a < 3; a++)
                left[a] = load[a] - y[a];
            if (x->active[n]) {
                tissue_contact *c = &t->contact[n];
                c->force = f->penalty ? t->repulsion[n] * still_to_go(t, n)
                                      : -(c->way[0] * left[0] + c->way[1] * left[1] + c->way[2] * left[2]);
                for (int a = 0; a < 3; a++)
                    left[a] += c->force * c->way[a], load[a] += c->force * c->way[a];
            }
            t->left[n] = single(left);
            smooth_first(t, f, x, 0, n, t->left[n]);
        }
        const double sum[] = {grid_block_sum(square(left), s), grid_block_sum(square(load), s),
                              grid_block_sum(square(y), s)};
        for (int i = 0; i < 3 && threadIdx.x == 0; i++)
            t->part[(PART_LEFT + i) * t->chunks + chunk] = sum[i];
    }
    grid_barrier(t->arrived);
}

/* The way, z + beta times the one before, and what pulls along it, by differences; PART_SECOND: the product of both. */
static __device__ void multiply(const tissue *t, const tissue_frame *f, const tissue_exact *x, float beta,
                                const float4 *before, float4 *way, grid_scratch *s)
{
    const float4 *z = x->at[0].z[FINISHED];
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        double product = 0;
        if (n < t->nodes) {
            const int32_t slice = n / LANES, lane = n % LANES, last = t->start[slice + 1];
            const float4 p = plus_times(z[n], beta, before[n]);
            float4 y = {0, 0, 0, 0};
#pragma unroll 2
            for (int32_t slot = t->start[slice]; slot < last; slot++) {
                const int32_t other = t->neighbour[slot * LANES + lane];
                block_add(t->block + (int64_t)slot * 9 * LANES + lane,
                          minus(plus_times(z[other], beta, before[other]), p), &y);
            }
            if (f->penalty && x->active[n])
                y = contact_add(&t->contact[n], y, t->repulsion[n] * contact_along(&t->contact[n], p));
            y = keep_out(t, f, x, 0, n, y);
            way[n] = p;
            t->pulled[n] = y;
            product = dot_of(p, y);
        }
        product = grid_block_sum(product, s);
        if (threadIdx.x == 0)
            t->part[PART_SECOND * t->chunks + chunk] = product;
    }
    grid_barrier(t->arrived);
}

/* alpha along the way; PART_FIRST: the square of what is left then. */
static __device__ void advance(const tissue *t, const tissue_frame *f, const tissue_exact *x, float alpha,
                               const float4 *way, grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        float4 left = {0, 0, 0, 0};
        if (n < t->nodes) {
            left = plus_times(t->left[n], -alpha, t->pulled[n]);
            t->left[n] = left;
            x->gone[n] = plus_times(x->gone[n], alpha, way[n]);
            smooth_first(t, f, x, 0, n, left);
        }
        const double sum = grid_block_sum(dot_of(left, left), s);
        if (threadIdx.x == 0)
            t->part[PART_FIRST * t->chunks + chunk] = sum;
    }
    grid_barrier(t->arrived);
}

/* Searches until the square of what is left is at most goal. Returns the iterations taken. */
static __device__ int search(const tissue *t, const tissue_frame *f, const tissue_exact *x, double goal,
                             grid_scratch *s)
{
    float beta = 0;
    int i = 0;
    for (int32_t n = blockIdx.x * GRID_THREADS + threadIdx.x; n < t->nodes; n += gridDim.x * GRID_THREADS)
        x->gone[n] = t->way[0][n] = {0, 0, 0, 0};
    cycle(t, f, x, s);
    double product = sum_of(t, PART_THIRD, s);
    while (i < SEARCH) {
        float4 *before = t->way[i % 2], *way = t->way[1 - i % 2];
        multiply(t, f, x, beta, before, way, s);
        const double curvature = sum_of(t, PART_SECOND, s);
        if (!(curvature > 0) || !(product > 0))
            break;
        advance(t, f, x, (float)(product / curvature), way, s);
        i++;
        if (!(sum_of(t, PART_FIRST, s) > goal))
            break;
        cycle(t, f, x, s);
        const double next = sum_of(t, PART_THIRD, s);
        beta = (float)(next / product);
        product = next;
    }
    for (int32_t n = blockIdx.x * GRID_THREADS + threadIdx.x; n < t->nodes; n += gridDim.x * GRID_THREADS) {
        const float4 by = x->gone[n];
        double *u = t->precise + 3 * (int64_t)n;
        u[0] += (double)by.x, u[1] += (double)by.y, u[2] += (double)by.z;
    }
    grid_barrier(t->arrived);
    return i;
}

/* Lets go of active nodes that pull and takes in those that are past their planes. Returns how many. */
static __device__ int64_t change_contacts(const tissue *t, const tissue_frame *f, const tissue_exact *x,
                                          grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        bool changed = false;
        if (n < t->nodes && t->listed[n]) {
            tissue_contact *c = &t->contact[n];
            changed = x->active[n] ? c->force < 0 : still_to_go(t, n) > exact_tolerance * f->probe.shape.size;
            x->active[n] ^= changed;
            if (!x->active[n])
                c->force = 0;
        }
        count_part(t, PART_FIRST, chunk, changed);
    }
    grid_barrier(t->arrived);
    return (int64_t)sum_of(t, PART_FIRST, s);
}

/* Whether a node that is not listed is in the probe; notes the forces. */
static __device__ bool contacts_missed(const tissue *t, const tissue_frame *f, grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        bool in = false;
        if (n < t->nodes) {
            const double *u = t->precise + 3 * (int64_t)n;
            contact_hold(t, n);
            in = !t->listed[n] && contact_candidate(t, f, n, single(u)) &&
                 contact_at(t, f, n, u).depth > missed * f->probe.shape.size;
        }
        count_part(t, PART_SECOND, chunk, in);
    }
    grid_barrier(t->arrived);
    return sum_of(t, PART_SECOND, s) > 0;
}

typedef struct progress {
    double load, residual; /* N2: the square of the frame's largest load, or of a slight one */
    int solves;
} progress;

/* Brings the tissue into equilibrium with the contacts listed. Returns whether it is. */
static __device__ bool solve(const tissue *t, const tissue_frame *f, const tissue_exact *x, progress *p,
                             grid_scratch *s)
{
    double tolerance = exact_tolerance / (sharper * sharper);
    int changes = 0, stage = 1;
    for (int turn = 0; turn < TURNS; turn++) {
        impose(t, f, x);
        find_left(t, f, x, s);
        const double left = sum_of(t, PART_LEFT, s);
        p->load = fmax(p->load, fmax(sum_of(t, PART_LOAD, s), sum_of(t, PART_PULLS, s)));
        p->residual = p->load > 0 ? sqrt(left / p->load) : 0;
        if (!isfinite(p->residual))
            return false;
        if (p->residual > tolerance) {
            const double goal = .64 * tolerance * tolerance * p->load, least = search_depth * search_depth * left;
            p->solves += search(t, f, x, fmax(goal, least), s);
            continue;
        }
        const bool settled = change_contacts(t, f, x, s) == 0;
        if (settled && stage == STAGES)
            return true;
        if (stage < STAGES && (settled || ++changes == CHANGES)) {
            tolerance = ++stage == STAGES ? exact_tolerance : sharper * tolerance;
            changes = 0;
        }
    }
    return false;
}

/* What the frame leaves: displacements in single precision too, no velocity, the forces for the next frame. */
static __device__ void conclude(const tissue *t, const tissue_frame *f, grid_scratch *s)
{
    for (int32_t chunk = blockIdx.x; chunk < t->chunks; chunk += gridDim.x) {
        const int32_t n = CHUNK_NODE(chunk);
        double u[3] = {0, 0, 0};
        if (n < t->nodes) {
            for (int a = 0; a < 3; a++)
                u[a] = t->precise[3 * (int64_t)n + a];
            contact_hold(t, n);
            t->u[n] = single(u);
            t->v[n] = {0, 0, 0, 0};
        }
        sight_parts(t, f, chunk, u, s);
    }
    grid_barrier(t->arrived);
}

static __global__ void __launch_bounds__(GRID_THREADS, 6) exact_kernel(tissue t, tissue_frame f, tissue_exact x)
{
    __shared__ grid_scratch scratch;
    grid_scratch *s = &scratch;
    progress p = {t.slight, 0, 0}; /* or tissue back at rest would never come to a share of what pulls it */
    bool good = true;
    for (int round = 0; round < ROUNDS && good; round++) {
        find_contacts(&t, &f, &x);
        good = solve(&t, &f, &x, &p, s);
        if (!f.touched || round == ROUNDS - 1 || !contacts_missed(&t, &f, s))
            break;
    }
    conclude(&t, &f, s);
    if (blockIdx.x == 0) {
        sight_sum(&t, p.residual, p.solves, s);
        if (!good && threadIdx.x == 0)
            t.outcome->failed = true;
    }
}

static __global__ void widen_kernel(tissue t)
{
    const int32_t n = blockIdx.x * GRID_THREADS + threadIdx.x;
    if (n >= t.nodes)
        return;
    double *to = t.precise + 3 * (int64_t)n;
    to[0] = (double)t.u[n].x, to[1] = (double)t.u[n].y, to[2] = (double)t.u[n].z;
}

void tissue_widen(const tissue *t, cudaStream_t stream)
{
    widen_kernel<<<(unsigned)t->chunks, GRID_THREADS, 0, stream>>>(*t);
}

static const void *kernel_of(const tissue *t, int processors)
{
    (void)t;
    (void)processors;
    return (const void *)exact_kernel;
}

cudaError_t tissue_exact_start(const tissue *t, const tissue_frame *f, const tissue_exact *x, cudaStream_t stream)
{
    tissue_exact view = *x;
    return tissue_start(TISSUE_EXACT, kernel_of, t, f, &view, t->chunks, stream);
}
