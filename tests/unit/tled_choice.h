/* Tests that a model is not given to a card that lacks one feature that the model needs. Owns nothing.
 */
#ifndef SINEW_TLED_CHOICE_H
#define SINEW_TLED_CHOICE_H

#include "tled/cpu/cpu.h"

#include "tap.h"

#include <stdio.h>
#include <string.h>

static const char *choice_usable(void)
{
    return NULL;
}

/* The card is refused by name, and left out where the choice is free. feature: EXECUTOR_*; words: as messages say
 * it; freely: what is said of a free choice. */
static inline void test_choice_without(const tled_problem *p, uint32_t feature, const char *words, const char *freely)
{
    const executor card = {.device = "cuda", .features = ~feature, .forms = ~(uint32_t)0, .unusable = choice_usable};
    const executor *const table[] = {&card, &tled_cpu_double.is, NULL};
    const executor_need need = tled_need(p);
    char says[300], refused[200];
    err e = {0};
    snprintf(refused, sizeof refused, "the CUDA back end has no %s; expected -d cpu or auto", words);
    ok(!executor_choose(table, "cuda", &need, says, sizeof says, &e) && !strcmp(e.text, refused), "%s", e.text);
    ok(executor_choose(table, "auto", &need, says, sizeof says, &e) == &tled_cpu_double.is && !strcmp(says, freely),
       "%s", says);
}

#endif
