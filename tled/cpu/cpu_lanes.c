/* The passes of cpu_pass.h: an object for each instruction set, precision and form, by the Makefile, which defines
 * CPU_FORM. All but its table is static. */
#include "solve/flush.h"
#include "solve/vectors.h"
#include "tled/cpu/cpu_pass.h"
#include "tled/problem/loads.h"

#ifndef CPU_FORM /* for tools that read a source by itself */
#define CPU_FORM NEO_HOOKEAN
#endif
#define CPU_PASTE(a, b, c) a##b##c
#define CPU_JOIN(a, b, c)  CPU_PASTE(a, b, c)

#ifdef ELEMENT_SINGLE
#define ELEMENT_LANES (VECTORS_BYTES / 4)
#define CPU_PASS      VECTORS_OF(CPU_JOIN(cpu_pass_single_, CPU_FORM, _))
#else
#define ELEMENT_LANES (VECTORS_BYTES / 8)
#define CPU_PASS      VECTORS_OF(CPU_JOIN(cpu_pass_double_, CPU_FORM, _))
#endif
#include "physics/element_laminate.h"
#include "tled/problem/node.h"

#define THE_FORM CPU_JOIN(FORM_, CPU_FORM, )

enum {
    LANES = ELEMENT_LANES,
    COEFFICIENTS = CPU_JOIN(FORM_, CPU_FORM, _NUMBERS),
    MODULI = CPU_JOIN(FORM_, CPU_FORM, _MODULI) /* the first ones */
};

typedef struct cpu_kind { /* a volume's numbers: cpu_kind_numbers */
    double law[COEFFICIENTS + HOURGLASS_NUMBERS], tension;
} cpu_kind;

static inline const cpu_kind *kind_of(const cpu_work *w, int32_t volume)
{
    return (const cpu_kind *)w->kind + volume;
}

/* Whether a volume's muscle has curves of its own. */
static inline bool is_curved(const cpu_work *w, int32_t volume)
{
    return w->p->curved && w->p->volume[volume].curved;
}

/* Whether it contracts in series with a spring. */
static inline bool is_serial(const cpu_work *w, int32_t volume)
{
    return w->p->serial && volume >= 0 && w->p->volume[volume].serial;
}

static inline real load(const void *array, int64_t at)
{
    real x;
    memcpy(&x, (const real_one *)array + at, sizeof x);
    return x;
}

static inline void store(void *array, int64_t at, real x)
{
    memcpy((real_one *)array + at, &x, sizeof x);
}

/* True in the first `count` lanes. */
static inline real_mask first_lanes(int count)
{
#if ELEMENT_LANES == 16
    const real_mask index = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
#elif ELEMENT_LANES == 8
    const real_mask index = {0, 1, 2, 3, 4, 5, 6, 7};
#elif ELEMENT_LANES == 4
    const real_mask index = {0, 1, 2, 3};
#else
    const real_mask index = {0, 1};
#endif
    return index < count;
}

/* A bit of its own for each lane. */
static inline real_mask lane_bits(void)
{
#if ELEMENT_LANES == 16
    const real_mask bits = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
#elif ELEMENT_LANES == 8
    const real_mask bits = {1, 2, 4, 8, 16, 32, 64, 128};
#elif ELEMENT_LANES == 4
    const real_mask bits = {1, 2, 4, 8};
#else
    const real_mask bits = {1, 2};
#endif
    return bits;
}

/* True in the lanes from the first on. */
static inline real_mask lanes_from(int first)
{
    return ~first_lanes(first);
}

/* A component's corners, where the first stretch of a group begins in the first lane. */
static inline element_corners corners_at(const void *u, const int32_t *n)
{
    element_corners c = {{load(u, n[0]), load(u, n[1]), load(u, n[2]), load(u, n[3]), load(u, n[4]), load(u, n[5]),
                          load(u, n[6]), load(u, n[7])}};
    return c;
}

/* Lanes from a further stretch's first on become that stretch's. */
static inline void take_corners(element_corners *to, const void *u, const rows_stretch *s, real_mask mask)
{
    for (int c = 0; c < 8; c++)
        to->at[c] = REAL_SELECT(mask, load(u, s->node[c] - s->lane), to->at[c]);
}

