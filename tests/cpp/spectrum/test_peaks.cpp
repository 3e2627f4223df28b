// Peaks of tones whose place and power are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "cpp/support/any_threads.h"
#include "echopath/spectrum/cfar/peaks.h"
#include "plane_waves.h"

namespace echopath::test_peaks {
namespace {

using testing::Complex;

constexpr double kOffsetError = 1e-6;    // cells, of the table that turns ratios of neighbours into offsets
constexpr double kVelocityError = 1e-5;  // m/s: likewise, in cells of some m/s
constexpr double kPowerError = 1e-5;     // relative: a parabola of the main lobe at that error, and rounding

constexpr int kChirps = 32, kSamples = 64;

// One tone in every channel, each with a phase of its own, at places in cells of the map; noise: rms per sample.
std::vector<Complex> tone(const Radar& radar, int zero_pad, double velocity, double range, double power, double noise = 0.0,
                          unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise * std::sqrt(0.5));
  std::vector<Complex> cube;
  for (size_t c = 0; c < radar.receivers.size(); ++c) {
    for (int j = 0; j < kChirps; ++j) {
      for (int n = 0; n < kSamples; ++n) {
        const double cycles =
            (velocity / zero_pad * j / kChirps + range / zero_pad * n / kSamples) + 0.3 * static_cast<double>(c);
        cube.push_back(std::polar(std::sqrt(power), kTwoPi * cycles) + Complex(normal(random), normal(random)));
      }
    }
  }
  return cube;
}

Radar radar_of(int num_rx = 2) { return testing::line_radar(num_rx, kChirps, kSamples); }

Peaks peaks_of(const std::vector<Complex>& cube, const Radar& radar, const Window& window, int zero_pad) {
  const RangeDoppler map = range_doppler(cube, radar, window, zero_pad);
  CfarOptions options;  // few training cells: thresholds at once
  options.training_velocity = 1;
  options.training_range = 2;
  return find_peaks(map, radar, cfar(map, radar, options));
}

// The index of the strongest.
size_t strongest(const Peaks& peaks) {
  return std::max_element(peaks.power.begin(), peaks.power.end()) - peaks.power.begin();
}

TEST(Peaks, ATonesPlaceAndPowerAreExactForEveryWindowAndPadding) {
  const Radar radar = radar_of();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> offset(-0.499, 0.499);
  for (const WindowKind kind :
       {WindowKind::kRect, WindowKind::kHann, WindowKind::kHamming, WindowKind::kBlackman, WindowKind::kBlackmanHarris,
        WindowKind::kChebyshev, WindowKind::kTaylor, WindowKind::kKaiser}) {
    for (const int zero_pad : {1, 2}) {
      const double up = offset(random), away = offset(random);
      const double power = 1e-12;
      const auto cube = tone(radar, zero_pad, 5 + up, 20 + away, power);
      const Peaks peaks = peaks_of(cube, radar, {kind, 80.0}, zero_pad);
      ASSERT_FALSE(peaks.cells.empty()) << static_cast<int>(kind);
      const size_t i = strongest(peaks);
      EXPECT_EQ(peaks.cells[i], (std::array<int64_t, 2>{kChirps / 2 * zero_pad + 5, 20}));
      EXPECT_NEAR(peaks.velocity_offset[i], up, kOffsetError) << static_cast<int>(kind) << " " << zero_pad;
      EXPECT_NEAR(peaks.range_offset[i], away, kOffsetError) << static_cast<int>(kind) << " " << zero_pad;
      EXPECT_NEAR(peaks.power[i] / power, 1.0, kPowerError) << static_cast<int>(kind) << " " << zero_pad;
      EXPECT_NEAR(peaks.range[i], (20 + away) / zero_pad * radar.waveform.range_resolution(), kOffsetError);
      EXPECT_NEAR(peaks.velocity[i], (5 + up) / zero_pad * radar.waveform.velocity_resolution(1), kVelocityError);
    }
  }
}

TEST(Peaks, ATonePeaksOnceAcrossTheEndsOfBothCircles) {
  const Radar radar = radar_of(1);
  for (const double away : {-0.3, 0.3}) {
    const auto cube = tone(radar, 1, kChirps / 2 + away, away, 1e-12);
    const Peaks peaks = peaks_of(cube, radar, {WindowKind::kHann}, 1);
    ASSERT_EQ(peaks.cells.size(), 1u);
    EXPECT_NEAR(peaks.velocity_offset[0], away, kOffsetError);
    EXPECT_NEAR(peaks.range_offset[0], away, kOffsetError);
    const double v_max = radar.waveform.max_velocity(1), step = 2.0 * v_max / kChirps;
    EXPECT_NEAR(peaks.velocity[0], -v_max + away * step, kVelocityError);
  }
}

TEST(Peaks, RealSamplesHaveNoNeighboursBeyondTheirRanges) {
  Radar radar = radar_of(1);
  radar.waveform.real = true;
  auto cube = tone(radar, 1, 3.2, 0.0, 1e-12);
  for (Complex& value : cube) value = std::sqrt(2.0) * value.real();
  const Peaks peaks = peaks_of(cube, radar, {WindowKind::kHann}, 1);
  const auto at_the_end =
      std::find_if(peaks.cells.begin(), peaks.cells.end(), [](const auto& cell) { return cell[1] == 0; });
  ASSERT_NE(at_the_end, peaks.cells.end());
  EXPECT_EQ(peaks.range_offset[at_the_end - peaks.cells.begin()], 0.0);
  cube = tone(radar, 1, 3.2, 12.3, 1e-12);
  for (Complex& value : cube) value = std::sqrt(2.0) * value.real();
  const Peaks inside = peaks_of(cube, radar, {WindowKind::kHann}, 1);
  ASSERT_FALSE(inside.cells.empty());
  EXPECT_NEAR(inside.range_offset[strongest(inside)], 0.3, 1e-3);  // what of the image at -12.3 leaks
}

TEST(Peaks, NoiseScattersOffsetsAsLittleAsStated) {
  const Radar radar = radar_of(1);
  const double in_cell = 1.5 * 1.5 / (kChirps * kSamples);  // Hann on both axes, of a sample's noise
  double squares = 0.0;
  const int count = 200;
  for (int k = 0; k < count; ++k) {
    const double away = -0.5 + (k + 0.5) / count;
    const auto cube = tone(radar, 1, 5.0, 20.0 + away, 100.0 * in_cell, 1.0, 7 + k);
    const Peaks peaks = peaks_of(cube, radar, {WindowKind::kHann}, 1);
    ASSERT_FALSE(peaks.cells.empty());
    const size_t i = strongest(peaks);
    const double error = static_cast<double>(peaks.cells[i][1]) + peaks.range_offset[i] - 20.0 - away;
    squares += error * error;
  }
  constexpr double kStated = 0.06, kScatter = 3.0 / std::numbers::sqrt2;  // of an rms over `count` errors, 3 sigma
  EXPECT_LT(std::sqrt(squares / count), kStated * (1.0 + kScatter / std::sqrt(count)));
}

TEST(Peaks, OnlyTopsOfTheCellsFoundAreTaken) {
  const Radar radar = testing::line_radar(1, 16, 40);
  RangeDoppler map = testing::empty_map(radar);
  map.values[3 * 40 + 7] = 1.0;
  map.values[3 * 40 + 8] = 1.0;  // as high: the first counts
  map.values[4 * 40 + 9] = 0.9;
  map.values[9 * 40 + 0] = 0.5;
  map.values[9 * 40 + 39] = 0.6;  // complex samples: range is a circle
  const Peaks peaks = find_peaks(map, radar, cfar(map, radar));
  ASSERT_EQ(peaks.cells.size(), 2u);
  EXPECT_EQ(peaks.cells[0], (std::array<int64_t, 2>{3, 7}));
  EXPECT_EQ(peaks.cells[1], (std::array<int64_t, 2>{9, 39}));
}

TEST(Peaks, DoNotDependOnTheNumberOfThreads) {
  const Radar radar = radar_of();
  const auto cube = tone(radar, 1, 5.2, 20.3, 1.0, 3.0);
  test::same_on_any_threads([&] {
    const Peaks found = peaks_of(cube, radar, {WindowKind::kHann}, 1);
    return std::tuple(found.power, found.range, found.velocity);
  });
}

TEST(Peaks, NothingFoundGivesNoPeaksAndAnotherMapIsAnError) {
  const Radar radar = radar_of(1);
  const RangeDoppler map = testing::empty_map(radar);
  EXPECT_TRUE(find_peaks(map, radar, cfar(map, radar)).cells.empty());
  EXPECT_THROW(find_peaks(map, radar, {}), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_peaks
