#include "msds/run/msds_record.h"

#include "base/checksum.h"
#include "base/mem.h"
#include "msds/run/frame_report.h"
#include "msds/run/settings.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char rest[] = "rest";

/* What a record is of. */
typedef struct origin {
    char probe[200], model[RECORD_WORD], start[RECORD_WORD], cavities[RECORD_WORD];
    record_of list[6];
    int count;
} origin;

/* A probe of a file is the model's; another is a setting. */
static void name_probe(const session *s, char *to, size_t size)
{
    snprintf(to, size, "setting");
    if (s->o->probe && s->probe.kind == PROBE_CONVEX)
        probe_text(&s->probe, to, size);
}

static void sum_start(const session *s, char to[RECORD_WORD])
{
    const msds_problem *p = &s->problem;
    const size_t bytes = 3 * (size_t)p->nodes * sizeof *p->displacement;
    uint32_t crc = checksum_add(checksum_add(0, p->displacement, bytes), p->velocity, bytes);
    if (s->skin.vertices)
        crc = checksum_add(crc, s->skin.u, 3 * (size_t)s->skin.vertices * sizeof *s->skin.u);
    snprintf(to, RECORD_WORD, "0x%08" PRIx32, crc);
}

static void find_origin(const session *s, origin *o)
{
    name_probe(s, o->probe, sizeof o->probe);
    record_model(&s->m, o->model);
    sum_start(s, o->start);
    o->list[0] = (record_of){"device", s->device->is.device};
    o->list[1] = (record_of){"probe", o->probe};
    o->list[2] = (record_of){"skin", s->skin.vertices ? s->skin_name : "none"};
    o->list[3] = (record_of){"model", o->model};
    o->list[4] = (record_of){"start", o->start};
    o->count = 5;
    if (!s->cavities.count) /* as records had it before there were any */
        return;
    cavities_text(&s->cavities, &s->m, o->cavities, sizeof o->cavities);
    o->list[o->count++] = (record_of){"cavities", o->cavities};
}

record *msds_record_create(const session *s, err *e)
{
    origin of;
    char text[SETTINGS_TEXT];
    find_origin(s, &of);
    record *r = record_create(s->o->record, s->o->force, run_options_table.name, of.list, of.count, e);
    if (!r)
        return NULL;
    record_setting(r, "method %s", methods_words[s->method]);
    for (int i = 0; i < settings_count(); i++)
        if (settings_text(s, i, text))
            record_setting(r, "%s", text);
    return r;
}

void msds_record_add(record *r, session *s, const frame_input *from, bool rested)
{
    record_frame f = {.index = s->next_frame - 1,
                      .time = from->time,
                      .has_pose = from->has_pose,
                      .at = from->at,
                      .steps = s->moves.asked,
                      .of = -1};
    snprintf(f.path, sizeof f.path, "%s", rested ? rest : methods_words[s->used]);
    record_add(r, &f, &s->warnings);
}

int msds_record_probe(session *s, err *e)
{
    keyfile k;
    int got;
    char **own = &s->text[SESSION_TEXTS - 1];               /* no setting's */
    if (s->o->probe && !strncmp(s->o->probe, "convex:", 7)) /* of a file, which a record has not */
        return 0;
    in *source = in_open(s->o->replay, e);
    if (!source)
        return -1;
    keyfile_open(&k, source);
    while ((got = keyfile_next(&k, e)) > 0 && strcmp(k.word[0], "frame") != 0)
        if (k.count == 3 && !strcmp(k.word[0], "set") && !strcmp(k.word[1], "probe") &&
            strcmp(k.word[2], "none") != 0) {
            *own = mem_text(k.word[2], e);
            got = *own ? 0 : -1;
            s->o->probe = *own;
            break;
        }
    in_close(source);
    return got < 0 ? -1 : 0;
}

static int replay_frame(session *s, const keyfile *k, const record_frame *f, err *e)
{
    const bool rested = !strcmp(f->path, rest);
    const int method = rested ? (int)s->method : methods_find(f->path);
    if (method < 0 || f->steps < 0)
        return keyfile_error(k, e, "expected steps=N, and path= with a method or %s", rest);
    if (f->index != s->next_frame || f->time < s->time)
        return keyfile_error(k, e, "frame %" PRId64 " at %.9g s; expected frame %" PRId64 ", at %.9g s or later",
                             f->index, f->time, s->next_frame, s->time);
    const frame_input from = {.time = f->time,
                              .has_pose = f->has_pose,
                              .at = f->at,
                              .line = k->line,
                              .method = (method_word)method,
                              .iterations = f->steps};
    if (rested ? solve_frame_rest(s, &from, e) : solve_frame_solve(s, &from, e))
        return -1;
    return solve_frame_write(s, &from, e);
}

static int replay_lines(session *s, replay *r, err *e)
{
    keyfile k;
    replay_kind kind;
    record_frame f;
    int got;
    while ((got = replay_next(r, &kind, &k, &f, e)) > 0)
        if (kind == REPLAY_FRAME ? replay_frame(s, &k, &f, e) : settings_take(s, &k, e))
            return -1;
    progress_clear(&s->progress);
    if (got < 0)
        return -1;
    if (!replay_is_whole(r))
        notes_add(&s->warnings, "%s ends without `end`: it was cut short; its frames up to there were made",
                  s->o->replay);
    frame_report_end(s);
    return 0;
}

int msds_record_replay(session *s, err *e)
{
    origin of;
    find_origin(s, &of);
    replay *r = replay_open(s->o->replay, run_options_table.name, of.list, of.count, e);
    if (!r)
        return -1;
    s->source = s->o->replay;
    const int failed = err_join(e, &s->unfit) || replay_lines(s, r, e) ? -1 : 0;
    replay_close(r);
    return failed;
}
