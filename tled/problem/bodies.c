#include "tled/problem/bodies.h"

#include "base/mem.h"
#include "mesh/fibre_sets.h"
#include "physics/element.h"
#include "physics/element_cut.h"
#include "place/pose_fit.h"
#include "tled/problem/conforming_step.h"
#include "tled/problem/cut.h"
#include "tled/problem/film_strain.h"
#include "tled/problem/followers.h"
#include "tled/problem/muscle_fibre.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK = 512 }; /* elements */

/* ---- which nodes and elements */

static int list_nodes(bodies *b, int64_t nodes, err *e)
{
    b->start = mem_array((int64_t)b->count + 1, sizeof *b->start, "the bodies", e);
    b->node = b->start ? mem_array(nodes, sizeof *b->node, "the bodies", e) : NULL;
    if (!b->node)
        return -1;
    int64_t count = 0;
    for (int32_t i = 0; i < b->count; i++) {
        b->start[i] = count;
        for (int64_t n = 0; n < nodes; n++)
            if (b->of && b->of[n] == i)
                b->node[count++] = (int32_t)n;
    }
    b->start[b->count] = count;
    return 0;
}

static bool touches(const tled_problem *p, const bodies *b, int64_t element)
{
    for (int i = 0; i < 8; i++)
        if (b->of && b->of[p->element_node[8 * element + i]] >= 0)
            return true;
    return false;
}

static int list_elements(const tled_problem *p, bodies *b, err *e)
{
    b->element = mem_array(p->elements, sizeof *b->element, "the bodies", e);
    for (int64_t i = 0; b->element && i < p->elements; i++)
        if (touches(p, b, i))
            b->element[b->elements++] = (int32_t)i;
    return b->element ? 0 : -1;
}

int bodies_make(tled_problem *p, const model *m, err *e)
{
    const model_array *of = model_find(m, "node.body"), *name = model_find(m, "body.name");
    if (!of || !name || !name->rows)
        return 0;
    p->bodies = mem_array(1, sizeof *p->bodies, "the bodies", e);
    if (!p->bodies)
        return -1;
    p->bodies->count = (int32_t)name->rows;
    p->bodies->of = p->films ? NULL : of->i32; /* bone that films hang on has no nodes */
    return list_nodes(p->bodies, p->nodes, e) || list_elements(p, p->bodies, e) ? -1 : 0;
}

void bodies_free(bodies *b)
{
    if (!b)
        return;
    free(b->start);
    free(b->node);
    free(b->element);
    free(b);
}

/* ---- forces of an element */

static element_field field_at(const tled_problem *p, int64_t element, const double *displacement)
{
    element_field u;
    for (int i = 0; i < 8; i++) {
        const double *at = displacement + 3 * (int64_t)p->element_node[8 * element + i];
        u.x.at[i] = at[0];
        u.y.at[i] = at[1];
        u.z.at[i] = at[2];
    }
    return u;
}

static element_law law_at(form f, const tled_law *of, const double *hourglass, double share)
{
    element_law law = {{0}, {0}};
    for (int i = 0; i < FORM_NUMBERS; i++)
        law.c[i] = (i < form_moduli(f) ? share : 1) * of->c[i];
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        law.hourglass[i] = share * hourglass[i];
    return law;
}

/* What of an element's fibres resists being stretched, of what of it is tissue. */
static fibre_sets sets_at(const tled_problem *p, int64_t element)
{
    fibre_sets to = fibre_sets_at(&p->fibres, element);
    for (int i = 0; i < to.count; i++) {
        to.of[i].law.k1 *= tled_fraction(p, element);
        to.of[i].fung.c *= tled_fraction(p, element);
    }
    return to;
}

/* The muscle of a volume in an element, the second that it is mixed of or its own; share: of the element. */
static element_fibre muscle_at(const tled_problem *p, const bodies_state *now, int64_t element, bool is_second,
                               int32_t volume, double share)
{
    element_fibre muscle = muscle_fibre_of(p, is_second ? p->mixfibre : p->fibre, element, volume, share, now->value);
    if (now->contractile[is_second])
        muscle.series.contractile = now->contractile[is_second][element];
    return muscle;
}

