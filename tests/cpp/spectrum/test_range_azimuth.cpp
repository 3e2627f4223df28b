#include <gtest/gtest.h>

#include <algorithm>

#include "cpp/support/any_threads.h"
#include "echopath/spectrum/angle/range_azimuth.h"
#include "plane_waves.h"

namespace echopath::test_range_azimuth {
namespace {

using testing::Complex;
constexpr double kRounding = 1e-12;  // of unit waves
constexpr int kChirps = 16, kSamples = 40;
constexpr double kPower = 1e-10;  // of powers of up to 10, of sums of some hundred unit waves

// A cube of tones: range bin r and velocity bin v, from azimuth `left`, of half-wavelength receivers.
void add_tone(std::vector<Complex>& cube, const Radar& radar, double r, double v, double left, double amplitude) {
  size_t i = 0;
  for (size_t rx = 0; rx < radar.receivers.size(); ++rx) {
    for (int j = 0; j < kChirps; ++j) {
      for (int n = 0; n < kSamples; ++n, ++i) {
        const double cycles = r * n / kSamples + v * j / kChirps - 0.5 * static_cast<double>(rx) * std::sin(left);
        cube[i] += amplitude * std::polar(1.0, kTwoPi * cycles);
      }
    }
  }
}

const double kLeft = 0.3;
const AngleGrid kGrid{{-0.4, 0.0, kLeft}, {0.0}};

TEST(RangeAzimuth, APointGivesItsPowerWhateverWindowAndPadding) {
  const Radar radar = testing::line_radar(6, kChirps, kSamples);
  std::vector<Complex> cube(6 * kChirps * kSamples);
  add_tone(cube, radar, 7.0, 2.0, kLeft, 3.0);
  for (const auto kind : {WindowKind::kRect, WindowKind::kHann, WindowKind::kChebyshev}) {
    for (const int pad : {1, 3}) {
      const RangeDoppler map = range_doppler(cube, radar, Window{kind, 60.0}, pad);
      const RangeAzimuth all = range_azimuth(map, radar, kGrid);
      EXPECT_NEAR(all.power[2 * map.range.size() + 7 * pad], 9.0, kPower);
      const RangeAzimuth one = range_azimuth(map, radar, kGrid, {map.velocity[(kChirps / 2 + 2) * pad]});
      EXPECT_NEAR(one.power[2 * map.range.size() + 7 * pad], 9.0, kPower);
      const RangeAzimuth peak = range_azimuth(map, radar, kGrid, {{}, Combine::kPeak});
      EXPECT_NEAR(peak.power[2 * map.range.size() + 7 * pad], 9.0, kPower);
      EXPECT_FALSE(all.velocity.has_value());
      EXPECT_EQ(*one.velocity, map.velocity[(kChirps / 2 + 2) * pad]);
    }
  }
}

TEST(RangeAzimuth, PointsOfSeveralVelocitiesAddTheirPowersOrGiveTheLargest) {
  const Radar radar = testing::line_radar(6, kChirps, kSamples);
  std::vector<Complex> cube(6 * kChirps * kSamples);
  add_tone(cube, radar, 7.0, 2.0, kLeft, 3.0);
  add_tone(cube, radar, 7.0, -5.0, kLeft, 1.0);
  const RangeDoppler map = range_doppler(cube, radar, Window{WindowKind::kHann});
  EXPECT_NEAR(range_azimuth(map, radar, kGrid).power[2 * kSamples + 7], 10.0, kPower);
  BeamformOptions capon;
  capon.method = BeamMethod::kCapon;
  for (const BeamformOptions& options : {BeamformOptions{}, capon}) {
    const RangeAzimuth peak = range_azimuth(map, radar, kGrid, {{}, Combine::kPeak}, options);
    EXPECT_NEAR(peak.power[2 * kSamples + 7], 9.0, kPower);
  }
  EXPECT_NEAR(range_azimuth(map, radar, kGrid, {map.velocity[3]}).power[2 * kSamples + 7], 1.0, kPower);
}

TEST(RangeAzimuth, AGateTakesPointsOfItsVelocitiesAlone) {
  const Radar radar = testing::line_radar(6, kChirps, kSamples);
  std::vector<Complex> cube(6 * kChirps * kSamples);
  add_tone(cube, radar, 7.0, 2.0, kLeft, 3.0);
  add_tone(cube, radar, 7.0, -5.0, kLeft, 1.0);
  const RangeDoppler map = range_doppler(cube, radar, Window{WindowKind::kHann});
  const auto velocity = [&](int bin) { return map.velocity[kChirps / 2 + bin]; };
  BeamformOptions capon;
  capon.method = BeamMethod::kCapon;
  for (const Combine combine : {Combine::kSum, Combine::kPeak}) {
    for (const BeamformOptions& options : {BeamformOptions{}, capon}) {
      const auto power = [&](int low, int high) {
        const VelocityChoice choice{{}, combine, std::array{velocity(low), velocity(high)}};
        return range_azimuth(map, radar, kGrid, choice, options).power[2 * kSamples + 7];
      };
      EXPECT_NEAR(power(0, 4), 9.0, kPower);  // the main lobe of a Hann window is four cells
      EXPECT_NEAR(power(-7, -3), 1.0, kPower);
      EXPECT_NEAR(power(-1, 0), 0.0, kPower) << "between them";
    }
  }
  const VelocityChoice nothing{{}, Combine::kSum, std::array{velocity(1) + 1e-6, velocity(2) - 1e-6}};
  EXPECT_THROW(range_azimuth(map, radar, kGrid, nothing), std::invalid_argument);
  const VelocityChoice both{velocity(1), Combine::kSum, std::array{velocity(0), velocity(2)}};
  EXPECT_THROW(range_azimuth(map, radar, kGrid, both), std::invalid_argument);
}

TEST(RangeAzimuth, BothMethodsGiveTheMeanOverChirps) {
  // Without a window the sum over velocities is the mean power over chirps (Parseval), whatever the chirps hold.
  const Radar radar = testing::line_radar(4, kChirps, kSamples);
  std::vector<Complex> cube(4 * kChirps * kSamples);
  for (size_t i = 0; i < cube.size(); ++i) cube[i] = std::polar(1.0, 0.7 * static_cast<double>(i * i % 101));
  const RangeDoppler map = range_doppler(cube, radar, Window{WindowKind::kRect}, 2);
  const RangeAzimuth all = range_azimuth(map, radar, {{kLeft}, {0.0}});
  for (const int r : {0, 11, 50, 79}) {
    double mean = 0.0;
    for (int j = 0; j < kChirps; ++j) {
      Complex beam;
      for (int rx = 0; rx < 4; ++rx) {
        for (int n = 0; n < kSamples; ++n) {
          const double cycles = 0.5 * rx * std::sin(kLeft) - static_cast<double>(r * n) / (2 * kSamples);
          beam += cube[(rx * kChirps + j) * kSamples + n] * std::polar(1.0 / (4 * kSamples), kTwoPi * cycles);
        }
      }
      mean += std::norm(beam) / kChirps;
    }
    EXPECT_NEAR(all.power[r], mean, kRounding);
  }
}

TEST(RangeAzimuth, OfSeveralElevationsTheLargestIsTaken) {
  const double half = 0.5 * testing::wavelength();
  const Radar radar = testing::radar_with({Vec3::Zero()}, {{0, 0, 0}, {0, half, 0}, {0, 0, half}, {0, half, half}});
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(0.3, 0.4), 1.0, 4, 1);
  const double v = map.velocity[4];
  const RangeAzimuth level = range_azimuth(map, radar, {{0.3}, {0.0}}, {v});
  const RangeAzimuth all = range_azimuth(map, radar, {{0.3}, {0.0, 0.4}}, {v});
  EXPECT_NEAR(all.power[1], 1.0, kRounding);
  EXPECT_LT(level.power[1], 0.8);
}

TEST(RangeAzimuth, CaponResolvesWhatBartlettDoesNot) {
  const Radar radar = testing::line_radar(12, kChirps, kSamples);
  std::vector<Complex> cube(12 * kChirps * kSamples);
  const double apart = 2.5 * testing::kDegree;
  add_tone(cube, radar, 7.0, 2.0, apart, 1.0);
  add_tone(cube, radar, 7.0, -4.0, -apart, 1.0);
  const RangeDoppler map = range_doppler(cube, radar, Window{WindowKind::kHann});
  const AngleGrid grid{{-apart, 0.0, apart}, {0.0}};
  BeamformOptions options;
  const auto row = [&] {
    const std::vector<double> power = range_azimuth(map, radar, grid, {}, options).power;
    return std::vector<double>{power[7], power[kSamples + 7], power[2 * kSamples + 7]};
  };
  const auto bartlett = row();
  EXPECT_GT(bartlett[1], std::max(bartlett[0], bartlett[2]));
  options.method = BeamMethod::kCapon;
  options.diagonal_loading = 1e-3;
  const auto capon = row();
  EXPECT_LT(capon[1], 0.1 * std::min(capon[0], capon[2]));
  EXPECT_NEAR(capon[0], 1.0, 0.05);
}

TEST(RangeAzimuth, DoesNotDependOnTheNumberOfThreads) {
  const Radar radar = testing::line_radar(5, 8, 70);
  RangeDoppler map = testing::empty_map(radar);
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::polar(1.0, 0.1 * static_cast<double>(i * i % 61));
  for (const BeamMethod method : {BeamMethod::kBartlett, BeamMethod::kCapon}) {
    BeamformOptions options;
    options.method = method;
    test::same_on_any_threads([&] { return range_azimuth(map, radar, kGrid, {}, options).power; });
  }
}

TEST(RangeAzimuth, BadInputIsAnError) {
  const Radar radar = testing::line_radar(3);
  const RangeDoppler map = testing::empty_map(radar);
  EXPECT_THROW(range_azimuth(map, radar, {{}, {0.0}}), std::invalid_argument);
  const double step = map.velocity[1] - map.velocity[0];
  EXPECT_THROW(range_azimuth(map, radar, kGrid, {map.velocity.back() + 0.6 * step}), std::invalid_argument);
  EXPECT_THROW(range_azimuth(map, radar, kGrid, {std::nan("")}), std::invalid_argument);
  EXPECT_NO_THROW(range_azimuth(map, radar, kGrid, {map.velocity.front() - 0.5 * step}));
  Job job;
  job.cancel();
  EXPECT_THROW(range_azimuth(map, radar, kGrid, {}, {}, &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_range_azimuth
