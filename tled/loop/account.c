#include "tled/loop/account.h"

#include "base/clock.h"
#include "base/mem.h"
#include "tled/contact/sliding.h"
#include "tled/problem/collider.h"
#include "tled/problem/film_strain.h"
#include "tled/problem/followers.h"
#include "tled/problem/muscle_fibre.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = STRAINED_CHUNK }; /* elements, or nodes */

/* What is known of one moment. */
typedef struct moment {
    bool known;
    double *displacement, *internal, *push; /* nodes x 3; push: NULL without a probe */
    double *pressed;                        /* likewise, N: by pressures; NULL without */
    sliding_load *bone;                     /* nodes that slide: what bone does to them; NULL without */
    double *stretch, *pull; /* elements x 2: of either fibre, and of springs in series, Pa; NULL without muscles */
    element_tensor *film;   /* films, Pa: their stress; NULL without, as is: */
    double *film_stretch;   /* films x 2: as stretch */
    double *curves;
    double driven; /* J: kinetic energy where displacements are prescribed */
    double first;  /* J: held at the first reading */
    account_sums sums;
} moment;

struct account_part { /* of one chunk: sums, largest values as squares */
    account_sums sum;
    double driven, mass;
};

struct account {
    const tled_problem *p;
    bool has_muscles;
    pool *threads;
    moment now, before, saved;
    double *velocity;
    double *contractile[2]; /* elements: of now; or NULL */
    struct account_part *part;
    strained_view view; /* of now */
    probe_placed probe; /* of now */
    followers_work followers;
};

static double stretch_of(const float *along, int64_t i, element_tensor h)
{
    const element_vector a = {along[3 * i], along[3 * i + 1], along[3 * i + 2]};
    return element_length(element_fibre_now(h, a));
}

/* The work (J) of the muscle that the volume is while a fibre's stretch changes, since the moment before. rest (m3): of
 * the tissue that is its. */
static double tension_work(const account *a, int32_t volume, double was, double is, double rest)
{
    const tled_problem *p = a->p;
    const double tension = (tled_tension(p, volume, a->before.curves) + tled_tension(p, volume, a->now.curves)) / 2;
    if (tension == 0)
        return 0;
    const double more = 1 + p->volume[volume].muscle[MUSCLE_LESS]; /* 1/optimum */
    return -rest * tension / more * (muscle_force_length_sum(is * more) - muscle_force_length_sum(was * more));
}

/* Along one of an element's fibres. */
static double muscle_work(const account *a, int64_t i, int fibre, int32_t volume, double rest)
{
    const double was = a->before.stretch[2 * i + fibre], is = a->now.stretch[2 * i + fibre];
    if (a->p->volume[volume].serial)
        return -rest * (a->before.pull[2 * i + fibre] + a->now.pull[2 * i + fibre]) / 2 * (is - was);
    return tension_work(a, volume, was, is, rest);
}

/* What the spring of a muscle pulls with, Pa, of the muscle alone. */
static double pull_of(const account *a, int64_t i, int fibre, int32_t volume, const float *along, element_tensor h)
{
    const muscle_series s = {a->p->volume[volume].muscle[MUSCLE_SPRING], a->contractile[fibre][i]};
    const element_vector at = {along[3 * i], along[3 * i + 1], along[3 * i + 2]};
    return muscle_spring(s, element_fibre_strain(h, at, a->now.stretch[2 * i + fibre]));
}

static void add_muscles(account *a, int64_t i, const deformed *d, account_sums *sum)
{
    const tled_problem *p = a->p;
    const float *const along[2] = {p->fibre, p->mixfibre};
    const int32_t volume[2] = {p->element_volume[i], tled_mix(p, i)};
    const double share[2] = {1 - tled_mixture(p, i), tled_mixture(p, i)};
    for (int k = 0; k < 2; k++) {
        if (!along[k] || volume[k] < 0 || (p->volume[volume[k]].contract < 0 && !p->volume[volume[k]].serial))
            continue;
        a->now.stretch[2 * i + k] = stretch_of(along[k], i, d->h);
        if (p->volume[volume[k]].serial)
            a->now.pull[2 * i + k] = pull_of(a, i, k, volume[k], along[k], d->h);
        if (a->before.known)
            sum->muscles += muscle_work(a, i, k, volume[k], tled_fraction(p, i) * share[k] * d->rest);
    }
}

