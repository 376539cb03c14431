/* What an emulated card's blocks tell each other.
 *
 * Words of relaxed_store() say nothing of what their writers did: but that what these read has been read, which is
 * roughly taken for known once any word of any block was heard. tell_done() hands on the clocks of what its thread
 * knows to be done, by its block and by others of which it has heard; who hears it may rely on that, and so may threads
 * of its block that meet it later.
 */
#include "machine.h"
#include "tled/cuda/cuda_ptx.cuh"

/* ---- words without order */

static word *told(const void *at)
{
    bool shared;
    word *w = find(at, sizeof(uint64_t), &shared);
    if (!w || shared || (uintptr_t)at % sizeof(uint64_t))
        fault("tells others at %p, which is not the card's memory", at);
    return w;
}

void relaxed_store(uint64_t *to, uint64_t word)
{
    HERE();
    told(to);
    touch(to, sizeof *to, true, true);
    *to = word;
    changed();
}

uint64_t relaxed_load(const uint64_t *from)
{
    HERE();
    const word *w = told(from);
    if (!w->wrote)
        fault("hears what nobody wrote");
    pass_on();
    now->home->heard |= w->wrote == past.at;
    return *from;
}

uint32_t take_ticket(uint32_t *from)
{
    HERE();
    touch(from, sizeof *from, true, true);
    return card.omission == OMIT_TICKET && !lot(8) ? *from : (*from)++;
}

/* ---- words that say what is done */

static std::map<const uint32_t *, telling> told_done;

static void take_over(clocks &all, const clocks &of)
{
    all.resize(of.size());
    for (size_t i = 0; i < of.size(); i++)
        all[i] = std::max(all[i], of[i]);
}

void tell_done(uint32_t *to, uint32_t word)
{
    HERE();
    const auto done = std::make_shared<std::map<int32_t, clocks>>();
    uint32_t &clock = now->clock[(size_t)now->thread];
    touch(to, sizeof *to, true, true);
    for (const telling &t : now->home->tellings)
        for (const auto &other : *t.done)
            if (known(t.heard))
                take_over((*done)[other.first], other.second);
    (*done)[now->home->index] = now->clock;
    told_done[to] = {now->home->index, past.at, {now->thread, clock++}, {}, done};
    *to = word;
    changed();
}

/* What is heard is added, if it is not known here, and what is earlier goes; but not the last of that:
 * the new is known to this thread alone. */
static void hear(telling what)
{
    std::vector<telling> &all = now->home->tellings;
    const auto is_known = [&](const telling &t) {
        return t.block == what.block && t.said.thread == what.said.thread && known(t.heard);
    };
    uint32_t last = 0;
    for (const telling &t : all)
        last = is_known(t) ? std::max(last, t.said.clock) : last;
    if (last >= what.said.clock)
        return;
    const auto is_old = [&](const telling &t) { return is_known(t) && t.said.clock < last; };
    all.erase(std::remove_if(all.begin(), all.end(), is_old), all.end());
    what.heard = {now->thread, now->clock[(size_t)now->thread]};
    all.push_back(what);
}

uint32_t hear_done(const uint32_t *from)
{
    HERE();
    bool shared;
    const word *w = find(from, sizeof *from, &shared);
    if (!w || shared || !w->wrote)
        fault("hears what nobody wrote");
    pass_on();
    const auto found = told_done.find(from);
    if (card.omission != OMIT_HEAR_DONE && found != told_done.end() && found->second.launch == past.at)
        hear(found->second);
    return *from;
}

bool is_told(int32_t block, moment when)
{
    for (const telling &t : now->home->tellings) {
        const auto found = t.done->find(block);
        if (found != t.done->end() && when.clock <= found->second[(size_t)when.thread] && known(t.heard))
            return true;
    }
    return false;
}
