/* An emulated card's threads: launches, fibres and lots, and where threads wait for each other. */
#include "machine.h"

#include <deque>
#include <pmmintrin.h>
#include <sanitizer/common_interface_defs.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>

__thread fibre *now;
emulated_card card;
dim3 threadIdx, blockIdx, gridDim;

/* The launch that runs, and what went wrong in one before: a card's state, of which there is one. */
static struct {
    void (*run)(const void *);
    void *host;               /* its stack */
    std::deque<block> blocks; /* which stay where they are */
    std::vector<fibre> fibres;
    std::vector<fibre *> started;
    std::vector<block *> live; /* those that have a thread which need not wait */
    block *turn;               /* whose threads run: for a while, since what is known of its memory stands near then */
    std::map<const void *, size_t> allowed; /* bytes of shared memory that kernels may ask for */
    size_t left;                            /* threads that have not ended */
    int64_t idle, ran;                      /* looks at words since anything changed; blocks so far */
    uint64_t lots;
    uint32_t serial;
    bool over;
    char what[200], text[500]; /* a fault; with where it was, or empty */
} machine;

enum {
    THREADS_MOST = 1024,
    SHARED_MOST = 227 << 10,
    SHARED_ALL = 228 << 10,
    SHARED_PLAIN = 48 << 10,
    IDLE_MOST = 2000,
    TURN = 64 /* threads that run before another block has its turn, about */
};

