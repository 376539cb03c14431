#include "tled/run/tled_batch.h"

#include <stdio.h>
#include <string.h>

int tled_batch_read(tled_batch *b, const struct options *o, err *e)
{
    b->changed = o->materials || o->material.count;
    return stage_shared_read(&b->from, e);
}

void tled_batch_free(tled_batch *b)
{
    stage_shared_free(&b->from);
    pthread_cond_destroy(&b->card.opened);
    pthread_mutex_destroy(&b->card.lock);
}

int tled_batch_share(tled_batch *b, session *s, err *e)
{
    s->card = &b->card;
    return stage_shared_lend(&b->from, &s->stage, &s->m, e);
}

/* Elements whose states a card has at once: some gigabytes. */
enum { ELEMENTS_TOGETHER = 4000000 };

static void enter(card_gate *g, const executor *device, int64_t elements)
{
    pthread_mutex_lock(&g->lock);
    while (g->elements > 0 && g->elements + elements > ELEMENTS_TOGETHER)
        pthread_cond_wait(&g->opened, &g->lock);
    g->elements += elements;
    if (device->share)
        device->share();
    pthread_mutex_unlock(&g->lock);
}

static void leave(card_gate *g, int64_t elements)
{
    pthread_mutex_lock(&g->lock);
    g->elements -= elements;
    pthread_cond_broadcast(&g->opened);
    pthread_mutex_unlock(&g->lock);
}

int tled_batch_run(session *s, run_end *end, err *e)
{
    const executor *device = &s->run.device->is;
    const bool enters = s->card && strcmp(device->device, "cpu") != 0;
    if (enters)
        enter(s->card, device, s->problem.elements);
    const int failed = run_go(&s->run, end, e);
    if (enters)
        leave(s->card, s->problem.elements);
    return failed;
}

void tled_batch_words(const run_end *end, char said[BATCH_SAID])
{
    snprintf(said, BATCH_SAID, "%s %.6g s, after %lld steps, largest displacement %.6g mm",
             end->rested ? "at rest at" : "at", end->reading.time, (long long)end->steps, 1e3 * end->reading.largest);
}
