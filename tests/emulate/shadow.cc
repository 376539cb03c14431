/* An emulated card's memory: what each access is checked for, and copies that the thread does not wait for.
 *
 * Kernels are compiled with -fsanitize=thread, which puts a call before each access; the calls come here. (What runs on
 * the host is looked at for what AddressSanitizer knows.)
 */
#include "machine.h"
#include "tled/cuda/cuda_ptx.cuh"

#include <link.h>
#include <sanitizer/asan_interface.h>
#include <stdlib.h>

history past;

extern "C" {
extern char __executable_start[], _end[];
}

/* All that kernels declare __shared__. */
static struct {
    char *at;
    size_t size;
} statics;

static std::vector<memory> pieces; /* of the card's */

static bool within(const void *at, size_t size, const void *from, size_t length)
{
    return (uintptr_t)at >= (uintptr_t)from && (uintptr_t)at + size <= (uintptr_t)from + length;
}

/* The piece that these bytes are of, or NULL. */
static memory *piece_of(const void *at, size_t size)
{
    for (memory &p : pieces)
        if (within(at, size, p.at, p.size))
            return &p;
    return NULL;
}

static size_t words_in(const void *at, size_t size)
{
    return ((uintptr_t)at % 4 + size + 3) / 4;
}

static int note_statics(dl_phdr_info *program, size_t, void *)
{
    for (int i = 0; i < program->dlpi_phnum; i++)
        if (program->dlpi_phdr[i].p_type == PT_TLS)
            statics = {(char *)program->dlpi_tls_data, program->dlpi_phdr[i].p_memsz};
    return 1; /* the first is the program itself */
}

void open_memory(bool open)
{
    dl_iterate_phdr(note_statics, NULL);
    for (const memory &p : pieces)
        (open ? __asan_unpoison_memory_region : __asan_poison_memory_region)(p.at, p.size);
}

memory memory_of(size_t size)
{
    memory m;
    if (posix_memalign((void **)&m.at, 256, size ? size : 1))
        fault("no memory for the card's");
    m.size = size;
    m.words.resize((size + 3) / 4);
    for (size_t i = 0; i < size; i++)
        m.at[i] = (char)lot(256);
    return m;
}

/* ---- words */

bool known(moment m)
{
    return m.thread == now->thread || m.clock <= now->clock[(size_t)m.thread];
}

static void forget_reads(word *w)
{
    w->reader = -1;
    if (!w->more)
        return;
    w->more->own.clear();
    w->more->others.clear();
}

/* What the word knows of an earlier block, or launch, is of no more use. */
static void forget(word *w, uint32_t at, bool shared)
{
    if (w->seen == at)
        return;
    w->seen = at;
    w->writer = -1;
    forget_reads(w);
    if (shared) {
        w->wrote = 0;
        w->flying = false;
    }
}

/* What is the matter with reading or writing it, or NULL. */
static const char *trouble(const word *w, bool atomic)
{
    const bool other = w->writer != -1 && w->writer != now->home->index;
    if (w->flying)
        return "what is on its way";
    if (atomic && w->atomic)
        return NULL;
    if (other)
        return is_told(w->writer, w->write) ? NULL : "what another block writes";
    return w->writer == -1 || known(w->write) ? NULL : "what another thread writes: a race";
}

static const char *trouble_in_reading(const word *w)
{
    return w->wrote ? trouble(w, false) : "what nobody wrote";
}

static readings *more_of(word *w)
{
    if (!w->more)
        w->more.reset(new readings);
    return w->more.get();
}

/* The block that read last is another than this one, of which its last read is kept; so
 * is this one's, from here on as `read`. */
static void note_other(word *w)
{
    auto &others = more_of(w)->others;
    const auto is_own = [](const std::pair<int32_t, moment> &r) { return r.first == now->home->index; };
    const auto at = std::find_if(others.begin(), others.end(), is_own);
    if (at == others.end())
        others.push_back({w->reader, w->read});
    else
        *at = {w->reader, w->read};
    w->more->own.clear();
}

/* Now and then those go that are known here: who writes next and knows this read knows them as well. */
static void note_earlier(word *w)
{
    std::vector<moment> &own = more_of(w)->own;
    if (own.size() >= 4 && (own.size() & (own.size() - 1)) == 0)
        own.erase(std::remove_if(own.begin(), own.end(), known), own.end());
    own.push_back(w->read);
}

