/* sinew-igtl-out: images, poses, surfaces and forces for programs that speak OpenIGTLink. */
#include "base/clock.h"
#include "base/mem.h"
#include "cli/tool.h"
#include "link/igtl_content.h"
#include "link/serve_hub.h"
#include "link/serve_images.h"
#include "link/serve_model.h"
#include "link/serve_poses.h"
#include "link/socket.h"
#include "live/feed.h"
#include "live/stop.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PORT = 18944, EXITING = 19 /* of STATUS */ };

struct options {
    opt_common common;
    const char *listen, *images, *poses, *control;
    bool pass;
    double rate;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {{OPT_INPUT, 0, "images", "FILE", OPT_TEXT, TO(images), 0, 0, NULL, OPT_FILE,
                                   "a FIFO of us-slice's images; -: standard input, and no model"},
                                  {OPT_INPUT, 0, "poses", "FILE", OPT_TEXT, TO(poses), 0, 0, NULL, OPT_FILE,
                                   "the probe's poses, a FIFO or - [default those of frames, or images]"},
                                  {OPT_ACTION, 0, "listen", "[ADDRESS:]PORT", OPT_TEXT, TO(listen), 0, 0, NULL,
                                   OPT_OUTPUT, "where clients connect; port 0: any [default 127.0.0.1:18944]"},
                                  {OPT_ACTION, 0, "rate", "HZ", OPT_NUMBER, TO(rate), 1e-3, 1e6, NULL, OPT_OUTPUT,
                                   "at most so many messages of a device a second [Hz; default all]"},
                                  {OPT_RESULT, 0, "control", "FILE", OPT_TEXT, TO(control), 0, 0, NULL, OPT_FILE,
                                   "us-slice's --control, a FIFO: what clients set goes there"},
                                  {OPT_RESULT, 0, "pass", NULL, OPT_FLAG, TO(pass), 0, 0, NULL, 0,
                                   "write the model on to standard output, as it comes"},
                                  {0}};

static const opt_tool table = {
    .name = "sinew-igtl-out",
    .command = "sinew igtl-out",
    .usage = "[options] < result\n--pass --images FIFO < result | us-slice volume > FIFO\n"
             "--images - [options] < images",
    .purpose =
        "Serves images, the probe's pose, moving surfaces and forces to programs that\nspeak OpenIGTLink, such as 3D "
        "Slicer.",
    .example = "us-slice --live --rigid --poses poses v.nrrd | sinew igtl-out --images -",
    .operands = "",
    .options = option_list,
};

/* All of one run. The error is the first of any thread. */
typedef struct job {
    const tool *t;
    const struct options *o;
    address at;
    int stop[2]; /* a pipe: closed to end reading */
    serve_board *board;
    serve_control *control;
    serve_us *us;
    serve_hub *hub;
    serve_model *model;
    feed *feed;
    serve_images *images;
    serve_poses *poses;
    int status; /* the board's number of it */
    bool is_ready;
    double asked;       /* s, by clock_now: when a signal came; 0: none has */
    atomic_bool showed; /* a frame */
    int64_t read;       /* frames */
    pthread_mutex_t lock;
    err wrong;
} job;

static bool is_input(const char *path)
{
    return path && !strcmp(path, "-");
}

static bool has_model(const struct options *o)
{
    return !is_input(o->images) && !is_input(o->poses);
}

static int check_options(const struct options *o, err *e)
{
    if (is_input(o->images) && is_input(o->poses))
        return err_usage(e, "--images - and --poses -: standard input is one of them; expected a FIFO for the other");
    if (o->pass && !has_model(o))
        return err_usage(e, "--pass is for the model on standard input; there is none with --images - or --poses -");
    if (o->common.output)
        return err_usage(e, "-o: nothing is written but the model, by --pass, to standard output");
    if (o->pass && isatty(STDOUT_FILENO))
        return err_option(e, "stdout", "is a terminal, and a model is not for reading; expected a pipe after --pass");
    return tool_need_stdin(has_model(o) ? "a model" : "images or poses", e);
}

/* ---- what threads say */

static void say(void *context, const char *line)
{
    const job *j = context;
    tool_say(j->t, "%s", line);
}

/* The first error ends the run; what a stop has cut off is none. */
static void failed(void *context, const err *e)
{
    job *j = context;
    pthread_mutex_lock(&j->lock);
    if (!stop_came())
        (void)err_join(&j->wrong, e); /* the first stands */
    pthread_mutex_unlock(&j->lock);
    serve_board_wake(j->board);
}

static void feed_failed(void *context, const char *name, const err *e)
{
    (void)name;
    failed(context, e);
}

static void show(void *context, const model *body, const frame *f)
{
    job *j = context;
    err e = {0};
    if (serve_model_show(j->model, body, f, &e))
        failed(j, &e);
    atomic_store(&j->showed, true);
}

/* Who reads what is passed on may go away, and clients are served on. */
static void cut(void *context, int code)
{
    job *j = context;
    err e = {0};
    if (code == EPIPE) {
        tool_say(j->t, "stdout: nobody reads the model any more; clients are served on");
        return;
    }
    err_system(&e, "stdout", code, "cannot write");
    failed(j, &e);
}

static int put_status(job *j, int code, const char *name, const char *text, err *e)
{
    igtl_buffer content = {0};
    igtl_status s = {.code = code, .text = text, .text_size = strlen(text)};
    snprintf(s.name, sizeof s.name, "%s", name);
    const int bad =
        igtl_write_status(&content, &s, e) || serve_board_put(j->board, j->status, igtl_now(), -1, &content, e);
    igtl_buffer_free(&content);
    return bad ? -1 : 0;
}

/* ---- whether it is over */

/* Poses of a FIFO have no end of their own. */
static bool inputs_ended(const job *j)
{
    return (!j->feed || feed_ended(j->feed)) && (!j->images || serve_images_ended(j->images)) &&
           (!is_input(j->o->poses) || serve_poses_ended(j->poses));
}

static bool has_failed(job *j)
{
    pthread_mutex_lock(&j->lock);
    const bool is = j->wrong.form != NULL;
    pthread_mutex_unlock(&j->lock);
    return is;
}

/* A signal that ends a whole pipe also ends its streams, soon. */
static bool is_stopped(job *j)
{
    static const double grace = 1; /* s */
    if (stop_came() && j->asked <= 0)
        j->asked = clock_now();
    return j->asked > 0 && clock_now() > j->asked + grace;
}

static bool over(void *context)
{
    job *j = context;
    err e = {0};
    const bool ends = has_failed(j) || inputs_ended(j) || is_stopped(j);
    if (!j->is_ready && (atomic_load(&j->showed) || (j->images && serve_images_count(j->images)))) {
        j->is_ready = true;
        if (put_status(j, IGTL_OK, "OK", "serving", &e))
            failed(j, &e);
    }
    if (ends && put_status(j, EXITING, "ending", "the input has ended", &e))
        failed(j, &e);
    return ends;
}

/* ---- beginning */

static int listen_at(job *j, err *e)
{
    char text[ADDRESS_MOST + 16], usual[16];
    snprintf(usual, sizeof usual, "%d", PORT);
    if (address_of(&j->at, j->o->listen ? j->o->listen : usual, e))
        return -1;
    const int fd = socket_listen(&j->at, e);
    if (fd < 0)
        return -1;
    const serve_hub_plan plan = {.listening = fd,
                                 .common = {j->board, j->us, isnan(j->o->rate) ? 0 : 1 / j->o->rate},
                                 .control = j->control,
                                 .context = j,
                                 .say = say,
                                 .over = over};
    j->hub = serve_hub_open(&plan, e);
    if (!j->hub)
        return -1;
    address_text(&j->at, text, sizeof text);
    tool_say(j->t, "listens on %s", text);
    return 0;
}

static int open_board(job *j, err *e)
{
    if (pipe(j->stop))
        return err_system(e, NULL, errno, "cannot make a pipe");
    j->board = serve_board_make(e);
    if (!j->board || (j->o->control && !(j->control = serve_control_open(j->o->control, e))))
        return -1;
    j->us = serve_us_make(j->control, e);
    j->status = j->us ? serve_board_add(j->board, "STATUS", "sinew", e) : -1;
    return j->status < 0 ? -1 : put_status(j, IGTL_NOT_READY, "starting", "nothing has come yet", e);
}

/* Standard output, as the feed's own, which it closes at the end. -1: there is none, or e is filled. */
static int take_output(const job *j, err *e)
{
    if (!j->o->pass)
        return -1;
    const int own = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3), nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (own < 0 || nothing < 0 || dup2(nothing, STDOUT_FILENO) < 0)
        err_system(e, "stdout", errno, "cannot write");
    if (nothing >= 0)
        close(nothing);
    return own;
}

