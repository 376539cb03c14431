/* A case as the tools that show it: for ultrasound msds-run, whose frames us-slice makes images of; else tled-run.
 *
 *     mesh.sinew -> msds-run --live --+--> us-slice --live volume.nrrd -> images
 *                      ^ lines        |           ^ lines
 *                                     +--> frames
 */
#include "console/console.h"

#include "base/clock.h"
#include "base/mem.h"
#include "console/json.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { WORDS = 24 };

/* A command line; its words are borrowed. */
typedef struct command {
    char *word[WORDS];
    int count;
} command;

/* execv takes what it does not write as if it did. */
static void add_word(command *to, const char *word)
{
    union {
        const char *in;
        char *out;
    } same = {.in = word};
    to->word[to->count++] = same.out;
}

static void add_option(command *to, const char *name, const char *value)
{
    if (!value)
        return;
    add_word(to, name);
    add_word(to, value);
}

static void say(console *c, const char *level, const char *text)
{
    web_send(c->web, -1, MAIL_SAID, json_said(level, NULL, text));
}

/* ---- what is read of a case before a tool runs */

static int read_body(console *c, const console_case *is, err *e)
{
    if (source_open(&c->body, is->model, e))
        return -1;
    const model *m = &c->body.body;
    const model_array *node = model_need(m, "element.node", e), *muscle = model_find(m, "muscle.volume");
    if (!node)
        return -1;
    c->face = node->columns == 8;
    if (!c->face && !is->volume)
        return err_set(e, is->name, 0,
                       "the case has no volume; expected %s and a .nrrd, .mha or .mhd beside it, or "
                       "after it on the command line",
                       is->model);
    if (c->face && is->expressions && expression_names_read(&c->expressions, is->expressions, e))
        return -1;
    c->level = mem_array((muscle ? muscle->rows : 0) + c->expressions.count, sizeof *c->level, "muscles", e);
    if (!c->level || colouring_room_make(&c->colours, m, e))
        return -1;
    if ((!c->face || is->body) && around_read(&c->around, is, &c->body.body, e))
        return -1;
    c->scene = geometry_make(m, c->face, c->face ? "" : c->around.skin, e);
    return c->scene ? around_attach(&c->around, m, c->scene, e) : -1;
}

const char *console_muscle(const console *c, int64_t i)
{
    const model *m = &c->body.body;
    const model_array *of = c->level ? model_find(m, "muscle.volume") : NULL, *name = model_find(m, "volume.name");
    const int64_t muscles = of && name ? of->rows : 0;
    if (i < muscles)
        return name->str[of->i32[i]];
    return c->level && i - muscles < c->expressions.count ? c->expressions.name[i - muscles] : NULL;
}

/* A pose over the skin's middle, its face toward the tissue and just off it. */
static pose first_pose(const geometry *g)
{
    enum { OFF = 1 }; /* mm */
    const double *box = geometry_tissue(g), *up = geometry_up(g);
    pose at = pose_none();
    for (int a = 0; a < 3; a++) {
        const double middle = (box[a] + box[3 + a]) / 2, half = (box[3 + a] - box[a]) / 2;
        at.position[a] = middle + up[a] * (half + 1e-3 * OFF);
    }
    /* The shortest turn of +z to -up, both of length 1; half round where they are opposite. */
    double q[4] = {up[1], -up[0], 0, 1 - up[2]};
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[3] * q[3]);
    if (length < 1e-9)
        memcpy(at.quaternion, (const double[4]){1, 0, 0, 0}, sizeof at.quaternion);
    for (int i = 0; i < 4 && length >= 1e-9; i++)
        at.quaternion[i] = q[i] / length;
    return at;
}

/* ---- starting the tools */

/* The first number whose records are not there. */
static void name_records(console *c)
{
    static const char *const ends[2][2] = {{"msds", "slice"}, {"tled", "none"}};
    for (int n = 1;; n++) {
        bool there = false;
        for (int i = 0; i < 2; i++) {
            snprintf(c->records[i], CONSOLE_FILE, "%.3000s/%.255s-%d.%s.record", c->record, c->cases.list[c->open].name,
                     n, ends[c->face][i]);
            there |= !access(c->records[i], F_OK);
        }
        if (!there)
            return;
    }
}