/* A group's fibres. share: of the element that is the volume's tissue. which: ELEMENT_MUSCLE and so on, a constant. */
static inline element_fibre fibre_of(const cpu_work *w, const void *const along[3], const rows_group *group,
                                     int32_t volume, real share, int which)
{
    const double *curve = w->p->volume[volume].muscle;
    element_fibre fibre = {.tension = REAL_ZERO};
    if (which == ELEMENT_NO_MUSCLE)
        return fibre;
    fibre.along =
        (element_vector){load(along[0], group->cell), load(along[1], group->cell), load(along[2], group->cell)};
    fibre.tension = share * (real_one)kind_of(w, volume)->tension;
    if (which == ELEMENT_SERIAL_MUSCLE)
        fibre.series.stiffness = share * (real_one)curve[MUSCLE_SPRING];
    if (which == ELEMENT_CURVED_MUSCLE || which == ELEMENT_SERIAL_MUSCLE) {
        fibre.curves.less = REAL_ZERO + (real_one)curve[MUSCLE_LESS];
        fibre.curves.passive = share * (real_one)curve[MUSCLE_PASSIVE];
        fibre.curves.stiffening = REAL_ZERO + (real_one)curve[MUSCLE_STIFFENING];
        fibre.curves.straight = REAL_ZERO + (real_one)curve[MUSCLE_STRAIGHT];
    }
    return fibre;
}

static inline element_field moved_by(const cpu_work *w, const rows_group *group)
{
    const rows_stretch *s = w->r->stretch + group->stretch;
    element_field u = {corners_at(w->from[0], s->node), corners_at(w->from[1], s->node),
                       corners_at(w->from[2], s->node)};
    for (int i = 1; i < group->stretches; i++) {
        const real_mask mask = lanes_from(s[i].lane);
        take_corners(&u.x, w->from[0], &s[i], mask);
        take_corners(&u.y, w->from[1], &s[i], mask);
        take_corners(&u.z, w->from[2], &s[i], mask);
    }
    return u;
}

static inline void store_corners(real_one *to, const element_corners *f)
{
    for (int i = 0; i < 8; i++)
        store(to, i * LANES, f->at[i]);
}

/* The forces of a group, in their seat: for each component, corner by corner. */
static inline void store_field(real_one *to, const element_field *f)
{
    store_corners(to, &f->x);
    store_corners(to + 8 * LANES, &f->y);
    store_corners(to + 16 * LANES, &f->z);
}

static inline void keep_field(const cpu_work *w, const rows_group *group, const element_field *f)
{
    store_field((real_one *)w->force + (int64_t)group->seat * (24 * LANES), f);
}

/* Adds the forces of a block to its nodes, in the order of the lattice. */
static void add_forces(const cpu_work *w, const rows_block *block)
{
    const real_mask bits = lane_bits();
    for (const rows_sum *s = w->r->sum + block->sum; s < w->r->sum + block->sum + block->sums; s++) {
        real x = load(w->sum[0], s->node), y = load(w->sum[1], s->node), z = load(w->sum[2], s->node);
        for (const rows_term *t = w->r->term + s->term; t < w->r->term + s->term + s->terms; t++) {
            const real_mask mask = (bits & (int)t->bits) != 0;
            x = REAL_SELECT(mask, x + load(w->force, t->at), x);
            y = REAL_SELECT(mask, y + load(w->force, t->at + 8 * LANES), y);
            z = REAL_SELECT(mask, z + load(w->force, t->at + 16 * LANES), z);
        }
        store(w->sum[0], s->node, x);
        store(w->sum[1], s->node, y);
        store(w->sum[2], s->node, z);
    }
}

/* A volume's law, of what is tissue: as much of it as the form reads. In place: returned, it would be copied. */
static inline void law_of_kind(const cpu_kind *kind, real share, element_law *law)
{
    for (int i = 0; i < MODULI; i++)
        law->c[i] = share * (real_one)kind->law[i];
    for (int i = MODULI; i < COEFFICIENTS; i++)
        law->c[i] = real_of(kind->law[i]);
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        law->hourglass[i] = share * (real_one)kind->law[COEFFICIENTS + i];
}

