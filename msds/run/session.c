#include "msds/run/session.h"

#include "base/clock.h"
#include "probe/probe_carry.h"
#include "surface/scale.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SUBSTEPS_MOST = 1000 };

/* Algorithm 1's constant, or 0 for auto. */
static int read_scale(const char *text, double *scale, err *e)
{
    num_length length;
    if (!strcmp(text, "auto")) {
        *scale = 0;
        return 0;
    }
    if (num_length_of(text, &length))
        return err_usage(e, "--spring-scale %.100s; expected a length above 0, such as .002, or auto", text);
    *scale = num_length_in(length, num_unit_of("m"), num_unit_of("m"));
    return *scale > 0 ? 0
                      : err_usage(e, "--spring-scale %.100s; expected a length above 0, such as .002, or auto", text);
}

/* Scales inertia, or cuts the step, until the step of springs is stable in every configuration. */
static int choose_step(session *s, err *e)
{
    const struct options *o = s->o;
    msds_problem *p = &s->problem;
    s->stable = largest_step(s->largest.rest, o->damping);
    s->sure = largest_step(s->largest.bound, o->damping);
    s->substeps = 1;
    if (o->mass == MASS_LUMPED)
        s->substeps = s->sure < o->dt ? (int64_t)fmin(ceil(o->dt / s->sure), 1e15) : 1;
    else
        p->mass_factor = fmax(1, largest_factor(s->largest.bound, o->damping, o->dt));
    if (s->substeps > SUBSTEPS_MOST)
        return err_set(e, NULL, 0, "--dt %g is %.3g times the stable step; expected at most %.3g s, or --mass stable",
                       o->dt, o->dt / s->sure, SUBSTEPS_MOST * s->sure);
    return 0;
}

/* Once, and only where springs move the tissue. */
static void say_springs(session *s)
{
    const struct options *o = s->o;
    const msds_problem *p = &s->problem;
    if (s->springs_told)
        return;
    s->springs_told = true;
    tool_say(s->t, "springs: %lld; k = %.6g m E", (long long)p->springs, p->scale);
    tool_say(s->t, "springs: stable step %.4g ms at rest, %.4g ms in any configuration, dt %.4g ms", 1e3 * s->stable,
             1e3 * s->sure, 1e3 * o->dt);
    if (o->mass == MASS_STABLE)
        tool_say(s->t, "springs: inertia is %.6g times the mass, for that step", p->mass_factor);
    else if (s->substeps > 1)
        tool_say(s->t, "springs: each step is cut into %lld", (long long)s->substeps);
}

static int read_options(const struct options *o, msds_options *to, err *e)
{
    *to = (msds_options){
        .damping = o->damping, .repulsion = o->repulsion, .friction = o->friction, .penalty = o->contact};
    for (int a = 0; a < 3 && o->gravity.count; a++)
        to->gravity[a] = o->gravity.value[a];
    return read_scale(o->scale, &to->scale, e);
}

static int read_cavities(session *s, err *e)
{
    const struct options *o = s->o;
    const cavities_said said = {o->cavity, o->outflow, o->wall};
    if (cavities_read(&s->cavities, &said, &s->m, e))
        return -1;
    if (s->cavities.count && (o->method != METHOD_TISSUE || o->compare))
        return err_usage(e, "--cavity with %s%s; expected --method tissue", o->compare ? "--compare" : "--method ",
                         o->compare ? "" : methods_words[o->method]);
    cavities_put(&s->cavities, &s->problem);
    return 0;
}

static int make_problem(session *s, err *e)
{
    const struct options *o = s->o;
    msds_options options;
    if (read_options(o, &options, e) || msds_problem_make(&s->problem, &s->m, &options, e) ||
        model_axis_add(&s->m, "probe", 1, e))
        return -1;
    if (read_cavities(s, e))
        return -1;
    tool_say(s->t, "%lld nodes, %lld tetrahedra", (long long)s->problem.nodes, (long long)s->problem.elements);
    if (o->probe && probe_carry(&s->probe, &s->m, &s->warnings, e))
        return -1;
    return largest_of(&s->problem, &s->largest, e) || choose_step(s, e) ? -1 : 0;
}

