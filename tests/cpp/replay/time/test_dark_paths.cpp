// The filter of a launch cell is a Gaussian of a phase gradient that grows evenly with time: an echo is dark only where that
// Gaussian stays low all through the frame, between the nodes too.
#include <gtest/gtest.h>

#include <cmath>

#include "cpp/support/scenes.h"
#include "echopath/replay/time/chebyshev_tails.h"

namespace echopath::test_dark_paths {
namespace {

using namespace testing;

constexpr double kLimit = 1e-7;
constexpr int kOrder = 6;

Radar radar_of_a_frame() {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.waveform.num_chirps = 64;
  return radar;
}

// Returns the filter whose gradient goes evenly from `first` to `last` rad, at a share of the frame.
double filter_at(double share, double first, double last) {
  const double gradient = first + share * (last - first);
  return std::exp(-0.5 * gradient * gradient);
}

double highest(double first, double last) {
  double most = 0.0;
  for (int i = 0; i <= 1000; ++i) most = std::max(most, filter_at(i / 1000.0, first, last));
  return most;
}

// Two echoes of the same filter: what one shows must not be read from the other.
bool is_found_dark(double first, double last) {
  const Radar radar = radar_of_a_frame();
  const FrameNodes nodes = chebyshev_nodes(radar, 0.0, {}, kOrder);
  Echoes echoes;
  echoes.num_echoes = 2;
  for (const double time : nodes.times) {
    echoes.amplitude.emplace_back(1.0);
    echoes.amplitude.push_back(std::polar(filter_at(time / radar.frame_duration(), first, last), 1.0));
  }
  EXPECT_FALSE(is_dark(nodes, echoes, 0, kLimit));
  return is_dark(nodes, echoes, 1, kLimit);
}

TEST(DarkPaths, FilterThatStaysLowIsDark) {
  ASSERT_LT(highest(8.0, 9.0), kLimit);
  EXPECT_TRUE(is_found_dark(8.0, 9.0));
  EXPECT_TRUE(is_found_dark(-12.0, -15.0));
}

// The logarithm in between is good to 2e-6.
TEST(DarkPaths, EvenAmplitudesAreDarkExactlyBelowTheLimit) {
  constexpr double kMargin = 1e-5;
  const FrameNodes nodes = chebyshev_nodes(radar_of_a_frame(), 0.0, {}, kOrder);
  for (double limit = 1e-60; limit < 1e3; limit *= 2.7) {
    for (const double side : {-1.0, 1.0}) {
      Echoes echoes;
      echoes.num_echoes = 1;
      echoes.amplitude.assign(nodes.times.size(), std::polar(limit * (1.0 + side * kMargin), 0.7));
      EXPECT_EQ(is_dark(nodes, echoes, 0, limit), side < 0) << limit;
    }
  }
}

TEST(DarkPaths, FilterThatRisesAboveTheLimitIsNot) {
  ASSERT_GT(highest(8.0, 5.0), kLimit);
  EXPECT_FALSE(is_found_dark(8.0, 5.0));
}

// The gradient passes through zero between the third and the fourth node, where the echo has all of its amplitude.
TEST(DarkPaths, FlashBetweenTwoNodesIsNotDark) {
  const FrameNodes nodes = chebyshev_nodes(radar_of_a_frame(), 0.0, {}, kOrder);
  const double frame = radar_of_a_frame().frame_duration();
  for (const double steep : {40.0, 60.0}) {
    for (const double time : nodes.times) ASSERT_LT(filter_at(time / frame, -steep, steep), kLimit);
    EXPECT_FALSE(is_found_dark(-steep, steep));
  }
}

}  // namespace
}  // namespace echopath::test_dark_paths
