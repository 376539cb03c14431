/* A CUDA card that a processor plays, for tests where there is no card: the kernels' sources, unchanged,
 * compiled by g++ with the two headers here in place of CUDA's and of tled/cuda/cuda_ptx.cuh. A block's threads
 * are fibres, one of which runs at a time until it has to wait; which, is drawn by lot. It says nothing of
 * speed, nor of what nvcc makes of the sources.
 *
 * Each access of a kernel to memory, and each copy that it does not wait for, is looked at for what a card lets
 * pass. The first fault ends the launch, and what is called next fails with the fault's text, as does all after it.
 * Blocks that have room at once run so in every other launch, by lot; what one does to memory that another has to do
 * with is a fault, unless it has heard that this is done (tell_done, hear_done), from that block or by way of
 * others. Not seen: an access past the end of an array that meets another of the same allocation; most of what
 * blocks that tell each other words without order (relaxed_store) do to each other's memory; of what several threads
 * of another block read, all but the last.
 *
 * What is put in a stream is done as late as something waits for it, or earlier, by lot; so is what is asked of no
 * stream. The card is one, and is the process's.
 *
 * Threads, and where they wait for each other, are in fibres.cc; memory in shadow.cc; what blocks tell each other in
 * telling.cc; what the host asks for in streams.cc; machine.h is between these. wrong.cu has kernels with a fault each.
 * The test of all this is tests/unit/test_tled_emulated.c.
 */
#ifndef SINEW_EMULATE_H
#define SINEW_EMULATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the card is to do as though the kernel had not said so: a test of the tests. */
typedef enum emulated_omission {
    OMIT_NOTHING,
    OMIT_SYNC_BLOCK,
    OMIT_SYNC_WARP,
    OMIT_BARRIER_WAIT, /* the card's barriers: nobody waits */
    OMIT_COPY_WAIT,    /* of all groups but the last */
    OMIT_HEAR_DONE,    /* the word is read, and says nothing of what was done before it */
    OMIT_TICKET        /* some are given out twice */
} emulated_omission;

typedef struct emulated_card {
    int capability; /* 10 major + minor */
    int processors; /* each of an H200's threads and shared memory; registers are not counted */
    bool together;  /* starts kernels whose blocks wait for each other */
    uint64_t seed;  /* of the lots */
    emulated_omission omission;
} emulated_card;

/* A card from here on; faults of before are forgotten. false: this processor cannot play one. */
bool emulate(const emulated_card *card);

/* Blocks that ran, since then. */
int64_t emulated_blocks(void);

#ifdef __cplusplus
}
#endif

#endif
