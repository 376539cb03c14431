/* Frames of msds-run on a card that the processor plays (tests/emulate): what they take of a state, in the model's
 * order and precision, while the state goes on; and how many tetrahedra are inverted there, as counted here.
 */
#include "tap.h"

#ifdef SINEW_EMULATED

#include "base/mem.h"
#include "msds/problem/simplex.h"
#include "tests/emulate/emulate.h"
#include "tests/emulate/emulated_frames.h"

#include <stdlib.h>
#include <string.h>

enum { NODES = 301, OWN = 312, ELEMENTS = 700, SOME = 90, SENT = 6, FOUR = 4 * OWN, THREE = 3 * OWN };

static uint32_t seed = 1;

static uint32_t draw(uint32_t most)
{
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) % most;
}

static double coordinate(void)
{
    return (double)draw(1u << 20) / (1 << 20) - .5;
}

/* A mesh without any order, whose nodes stand anywhere among those of the slices. */
typedef struct mesh {
    msds_problem p;
    sell order;
    int32_t own[NODES], corner[4 * ELEMENTS];
    double position[THREE];
} mesh;

static void make_mesh(mesh *k)
{
    int32_t place[OWN];
    for (int i = 0; i < OWN; i++)
        place[i] = i;
    for (int i = 0; i < NODES; i++) {
        const int32_t other = i + (int32_t)draw((uint32_t)(OWN - i)), was = place[i];
        place[i] = place[other];
        place[other] = was;
        k->own[i] = place[i];
    }
    for (int i = 0; i < 4 * ELEMENTS; i++)
        k->corner[i] = (int32_t)draw(NODES);
    for (int i = 0; i < THREE; i++)
        k->position[i] = coordinate();
    k->p = (msds_problem){.nodes = NODES, .elements = ELEMENTS, .element_node = k->corner};
    k->order = (sell){.nodes = OWN, .own_node = k->own};
}

/* A state, in single precision, and in double where `precise`. */
typedef struct state {
    float u[FOUR], v[FOUR];
    double wide[THREE];
    bool precise;
} state;

static void make_state(state *s, bool precise)
{
    for (int i = 0; i < FOUR; i++)
        s->u[i] = (float)coordinate(), s->v[i] = (float)coordinate();
    for (int i = 0; i < THREE; i++)
        s->wide[i] = coordinate();
    s->precise = precise;
}

static double moved(const state *s, int64_t own, int64_t a)
{
    return s->precise ? s->wide[3 * own + a] : (double)s->u[4 * own + a];
}

static int64_t count_here(const mesh *k, const state *s)
{
    int64_t count = 0;
    for (int t = 0; t < ELEMENTS; t++) {
        double x[4][3];
        for (int c = 0; c < 4; c++)
            for (int a = 0; a < 3; a++) {
                const int64_t own = k->own[k->corner[4 * t + c]];
                x[c][a] = k->position[3 * own + a] + moved(s, own, a);
            }
        count += !(simplex_volume(x[0], x[1], x[2], x[3]) > 0);
    }
    return count;
}

/* Whether a frame has what frames take of the state, and nothing else. */
static bool is_of(const mesh *k, const msds_frames *of, const state *s, const msds_values *got)
{
    const int64_t count = of->displacement ? NODES : of->count;
    bool good = !got->velocity == !of->velocity && !(got->precise && got->displacement) &&
                (got->precise || got->displacement || !count);
    for (int64_t i = 0; i < 3 * count && good; i++) {
        const double want = moved(s, k->own[of->displacement ? i / 3 : of->node[i / 3]], i % 3);
        good = s->precise ? got->precise && got->precise[i] == want
                          : got->displacement && (double)got->displacement[i] == want;
    }
    for (int64_t i = 0; i < 3 * NODES && good && of->velocity; i++)
        good = got->velocity[i] == s->v[4 * k->own[i / 3] + i % 3];
    return good;
}

/* Two are on their way at a time, and the state goes on. */
static void test_frames(const msds_frames *of, bool mixed, const char *name)
{
    static mesh k;
    static state s[SENT];
    bool good = true;
    int64_t inverted = 0, wrong = 0;
    err e = {0};
    make_mesh(&k);
    emulated_frames *f = emulated_frames_make(of, &k.p, &k.order, k.position, &e);
    for (int i = 0; i < SENT && f && good; i++) {
        int64_t count = -1;
        msds_values got;
        make_state(&s[i], mixed && i % 3 == 1);
        good = !emulated_frames_put(f, s[i].u, s[i].v, s[i].precise ? s[i].wide : NULL, &e) &&
               !emulated_frames_send(f, i % MSDS_SLOTS, &e) && !emulated_frames_count(f, &count, &e) &&
               (i < 1 || (!emulated_frames_wait(f, (i - 1) % MSDS_SLOTS, &got, &e) && is_of(&k, of, &s[i - 1], &got)));
        inverted += count;
        wrong += count != count_here(&k, &s[i]);
    }
    ok(f && good && !e.status, "%s: what frames take, in the model's order; %s", name, e.text);
    ok(!wrong && inverted > SENT, "and %lld tetrahedra are inverted, as here", (long long)inverted);
    if (f)
        emulated_frames_free(f);
}

int main(void)
{
    static int32_t some[SOME];
    const emulated_card card = {.capability = 90, .processors = 2, .seed = 5};
    const struct {
        const char *name;
        msds_frames of;
    } all[] = {{"all", {true, true, NULL, 0}},
               {"displacements", {true, false, NULL, 0}},
               {"displacements of some", {false, false, some, SOME}},
               {"velocities, and displacements of some", {false, true, some, SOME}},
               {"velocities", {false, true, NULL, 0}},
               {"nothing", {false, false, NULL, 0}}};
    if (!emulate(&card)) {
        skip(1, "this processor has no fused operations");
        return done_testing();
    }
    for (int i = 0; i < SOME; i++)
        some[i] = 3 * i + (int32_t)draw(3);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        for (int mixed = 0; mixed < 2; mixed++)
            test_frames(&all[i].of, mixed, all[i].name);
    return done_testing();
}

#else

int main(void)
{
    skip(1, "no g++ for x86-64");
    return done_testing();
}

#endif
