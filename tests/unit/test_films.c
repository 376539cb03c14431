/* Films of tissue on bone (attach --surface), in the CPU's executors: forces are the derivative of the energy; a
 * film has the gradient of tissue that is held at the bone; the stable step holds, by the highest frequency that
 * powers of M^-1 K find; any threads and vectors give the same bytes; cards are refused.
 */
// needs: tled/*/*.c
#include "solve/vectors.h"
#include "tled/cpu/cpu.h"
#include "tled/problem/cut.h"
#include "tled/problem/deformed.h"
#include "tled/problem/film_strain.h"
#include "tled/problem/step.h"

#include "tap.h"
#include "tled_block.h"
#include "tled_choice.h"

#include <string.h>

static const block soft = {{4, 3, 2}, {.01, .012, .009}, 3000, .45, 1000, 30000, 2, 0, 0, {0, 0, 0}, .7F, false};

typedef struct setting {
    model m;
    script s;
    tled_problem p;
} setting;

static void die(const char *why)
{
    printf("Bail out! %s\n", why);
    exit(1);
}

static double *numbers(int64_t count)
{
    double *x = calloc((size_t)count, sizeof *x);
    if (!x)
        die("no memory");
    return x;
}

/* ---- a block on an oblique bone: a film in each element of the lowest layer, one of them outside of it */

static const double normal[3] = {.2, -.3, .93273790530888150};

static void add_films(model *m, const block *b)
{
    err e = {0};
    const int32_t count = b->cells[0] * b->cells[1];
    if (model_axis_add(m, "anchor", 1, &e) || model_axis_add(m, "bone", count, &e) ||
        model_axis_add(m, "film", count, &e))
        die(e.text);
    model_array *name = block_array(m, "anchor.name");
    if (model_set_text(name, 0, "skull", &e))
        die(e.text);
    int32_t *element = block_array(m, "bone.element")->i32, *of = block_array(m, "film.element")->i32;
    double *point = block_array(m, "bone.point")->f64, *depth = block_array(m, "bone.depth")->f64;
    double *area = block_array(m, "bone.area")->f64;
    float *products = block_array(m, "bone.products")->f32;
    float *n = block_array(m, "bone.normal")->f32, *share = block_array(m, "film.share")->f32;
    block_array(m, "bone.anchor");
    block_array(m, "film.moments");
    for (int32_t i = 0; i < count; i++) {
        element[i] = of[i] = i;
        const int32_t at[3] = {i % b->cells[0], i / b->cells[0], 0};
        for (int a = 0; a < 3; a++) {
            point[3 * i + a] = b->side[a] * (at[a] + .1 + .07 * ((i + a) % 10));
            n[3 * i + a] = (float)normal[a];
        }
        if (!i)
            point[2] = -.2 * b->side[2];
        for (int a = 0; a < 4; a++)
            products[4 * i + a] = .03F * (float)((i + 3 * a) % 7) - .1F;
        depth[i] = .004;
        area[i] = 1e-4 + 2e-6 * i;
        share[i] = .1F + .05F * (float)(i % 9);
    }
}

/* Makes laminates of mixed elements, on films and off. */
static void add_borders(model *m)
{
    static const float way[3] = {.6F, .48F, .64F}, moments[6] = {.2F, .1F, .15F, .05F, .02F, .04F};
    const int32_t *mix = model_find(m, "element.mix")->i32;
    const float *mixture = model_find(m, "element.mixture")->f32;
    int64_t count = 0;
    err e = {0};
    model_remove(m, "element.E"); /* laminates have the values of materials alone */
    model_remove(m, "element.density");
    int32_t *at_cell = block_array(m, "element.lattice")->i32;
    for (int64_t i = 0; i < model_count(m, "element"); i++) {
        at_cell[3 * i] = (int32_t)i % soft.cells[0];
        at_cell[3 * i + 1] = (int32_t)i / soft.cells[0] % soft.cells[1];
        at_cell[3 * i + 2] = (int32_t)i / soft.cells[0] / soft.cells[1];
    }
    for (int64_t i = 0; i < model_count(m, "element"); i++)
        count += mix[i] >= 0 && mixture[i] > 0 && mixture[i] < 1;
    if (model_axis_add(m, "border", count, &e))
        die(e.text);
    int32_t *element = block_array(m, "border.element")->i32;
    float *n = block_array(m, "border.normal")->f32, *of = block_array(m, "border.moments")->f32;
    for (int64_t i = 0, at = 0; at < count; i++)
        if (mix[i] >= 0 && mixture[i] > 0 && mixture[i] < 1) {
            element[at] = (int32_t)i;
            memcpy(n + 3 * at, way, sizeof way);
            memcpy(of + 6 * at++, moments, sizeof moments);
        }
}

