/* The CPU executor's pass over a problem without a lattice; part of cpu_lanes.c. Elements go in groups of LANES, side
 * by side, and leave each corner's force in w->force; then nodes gather theirs in the elements' order: the same bytes
 * for any number of lanes and threads.
 */
#include "physics/element_any.h"

/* One component at the corners of a group. */
static inline element_corners mesh_corners(const void *u, const int32_t *node)
{
    element_corners c;
    for (int i = 0; i < 8; i++)
        for (int lane = 0; lane < LANES; lane++)
            c.at[i][lane] = ((const real_one *)u)[node[i * LANES + lane]];
    return c;
}

static inline element_vector mesh_vector(const real_one *at, int first)
{
    element_vector v = {load(at, first * LANES), load(at, (first + 1) * LANES), load(at, (first + 2) * LANES)};
    return v;
}

/* Nothing, where control is not physical. */
static inline element_tensor mesh_basis(const real_one *at, hourglass_kind control)
{
    real basis[9];
    for (int i = 0; i < 9; i++)
        basis[i] = control == HOURGLASS_PHYSICAL ? load(at, (CPU_SHAPE + i) * LANES) : REAL_ZERO;
    element_tensor j = {basis[0], basis[1], basis[2], basis[3], basis[4], basis[5], basis[6], basis[7], basis[8]};
    return j;
}

static inline element_any mesh_shape(const real_one *at, hourglass_kind control)
{
    element_any s;
    for (int m = 0; m < ELEMENT_MODES; m++)
        s.slope[m] = mesh_vector(at, 3 * m);
    for (int g = 0; g < ELEMENT_TWISTS; g++)
        s.twist[g] = mesh_vector(at, 3 * (ELEMENT_MODES + g));
    s.volume = load(at, 3 * (ELEMENT_MODES + ELEMENT_TWISTS) * LANES);
    s.basis = mesh_basis(at, control);
    return s;
}

static inline element_law mesh_law(const real_one *at, hourglass_kind control)
{
    element_law law = {{REAL_ZERO}, {REAL_ZERO}};
    for (int i = 0; i < COEFFICIENTS; i++)
        law.c[i] = load(at, (CPU_SHAPE + cpu_hold_numbers(control) + i) * LANES);
    if (control == HOURGLASS_ISOTROPIC)
        law.hourglass[HOURGLASS_K] = load(at, CPU_SHAPE * LANES);
    for (int i = 0; control == HOURGLASS_PHYSICAL && i < HOURGLASS_NUMBERS; i++)
        law.hourglass[i] = load(at, (CPU_SHAPE + 9 + i) * LANES);
    return law;
}

/* A lane of a group: an element whose muscle has curves of its own. */
static inline void mesh_curves(muscle_curves *to, const double *curve, real_one share, int lane)
{
    to->less[lane] = (real_one)curve[MUSCLE_LESS];
    to->passive[lane] = share * (real_one)curve[MUSCLE_PASSIVE];
    to->stiffening[lane] = (real_one)curve[MUSCLE_STIFFENING];
    to->straight[lane] = (real_one)curve[MUSCLE_STRAIGHT];
}

/* A lane of a group whose muscle is in series with a spring. */
static inline void mesh_series(const cpu_work *w, int64_t i, const tled_volume *v, real_one share, int lane,
                               element_fibre *to, real *most)
{
    to->series.stiffness[lane] = share * (real_one)v->muscle[MUSCLE_SPRING];
    to->series.contractile[lane] = ((const real_one *)w->contractile)[i];
    (*most)[lane] = (real_one)tled_contractile_most(v, w->dt);
}

/* The contractile elements of a group, which go on by the step that this pass ends. */
static inline void mesh_contract(const cpu_work *w, int64_t group, const element_field *u, const element_any *shape,
                                 real most, element_fibre *fibre)
{
    if (!(w->what & PASS_FINISH))
        return;
    const element_tensor h =
        element_any_gradient(shape, element_modes_of(u->x), element_modes_of(u->y), element_modes_of(u->z));
    fibre->series.contractile = element_contract(h, *fibre, most);
    for (int lane = 0; lane < LANES && group * LANES + lane < w->p->elements; lane++)
        if (fibre->series.stiffness[lane] > 0)
            ((real_one *)w->contractile)[group * LANES + lane] = fibre->series.contractile[lane];
}

