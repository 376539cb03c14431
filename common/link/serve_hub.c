#include "link/serve_hub.h"

#include "base/clock.h"
#include "base/mem.h"
#include "link/igtl_content.h"
#include "link/socket.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

enum { LISTEN, BELL, CONTROL, OTHERS, SPARE = 32 /* descriptors that others need */, BUSY = 6 /* of STATUS */ };

struct serve_hub {
    serve_hub_plan plan;
    int most, count;
    serve_client *client[SERVE_CLIENTS];
    struct pollfd poll[OTHERS + SERVE_CLIENTS];
    serve_hub_counts counts; /* of clients that went away, too */
};

serve_hub *serve_hub_open(const serve_hub_plan *plan, err *e)
{
    struct rlimit limit;
    serve_hub *h = mem_array(1, sizeof *h, "clients", e);
    if (!h) {
        close(plan->listening);
        return NULL;
    }
    h->plan = *plan;
    h->most = SERVE_CLIENTS;
    if (!getrlimit(RLIMIT_NOFILE, &limit) && limit.rlim_cur < SERVE_CLIENTS + SPARE)
        h->most = limit.rlim_cur > SPARE ? (int)limit.rlim_cur - SPARE : 1;
    return h;
}

/* ---- clients that go */

/* why: it is dropped; NULL: it went by itself. The last client takes its place. */
static void remove_client(serve_hub *h, int i, const err *why)
{
    char line[sizeof *why + 40];
    serve_client *c = h->client[i];
    if (why) {
        snprintf(line, sizeof line, "%s; it is dropped", why->text);
        h->plan.say(h->plan.context, line);
        h->counts.dropped++;
    }
    h->counts.sent += serve_client_sent(c);
    h->counts.lost += serve_client_lost(c);
    serve_client_free(c);
    h->client[i] = h->client[--h->count];
}

/* After a read or write of a client. True: it is gone. */
static bool is_gone(serve_hub *h, int i, int result, const err *e)
{
    if (result)
        remove_client(h, i, result < 0 ? e : NULL);
    return result != 0;
}

/* ---- clients that come */

/* Says why, and closes. */
static void refuse(serve_hub *h, int fd, const char *from)
{
    char text[80], line[300];
    err ignored = {0};
    igtl_buffer content = {0}, message = {0};
    snprintf(text, sizeof text, "%d clients are served; expected fewer", h->count);
    const igtl_status s = {.code = BUSY, .name = "busy", .text = text, .text_size = strlen(text)};
    const igtl_about about = {.version = 1, .type = "STATUS", .device = "sinew", .stamp = igtl_now()};
    if (!igtl_write_status(&content, &s, &ignored) && !igtl_write(&message, &about, content.at, content.size, &ignored))
        (void)send(fd, message.at, (size_t)message.size, MSG_NOSIGNAL); /* or it sees the end alone */
    igtl_buffer_free(&content);
    igtl_buffer_free(&message);
    close(fd);
    if (!h->counts.refused++) {
        snprintf(line, sizeof line, "client %s is refused: %s; others like it are, too", from, text);
        h->plan.say(h->plan.context, line);
    }
}

static void accept_all(serve_hub *h)
{
    char from[SERVE_FROM], line[sizeof(err) + SERVE_FROM + 40];
    int fd;
    while ((fd = socket_accept(h->plan.listening, from, sizeof from)) >= 0) {
        err e = {0};
        if (h->count == h->most) {
            refuse(h, fd, from);
            continue;
        }
        serve_client *c = serve_client_make(fd, from, &h->plan.common, &e);
        snprintf(line, sizeof line, "client %s: %s", from, c ? "connected" : e.text);
        h->plan.say(h->plan.context, line);
        if (c) {
            h->client[h->count++] = c;
            h->counts.clients++;
        }
    }
}

/* ---- all of them */

/* What a client has sent, where its connection says that there is something. True: it is gone. */
static bool read_client(serve_hub *h, int i, short events)
{
    err e = {0};
    return events & (POLLIN | POLLHUP | POLLERR) && is_gone(h, i, serve_client_read(h->client[i], &e), &e);
}

static bool write_client(serve_hub *h, int i, bool last)
{
    err e = {0};
    if (is_gone(h, i, serve_client_write(h->client[i], last, &e), &e))
        return true;
    if (serve_client_stuck(h->client[i]) <= SERVE_PATIENCE)
        return false;
    err_set(&e, serve_client_from(h->client[i]), 0, "has taken nothing for %d s", SERVE_PATIENCE);
    remove_client(h, i, &e);
    return true;
}

/* From the last to the first: who takes the place of one that goes was looked at. */
static void look_at_clients(serve_hub *h, int count, bool last)
{
    for (int i = count - 1; i >= 0; i--)
        if (!read_client(h, i, h->poll[OTHERS + i].revents))
            (void)write_client(h, i, last); /* whether it is gone, nobody else asks */
}

/* What to wait for; returns for how many ms at most. */
static int prepare(serve_hub *h, int lines)
{
    const double often = lines ? .05 : .25; /* s: a signal, or a reader of controls, rings no bell */
    double until = clock_now() + often;
    h->poll[LISTEN] = (struct pollfd){.fd = h->plan.listening, .events = POLLIN};
    h->poll[BELL] = (struct pollfd){.fd = serve_board_bell(h->plan.common.board), .events = POLLIN};
    h->poll[CONTROL] = serve_control_waits(h->plan.control);
    for (int i = 0; i < h->count; i++) {
        const serve_client *c = h->client[i];
        h->poll[OTHERS + i] = (struct pollfd){.fd = serve_client_fd(c), .events = serve_client_events(c)};
        until = fmin(until, serve_client_due(c));
    }
    return (int)ceil(1e3 * fmax(0, until - clock_now()));
}

static int wait_and_look(serve_hub *h, bool last, err *e)
{
    const int count = h->count, lines = serve_control_write(h->plan.control);
    if (poll(h->poll, OTHERS + (nfds_t)count, prepare(h, lines)) < 0 && errno != EINTR)
        return err_system(e, NULL, errno, "cannot wait for clients");
    if (h->poll[BELL].revents)
        serve_board_heard(h->plan.common.board);
    look_at_clients(h, count, last);
    if (h->poll[LISTEN].revents)
        accept_all(h);
    return 0;
}

/* Whether something still waits that a client could take. */
static bool is_waiting(const serve_hub *h)
{
    for (int i = 0; i < h->count; i++)
        if (serve_client_is_full(h->client[i]))
            return true;
    return false;
}

int serve_hub_run(serve_hub *h, double seconds, err *e)
{
    while (!h->plan.over(h->plan.context))
        if (wait_and_look(h, false, e))
            return -1;
    const double until = clock_now() + seconds;
    serve_board_wake(h->plan.common.board);
    do {
        if (wait_and_look(h, true, e))
            return -1;
    } while ((is_waiting(h) || serve_control_write(h->plan.control)) && clock_now() < until);
    return 0;
}

serve_hub_counts serve_hub_count(const serve_hub *h)
{
    serve_hub_counts all = h->counts;
    for (int i = 0; i < h->count; i++) {
        all.sent += serve_client_sent(h->client[i]);
        all.lost += serve_client_lost(h->client[i]);
    }
    return all;
}

void serve_hub_close(serve_hub *h)
{
    if (!h)
        return;
    for (int i = 0; i < h->count; i++) {
        shutdown(serve_client_fd(h->client[i]), SHUT_WR);
        serve_client_free(h->client[i]);
    }
    close(h->plan.listening);
    free(h);
}