static void add_element(account *a, int64_t i, element_shape box, account_sums *sum)
{
    const deformed d = deformed_of(a->p, i, box, a->now.displacement);
    strained_add(&sum->tissue, &a->view, i, &d);
    if (a->now.stretch)
        add_muscles(a, i, &d, sum);
    if (a->has_muscles)
        sum->falling += muscle_fibre_falls(a->p, i, a->now.curves, d.h, d.law.mu);
}

/* What muscles in a film did. */
static double film_muscles(account *a, int64_t i, element_tensor h)
{
    const tled_problem *p = a->p;
    const int64_t element = p->films->rows.element[i];
    const float *const along[2] = {p->fibre, p->mixfibre};
    const int32_t volume[2] = {p->element_volume[element], tled_mix(p, element)};
    const double share[2] = {1 - tled_mixture(p, element), tled_mixture(p, element)};
    const double rest = p->films->rows.area[i] * p->films->rows.depth[i];
    double sum = 0;
    for (int k = 0; k < 2; k++) {
        if (!along[k] || volume[k] < 0 || p->volume[volume[k]].contract < 0)
            continue;
        a->now.film_stretch[2 * i + k] = stretch_of(along[k], element, h);
        if (a->before.known)
            sum += tension_work(a, volume[k], a->before.film_stretch[2 * i + k], a->now.film_stretch[2 * i + k],
                                rest * share[k]);
    }
    return sum;
}

/* What the bone did to a film as it moved, since the moment before: while its element stays, the film's gradient
 * changes by d((R - I)(I + n n)/2) - du n/d. */
static double bone_work(const account *a, int64_t i)
{
    const films *f = a->p->films;
    const double *n = f->rows.normal + 3 * i;
    const element_tensor *s = &a->before.film[i], *t = &a->now.film[i];
    const double stress[3][3] = {{s->xx + t->xx, s->xy + t->xy, s->xz + t->xz},
                                 {s->yx + t->yx, s->yy + t->yy, s->yz + t->yz},
                                 {s->zx + t->zx, s->zy + t->zy, s->zz + t->zz}};
    const film_bone was = films_bone(a->p, i, a->before.curves), is = films_bone(a->p, i, a->now.curves);
    double sum = 0;
    for (int r = 0; r < 3; r++) {
        const double way = (is.u[r] - was.u[r]) / f->rows.depth[i];
        double along = 0;
        for (int k = 0; k < 3; k++)
            along += (is.turn[r][k] - was.turn[r][k]) * n[k];
        for (int k = 0; k < 3; k++)
            sum += stress[r][k] * ((is.turn[r][k] - was.turn[r][k] + along * n[k]) / 2 - way * n[k]);
    }
    return f->rows.area[i] * f->rows.depth[i] * sum / 2;
}

static void read_films(account *a)
{
    const tled_problem *p = a->p;
    for (int64_t i = 0; i < films_count(p); i++) {
        const int32_t *node = p->element_node + 8 * (int64_t)p->films->rows.element[i];
        const element_tensor h = films_gradient(p, i, a->now.displacement, node, a->now.curves);
        a->now.film[i] = films_stress(p, i, h, a->now.curves);
        a->now.sums.tissue.strain += films_energy(p, i, h);
        if (a->now.film_stretch)
            a->now.sums.muscles += film_muscles(a, i, h);
        if (a->before.known)
            a->now.sums.held += bone_work(a, i);
    }
}

static void element_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    account *a = context;
    account_sums sum = {.tissue = strained_none()};
    const element_shape shape = element_box(a->p->side[0], a->p->side[1], a->p->side[2]);
    for (int64_t i = from; i < to; i++)
        add_element(a, i, shape, &sum);
    a->part[chunk].sum = sum;
}

static void sum_elements(account *a)
{
    account_sums *to = &a->now.sums;
    for (int64_t c = 0; c < pool_chunks(a->p->elements, CHUNK); c++) {
        strained_join(&to->tissue, &a->part[c].sum.tissue);
        to->muscles += a->part[c].sum.muscles;
        to->falling += a->part[c].sum.falling;
    }
}

/* What acts on a node at a moment, N. */
typedef struct node_load {
    double gravity[3], forces[3];
} node_load;

static node_load load_of(const tled_problem *p, const moment *m, int64_t n)
{
    node_load load = {{0}, {0}};
    tled_external(p, m->curves, m->displacement + 3 * n, n, load.forces);
    for (int a = 0; a < 3 && p->gravity >= 0; a++) {
        load.gravity[a] = tled_weight(p, n) * m->curves[3 * p->gravity + a];
        load.forces[a] -= load.gravity[a];
    }
    return load;
}

