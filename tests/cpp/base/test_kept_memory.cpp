#include "echopath/base/memory/kept_memory.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace {

// Allocations of this thread that still succeed; negative: all do.
thread_local int64_t allocations_left = -1;

}  // namespace

// The allocations of the whole program, which can be made to fail. They are not inlined: the compiler would see memory of
// new that free gives back.
__attribute__((noinline)) void* operator new(size_t num_bytes, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(num_bytes > 0 ? num_bytes : 1);
}
__attribute__((noinline)) void* operator new(size_t num_bytes) {
  if (allocations_left == 0) throw std::bad_alloc();
  if (allocations_left > 0) --allocations_left;
  void* const memory = std::malloc(num_bytes > 0 ? num_bytes : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}
__attribute__((noinline)) void operator delete(void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, size_t /*num_bytes*/) noexcept { std::free(memory); }

namespace echopath::test_kept_memory {
namespace {

// Memory of so many bytes, in name only. Kinds are types of their own.
template <int kKind>
struct Work {
  size_t bytes = 0;
  std::atomic<int> users = 0;

  size_t num_bytes() const { return bytes; }
};
using Rows = Work<0>;
using Echoes = Work<1>;
// Memory whose owner tells whether it was freed.
struct Counted {
  std::shared_ptr<int> owner;
  size_t num_bytes() const { return owner ? 10 : 0; }
};
static_assert(noexcept(std::declval<KeptMemory&>().leave(std::unique_ptr<Rows>())), "destructors leave memory");

constexpr size_t kObject = sizeof(Rows);  // bytes that one takes besides

template <class Kind = Rows>
std::unique_ptr<Kind> work_of(size_t bytes) {
  auto work = std::make_unique<Kind>();
  work->bytes = bytes;
  return work;
}

TEST(KeptMemory, TheSmallestThatWillDoIsTaken) {
  KeptMemory kept;
  for (const size_t bytes : {10, 30, 20}) kept.leave(work_of(bytes));
  EXPECT_EQ(kept.take<Rows>(11)->bytes, 20u);
  EXPECT_EQ(kept.take<Rows>(30)->bytes, 30u);
  EXPECT_EQ(kept.take<Rows>(10)->bytes, 10u);
  EXPECT_EQ(kept.take<Rows>(10)->bytes, 0u);
}

TEST(KeptMemory, TheLargestMakesRoomWhereNoneWillDo) {
  KeptMemory kept;
  for (const size_t bytes : {10, 30, 20}) kept.leave(work_of(bytes));
  for (const size_t bytes : {30, 20, 10, 0}) EXPECT_EQ(kept.take<Rows>(31)->bytes, bytes);
}

TEST(KeptMemory, TheLargestIsTakenWhereNoSizeIsAskedFor) {
  KeptMemory kept;
  for (const size_t bytes : {10, 30, 20}) kept.leave(work_of(bytes));
  for (const size_t bytes : {30, 20, 10, 0}) EXPECT_EQ(kept.take<Rows>()->bytes, bytes);
}

TEST(KeptMemory, OfEqualOnesTheLastLeftIsTakenFirst) {
  KeptMemory kept;
  std::vector<const Rows*> left;
  for (int i = 0; i < 4; ++i) {
    auto rows = work_of(10);
    left.push_back(rows.get());
    kept.leave(std::move(rows));
  }
  const auto last = kept.take<Rows>(), third = kept.take<Rows>(10), second = kept.take<Rows>(5);
  EXPECT_EQ(last.get(), left[3]);
  EXPECT_EQ(third.get(), left[2]);
  EXPECT_EQ(second.get(), left[1]);
}

TEST(KeptMemory, TypesAreKeptApart) {
  KeptMemory kept;
  kept.leave(work_of<Rows>(10));
  EXPECT_EQ(kept.take<Echoes>()->bytes, 0u);
  EXPECT_EQ(kept.take<Echoes>(1)->bytes, 0u);
  kept.leave(work_of<Echoes>(20));
  EXPECT_EQ(kept.take<Rows>(15)->bytes, 10u);
  EXPECT_EQ(kept.take<Echoes>()->bytes, 20u);
}

TEST(KeptMemory, AllTypesShareOneBudgetFromWhichTheOldestGoes) {
  KeptMemory kept(100 + 2 * kObject);
  kept.leave(work_of<Rows>(40));
  kept.leave(work_of<Echoes>(60));
  kept.leave(work_of<Echoes>(39));  // takes the place of the rows, and of no more
  EXPECT_EQ(kept.take<Rows>()->bytes, 0u);
  EXPECT_EQ(kept.take<Echoes>()->bytes, 60u);
  EXPECT_EQ(kept.take<Echoes>()->bytes, 39u);
}

TEST(KeptMemory, NothingGoesForWhatIsLargerThanTheBudget) {
  KeptMemory kept(100 + kObject);
  kept.leave(work_of<Rows>(100));
  kept.leave(work_of<Echoes>(101));
  EXPECT_EQ(kept.take<Echoes>()->bytes, 0u);
  EXPECT_EQ(kept.take<Rows>()->bytes, 100u);
}

TEST(KeptMemory, HasRoomAgainForWhatWasTaken) {
  KeptMemory kept(100 + kObject);
  for (int i = 0; i < 3; ++i) {
    kept.leave(work_of<Rows>(100));
    EXPECT_EQ(kept.take<Rows>()->bytes, 100u);
    kept.leave(work_of<Echoes>(100));
    EXPECT_EQ(kept.take<Echoes>()->bytes, 100u);
  }
}

TEST(KeptMemory, NothingIsKeptOfWhatIsEmptyOrMovedFrom) {
  KeptMemory kept;
  kept.leave(std::unique_ptr<Rows>());
  auto empty = work_of(0);
  empty->users = 7;
  kept.leave(std::move(empty));
  EXPECT_EQ(kept.take<Rows>()->users, 0);
}

// Takes and leaves one kind of work many times; counts what another thread has at the same time.
template <class Kind>
void use(KeptMemory& kept, std::atomic<int>& num_shared) {
  constexpr int kRounds = 10000;
  for (size_t i = 0; i < kRounds; ++i) {
    std::unique_ptr<Kind> work = i % 2 ? kept.take<Kind>() : kept.take<Kind>(i % 5);
    num_shared += work->users++ != 0;
    work->bytes = 1 + i % 7;
    --work->users;
    kept.leave(std::move(work));
  }
}

template <class Kind>
void expect_distinct(KeptMemory& kept, size_t num_threads) {
  std::vector<std::unique_ptr<Kind>> all;
  std::set<const Kind*> distinct;
  do {
    distinct.insert(all.emplace_back(kept.take<Kind>()).get());
  } while (all.back()->bytes != 0);  // the last is new
  EXPECT_EQ(distinct.size(), all.size());
  EXPECT_GE(all.size(), 2u);
  EXPECT_LE(all.size(), num_threads + 1);  // and no more than were in use at once
}

TEST(KeptMemory, BelongsToOneThreadAtATime) {
  constexpr size_t kThreads = 2;  // of each kind
  KeptMemory kept;
  std::atomic<int> num_shared = 0;
  std::vector<std::thread> threads;
  for (size_t i = 0; i < kThreads; ++i) {
    threads.emplace_back([&] { use<Rows>(kept, num_shared); });
    threads.emplace_back([&] { use<Echoes>(kept, num_shared); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(num_shared, 0);
  expect_distinct<Rows>(kept, kThreads);
  expect_distinct<Echoes>(kept, kThreads);
}

// Destructors leave memory: they must not throw where there is none for the entry that names it.
TEST(KeptMemory, WhatItHasNoRoomToNameIsFreed) {
  for (int64_t succeed = 0; succeed < 3; ++succeed) {  // entries of a list and of a map
    KeptMemory kept;
    auto of_freed = std::make_shared<int>();
    auto counted = std::make_unique<Counted>(Counted{of_freed});
    allocations_left = succeed;
    kept.leave(std::move(counted));
    allocations_left = -1;
    const bool is_kept = of_freed.use_count() == 2;
    EXPECT_EQ(is_kept, succeed == 2);
    EXPECT_EQ(kept.take<Counted>()->owner != nullptr, is_kept);
    kept.leave(work_of(10));
    EXPECT_EQ(kept.take<Rows>()->bytes, 10u);
  }
}

}  // namespace
}  // namespace echopath::test_kept_memory