/* Likewise that of cells that are mixed. */
static inline void law_of_cells(const cpu_work *w, int64_t cell, real share, element_law *law)
{
    for (int i = 0; i < MODULI; i++)
        law->c[i] = share * load(w->law[i], cell);
    for (int i = MODULI; i < COEFFICIENTS; i++)
        law->c[i] = load(w->law[i], cell);
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        law->hourglass[i] = share * load(w->law[COEFFICIENTS + i], cell);
}

static inline void group_forces(const cpu_work *w, const rows_group *group, element_shape shape, hourglass_kind control,
                                int which)
{
    const cpu_kind *kind = kind_of(w, group->volume);
    const real share =
        w->fraction ? load(w->fraction, group->cell) : REAL_ZERO + 1; /* forces are linear in all below */
    element_law law;
    law_of_kind(kind, share, &law);
    const element_fibre fibre = fibre_of(w, w->fibre, group, group->volume, share, which);
    const element_field f = element_force(THE_FORM, control, moved_by(w, group), shape, law, fibre, which);
    keep_field(w, group, &f);
}

/* Elements mixed of two volumes. */
static inline void mixed_forces(const cpu_work *w, const rows_group *group, element_shape shape, hourglass_kind control,
                                int which, int which_second)
{
    const real share = w->fraction ? load(w->fraction, group->cell) : REAL_ZERO + 1,
               part = load(w->mixture, group->cell);
    const real own = share * (1 - part), other = share * part;
    element_law law;
    law_of_cells(w, group->cell, share, &law);
    const element_fibre fibre = fibre_of(w, w->fibre, group, group->volume, own, which);
    const element_fibre second = fibre_of(w, w->mixfibre, group, group->mix, other, which_second);
    const element_field f =
        element_force_of_two(THE_FORM, control, moved_by(w, group), shape, law, fibre, which, second, which_second);
    keep_field(w, group, &f);
}

static inline void any_mixed_forces_of(const cpu_work *w, const rows_group *group, element_shape shape,
                                       hourglass_kind control)
{
    const bool active = w->fibre[0] && kind_of(w, group->volume)->tension != 0;
    const bool second = w->mixfibre[0] && kind_of(w, group->mix)->tension != 0;
    if (w->fibre[0] && w->mixfibre[0] && (is_curved(w, group->volume) || is_curved(w, group->mix)))
        mixed_forces(w, group, shape, control, ELEMENT_CURVED_MUSCLE, ELEMENT_CURVED_MUSCLE);
    else if (w->fibre[0] && is_curved(w, group->volume))
        mixed_forces(w, group, shape, control, ELEMENT_CURVED_MUSCLE, ELEMENT_NO_MUSCLE);
    else if (active && second)
        mixed_forces(w, group, shape, control, ELEMENT_MUSCLE, ELEMENT_MUSCLE);
    else if (active)
        mixed_forces(w, group, shape, control, ELEMENT_MUSCLE, ELEMENT_NO_MUSCLE);
    else if (second)
        mixed_forces(w, group, shape, control, ELEMENT_NO_MUSCLE, ELEMENT_MUSCLE);
    else
        mixed_forces(w, group, shape, control, ELEMENT_NO_MUSCLE, ELEMENT_NO_MUSCLE);
}

/* Apart from the loop, which is the faster without it. */
static __attribute__((noinline)) void any_mixed_forces(const cpu_work *w, const rows_group *group, element_shape shape)
{
    if (w->p->control.kind == HOURGLASS_PHYSICAL)
        any_mixed_forces_of(w, group, shape, HOURGLASS_PHYSICAL);
    else
        any_mixed_forces_of(w, group, shape, HOURGLASS_ISOTROPIC);
}