/* What an element pulls its corners with. */
static element_field pull_of(const tled_problem *p, int64_t element, const bodies_state *now)
{
    const double share = tled_fraction(p, element), mixture = tled_mixture(p, element);
    const int32_t mix = tled_mix(p, element);
    const tled_law of = tled_law_of(p, element);
    const element_field u = field_at(p, element, now->displacement);
    const fibre_sets sets = sets_at(p, element);
    const element_fibre own = muscle_at(p, now, element, false, p->element_volume[element], share * (1 - mixture));
    if (p->conforming) {
        const conforming_hold hold = conforming_hold_of(p, element);
        const element_any shape = conforming_shape(p, element, &hold);
        return element_any_force_fibred(p->form, p->control.kind, u, &shape, law_at(p->form, &of, hold.law, share), own,
                                        element_fibre_which(own), sets.of, sets.count);
    }
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    const element_fibre other = muscle_at(p, now, element, true, mix, share * mixture);
    const element_law law = law_at(p->form, &of, of.hourglass, share);
    const int which = element_fibre_which(own), which_other = element_fibre_which(other);
    const float *cut = tled_cut(p, element);
    const double *border = tled_border(p, element);
    if (border) {
        const border_parts parts = border_parts_by(border_parts_of(p, element, border), p, share);
        return element_force_laminate(p->form, p->control.kind, u, box, parts.law, parts.c[0], parts.c[1], own, which,
                                      other, which_other, sets.of, sets.count, &parts.l);
    }
    if (cut)
        return element_force_cut(p->form, p->control.kind, u, box, law, own, which, other, which_other, sets.of,
                                 sets.count, element_cut_of(cut));
    return element_force_fibred(p->form, p->control.kind, u, box, law, own, which, other, which_other, sets.of,
                                sets.count);
}

void bodies_pull(const tled_problem *p, int64_t element, const bodies_state *now, double pull[8][3])
{
    const element_field f = pull_of(p, element, now);
    for (int c = 0; c < 8; c++) {
        pull[c][0] = f.x.at[c];
        pull[c][1] = f.y.at[c];
        pull[c][2] = f.z.at[c];
    }
}

/* ---- films */

/* What a body's films hang on: their points as the bone has them at rest, and how these have moved. */
typedef struct film_points {
    double *displacement; /* films x 3, m */
    int32_t *film;        /* of one body */
    int64_t count;
} film_points;

static int points_make(film_points *to, const tled_problem *p, err *e)
{
    const int64_t count = films_count(p);
    *to = (film_points){mem_array(count, 3 * sizeof *to->displacement, "the bodies", e),
                        mem_array(count, sizeof *to->film, "the bodies", e), 0};
    return to->displacement && to->film ? 0 : -1;
}

static void points_free(film_points *of)
{
    free(of->displacement);
    free(of->film);
}

static void points_of(film_points *to, const tled_problem *p, int32_t body, const double *value)
{
    to->count = 0;
    for (int64_t i = 0; i < films_count(p); i++)
        if (p->films->rows.body && p->films->rows.body[i] == body) {
            const film_bone bone = films_bone(p, i, value);
            memcpy(to->displacement + 3 * i, bone.u, sizeof bone.u);
            to->film[to->count++] = (int32_t)i;
        }
}

static void place_points(const film_points *of, const tled_problem *p, double middle[3])
{
    for (int a = 0; a < 3; a++) {
        middle[a] = 0;
        for (int64_t i = 0; i < of->count; i++)
            middle[a] +=
                (p->films->rows.point[3 * (int64_t)of->film[i] + a] + of->displacement[3 * (int64_t)of->film[i] + a]) /
                (double)of->count;
    }
}

static void add_force(body_load *to, const double x[3], const double middle[3], const double force[3])
{
    double d[3];
    for (int a = 0; a < 3; a++)
        d[a] = x[a] - middle[a];
    for (int a = 0; a < 3; a++) {
        to->force[a] += force[a];
        to->torque[a] += d[(a + 1) % 3] * force[(a + 2) % 3] - d[(a + 2) % 3] * force[(a + 1) % 3];
    }
}

