/* Pressures of a script on bound surfaces: power against the change of volume, balance, turns, threads; and the bound
 * of the load stiffness against the matrix itself, of difference quotients. */
// needs: tled/*/*.c
#include "tled/problem/followers.h"

#include "base/mem.h"
#include "mesh/bound.h"
#include "mesh/weights.h"

#include "tap.h"
#include "tled_block.h"

#include <string.h>

static const block brick = {{4, 3, 3}, {.01, .012, .009}, 3000, .45, 1000, 30000, 0, 0, 0, {0, 0, 0}, 0, false};

enum { PARTS = 8 }; /* of an octahedron's edges */

typedef struct ball {
    double x[3 * 8 * 3 * PARTS * PARTS]; /* m */
    int32_t corner[8 * 3 * PARTS * PARTS];
    int32_t vertices, corners;
} ball;

static double *room(int64_t count)
{
    err e = {0};
    double *numbers = mem_array(count, sizeof *numbers, "a test", &e);
    if (!numbers) {
        printf("Bail out! %s\n", e.text);
        exit(1);
    }
    return numbers;
}

static double noise(int64_t i)
{
    return (double)(i * 7919 % 1009) / 1009 - .5;
}

static int32_t ball_vertex(ball *b, int sign, int i, int j)
{
    const double p[3] = {(double)(PARTS - i - j), (double)i, (double)j}, middle[3] = {.02, .018, .0135};
    double *x = b->x + 3 * (int64_t)b->vertices;
    const double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int a = 0; a < 3; a++)
        x[a] = middle[a] + (sign >> a & 1 ? -.011 : .011) * p[a] / length;
    return b->vertices++;
}

static void ball_triangle(ball *b, int sign, const int ij[6])
{
    const bool turned = (sign & 1) ^ (sign >> 1 & 1) ^ (sign >> 2 & 1);
    for (int k = 0; k < 3; k++) {
        const int at = turned ? 2 - k : k;
        b->corner[b->corners++] = ball_vertex(b, sign, ij[2 * at], ij[2 * at + 1]);
    }
}

/* A ball of 11 mm in the brick, each triangle with vertices of its own. */
static void ball_make(ball *b)
{
    *b = (ball){.vertices = 0};
    for (int sign = 0; sign < 8; sign++)
        for (int i = 0; i < PARTS; i++)
            for (int j = 0; i + j < PARTS; j++) {
                ball_triangle(b, sign, (int[]){i, j, i + 1, j, i, j + 1});
                if (i + j + 1 < PARTS)
                    ball_triangle(b, sign, (int[]){i + 1, j, i + 1, j + 1, i, j + 1});
            }
}

static void bind_vertex(const model *m, int64_t at, const double *x, int32_t *element, double *weight)
{
    const double *position = model_find(m, "node.position")->f64;
    int32_t cell[3];
    for (int a = 0; a < 3; a++)
        cell[a] = (int32_t)(x[a] / brick.side[a]);
    element[at] = (cell[2] * brick.cells[1] + cell[1]) * brick.cells[0] + cell[0];
    const weights_box box = weights_box_of(model_find(m, "element.node")->i32 + 8 * (int64_t)element[at], position);
    weights_of(&box, x, weight + 3 * at);
}

static void carry(model *m, const ball *b)
{
    err e = {0};
    model_axis_add(m, "ball/vertex", b->vertices, &e);
    model_axis_add(m, "ball/face", b->corners / 3, &e);
    model_axis_add(m, "ball/corner", b->corners, &e);
    model_axis_add(m, "ball/group", 2, &e);
    double *x = block_array(m, "ball/vertex.position")->f64;
    int64_t *start = block_array(m, "ball/face.start")->i64;
    int32_t *group = block_array(m, "ball/face.group")->i32, *element = block_array(m, "ball/vertex.element")->i32;
    memcpy(block_array(m, "ball/face.vertex")->i32, b->corner, (size_t)b->corners * sizeof *b->corner);
    model_array *name = block_array(m, "ball/group.name");
    model_set_text(name, 0, "low", &e);
    model_set_text(name, 1, "high cap", &e);
    model_array *weight = model_add_as(m, "ball/vertex.weight", MODEL_F64, "1", "ball/vertex", 3, &e);
    if (!weight)
        printf("Bail out! %s\n", e.text);
    for (int32_t i = 0; weight && i < b->vertices; i++) {
        memcpy(x + 3 * (int64_t)i, b->x + 3 * (int64_t)i, 3 * sizeof *x);
        bind_vertex(m, i, b->x + 3 * (int64_t)i, element, weight->f64);
    }
    for (int32_t i = 0; i < b->corners / 3; i++) {
        start[i] = 3 * (int64_t)i;
        group[i] = b->x[3 * (int64_t)b->corner[3 * i] + 2] > .0135;
    }
}