int session_provenance(const session *s, tool *t, err *e)
{
    char shape[300] = "";
    const struct options *o = s->o;
    if (o->probe) {
        char text[280];
        probe_text(&s->probe, text, sizeof text);
        snprintf(shape, sizeof shape, "--probe %s ", text);
    }
    return tool_provenance(
        t, e,
        "%s--method %s --iterations %lld --rate %.9g --dt %.9g --mass %s --spring-scale %.9g --damping %.9g "
        "--contact %s --repulsion %.9g [%s, inertia %.9g, %lld substeps]",
        shape, methods_words[o->method], (long long)o->iterations, o->rate, o->dt, o->mass ? "lumped" : "stable",
        s->problem.scale, o->damping, o->contact ? "penalty" : "prescribed", o->repulsion, s->device->is.device,
        s->problem.mass_factor, (long long)s->substeps);
}

static int start_from(session *s, const frame *last, err *e)
{
    const model_array *last_pose = frame_find(last, "probe.pose");
    s->next_frame = last->index + 1;
    s->time = last->time;
    if (last_pose && last_pose->rows == 1 && (s->o->probe || s->o->live || s->o->replay)) {
        const pose from = pose_of_row(last_pose->f64);
        press_from(&s->press, &from, last->time);
    }
    if (msds_problem_start(&s->problem, last, e))
        return -1;
    return s->skin.vertices ? skin_model_start(&s->skin, last, e) : 0;
}

/* What frames have of the probe, or of where one would be. */
static int offer_probe(session *s, err *e)
{
    static const char *const names[] = {"probe.pose", "probe.force", "probe.torque"};
    const struct options *o = s->o;
    const int none = o->probe || o->live || o->replay ? 0 : FRAME_CHOICE_EMPTY;
    s->frames.empty = "--probe too, or other arrays";
    for (int i = 0; i < 3; i++)
        if (frame_choice_offer(&s->frames, names[i], none | (i || o->poses ? 0 : FRAME_CHOICE_PERHAPS), e))
            return -1;
    return 0;
}

/* What frames can have, and what --frames chooses of it. */
static int choose_frames(session *s, err *e)
{
    frame_choice *c = &s->frames;
    if (frame_choice_offer(c, "node.displacement", 0, e) || frame_choice_offer(c, "node.velocity", 0, e) ||
        offer_probe(s, e))
        return -1;
    if (s->skin.vertices && skin_model_offer(&s->skin, c, e))
        return -1;
    return frame_choice_offer_bound(c, &s->m, e) || frame_choice_read(c, &s->o->frames, e) ? -1 : 0;
}

/* Of a record it is told first whether it is one of this model at all. */
static int follow(session *s, const frame *last, err *e)
{
    const char *where = stage_name(&s->stage);
    if (!s->o->replay)
        return frame_choice_follow(&s->frames, last, where, e);
    frame_choice_follow(&s->frames, last, where, &s->unfit);
    return 0;
}

/* Passes on the frames that came, and starts from the last. */
static int take_frames(session *s, err *e)
{
    frame last = {0};
    const int64_t count = stage_last_frame(&s->stage, &s->m, true, &last, e);
    const int failed = count > 0 && (start_from(s, &last, e) || follow(s, &last, e)) ? -1 : 0;
    frame_free(&last);
    return count < 0 ? -1 : failed;
}

/* Flushed, as a frame is to be seen when it is there. */
static int put_frame(void *context, frame *f, err *e)
{
    session *s = context;
    const int failed = frame_nodes_end(&s->of_nodes, f, true, e) || model_write_frame(s->stage.writer, f, e) ? -1 : 0;
    out_flush(s->stage.sink);
    return failed;
}

int session_finish(session *s, bool ended, err *e)
{
    frame_queue *q = s->queue;
    const double each = (double)(s->posed - 1);
    s->queue = NULL;
    if (frame_queue_close(q, e))
        return -1;
    if (ended && !s->o->live && !s->o->replay && s->posed > 1)
        tool_detail(s->t, "a frame took %.4g ms, of which the solver %.4g ms, in the mean of the %.0f after the first",
                    1e3 * (clock_now() - s->first_done) / each, 1e3 * s->solving / each, each);
    return 0;
}

