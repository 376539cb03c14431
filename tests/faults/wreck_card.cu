/* Wrecks a card in the middle of a run: preloaded into a program (LD_PRELOAD), it waits for the file that
 * SINEW_FAULT_WHEN names, then writes where there is no memory, as a kernel in the program's own context. From then on
 * everything that the program asks of the card fails, as after a fault of its own.
 */
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

static __global__ void wreck(int *nowhere)
{
    *nowhere = 1;
}

static void *wait_and_wreck(void *when)
{
    while (access((const char *)when, F_OK))
        usleep(1000);
    wreck<<<1, 1>>>((int *)8);
    return NULL;
}

__attribute__((constructor)) static void start(void)
{
    pthread_t thread;
    const char *when = getenv("SINEW_FAULT_WHEN");
    if (when && !pthread_create(&thread, NULL, wait_and_wreck, (void *)when))
        pthread_detach(thread);
}