static int open_model(job *j, int probe, err *e)
{
    j->model = serve_model_make(j->board, probe, e);
    const int own = j->model ? take_output(j, e) : -1, from = fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
    if (from < 0)
        err_system(e, "stdin", errno, "cannot read");
    if (e->form)
        return -1;
    const feed_plan plan = {.from = from,
                            .tool = "stdin",
                            .copy_to = own,
                            .context = j,
                            .show = show,
                            .failed = feed_failed,
                            .stop = j->stop[0],
                            .cut = cut};
    j->feed = feed_open(&plan, e);
    return j->feed ? 0 : -1;
}

/* Each input, in a thread of its own. The pose is from lines, or from frames, or else from images. */
static int open_inputs(job *j, err *e)
{
    const struct options *o = j->o;
    const bool frames = has_model(o);
    const int probe = serve_board_add(j->board, "TRANSFORM", "ProbeToReference", e);
    if (probe < 0)
        return -1;
    const serve_images_plan of_images = {o->images, o->poses || frames ? -1 : probe, j->stop[0], j->board, j->us, j,
                                         failed};
    const serve_poses_plan of_poses = {o->poses, probe, j->board, j, say, failed};
    if ((o->images && !(j->images = serve_images_open(&of_images, e))) ||
        (o->poses && !(j->poses = serve_poses_open(&of_poses, e))))
        return -1;
    if (!frames)
        return 0;
    return open_model(j, o->poses ? -1 : probe, e);
}

