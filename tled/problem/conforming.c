#include "tled/problem/conforming.h"

#include "tled/problem/cut.h"

#include "mesh/lattice.h"

#include "base/mem.h"
#include "mesh/hexahedron.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* ---- small symmetric matrices, row by row */

/* The largest eigenvalue, to rounding, by Jacobi's turns; n at most 4. a is left with all of them on its diagonal. */
static double largest_eigenvalue(double *a, int n)
{
    double largest = 0;
    for (int sweep = 0; sweep < 30; sweep++)
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++) {
                if (fabs(a[p * n + q]) <= 1e-15 * (a[p * n + p] + a[q * n + q]))
                    continue;
                double theta = (a[q * n + q] - a[p * n + p]) / (2 * a[p * n + q]);
                double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int i = 0; i < n; i++) {
                    double left = a[i * n + p], right = a[i * n + q];
                    a[i * n + p] = c * left - s * right;
                    a[i * n + q] = s * left + c * right;
                }
                for (int i = 0; i < n; i++) {
                    double left = a[p * n + i], right = a[q * n + i];
                    a[p * n + i] = c * left - s * right;
                    a[q * n + i] = s * left + c * right;
                }
            }
    for (int i = 0; i < n; i++)
        largest = fmax(largest, a[i * n + i]);
    return largest;
}

/* a = L L^T, L lower. False: it is not positive definite. */
static bool factor(const double *a, int n, double *l)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double sum = a[i * n + j];
            for (int k = 0; k < j && k < i; k++)
                sum -= l[i * n + k] * l[j * n + k];
            if (i == j && !(sum > 0))
                return false;
            l[i * n + j] = i == j ? sqrt(sum) : i > j ? sum / l[j * n + j] : 0;
        }
    return true;
}

/* x = L^-1 x, x of n. */
static void solve(const double *l, int n, double *x)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            x[i] -= l[i * n + k] * x[k];
        x[i] /= l[i * n + i];
    }
}

/* ---- the shape of an element */

typedef struct corners {
    double at[8][3]; /* m, from the first */
    double b[8][3];  /* B, 1/m */
} corners;

/* gamma gamma^T, gamma_g = s_g - twist_g . B and B = the sum over modes of s slope, s.s = 8 and no two s alike. */
static void products_of(const conforming_element *c, double product[16])
{
    for (int g = 0; g < 4; g++)
        for (int h = 0; h < 4; h++) {
            double sum = g == h;
            for (int i = 0; i < 3; i++)
                sum -= c->twist[g][i] * c->slope[3 + h][i] + c->twist[h][i] * c->slope[3 + g][i];
            for (int m = 0; m < 7; m++) {
                double left = 0, right = 0;
                for (int i = 0; i < 3; i++) {
                    left += c->twist[g][i] * c->slope[m][i];
                    right += c->twist[h][i] * c->slope[m][i];
                }
                sum += left * right;
            }
            product[4 * g + h] = 8 * sum;
        }
}

void conforming_root(const conforming_element *c, double root[16])
{
    double product[16];
    products_of(c, product);
    if (c->least < c->gammas && factor(product, 4, root))
        return;
    for (int i = 0; i < 16; i++)
        root[i] = i % 5 ? 0 : sqrt(c->gammas);
}

/* c^2. */
static void find_couple(conforming_element *c)
{
    double grams[16], l[16] = {0}, mixed[3][4], product[9];
    c->couple = 1;
    products_of(c, grams);
    if (!factor(grams, 4, l))
        return;
    for (int g = 0; g < 4; g++) { /* L^-1 B gamma^T, B gamma_g = 8 slope_g - B B^T twist_g */
        double column[3];
        for (int i = 0; i < 3; i++) {
            column[i] = 8 * c->slope[3 + g][i];
            for (int m = 0; m < 7; m++)
                for (int k = 0; k < 3; k++)
                    column[i] -= 8 * c->slope[m][i] * c->slope[m][k] * c->twist[g][k];
        }
        solve(&c->root[0][0], 3, column);
        for (int i = 0; i < 3; i++)
            mixed[i][g] = column[i];
    }
    for (int i = 0; i < 3; i++)
        solve(l, 4, mixed[i]);
    for (int i = 0; i < 9; i++) {
        product[i] = 0;
        for (int g = 0; g < 4; g++)
            product[i] += mixed[i / 3][g] * mixed[i % 3][g];
    }
    c->couple = fmin(1, largest_eigenvalue(product, 3));
}