static void note_read(word *w, bool copied)
{
    if (w->reader != -1 && w->reader != now->home->index)
        note_other(w);
    else if (w->reader != -1 && !w->copied && (copied || !known(w->read)))
        note_earlier(w);
    w->reader = now->home->index;
    w->read = {now->thread, now->clock[(size_t)now->thread]};
    w->copied = copied;
}

static void read_word(word *w)
{
    const char *what = trouble_in_reading(w);
    if (what)
        fault("reads %s", what);
    if (w->unsure)
        fault("reads a copy of %s", w->unsure);
    note_read(w, false);
}

/* A write after this block's read; after another block's. */
static void after_own(moment read)
{
    if (!known(read))
        fault("writes what thread %d reads: a race", read.thread);
}

static void after_other(int32_t reader, moment read)
{
    if (!now->home->heard && !is_told(reader, read))
        fault("writes what another block reads");
}

static void after_reads(const word *w)
{
    if (w->reader != -1 && w->reader != now->home->index)
        after_other(w->reader, w->read);
    else if (w->reader != -1 && !w->copied)
        after_own(w->read);
    if (!w->more)
        return;
    for (const auto &read : w->more->others)
        if (read.first != now->home->index)
            after_other(read.first, read.second);
    for (const moment &read : w->more->own)
        if (w->reader == now->home->index)
            after_own(read);
}

static void write_word(word *w, bool atomic)
{
    const int32_t own = now->home->index;
    const char *what = trouble(w, atomic);
    if (what)
        fault("writes %s", what);
    after_reads(w);
    forget_reads(w);
    w->writer = own;
    w->write = {now->thread, now->clock[(size_t)now->thread]};
    w->atomic = atomic;
    w->wrote = past.at;
    w->unsure = NULL;
}

/* ---- accesses */

/* The kernels' own shared memory is one for all blocks: whose it is now finds there what it left. */
static void take_statics()
{
    static uint32_t owner;
    static block *home;
    fibre *me = now; /* which stands there too */
    block *b = me->home;
    if (owner == b->serial)
        return;
    if (home)
        home->statics.assign(statics.at, statics.at + statics.size);
    if (!b->statics.empty())
        memcpy(statics.at, b->statics.data(), statics.size);
    now = me;
    b->own.at = statics.at;
    b->own.words.resize(statics.size / 4 + 1);
    owner = b->serial;
    home = b;
}

word *find(const void *at, size_t size, bool *shared)
{
    block *b = now->home;
    const bool own = within(at, size, statics.at, statics.size);
    *shared = own || within(at, size, b->dynamic.at, b->dynamic.size);
    if (own)
        take_statics();
    memory *m = *shared ? &b->dynamic : piece_of(at, size);
    if (own)
        m = &b->own;
    if (!m)
        return NULL;
    word *w = &m->words[(size_t)((const char *)at - m->at) / 4];
    for (size_t i = 0; i < words_in(at, size); i++)
        forget(&w[i], *shared ? b->serial : past.at, *shared);
    return w;
}

void touch(const void *at, size_t size, bool writes, bool atomic)
{
    bool shared;
    if (within(at, size, now->stack, STACK))
        return;
    word *w = find(at, size, &shared);
    if (!w && !writes &&
        (within(at, size, past.call, past.call_size) ||
         within(at, size, __executable_start, (size_t)(_end - __executable_start))))
        return;
    if (!w)
        fault("%s at %p, which is not the card's", writes ? "writes" : "reads", at);
    for (const word *end = w + words_in(at, size); w < end; w++)
        if (writes)
            write_word(w, atomic);
        else
            read_word(w);
}

/* An access of code that is compiled for it: a kernel's, or the host's beside it. */
static void access(const void *at, size_t size, bool writes, const void *place)
{
    if (now) {
        now->place = place;
        touch(at, size, writes);
    } else if (__asan_region_is_poisoned((void *)at, size)) {
        __asan_report_error((void *)place, __builtin_frame_address(0), __builtin_frame_address(0), (void *)at, writes,
                            size);
    }
}