/* Elements of a muscle with curves of its own; likewise. */
static __attribute__((noinline)) void curved_forces(const cpu_work *w, const rows_group *group, element_shape shape)
{
    if (w->p->control.kind == HOURGLASS_PHYSICAL)
        group_forces(w, group, shape, HOURGLASS_PHYSICAL, ELEMENT_CURVED_MUSCLE);
    else
        group_forces(w, group, shape, HOURGLASS_ISOTROPIC, ELEMENT_CURVED_MUSCLE);
}

/* What of a volume's fibres in cells resists being stretched; share: of the cells, that is the volume's tissue. */
static inline fibre_set fibres_of(const cpu_work *w, int64_t cell, int32_t volume, const void *const along[3],
                                  const void *const family[FIBRE_FAMILIES][3], real share)
{
    fibre_set s = {.families = 0};
    if (!fibres_any(&w->p->fibres, volume) || !along[0])
        return s;
    const fibre_numbers *n = &w->p->fibres.of[volume];
    const fibre_invariants q = fibre_numbers_fung(n);
    s.families = fibre_numbers_families(n);
    s.is_fung = n->c > 0;
    s.law = (fibre_law){share * (real_one)n->k1, real_of(n->k2), real_of(n->kappa)};
    s.fung = (fibre_fung){share * (real_one)n->c, real_of(q.all), real_of(q.along), real_of(q.both)};
    s.along = (element_vector){load(along[0], cell), load(along[1], cell), load(along[2], cell)};
    for (int k = 0; k < s.families; k++)
        s.family[k] = (element_vector){load(family[k][0], cell), load(family[k][1], cell), load(family[k][2], cell)};
    return s;
}

/* ELEMENT_MUSCLE and so on. volume: -1 where an element has no such. */
static inline int muscle_of(const cpu_work *w, const void *const along[3], int32_t volume)
{
    if (volume < 0 || !along[0])
        return ELEMENT_NO_MUSCLE;
    if (is_serial(w, volume))
        return ELEMENT_SERIAL_MUSCLE;
    if (is_curved(w, volume))
        return ELEMENT_CURVED_MUSCLE;
    return kind_of(w, volume)->tension != 0 ? ELEMENT_MUSCLE : ELEMENT_NO_MUSCLE;
}

/* Whether a group has fibres that resist being stretched. */
static inline bool is_fibred(const cpu_work *w, const rows_group *group)
{
    return fibres_any(&w->p->fibres, group->volume) || fibres_any(&w->p->fibres, group->mix);
}

/* The moments of a group that is cut; 0 in its elements that are whole. */
static inline element_cut cut_of(const cpu_work *w, const rows_group *group)
{
    const int64_t at = (int64_t)group->cut * (6 * LANES);
    const element_cut c = {load(w->cut, at),
                           load(w->cut, at + LANES),
                           load(w->cut, at + 2 * LANES),
                           load(w->cut, at + 3 * LANES),
                           load(w->cut, at + 4 * LANES),
                           load(w->cut, at + 5 * LANES)};
    return c;
}

/* Contractile elements of a group, which go on by the step that this pass ends. Cells after its own are another's. */
static inline void contract(const cpu_work *w, const rows_group *group, int32_t volume, element_tensor h, real_one *at,
                            element_fibre *fibre)
{
    for (int lane = 0; lane < group->count; lane++)
        fibre->series.contractile[lane] = at[group->cell + lane];
    if (!(w->what & PASS_FINISH))
        return;
    fibre->series.contractile =
        element_contract(h, *fibre, real_of(tled_contractile_most(&w->p->volume[volume], w->dt)));
    for (int lane = 0; lane < group->count; lane++)
        at[group->cell + lane] = fibre->series.contractile[lane];
}

/* Those of both volumes. is_cut: as of any_forces_of. */
static inline void contract_both(const cpu_work *w, const rows_group *group, const element_field *u,
                                 element_shape shape, bool is_cut, element_fibre *fibre, element_fibre *second)
{
    const element_modes x = element_modes_of(u->x), y = element_modes_of(u->y), z = element_modes_of(u->z);
    const element_tensor h =
        is_cut ? element_cut_gradient(x, y, z, shape.slope, cut_of(w, group)) : element_gradient(x, y, z, shape.slope);
    if (is_serial(w, group->volume) && w->fibre[0])
        contract(w, group, group->volume, h, w->contractile, fibre);
    if (is_serial(w, group->mix) && w->mixfibre[0])
        contract(w, group, group->mix, h, w->mixcontractile, second);
}