static void find_push(account *a, int64_t n)
{
    const tled_problem *p = a->p;
    double x[3], *push = a->now.push + 3 * n;
    for (int k = 0; k < 3; k++) {
        x[k] = p->position[3 * n + k] + a->now.displacement[3 * n + k];
        push[k] = 0;
    }
    if (!collider_push(p->collider, &a->probe, collider_up(p->collider, a->now.sums.time), x, p->mass[n], push))
        memset(push, 0, 3 * sizeof *push);
}

/* What a component of a node did since the moment before. What displaces it works against the elements' pulls and for
 * what else pushes it; the energy of its motion, and what damping takes of it, come in account_read. */
static void work_of(const account *a, int64_t i, const node_load *was, const node_load *is, account_sums *sum)
{
    const int axis = (int)(i % 3);
    const double way = a->now.displacement[i] - a->before.displacement[i];
    const double gravity = (was->gravity[axis] + is->gravity[axis]) / 2 * way;
    const double forces = (was->forces[axis] + is->forces[axis]) / 2 * way;
    const double push = a->now.push ? (a->before.push[i] + a->now.push[i]) / 2 * way : 0;
    const double pressed = a->now.pressed ? (a->before.pressed[i] + a->now.pressed[i]) / 2 * way : 0;
    sum->gravity += gravity;
    sum->forces += forces + pressed;
    if (a->p->hold[i] >= 0) /* internal forces are less by what is in them: push, and what pressures do */
        sum->held += (a->before.internal[i] + a->now.internal[i]) / 2 * way + push - gravity - forces;
    else
        sum->probe += push;
}

/* Where displacements are those of now. */
static void find_pressed(account *a)
{
    const followers *f = a->p->followers;
    followers_move(&a->followers, a->now.displacement);
    followers_press(&a->followers, a->threads, a->now.curves);
    for (int64_t i = 0; i < f->nodes; i++)
        followers_pull(&a->followers, i, a->now.pressed + 3 * (int64_t)f->node[i]);
}

/* What bone does to a node that slides, and did since the moment before; less of net (3, N) is then left. */
static void slide(account *a, int64_t n, double net[3], account_sums *sum)
{
    const int32_t row = a->p->sliding->row[n];
    sliding_load *load = &a->now.bone[row];
    *load = sliding_load_at(a->p, row, a->now.curves, a->now.displacement, net);
    for (int i = 0; i < 3; i++)
        net[i] += load->normal[i] + load->stuck[i];
    if (!a->before.known)
        return;
    const sliding_moment was = {a->before.curves, a->before.displacement, &a->before.bone[row]};
    const sliding_moment is = {a->now.curves, a->now.displacement, load};
    sum->held += sliding_work(a->p, row, &was, &is);
}

static void add_node(account *a, int64_t n, struct account_part *part)
{
    const tled_problem *p = a->p;
    const double mass = p->mass[n];
    const node_load is = load_of(p, &a->now, n);
    const node_load was = a->before.known ? load_of(p, &a->before, n) : is;
    double way = 0, speed = 0, net[3];
    if (p->collider)
        find_push(a, n);
    for (int i = 0; i < 3; i++)
        net[i] = is.gravity[i] + is.forces[i] - a->now.internal[3 * n + i];
    if (p->sliding && p->sliding->row[n] >= 0)
        slide(a, n, net, &part->sum);
    for (int64_t i = 3 * n; i < 3 * n + 3; i++) {
        const double gap = net[i % 3];
        const double square = a->velocity[i] * a->velocity[i];
        part->sum.acceleration += p->hold[i] == HOLD_FREE ? gap * gap / mass : 0;
        part->driven += p->hold[i] >= 0 ? mass * square / 2 : 0;
        way += a->now.displacement[i] * a->now.displacement[i];
        speed += square;
        if (a->before.known)
            work_of(a, i, &was, &is, &part->sum);
    }
    part->mass += mass;
    part->sum.kinetic += mass * speed / 2;
    part->sum.displacement = fmax(part->sum.displacement, way);
    part->sum.speed = fmax(part->sum.speed, speed);
}

static void node_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    account *a = context;
    struct account_part part = {0};
    for (int64_t n = from; n < to; n++)
        add_node(a, n, &part);
    a->part[chunk] = part;
}