/* A film pulls the bone as it pulls its element, the other way round; and the bone bears its weight. */
static void add_film(const tled_problem *p, const bodies_state *now, int64_t film, const double middle[3],
                     body_load *to)
{
    const films *f = p->films;
    const int32_t *node = p->element_node + 8 * (int64_t)f->rows.element[film];
    const element_tensor h = films_gradient(p, film, now->displacement, node, now->value);
    const element_tensor s = films_stress(p, film, h, now->value);
    const double mass =
        tled_law_of(p, f->rows.element[film]).density * f->rows.area[film] * f->rows.depth[film] * f->taken;
    const film_bone bone = films_bone(p, film, now->value);
    double force[3], x[3];
    for (int c = 0; c < 8; c++) {
        films_pull(f, film, c, &s, force);
        for (int a = 0; a < 3; a++)
            x[a] = p->position[3 * (int64_t)node[c] + a] + now->displacement[3 * (int64_t)node[c] + a];
        add_force(to, x, middle, force);
    }
    for (int a = 0; a < 3; a++) {
        force[a] = p->gravity < 0 ? 0 : mass * now->value[3 * p->gravity + a];
        x[a] = f->rows.point[3 * film + a] + bone.u[a];
    }
    add_force(to, x, middle, force);
}

static int film_loads(const tled_problem *p, const bodies_state *now, body_load *to, err *e)
{
    film_points of;
    const int failed = points_make(&of, p, e);
    for (int32_t i = 0; !failed && i < p->bodies->count; i++) {
        double middle[3];
        points_of(&of, p, i, now->value);
        place_points(&of, p, middle);
        for (int64_t k = 0; k < of.count; k++)
            add_film(p, now, of.film[k], middle, &to[i]);
    }
    points_free(&of);
    return failed;
}

static int film_poses(const tled_problem *p, const bodies_state *now, double *to, err *e)
{
    film_points of;
    const int failed = points_make(&of, p, e);
    for (int32_t i = 0; !failed && i < p->bodies->count; i++) {
        points_of(&of, p, i, now->value);
        const pose at = pose_fit(p->films->rows.point, of.displacement, of.film, of.count);
        pose_to_row(&at, to + 7 * (int64_t)i);
    }
    points_free(&of);
    return failed;
}

/* ---- sums */

typedef struct summing {
    const tled_problem *p;
    const bodies_state *now;
    double *middle;  /* bodies x 3, m: the mean of the nodes */
    body_load *part; /* chunks x bodies */
} summing;

static void place_of(const summing *s, int64_t node, double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = s->p->position[3 * node + a] + s->now->displacement[3 * node + a];
}

/* Adds a force at a node to its body's load. */
static void add_at(const summing *s, int64_t node, const double force[3], body_load *list)
{
    const int32_t body = s->p->bodies->of[node];
    double x[3];
    place_of(s, node, x);
    add_force(&list[body], x, s->middle + 3 * (int64_t)body, force);
}

static void element_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const summing *s = context;
    const tled_problem *p = s->p;
    body_load *list = s->part + chunk * p->bodies->count;
    for (int64_t i = from; i < to; i++) {
        const int64_t element = p->bodies->element[i];
        const element_field f = pull_of(p, element, s->now);
        for (int c = 0; c < 8; c++) {
            const int64_t node = p->element_node[8 * element + c];
            const double force[3] = {-f.x.at[c], -f.y.at[c], -f.z.at[c]};
            if (p->bodies->of[node] >= 0)
                add_at(s, node, force, list);
        }
    }
}

bool bodies_middle(const tled_problem *p, int32_t body, const double *displacement, double middle[3])
{
    const bodies *b = p->bodies;
    const int64_t count = b->start[body + 1] - b->start[body];
    middle[0] = middle[1] = middle[2] = 0;
    for (int64_t k = b->start[body]; k < b->start[body + 1]; k++)
        for (int a = 0; a < 3; a++) {
            const int64_t at = 3 * (int64_t)b->node[k] + a;
            middle[a] += (p->position[at] + displacement[at]) / (double)count;
        }
    return count > 0;
}