static void make(setting *s, const block *b, bool laminates, hourglass_control control)
{
    err e = {0};
    *s = (setting){.p = {.nodes = 0}};
    block_make(b, &s->m);
    add_films(&s->m, b);
    if (laminates)
        add_borders(&s->m);
    if ((b->fibre[0] > 0 && script_add_contract(&s->s, &s->m, "m=.3", 0, &e)) ||
        tled_problem_make(&s->p, &s->m, &s->s, control, &e))
        die(e.text);
}

static void end(setting *s)
{
    tled_problem_free(&s->p);
    script_free(&s->s);
    model_free(&s->m);
}

/* What elements and films pull with at displacements u. */
static void pull(setting *s, const tled_executor *by, int threads_wanted, const double *u, double *f)
{
    err e = {0};
    pool *threads = pool_create(threads_wanted, &e);
    memcpy(s->p.at_start.of[TLED_DISPLACEMENT], u, 3 * (size_t)s->p.nodes * sizeof *u);
    tled_state *state = threads ? by->create(&s->p, threads, &e) : NULL;
    if (!state || by->get(state, TLED_INTERNAL, f, &e))
        die(e.text);
    by->destroy(state);
    pool_destroy(threads);
}

static void shake(const setting *s, double by, double *u)
{
    for (int64_t i = 0; i < 3 * s->p.nodes; i++)
        u[i] = by * sin((double)(i * i % 97));
}

/* ---- energy */

static double energy_of(const tled_problem *p, const double *u, const double *value)
{
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    double sum = films_energies(p, u, value);
    for (int64_t i = 0; i < p->elements; i++) {
        const deformed d = deformed_of(p, i, box, u);
        sum += tled_fraction(p, i) * (d.rest * d.energy + d.hourglass);
    }
    return sum;
}

static void test_energy(hourglass_control control, bool mixed, bool laminates, const char *name)
{
    block b = soft;
    setting s;
    b.mixed = mixed;
    b.fraction = laminates ? 0 : b.fraction;
    make(&s, &b, laminates, control);
    double *u = numbers(3 * s.p.nodes), *f = numbers(3 * s.p.nodes), worst = 0, scale = 0;
    shake(&s, 4e-4, u);
    pull(&s, &tled_cpu_double, 1, u, f);
    for (int64_t i = 1; i < 3 * s.p.nodes; i += 5) {
        const double was = u[i], step = 1e-8;
        u[i] = was + step;
        const double high = energy_of(&s.p, u, NULL);
        u[i] = was - step;
        const double slope = (high - energy_of(&s.p, u, NULL)) / (2 * step);
        u[i] = was;
        worst = fmax(worst, fabs(slope - f[i]));
        scale = fmax(scale, fabs(slope));
    }
    near_(worst / scale, 0, 1e-5, "%s: forces are the derivative of the energy", name);
    free(u);
    free(f);
    end(&s);
}

/* ---- one film */

