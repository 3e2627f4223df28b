#include "echopath/base/kept_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <thread>
#include <utility>

namespace echopath {
namespace {

// Memory of so many bytes, in name only.
struct Work {
  size_t bytes = 0;
  std::atomic<int> users = 0;

  size_t num_bytes() const { return bytes; }
};
using Kept = KeptMemory<Work>;
static_assert(noexcept(std::declval<Kept&>().leave(nullptr)), "destructors leave memory");

std::unique_ptr<Work> work_of(size_t bytes) {
  auto work = std::make_unique<Work>();
  work->bytes = bytes;
  return work;
}

TEST(KeptMemory, WhatIsLeftLastIsTakenFirst) {
  Kept kept;
  for (const size_t bytes : {10, 30, 20}) kept.leave(work_of(bytes));
  for (const size_t bytes : {20, 30, 10}) EXPECT_EQ(kept.take()->bytes, bytes);
}

TEST(KeptMemory, IsNewWhereNothingIsLeft) {
  Kept kept;
  EXPECT_EQ(kept.take()->bytes, 0u);
  kept.leave(work_of(10));
  kept.take();
  EXPECT_EQ(kept.take()->bytes, 0u);
}

TEST(KeptMemory, KeepsNoMoreThanItsMostInAll) {
  Kept kept;
  kept.leave(work_of(Kept::kMost + 1));
  EXPECT_EQ(kept.take()->bytes, 0u);
  kept.leave(work_of(Kept::kMost - 10));
  kept.leave(work_of(11));
  EXPECT_EQ(kept.take()->bytes, Kept::kMost - 10);
  kept.leave(work_of(Kept::kMost - 10));
  kept.leave(work_of(10));
  EXPECT_EQ(kept.take()->bytes, 10u);
}

TEST(KeptMemory, HasRoomAgainForWhatWasTaken) {
  Kept kept;
  for (int i = 0; i < 3; ++i) {
    kept.leave(work_of(Kept::kMost));
    EXPECT_EQ(kept.take()->bytes, Kept::kMost);
  }
}

TEST(KeptMemory, BelongsToOneThreadAtATime) {
  constexpr int kThreads = 4, kRounds = 20000;
  Kept kept;
  std::atomic<int> num_shared = 0;
  const auto use = [&] {
    for (int i = 0; i < kRounds; ++i) {
      std::unique_ptr<Work> work = kept.take();
      num_shared += work->users++ != 0;
      work->bytes = Kept::kMost / kThreads;  // all that are in use have room
      --work->users;
      kept.leave(std::move(work));
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) threads.emplace_back(use);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(num_shared, 0);
  std::set<Work*> left;
  std::vector<std::unique_ptr<Work>> all;
  while (all.empty() || all.back()->bytes != 0) left.insert(all.emplace_back(kept.take()).get());
  EXPECT_EQ(left.size(), all.size());
  EXPECT_GE(all.size(), 2u);  // and what is new
  EXPECT_LE(all.size(), size_t{kThreads} + 1);
}

}  // namespace
}  // namespace echopath
