/* A device is made ready on a thread of its own where the options say that it may be chosen, once, and not one that
 * cannot be.
 */
#include "solve/executor.h"
#include "tap.h"

#include <pthread.h>

static int looks;
static pthread_t by;

static const char *count_looks(void)
{
    looks++;
    by = pthread_self();
    return NULL;
}

static const char *ready(void)
{
    looks = -100;
    return NULL;
}

int main(void)
{
    static const executor card = {.device = "cuda", .unusable = count_looks},
                          processors = {.device = "cpu", .features = EXECUTOR_CONTACT, .unusable = ready};
    const executor *table[] = {&card, &processors, NULL};
    static const executor_need nothing = {0}, contact = {.features = EXECUTOR_CONTACT};
    static const char *const device[] = {"auto", "cuda", "cpu", "auto", "cuda"};
    for (int i = 0; i < 5; i++) {
        executor_ahead ahead = {.of = NULL};
        looks = 0;
        executor_ahead_start(&ahead, table, device[i], i > 2 ? &contact : &nothing);
        executor_ahead_wait(&ahead);
        executor_ahead_wait(&ahead);
        ok(looks == (i < 2), "-d %s%s: %d looked ahead", device[i], i > 2 ? " with contact" : "", looks);
        ok(!looks || !pthread_equal(by, pthread_self()), "by a thread of its own");
    }
    return done_testing();
}