/* The eigenvalues of R R^T, and l; products: B B^T, used up. */
static void find_slope(double products[9], conforming_element *c)
{
    double gammas[16], least = INFINITY;
    products_of(c, gammas);
    c->gammas = largest_eigenvalue(gammas, 4);
    for (int g = 0; g < 4; g++)
        least = fmin(least, gammas[5 * g]);
    c->least = least > 1e-3 * c->gammas ? least : c->gammas;
    c->steepest = sqrt(largest_eigenvalue(products, 3) / c->least);
}

/* False: it has no inside. */
static bool shape_of(const tled_problem *p, int64_t element, conforming_element *c)
{
    corners x = {.b = {{0}}};
    double products[9] = {0};
    const double *first = p->position + 3 * (int64_t)p->element_node[8 * element];
    for (int i = 0; i < 24; i++)
        x.at[i / 3][i % 3] = p->position[3 * (int64_t)p->element_node[8 * element + i / 3] + i % 3] - first[i % 3];
    c->volume = hexahedron_mean(&x.at[0][0], &x.b[0][0]);
    hexahedron_modes(&x.at[0][0], &x.b[0][0], &c->slope[0][0], &c->twist[0][0]);
    for (int i = 0; i < 9; i++)
        for (int a = 0; a < 8; a++)
            products[i] += x.b[a][i / 3] * x.b[a][i % 3];
    c->squares = products[0] + products[4] + products[8];
    if (!(c->volume > 0) || !isfinite(c->squares) || !factor(products, 3, &c->root[0][0]))
        return false;
    find_slope(products, c);
    find_couple(c);
    return true;
}

int conforming_create(tled_problem *p, err *e)
{
    conforming *c = mem_array(1, sizeof *c, "the elements", e);
    double volume = 0;
    p->conforming = c;
    if (!c || !(c->element = mem_array(p->elements, sizeof *c->element, "the elements", e)))
        return -1;
    if (p->mix)
        return err_set(e, NULL, 0, "element.mix in a model without a lattice; expected elements of one volume each");
    for (int64_t i = 0; i < p->elements; i++) {
        if (!shape_of(p, i, &c->element[i]))
            return err_set(
                e, NULL, 0,
                "element %lld has no inside, or is inside out; expected a hexahedron, its nodes in VTK's order",
                (long long)i);
        volume += c->element[i].volume;
    }
    for (int a = 0; a < 3; a++)
        p->side[a] = cbrt(volume / (double)p->elements);
    return 0;
}

void conforming_free(conforming *c)
{
    if (c)
        free(c->element);
    free(c);
}

conforming_hold conforming_hold_of(const tled_problem *p, int64_t element)
{
    const conforming_element *c = &p->conforming->element[element];
    const tled_law law = tled_law_of(p, element);
    const int32_t *node = p->element_node + 8 * element;
    conforming_hold hold = {.law = {0}};
    double at[24];
    if (p->control.kind == HOURGLASS_PHYSICAL)
        hourglass_moduli(law.mu, law.bulk, hold.law);
    else
        hold.law[HOURGLASS_K] = hourglass_stiffness(p->control.kappa, law.mu, c->volume, c->squares);
    for (int i = 0; i < 24; i++)
        at[i] = p->position[3 * (int64_t)node[i / 3] + i % 3] - p->position[3 * (int64_t)node[0] + i % 3];
    hexahedron_basis(at, hold.basis);
    return hold;
}

