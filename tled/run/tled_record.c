#include "tled/run/tled_record.h"

#include "base/checksum.h"
#include "base/num.h"
#include "cli/tool.h"
#include "model/hourglass_text.h"
#include "tled/loop/fingerprint.h"
#include "tled/run/tled_live.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MOST = 16, VALUE = 100 };

typedef struct list {
    record_of of[MOST];
    char value[MOST][VALUE];
    int count;
} list;

SINEW_PRINTF(3, 4) static void add(list *l, const char *key, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(l->value[l->count], VALUE, format, args);
    va_end(args);
    l->of[l->count] = (record_of){key, l->value[l->count]};
    l->count++;
}

static void add_number(list *l, const char *key, double value)
{
    char text[NUM_TEXT];
    num_text(value, false, text);
    add(l, key, "%s", text);
}

/* Of the model, one sum of those of all its parts; the script, the probe and the start have their own. */
static void add_sums(list *l, const fingerprint *f)
{
    static const char *const keys[] = {"script", "probe", "start"};
    uint32_t sum = 0;
    for (int64_t i = 0; i < f->parts; i++)
        if (!strncmp(f->part[i].name, "meta ", 5) || !strncmp(f->part[i].name, "array ", 6))
            sum = checksum_add(sum, &f->part[i].crc, sizeof f->part[i].crc);
    add(l, "model", "0x%08x", (unsigned)sum);
    for (int64_t i = 0; i < f->parts; i++)
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
            if (!strcmp(f->part[i].name, keys[k]))
                add(l, keys[k], "0x%08x", (unsigned)f->part[i].crc);
}

static void add_run(list *l, const session *s, double rate)
{
    char control[HOURGLASS_TEXT];
    hourglass_text(s->problem.control, control);
    add(l, "device", "%s", s->run.device->is.device);
    add(l, "precision", "%s", s->run.single ? "single" : "double");
    add_number(l, "rate", rate);
    add_number(l, "steps-a-second", s->run.rate * (double)live_parts(s->live));
    add_number(l, "damping", s->run.damping);
    add(l, "hourglass", "%s", control);
    add(l, "unit", "%s", s->script.unit ? s->script.unit : "source.unit");
    if (s->problem.sliding)
        add_number(l, "friction", s->problem.sliding->ground.friction);
    else if (s->problem.self_contact)
        add_number(l, "friction", s->problem.self_contact->friction);
    if (s->collider.poses) {
        add_number(l, "contact", s->collider.stiffness);
        add_number(l, "ramp", live_ramp(s->live));
    }
}

int record_begin(const session *s, double rate, const char *path, bool force, const char *replayed, record **to,
                 replay **from, err *e)
{
    const fingerprint_run run = {"", &s->m, &s->run, &s->problem, s->next_frame};
    list l = {.count = 0};
    fingerprint f = {0};
    int failed = (path || replayed) && fingerprint_make(&f, &run, e);
    if (!failed) {
        add(&l, "version", "%s", SINEW_VERSION);
        add_sums(&l, &f);
        add_run(&l, s, rate);
    }
    fingerprint_free(&f);
    if (!failed && path)
        failed = !(*to = record_create(path, force, "tled-run", l.of, l.count, e));
    if (!failed && replayed)
        failed = !(*from = replay_open(replayed, "tled-run", l.of, l.count, e));
    return failed ? -1 : 0;
}
