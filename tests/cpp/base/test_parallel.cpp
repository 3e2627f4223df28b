#include "echopath/base/threads/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <set>
#include <thread>
#include <vector>

#include "cpp/support/expect_error.h"

namespace echopath::test_parallel {
namespace {

constexpr int64_t kCount = 10000;
constexpr int kStages = 3000000;  // so many that a reader meets some that begin: seven runs of ten did

class ParallelFor : public ::testing::Test {
 protected:
  void TearDown() override { set_num_threads(0); }
};

TEST_F(ParallelFor, CallsTheBodyOnceForEachIndex) {
  for (const int threads : {1, 2, 4}) {
    set_num_threads(threads);
    std::vector<std::atomic<int>> calls(kCount);
    parallel_for(kCount, [&](int64_t i) { ++calls[static_cast<size_t>(i)]; });
    EXPECT_TRUE(std::all_of(calls.begin(), calls.end(), [](const auto& n) { return n == 1; })) << threads << " threads";
  }
}

TEST_F(ParallelFor, DoesNothingForAnEmptyRange) {
  for (const int64_t count : {int64_t{0}, int64_t{-3}}) parallel_for(count, [](int64_t) { FAIL(); });
}

TEST_F(ParallelFor, RethrowsTheExceptionOfABody) {
  const auto body = [](int64_t i) { require(i != 4321, "index", "must not be that one", i); };
  EXPECT_EQ(test::error_text([&] { parallel_for(kCount, body); }), "index: must not be that one, got 4321");
}

TEST_F(ParallelFor, WorksAgainAfterAnException) {
  EXPECT_THROW(parallel_for(kCount, [](int64_t) { throw FileError("disk"); }), FileError);
  std::atomic<int64_t> sum = 0;
  parallel_for(kCount, [&](int64_t i) { sum += i; });
  EXPECT_EQ(sum, kCount * (kCount - 1) / 2);
}

TEST_F(ParallelFor, RunsLoopsInsideLoops) {
  std::atomic<int64_t> sum = 0;
  parallel_for(30, [&](int64_t i) { parallel_for(40, [&](int64_t j) { sum += i * j; }); });
  EXPECT_EQ(sum, (29 * 30 / 2) * (39 * 40 / 2));
}

TEST_F(ParallelFor, AdvancesTheJobByItsCount) {
  Job job;
  job.start(4 * kCount);
  EXPECT_EQ(job.fraction(), 0.0);
  parallel_for(kCount, [](int64_t) {}, &job);
  EXPECT_EQ(job.fraction(), 0.25);
}

TEST(Job, TellsNoMoreThanAllWhileStagesBegin) {
  Job job;
  std::atomic<bool> has_ended = false;
  std::thread stages([&] {
    for (int i = 0; i < kStages; ++i) {
      for (const int64_t total : {int64_t{1}, kCount}) {
        job.start(total);
        job.advance(total);
      }
    }
    has_ended = true;
  });
  double most = 0.0;
  while (!has_ended) most = std::max(most, job.fraction());
  stages.join();
  EXPECT_LE(most, 1.0);
}

TEST_F(ParallelFor, CancelledBeforeTheLoopRunsNothing) {
  Job job;
  job.cancel();
  EXPECT_THROW(parallel_for(kCount, [](int64_t) { FAIL(); }, &job), Cancelled);
}

TEST_F(ParallelFor, CancelledFromAnotherThreadStopsLongBeforeTheEnd) {
  Job job;
  std::atomic<int64_t> calls = 0;
  std::thread other([&] {
    while (calls == 0) std::this_thread::yield();
    job.cancel();
  });
  const auto body = [&](int64_t) {
    ++calls;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  EXPECT_THROW(parallel_for(kCount, body, &job), Cancelled);
  other.join();
  EXPECT_LT(calls, kCount / 2);
}

TEST_F(ParallelFor, FlushesDenormalsInsideAndRestoresTheCallersMode) {
  const volatile double smallest = std::numeric_limits<double>::min();
  std::atomic<int> num_denormals = 0;
  parallel_for(100, [&](int64_t) { num_denormals += smallest * 0.5 != 0.0; });
#if defined(__SSE2__)
  EXPECT_EQ(num_denormals, 0);
#endif
  EXPECT_NE(smallest * 0.5, 0.0);
}

TEST_F(ParallelFor, RunBothCallsBothOnceAndSharesTheirLoops) {
  for (const int threads : {1, 2, 4}) {
    set_num_threads(threads);
    std::atomic<int64_t> first = 0, second = 0;
    run_both([&] { parallel_for(kCount, [&](int64_t i) { first += i; }); },
             [&] { parallel_for(kCount, [&](int64_t i) { second += 2 * i; }); });
    EXPECT_EQ(first, kCount * (kCount - 1) / 2) << threads << " threads";
    EXPECT_EQ(second, kCount * (kCount - 1)) << threads << " threads";
  }
}

TEST_F(ParallelFor, RunBothRethrowsWhatEitherThrows) {
  const auto nothing = [] {};
  const auto fails = [] { throw FileError("disk"); };
  EXPECT_THROW(run_both(fails, nothing), FileError);
  EXPECT_THROW(run_both(nothing, fails), FileError);
  EXPECT_THROW(run_both([] { parallel_for(kCount, [](int64_t) { throw FileError("disk"); }); }, nothing), FileError);
}

// The side that throws waits until the loop of the other has begun.
TEST_F(ParallelFor, RunBothEndsTheLoopOfOneSideWhereTheOtherThrows) {
  constexpr int64_t kSteps = 1000;
  for (const int threads : {2, 4}) {
    set_num_threads(threads);
    for (const bool first_throws : {false, true}) {
      std::atomic<int64_t> calls = 0;
      const std::function<void()> fails = [&] {
        while (calls == 0) std::this_thread::yield();
        throw FileError("disk");
      };
      const std::function<void()> counts = [&] {
        parallel_for(kSteps, [&](int64_t) {
          std::this_thread::sleep_for(std::chrono::microseconds(1));
          ++calls;
        });
        EXPECT_EQ(calls, kSteps) << threads << " threads";
      };
      EXPECT_THROW(run_both(first_throws ? fails : counts, first_throws ? counts : fails), FileError);
      EXPECT_EQ(calls, kSteps) << threads << " threads";
    }
  }
}

TEST_F(ParallelFor, RunBothFlushesDenormalsInsideAndRestoresTheCallersMode) {
  const volatile double smallest = std::numeric_limits<double>::min();
  std::atomic<int> num_denormals = 0;
  const auto look = [&] { num_denormals += smallest * 0.5 != 0.0; };
  run_both(look, look);
#if defined(__SSE2__)
  EXPECT_EQ(num_denormals, 0);
#endif
  EXPECT_NE(smallest * 0.5, 0.0);
}

TEST(NumThreads, IsWhatWasSet) {
  for (const int threads : {1, 2, 3}) {
    set_num_threads(threads);
    EXPECT_EQ(num_threads(), threads);
  }
  set_num_threads(0);
  EXPECT_GE(num_threads(), 1);
}

TEST(NumThreads, MoreThanCoresAreReallyThere) {
  const int threads = 2 * static_cast<int>(std::thread::hardware_concurrency());
  set_num_threads(threads);
  // Each body waits for all others, which only that many threads at once can satisfy.
  std::atomic<int> arrived = 0;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  parallel_for(threads, [&](int64_t) {
    ++arrived;
    while (arrived < threads && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  });
  EXPECT_LT(std::chrono::steady_clock::now(), deadline);
  set_num_threads(0);
}

TEST(NumThreads, OneThreadRunsEverythingOnTheCaller) {
  set_num_threads(1);
  std::set<std::thread::id> threads;
  parallel_for(kCount, [&](int64_t) { threads.insert(std::this_thread::get_id()); });
  EXPECT_EQ(threads, std::set<std::thread::id>{std::this_thread::get_id()});
  set_num_threads(0);
}

TEST(NumThreads, RefusesNegativeNumbers) {
  EXPECT_EQ(test::error_text([] { set_num_threads(-2); }), "num_threads: must be 0 (one per core) or more, got -2");
}

}  // namespace
}  // namespace echopath::test_parallel
