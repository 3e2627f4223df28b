#include <gtest/gtest.h>

#include <algorithm>

#include "beams.h"
#include "cpp/support/any_threads.h"

namespace echopath::test_beamform {
namespace {

using testing::capon;
using testing::Complex;
using testing::kDegree;
using testing::kHalf;
using testing::kRounding;
using testing::kSolved;
using testing::power_at;

std::vector<double> steps(double first, double last, int count) {
  std::vector<double> axis;
  for (int i = 0; i < count; ++i) axis.push_back(first + (last - first) * i / (count - 1));
  return axis;
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

TEST(Beamform, DoesNotDependOnTheNumberOfThreads) {
  const Radar radar = testing::line_radar(5, 8, 70);
  RangeDoppler map = testing::empty_map(radar);
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::polar(1.0, 0.1 * static_cast<double>(i * i % 61));
  for (const BeamformOptions& options : {BeamformOptions{}, capon(1e-2, 1, 2)}) {
    const AngleGrid grid{steps(-1.0, 1.0, 21), {0.0}};
    test::same_on_any_threads([&] { return beamform(map, radar, grid, options).power; });
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
  for (const AngleGrid& bad : {AngleGrid{{}, {0.0}}, AngleGrid{{0.1, 0.1}, {0.0}}, AngleGrid{{7.0}, {0.0}},
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