/* Adds what the chunks found to what is known: energies are of now, work adds up. */
static double sum_nodes(account *a, double *mass)
{
    account_sums *to = &a->now.sums;
    double driven = 0;
    for (int64_t c = 0; c < pool_chunks(a->p->nodes, CHUNK); c++) {
        const struct account_part *part = &a->part[c];
        const account_sums *s = &part->sum;
        to->kinetic += s->kinetic;
        to->gravity += s->gravity;
        to->forces += s->forces;
        to->held += s->held;
        to->probe += s->probe;
        to->acceleration += s->acceleration;
        to->displacement = fmax(to->displacement, s->displacement);
        to->speed = fmax(to->speed, s->speed);
        driven += part->driven;
        *mass += part->mass;
    }
    return driven;
}

static account_past past_of(const moment *m)
{
    const account_sums *s = &m->sums;
    return (account_past){m->first, s->gravity, s->forces, s->held, s->muscles, s->probe, s->damping};
}

static void set_past(moment *m, const account_past *past)
{
    account_sums *s = &m->sums;
    m->first = past->first;
    s->gravity = past->gravity;
    s->forces = past->forces;
    s->held = past->held;
    s->muscles = past->muscles;
    s->probe = past->probe;
    s->damping = past->damping;
}

/* Work goes on from the moment before; the rest begins at nothing. */
static void begin_sums(account *a, double time)
{
    const account_past past = a->before.known ? past_of(&a->before) : (account_past){0};
    a->now.sums = (account_sums){.time = time, .tissue = strained_none()};
    set_past(&a->now, &past);
}

/* Damping takes alpha m v^2: twice alpha times the kinetic energy. */
static void close_sums(account *a, double damping, double mass)
{
    account_sums *s = &a->now.sums;
    const moment *before = &a->before;
    const double held = s->kinetic + s->tissue.strain + s->tissue.hourglass;
    if (before->known) {
        const double span = damping * (s->time - before->sums.time);
        s->damping += span * (before->sums.kinetic + s->kinetic);
        s->held += a->now.driven - before->driven + span * (before->driven + a->now.driven);
    }
    if (!before->known)
        a->now.first = held;
    s->balance = held - a->now.first - s->gravity - s->forces - s->held - s->muscles - s->probe + s->damping;
    s->displacement = sqrt(s->displacement);
    s->speed = sqrt(s->speed);
    s->acceleration = sqrt(s->acceleration / mass);
    a->now.known = true;
}

const account_sums *account_read(account *a, const tled_executor *b, tled_state *state, double time, double damping,
                                 double *there, err *e)
{
    const tled_problem *p = a->p;
    const moment swap = a->before;
    double mass = 0;
    a->before = a->now;
    a->now = swap;
    if (b->get(state, TLED_DISPLACEMENT, a->now.displacement, e) || b->get(state, TLED_VELOCITY, a->velocity, e) ||
        b->get(state, TLED_INTERNAL, a->now.internal, e))
        return NULL;
    for (int i = TLED_CONTRACTILE; i < p->fields.count; i++)
        if (b->get(state, i, a->contractile[i - TLED_CONTRACTILE], e))
            return NULL;
    *there = clock_now();
    begin_sums(a, time);
    tled_curves(p, time, a->now.curves);
    if (p->collider)
        a->probe = collider_at(p->collider, time);
    if (p->followers)
        find_pressed(a);
    a->view = strained_view_of(p, a->now.displacement, a->before.sums.tissue.quality.element);
    pool_run(a->threads, p->elements, CHUNK, element_work, a);
    sum_elements(a);
    read_films(a);
    pool_run(a->threads, p->nodes, CHUNK, node_work, a);
    a->now.driven = sum_nodes(a, &mass);
    close_sums(a, damping, mass);
    return &a->now.sums;
}

bodies_state account_bodies(const account *a)
{
    const bodies_state now = {account_curves(a), a->now.displacement, {a->contractile[0], a->contractile[1]}};
    return now;
}

const double *account_displacement(const account *a)
{
    return a->now.displacement;
}

const double *account_curves(const account *a)
{
    return a->now.curves;
}

