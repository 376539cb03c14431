#include "tled/run/tled_batch.h"

#include <stdio.h>
#include <string.h>

int tled_batch_read(tled_batch *b, const struct options *o, err *e)
{
    b->changed = o->materials || o->material.count;
    pthread_mutex_init(&b->card, NULL);
    return stage_shared_read(&b->from, e);
}

void tled_batch_free(tled_batch *b)
{
    stage_shared_free(&b->from);
}

int tled_batch_share(tled_batch *b, session *s, err *e)
{
    s->card = &b->card;
    return stage_shared_lend(&b->from, &s->stage, &s->m, e);
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