/* ---- nodes */

int conforming_corners(tled_problem *p, err *e)
{
    p->corner_start = mem_array(p->nodes + 2, sizeof *p->corner_start, "the nodes", e);
    if (!p->corner_start)
        return -1;
    /* Counts two places on, so that filling moves each start to where it belongs. */
    for (int64_t i = 0; i < 8 * p->elements; i++)
        p->corner_start[p->element_node[i] + 2]++;
    for (int64_t n = 0; n < p->nodes; n++) {
        if (!p->corner_start[n + 2])
            return err_set(e, NULL, 0, "node %lld is in no element", (long long)n);
        p->corner_start[n + 2] += p->corner_start[n + 1];
    }
    for (int64_t i = 0; i < 8 * p->elements; i++) {
        const int64_t node = p->element_node[i];
        p->corner[p->corner_start[node + 1]++] = (int32_t)i;
        p->mass[node] +=
            tled_law_of(p, i / 8).density * p->conforming->element[i / 8].volume / 8 * tled_fraction(p, i / 8);
    }
    return 0;
}

enum { ELEMENTS = 4096, NODES = 32768 }; /* a chunk has */

/* ---- boxes of a lattice */

static bool is_box(const tled_problem *p, int64_t element)
{
    const int32_t *node = p->element_node + 8 * element;
    const double *first = p->position + 3 * (int64_t)node[0];
    bool good = true;
    for (int c = 0; c < 8; c++) {
        const double *corner = p->position + 3 * (int64_t)node[c];
        for (int a = 0; a < 3; a++) {
            const double gap = corner[a] - first[a] - p->side[a] * lattice_vtk[c][a];
            good &= fabs(gap) <= 1e-6 * p->side[a];
        }
    }
    return good;
}

/* Of all chunks: the first of what is wrong, INT64_MAX where nothing is. */
static void note_first(atomic_llong *first, int64_t at)
{
    long long before = atomic_load(first);
    while (at < before && !atomic_compare_exchange_weak(first, &before, at))
        ;
}

typedef struct check {
    const tled_problem *p;
    atomic_llong wrong; /* the first element that is not a box */
} check;

static void check_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    check *c = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        if (!is_box(c->p, i)) {
            note_first(&c->wrong, i);
            return;
        }
}

int boxes_check(const tled_problem *p, err *e)
{
    check c = {.p = p};
    atomic_init(&c.wrong, INT64_MAX);
    pool_run(p->threads, p->elements, ELEMENTS, check_work, &c);
    const int64_t wrong = atomic_load(&c.wrong);
    if (wrong == INT64_MAX)
        return 0;
    return err_set(e, NULL, 0, "element %lld is not a box of %g x %g x %g m; expected all to be the lattice's",
                   (long long)wrong, p->side[0], p->side[1], p->side[2]);
}

/* ---- the corners at nodes of boxes */

typedef struct span {
    int32_t low, high;
} span;

/* Nodes gather their corners, since sums must be made in the elements' order: a chunk of nodes goes through those
 * chunks of elements that have nodes of its own. These are few where a model is numbered as its lattice. */
typedef struct box_corners {
    tled_problem *p;
    span *span; /* of each chunk of elements: from its lowest to its highest node */
    int64_t spans;
    atomic_llong crowded; /* the first corner that finds no room at its node */
    atomic_llong bare;    /* the first node that is in no element */
} box_corners;

static void span_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const box_corners *c = context;
    span s = {INT32_MAX, -1};
    for (int64_t i = 8 * from; i < 8 * to; i++) {
        const int32_t n = c->p->element_node[i];
        s.low = n < s.low ? n : s.low;
        s.high = n > s.high ? n : s.high;
    }
    c->span[chunk] = s;
}

/* Where among a node's elements, by their places in the lattice, the one is that has the node for this corner. */
static int corner_rank(int32_t corner)
{
    const int32_t *offset = lattice_vtk[corner % 8];
    return 7 - (offset[0] + 2 * offset[1] + 4 * offset[2]);
}