static void find_middles(const summing *s)
{
    for (int32_t i = 0; i < s->p->bodies->count; i++)
        bodies_middle(s->p, i, s->now->displacement, s->middle + 3 * (int64_t)i);
}

static void add_external(const summing *s, body_load *to)
{
    const bodies *b = s->p->bodies;
    for (int64_t k = 0; k < b->start[b->count]; k++) {
        double force[3];
        tled_external(s->p, s->now->value, s->now->displacement + 3 * (int64_t)b->node[k], b->node[k], force);
        add_at(s, b->node[k], force, to);
    }
}

static int add_pressures(const summing *s, pool *threads, body_load *to, err *e)
{
    followers_work w;
    const followers *f = s->p->followers;
    const int failed = followers_room(&w, f, e);
    if (!failed && f) {
        followers_move(&w, s->now->displacement);
        followers_press(&w, threads, s->now->value);
        for (int64_t i = 0; i < f->nodes; i++) {
            double push[3];
            followers_pull(&w, i, push);
            if (s->p->bodies->of[f->node[i]] >= 0)
                add_at(s, f->node[i], push, to);
        }
    }
    followers_room_free(&w);
    return failed;
}

static void add_parts(const summing *s, int64_t chunks, body_load *to)
{
    const int32_t count = s->p->bodies->count;
    for (int64_t i = 0; i < chunks * count; i++)
        for (int a = 0; a < 3; a++) {
            to[i % count].force[a] += s->part[i].force[a];
            to[i % count].torque[a] += s->part[i].torque[a];
        }
}

int bodies_loads(const tled_problem *p, pool *threads, const bodies_state *now, body_load *to, err *e)
{
    const bodies *b = p->bodies;
    const int64_t chunks = pool_chunks(b->elements, CHUNK);
    summing s = {.p = p, .now = now};
    int failed = -1;
    memset(to, 0, (size_t)b->count * sizeof *to);
    if (p->films)
        return film_loads(p, now, to, e);
    s.middle = mem_array(b->count, 3 * sizeof *s.middle, "the bodies", e);
    s.part = s.middle ? mem_array(chunks * b->count, sizeof *s.part, "the bodies", e) : NULL;
    if (s.part) {
        find_middles(&s);
        pool_run(threads, b->elements, CHUNK, element_work, &s);
        add_parts(&s, chunks, to);
        add_external(&s, to);
        failed = add_pressures(&s, threads, to, e);
    }
    free(s.middle);
    free(s.part);
    return failed;
}

int bodies_add(const tled_problem *p, pool *threads, const bodies_state *now, frame *f, const model *m, err *e)
{
    static const char *const names[] = {"body.pose", "body.force", "body.torque"};
    const bodies *b = p->bodies;
    double *to[3];
    if (!b)
        return 0;
    for (int i = 0; i < 3; i++) {
        model_array *a = frame_add(f, m, names[i], e);
        if (!a)
            return -1;
        to[i] = a->f64;
    }
    body_load *load = mem_array(b->count, sizeof *load, "the bodies", e);
    const int failed = load ? bodies_loads(p, threads, now, load, e) : -1;
    if (!failed && p->films && film_poses(p, now, to[0], e)) {
        free(load);
        return -1;
    }
    for (int32_t i = 0; !failed && i < b->count; i++) {
        memcpy(to[1] + 3 * (int64_t)i, load[i].force, sizeof load[i].force);
        memcpy(to[2] + 3 * (int64_t)i, load[i].torque, sizeof load[i].torque);
    }
    for (int32_t i = 0; !failed && !p->films && i < b->count; i++) {
        const int64_t count = b->start[i + 1] - b->start[i];
        const pose at = count ? pose_fit(p->position, now->displacement, b->node + b->start[i], count)
                              : (pose){.quaternion = {0, 0, 0, 1}};
        pose_to_row(&at, to[0] + 7 * (int64_t)i);
    }
    free(load);
    return failed;
}
