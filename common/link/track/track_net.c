#include "link/track/track_net.h"

#include "base/clock.h"

#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define CONNECT    3.0 /* s: the most that one try to connect takes */
#define PAUSE      0.2 /* s between the first tries */
#define PAUSE_MOST 2.0

enum { PORT = 18944, ROUNDS = 64 /* pieces of 64 KiB of one peer at a time, so that none keeps the others waiting */ };

int track_net_listen(track_net *n, const char *text, err *e)
{
    address at;
    n->listens = true;
    if (address_of(&at, text, e))
        return -1;
    n->listening = socket_listen(&at, e);
    if (n->listening < 0)
        return -1;
    address_text(&at, n->place, sizeof n->place);
    tool_say(n->t, "listening at %s", n->place);
    return 0;
}

int track_net_connect_to(track_net *n, const char *text, err *e)
{
    n->pause = PAUSE;
    if (socket_name(text, "HOST:PORT", PORT, n->host, n->digits, e))
        return -1;
    snprintf(n->place, sizeof n->place, strchr(n->host, ':') ? "[%s]:%s" : "%s:%s", n->host, n->digits);
    return socket_known(n->host, n->digits, e);
}

/* ---- coming and going */

/* The peer at i has gone. */
static void drop(track_net *n, track *k, int i)
{
    track_peer *p = n->peer[i];
    const bool speaks = track_peer_speaks(p);
    n->is_mute = !speaks && !n->listens;
    n->pause = speaks ? PAUSE : n->pause;
    n->ended = clock_now();
    n->next = n->ended + n->pause;
    track_forget(k, p);
    track_peer_free(p);
    n->peer[i] = n->peer[--n->peers];
}

static void add(track_net *n, track *k, int fd, const char *place)
{
    err e = {0};
    track_peer *p = track_peer_make(fd, place, track_wants, k, &e);
    if (p && !track_peer_ask(p, &n->ask, &e)) {
        n->peer[n->peers++] = p;
        n->connections++;
        return;
    }
    track_warn(n->t, "%s", e.text);
    track_peer_free(p);
}

static void accept_all(track_net *n, track *k)
{
    char from[ADDRESS_MOST + 16];
    int fd;
    while ((fd = socket_accept(n->listening, from, sizeof from)) >= 0) {
        if (n->peers < TRACK_PEERS) {
            tool_say(n->t, "%s: connected", from);
            add(n, k, fd, from);
            continue;
        }
        close(fd);
        if (!n->told_many)
            track_warn(n->t, "%s: turned away, as others are: %d programs are connected, the most there can be", from,
                       TRACK_PEERS);
        n->told_many = true;
    }
}

static void try_to_connect(track_net *n, track *k)
{
    err e = {0};
    const int fd = socket_connect(n->host, n->digits, CONNECT, &e);
    const double now = clock_now();
    n->next = now + n->pause;
    n->pause = n->pause * 2 < PAUSE_MOST ? n->pause * 2 : PAUSE_MOST;
    if (fd < 0) {
        if (!n->told && !(n->ended > 0))
            track_warn(n->t, "%s; trying until it listens", e.text);
        n->told = true;
        return;
    }
    if (n->ended > 0 && !n->is_mute)
        track_warn(n->t, "%s: connected again after %.1f s", n->place, now - n->ended);
    else if (!n->is_mute)
        tool_say(n->t, "%s: connected", n->place);
    add(n, k, fd, n->place);
}

/* ---- what comes */

/* 1: all that has come was taken; 0: the stream is lost, for the reason in *lost; -1 with e filled. */
static int take_messages(track *k, track_peer *p, err *lost, err *e)
{
    igtl_message m;
    for (;;) {
        switch (igtl_reader_next(p->reader, &m, lost)) {
        case IGTL_MORE:
            return 1;
        case IGTL_LOST:
            return 0;
        case IGTL_WRONG:
            track_skip(k, lost);
            break;
        case IGTL_MESSAGE:
            if (track_take(k, p, &m, clock_now(), e))
                return -1;
            break;
        }
    }
}

/* The connection of peer i has ended, or is of no use any more: `why`, where there is a reason. */
static void end_peer(track_net *n, track *k, int i, const err *why)
{
    const track_peer *p = n->peer[i];
    const char *cut = igtl_reader_inside(p->reader) ? " inside a message" : "";
    const char *more = n->listens ? "" : "; trying to connect again";
    const bool told = n->is_mute && !track_peer_speaks(p);
    if (why->status && !told)
        track_warn(n->t, "%s%s", why->text, more);
    else if ((*cut || !n->listens) && !told)
        track_warn(n->t, "%s: the connection has ended%s%s", p->place, cut, more);
    else if (!told)
        tool_say(n->t, "%s: the connection has ended", p->place);
    drop(n, k, i);
}

/* Reads what peer i has sent. 0, also where it has gone; -1 with e filled. */
static int read_peer(track_net *n, track *k, int i, err *e)
{
    track_peer *p = n->peer[i];
    err why = {0};
    for (int round = 0; round < ROUNDS; round++) {
        const track_came came = track_peer_receive(p, &why);
        if (came == TRACK_NOTHING)
            return 0;
        const int taken = came == TRACK_BYTES ? take_messages(k, p, &why, e) : 0;
        if (taken < 0)
            return -1;
        if (taken)
            continue;
        if (came == TRACK_BYTES && !n->listens && n->connections == 1 && !track_peer_speaks(p))
            return err_join(e, &why); /* it never spoke OpenIGTLink: a wrong port */
        end_peer(n, k, i, &why);
        return 0;
    }
    return 0;
}

static int take_all(track_net *n, track *k, const struct pollfd *p, err *e)
{
    /* From the last on: one that goes is replaced by one that was looked at. */
    for (int i = n->peers - 1; i >= 0; i--)
        if (p[i].revents && read_peer(n, k, i, e))
            return -1;
    return 0;
}

static double until_next(const track_net *n, const track *k, double wait)
{
    const double left = n->next - clock_now();
    if (k->lines.size)
        wait = fmin(wait, 2e-3);
    if (!n->listens && !n->peers)
        wait = fmin(wait, fmax(left, 0));
    return wait;
}

int track_net_round(track_net *n, track *k, double wait, err *e)
{
    struct pollfd p[TRACK_PEERS + 2];
    const int peers = n->peers;
    if (!n->listens && !peers && clock_now() >= n->next)
        try_to_connect(n, k);
    for (int i = 0; i < n->peers; i++)
        p[i] = (struct pollfd){.fd = n->peer[i]->fd, .events = POLLIN};
    p[n->peers] = (struct pollfd){.fd = k->lines.fd}; /* its reader's going is seen */
    p[n->peers + 1] = (struct pollfd){.fd = n->listens ? n->listening : -1, .events = POLLIN};
    if (poll(p, (nfds_t)n->peers + 2, (int)(1e3 * until_next(n, k, wait) + .5)) <= 0)
        return track_pass(k, clock_now(), n->peers > 0, e);
    const short output = p[n->peers].revents, listening = p[n->peers + 1].revents;
    if (output & (POLLERR | POLLHUP))
        k->lines.gone = true;
    if (take_all(n, k, p, e))
        return -1;
    if (listening)
        accept_all(n, k);
    return track_pass(k, clock_now(), n->peers > 0, e);
}

void track_net_close(track_net *n)
{
    while (n->peers)
        track_peer_free(n->peer[--n->peers]);
    if (n->listening >= 0)
        close(n->listening);
    n->listening = -1;
}
