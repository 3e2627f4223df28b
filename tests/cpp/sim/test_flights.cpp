#include "echopath/sim/stream/flights.h"

#include <gtest/gtest.h>

#include <random>

namespace echopath::test_flights {

std::vector<PathsInFlight> random_lists(std::mt19937& random) {
  std::vector<PathsInFlight> lists(1 + random() % 12);
  for (PathsInFlight& list : lists) {
    const int64_t most = random() % 4 == 0 ? 200000 : 300;
    list = {1 + static_cast<int64_t>(random()) % most, 1 + static_cast<int64_t>(random() % (random() % 2 == 0 ? 64 : 256)),
            1};
    if (random() % 2 == 0) list.num_rows = 4 << (random() % 10);
  }
  return lists;
}

TEST(Flights, HaveEachPathOfEachListOnceAndInOrder) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<PathsInFlight> lists = random_lists(random);
    size_t list = 0;
    int64_t next = 0;
    for (const Flight& flight : plan_flights(lists)) {
      ASSERT_FALSE(flight.empty());
      for (const BlockInFlight& block : flight) {
        if (next == lists[list].num_paths) ++list, next = 0;
        ASSERT_EQ(block.list, list);
        ASSERT_EQ(block.begin, next);
        ASSERT_GT(block.end, block.begin);
        next = block.end;
      }
    }
    EXPECT_EQ(list, lists.size() - 1);
    EXPECT_EQ(next, lists.back().num_paths);
  }
}

// The header of ReplayStream promises a bound of .2 GiB at 32 nodes a path: a delay and a complex amplitude at each.
TEST(Flights, HoldABoundedNumberOfBlocksAndValues) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const std::vector<PathsInFlight> lists = random_lists(random);
    for (const Flight& flight : plan_flights(lists)) {
      EXPECT_LE(flight.size(), 32U);
      int64_t bytes = 0;
      for (const BlockInFlight& block : flight) {
        const PathsInFlight& list = lists[block.list];
        EXPECT_LE(block.end - block.begin, 1000);
        bytes += (block.end - block.begin) * list.num_channels * list.num_rows * 24;
      }
      EXPECT_LE(bytes, int64_t{215} << 20);
    }
  }
}

TEST(Flights, AreSharedByShortLists) {
  const std::vector<PathsInFlight> lists = {{625, 12, 6}, {875, 12, 8}, {1000, 4, 128}, {90, 4, 512}};
  EXPECT_EQ(plan_flights(lists).size(), 1U);
}

TEST(Flights, OfNoPathsAreNone) { EXPECT_TRUE(plan_flights({}).empty()); }

}  // namespace echopath::test_flights
