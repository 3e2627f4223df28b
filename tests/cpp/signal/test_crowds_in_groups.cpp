// The NUFFT as it adds many moving echoes of several groups and channels. Truth is the direct sum in double.
#include <gtest/gtest.h>

#include <algorithm>

#include "cpp/signal/crowds.h"

namespace echopath::test_crowds_in_groups {
namespace {

using namespace testing;

constexpr double kAdditivity = 1e-12;

// Those of one group, by themselves.
Echoes echoes_of_group(const Echoes& all, uint32_t group) {
  Echoes part;
  part.sampling = all.sampling;
  for (int k = 0; k < all.sampling.num_rows; ++k) {
    for (int64_t p = 0; p < all.num_echoes; ++p) {
      if (all.group[static_cast<size_t>(p)] != group) continue;
      part.delay.push_back(all.delay[static_cast<size_t>(k * all.num_echoes + p)]);
      part.amplitude.push_back(all.amplitude[static_cast<size_t>(k * all.num_echoes + p)]);
    }
  }
  part.num_echoes = static_cast<int64_t>(part.delay.size()) / all.sampling.num_rows;
  return part;
}

TEST(CrowdsInGroups, GroupsOfACrowdHoldTheirOwnAndAddUpToIt) {
  const ChirpSequence w = few_chirps();
  constexpr double kTolerance = 1e-9;
  Echoes echoes = crowd(w, 3000, 400 * cell_delay(w), 12, 1);
  const auto whole = testing::synthesize(w, echoes, {kTolerance, Method::kNufft});
  for (int p = 0; p < 3000; ++p) echoes.group.push_back(static_cast<uint32_t>(p * 7919 % 5));
  Synthesizer parts(w, 1, 5, 3000, {kTolerance, Method::kNufft});
  parts.add(0, echoes);
  std::vector<Complex> sum(whole.size());
  for (int g = 0; g < 5; ++g) {
    const Echoes own = echoes_of_group(echoes, static_cast<uint32_t>(g));
    const auto part = parts.cube(g), alone = testing::synthesize(w, own, {.method = Method::kDirect});
    EXPECT_LT(rms_error(part, alone, testing::sum_of_magnitudes(own.amplitude)), kTolerance) << g;
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
  }
  EXPECT_LT(testing::largest_difference(sum, whole), kAdditivity * 3000);
}

// The second channel is near the first, so it takes over its order; the third has other delays and the fourth other groups.
TEST(CrowdsInGroups, ChannelsThatShareAnOrderAndOthersEqualTheDirectSum) {
  const ChirpSequence w = few_chirps();
  constexpr double kTolerance = 1e-9;
  constexpr int kCount = 900;
  std::vector<Echoes> channels(4, crowd(w, kCount, 400 * cell_delay(w), 40, 1));
  for (Echoes& echoes : channels) {
    for (int p = 0; p < kCount; ++p) echoes.group.push_back(static_cast<uint32_t>(p % 2));
  }
  for (double& delay : channels[1].delay) delay += 0.3 * cell_delay(w);
  for (Complex& amplitude : channels[1].amplitude) amplitude *= Complex(0.0, 1.0);
  for (double& delay : channels[2].delay) delay = 840 * cell_delay(w) - delay;
  std::reverse(channels[3].group.begin() + kCount / 2, channels[3].group.end());
  channels[3].group.front() = 1;
  Synthesizer all(w, 4, 2, kCount, {kTolerance, Method::kNufft});
  for (int channel = 0; channel < 4; ++channel) all.add(channel, channels[static_cast<size_t>(channel)]);
  for (uint32_t group = 0; group < 2; ++group) {
    const std::vector<Complex> found = all.cube(static_cast<int>(group));
    for (size_t channel = 0; channel < 4; ++channel) {
      const Echoes own = echoes_of_group(channels[channel], group);
      const auto direct = testing::synthesize(w, own, {.method = Method::kDirect});
      const auto first = found.begin() + static_cast<ptrdiff_t>(channel * direct.size());
      const std::vector<Complex> here(first, first + static_cast<ptrdiff_t>(direct.size()));
      EXPECT_LT(rms_error(here, direct, testing::sum_of_magnitudes(own.amplitude)), kTolerance) << channel;
    }
  }
}

}  // namespace
}  // namespace echopath::test_crowds_in_groups