/* Elements of any kind: cut ones, and those of which a volume has fibres that resist being stretched, or a muscle in
 * series with a spring. is_cut: a constant, as is control of those that are not. */
static inline void any_forces_of(const cpu_work *w, const rows_group *group, element_shape shape,
                                 hourglass_kind control, bool is_cut)
{
    const bool mixed = group->mix >= 0;
    const int which = muscle_of(w, w->fibre, group->volume), which_second = muscle_of(w, w->mixfibre, group->mix);
    const real share = w->fraction ? load(w->fraction, group->cell) : REAL_ZERO + 1;
    const real part = mixed ? load(w->mixture, group->cell) : REAL_ZERO, own = share * (1 - part), other = share * part;
    element_law law;
    if (mixed)
        law_of_cells(w, group->cell, share, &law);
    else
        law_of_kind(kind_of(w, group->volume), share, &law);
    const element_field u = moved_by(w, group);
    element_fibre fibre = fibre_of(w, w->fibre, group, group->volume, own, which);
    element_fibre second = fibre_of(w, w->mixfibre, group, mixed ? group->mix : group->volume, other, which_second);
    if (w->p->serial)
        contract_both(w, group, &u, shape, is_cut, &fibre, &second);
    const fibre_set sets[2] = {fibres_of(w, group->cell, group->volume, w->fibre, w->family, own),
                               fibres_of(w, group->cell, group->mix, w->mixfibre, w->mixfamily, other)};
    const int count = is_cut || is_fibred(w, group) ? 1 + mixed : 0;
    element_field f;
    if (is_cut)
        f = element_force_cut(THE_FORM, control, u, shape, law, fibre, which, second, which_second, sets, count,
                              cut_of(w, group));
    else
        f = element_force_fibred(THE_FORM, control, u, shape, law, fibre, which, second, which_second, sets, count);
    keep_field(w, group, &f);
}

static __attribute__((noinline)) void fibred_forces(const cpu_work *w, const rows_group *group, element_shape shape)
{
    if (w->p->control.kind == HOURGLASS_PHYSICAL)
        any_forces_of(w, group, shape, HOURGLASS_PHYSICAL, false);
    else
        any_forces_of(w, group, shape, HOURGLASS_ISOTROPIC, false);
}

/* Cut elements of a volume that has a law alone. control: a constant. */
static inline void plain_cut_forces(const cpu_work *w, const rows_group *group, element_shape shape,
                                    hourglass_kind control)
{
    const real share = load(w->fraction, group->cell);
    element_law law;
    law_of_kind(kind_of(w, group->volume), share, &law);
    const element_field f =
        element_force_cut_plain(THE_FORM, control, moved_by(w, group), shape, &law, cut_of(w, group));
    keep_field(w, group, &f);
}

static __attribute__((noinline)) void cut_forces(const cpu_work *w, const rows_group *group, element_shape shape)
{
    const bool fibred = w->p->fibres.of && fibres_any(&w->p->fibres, group->volume);
    if (fibred || group->mix >= 0 || muscle_of(w, w->fibre, group->volume) != ELEMENT_NO_MUSCLE)
        any_forces_of(w, group, shape, w->p->control.kind, true);
    else if (w->p->control.kind == HOURGLASS_PHYSICAL)
        plain_cut_forces(w, group, shape, HOURGLASS_PHYSICAL);
    else
        plain_cut_forces(w, group, shape, HOURGLASS_ISOTROPIC);
}

