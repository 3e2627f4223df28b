#include "echopath/base/lanes/lanes.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace echopath::test_lanes {
namespace {

TEST(Lanes, AreLoadedAndStoredFromAnywhere) {
  alignas(64) double from[9], to[10] = {};
  for (int i = 0; i < 9; ++i) from[i] = i;
  store_lanes(to + 1, 2.0 * load_lanes<8>(from + 1));
  EXPECT_EQ(to[0], 0.0);
  for (int i = 1; i < 9; ++i) EXPECT_EQ(to[i], 2.0 * i);
  EXPECT_EQ(to[9], 0.0);
}

TEST(Lanes, AreChosenOneByOne) {
  const int32_t values[] = {3, -1, 4, -1};
  const Lanes<int32_t, 4> x = load_lanes<4>(values), none = {};
  const Lanes<int32_t, 4> positive = x > 0 ? x : none;
  for (int i = 0; i < 4; ++i) EXPECT_EQ(positive[i], values[i] > 0 ? values[i] : 0);
}

TEST(Simd, PicksTheSetOfTheProcess) {
  const InstructionSet set = with_instruction_set([](auto picked) { return decltype(picked)::value; });
  EXPECT_EQ(set, instruction_set());
}

ECHOPATH_INLINE void add_up(const double* values, int count, double* sum) {
  for (int i = 0; i < count; ++i) *sum += values[i];
}

TEST(Simd, LoopsGetTheirArguments) {
  const double values[] = {1.0, 2.0, 4.0};
  double sum = 8.0;
  run_simd<add_up>(values, 3, &sum);
  EXPECT_EQ(sum, 15.0);
}

}  // namespace
}  // namespace echopath::test_lanes