/* Into its place among the node's. false: they are 8 already. */
static bool add_corner(int32_t *list, int32_t corner, int32_t none)
{
    int at = 7;
    if (list[at] != none)
        return false;
    for (; at && (list[at - 1] == none || corner_rank(list[at - 1]) > corner_rank(corner)); at--)
        list[at] = list[at - 1];
    list[at] = corner;
    return true;
}

/* What an element gives to those of its nodes that are in [from, to). false: one of these has no room. */
static bool give(box_corners *c, int64_t element, int64_t from, int64_t to)
{
    tled_problem *p = c->p;
    const double share = p->side[0] * p->side[1] * p->side[2] / 8;
    const int32_t *node = p->element_node + 8 * element, none = (int32_t)p->elements * 8;
    bool any = false;
    for (int k = 0; k < 8; k++)
        any |= (node[k] >= from) & (node[k] < to);
    if (!any)
        return true;
    const double mass = tled_law_of(p, element).density * share * cut_inertia(p, element);
    for (int k = 0; k < 8; k++) {
        const int64_t n = node[k];
        if (n < from || n >= to)
            continue;
        if (!add_corner(p->corner + 8 * n, (int32_t)(8 * element) + k, none)) {
            note_first(&c->crowded, 8 * element + k);
            return false;
        }
        p->mass[n] += mass;
    }
    return true;
}

static bool give_chunk(box_corners *c, int64_t chunk, int64_t from, int64_t to)
{
    const int64_t first = chunk * ELEMENTS, left = c->p->elements - first;
    for (int64_t i = first; i < first + (left < ELEMENTS ? left : ELEMENTS); i++)
        if (!give(c, i, from, to))
            return false;
    return true;
}

static bool meets(const span *s, int64_t from, int64_t to)
{
    return s->high >= from && s->low < to;
}

static void gather_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    box_corners *c = context;
    const int32_t none = (int32_t)c->p->elements * 8;
    (void)chunk;
    for (int64_t i = 8 * from; i < 8 * to; i++)
        c->p->corner[i] = none;
    for (int64_t k = 0; k < c->spans; k++)
        if (meets(&c->span[k], from, to) && !give_chunk(c, k, from, to))
            return;
    for (int64_t n = from; n < to; n++)
        if (c->p->corner[8 * n] == none) {
            note_first(&c->bare, n);
            return;
        }
}

/* How many nodes to take at a time: all at once where the model's numbers jump, so that chunks of nodes would each go
 * through most elements. */
static int64_t choose_size(const box_corners *c)
{
    int64_t visits = 0;
    for (int64_t from = 0; from < c->p->nodes; from += NODES)
        for (int64_t k = 0; k < c->spans; k++)
            visits += meets(&c->span[k], from, from + NODES);
    return visits <= 4 * c->spans ? NODES : c->p->nodes;
}

int boxes_corners(tled_problem *p, err *e)
{
    box_corners c = {.p = p, .spans = pool_chunks(p->elements, ELEMENTS)};
    c.span = mem_array(c.spans, sizeof *c.span, "the nodes", e);
    if (!c.span)
        return -1;
    atomic_init(&c.crowded, INT64_MAX);
    atomic_init(&c.bare, INT64_MAX);
    pool_run(p->threads, p->elements, ELEMENTS, span_work, &c);
    pool_run(p->threads, p->nodes, choose_size(&c), gather_work, &c);
    free(c.span);
    const int64_t crowded = atomic_load(&c.crowded), bare = atomic_load(&c.bare);
    if (crowded < INT64_MAX)
        return err_set(e, NULL, 0, "node %lld is in more than 8 elements", (long long)p->element_node[crowded]);
    return bare < INT64_MAX ? err_set(e, NULL, 0, "node %lld is in no element", (long long)bare) : 0;
}