/* The borders of a group of laminates; bulk moduli are its volumes'. by: the share of the element that counts. */
static inline element_laminate laminate_at(const cpu_work *w, const rows_group *group, real by)
{
    real n[LAMINATE_NUMBERS];
    for (int k = 0; k < LAMINATE_NUMBERS; k++)
        n[k] = load(w->border, ((int64_t)group->border * LAMINATE_NUMBERS + k) * LANES);
    const real *c = n + LAMINATE_SECOND, *a = n + LAMINATE_WHOLE, *k = n + LAMINATE_KINK;
    const element_laminate l = {
        {n[0], n[1], n[2]},
        {c[0], c[1], c[2], c[3], c[4], c[5]},
        {a[0], a[1], a[2], a[3], a[4], a[5]},
        load(w->mixture, group->cell),
        {k[0], k[1], k[2], k[3]},
        {by * (real_one)w->p->volume[group->volume].law.bulk, by * (real_one)w->p->volume[group->mix].law.bulk}};
    return l;
}

static __attribute__((noinline)) void laminate_forces(const cpu_work *w, const rows_group *group, element_shape shape)
{
    const int which = muscle_of(w, w->fibre, group->volume), which_second = muscle_of(w, w->mixfibre, group->mix);
    const real by = w->fraction ? load(w->fraction, group->cell) : REAL_ZERO + 1;
    const element_laminate l = laminate_at(w, group, by);
    const real own = by * (1 - l.share), other = by * l.share;
    element_law law, first, second;
    law_of_cells(w, group->cell, by, &law);
    law_of_kind(kind_of(w, group->volume), own, &first);
    law_of_kind(kind_of(w, group->mix), other, &second);
    const element_field u = moved_by(w, group);
    element_fibre fibre = fibre_of(w, w->fibre, group, group->volume, own, which);
    element_fibre along = fibre_of(w, w->mixfibre, group, group->mix, other, which_second);
    if (w->p->serial)
        contract_both(w, group, &u, shape, w->cut && group->cut >= 0, &fibre, &along);
    const fibre_set sets[2] = {fibres_of(w, group->cell, group->volume, w->fibre, w->family, own),
                               fibres_of(w, group->cell, group->mix, w->mixfibre, w->mixfamily, other)};
    const element_field f =
        element_force_laminate(THE_FORM, w->p->control.kind, u, shape, law, first.c, second.c, fibre, which, along,
                               which_second, sets, is_fibred(w, group) ? 2 : 0, &l);
    keep_field(w, group, &f);
}

/* One component of a node that the script displaces or pushes. */
static void move_extra(const cpu_work *w, int64_t at, int64_t n, int a, node_factors k)
{
    const tled_problem *p = w->p;
    const int32_t hold = p->hold[3 * n + a];
    real_one *sum = (real_one *)w->sum[a] + at, *v = (real_one *)w->velocity[a] + at, *to = (real_one *)w->to[a] + at;
    real_one u = ((const real_one *)w->from[a])[at], net = -*sum, acceleration = 0;
    if (w->what & PASS_INTERNAL)
        *to = *sum;
    *sum = 0;
    for (int32_t i = p->force_start[n]; i < p->force_start[n + 1]; i++)
        net += (real_one)loads_entry(p, i, w->now, a, (double)u);
    if (hold == HOLD_FREE)
        acceleration = (p->gravity < 0 ? 0 : (real_one)w->now[3 * p->gravity + a]) *
                           (w->weight ? ((const real_one *)w->weight)[at] : 1) +
                       net * ((const real_one *)w->mass_inverse)[at];
    if (hold == HOLD_FREE && w->what & PASS_FINISH)
        *v = *v * k.keep + k.half * acceleration;
    if (!(w->what & PASS_BEGIN))
        return;
    if (hold == HOLD_FREE) {
        *v = (*v + k.half * acceleration) * k.slow;
        u += k.dt * *v;
    } else if (hold >= 0) {
        real_one end = (real_one)moves_to(w->next, hold, a, p->position + 3 * n);
        *v = (end - u) / k.dt;
        u = end;
    }
    *to = u;
}

