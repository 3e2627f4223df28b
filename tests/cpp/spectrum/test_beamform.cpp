#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/angle/beamform.h"
#include "plane_waves.h"

namespace echopath::test_beamform {
namespace {

using testing::Complex;
using testing::kDegree;
constexpr double kRounding = 1e-12;  // of unit waves
constexpr double kSolved = 1e-9;     // relative: covariances are inverted
const double kHalf = 0.5 * testing::wavelength();

std::vector<double> steps(double first, double last, int count) {
  std::vector<double> axis;
  for (int i = 0; i < count; ++i) axis.push_back(first + (last - first) * i / (count - 1));
  return axis;
}

BeamformOptions capon(double loading, int velocities = 0, int ranges = 0) {
  BeamformOptions options;
  options.method = BeamMethod::kCapon;
  options.diagonal_loading = loading;
  options.velocity_neighbours = velocities;
  options.range_neighbours = ranges;
  return options;
}

double power_at(const BeamPower& beams, size_t elevation, size_t azimuth, size_t cell) {
  const size_t cells = beams.power.size() / (beams.azimuth.size() * beams.elevation.size());
  return beams.power[(elevation * beams.azimuth.size() + azimuth) * cells + cell];
}

// Where a curve falls through half of its value at `top`, between samples.
double half_width(const std::vector<double>& angle, const std::vector<double>& power, size_t top, int step) {
  size_t i = top;
  while (power[i] > 0.5 * power[top]) i += step;
  const double share = (power[i - step] - 0.5 * power[top]) / (power[i - step] - power[i]);
  return std::abs(angle[i - step] + share * (angle[i] - angle[i - step]) - angle[top]);
}

TEST(Bartlett, TwelveElementsPeakWhereTheWaveComesFrom) {
  const Radar radar = testing::line_radar(12);
  for (const double degrees : {0.0, 20.0, 45.0}) {
    RangeDoppler map = testing::empty_map(radar);
    testing::add_wave(map, radar, direction(degrees * kDegree, 0.0), 1.0, 2, 1);
    const AngleGrid grid{steps(-80.0 * kDegree, 80.0 * kDegree, 16001), {0.0}};
    const std::vector<double> power = beamform(map, radar, {{2, 1}}, grid).power;
    const size_t top = std::max_element(power.begin(), power.end()) - power.begin();
    EXPECT_NEAR(grid.azimuth[top], degrees * kDegree, 0.02 * kDegree);
    EXPECT_NEAR(power[top], 1.0, kRounding);
  }
}

TEST(Bartlett, TwelveElementsHaveTheirHalfPowerWidth) {
  const Radar radar = testing::line_radar(12);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, Vec3::UnitX(), 1.0, 0, 0);
  const AngleGrid grid{steps(-20.0 * kDegree, 20.0 * kDegree, 4001), {0.0}};
  const std::vector<double> power = beamform(map, radar, {{0, 0}}, grid).power;
  const double width = half_width(grid.azimuth, power, 2000, 1) + half_width(grid.azimuth, power, 2000, -1);
  EXPECT_NEAR(width, 8.46 * kDegree, 0.05 * kDegree);
}

TEST(Bartlett, AnyArrayEqualsTheSlowSum) {
  Radar radar = testing::circle_radar();
  radar.transmitters.push_back(radar.receivers[4]);
  RangeDoppler map = testing::empty_map(radar);
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::polar(1.0, 1.7 * static_cast<double>(i * i % 97));
  const AngleGrid grid{{-0.7, 0.1, 0.4}, {-0.3, 0.2}};
  BeamformOptions options;
  options.compensate = false;
  const BeamPower beams = beamform(map, radar, grid, options);
  const size_t cells = map.velocity.size() * map.range.size();
  const double k = kTwoPi / testing::wavelength();
  for (size_t e = 0; e < 2; ++e) {
    for (size_t a = 0; a < 3; ++a) {
      const Vec3 u(std::cos(grid.elevation[e]) * std::cos(grid.azimuth[a]),
                   std::cos(grid.elevation[e]) * std::sin(grid.azimuth[a]), std::sin(grid.elevation[e]));
      for (size_t cell = 0; cell < cells; ++cell) {
        Complex sum;
        for (int channel = 0; channel < 18; ++channel) {
          const Vec3 x = radar.transmitters[channel / 9].position + radar.receivers[channel % 9].position;
          sum += map.values[channel * cells + cell] * std::polar(1.0 / 18.0, k * x.dot(u));
        }
        EXPECT_NEAR(power_at(beams, e, a, cell), std::norm(sum), kRounding);
      }
    }
  }
}

TEST(Bartlett, ChosenCellsEqualTheWholeMap) {
  const Radar radar = testing::line_radar(6, 8, 40);
  RangeDoppler map = testing::empty_map(radar);
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::polar(1.0, 0.3 * static_cast<double>(i * i % 89));
  const AngleGrid grid{{-0.5, 0.0, 0.6}, {0.0}};
  for (const BeamformOptions& options : {BeamformOptions{}, capon(1e-2, 1, 2)}) {
    const BeamPower whole = beamform(map, radar, grid, options);
    const BeamPower chosen = beamform(map, radar, {{7, 39}, {0, 0}, {3, 33}}, grid, options);
    EXPECT_EQ(chosen.range, (std::vector<double>{map.range[39], map.range[0], map.range[33]}));
    for (size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(power_at(chosen, 0, a, 0), power_at(whole, 0, a, 7 * 40 + 39));
      EXPECT_EQ(power_at(chosen, 0, a, 1), power_at(whole, 0, a, 0));
      EXPECT_EQ(power_at(chosen, 0, a, 2), power_at(whole, 0, a, 3 * 40 + 33));
    }
  }
}

TEST(Bartlett, LeftAndUpArePositive) {
  std::vector<Vec3> receivers;
  for (int i = 0; i < 9; ++i) receivers.emplace_back(0.0, i % 3 * kHalf, i / 3 * kHalf);
  const Radar radar = testing::radar_with({Vec3::Zero()}, receivers);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(0.3, -0.2), 1.0, 0, 0);
  const BeamPower beams = beamform(map, radar, {{0, 0}}, {{-0.3, 0.3}, {-0.2, 0.2}});
  EXPECT_NEAR(power_at(beams, 0, 1, 0), 1.0, kRounding);
  for (const auto& [e, a] : {std::pair{0, 0}, {1, 0}, {1, 1}}) EXPECT_LT(power_at(beams, e, a, 0), 0.7);
}

