#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "cpp/support/sanitized.h"
#include "echopath/base/memory/lazy.h"

namespace echopath::test_lazy {
namespace {

TEST(Lazy, IsMadeOnceHoweverManyThreadsAsk) {
  constexpr int kNumThreads = 8;
  const Lazy<int> value;
  std::atomic<int> num_made = 0, num_right = 0;
  std::barrier all_ask(kNumThreads);
  std::vector<std::jthread> threads;
  for (int i = 0; i < kNumThreads; ++i) {
    threads.emplace_back([&] {
      all_ask.arrive_and_wait();
      num_right += value.get([&] {
        ++num_made;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return 7;
      }) == 7;
    });
  }
  threads.clear();
  EXPECT_EQ(num_made, 1);
  EXPECT_EQ(num_right, kNumThreads);
}

TEST(Lazy, IsMadeByTheNextWhereMakingItFailed) {
  if (test::kThreadsAreWatched) GTEST_SKIP() << "behind an exception the thread sanitizer's own call_once waits for ever";
  const Lazy<int> value;
  const auto fail = []() -> int { throw std::runtime_error("not yet"); };
  EXPECT_THROW(value.get(fail), std::runtime_error);
  EXPECT_EQ(value.get([] { return 3; }), 3);
  EXPECT_EQ(value.get(fail), 3);
}

}  // namespace
}  // namespace echopath::test_lazy