typedef struct stand {
    model m;
    script s;
    tled_problem p;
    followers_work w;
    pool *threads;
    double *u, *force; /* nodes x 3 */
} stand;

static void make(stand *t, const char *text, int threads)
{
    err e = {0};
    ball b;
    *t = (stand){.threads = pool_create(threads, &e)};
    ball_make(&b);
    block_make(&brick, &t->m);
    carry(&t->m, &b);
    in *source = in_memory(text, strlen(text), "script", &e);
    ok(!script_read(&t->s, source, &t->m, &e) && !tled_problem_make(&t->p, &t->m, &t->s, PHYSICAL, &e) &&
           t->p.followers && !followers_room(&t->w, t->p.followers, &e),
       "pressures: %s", e.text);
    in_close(source);
    t->u = room(3 * t->p.nodes);
    t->force = room(3 * t->p.nodes);
}

static void clear(stand *t)
{
    followers_room_free(&t->w);
    tled_problem_free(&t->p);
    script_free(&t->s);
    model_free(&t->m);
    pool_destroy(t->threads);
    free(t->u);
    free(t->force);
}

static void press(stand *t)
{
    double value[3 * 4];
    tled_curves(&t->p, 0, value);
    followers_move(&t->w, t->u);
    followers_press(&t->w, t->threads, value);
    memset(t->force, 0, 3 * (size_t)t->p.nodes * sizeof *t->force);
    for (int64_t i = 0; i < t->p.followers->nodes; i++)
        followers_pull(&t->w, i, t->force + 3 * (int64_t)t->p.followers->node[i]);
}

/* What the ball encloses, m3, where u has it; by tetrahedra from the origin. */
static double volume_at(const stand *t, const double *u)
{
    bound b;
    err e = {0};
    double sum = 0;
    bound_of(&b, &t->m, "ball", &e);
    for (int64_t i = 0; i < b.shape.corners; i += 3) {
        double x[3][3];
        for (int k = 0; k < 3; k++) {
            const int32_t vertex = b.shape.vertex[i + k];
            bound_displacement(&b, vertex, u, x[k]);
            for (int a = 0; a < 3; a++)
                x[k][a] += b.shape.position[3 * (int64_t)vertex + a];
        }
        for (int a = 0; a < 3; a++)
            sum += x[0][a] * (x[1][(a + 1) % 3] * x[2][(a + 2) % 3] - x[1][(a + 2) % 3] * x[2][(a + 1) % 3]) / 6;
    }
    return sum;
}

static void test_power(void)
{
    stand t;
    make(&t, "0 pressure ball 250\n", 1);
    const int64_t count = 3 * t.p.nodes;
    double *side = room(count), power = 0, total[3] = {0}, moment[3] = {0}, largest = 0;
    for (int64_t i = 0; i < count; i++)
        t.u[i] = .004 * noise(i);
    press(&t);
    const double h = 1e-6;
    for (int64_t i = 0; i < count; i++) {
        side[i] = t.u[i] + h * noise(3 * i + 1);
        power += t.force[i] * 2 * h * noise(3 * i + 1);
        total[i % 3] += t.force[i];
        largest = fmax(largest, fabs(t.force[i]));
        const double y = t.p.position[i / 3 * 3 + (i + 1) % 3] + t.u[i / 3 * 3 + (i + 1) % 3];
        const double z = t.p.position[i / 3 * 3 + (i + 2) % 3] + t.u[i / 3 * 3 + (i + 2) % 3];
        moment[i % 3] += y * t.force[i / 3 * 3 + (i + 2) % 3] - z * t.force[i / 3 * 3 + (i + 1) % 3];
    }
    double change = volume_at(&t, side);
    for (int64_t i = 0; i < count; i++)
        side[i] = t.u[i] - h * noise(3 * i + 1);
    change -= volume_at(&t, side);
    near_(power, -250 * change, 1e-6 * fabs(power), "nodes' power is that of the pressure on the volume: %g", power);
    for (int a = 0; a < 3; a++) {
        near_(total[a], 0, 1e-13 * largest, "forces sum to 0, %c", 'x' + a);
        near_(moment[a], 0, 1e-14 * largest, "moments too");
    }
    free(side);
    clear(&t);
}