int session_start(session *s, err *e)
{
    if (take_frames(s, e) || frame_choice_open(&s->frames, &s->m, e) || press_bones(&s->press, &s->m, e) ||
        openness_make(&s->openness, &s->problem, e))
        return -1;
    s->inverted = (inverted){.p = &s->problem, .threads = s->threads};
    s->state = s->device->create(&s->problem, s->threads, e);
    if (!s->state)
        return -1;
    s->of_nodes = (frame_nodes){.device = s->device, .state = s->state};
    if (frame_nodes_make(&s->of_nodes, &s->problem, &s->frames, &s->m, s->threads, e))
        return -1;
    if (s->o->compare) {
        s->other = compare_make(&s->problem, s->device, s->threads, e);
        if (!s->other)
            return -1;
    }
    out_flush(s->stage.sink);
    s->queue = frame_queue_open(put_frame, s, s->o->live, e);
    return s->queue ? 0 : -1;
}

void session_method(session *s, method_word method)
{
    s->method = methods_with(method, s->o->exact, s->o->warp);
    if (s->method != METHOD_MSDS)
        s->last_fem = s->method;
    if (s->method == METHOD_MSDS)
        say_springs(s);
}

static int read_probe(session *s, err *e)
{
    const struct options *o = s->o;
    return o->probe ? probe_read(&s->probe, o->probe, o->unit, o->common.anonymous, &s->m, e) : 0;
}

/* The skin's surface joins the model, where --body has it, if it does; its springs are made when there are threads. */
static int carry_skin(session *s, err *e)
{
    if (!s->o->skin)
        return 0;
    skin_source from = {.path = s->o->skin, .around = &s->around, .part = body_find(&s->around, s->o->skin)};
    num_unit unit = from.part ? 0 : scale_unit(s->o->unit, &s->m, e);
    if (!unit && !from.part)
        return -1;
    from.scale = unit ? scale_of(unit) : 1;
    return skin_model_carry(&s->m, &from, s->o->common.anonymous, s->skin_name, &s->warnings, e);
}

static skin_options skin_options_of(const struct options *o)
{
    return (skin_options){o->skin_stiffness, o->skin_anchors, o->skin_tension, o->damping, o->dt};
}

static int make_skin(session *s, err *e)
{
    const skin_options options = skin_options_of(s->o);
    surface shape;
    if (!s->o->skin)
        return 0;
    if (surface_of(&s->m, s->skin_name, &shape, e) || skin_make(&s->skin, &shape, &options, s->threads, e))
        return -1;
    s->skin.device = s->device->skin;
    tool_say(s->t, "skin %s: %lld vertices, %lld springs", s->skin_name, (long long)s->skin.vertices,
             (long long)s->skin.edges);
    return 0;
}

int session_slides(const session *s, method_word method, double friction, err *e)
{
    const method_word is = methods_with(method, s->o->exact, s->o->warp);
    if (!(friction > 0) || methods_solver(is) == MSDS_FEM || methods_solver(is) == MSDS_TISSUE)
        return 0;
    return err_usage(e,
                     "--friction %g with the method %s, by which tissue slides on the probe; expected fem, warp or "
                     "tissue, or --friction 0",
                     friction, methods_words[is]);
}

static const char *const device_names[] = {"auto", "cuda", "cpu"};

/* As far as it is known: cavities are the model's. */
static executor_need need_of(const session *s)
{
    const struct options *o = s->o;
    const method_word method = (method_word)o->method;
    const uint32_t later = o->warp && method == METHOD_MSDS ? EXECUTOR_WARP : 0; /* where FEM begins */
    const uint32_t more = (o->friction > 0 ? EXECUTOR_FRICTION : 0) | (s->cavities.count ? EXECUTOR_CAVITIES : 0) |
                          (o->haptics ? EXECUTOR_TANGENT : 0);
    return (executor_need){.features = methods_features(methods_with(method, o->exact, o->warp)) | more |
                                       (o->device ? 0 : later)};
}