static void add_records(const console *c, int which, bool replay, command *to)
{
    if (!replay)
        add_word(to, "--live");
    if (replay || c->recording)
        add_option(to, replay ? "--replay" : "--record", c->records[which]);
    if (!replay)
        add_option(to, "--control", CHILD_CONTROL);
}

static void command_of_compute(const console *c, bool replay, command *to)
{
    add_word(to, c->face ? "tled-run" : "msds-run");
    add_records(c, 0, replay, to);
    if (c->face) {
        add_option(to, "--precision", "single");
        add_option(to, "--results", "activation");
        add_option(to, "--expressions", c->cases.list[c->open].expressions);
        return;
    }
    if (!replay)
        add_option(to, "--poses", CHILD_CONTROL);
    add_option(to, "--probe", dials_value(&c->dials, "probe"));
    add_option(to, "--spring-scale", dials_value(&c->dials, "spring-scale"));
    add_option(to, "--skin", c->around.skin_path);
    if (c->around.skin_path)
        add_option(to, c->around.body_path ? "--body" : "--unit", c->around.body_path ? c->around.body_path : "mm");
}

static void command_of_slice(const console *c, const console_case *is, bool replay, command *to)
{
    add_word(to, "us-slice");
    add_records(c, 1, replay, to);
    add_option(to, "--labels", is->labels);
    add_word(to, "--"); /* no path is an option */
    add_word(to, is->volume);
}

static int start_child(console *c, child *is, command *line, int input, err *e)
{
    line->word[line->count] = NULL;
    const child_plan plan = {line->word[0], line->word, input, c, console_said};
    return child_start(is, &plan, e);
}

/* *to: where us-slice reads frames from. */
static int start_slice(console *c, bool replay, int *to, err *e)
{
    int fd[2];
    command line = {0};
    if (pipe(fd))
        return err_system(e, "us-slice", errno, "cannot make a pipe");
    fcntl(fd[1], F_SETFD, FD_CLOEXEC);
    command_of_slice(c, &c->cases.list[c->open], replay, &line);
    if (start_child(c, &c->slice, &line, fd[0], e)) {
        close(fd[1]);
        return -1;
    }
    *to = fd[1];
    c->has_slice = true;
    const images_plan plan = {c->slice.out,       "us-slice",          c,
                              console_time,       console_wants_image, console_wants_raw,
                              console_show_image, console_failed};
    c->slice.out = -1;
    c->images = images_open(&plan, e);
    return c->images ? 0 : -1;
}

static int start_compute(console *c, bool replay, int copy_to, err *e)
{
    const char *path = c->cases.list[c->open].model;
    command line = {0};
    const int input = open(path, O_RDONLY | O_CLOEXEC);
    command_of_compute(c, replay, &line);
    if (input < 0 || start_child(c, &c->compute, &line, input, e)) {
        if (input < 0)
            err_system(e, path, errno, "cannot open");
        if (copy_to >= 0)
            close(copy_to);
        return -1;
    }
    c->has_compute = true;
    const feed_plan plan = {.from = c->compute.out,
                            .tool = line.word[0],
                            .copy_to = copy_to,
                            .context = c,
                            .show = console_show,
                            .failed = console_failed,
                            .may_be_empty = true,
                            .stop = -1};
    c->compute.out = -1;
    c->feed = feed_open(&plan, e);
    return c->feed ? 0 : -1;
}

static int start_tools(console *c, bool replay, err *e)
{
    int to = -1;
    if (!c->face && start_slice(c, replay, &to, e)) {
        if (to >= 0)
            close(to);
        return -1;
    }
    if (start_compute(c, replay, to, e))
        return -1;
    if (c->face || replay)
        return 0;
    const pose at = first_pose(c->scene);
    return console_begin_pose(c, &at, e);
}

/* ---- opening and closing */

/* What a case begins with. */
static void begin_case(console *c, int index, bool replay)
{
    c->open = index;
    c->replaying = replay;
    c->paused = false;
    c->why[0] = '\0';
    c->told[0] = c->told[1] = false;
    c->pull_count = 0;
    c->began = clock_now();
    c->has_compute = c->has_slice = false;
    snprintf(c->method, sizeof c->method, "tissue");
    atomic_store(&c->colour, COLOURING_OWN);
    console_begin_showing(c);
}