static void test_turn(void)
{
    static const double turn[3][3] = {{.36, .48, -.8}, {-.8, .6, 0}, {.48, .64, .6}};
    stand t, more;
    make(&t, "0 pressure ball:high 100\n0 pressure ball -30\n", 1);
    make(&more, "0 pressure ball:high 100\n0 pressure ball -30\n", 3);
    press(&t);
    for (int64_t n = 0; n < t.p.nodes; n++)
        for (int a = 0; a < 3; a++)
            for (int k = 0; k < 3; k++)
                more.u[3 * n + a] += (turn[a][k] - (a == k)) * t.p.position[3 * n + k];
    press(&more);
    double off = 0, largest = 0;
    for (int64_t i = 0; i < 3 * t.p.nodes; i++) {
        const double *f = t.force + i / 3 * 3, *r = turn[i % 3];
        off = fmax(off, fabs(more.force[i] - (r[0] * f[0] + r[1] * f[1] + r[2] * f[2])));
        largest = fmax(largest, fabs(more.force[i]));
    }
    near_(off, 0, 1e-13 * largest, "where the model has turned, so have the forces");
    memcpy(t.u, more.u, 3 * (size_t)t.p.nodes * sizeof *t.u);
    press(&t);
    ok(!memcmp(t.force, more.force, 3 * (size_t)t.p.nodes * sizeof *t.force), "the same bytes by 1 and 3 threads");
    int64_t inside = t.p.followers->node[0], outside = 0;
    ok(followers_push(t.p.followers, t.p.followers->node[t.p.followers->nodes - 1]) &&
           !followers_push(t.p.followers, inside) && !followers_push(t.p.followers, outside),
       "a region pushes, a whole surface is in balance");
    clear(&t);
    clear(&more);
}

/* The largest eigenvalue of a symmetric n x n matrix, of either sign, by powers. */
static double largest_of(const double *a, int64_t n)
{
    double *x = room(n), *y = room(n), size = 0;
    for (int64_t i = 0; i < n; i++)
        x[i] = noise(i * 13 + 5);
    for (int go = 0; go < 300; go++) {
        size = 0;
        for (int64_t i = 0; i < n; i++) {
            y[i] = 0;
            for (int64_t k = 0; k < n; k++)
                y[i] += a[i * n + k] * x[k];
            size += y[i] * y[i];
        }
        size = sqrt(size);
        for (int64_t i = 0; i < n; i++)
            x[i] = y[i] / size;
    }
    free(x);
    free(y);
    return size;
}

static void test_bound(const char *text, double spread)
{
    stand t;
    double value[3 * 4];
    make(&t, text, 1);
    const int64_t n = 3 * t.p.nodes;
    double *a = room(n * n);
    for (int64_t i = 0; i < n; i++)
        t.u[i] = spread * noise(i);
    const double h = 1e-3; /* forces are quadratic: differences are exact */
    for (int64_t k = 0; k < n; k++)
        for (int side = -1; side <= 1; side += 2) {
            t.u[k] += side * h;
            press(&t);
            t.u[k] -= side * h;
            for (int64_t i = 0; i < n; i++) {
                const double part = side * t.force[i] / (2 * h) / sqrt(t.p.mass[i / 3] * t.p.mass[k / 3]);
                a[i * n + k] += part / 2;
                a[k * n + i] += part / 2;
            }
        }
    tled_curves(&t.p, 0, value);
    followers_move(&t.w, t.u);
    const double most = largest_of(a, n), limit = followers_square(&t.w, t.threads, value);
    ok(most > 0 && most <= limit && limit < 20 * most, "the bound of the load stiffness: %g times %g 1/s2",
       limit / most, most);
    ok(spread > 0 || fabs(followers_square_at_rest(&t.p) - limit) < 1e-12 * limit, "and that at rest");
    free(a);
    clear(&t);
}

int main(void)
{
    test_power();
    test_turn();
    test_bound("0 pressure ball 250\n", 0);
    test_bound("0 pressure ball 250\n", .002);
    test_bound("0 pressure ball:high 250\n", 0);
    test_bound("0 pressure ball:high -250\n0 pressure ball 40\n", .001);
    near_(followers_step(0, .5), .5, 0, "no pressure: the step of elements");
    return done_testing();
}
