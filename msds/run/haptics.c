#include "msds/run/haptics.h"

#include "base/clock.h"
#include "base/mem.h"
#include "msds/tangent/probe_tangent.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* Iterations for each column: of a frame, and of one after frames without a contact. */
enum { USUALLY = 3, AT_FIRST = 12 };

struct haptics {
    session *s;
    probe_tangent *tangent;
    int64_t found; /* frames whose stiffness was */
    int64_t products;
    double took, longest; /* s: all of them, the longest */
};

typedef struct line {
    char text[BROADCAST_LINE];
    size_t length;
} line;

haptics *haptics_create(session *s, err *e)
{
    haptics *h = mem_array(1, sizeof *h, "haptics", e);
    if (!h)
        return NULL;
    h->s = s;
    h->tangent = probe_tangent_create(s->device, s->state, e);
    if (h->tangent)
        return h;
    free(h);
    return NULL;
}

void haptics_destroy(haptics *h)
{
    if (h)
        probe_tangent_destroy(h->tangent);
    free(h);
}

static void put(line *l, const char *format, ...) SINEW_PRINTF(2, 3);

static void put(line *l, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int length = vsnprintf(l->text + l->length, sizeof l->text - l->length, format, list);
    va_end(list);
    l->length += length > 0 ? (size_t)length : 0;
}

static void put_numbers(line *l, const double *number, int count)
{
    for (int i = 0; i < count; i++)
        put(l, " %.9g", number[i]);
}

/* To the frame that poses come in, whose axes differ where a body was given. */
static void put_turned(line *l, const session *s, const double v[3])
{
    double to[3] = {v[0], v[1], v[2]};
    if (s->o->body)
        pose_turn(s->around.volume.quaternion, v, to);
    put_numbers(l, to, 3);
}

/* A matrix of four 3 x 3 blocks, each of which is turned on both sides: first its columns' axes, then its rows'. */
static void turn_stiffness(const session *s, double k[6][6])
{
    double v[3], to[3];
    for (int i = 0; i < 6 && s->o->body; i++)
        for (int block = 0; block < 6; block += 3)
            pose_turn(s->around.volume.quaternion, (const double[3]){k[i][block], k[i][block + 1], k[i][block + 2]},
                      &k[i][block]);
    for (int j = 0; j < 6 && s->o->body; j++)
        for (int block = 0; block < 6; block += 3) {
            for (int a = 0; a < 3; a++)
                v[a] = k[block + a][j];
            pose_turn(s->around.volume.quaternion, v, to);
            for (int a = 0; a < 3; a++)
                k[block + a][j] = to[a];
        }
}

static int find(haptics *h, bool rested, probe_tangent_reading *r, err *e)
{
    const double began = clock_now();
    *r = (probe_tangent_reading){.left = 0};
    if (rested) {
        probe_tangent_forget(h->tangent);
        return 0;
    }
    if (probe_tangent_find(h->tangent, USUALLY, AT_FIRST, r, e))
        return -1;
    const double took = clock_now() - began;
    h->found++;
    h->products += r->products;
    h->took += took;
    h->longest = took > h->longest ? took : h->longest;
    return 0;
}

static void fill(line *l, const session *s, double came, const probe_tangent_reading *r)
{
    double row[7];
    const pose *end = press_end(&s->moves);
    const pose at = s->o->body ? pose_compose(&s->around.volume, end) : *end;
    pose_to_row(&at, row);
    put(l, "haptic %.9g %.6f %.6f %lld", s->time, came, clock_now(), (long long)s->reading.contacts);
    put_numbers(l, row, 7);
    put_turned(l, s, s->reading.force);
    put_turned(l, s, s->reading.torque);
    for (int i = 0; i < 6; i++)
        put_numbers(l, r->stiffness[i], 6);
    put(l, "\n");
}

int haptics_send(haptics *h, double came, bool rested, err *e)
{
    probe_tangent_reading r;
    line l = {.length = 0};
    if (!broadcast_clients(h->s->socket)) {
        probe_tangent_forget(h->tangent);
        return 0;
    }
    if (find(h, rested, &r, e))
        return -1;
    turn_stiffness(h->s, r.stiffness);
    fill(&l, h->s, came, &r);
    broadcast_send(h->s->socket, l.text, l.length);
    return 0;
}

void haptics_end(const haptics *h)
{
    const broadcast_counts c = broadcast_count(h->s->socket);
    const double frames = h->found > 0 ? (double)h->found : 1;
    tool_say(h->s->t, "haptics: %lld clients, %lld frames sent, %lld lost by clients that were slow",
             (long long)c.clients, (long long)c.lines, (long long)c.lost);
    tool_detail(h->s->t, "haptics: the stiffness took %.3g ms a frame, %.3g at most; %.3g products",
                1e3 * h->took / frames, 1e3 * h->longest, (double)h->products / frames);
}
