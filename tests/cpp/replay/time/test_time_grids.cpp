#include <gtest/gtest.h>

#include "cpp/support/scenes.h"
#include "echopath/replay/time/time_grids.h"

namespace echopath::test_time_grids {
namespace {

using namespace testing;

constexpr double kRounding = 1e-12;  // s, of times of a frame of milliseconds

Radar two_transmitters() {
  Radar radar = plain_radar(Vec3::Zero(), Vec3(0, 0.01, 0));
  radar.waveform.num_chirps = 16;
  radar.transmitters.push_back(antenna_at(Vec3(0, 0.02, 0)));
  return radar;
}

Paths empty_record(const Radar& radar) {
  Paths paths;
  paths.scene = std::make_shared<const Scene>();
  paths.radar = radar;
  paths.frame.start_time = 0.5;
  paths.frame.trace_time = 0.5 + 0.5 * radar.frame_duration();
  return paths;
}

TEST(TimeGrids, ChirpsHaveOneNodeInTheMiddleOfTheWindowsOfTheirTransmitter) {
  const Radar radar = two_transmitters();
  const FrameNodes nodes = nodes_of(ChirpGrid{1}, radar, 0.5, ChirpDerivatives::kFirst);
  const ChirpSequence& waveform = radar.waveform;
  const double middle = 0.5 * (waveform.num_samples - 1) / waveform.sampling_rate;
  ASSERT_EQ(nodes.times.size(), 16u);
  for (int chirp = 0; chirp < 16; ++chirp) {
    EXPECT_NEAR(nodes.times[static_cast<size_t>(chirp)], 0.5 + (2 * chirp + 1) * waveform.chirp_interval + middle,
                kRounding);
  }
  EXPECT_EQ(transmitter_of(ChirpGrid{1}), 1);
}

TEST(TimeGrids, SamplesHaveTheirMiddleNodeWhereChirpsHaveTheirs) {
  const Radar radar = two_transmitters();
  const FrameNodes samples = nodes_of(SampleGrid{0, 5}, radar, 0.5, ChirpDerivatives::kThird);
  const FrameNodes chirps = nodes_of(ChirpGrid{0}, radar, 0.5, ChirpDerivatives::kThird);
  ASSERT_EQ(samples.times.size(), 5 * chirps.times.size());
  for (size_t chirp = 0; chirp < chirps.times.size(); ++chirp) {
    EXPECT_NEAR(samples.times[5 * chirp + 2], chirps.times[chirp], kRounding);
  }
}

TEST(TimeGrids, PolynomialsBeginAndEndWithThePiecesBetweenTheirCuts) {
  const Radar radar = two_transmitters();
  const double end = 0.5 + radar.frame_duration(), cut = 0.5 + 0.3 * radar.frame_duration();
  const PolynomialGrid grid{4, PolynomialGrid::Pieces::kSmooth, {cut}, 8, end - cut};
  const FrameNodes nodes = nodes_of(grid, radar, 0.5, ChirpDerivatives::kFirst);
  ASSERT_EQ(nodes.times.size(), 8u);
  EXPECT_NEAR(nodes.times[0], cut, kRounding);  // Chebyshev-Lobatto nodes of a piece descend
  EXPECT_NEAR(nodes.times[3], 0.5, kRounding);
  EXPECT_NEAR(nodes.times[4], end, kRounding);
  EXPECT_NEAR(nodes.times[7], cut, kRounding);
  EXPECT_EQ(transmitter_of(grid), -1);
}

TEST(TimeGrids, StillScenesHaveOneNodeForAllTransmitters) {
  const Radar radar = two_transmitters();
  const FrameNodes nodes = nodes_of(StillGrid{0.7}, radar, 0.5, ChirpDerivatives::kFirst);
  EXPECT_EQ(nodes.times, std::vector<double>{0.7});
  EXPECT_EQ(nodes.sampling.size(), 2u);
}

TEST(GridIndex, PathsTryStillGridsThenPolynomialsThenNone) {
  const GridIndex first = GridIndex::polynomial(0), last = GridIndex::polynomial(GridIndex::kMostPolynomials - 1);
  EXPECT_TRUE(GridIndex::still() < first && first < last && last < GridIndex::none());
  EXPECT_TRUE(first.is_polynomial() && last.is_polynomial());
  EXPECT_FALSE(GridIndex::still().is_polynomial() || GridIndex::none().is_polynomial());
  EXPECT_EQ(last.number(), GridIndex::kMostPolynomials - 1);
}

TEST(GridIndex, PolynomialsOfEachSetOfCutsHaveAPlaceOfTheirOwn) {
  const GridIndex some = GridIndex::polynomial(3, 5), last = GridIndex::polynomial(GridIndex::kMostPolynomials - 1, 5);
  EXPECT_TRUE(some.is_polynomial() && GridIndex::none() < some && some < last && last < GridIndex::polynomial(0, 6));
  EXPECT_EQ(some.number(), 3u);
  EXPECT_EQ(some.cuts(), 5u);
  EXPECT_EQ(GridIndex::none().cuts(), 0u);
  EXPECT_LT(last.place(), GridIndex::count(6));
}

// Four chirps have twelve nodes of samples: polynomials of a frame without cuts are those of order 4, 5 to 10 and 12.
TEST(TimeGrids, NoPolynomialCostsMoreThanEveryChirpAndExactReplayHasNone) {
  Radar radar = two_transmitters();
  radar.waveform.num_chirps = 4;
  const Paths paths = empty_record(radar);
  const TimeGrids grids(paths, radar, {});
  std::vector<int> orders;
  for (size_t k = 0; k < grids.num_polynomials(MotionCuts::kOfRadar); ++k)
    orders.push_back(grids.polynomial(GridIndex::polynomial(k)).order);
  EXPECT_EQ(orders, (std::vector<int>{4, 5, 6, 7, 8, 9, 10, 12}));
  const GridIndex first = GridIndex::polynomial(0);
  EXPECT_EQ(grids.polynomial(grids.next_polynomial(first, 7.5)).order, 8);
  EXPECT_TRUE(grids.next_polynomial(first, 1000.0) == GridIndex::none());
  ReplaySettings settings;
  settings.exact = true;
  EXPECT_EQ(TimeGrids(paths, radar, settings).num_polynomials(MotionCuts::kOfRadar), 0u);
}

}  // namespace
}  // namespace echopath::test_time_grids