/* ---- the end */

static void say_counts(const job *j)
{
    const serve_hub_counts c = serve_hub_count(j->hub);
    char came[LINES_TEXT + 10] = "", refused[60] = "";
    if (j->poses) {
        const lines_counts list = serve_poses_count(j->poses);
        lines_text(&list, came);
        strcat(came, "; ");
    }
    if (c.refused)
        snprintf(refused, sizeof refused, ", %" PRId64 " refused", c.refused);
    tool_say(j->t,
             "%" PRId64 " frames, %" PRId64 " images; %s%" PRId64 " clients, %" PRId64 " dropped%s; %" PRId64
             " messages sent, %" PRId64 " left out as newer ones came",
             j->read, j->images ? serve_images_count(j->images) : 0, came, c.clients, c.dropped, refused, c.sent,
             c.lost);
}

static void end_inputs(job *j)
{
    if (j->stop[1] >= 0)
        close(j->stop[1]);
    if (j->feed)
        j->read = feed_count(j->feed);
    feed_close(j->feed);
    if (j->poses)
        serve_poses_end(j->poses);
}

static void close_all(job *j)
{
    serve_hub_close(j->hub);
    serve_images_close(j->images);
    serve_poses_close(j->poses);
    serve_model_free(j->model);
    serve_us_free(j->us);
    serve_control_close(j->control);
    serve_board_free(j->board);
    if (j->stop[0] >= 0)
        close(j->stop[0]);
    pthread_mutex_destroy(&j->lock);
}

static int run_tool(int argc, char **argv)
{
    static const double patience = 2; /* s: for what waits at the end */
    struct options o = {.rate = (double)NAN};
    err e = {0};
    tool t = {0};
    job j = {.t = &t, .o = &o, .stop = {-1, -1}};

    stop_catch();
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done || check_options(&o, &e))
        return tool_end(&t, &e);
    signal(SIGPIPE, SIG_IGN); /* who does not read any more is no reason to end */
    pthread_mutex_init(&j.lock, NULL);
    const bool ran =
        !open_board(&j, &e) && !listen_at(&j, &e) && !open_inputs(&j, &e) && !serve_hub_run(j.hub, patience, &e);
    end_inputs(&j);
    if (ran)
        say_counts(&j);
    close_all(&j);
    (void)err_join(&e, &j.wrong); /* tool_end says it */
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
