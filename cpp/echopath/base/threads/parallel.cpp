#include "echopath/base/threads/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace echopath {
namespace {

// Denormals cost hundreds of cycles each and carry no information here; the caller's mode is restored.
class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }

 private:
  unsigned saved_;
#endif
};

std::mutex arena_mutex;
std::shared_ptr<tbb::task_arena> arena = std::make_shared<tbb::task_arena>();
std::unique_ptr<tbb::global_control> worker_limit;

// TBB starts one worker per core and no more unless told so; asking for more is useful to test that results do not change.
void allow_threads(int num_threads) {
  static const size_t one_per_core = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const size_t allowed = std::max(one_per_core, static_cast<size_t>(num_threads));
  worker_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, allowed);
}

std::shared_ptr<tbb::task_arena> current_arena() {
  const std::lock_guard lock(arena_mutex);
  return arena;
}

#ifdef ECHOPATH_THREAD_SANITIZER
// The sanitizer cannot see into the TBB library, where every hand-over of a task would look like a race: plain threads,
// which it understands, so that what it reports is ours.
void run_steps(int64_t count, const std::function<void(int64_t)>& step) {
  std::atomic<int64_t> next = 0;
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (int64_t i = next++; i < count; i = next++) step(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (int64_t k = 1; k < std::min<int64_t>(num_threads(), count); ++k) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (failure) std::rethrow_exception(failure);
}

void run_pair(const std::function<void()>& first, const std::function<void()>& second) {
  run_steps(2, [&](int64_t i) { i == 0 ? first() : second(); });
}
#else
// Each loop enters the arena anew, those inside others, too: its tasks stand apart from what surrounds it. Else an exception
// of one side of run_pair would cancel the loops of the other, which would stop half-way and return as if they had ended.
void run_steps(int64_t count, const std::function<void(int64_t)>& step) {
  const auto run_range = [&](const tbb::blocked_range<int64_t>& range) {
    for (int64_t i = range.begin(); i != range.end(); ++i) step(i);
  };
  current_arena()->execute(
      [&] { tbb::parallel_for(tbb::blocked_range<int64_t>(0, count, 1), run_range, tbb::simple_partitioner()); });
}

void run_pair(const std::function<void()>& first, const std::function<void()>& second) {
  current_arena()->execute([&] { tbb::parallel_invoke(first, second); });
}
#endif

}  // namespace

void set_num_threads(int num_threads) {
  require(num_threads >= 0, "num_threads", "must be 0 (one per core) or more", num_threads);
  const std::lock_guard lock(arena_mutex);
  allow_threads(num_threads);
  constexpr int one_per_core = tbb::task_arena::automatic;  // a copy: the member itself has no address
  arena = std::make_shared<tbb::task_arena>(num_threads == 0 ? one_per_core : num_threads);
}

int num_threads() { return current_arena()->max_concurrency(); }

void parallel_for(int64_t count, const std::function<void(int64_t)>& body, Job* job) {
  if (count <= 0) return;
  const auto step = [&](int64_t i) {
    const FlushDenormals flush;
    if (job) job->throw_if_cancelled();
    body(i);
    if (job) job->advance(1);
  };
  if (count == 1) step(0);  // other threads sleep on
  else run_steps(count, step);
}

void parallel_for_chunks(int64_t count, int64_t size, const std::function<void(int64_t begin, int64_t end)>& body,
                         Job* job) {
  parallel_for(num_chunks(count, size), [&](int64_t i) { body(i * size, std::min(count, (i + 1) * size)); }, job);
}

void run_both(const std::function<void()>& first, const std::function<void()>& second) {
  const auto flushed = [](const std::function<void()>& work) {
    return [&work] {
      const FlushDenormals flush;
      work();
    };
  };
  run_pair(flushed(first), flushed(second));
}

}  // namespace echopath
