// Capon's beams against closed forms.
#include <gtest/gtest.h>

#include <tuple>

#include "beams.h"

namespace echopath::test_capon {
namespace {

using testing::capon;
using testing::kDegree;
using testing::kHalf;
using testing::kRounding;
using testing::kSolved;
using testing::power_at;

// R = S a a^H + P I, made of one snapshot per element and one of the wave: the ranges of one velocity.
RangeDoppler wave_in_noise(const Radar& radar, const Vec3& u, double wave, double noise) {
  RangeDoppler map = testing::empty_map(radar);
  const size_t count = radar.receivers.size();
  const double snapshots = static_cast<double>(count + 1);
  testing::add_wave(map, radar, u, std::sqrt(wave * snapshots), 0, 0);
  for (size_t e = 0; e < count; ++e) {
    map.values[e * map.velocity.size() * map.range.size() + e + 1] = std::sqrt(noise * snapshots);
  }
  return map;
}

TEST(Capon, OneWaveInNoiseHasItsClosedForm) {
  const int count = 7;
  const double wave = 2.0, noise = 0.3, loading = 1e-9;
  const Radar radar = testing::line_radar(count, 1, count + 1);
  const RangeDoppler map = wave_in_noise(radar, direction(0.2, 0.0), wave, noise);
  const AngleGrid grid{{-0.6, 0.1, 0.2, 0.25, 0.9}, {0.0}};
  // The mean over the ranges is w^H R w with w of the covariance of all of them; 64 neighbours reach every one.
  const BeamPower beams = beamform(map, radar, grid, capon(loading, 0, 64));
  for (size_t a = 0; a < grid.azimuth.size(); ++a) {
    double mean = 0.0;
    for (int r = 0; r <= count; ++r) mean += power_at(beams, 0, a, r) / (count + 1);
    // 1 / (a^H R^-1 a) with R^-1 by Sherman and Morrison
    const double phase = kPi * (std::sin(grid.azimuth[a]) - std::sin(0.2));
    const double overlap = std::abs(phase) < 1e-12 ? 1.0 : std::sin(0.5 * count * phase) / (count * std::sin(0.5 * phase));
    const double share = count * wave / (noise + count * wave);
    const double expected = noise / (count * (1.0 - share * overlap * overlap));
    EXPECT_NEAR(mean, expected, 1e-6 * expected);  // the loading moves it by its own share
  }
  double at_wave = 0.0;
  for (int r = 0; r <= count; ++r) at_wave += power_at(beams, 0, 2, r) / (count + 1);
  EXPECT_NEAR(at_wave, wave + noise / count, 1e-6 * wave);
}

TEST(Capon, ResolvesTwoWavesThatBartlettDoesNot) {
  const Radar radar = testing::line_radar(12, 8, 40);
  RangeDoppler map = testing::empty_map(radar);
  for (size_t r = 0; r < 40; ++r) {  // two waves 5 degrees apart, beams are 8.5 wide; their phases differ by range
    testing::add_wave(map, radar, direction(-2.5 * kDegree, 0.0), std::polar(1.0, 0.0), 3, r);
    testing::add_wave(map, radar, direction(2.5 * kDegree, 0.0), std::polar(1.0, 2.0 * static_cast<double>(r)), 3, r);
  }
  const AngleGrid grid{{-2.5 * kDegree, 0.0, 2.5 * kDegree}, {0.0}};
  const auto mean = [&](const BeamformOptions& options) {
    std::vector<double> power(3);
    const BeamPower beams = beamform(map, radar, grid, options);
    for (size_t a = 0; a < 3; ++a) {
      for (size_t r = 10; r < 30; ++r) power[a] += power_at(beams, 0, a, 3 * 40 + r) / 20.0;
    }
    return power;
  };
  const auto bartlett = mean({}), adapted = mean(capon(1e-3, 0, 10));
  EXPECT_GT(bartlett[1], bartlett[0]);
  EXPECT_GT(bartlett[1], bartlett[2]);
  EXPECT_LT(adapted[1], 0.1 * adapted[0]);
  EXPECT_LT(adapted[1], 0.1 * adapted[2]);
  EXPECT_NEAR(adapted[0], 1.0, 0.1);
}

TEST(Capon, ForwardBackwardTellsWavesOfOneHistoryApart) {
  const Radar radar = testing::line_radar(12);
  RangeDoppler map = testing::empty_map(radar);
  const Vec3 one = direction(-4.0 * kDegree, 0.0), other = direction(9.0 * kDegree, 0.0);
  testing::add_wave(map, radar, one, 1.0, 0, 0);
  testing::add_wave(map, radar, other, {0.0, 1.0}, 0, 0);
  const AngleGrid grid{{-4.0 * kDegree, 2.5 * kDegree, 9.0 * kDegree}, {0.0}};
  BeamformOptions options = capon(1e-4);
  const BeamPower forward = beamform(map, radar, {{0, 0}}, grid, options);
  options.forward_backward = true;
  const BeamPower both = beamform(map, radar, {{0, 0}}, grid, options);
  // One snapshot alone is one wave front to Capon: neither direction passes whole.
  EXPECT_LT(power_at(forward, 0, 0, 0), 0.3);
  EXPECT_GT(power_at(both, 0, 0, 0), 3.0 * power_at(forward, 0, 0, 0));
  EXPECT_LT(power_at(both, 0, 1, 0), 0.01 * power_at(both, 0, 0, 0));
}

TEST(Capon, NeighboursGoRoundTheVelocityAxisWithTheirPhaseBetweenSlots) {
  // A wave at the highest velocity leaks into the lowest cell, still with the phase of the highest: beams elsewhere
  // learn from the strong cell to null the weak one.
  const Vec3 step(0, kHalf, 0);
  const Radar radar = testing::radar_with(testing::line(3, 2 * step), testing::line(2, step), 8, 3);
  for (const auto& [weak, strong, fold] : {std::tuple<size_t, size_t, double>{7, 0, 7.0 / 8.0}, {0, 7, -7.0 / 8.0}}) {
    RangeDoppler map = testing::empty_map(radar);
    testing::add_wave(map, radar, direction(0.3, 0.0), 0.01, weak, 1);
    testing::add_wave(map, radar, direction(0.3, 0.0), 3.0, strong, 1, true, fold);
    const int64_t cell = static_cast<int64_t>(weak);
    const BeamPower beams = beamform(map, radar, {{cell, 1}}, {{-0.1, 0.3}, {0.0}}, capon(1e-3, 1, 0));
    EXPECT_NEAR(beams.power[1], 1e-4, kRounding);
    EXPECT_LT(beams.power[0], 1e-4 * 1e-4);
  }
}

TEST(Capon, WeakestSignalsAreHandledLikeStrongOnes) {
  const Radar radar = testing::line_radar(4);
  for (const double amplitude : {1e-100, 1.0, 1e100}) {
    RangeDoppler map = testing::empty_map(radar);
    testing::add_wave(map, radar, direction(0.2, 0.0), amplitude, 1, 1);
    const BeamPower beams = beamform(map, radar, {{1, 1}}, {{0.2}, {0.0}}, capon(1e-2));
    EXPECT_NEAR(beams.power[0] / amplitude / amplitude, 1.0, kSolved);
  }
}

}  // namespace
}  // namespace echopath::test_capon