extern "C" {
#define ACCESS(name, writes, size)                                                                                     \
    void __tsan_##name##size(void *at)                                                                                 \
    {                                                                                                                  \
        access(at, size, writes, __builtin_return_address(0));                                                         \
    }
#define ACCESSES(size)                                                                                                 \
    ACCESS(read, false, size)                                                                                          \
    ACCESS(write, true, size) ACCESS(unaligned_read, false, size) ACCESS(unaligned_write, true, size)
ACCESSES(1)
ACCESSES(2)
ACCESSES(4)
ACCESSES(8)
ACCESSES(16)
void __tsan_read_range(void *at, size_t size)
{
    access(at, size, false, __builtin_return_address(0));
}
void __tsan_write_range(void *at, size_t size)
{
    access(at, size, true, __builtin_return_address(0));
}
void __tsan_func_entry(void *)
{
}
void __tsan_func_exit()
{
}
void __tsan_init()
{
}
}

/* One access; f: from what is there to what is to be. Returns what was. */
template <class T, class F> static T atomically(T *at, F f)
{
    touch(at, sizeof *at, true, true);
    const T old = *at;
    *at = f(old);
    return old;
}

int atomicMin(int *at, int value)
{
    HERE();
    return atomically(at, [&](int old) { return std::min(old, value); });
}

int atomicAdd(int *at, int value)
{
    HERE();
    return atomically(at, [&](int old) { return old + value; });
}

int atomicExch(int *at, int value)
{
    HERE();
    return atomically(at, [&](int) { return value; });
}

unsigned long long atomicAdd(unsigned long long *at, unsigned long long value)
{
    HERE();
    return atomically(at, [&](unsigned long long old) { return old + value; });
}

unsigned long long atomicMax(unsigned long long *at, unsigned long long value)
{
    HERE();
    return atomically(at, [&](unsigned long long old) { return std::max(old, value); });
}

/* ---- shared memory by address */

void *emulated_dynamic()
{
    return now->home->dynamic.at;
}

uint32_t shared_at(const void *p)
{
    const bool own = within(p, 0, statics.at, statics.size);
    return (uint32_t)(own ? (const char *)p - statics.at : (const char *)p - now->home->dynamic.at + DYNAMIC_AT);
}

static char *place_of(uint32_t at, size_t size)
{
    if (at % size)
        fault("is at %u, no multiple of %zu", at, size);
    if (at < DYNAMIC_AT ? at + size > statics.size : at - DYNAMIC_AT + size > now->home->dynamic.size)
        fault("is at %u, past the block's shared memory", at);
    return at < DYNAMIC_AT ? statics.at + at : now->home->dynamic.at + (at - DYNAMIC_AT);
}

char *touch_shared(uint32_t at, size_t size, bool writes)
{
    char *p = place_of(at, size);
    touch(p, size, writes);
    return p;
}

/* ---- copies: each is there as early or as late as may be, by lot. One of what changes meanwhile is none of the
 * thread's business before it is read. */

/* What is the matter with copying from there, or NULL. */
static const char *trouble_in_copying(const float4 *from)
{
    bool shared;
    const word *w = find(from, sizeof *from, &shared);
    const char *what = NULL;
    if (!w || shared)
        fault("copies from %p, which is not the card's", (const void *)from);
    if ((uintptr_t)from % sizeof *from)
        fault("copies from %p, no multiple of %zu", (const void *)from, sizeof *from);
    for (int i = 0; i < 4; i++)
        what = what ? what : trouble_in_reading(&w[i]);
    return what;
}

/* Where the copy is of use. */
static void note_copied(const float4 *from)
{
    bool shared;
    word *w = find(from, sizeof *from, &shared);
    for (int i = 0; i < 4; i++)
        note_read(&w[i], true);
}

void send(uint32_t to, const float4 *from, bool is)
{
    HERE();
    float4 *at = (float4 *)touch_shared(to, sizeof *at, true);
    const char *unsure = is ? trouble_in_copying(from) : NULL;
    if (is && !unsure)
        note_copied(from);
    now->flights.push_back({to, is ? from : NULL, is ? *from : float4(), now->group, unsure});
    bool shared;
    word *w = find(at, sizeof *at, &shared);
    for (int i = 0; i < 4; i++)
        w[i].flying = true;
    if (lot(2))
        *at = now->flights.back().value;
}

