/* What frames of msds-run have of the nodes: by snapshots, of which a second thread makes the arrays while the state
 * goes on, they have the bytes of frames that are made of the whole state; and snapshots are asked for no more than
 * frames take.
 */
// needs: msds/mesh/mesh_tets.c msds/run/frame_nodes.c
#include "msds/run/frame_nodes.h"

#include "base/out.h"
#include "model/stream.h"
#include "msds_block.h"
#include "tap.h"

enum { FRAMES = 7, VERTICES = 3 };

/* A device whose numbers change with each frame, in single precision or, where `precise`, in double. */
struct msds_state {
    int64_t nodes, count;
    double *u;
    float *v;
    bool precise;
    msds_frames of;
    int32_t *node;
    struct {
        float *u, *v;
        double *precise;
        bool is_precise;
    } slot[MSDS_SLOTS];
};

/* The state of frame i; every third is in double. */
static void go_to(msds_state *s, int64_t i, bool mixed)
{
    s->precise = mixed && i % 3 == 2;
    for (int64_t k = 0; k < 3 * s->nodes; k++) {
        const double x = 1e-3 * (double)(i + 1) / (double)(k + 3);
        s->u[k] = s->precise ? x : (double)(float)x;
        s->v[k] = (float)(-7 * x);
    }
}

static int get(msds_state *s, int what, double *to, err *e)
{
    (void)e;
    for (int64_t k = 0; k < 3 * s->nodes; k++)
        to[k] = what == MSDS_DISPLACEMENT ? s->u[k] : (double)s->v[k];
    return 0;
}

static int frames(msds_state *s, const msds_frames *of, err *e)
{
    s->of = *of;
    s->count = of->displacement ? s->nodes : of->count;
    s->node = mem_array(s->count, sizeof *s->node, "test", e);
    for (int64_t i = 0; i < s->count; i++)
        s->node[i] = of->displacement ? (int32_t)i : of->node[i];
    for (int i = 0; i < MSDS_SLOTS; i++) {
        s->slot[i].u = mem_array(s->count, 3 * sizeof(float), "test", e);
        s->slot[i].v = mem_array(s->nodes, 3 * sizeof(float), "test", e);
        s->slot[i].precise = mem_array(s->count, 3 * sizeof(double), "test", e);
    }
    return 0;
}

static int snapshot(msds_state *s, int slot, err *e)
{
    (void)e;
    s->slot[slot].is_precise = s->precise;
    for (int64_t i = 0; i < s->count; i++)
        for (int a = 0; a < 3; a++) {
            const double x = s->u[3 * s->node[i] + a];
            s->slot[slot].precise[3 * i + a] = s->precise ? x : NAN;
            s->slot[slot].u[3 * i + a] = s->precise ? NAN : (float)x;
        }
    memcpy(s->slot[slot].v, s->v, 3 * (size_t)s->nodes * sizeof *s->v);
    return 0;
}

static int fetch(msds_state *s, int slot, msds_values *to, err *e)
{
    const bool precise = s->slot[slot].is_precise;
    (void)e;
    *to = (msds_values){.displacement = precise ? NULL : s->slot[slot].u,
                        .precise = precise ? s->slot[slot].precise : NULL,
                        .velocity = s->of.velocity ? s->slot[slot].v : NULL};
    return 0;
}

static const msds_executor whole = {.get = get},
                           by_snapshots = {.get = get, .frames = frames, .snapshot = snapshot, .fetch = fetch};

static void state_free(msds_state *s)
{
    for (int i = 0; i < MSDS_SLOTS; i++) {
        free(s->slot[i].u);
        free(s->slot[i].v);
        free(s->slot[i].precise);
    }
    free(s->node);
    free(s->u);
    free(s->v);
}

/* ---- a model with a bound triangle */

static void add_axis(model *m, const char *name, int64_t count)
{
    err e = {0};
    tets_must(!model_axis_add(m, name, count, &e), &e);
}

static void make_model(model *m)
{
    static const tets block = {{5, 4, 3}, {.04, .03, .02}, 1e4, .45, 1000, 2, false};
    err e = {0};
    tets_make(&block, m);
    add_axis(m, "probe", 1);
    add_axis(m, "vessel/vertex", VERTICES);
    add_axis(m, "vessel/face", 1);
    add_axis(m, "vessel/corner", VERTICES);
    add_axis(m, "vessel/group", 1);
    tets_array(m, "vessel/vertex.position");
    double *weight = tets_array(m, "vessel/vertex.weight")->f64;
    int32_t *element = tets_array(m, "vessel/vertex.element")->i32;
    int32_t *vertex = tets_array(m, "vessel/face.vertex")->i32;
    tets_array(m, "vessel/face.start");
    tets_array(m, "vessel/face.group");
    tets_must(!model_set_text(tets_array(m, "vessel/group.name"), 0, "vessel", &e), &e);
    for (int v = 0; v < VERTICES; v++) {
        const double of[4] = {.1, .2, .3, .4};
        memcpy(weight + 4 * v, of, sizeof of);
        element[v] = 11 * v + 2;
        vertex[v] = v;
    }
}

/* ---- runs */

