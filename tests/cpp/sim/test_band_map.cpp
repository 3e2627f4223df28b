#include <gtest/gtest.h>

#include <algorithm>

#include "cpp/support/scenes.h"
#include "echopath/sim/stream/part_pass.h"
#include "echopath/trace/trace.h"

namespace echopath::test_band_map {
namespace {

using namespace testing;

constexpr double kRounding = 1e-12;  // of the largest cell: both ways are sums of a few hundred terms
constexpr double kLeast = 1e-9;      // of the largest cell

struct Case {
  int num_samples, num_chirps, zero_pad;
  WindowKind window;
  bool real;
  bool leaves_out;         // whether the plates are far from the end of the map, and the samples complex
  double bandwidth = 5e8;  // Hz, negative where chirps fall
};

Radar radar_of(const Case& one) {
  Radar radar = plain_radar(Vec3::Zero(), {0, 0.02, 0});
  radar.waveform = {.start_frequency = 77e9,
                    .bandwidth = one.bandwidth,
                    .num_samples = one.num_samples,
                    .sampling_rate = 5e6,
                    .num_chirps = one.num_chirps,
                    .chirp_interval = 120e-6,
                    .real = one.real};
  radar.receivers.push_back(antenna_at({0, 0.04, 0}));
  return radar;
}

// Paths over two plates that move, the far one at some distance in m, and none at rest.
Paths paths_of(const Radar& radar, double far = 7.0) {
  Scene still, moving;
  add_rectangle(still, "near", {4, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}, lambert(0.5));
  add_rectangle(still, "far", {far, 0.23 * far, -0.5}, {0, 1, 0}, {0, 0, 1}, lambert(0.5));
  for (Node plate : still.nodes()) {
    plate.motion = std::make_shared<LinearMotion>(Vec3(-20.0, 0.0, 0.0));
    moving.add(plate);
  }
  return trace(moving, radar, with_rays(300));
}

class BandMaps : public ::testing::TestWithParam<Case> {};

// The samples and their Fourier transform are the truth.
TEST_P(BandMaps, ShownCellsAreThoseOfTheSamplesAndOthersAreWeak) {
  const Case& one = GetParam();
  const Radar radar = radar_of(one);
  const Paths paths = paths_of(radar);
  ASSERT_GT(paths.num_paths(), 50);
  PartPass pass(paths, radar, std::vector<uint32_t>(paths.num_paths()), 1, {});
  const Window window{one.window};
  const SetPower whole = pass.powers({{0}}, window, one.zero_pad, 0.0, nullptr).front();
  const double largest = *std::max_element(whole.cells.begin(), whole.cells.end());
  const SetPower band = pass.powers({{0}}, window, one.zero_pad, kLeast * largest, nullptr).front();
  ASSERT_EQ(band.cells.size(), whole.cells.size());
  for (size_t i = 0; i < whole.cells.size(); ++i) {
    if (band.cells[i] == 0.0) ASSERT_LE(whole.cells[i], kLeast * largest) << i;
    else ASSERT_NEAR(band.cells[i], whole.cells[i], kRounding * largest) << i;
  }
  EXPECT_NEAR(band.mean_square, whole.mean_square, kRounding * whole.mean_square);
  EXPECT_EQ(std::count(band.cells.begin(), band.cells.end(), 0.0) > 0, one.leaves_out);
}

// A few ranges that are asked for are those of the samples; others have no power.
TEST_P(BandMaps, AskedRangesAreThoseOfTheSamples) {
  const Case& one = GetParam();
  const Radar radar = radar_of(one);
  const Paths paths = paths_of(radar);
  PartPass pass(paths, radar, std::vector<uint32_t>(paths.num_paths()), 2, {});
  const Window window{one.window};
  const SetPower whole = pass.powers({{0}}, window, one.zero_pad, 0.0, nullptr).front();
  const double largest = *std::max_element(whole.cells.begin(), whole.cells.end());
  const size_t num_ranges = whole.cells.size() / static_cast<size_t>(one.num_chirps * one.zero_pad);
  for (const size_t num_asked : {size_t{3}, size_t{20}}) {
    std::vector<uint8_t> asked(num_ranges);
    std::fill_n(asked.begin() + 1, num_asked, 1);
    const std::vector<SetPower> found = pass.powers({{0}, {1}}, window, one.zero_pad, 0.0, nullptr, {asked, asked});
    for (size_t i = 0; i < whole.cells.size(); ++i) {
      if (asked[i % num_ranges]) ASSERT_NEAR(found[0].cells[i], whole.cells[i], kRounding * largest) << i;
      else ASSERT_EQ(found[0].cells[i], 0.0) << i;
    }
    EXPECT_NEAR(found[0].mean_square, whole.mean_square, kRounding * whole.mean_square);
    EXPECT_EQ(found[1].mean_square, 0.0);  // no path is in that group
  }
}

// Two cells of the grid are 0.3 m: bands of 8 to some 120 cells, whose mean squares are found in different ways.
TEST(BandMapSquares, MeanSquaresOfNarrowAndWideBandsAreThoseOfTheSamples) {
  const Radar radar = radar_of({256, 33, 1, WindowKind::kHann, false, true});
  for (const double far : {4.5, 7.0, 11.0, 12.0, 13.0, 16.0, 20.0}) {
    const Paths paths = paths_of(radar, far);
    PartPass pass(paths, radar, std::vector<uint32_t>(paths.num_paths()), 1, {});
    const SetPower samples = pass.powers({{0}}, Window{WindowKind::kHann}, 1, 0.0, nullptr).front();
    const double least = kLeast * *std::max_element(samples.cells.begin(), samples.cells.end());
    const SetPower band = pass.powers({{0}}, Window{WindowKind::kHann}, 1, least, nullptr).front();
    ASSERT_GT(std::count(band.cells.begin(), band.cells.end(), 0.0), 0) << far;  // it is a band
    EXPECT_NEAR(band.mean_square, samples.mean_square, kRounding * samples.mean_square) << far;
  }
}

INSTANTIATE_TEST_SUITE_P(Waveforms, BandMaps,
                         ::testing::Values(Case{256, 128, 1, WindowKind::kHann, false, true},
                                           Case{256, 40, 2, WindowKind::kHann, false, true},
                                           Case{256, 40, 1, WindowKind::kHann, false, true, -5e8},
                                           Case{500, 33, 1, WindowKind::kBlackmanHarris, false, true},
                                           Case{64, 5, 3, WindowKind::kRect, false, false},
                                           Case{256, 16, 1, WindowKind::kHann, true, false}));

}  // namespace
}  // namespace echopath::test_band_map