TEST(Bartlett, AnUncompensatedSlotIsTakenForADirection) {
  // A step of the phase k d (sin az) per receiver and 4 of them per transmitter: the slot phase alone moves the peak.
  const Vec3 step(0, kHalf, 0);
  const Radar radar = testing::radar_with(testing::line(3, 4 * step), testing::line(4, step));
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, Vec3::UnitX(), 1.0, 7, 0);  // 3 cells of velocity from rest
  const AngleGrid grid{steps(-0.5, 0.5, 1001), {0.0}};
  BeamformOptions options;
  const auto peak = [&] {
    const std::vector<double> power = beamform(map, radar, {{7, 0}}, grid, options).power;
    return grid.azimuth[std::max_element(power.begin(), power.end()) - power.begin()];
  };
  EXPECT_NEAR(peak(), 0.0, kSolved);
  options.compensate = false;
  EXPECT_LT(peak(), -2.0 * kDegree);
}

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
  for (const auto& [weak, strong, fold] : {std::tuple<size_t, size_t, int>{7, 0, 1}, {0, 7, -1}}) {
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

TEST(Beamform, DoesNotDependOnTheNumberOfThreads) {
  const Radar radar = testing::line_radar(5, 8, 70);
  RangeDoppler map = testing::empty_map(radar);
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::polar(1.0, 0.1 * static_cast<double>(i * i % 61));
  for (const BeamformOptions& options : {BeamformOptions{}, capon(1e-2, 1, 2)}) {
    const AngleGrid grid{steps(-1.0, 1.0, 21), {0.0}};
    set_num_threads(1);
    const auto one = beamform(map, radar, grid, options).power;
    set_num_threads(4);
    const auto four = beamform(map, radar, grid, options).power;
    set_num_threads(0);
    EXPECT_EQ(one, four);
  }
}

TEST(Beamform, ZerosGiveZerosAndNoCellsGiveNone) {
  const Radar radar = testing::line_radar(3);
  const RangeDoppler map = testing::empty_map(radar);
  const AngleGrid grid{{-0.1, 0.1}, {0.0}};
  for (const BeamformOptions& options : {BeamformOptions{}, capon(1e-2, 1, 1)}) {
    for (const double power : beamform(map, radar, grid, options).power) EXPECT_EQ(power, 0.0);
    EXPECT_TRUE(beamform(map, radar, std::vector<Cell>{}, grid, options).power.empty());
  }
}

TEST(Beamform, OneChannelHasItsPowerInEveryDirection) {
  const Radar radar = testing::line_radar(1);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(0.3, 0.0), 2.0, 1, 1);
  for (const BeamformOptions& options : {BeamformOptions{}, capon(1e-2)}) {
    for (const double power : beamform(map, radar, {{1, 1}}, {{-0.5, 0.3, 0.9}, {0.0}}, options).power) {
      EXPECT_NEAR(power, 4.0, kRounding);
    }
  }
}

TEST(Beamform, BadInputIsAnError) {
  const Radar radar = testing::line_radar(3), circle = testing::circle_radar();
  const RangeDoppler map = testing::empty_map(radar), round = testing::empty_map(circle);
  const AngleGrid grid{{0.0}, {0.0}};
  for (const AngleGrid& bad : {AngleGrid{{}, {0.0}}, AngleGrid{{0.1, 0.1}, {0.0}}, AngleGrid{{4.0}, {0.0}},
                               AngleGrid{{0.0}, {2.0}}, AngleGrid{{0.0}, {std::nan("")}}}) {
    EXPECT_THROW(beamform(map, radar, bad), std::invalid_argument);
  }
  for (const BeamformOptions& bad : {capon(0.0), capon(1e4), capon(1e-2, -1), capon(1e-2, 0, 65)}) {
    EXPECT_THROW(beamform(map, radar, grid, bad), std::invalid_argument);
  }
  BeamformOptions tapered = capon(1e-2);
  tapered.window.kind = WindowKind::kHann;
  EXPECT_THROW(beamform(map, radar, grid, tapered), std::invalid_argument);
  tapered.method = BeamMethod::kBartlett;
  EXPECT_NO_THROW(beamform(map, radar, grid, tapered));
  EXPECT_THROW(beamform(round, circle, grid, tapered), std::invalid_argument);
  BeamformOptions mirrored = capon(1e-2);
  mirrored.forward_backward = true;
  EXPECT_THROW(beamform(round, circle, grid, mirrored), std::invalid_argument);
  for (const Cell& cell : {Cell{8, 0}, Cell{0, 4}, Cell{-1, 0}}) {
    EXPECT_THROW(beamform(map, radar, {cell}, grid), std::out_of_range);
  }
  EXPECT_THROW(beamform(map, circle, grid), std::invalid_argument);
  Job job;
  job.cancel();
  EXPECT_THROW(beamform(map, radar, grid, {}, &job), Cancelled);
  EXPECT_THROW(beamform(map, radar, grid, capon(1e-2), &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_beamform
