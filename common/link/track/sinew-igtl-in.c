/* sinew-igtl-in: poses that other programs send by OpenIGTLink, as lines. */
#include "base/clock.h"
#include "cli/tool.h"
#include "link/track/track_net.h"
#include "live/stop.h"

#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>

struct options {
    opt_common common;
    const char *listen, *transform;
    double rate, timeout, list;
    int protocol, space;
};

#define TO(field) offsetof(struct options, field)
static const opt option_table[] = {{OPT_INPUT, 0, "listen", "[ADDRESS:]PORT", OPT_TEXT, TO(listen), 0, 0, NULL, 0,
                                    "wait there for programs that connect, in place of HOST"},
                                   {OPT_INPUT, 0, "transform", "NAME", OPT_TEXT, TO(transform), 0, 0, NULL, 0,
                                    "device or tool to take [default the one there is]"},
                                   {OPT_INPUT, 0, "space", "lps|ras", OPT_CHOICE, TO(space), 0, 0, "lps|ras", 0,
                                    "in which the poses are sent [default ras]"},
                                   {OPT_INPUT, 0, "rate", "HZ", OPT_NUMBER, TO(rate), .001, 1000, NULL, 0,
                                    "poses a second to ask for by STT_TDATA [Hz; default 100]"},
                                   {OPT_INPUT, 0, "protocol", "2|3", OPT_CHOICE, TO(protocol), 0, 0, "2|3", 0,
                                    "to speak: with 3, PLUS says what is tracked [default 2]"},
                                   {OPT_INPUT, 0, "timeout", "SECONDS", OPT_NUMBER, TO(timeout), 0, 86400, NULL, 0,
                                    "without a pose, it is lost; 0: never [s; default 1]"},
                                   {OPT_ACTION, 0, "list", "SECONDS", OPT_NUMBER, TO(list), .01, 86400, NULL, 0,
                                    "print what is sent in that time, and end [s]"},
                                   {0}};

static const opt_tool table = {
    .name = "sinew-igtl-in",
    .command = "sinew igtl-in",
    .usage = "[options] HOST[:PORT] | msds-run --live --poses - ...\n[options] --listen [ADDRESS:]PORT > fifo",
    .purpose = "Writes the poses that PLUS, 3D Slicer or a tracker sends by OpenIGTLink as lines\n"
               "that --poses reads: time tx ty tz qx qy qz qw.",
    .example = "sinew igtl-in --transform ProbeToReference localhost:18944 > fifo",
    .operands = "HOST[:PORT]",
    .operands_max = 1,
    .options = option_table,
};

static int open_net(track_net *n, const tool *t, const struct options *o, err *e)
{
    if (t->operands == (o->listen != NULL)) /* both, or none */
        return err_usage(e, "%s; expected one of these", o->listen ? "HOST and --listen" : "neither HOST nor --listen");
    return o->listen ? track_net_listen(n, o->listen, e) : track_net_connect_to(n, t->operand[0], e);
}

/* Until a signal comes, the lines' reader goes, or it is `until`. */
static int go(track_net *n, track *k, double until, err *e)
{
    static const double often = .1; /* s: to see that a signal came */
    while (!stop_came() && !k->lines.gone && clock_now() < until)
        if (track_net_round(n, k, fmin(often, fmax(0, until - clock_now())), e))
            return -1;
    return 0;
}

static int print_names(const track_net *n, const track *k, const char *path, err *e)
{
    if (!n->connections)
        return err_set(e, n->place, 0, n->listens ? "nothing has connected" : "cannot connect");
    if (!k->names.count)
        return err_set(e, n->place, 0, "nothing has come");
    out *to = out_open(path, false, e);
    if (!to)
        return -1;
    out_text(to, "# type        a second    count  name\n");
    for (int i = 0; i < k->names.count; i++) {
        const track_row *row = &k->names.row[i];
        out_format(to, "%-12s %9.1f %8" PRId64 "  %s\n", row->type, track_names_rate(row), row->count, row->name);
    }
    return out_close(to, e);
}

static int list(track_net *n, track *k, const struct options *o, err *e)
{
    k->lines.fd = -1;
    if (go(n, k, clock_now() + o->list, e))
        return -1;
    return print_names(n, k, o->common.output, e);
}

static int follow(track_net *n, track *k, const struct options *o, err *e)
{
    char text[TRACK_TEXT];
    if (track_lines_open(&k->lines, o->common.output, e))
        return -1;
    int failed = go(n, k, INFINITY, e);
    track_net_close(n);
    failed = track_lines_close(&k->lines, failed != 0, .5, e);
    track_text(k, text);
    if (!k->lines.gone && !failed)
        tool_say(k->t, "%s; %" PRId64 " connection%s", text, n->connections, n->connections == 1 ? "" : "s");
    return failed;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.rate = 100, .timeout = 1, .list = NAN, .space = SPACE_RAS};
    err e = {0};
    tool t = {0};
    track_net net = {.t = &t, .listening = -1};
    track *k = NULL;
    stop_catch();
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        return tool_end(&t, &e);
    signal(SIGPIPE, SIG_IGN); /* a reader that goes away is seen by poll, and senders are told then */
    const track_plan plan = {o.transform, (space)o.space, o.timeout, !isnan(o.list)};
    net.ask = (track_ask){o.rate, o.protocol == 1};
    k = calloc(1, sizeof *k);
    if (!k) {
        err_memory(&e, "poses");
        return tool_end(&t, &e);
    }
    k->t = &t;
    k->plan = &plan;
    if (!open_net(&net, &t, &o, &e))
        (void)(plan.only_names ? list : follow)(&net, k, &o, &e);
    track_net_close(&net);
    free(k);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