void session_ahead(session *s)
{
    const executor_need need = need_of(s);
    executor_ahead_start(&s->ahead, msds_executors, device_names[s->o->device], &need);
}

static int choose_device(session *s, err *e)
{
    const struct options *o = s->o;
    if (session_slides(s, (method_word)o->method, o->friction, e))
        return -1;
    const executor_need need = need_of(s);
    char device[300];
    executor_ahead_wait(&s->ahead);
    s->device =
        msds_executor_of(executor_choose(msds_executors, device_names[o->device], &need, device, sizeof device, e));
    int threads = tool_threads(s->t, e);
    s->threads = s->device && threads > 0 ? pool_create(threads, e) : NULL;
    if (s->threads)
        tool_say(s->t, "%s", device);
    return s->threads ? 0 : -1;
}

int session_prepare(session *s, err *e)
{
    const struct options *o = s->o;
    if (placing_read(&s->placing, s->o->body, s->o->marker, &s->around, e) || read_probe(s, e) || carry_skin(s, e) ||
        make_problem(s, e) || choose_device(s, e))
        return -1;
    s->last_fem = methods_with(METHOD_FEM, o->exact, o->warp);
    session_method(s, (method_word)o->method);
    if (o->compare)
        say_springs(s);
    if (make_skin(s, e) || choose_frames(s, e))
        return -1;
    return press_make(&s->press, &s->problem, &s->probe, o->iterations, o->rate, e);
}

static int change_probe(session *s, err *e)
{
    probe made = {0};
    const struct options *o = s->o;
    if (o->probe && probe_read(&made, o->probe, o->unit, o->common.anonymous, &s->m, e)) {
        probe_free(&made);
        return -1;
    }
    probe_free(&s->probe);
    s->probe = made;
    return 0;
}

/* Inertia is found from springs without a factor. */
static int change_problem(session *s, session_part part, err *e)
{
    msds_problem *p = &s->problem;
    msds_options options;
    if (read_options(s->o, &options, e))
        return -1;
    if (part == SESSION_SPRINGS)
        msds_problem_change(p, &options);
    else
        p->options = options;
    p->mass_factor = 1;
    if ((part == SESSION_SPRINGS && largest_of(p, &s->largest, e)) || choose_step(s, e) ||
        s->device->change(s->state, e))
        return -1;
    return s->other ? s->device->change(s->other->state, e) : 0;
}

int session_change(session *s, session_part part, err *e)
{
    const skin_options options = skin_options_of(s->o);
    const bool of_problem = part == SESSION_FORCES || part == SESSION_STEP || part == SESSION_SPRINGS;
    if (part == SESSION_PROBE)
        return change_probe(s, e);
    if (part == SESSION_CAVITIES)
        return cavities_change(&s->cavities, s->o->cavity, &s->m, e);
    if (part == SESSION_PACE)
        press_pace(&s->press, s->o->iterations, s->o->rate);
    if (of_problem && change_problem(s, part, e))
        return -1;
    if (s->skin.vertices && part != SESSION_PACE && part != SESSION_FORCES)
        return skin_change(&s->skin, &options, e);
    return 0;
}

void session_leave(session *s)
{
    compare_free(s->other, s->device);
    if (s->state)
        s->device->destroy(s->state);
    skin_free(&s->skin);
    s->other = NULL;
    s->state = NULL;
}

void session_free(session *s)
{
    executor_ahead_end(&s->ahead);
    broadcast_close(s->socket);
    session_leave(s);
    frame_nodes_free(&s->of_nodes);
    frame_choice_free(&s->frames);
    inverted_free(&s->inverted);
    openness_free(&s->openness);
    pool_destroy(s->threads);
    for (int i = 0; i < SESSION_TEXTS; i++)
        free(s->text[i]);
    press_free(&s->press);
    body_free(&s->around);
    msds_problem_free(&s->problem);
    probe_free(&s->probe);
    model_free(&s->m);
}