static void land(const flight &f)
{
    float4 *at = (float4 *)place_of(f.to, sizeof *at);
    const char *unsure = f.unsure || !f.from ? f.unsure : trouble_in_copying(f.from);
    bool shared;
    word *w = find(at, sizeof *at, &shared);
    if (f.from && memcmp(f.from, &f.value, sizeof f.value))
        unsure = "what has changed since it was sent";
    for (int i = 0; i < 4; i++)
        w[i].flying = false;
    touch(at, sizeof *at, true);
    for (int i = 0; i < 4; i++)
        w[i].unsure = unsure;
    *at = f.value;
}

void sent()
{
    now->group++;
}

void emulated_arrived(int but_for)
{
    HERE();
    const int groups = now->group - but_for - (card.omission == OMIT_COPY_WAIT);
    size_t n = 0;
    for (const flight &f : now->flights)
        if (f.group < groups)
            land(f);
        else
            now->flights[n++] = f;
    now->flights.resize(n);
}

void end_flights()
{
    if (!now->flights.empty())
        fault("ends with copies on their way");
}

/* ---- the host's side */

cudaError_t cudaMalloc(void **at, size_t size)
{
    pieces.push_back(memory_of(size));
    *at = pieces.back().at;
    open_memory(false);
    return cudaSuccess;
}

cudaError_t cudaFree(void *at)
{
    for (size_t i = 0; i < pieces.size(); i++)
        if (pieces[i].at == at) {
            cudaDeviceSynchronize();
            open_memory(true);
            free(at);
            pieces.erase(pieces.begin() + (ptrdiff_t)i);
            open_memory(false);
            return cudaSuccess;
        }
    return at ? cudaErrorInvalidValue : cudaSuccess;
}

static word *words_at(const void *at, size_t size)
{
    memory *p = piece_of(at, size);
    return p ? &p->words[(size_t)((const char *)at - p->at) / 4] : NULL;
}

/* From here on these bytes are written, but for what was copied from where nobody wrote. */
static void note_written(const void *at, size_t size, const void *from)
{
    word *to = words_at(at, size);
    const word *old = words_at(from, size);
    past.at++;
    for (size_t i = 0; i < words_in(at, size); i++)
        to[i].wrote = old && !old[i].wrote ? 0 : past.at;
}

static bool is_there(const void *to, const void *from, size_t size, cudaMemcpyKind kind)
{
    return (kind != cudaMemcpyDeviceToHost) == (piece_of(to, size) != NULL) &&
           (kind != cudaMemcpyHostToDevice) == (piece_of(from, size) != NULL);
}

bool copy(void *to, const void *from, size_t size, cudaMemcpyKind kind)
{
    if (!is_there(to, from, size, kind))
        return false;
    open_memory(true);
    memcpy(to, from, size);
    open_memory(false);
    if (kind != cudaMemcpyDeviceToHost)
        note_written(to, size, from);
    return true;
}

/* What goes to the card may still be on its way when this returns. */
cudaError_t cudaMemcpy(void *to, const void *from, size_t size, cudaMemcpyKind kind)
{
    if (!is_there(to, from, size, kind))
        return cudaErrorInvalidValue;
    if (kind == cudaMemcpyDeviceToHost) {
        finish_none();
        copy(to, from, size, kind);
    } else if (kind == cudaMemcpyHostToDevice) {
        const std::vector<char> bytes((const char *)from, (const char *)from + size);
        ask(NULL, [=] { copy(to, bytes.data(), size, kind); });
    } else {
        ask(NULL, [=] { copy(to, from, size, kind); });
    }
    return cudaGetLastError();
}

cudaError_t cudaMemset(void *at, int value, size_t size)
{
    return cudaMemsetAsync(at, value, size, NULL);
}

/* Is not waited for. */
cudaError_t cudaMemsetAsync(void *at, int value, size_t size, cudaStream_t stream)
{
    if (!piece_of(at, size))
        return cudaErrorInvalidValue;
    ask(stream, [=] {
        open_memory(true);
        memset(at, value, size);
        open_memory(false);
        note_written(at, size, NULL);
    });
    return cudaGetLastError();
}
