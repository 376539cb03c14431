/* A device is made ready on a thread of its own where the options say that it may be chosen, once, and not one that
 * cannot be. What it loads then, if it can be used, holds up nobody but who ends it.
 */
#include "solve/executor.h"
#include "tap.h"

#include <pthread.h>
#include <semaphore.h>

static int looks, loads;
static pthread_t by;
static sem_t go_on; /* until which loading lasts */

static const char *count_looks(void)
{
    looks++;
    by = pthread_self();
    return NULL;
}

static const char *refuse(void)
{
    looks++;
    by = pthread_self();
    return "no";
}

static void count_loads(void)
{
    sem_wait(&go_on);
    loads++;
}

static const char *ready(void)
{
    looks = -100;
    return NULL;
}

int main(void)
{
    static const executor card = {.device = "cuda", .unusable = count_looks, .load = count_loads},
                          broken = {.device = "cuda", .unusable = refuse, .load = count_loads},
                          empty = {.device = "cuda", .unusable = count_looks},
                          processors = {.device = "cpu", .features = EXECUTOR_CONTACT, .unusable = ready};
    static const executor_need nothing = {0}, contact = {.features = EXECUTOR_CONTACT};
    static const executor *const list[] = {&card, &card, &card, &card, &card, &broken, &empty};
    static const char *const device[] = {"auto", "cuda", "cpu", "auto", "cuda", "auto", "cuda"};
    for (int i = 0; i < 7; i++) {
        const executor *table[] = {list[i], &processors, NULL};
        const bool looked = i < 2 || i > 4, loaded = i < 2;
        executor_ahead ahead = {.of = NULL};
        looks = loads = 0;
        sem_init(&go_on, 0, 0);
        executor_ahead_start(&ahead, table, device[i], i > 2 && i < 5 ? &contact : &nothing);
        executor_ahead_wait(&ahead);
        executor_ahead_wait(&ahead);
        ok(looks == looked && !loads, "-d %s, %d: %d looked ahead, and none waited for what is loaded", device[i], i,
           looks);
        ok(!looks || !pthread_equal(by, pthread_self()), "by a thread of its own");
        sem_post(&go_on);
        executor_ahead_end(&ahead);
        executor_ahead_end(&ahead);
        ok(loads == loaded, "%d loaded by the end", loads);
        sem_destroy(&go_on);
    }
    return done_testing();
}