/* Copies what `from` knows; both have arrays of their own. */
static void copy_moment(const tled_problem *p, const moment *from, moment *to)
{
    const size_t size = 3 * (size_t)p->nodes * sizeof(double);
    const moment own = *to;
    *to = *from;
    to->displacement = own.displacement;
    to->internal = own.internal;
    to->push = own.push;
    to->pressed = own.pressed;
    to->stretch = own.stretch;
    to->pull = own.pull;
    to->curves = own.curves;
    to->film = own.film;
    to->bone = own.bone;
    to->film_stretch = own.film_stretch;
    memcpy(to->displacement, from->displacement, size);
    memcpy(to->internal, from->internal, size);
    memcpy(to->curves, from->curves, 3 * (size_t)p->script->curves * sizeof(double));
    if (to->push)
        memcpy(to->push, from->push, size);
    if (to->pressed)
        memcpy(to->pressed, from->pressed, size);
    if (to->bone)
        memcpy(to->bone, from->bone, (size_t)p->sliding->count * sizeof *to->bone);
    if (to->film)
        memcpy(to->film, from->film, (size_t)films_count(p) * sizeof *to->film);
    if (to->film_stretch)
        memcpy(to->film_stretch, from->film_stretch, 2 * (size_t)films_count(p) * sizeof(double));
    if (to->stretch)
        memcpy(to->stretch, from->stretch, 2 * (size_t)p->elements * sizeof(double));
    if (to->pull)
        memcpy(to->pull, from->pull, 2 * (size_t)p->elements * sizeof(double));
}

void account_save(account *a)
{
    copy_moment(a->p, &a->now, &a->saved);
}

void account_restore(account *a)
{
    copy_moment(a->p, &a->saved, &a->now);
}

account_past account_past_of(const account *a)
{
    return past_of(&a->now);
}

int account_resume(account *a, const tled_executor *b, tled_state *state, double time, const account_past *past, err *e)
{
    double there;
    if (!account_read(a, b, state, time, 0, &there, e))
        return -1;
    set_past(&a->now, past);
    account_save(a);
    return 0;
}

static bool contracts(const tled_problem *p)
{
    for (int32_t i = 0; i < p->volumes; i++)
        if (p->volume[i].contract >= 0)
            return true;
    return false;
}

bool account_has_muscles(const tled_problem *p)
{
    return p->fibre && (p->curved || contracts(p));
}

static int make_numbers(int64_t rows, int columns, double **to, err *e)
{
    *to = mem_array(rows, columns * sizeof **to, "the log", e);
    return *to ? 0 : -1;
}

static int make_moment(const tled_problem *p, moment *m, err *e)
{
    if (make_numbers(p->nodes, 3, &m->displacement, e) || make_numbers(p->nodes, 3, &m->internal, e) ||
        make_numbers(p->script->curves, 3, &m->curves, e))
        return -1;
    if (p->collider && make_numbers(p->nodes, 3, &m->push, e))
        return -1;
    if (p->followers && make_numbers(p->nodes, 3, &m->pressed, e))
        return -1;
    if (p->sliding && !(m->bone = mem_array(p->sliding->count, sizeof *m->bone, "the log", e)))
        return -1;
    if (p->films && !(m->film = mem_array(films_count(p), sizeof *m->film, "the log", e)))
        return -1;
    if (p->films && contracts(p) && make_numbers(films_count(p), 2, &m->film_stretch, e))
        return -1;
    if (p->serial && make_numbers(p->elements, 2, &m->pull, e))
        return -1;
    return p->serial || contracts(p) ? make_numbers(p->elements, 2, &m->stretch, e) : 0;
}

static void free_moment(moment *m)
{
    free(m->film);
    free(m->bone);
    free(m->film_stretch);
    free(m->displacement);
    free(m->internal);
    free(m->curves);
    free(m->push);
    free(m->pressed);
    free(m->stretch);
    free(m->pull);
}

account *account_create(const tled_problem *p, pool *threads, err *e)
{
    const int64_t most = p->elements > p->nodes ? p->elements : p->nodes;
    account *a = mem_array(1, sizeof *a, "the log", e);
    if (!a)
        return NULL;
    a->p = p;
    a->threads = threads;
    a->has_muscles = account_has_muscles(p);
    a->velocity = mem_array(p->nodes, 3 * sizeof(double), "the log", e);
    a->part = mem_array(pool_chunks(most, CHUNK), sizeof *a->part, "the log", e);
    for (int i = TLED_CONTRACTILE; i < p->fields.count; i++)
        if (make_numbers(p->elements, 1, &a->contractile[i - TLED_CONTRACTILE], e)) {
            account_destroy(a);
            return NULL;
        }
    if (!a->velocity || !a->part || make_moment(p, &a->now, e) || make_moment(p, &a->before, e) ||
        make_moment(p, &a->saved, e) || followers_room(&a->followers, p->followers, e)) {
        account_destroy(a);
        return NULL;
    }
    return a;
}

void account_destroy(account *a)
{
    if (!a)
        return;
    free_moment(&a->now);
    free_moment(&a->before);
    free_moment(&a->saved);
    followers_room_free(&a->followers);
    free(a->velocity);
    free(a->contractile[0]);
    free(a->contractile[1]);
    free(a->part);
    free(a);
}