/* The tissue follows H = a (x) n, as a film on bone at rest has it: its stress is the law's at H. */
static void test_strain(void)
{
    static const double a[3] = {.05, -.1, .08};
    setting s;
    make(&s, &soft, false, PHYSICAL);
    double *u = numbers(3 * s.p.nodes), worst = 0;
    for (int64_t film = 0; film < films_count(&s.p); film++) {
        const films *f = s.p.films;
        const int32_t *node = s.p.element_node + 8 * (int64_t)f->rows.element[film];
        for (int64_t n = 0; n < s.p.nodes; n++) { /* 0 where the film meets the bone */
            double away = f->rows.depth[film];
            for (int k = 0; k < 3; k++)
                away += (s.p.position[3 * n + k] - f->rows.point[3 * film + k]) * f->rows.normal[3 * film + k];
            for (int k = 0; k < 3; k++)
                u[3 * n + k] = a[k] * away;
        }
        const element_tensor h = films_gradient(&s.p, film, u, node, NULL);
        const double got[9] = {h.xx, h.xy, h.xz, h.yx, h.yy, h.yz, h.zx, h.zy, h.zz};
        for (int i = 0; i < 9; i++)
            worst = fmax(worst, fabs(got[i] - a[i / 3] * f->rows.normal[3 * film + i % 3]));
    }
    near_(worst, 0, 1e-12, "a film has the gradient of tissue that is held at the bone's surface");
    free(u);
    end(&s);
}

/* ---- the stable step */

/* The square of the highest frequency, from below: powers of M^-1 K at rest, K by differences of forces. */
static double square_found(setting *s)
{
    const int64_t count = 3 * s->p.nodes;
    double *u = numbers(count), *f = numbers(count), found = 0;
    shake(s, 1, u);
    for (int k = 0; k < 300; k++) {
        double square = 0, work = 0;
        for (int64_t i = 0; i < count; i++)
            square += s->p.mass[i / 3] * u[i] * u[i];
        for (int64_t i = 0; i < count; i++)
            u[i] *= 1e-9 / sqrt(square);
        pull(s, &tled_cpu_double, 1, u, f);
        for (int64_t i = 0; i < count; i++)
            work += u[i] * f[i];
        found = work / 1e-18;
        for (int64_t i = 0; i < count; i++)
            u[i] = f[i] / s->p.mass[i / 3];
    }
    free(u);
    free(f);
    return found;
}

static void test_step(double area)
{
    setting s;
    make(&s, &soft, false, PHYSICAL);
    double *of = model_find(&s.m, "bone.area")->f64;
    for (int64_t i = 0; i < films_count(&s.p); i++)
        of[i] *= area;
    err e = {0};
    tled_problem_free(&s.p);
    if (tled_problem_make(&s.p, &s.m, &s.s, PHYSICAL, &e))
        die(e.text);
    const double found = square_found(&s), told = 4 / pow(step_at_rest(&s.p, NULL), 2);
    ok(found <= told * (1 + 1e-6) && found > .3 * told, "films of %g times the area: %.4g 1/s2 found, %.4g told", area,
       found, told);
    end(&s);
}

/* ---- bytes and choice */

static void test_bytes(const tled_executor *by, const char *name)
{
    static const char *const sets[] = {"plain", "AVX2", "AVX-512"};
    setting s;
    make(&s, &soft, false, PHYSICAL);
    double *u = numbers(3 * s.p.nodes), *want = numbers(3 * s.p.nodes), *f = numbers(3 * s.p.nodes);
    shake(&s, 4e-4, u);
    pull(&s, by, 1, u, want);
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
        err none = {0};
        setenv("SINEW_VECTORS", sets[i], 1);
        if (vectors_choose(&none) < 0) {
            skip(1, "this processor has no such vectors");
            continue;
        }
        pull(&s, by, 3, u, f);
        ok(!memcmp(f, want, 3 * (size_t)s.p.nodes * sizeof *f), "%s, %s: the same bytes", name, sets[i]);
    }
    unsetenv("SINEW_VECTORS");
    free(u);
    free(want);
    free(f);
    end(&s);
}

static void test_choice(void)
{
    setting s;
    make(&s, &soft, false, PHYSICAL);
    test_choice_without(&s.p, EXECUTOR_FILMS, "films on bone (attach --surface)",
                        "cpu (the one with films on bone (attach --surface))");
    end(&s);
}

int main(void)
{
    test_energy(PHYSICAL, false, false, "a block on films");
    test_energy(ISOTROPIC(.05), true, false, "a mixed one");
    test_energy(ISOTROPIC(.05), true, true, "with laminates, which films have a part of");
    test_energy(PHYSICAL, true, true, "and with physical hourglass control");
    test_strain();
    test_step(1);
    test_step(5);
    test_bytes(&tled_cpu_double, "double");
    test_bytes(&tled_cpu_single, "single");
    test_choice();
    return done_testing();
}
