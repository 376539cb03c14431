/* The executors of a solver: the ways in which it can be computed, each on a device. Here is what the choice among them
 * needs: what each can do, and what a problem needs. The functions of each solver's executors have that solver's types
 * (tled/problem/tled_executor.h, msds/problem/msds_executor.h), and follow this part.
 */
#ifndef SINEW_EXECUTOR_H
#define SINEW_EXECUTOR_H

#include "base/err.h"

#include <pthread.h>
#include <semaphore.h>

#include <stddef.h>
#include <stdint.h>

/* X(name, as messages say it): what not every executor can do. The first that is lacking is named. */
#define EXECUTOR_FEATURES(X)                                                                                           \
    X(MESHES, "elements off a lattice")                                                                                \
    X(CONTACT, "contact with a probe")                                                                                 \
    X(FOLLOWERS, "pressure on a surface")                                                                              \
    X(WARP, "elements that turn: --warp")                                                                              \
    X(TISSUE, "the method tissue")                                                                                     \
    X(CAVITIES, "cavities: --cavity")                                                                                  \
    X(FRICTION, "friction on a probe: --friction")                                                                     \
    X(TANGENT, "contact stiffness: --haptics")                                                                         \
    X(HISTORY, "history of elements, which the law needs")                                                             \
    X(MIXTURES, "elements mixed of two volumes")                                                                       \
    X(CURVES, "muscles with a passive stress or an optimum")                                                           \
    X(SERIES, "muscles in series with a spring: vmax=")                                                                \
    X(FIBRES, "fibres that resist being stretched")                                                                    \
    X(CUTS, "mean strain of cut elements")                                                                             \
    X(BORDERS, "laminates of two volumes")                                                                             \
    X(FILMS, "films on bone (attach --surface)")                                                                       \
    X(SLIDING, "nodes that slide on bone (attach --slide)")                                                            \
    X(SELF_CONTACT, "skin that touches itself (bind --self-contact)")

enum executor_feature {
#define EXECUTOR_NUMBER(name, words) EXECUTOR_NUMBER_##name,
    EXECUTOR_FEATURES(EXECUTOR_NUMBER)
#undef EXECUTOR_NUMBER
        EXECUTOR_FEATURE_COUNT
};

enum { /* as bits */
#define EXECUTOR_BIT(name, words) EXECUTOR_##name = 1 << EXECUTOR_NUMBER_##name,
       EXECUTOR_FEATURES(EXECUTOR_BIT)
#undef EXECUTOR_BIT
};

/* All executors have these features, so messages about the choice do not name them. */
enum {
    EXECUTOR_USUAL =
        EXECUTOR_MIXTURES | EXECUTOR_CURVES | EXECUTOR_FIBRES | EXECUTOR_SERIES | EXECUTOR_CUTS | EXECUTOR_TISSUE
};

typedef struct executor {
    const char *device; /* "cpu" or "cuda", as the user says it */
    uint32_t features;  /* that it has: EXECUTOR_* */
    uint32_t forms;     /* that it is compiled for: bit i for form i of the solver */
    /* Why it cannot be used on this machine, or NULL. Initialises the device: called only where it may be chosen. */
    const char *(*unusable)(void);
    /* Loads what the first steps on the device would wait for: in any thread, while others use it. Only where it can be
     * used; what fails here fails there again. NULL: there is nothing to load. */
    void (*load)(void);
    /* Tells the device that many states will be made and freed, by several threads, before any of them. NULL: it makes
     * no difference to it. */
    void (*share)(void);
} executor;

enum { EXECUTOR_FORMS = 32 }; /* the most of any solver: a bit each */

typedef struct executor_need {
    uint32_t features;
    uint32_t form;                   /* of energy, as its bit in executor.forms; 0: any executor will do */
    const char *law[EXECUTOR_FORMS]; /* of each form, as users say it; NULL: no law has that form */
    const char *volume;              /* which wants that law, for messages; or NULL */
} executor_need;

/* The first executor of `table` (ends with NULL, the preferred first) on the device of this name that has what is
 * needed; for "auto" the first on any device that can be used. says (of `size` bytes) gets which device was chosen, and
 * which was not and why. NULL with e filled: the device is not in the table, lacks what is needed, or cannot be used
 * here. */
const executor *executor_choose(const executor *const *table, const char *device, const executor_need *need, char *says,
                                size_t size, err *e);

/* An executor's device that is made ready on a thread of its own, while the model is read: a card's context takes a
 * third of a second, and its kernels some hundredths. The caller owns it; zeroed: none. It stays where it is. */
typedef struct executor_ahead {
    const executor *of;
    bool waits; /* it has not been waited for */
    pthread_t thread;
    sem_t known; /* whether the device can be used */
} executor_ahead;

/* Starts with the executor that executor_choose would take, as far as what is needed is known; not with one on
 * processors, which is ready. What was found wrong comes out of executor_choose, as ever. */
void executor_ahead_start(executor_ahead *a, const executor *const *table, const char *device,
                          const executor_need *need);

/* Waits until it is known whether the device can be used: before executor_choose. Again, and of none: nothing. */
void executor_ahead_wait(executor_ahead *a);

/* Waits until all is loaded, and ends the thread: before the process ends. Again, and of none: nothing. */
void executor_ahead_end(executor_ahead *a);

#endif
