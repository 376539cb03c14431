#include "live/stop.h"

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>

/* Without locks, so a signal's handler may write it; and any thread may read it. */
static atomic_int came;

static void on_signal(int signal)
{
    (void)signal;
    atomic_store(&came, 1);
}

void stop_catch(void)
{
    /* Reads and writes go on where they were: what is half written would be lost. */
    struct sigaction act = {.sa_handler = on_signal, .sa_flags = (int)(SA_RESTART | SA_RESETHAND)};
    sigemptyset(&act.sa_mask);
    sigaction(SIGINT, &act, NULL);
    sigaction(SIGTERM, &act, NULL);
}

bool stop_came(void)
{
    return atomic_load(&came) != 0;
}
