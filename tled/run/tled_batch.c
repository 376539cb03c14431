#include "tled/run/tled_batch.h"

#include "model/model_share.h"

#include <stdio.h>
#include <string.h>

int tled_batch_read(tled_batch *b, const struct options *o, err *e)
{
    b->changed = o->materials || o->material.count;
    pthread_mutex_init(&b->card, NULL);
    b->frames = stage_keep_frames(&b->base.stage, &b->base.m, &b->frame, e);
    return b->frames < 0 ? -1 : 0;
}

void tled_batch_free(tled_batch *b)
{
    if (b->frames > 0)
        stage_free_frames(b->frame, b->frames);
    stage_close_input(&b->base.stage);
    model_free(&b->base.m);
}

int tled_batch_share(tled_batch *b, session *s, err *e)
{
    s->card = &b->card;
    s->stage.kept = b->frames ? b->frame : NULL;
    s->stage.kept_count = b->frames;
    return model_share(&s->m, &b->base.m, e);
}

/* On a card, jobs run one after another, while the next are prepared and frames are written. */
int tled_batch_run(session *s, run_end *end, err *e)
{
    const bool waits = s->card && strcmp(s->run.device->is.device, "cpu") != 0;
    if (waits)
        pthread_mutex_lock(s->card);
    const int failed = run_go(&s->run, end, e);
    if (waits)
        pthread_mutex_unlock(s->card);
    return failed;
}

void tled_batch_words(const run_end *end, char said[BATCH_SAID])
{
    snprintf(said, BATCH_SAID, "%s %.6g s, after %lld steps, largest displacement %.6g mm",
             end->rested ? "at rest at" : "at", end->reading.time, (long long)end->steps, 1e3 * end->reading.largest);
}
