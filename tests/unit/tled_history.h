/* A row more in the table of a state, a history of 6 numbers an element, and an executor whose steps change it: that it
 * is got, saved, restored and snapshotted. Who includes this gives the executor, whose step adds to number a of each
 * element a + 1 a step.
 */
#ifndef SINEW_TLED_HISTORY_H
#define SINEW_TLED_HISTORY_H

#include "tled_bench.h"

enum { HISTORY = 2, COLUMNS = 6 };

/* The problem's table and a row more, and what it begins with. */
static inline void add_history(tled_problem *p, field row[HISTORY + 1], int where)
{
    err e = {0};
    memcpy(row, p->fields.field, HISTORY * sizeof *row);
    row[HISTORY] = (field){"element.history", "1", FIELD_ELEMENT, COLUMNS, where, "no history"};
    p->fields.field = row;
    p->fields.count = HISTORY + 1;
    fields_free(&p->at_start);
    bench_must(fields_allocate(&p->fields, FIELDS_ALL, &p->at_start, "a test", &e), &e);
    for (int64_t i = 0; i < COLUMNS * p->elements; i++)
        p->at_start.of[HISTORY][i] = (double)i;
}

static inline bool is_after(const double *history, int64_t elements, int64_t steps)
{
    for (int64_t i = 0; i < COLUMNS * elements; i++)
        if (history[i] != (double)(i + steps * (i % COLUMNS + 1)))
            return false;
    return true;
}

/* asks: the device is asked for differences first, as in a run to rest. */
static inline void test_history(const tled_executor *device, const block *what, bool asks, const char *name)
{
    const tled_question question = {.rest = INFINITY, .raise = 1.01, .differences = true};
    bench b;
    tled_sums sums;
    field row[HISTORY + 1];
    field_values got;
    bench_make(&b, what, NULL, .7, PHYSICAL, 2);
    tled_problem *p = &b.problem;
    add_history(p, row, FIELD_IN_FRAMES);
    fields_allocate(&p->fields, FIELDS_ALL, &got, "a test", &b.e);
    const tled_plan plan = {.rate = b.setup.rate, .damping = b.setup.damping};
    tled_state *state = device->create(p, b.setup.threads, &b.e);
    bench_must(!state || (asks && device->monitor(state, &question, &sums, &b.e)), &b.e);
    const double *history = got.of[HISTORY];
    ok(!device->get(state, HISTORY, got.of[HISTORY], &b.e) && is_after(history, p->elements, 0), "%s: as it began",
       name);
    device->step(state, &plan, 2, &b.e);
    device->save(state, &b.e);
    device->snapshot(state, 1, &b.e);
    device->step(state, &plan, 3, &b.e);
    ok(!device->get(state, HISTORY, got.of[HISTORY], &b.e) && is_after(history, p->elements, 5), "%s: got", name);
    ok(!device->fetch(state, 1, &got, &b.e) && is_after(history, p->elements, 2), "%s: a snapshot is of its time",
       name);
    device->restore(state, &b.e);
    ok(!device->get(state, HISTORY, got.of[HISTORY], &b.e) && is_after(history, p->elements, 2), "%s: restored %s",
       name, b.e.text);
    device->destroy(state);
    fields_free(&got);
    bench_free(&b);
}

#endif