typedef struct trial {
    frame_nodes n;
    frame_choice choice;
    model_writer *w;
} trial;

static int put(void *context, frame *f, err *e)
{
    trial *t = context;
    return frame_nodes_end(&t->n, f, true, e) || model_write_frame(t->w, f, e) ? -1 : 0;
}

static void choose(trial *t, const model *m, const char *list)
{
    static const char *const names[] = {"node.displacement", "node.velocity", "probe.force"};
    err e = {0};
    const opt_list options = {.value = {list}, .count = list ? 1 : 0};
    for (int i = 0; i < 3; i++)
        tets_must(!frame_choice_offer(&t->choice, names[i], 0, &e), &e);
    tets_must(!frame_choice_offer_bound(&t->choice, m, &e) && !frame_choice_read(&t->choice, &options, &e) &&
                  !frame_choice_open(&t->choice, m, &e),
              &e);
}

static void send_frames(trial *t, frame_queue *q, msds_state *s, const model *m, bool mixed)
{
    err e = {0};
    for (int64_t i = 0; i < FRAMES; i++) {
        go_to(s, i, mixed);
        frame *f = frame_queue_next(q, &e);
        tets_must(f != NULL, &e);
        f->index = i - 3;
        f->time = (double)i;
        tets_must(!frame_nodes_begin(&t->n, f, &e), &e);
        if (i == 4) { /* seldom: of all nodes, whatever frames take */
            const double *u = frame_nodes_displacement(&t->n, f, &e);
            tets_must(u && !memcmp(u, s->u, 3 * (size_t)s->nodes * sizeof *u), &e);
        }
        model_array *force = frame_queue_array(f, m, "probe.force", &e);
        tets_must(force != NULL, &e);
        force->f64[2] = -(double)i;
        tets_must(!frame_nodes_end(&t->n, f, false, &e), &e);
        go_to(s, i + 100, false); /* it goes on */
        tets_must(!frame_queue_send(q, &e), &e);
    }
}

/* All that a run writes; asked: how many nodes snapshots had to take the displacement of. */
static out *run(const model *m, const msds_executor *device, const char *list, bool mixed, int64_t *asked)
{
    err e = {0};
    trial t = {.n = {.device = device}};
    msds_state s = {.nodes = model_count(m, "node")};
    const msds_problem p = {.nodes = s.nodes};
    pool *threads = pool_create(2, &e);
    out *o = out_memory(&e);
    s.u = mem_array(s.nodes, 3 * sizeof *s.u, "test", &e);
    s.v = mem_array(s.nodes, 3 * sizeof *s.v, "test", &e);
    t.w = o ? model_writer_open(o, false, &e) : NULL;
    tets_must(threads && s.u && s.v && t.w && !model_write(t.w, m, &e), &e);
    choose(&t, m, list);
    t.n.state = &s;
    tets_must(!frame_nodes_make(&t.n, &p, &t.choice, m, threads, &e), &e);
    frame_queue *q = frame_queue_open(put, &t, false, &e);
    tets_must(q != NULL, &e);
    send_frames(&t, q, &s, m, mixed);
    tets_must(!frame_queue_close(q, &e), &e);
    if (asked)
        *asked = s.count;
    frame_nodes_free(&t.n);
    frame_choice_free(&t.choice);
    state_free(&s);
    pool_destroy(threads);
    model_writer_close(t.w);
    return o;
}

static bool same(out *a, out *b)
{
    size_t size[2];
    const unsigned char *at[2] = {out_bytes(a, &size[0]), out_bytes(b, &size[1])};
    return size[0] == size[1] && size[0] > 0 && !memcmp(at[0], at[1], size[0]);
}

int main(void)
{
    static const struct {
        const char *list;
        int64_t most; /* nodes that are asked of snapshots; 0: all, -1: none */
    } choices[] = {{NULL, 0},
                   {"displacement,velocity,probe.force", 0},
                   {"displacement:f32", 0},
                   {"displacement:f32,velocity:f32,surfaces", 0},
                   {"displacement,surfaces:f32", 0},
                   {"velocity,surfaces", 4 * VERTICES},
                   {"velocity:f32,probe.force:f32", -1},
                   {"surfaces", 4 * VERTICES},
                   {"surfaces:f32,probe", 4 * VERTICES},
                   {"probe", -1}};
    model m = {0};
    make_model(&m);
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++)
        for (int mixed = 0; mixed < 2; mixed++) {
            const int64_t nodes = model_count(&m, "node"), most = choices[i].most;
            int64_t asked;
            out *want = run(&m, &whole, choices[i].list, mixed, NULL);
            out *got = run(&m, &by_snapshots, choices[i].list, mixed, &asked);
            ok(same(want, got), "%s%s: the same bytes by snapshots", choices[i].list ? choices[i].list : "all",
               mixed ? ", some frames in double" : "");
            ok(most > 0 ? asked > 0 && asked <= most : asked == (most ? 0 : nodes), "that ask for %lld of %lld nodes",
               (long long)asked, (long long)nodes);
            out_discard(want);
            out_discard(got);
        }
    model_free(&m);
    return done_testing();
}
