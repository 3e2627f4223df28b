#include "echopath/base/memory/recent_results.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace echopath::test_recent_results {
namespace {

struct Squares {
  RecentResults<int, int> recent{2};
  std::vector<int> made;

  int operator()(int x) {
    return recent.get(x, [&] {
      made.push_back(x);
      return x * x;
    });
  }
};

TEST(RecentResults, AreMadeOnce) {
  Squares square;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(square(5), 25);
  EXPECT_EQ(square.made, std::vector<int>{5});
}

TEST(RecentResults, ThatWereAskedForLastAreKept) {
  Squares square;
  for (const int x : {1, 2, 1, 3, 1, 2}) EXPECT_EQ(square(x), x * x);
  EXPECT_EQ(square.made, (std::vector<int>{1, 2, 3, 2}));
}

TEST(RecentResults, AreNotKeptWhereMakingThemFails) {
  RecentResults<int, int> recent(2);
  const auto fail = []() -> int { throw std::runtime_error("no"); };
  EXPECT_THROW(recent.get(1, fail), std::runtime_error);
  EXPECT_EQ(recent.get(1, [] { return 4; }), 4);
}

// Whoever makes the same meanwhile adds nothing: here the second is made while the first is.
TEST(RecentResults, AreKeptOnceHoweverManyMakeThem) {
  RecentResults<int, int> recent(3);
  EXPECT_EQ(recent.get(1, [&] { return recent.get(1, [] { return 4; }); }), 4);
  EXPECT_EQ(recent.size(), 1u);
}

TEST(RecentResults, AreThoseOfTheirKeysOnAnyThread) {
  RecentResults<int, int> recent(3);
  std::vector<int> wrong(4);
  std::vector<std::thread> threads;
  for (int& of_thread : wrong) {
    threads.emplace_back([&recent, &of_thread] {
      for (int i = 0; i < 5000; ++i) {
        const int key = i % 5;
        of_thread += recent.get(key, [key] { return 10 * key; }) != 10 * key;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4));
}

}  // namespace
}  // namespace echopath::test_recent_results
