/* Frames of msds-run on their way from the card: a kernel puts what frames take of a state into the model's order, in
 * the state's precision, between two frames of the solver; it is copied to the host in a stream of its own while the
 * next is solved. Beside that, inverted tetrahedra are counted where they are. The executor's state owns it.
 *
 *     slot   | displacement of `count` nodes, x y z each | velocity of all nodes, x y z each |
 */
#ifndef SINEW_CUDA_FRAMES_CUH
#define SINEW_CUDA_FRAMES_CUH

#include <cuda_runtime.h>
#include <stdbool.h>

extern "C" {
#include "msds/problem/msds_executor.h"
#include "msds/problem/sell.h"
}

/* A state where the solver has it, in the slices' order (sell.h). */
typedef struct card_fields {
    const float4 *u, *v;
    const double *precise;  /* nodes x 3, m: the displacement in place of u, or NULL */
    const double *position; /* nodes x 3, m */
} card_fields;

/* A frame that was sent. */
typedef struct card_sent {
    char *host, *card; /* pinned, and on the card: room for what is sent, in bytes: */
    int64_t room;
    cudaEvent_t ready, arrived;
    bool precise; /* the displacement is in doubles */
    int64_t step; /* of the solver, for messages */
} card_sent;

typedef struct card_frames {
    msds_frames of;
    int64_t nodes, count, elements; /* count: of whose displacement is sent */
    char *memory;                   /* of the card: the arrays below */
    int64_t bytes;
    const int32_t *all;                  /* nodes: where each stands; NULL: frames have nothing of all nodes */
    const int32_t *some;                 /* of.count: the same of those that are listed */
    const uint4 *corner;                 /* elements: where their nodes stand */
    unsigned long long *inverted, *told; /* on the card, and pinned */
    cudaStream_t sending;
    card_sent slot[MSDS_SLOTS];
} card_frames;

/* Makes f (zeroed). -1 with e filled, as for all below, and to be freed all the same. */
int card_frames_make(card_frames *f, const msds_frames *of, const msds_problem *p, const sell *order, err *e);
void card_frames_free(card_frames *f);

/* Puts a state into a slot, in the solver's stream, and begins to send it. step: for messages. */
int card_frames_send(card_frames *f, const card_fields *state, int slot, cudaStream_t stream, int64_t step, err *e);

/* Waits for a slot, in any thread. */
int card_frames_wait(const card_frames *f, int slot, msds_values *to, err *e);

/* Counts the tetrahedra of no volume, or less, in the solver's stream: *told has it once the stream is waited for. */
int card_frames_count(card_frames *f, const card_fields *state, cudaStream_t stream, int64_t step, err *e);

/* Bytes of the card's memory. */
int64_t card_frames_bytes(const card_frames *f);

#endif