/* What pulls along the fibres; *which: ELEMENT_MUSCLE and so on, the most of any of them. */
static inline element_fibre mesh_fibre(const cpu_work *w, int64_t group, int *which, real *most)
{
    element_fibre fibre = {.tension = REAL_ZERO};
    *which = ELEMENT_NO_MUSCLE;
    *most = REAL_ZERO;
    for (int lane = 0; w->fibre[0] && lane < LANES && group * LANES + lane < w->p->elements; lane++) {
        const int64_t i = group * LANES + lane;
        const int32_t volume = w->p->element_volume[i];
        const double tension = kind_of(w, volume)->tension;
        const real_one share = w->fraction ? ((const real_one *)w->fraction)[i] : 1;
        if (tension == 0 && !is_curved(w, volume))
            continue;
        if (is_curved(w, volume))
            mesh_curves(&fibre.curves, w->p->volume[volume].muscle, share, lane);
        if (is_serial(w, volume))
            mesh_series(w, i, &w->p->volume[volume], share, lane, &fibre, most);
        const int is = is_serial(w, volume)   ? ELEMENT_SERIAL_MUSCLE
                       : is_curved(w, volume) ? ELEMENT_CURVED_MUSCLE
                                              : ELEMENT_MUSCLE;
        *which = is > *which ? is : *which;
        fibre.along.x[lane] = ((const real_one *)w->fibre[0])[i];
        fibre.along.y[lane] = ((const real_one *)w->fibre[1])[i];
        fibre.along.z[lane] = ((const real_one *)w->fibre[2])[i];
        fibre.tension[lane] = share * (real_one)tension;
    }
    return fibre;
}

/* Lane `lane` of a volume's fibres that resist being stretched, in cell i. */
static inline void mesh_fibres_of(const cpu_work *w, int64_t i, int lane, int32_t volume, const void *const along[3],
                                  const void *const family[FIBRE_FAMILIES][3], real_one share, fibre_set *s)
{
    if (!fibres_any(&w->p->fibres, volume) || !along[0])
        return;
    const fibre_numbers *n = &w->p->fibres.of[volume];
    const fibre_invariants q = fibre_numbers_fung(n);
    const int families = fibre_numbers_families(n);
    s->families = families > s->families ? families : s->families;
    s->is_fung |= n->c > 0;
    s->law.k1[lane] = share * (real_one)n->k1;
    s->law.k2[lane] = (real_one)n->k2;
    s->law.kappa[lane] = (real_one)n->kappa;
    s->fung.c[lane] = share * (real_one)n->c;
    s->fung.all[lane] = (real_one)q.all;
    s->fung.along[lane] = (real_one)q.along;
    s->fung.both[lane] = (real_one)q.both;
    s->along.x[lane] = ((const real_one *)along[0])[i];
    s->along.y[lane] = ((const real_one *)along[1])[i];
    s->along.z[lane] = ((const real_one *)along[2])[i];
    for (int k = 0; k < families; k++) {
        s->family[k].x[lane] = ((const real_one *)family[k][0])[i];
        s->family[k].y[lane] = ((const real_one *)family[k][1])[i];
        s->family[k].z[lane] = ((const real_one *)family[k][2])[i];
    }
}