static int open_case(console *c, int index, bool replay, err *e)
{
    const console_case *is = &c->cases.list[index];
    begin_case(c, index, replay);
    if (read_body(c, is, e))
        return -1;
    c->dials = c->face ? dials_of_tled() : dials_of_msds(c->around.skin_path != NULL);
    c->knobs = dials_of_slice(is->labels != NULL);
    if (c->recording && !replay)
        name_records(c);
    mail *scene = geometry_mail(c->scene, e);
    if (!scene)
        return -1;
    console_send_state(c);
    web_send(c->web, -1, MAIL_GEOMETRY, scene);
    return start_tools(c, replay, e);
}

int console_open(console *c, int index, bool replay, err *e)
{
    console_close(c);
    const int failed = open_case(c, index, replay, e);
    if (failed) {
        console_close(c);
        snprintf(c->why, sizeof c->why, "%.*s", CONSOLE_LINE - 1, e->text);
    }
    console_send_state(c);
    return failed;
}

static void drop_all(console *c)
{
    for (int slot = MAIL_GEOMETRY; slot < MAIL_SLOTS; slot++)
        web_drop(c->web, (mail_slot)slot);
}

void console_close(console *c)
{
    enum { GRACE = 2 }; /* s */
    if (c->has_compute)
        child_ask(&c->compute);
    if (c->has_slice)
        child_ask(&c->slice);
    if (c->has_compute)
        child_end(&c->compute, GRACE);
    if (c->has_slice)
        child_end(&c->slice, GRACE);
    feed_close(c->feed);
    images_close(c->images);
    c->feed = NULL;
    c->images = NULL;
    c->has_compute = c->has_slice = false;
    drop_all(c);
    geometry_free(c->scene);
    c->scene = NULL;
    around_free(&c->around);
    source_close(&c->body);
    c->body = (source){0};
    expression_names_free(&c->expressions);
    free(c->level);
    c->level = NULL;
    colouring_room_free(&c->colours);
    c->open = -1;
    c->replaying = false;
}

/* ---- children that ended */

static bool is_well(const child *is)
{
    return WIFEXITED(is->status) && !WEXITSTATUS(is->status);
}

static void tell_end(console *c, int which, child *is)
{
    char how[80], text[CONSOLE_LINE + 200];
    child_end(is, 0); /* and all that it said is heard */
    child_how(is, how, sizeof how);
    pthread_mutex_lock(&c->shared.lock);
    /* A tool that exits with a failure has said why in its last line; one that a signal killed has not. */
    const bool failed = WIFEXITED(is->status) && !is_well(is);
    snprintf(text, sizeof text, "%s %s%s%s", is->plan.tool, how, failed ? ": " : "",
             failed ? c->shared.said[which] : "");
    pthread_mutex_unlock(&c->shared.lock);
    say(c, c->replaying && is_well(is) ? "info" : "error", text);
    if (!is_well(is) || !c->replaying)
        snprintf(c->why, sizeof c->why, "%.*s", CONSOLE_LINE - 1, text);
    tool_say(c->t, "%s", text);
    c->told[which] = true;
}

void console_look(console *c)
{
    char why[CONSOLE_LINE + 200];
    const bool ended[2] = {c->has_compute && !c->told[0] && child_has_ended(&c->compute),
                           c->has_slice && !c->told[1] && child_has_ended(&c->slice)};
    if (ended[0])
        tell_end(c, 0, &c->compute);
    if (ended[1])
        tell_end(c, 1, &c->slice);
    pthread_mutex_lock(&c->shared.lock);
    const bool device = c->shared.device_is_new;
    c->shared.device_is_new = false;
    pthread_mutex_unlock(&c->shared.lock);
    err e = {0};
    if (console_steer(c, &e))
        say(c, "error", e.text);
    const bool lost = steering_has_lost(c->steering, why, sizeof why);
    if (lost) {
        say(c, "error", why);
        tool_say(c->t, "%s", why);
    }
    if (ended[0] || ended[1] || device || lost)
        console_send_state(c);
}
