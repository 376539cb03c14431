/* An emulated card's streams: what is started or copied in one is done when something waits for it, or
 * before, by lot. One thread of the host calls.
 */
#include "machine.h"

#include <deque>

/* What has been asked for and is not done yet. */
struct emulated_stream {
    std::deque<std::function<void()>> asked;
    uint64_t done = 0; /* so far */
};

/* What had been asked of a stream when it was recorded. */
struct emulated_event {
    cudaStream_t stream = NULL;
    uint64_t number = 0;
};

/* The first is what stands for none: other streams do not wait for it. */
static emulated_stream none;
static std::vector<cudaStream_t> streams = {&none};

static void run_until(cudaStream_t stream, uint64_t number)
{
    while (stream && stream->done < number) {
        const std::function<void()> next = std::move(stream->asked.front());
        stream->asked.pop_front();
        stream->done++;
        next();
    }
}

static uint64_t asked_of(cudaStream_t stream)
{
    return stream->done + stream->asked.size();
}

void ask(cudaStream_t stream, std::function<void()> what)
{
    stream = stream ? stream : &none;
    stream->asked.push_back(std::move(what));
    if (lot(2))
        run_until(stream, stream->done + lot((uint32_t)stream->asked.size() + 1));
}

void finish_none()
{
    run_until(&none, asked_of(&none));
}

cudaError_t cudaDeviceSynchronize()
{
    for (cudaStream_t stream : streams)
        run_until(stream, asked_of(stream));
    return cudaGetLastError();
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t *stream, unsigned)
{
    *stream = new emulated_stream;
    streams.push_back(*stream);
    return cudaSuccess;
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream)
{
    stream = stream ? stream : &none;
    run_until(stream, asked_of(stream));
    return cudaGetLastError();
}

cudaError_t cudaStreamDestroy(cudaStream_t stream)
{
    run_until(stream, asked_of(stream));
    streams.erase(std::find(streams.begin(), streams.end(), stream));
    delete stream;
    return cudaSuccess;
}

cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned)
{
    const emulated_event as_is = *event;
    ask(stream, [as_is] { run_until(as_is.stream, as_is.number); });
    return cudaSuccess;
}

cudaError_t cudaEventCreateWithFlags(cudaEvent_t *event, unsigned)
{
    *event = new emulated_event;
    return cudaSuccess;
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream)
{
    *event = {stream, asked_of(stream)};
    return cudaSuccess;
}

cudaError_t cudaEventSynchronize(cudaEvent_t event)
{
    run_until(event->stream, event->number);
    return cudaGetLastError();
}

cudaError_t cudaEventDestroy(cudaEvent_t event)
{
    delete event;
    return cudaSuccess;
}

cudaError_t cudaMemcpyAsync(void *to, const void *from, size_t size, cudaMemcpyKind kind, cudaStream_t stream)
{
    ask(stream, [=] {
        if (!copy(to, from, size, kind))
            fault("copies what is not where it should be");
    });
    return cudaGetLastError();
}
