#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "echopath/base/lazy.h"
#include "echopath/base/parallel.h"

namespace echopath {
namespace {

TEST(Lazy, IsMadeOnceHoweverManyThreadsAsk) {
  const Lazy<int> value;
  std::atomic<int> num_made = 0, num_right = 0;
  parallel_for(1000, [&](int64_t) {
    num_right += value.get([&] {
      ++num_made;
      return 7;
    }) == 7;
  });
  EXPECT_EQ(num_made, 1);
  EXPECT_EQ(num_right, 1000);
}

TEST(Lazy, IsMadeByTheNextWhereMakingItFailed) {
  const Lazy<int> value;
  const auto fail = []() -> int { throw std::runtime_error("not yet"); };
  EXPECT_THROW(value.get(fail), std::runtime_error);
  EXPECT_EQ(value.get([] { return 3; }), 3);
  EXPECT_EQ(value.get(fail), 3);
}

}  // namespace
}  // namespace echopath
