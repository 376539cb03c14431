/* sinew-console: a page in a browser on tools that run live. */
#include "base/path.h"
#include "cli/installed.h"
#include "cli/tool.h"
#include "console/console.h"
#include "console/json.h"
#include "live/stop.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct options {
    opt_common common;
    const char *listen, *record, *page, *three, *poses, *igtl_out;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {{OPT_INPUT, 0, "page", "FOLDER", OPT_TEXT, TO(page), 0, 0, NULL, OPT_FILE,
                                   "another copy of the page [default that which was installed]"},
                                  {OPT_INPUT, 0, "three", "FOLDER", OPT_TEXT, TO(three), 0, 0, NULL, OPT_FILE,
                                   "another copy of three.js [default /usr/share/javascript/three]"},
                                  {OPT_INPUT, 0, "poses", "SOURCE", OPT_TEXT, TO(poses), 0, 0, "spnav:|igtl:", OPT_FILE,
                                   "move the probe too: a FIFO, spnav: or igtl:HOST:PORT,NAME"},
                                  {OPT_ACTION, 0, "listen", "[ADDRESS:]PORT", OPT_TEXT, TO(listen), 0, 0, NULL, 0,
                                   "where to serve it [default 127.0.0.1 and a free port]"},
                                  {OPT_ACTION, 0, "igtl-out", "[ADDRESS:]PORT", OPT_TEXT, TO(igtl_out), 0, 0, NULL, 0,
                                   "serve the probe's pose by OpenIGTLink there, as igtl-out does"},
                                  {OPT_RESULT, 0, "record", "FOLDER", OPT_TEXT, TO(record), 0, 0, NULL, OPT_FILE,
                                   "record every run there, and save there"},
                                  {0}};

static const opt_tool table = {
    .name = "sinew-console",
    .command = "sinew console",
    .usage = "[options] case...\n[options] model [volume] ...",
    .purpose = "Serves a page for a browser on models that move: a probe is dragged over the\nskin, or a face is "
               "pulled, while msds-run and us-slice, or tled-run, run live.",
    .example = "sinew console case",
    .operands = "case...",
    .operands_min = 1,
    .operands_max = 1000,
    .options = option_list,
};

/* ---- folders */

static bool has_file(const char *folder, const char *name)
{
    char path[CONSOLE_FILE];
    return snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path && !access(path, R_OK);
}

/* Where the page's files lie. */
static int find_page(char folder[INSTALLED_PATH], err *e)
{
    if (installed_find("share/sinew/console", "common/console/page", "index.html", folder))
        return 0;
    return err_set(e, NULL, 0, "the page's files are not where they were installed; expected --page FOLDER");
}

static int check_folders(struct options *o, char page[INSTALLED_PATH], err *e)
{
    if (!o->page && find_page(page, e))
        return -1;
    o->page = o->page ? o->page : page;
    o->three = o->three ? o->three : "/usr/share/javascript/three";
    if (!has_file(o->page, "index.html"))
        return err_set(e, o->page, 0, "there is no index.html; expected the folder of the page");
    if (!has_file(o->three, "build/three.module.js"))
        return err_set(e, o->three, 0,
                       "there is no build/three.module.js; expected three.js (the package libjs-three), "
                       "or its folder in --three");
    if (o->record && mkdir(o->record, 0777) && errno != EEXIST)
        return err_system(e, o->record, errno, "cannot make the folder");
    return o->record && access(o->record, W_OK | X_OK) ? err_system(e, o->record, errno, "cannot write there") : 0;
}

/* ---- running */

static void on_said(void *context, int client, const char *text, size_t size)
{
    console *c = context;
    message m;
    err e = {0};
    if (message_read(text, size, &m, &e))
        web_send(c->web, client, MAIL_SAID, json_said("error", NULL, e.text));
    else
        inbox_put(c->inbox, client, &m);
}

static int start(console *c, const struct options *o, char token[ORIGIN_TOKEN], err *e)
{
    if (address_of(&c->at, o->listen, e) || (!address_is_local(&c->at) && origin_token(token, e)))
        return -1;
    c->token = address_is_local(&c->at) ? NULL : token;
    c->inbox = inbox_make(e);
    if (!c->inbox)
        return -1;
    const web_plan plan = {c->at, c->token, o->page, o->three, c, on_said, console_file};
    c->web = web_open(&plan, e);
    if (!c->web)
        return -1;
    c->at.port = web_port(c->web);
    const steering_plan steers = {o->poses, o->igtl_out, c, console_steered, console_heard};
    if (!o->poses && !o->igtl_out)
        return 0;
    c->steering = steering_open(&steers, e);
    return c->steering ? 0 : -1;
}

static int put_address(const console *c, const char *path, err *e)
{
    char url[ORIGIN_URL];
    out *to = out_open(path, false, e);
    if (!to)
        return -1;
    origin_url(&c->at, c->token, url, sizeof url);
    out_format(to, "%s\n", url);
    return out_close(to, e);
}

/* A case that cannot be opened is told on the page too; where it is the only one, the console ends. */
static int open_first(console *c, err *e)
{
    if (c->cases.count == 1)
        return console_open(c, 0, false, e);
    console_send_state(c);
    return 0;
}

static int go(console *c, const struct options *o, err *e)
{
    static const double often = .05; /* s */
    message m;
    int client;
    if (open_first(c, e) || put_address(c, o->common.output, e))
        return -1;
    while (!stop_came()) {
        if (inbox_take(c->inbox, often, &client, &m))
            console_take(c, client, &m);
        console_look(c);
    }
    return 0;
}

static void finish(console *c)
{
    if (c->inbox)
        inbox_end(c->inbox);
    steering_close(c->steering);
    c->steering = NULL;
    if (c->web)
        console_close(c);
    web_close(c->web);
    inbox_free(c->inbox);
    console_remove_folder(c);
    cases_free(&c->cases);
    pthread_mutex_destroy(&c->shared.lock);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {0};
    char page[INSTALLED_PATH], token[ORIGIN_TOKEN];
    err e = {0};
    tool t = {0};
    static const console none = {.open = -1};
    console *c = NULL;

    stop_catch();
    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        return tool_end(&t, &e);
    signal(SIGPIPE, SIG_IGN); /* a tool or a page that went away is no reason to end */
    c = malloc(sizeof *c);
    if (!c) {
        err_memory(&e, "the console");
        return tool_end(&t, &e);
    }
    *c = none;
    c->t = &t;
    c->record = o.record;
    c->recording = o.record != NULL;
    pthread_mutex_init(&c->shared.lock, NULL);
    if (!check_folders(&o, page, &e) && !cases_add(&c->cases, t.operand, t.operands, &e) && !start(c, &o, token, &e))
        (void)go(c, &o, &e);
    finish(c);
    free(c);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