/* The fibres of a group that resist being stretched, of its volumes and of those mixed into them. 0: there are none. */
static inline int mesh_fibres(const cpu_work *w, int64_t group, fibre_set sets[2])
{
    const tled_problem *p = w->p;
    if (!p->fibres.of)
        return 0;
    for (int k = 0; k < 2; k++)
        sets[k] = (fibre_set){.families = 0};
    for (int lane = 0; lane < LANES && group * LANES + lane < p->elements; lane++) {
        const int64_t i = group * LANES + lane;
        const real_one share = w->fraction ? ((const real_one *)w->fraction)[i] : 1;
        const real_one part = tled_mix(p, i) >= 0 ? ((const real_one *)w->mixture)[i] : 0;
        mesh_fibres_of(w, i, lane, p->element_volume[i], w->fibre, w->family, share * (1 - part), &sets[0]);
        mesh_fibres_of(w, i, lane, tled_mix(p, i), w->mixfibre, w->mixfamily, share * part, &sets[1]);
    }
    return sets[0].families || sets[0].is_fung || sets[1].families || sets[1].is_fung ? 2 : 0;
}

/* The forces of groups; control: a constant. */
static inline void mesh_groups_forces(const cpu_work *w, int64_t from, int64_t to, hourglass_kind control)
{
    for (int64_t group = from; group < to; group++) {
        const real_one *own = (const real_one *)w->shape + group * cpu_mesh_numbers(THE_FORM, control) * LANES;
        const int32_t *node = w->group_node + group * 8 * LANES;
        real_one *force = (real_one *)w->force + group * 24 * LANES;
        const element_any shape = mesh_shape(own, control);
        const element_law law = mesh_law(own, control);
        const element_field u = {mesh_corners(w->from[0], node), mesh_corners(w->from[1], node),
                                 mesh_corners(w->from[2], node)};
        int which;
        real most;
        element_fibre fibre = mesh_fibre(w, group, &which, &most);
        if (which == ELEMENT_SERIAL_MUSCLE)
            mesh_contract(w, group, &u, &shape, most, &fibre);
        fibre_set sets[2];
        const int count = mesh_fibres(w, group, sets);
        const element_field f = element_any_force_fibred(THE_FORM, control, u, &shape, law, fibre, which, sets, count);
        store_field(force, &f);
    }
}

static void mesh_elements(const cpu_work *w, int64_t from, int64_t to)
{
#ifdef ELEMENT_SINGLE
    const unsigned before = flush_small();
#endif
    if (w->p->control.kind == HOURGLASS_PHYSICAL)
        mesh_groups_forces(w, from, to, HOURGLASS_PHYSICAL);
    else
        mesh_groups_forces(w, from, to, HOURGLASS_ISOTROPIC);
#ifdef ELEMENT_SINGLE
    flush_as(before);
#endif
}

/* Adds what the elements at a node pull with. */
static inline void mesh_gather(const cpu_work *w, int64_t n)
{
    const tled_problem *p = w->p;
    for (int64_t i = p->corner_start[n]; i < p->corner_start[n + 1]; i++) {
        const int64_t element = p->corner[i] / 8, corner = p->corner[i] % 8;
        const real_one *force = (const real_one *)w->force + (element / LANES * 24 + corner) * LANES + element % LANES;
        for (int a = 0; a < 3; a++)
            ((real_one *)w->sum[a])[n] += force[a * 8 * LANES];
    }
}

/* from: a multiple of LANES. */
static void mesh_nodes(const cpu_work *w, int64_t from, int64_t to)
{
#ifdef ELEMENT_SINGLE
    const unsigned before = flush_small();
#endif
    const rows *r = w->r;
    const node_factors k = node_factors_of(w->dt, w->damping);
    const rows_block l = {.node = (int32_t)from, .nodes = (int32_t)(to - from)};
    int32_t extra = 0, high = r->extras;
    while (extra < high) {
        const int32_t middle = extra + (high - extra) / 2;
        if (r->extra[middle] < from)
            extra = middle + 1;
        else
            high = middle;
    }
    for (int64_t n = from; n < to; n++)
        mesh_gather(w, n);
    for (; extra < r->extras && r->extra[extra] < to; extra++)
        for (int a = 0; a < 3; a++)
            move_extra(w, r->extra[extra], r->extra_node[extra], a, k);
    for (int a = 0; a < 3; a++)
        move_nodes(w, &l, a, k);
#ifdef ELEMENT_SINGLE
    flush_as(before);
#endif
}