bool emulate(const emulated_card *c)
{
    card = *c;
    machine.lots = c->seed * 2 + 1;
    machine.ran = 0;
    machine.over = false;
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

int64_t emulated_blocks()
{
    return machine.ran;
}

/* Xorshift (Marsaglia 2003). */
uint32_t lot(uint32_t most)
{
    uint64_t &x = machine.lots;
    x ^= x << 13, x ^= x >> 7, x ^= x << 17;
    return (uint32_t)((x >> 32) * most >> 32);
}

/* ---- fibres: the registers that a call keeps (System V, x86-64) stand on the stack of who does not run */

extern "C" void emulated_switch(void **from, void *to);
asm(".text\n"
    "emulated_switch:\n"
    "push %rbp\n push %rbx\n push %r12\n push %r13\n push %r14\n push %r15\n"
    "mov %rsp, (%rdi)\n"
    "mov %rsi, %rsp\n"
    "pop %r15\n pop %r14\n pop %r13\n pop %r12\n pop %rbx\n pop %rbp\n"
    "ret\n");

static void to_host()
{
    emulated_switch(&now->stack_pointer, machine.host);
}

/* What is the matter with a thread, and where. (Not on its stack, which is small.) */
static void note(const fibre *f, const char *what)
{
    char place[200] = "";
    if (f->place)
        __sanitizer_symbolize_pc((void *)((uintptr_t)f->place - 1), " (%f, %s:%l)", place, sizeof place);
    snprintf(machine.text, sizeof machine.text, "thread %d of block %d %s%s", f->thread, f->home->index, what, place);
}

void fault(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(machine.what, sizeof machine.what, format, list);
    va_end(list);
    machine.over = true;
    while (now)
        to_host();
    fprintf(stderr, "emulated card: %s\n", machine.what);
    abort();
}

void pass_on()
{
    if (++machine.idle > IDLE_MOST * (int64_t)machine.left)
        fault("waits for a word that nobody writes");
    now->home->ready.push_back(now);
    machine.turn = NULL;
    to_host();
}

void changed()
{
    machine.idle = 0;
}

/* These are of the block whose thread runs. */
static void wake(std::vector<fibre *> &waiting)
{
    std::vector<fibre *> &ready = now->home->ready;
    ready.insert(ready.end(), waiting.begin(), waiting.end());
    waiting.clear();
    changed();
}

static void first_of_fibre()
{
    machine.run(past.call);
    end_flights();
    now->ended = true;
    machine.left--;
    changed();
    to_host();
}

static void start(fibre *f, block *home, int thread)
{
    if (!f->stack) {
        void *stack = mmap(NULL, STACK, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (stack == MAP_FAILED || mprotect(stack, 4096, PROT_NONE))
            fault("no memory for stacks");
        f->stack = (char *)stack;
    }
    void **top = (void **)(f->stack + STACK);
    *--top = NULL;
    *--top = (void *)first_of_fibre;
    f->stack_pointer = top - 6;
    f->home = home;
    f->thread = thread;
    f->clock.assign((size_t)home->threads, 0);
    f->clock[(size_t)thread] = 1;
    f->flights.clear();
    f->group = 0;
    f->ended = false;
    f->slow = thread % 32 ? (f - 1)->slow : !lot(4);
    f->place = NULL;
    machine.started.push_back(f);
    home->ready.push_back(f);
}

/* ---- launches */

static void begin(block *b, int32_t index, const cudaLaunchConfig_t *how)
{
    b->serial = ++machine.serial;
    b->index = index;
    b->heard = false;
    b->tellings.clear();
    b->ready.clear();
    b->threads = (int)how->blockDim.x;
    if (4 * b->dynamic.words.size() < how->dynamicSmemBytes) {
        free(b->dynamic.at);
        b->dynamic = memory_of(how->dynamicSmemBytes);
    }
    b->dynamic.size = how->dynamicSmemBytes; /* what is more, of launches before, stays where it is */
    const size_t warps = ((size_t)b->threads + 31) / 32;
    b->all = meeting();
    b->warps.assign(warps, meeting());
    b->votes.assign(warps, meeting());
    b->barriers.clear();
    b->statics.clear();
}

/* The block whose turn it is, by lot; NULL: all threads wait. A block without a ready thread
 * has none later: only its own wake them. */
static block *next_block()
{
    std::vector<block *> &live = machine.live;
    while (!live.empty() && (!machine.turn || machine.turn->ready.empty() || !lot(TURN))) {
        block *&pick = live[lot((uint32_t)live.size())];
        machine.turn = pick;
        if (!pick->ready.empty())
            break;
        pick = live.back();
        live.pop_back();
    }
    return live.empty() ? NULL : machine.turn;
}

/* By lot; slow ones are passed over most of the time. */
static fibre *next_thread(std::vector<fibre *> &ready)
{
    for (;;) {
        fibre *&pick = ready[lot((uint32_t)ready.size())], *f = pick;
        if (f->slow && lot(32))
            continue;
        pick = ready.back();
        ready.pop_back();
        return f;
    }
}

static void run_threads()
{
    while (machine.left && !machine.over) {
        block *b = next_block();
        if (!b) {
            now = *std::find_if(machine.started.begin(), machine.started.end(), [](fibre *f) { return !f->ended; });
            snprintf(machine.what, sizeof machine.what, "waits for ever, as do %zu others", machine.left - 1);
            machine.over = true;
            break;
        }
        now = next_thread(b->ready);
        threadIdx.x = (unsigned)now->thread;
        blockIdx.x = (unsigned)now->home->index;
        emulated_switch(&machine.host, now->stack_pointer);
    }
    if (machine.over)
        note(now, machine.what);
    now = NULL;
}

/* Blocks order[0] to order[count - 1], all at once. */
static void run_blocks(const uint32_t *order, size_t count, const cudaLaunchConfig_t *how)
{
    const size_t threads = how->blockDim.x;
    gridDim = how->gridDim;
    if (machine.blocks.size() < count)
        machine.blocks.resize(count);
    if (machine.fibres.size() < count * threads)
        machine.fibres.resize(count * threads);
    machine.started.clear();
    machine.live.clear();
    machine.turn = NULL;
    for (size_t i = 0; i < count; i++) {
        block *b = &machine.blocks[i];
        begin(b, (int32_t)order[i], how);
        for (size_t t = 0; t < threads; t++)
            start(&machine.fibres[i * threads + t], b, (int)t);
        machine.live.push_back(b);
    }
    machine.left = count * threads;
    machine.idle = 0;
    run_threads();
    machine.ran += (int64_t)count;
}

cudaError_t emulated_allow(const void *kernel, int shared)
{
    if (shared > SHARED_MOST)
        return cudaErrorInvalidValue;
    machine.allowed[kernel] = (size_t)shared;
    return cudaSuccess;
}

cudaError_t emulated_fit(int *blocks, int threads, size_t shared)
{
    *blocks = shared > SHARED_MOST ? 0 : std::min(2 * THREADS_MOST / threads, (int)(SHARED_ALL / (shared + 1024)));
    return cudaSuccess;
}

/* Whether all blocks have room at once. */
static bool has_room(const cudaLaunchConfig_t *how)
{
    int each = 0;
    emulated_fit(&each, (int)how->blockDim.x, how->dynamicSmemBytes);
    return how->gridDim.x <= (unsigned)(each * card.processors);
}

/* Whether blocks of this kind can start; together: all of them at once. */
static bool fits(const void *kernel, const cudaLaunchConfig_t *how, bool together)
{
    const auto more = machine.allowed.find(kernel);
    const size_t most = std::max((size_t)SHARED_PLAIN, more == machine.allowed.end() ? 0 : more->second);
    if (!how->gridDim.x || !how->blockDim.x || how->blockDim.x > THREADS_MOST || how->dynamicSmemBytes > most)
        return false;
    return !together || (card.together && has_room(how));
}

static void launch(const cudaLaunchConfig_t *how, bool together, const std::vector<char> &call)
{
    const bool at_once = together || (has_room(how) && lot(2));
    if (machine.over)
        return;
    past.at++;
    past.call = call.data();
    past.call_size = call.size();
    std::vector<uint32_t> order(how->gridDim.x);
    for (uint32_t i = 0; i < order.size(); i++) {
        const uint32_t other = lot(i + 1);
        order[i] = order[other];
        order[other] = i;
    }
    const unsigned rounding = _mm_getcsr();
    _mm_setcsr(rounding | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON); /* as -ftz=true */
    open_memory(true);
    for (size_t i = 0; i < order.size() && !machine.over; i += at_once ? order.size() : 1)
        run_blocks(&order[i], at_once ? order.size() : 1, how);
    open_memory(false);
    _mm_setcsr(rounding);
}

cudaError_t emulated_launch(const void *kernel, const cudaLaunchConfig_t *how, void (*run)(const void *),
                            const void *call, size_t size)
{
    const bool together = how->numAttrs && how->attrs->val.cooperative;
    if (!fits(kernel, how, together))
        return cudaErrorInvalidValue;
    const std::vector<char> with((const char *)call, (const char *)call + size);
    const cudaLaunchConfig_t own = *how;
    ask(how->stream, [=] {
        machine.run = run;
        launch(&own, together, with);
    });
    return cudaGetLastError();
}

cudaError_t cudaGetLastError()
{
    return machine.over ? cudaErrorLaunchFailure : cudaSuccess;
}

cudaError_t cudaGetDeviceCount(int *count)
{
    *count = card.processors > 0;
    return cudaSuccess;
}

cudaError_t cudaDeviceGetAttribute(int *value, cudaDeviceAttr which, int)
{
    *value = 0;
    if (which == cudaDevAttrComputeCapabilityMajor)
        *value = card.capability / 10;
    else if (which == cudaDevAttrComputeCapabilityMinor)
        *value = card.capability % 10;
    else if (which == cudaDevAttrMultiProcessorCount)
        *value = card.processors;
    else if (which == cudaDevAttrCooperativeLaunch)
        *value = card.together;
    else if (which == cudaDevAttrMaxSharedMemoryPerBlockOptin)
        *value = SHARED_MOST;
    return cudaSuccess;
}

const char *cudaGetErrorString(cudaError_t error)
{
    if (error == cudaErrorLaunchFailure)
        return machine.text;
    return error == cudaErrorMemoryAllocation ? "out of memory" : "the emulated card cannot";
}

/* ---- where threads wait for each other */

/* Lets others know what was done here. */
static void tell(clocks &all)
{
    all.resize(now->clock.size());
    for (size_t i = 0; i < all.size(); i++)
        all[i] = std::max(all[i], now->clock[i]);
    now->clock[(size_t)now->thread]++;
}

static void learn(const clocks &of)
{
    for (size_t i = 0; i < of.size(); i++)
        now->clock[i] = std::max(now->clock[i], of[i]);
}

/* Waits until `want` threads are here; orders: what they did before comes before
 * what they do after. Whether any says so. */
static bool meet(meeting &m, int want, bool says, bool orders)
{
    if (orders)
        tell(m.known);
    m.value |= says;
    if (++m.came < want) {
        m.waiting.push_back(now);
        to_host();
    } else {
        m.answer = m.value;
        m.answered = m.known;
        m.came = 0;
        m.round++;
        m.value = false;
        wake(m.waiting);
    }
    const bool answer = m.answer;
    if (orders)
        learn(m.answered);
    return answer;
}

static int warp_size()
{
    return std::min(32, now->home->threads - now->thread / 32 * 32);
}

void __syncthreads()
{
    HERE();
    if (card.omission != OMIT_SYNC_BLOCK)
        meet(now->home->all, now->home->threads, false, true);
}

int __syncthreads_or(int value)
{
    HERE();
    return meet(now->home->all, now->home->threads, value != 0, true);
}

void __syncwarp()
{
    HERE();
    if (card.omission != OMIT_SYNC_WARP)
        meet(now->home->warps[(size_t)now->thread / 32], warp_size(), false, true);
}

/* A warp's threads tell each other, which orders nothing: what all of them say. It
 * stands until they have met once more. */
static const uint64_t *say(unsigned mask, uint64_t what, bool *any)
{
    meeting &m = now->home->votes[(size_t)now->thread / 32];
    uint64_t *said = m.said[m.round % 2];
    if (mask != ~0u)
        fault("asks some of its warp only, which is not emulated");
    said[now->thread % 32] = what;
    *any = meet(m, warp_size(), what != 0, false);
    return said;
}

int __any_sync(unsigned mask, int value)
{
    bool any;
    HERE();
    say(mask, value != 0, &any);
    return any;
}

unsigned __ballot_sync(unsigned mask, int value)
{
    bool any;
    unsigned who = 0;
    HERE();
    const uint64_t *said = say(mask, value != 0, &any);
    for (int i = 0; i < warp_size(); i++)
        who |= (unsigned)said[i] << i;
    return who;
}

uint64_t emulated_exchange(unsigned mask, uint64_t bits, int with)
{
    bool any;
    HERE();
    return say(mask, bits, &any)[now->thread % 32 ^ with];
}

/* ---- the card's barriers */

void barrier_make(uint32_t at, uint32_t count)
{
    HERE();
    touch_shared(at, 8, true);
    if (now->home->barriers.count(at))
        fault("makes a barrier again");
    now->home->barriers[at].count = count;
}

static barrier &barrier_at(uint32_t at)
{
    touch_shared(at, 8, false);
    const auto found = now->home->barriers.find(at);
    if (found == now->home->barriers.end())
        fault("uses a barrier that nobody made");
    return found->second;
}

void barrier_arrive(uint32_t at)
{
    HERE();
    barrier &b = barrier_at(at);
    tell(b.known);
    if (++b.came < b.count)
        return;
    b.came = 0;
    b.ended[b.phase++ % 2] = b.known;
    wake(b.waiting);
}

void barrier_wait(uint32_t at, int odd)
{
    HERE();
    barrier &b = barrier_at(at);
    if (card.omission == OMIT_BARRIER_WAIT)
        return;
    while ((int)(b.phase % 2) == odd) {
        b.waiting.push_back(now);
        to_host();
    }
    learn(b.ended[odd]);
}