/* One component of a block's nodes, but for its extras. */
static inline void move_nodes(const cpu_work *w, const rows_block *l, int a, node_factors k)
{
    const real_one gravity = w->p->gravity < 0 ? 0 : (real_one)w->now[3 * w->p->gravity + a];
    const bool finish = w->what & PASS_FINISH, begin = w->what & PASS_BEGIN, internal = w->what & PASS_INTERNAL;
    for (int32_t i = 0; i < l->nodes; i += LANES) {
        const int64_t at = l->node + i;
        real_bits flags = {0};
        for (int lane = 0; lane < LANES; lane++)
            flags[lane] = w->flags[at + lane];
        const real_mask bits = REAL_CONVERT(flags, real_mask);
        const real_mask mine = first_lanes(l->nodes - i) & ((bits & NODE_EXTRA) == 0);
        const real_mask free = mine & ((bits & (NODE_FREE << a)) != 0);
        const real sum = load(w->sum[a], at), old = load(w->velocity[a], at), u = load(w->from[a], at);
        const real push = -sum * load(w->mass_inverse, at);
        const real acceleration = w->weight ? gravity * load(w->weight, at) + push : gravity + push;
        real v = old, to = load(w->to[a], at);
        if (finish)
            v = REAL_SELECT(free, node_finish(v, acceleration, k), v);
        if (begin) {
            v = REAL_SELECT(free, node_begin(v, acceleration, k), v);
            to = REAL_SELECT(free, u + k.dt * v, REAL_SELECT(mine, u, to));
        }
        if (internal)
            to = REAL_SELECT(mine, sum, to);
        store(w->velocity[a], at, v);
        store(w->to[a], at, to);
        store(w->sum[a], at, REAL_SELECT(mine, REAL_ZERO, sum));
    }
}

/* The forces of a block's elements; control: a constant. */
static inline void block_forces(const cpu_work *w, const rows_block *l, element_shape shape, hourglass_kind control)
{
    const bool fibred = w->p->fibres.of, serial = w->p->serial;
    for (const rows_group *group = w->r->group + l->group; group < w->r->group + l->group + l->groups; group++)
        if (w->border && group->border >= 0)
            laminate_forces(w, group, shape);
        else if (w->cut && group->cut >= 0)
            cut_forces(w, group, shape);
        else if ((fibred && is_fibred(w, group)) ||
                 (serial && (is_serial(w, group->volume) || is_serial(w, group->mix))))
            fibred_forces(w, group, shape);
        else if (group->mix >= 0)
            any_mixed_forces(w, group, shape);
        else if (w->fibre[0] && is_curved(w, group->volume))
            curved_forces(w, group, shape);
        else if (w->fibre[0] && kind_of(w, group->volume)->tension != 0)
            group_forces(w, group, shape, control, ELEMENT_MUSCLE);
        else
            group_forces(w, group, shape, control, ELEMENT_NO_MUSCLE);
}

static void slab_pass(const cpu_work *w, int32_t which)
{
#ifdef ELEMENT_SINGLE /* whose smallest normal number tissue far from all that moves soon comes to */
    const unsigned before = flush_small();
#endif
    const rows *r = w->r;
    const rows_slab *s = &r->slab[which];
    const element_shape shape = element_box(w->p->side[0], w->p->side[1], w->p->side[2]);
    const node_factors k = node_factors_of(w->dt, w->damping);
    int32_t extra = s->extra;
    for (const rows_block *l = r->block + s->block; l < r->block + s->block + s->blocks; l++) {
        if (w->p->control.kind == HOURGLASS_PHYSICAL)
            block_forces(w, l, shape, HOURGLASS_PHYSICAL);
        else
            block_forces(w, l, shape, HOURGLASS_ISOTROPIC);
        add_forces(w, l);
        for (; extra < s->extra + s->extras && r->extra[extra] < l->node + l->nodes; extra++)
            for (int a = 0; a < 3; a++)
                move_extra(w, r->extra[extra], r->extra_node[extra], a, k);
        for (int a = 0; a < 3; a++)
            move_nodes(w, l, a, k);
    }
#ifdef ELEMENT_SINGLE
    flush_as(before);
#endif
}

#include "tled/cpu/cpu_mesh_lanes.h"

const cpu_pass CPU_PASS = {VECTORS_NAME, LANES, slab_pass, mesh_elements, mesh_nodes};
