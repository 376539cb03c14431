/* What runs on an emulated card, as its own files see it: blocks and their threads,
 * and what each thread knows of the others.
 *
 * Time is told by clocks, one a thread (a vector clock: Lamport 1978, Mattern 1989). A thread's own counts on where it
 * lets others know what it did; where it waits for others, it takes over what they knew. What another did at a time
 * past the one known here, is in no order with what is done here: a race, whether or not the bytes show it.
 */
#ifndef SINEW_MACHINE_H
#define SINEW_MACHINE_H

#include "cuda_runtime.h"
#include "emulate.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <vector>

typedef std::vector<uint32_t> clocks; /* of a block's threads */

/* When a thread did something. */
struct moment {
    int32_t thread;
    uint32_t clock;
};

/* Reads of 4 bytes before the last. */
struct readings {
    std::vector<moment> own;                        /* of the same block, none known to a later one */
    std::vector<std::pair<int32_t, moment>> others; /* other blocks' last */
};

/* What is known of 4 bytes of memory. `seen` is the block, of shared memory, or the launch, else, that the rest is of.
 * There are many of these: most are read by one thread, or by some that know of each other. */
struct word {
    uint32_t seen = 0;
    uint32_t wrote = 0;               /* the launch, or the host's copy, that did so last; 0: none */
    int32_t writer = -1, reader = -1; /* the last blocks, or none */
    moment write = {0, 0}, read = {0, 0};
    bool atomic = false, flying = false; /* written so; a copy to it is on its way */
    bool copied = false;       /* `read` is a copy's: a write while that is on its way spoils the copy alone */
    const char *unsure = NULL; /* a copy to it was not to be relied on: why */
    std::unique_ptr<readings> more;
};

/* Bytes, and what is known of them. */
struct memory {
    char *at = NULL;
    size_t size = 0;
    std::vector<word> words;
};

struct fibre;

/* Where `threads` meet, round after round. */
struct meeting {
    int came = 0, round = 0;
    bool value = false, answer = false; /* whether any says so, of this round and the last */
    uint64_t said[2][32];               /* by a warp's threads, in rounds even and odd */
    clocks known, answered;
    std::vector<fibre *> waiting;
};

/* One of the card's, in shared memory. */
struct barrier {
    uint32_t count = 0, came = 0, phase = 0;
    clocks known, ended[2]; /* phases even and odd */
    std::vector<fibre *> waiting;
};

/* That a thread of a block said in a launch that something is done: what its own block, and others of which it had
 * heard, did by these clocks. said, heard: when that was. */
struct telling {
    int32_t block;
    uint32_t launch;
    moment said, heard;
    std::shared_ptr<const std::map<int32_t, clocks>> done;
};

struct block {
    uint32_t serial = 0; /* among all that ever ran */
    int32_t index = 0;
    int threads = 0;
    bool heard = false;            /* another's word, in this launch */
    std::vector<telling> tellings; /* others', that it heard */
    memory dynamic, own;       /* shared memory: as the launch says; what kernels declare, which blocks have by turns */
    std::vector<char> statics; /* these, while another block has them */
    ~block()
    {
        free(dynamic.at);
    }
    std::vector<fibre *> ready; /* threads that need not wait */
    meeting all;
    std::vector<meeting> warps, votes;
    std::map<uint32_t, barrier> barriers;
};

/* On its way to shared memory. */
struct flight {
    uint32_t to;
    const float4 *from; /* NULL: zeros */
    float4 value;       /* when it began */
    int group;
    const char *unsure; /* why the value is not to be relied on, or NULL */
};

struct fibre {
    void *stack_pointer = NULL;
    char *stack = NULL;
    block *home = NULL;
    int thread = 0;
    clocks clock;
    std::vector<flight> flights;
    int group = 0; /* that is sent next */
    bool ended = false;
    bool slow = false;        /* as is all of its warp: others get far ahead of it */
    const void *place = NULL; /* in the program, of what it does or waits for */
};

enum {
    STACK = 256 << 10,
    DYNAMIC_AT = 1 << 20 /* the address, in shared memory, of what launches ask for; below: kernels' own */
};

/* ---- fibres.cc */
extern __thread fibre *now; /* NULL: the host */
extern emulated_card card;

/* A number below `most`, by lot. */
uint32_t lot(uint32_t most);
/* Ends the launch. */
[[noreturn]] void fault(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Others run; until something has changed for one that looks again and again. */
void pass_on();
void changed();
/* Where a kernel calls from. */
#define HERE() (now->place = __builtin_return_address(0))

/* ---- streams.cc */
/* Is done in its turn. */
void ask(cudaStream_t stream, std::function<void()> what);
/* All that was asked of no stream is done. */
void finish_none();

/* ---- shadow.cc */
/* What the host and launches do to the card's memory is numbered. */
typedef struct history {
    uint32_t at;      /* the last so far */
    const char *call; /* a launch's arguments, which its threads may read */
    size_t call_size;
} history;
extern history past;

/* The card's memory is closed to the host but for its copies. */
void open_memory(bool open);
/* Of anything: what nobody wrote is drawn by lot. */
memory memory_of(size_t size);
/* Whether the thread that runs knows of it. */
bool known(moment m);
/* The first of the words that bytes are of, all of them with what is of use by now; NULL where they
 * are neither the block's nor the card's. */
word *find(const void *at, size_t size, bool *shared);
/* A thread reads or writes; atomic: as others may at once. */
void touch(const void *at, size_t size, bool writes, bool atomic = false);
/* The same of shared memory. Where it is for the processor. */
char *touch_shared(uint32_t at, size_t size, bool writes);
void end_flights();
/* At once. false: these are not where `kind` says. */
bool copy(void *to, const void *from, size_t size, cudaMemcpyKind kind);

/* ---- telling.cc */
/* Whether what a thread of another block did then is known here, since that block has told of it. */
bool is_told(int32_t block, moment when);

#endif
