#pragma once
// Runs parallel loops (TBB) in one arena whose size `set_num_threads` fixes. Results must not depend on the number of
// threads: a task owns what it writes, and whoever adds up does so in index order.
#include <cstdint>
#include <functional>

#include "echopath/base/threads/job.h"

namespace echopath {

// Sets the number of threads of all parallel loops from now on; 0 means one per core. Raises invalid_argument if negative.
void set_num_threads(int num_threads);
int num_threads();

// Calls body(i) for i in [0, count), in any order, on any thread, denormals flushed to zero inside. The first exception of
// a body is rethrown here after all tasks ended. With a job: each i advances it by one, and cancelling raises Cancelled.
void parallel_for(int64_t count, const std::function<void(int64_t)>& body, Job* job = nullptr);

// Returns how many chunks of `size` each [0, count) has; the last one may be smaller.
constexpr int64_t num_chunks(int64_t count, int64_t size) { return (count + size - 1) / size; }
// Calls body(begin, end) for each of these chunks, as parallel_for does for each i.
void parallel_for_chunks(int64_t count, int64_t size, const std::function<void(int64_t begin, int64_t end)>& body,
                         Job* job = nullptr);

// Calls both, side by side where there are threads; their own parallel loops share these. An exception of either is rethrown
// here after what has begun has ended; the other may not have begun then. Neither may wait for the other, nor hold a lock
// across a parallel loop that the other takes: who waits for tasks helps with any.
void run_both(const std::function<void()>& first, const std::function<void()>& second);

}  // namespace echopath
