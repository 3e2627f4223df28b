#include <gtest/gtest.h>
#include <sys/resource.h>

#include "cpp/support/any_threads.h"
#include "cpp/support/sanitized.h"
#include "echopath/spectrum/angle/estimate_angles.h"
#include "echopath/spectrum/array/tdm.h"
#include "plane_waves.h"

namespace echopath::test_estimate_angles {
namespace {

using testing::Complex;
using testing::kDegree;
const double kHalf = 0.5 * testing::wavelength();
// The search ends with steps of the grid times 0.225^7, of at most a few degrees.
constexpr double kFine = 1e-5;
constexpr double kPower = 1e-6;           // relative: second order in kFine, and the table of offsets
constexpr double kBesideEachOther = 0.2;  // of powers of 1 and 4, near nulls of each other
constexpr double kRounding = 1e-9;        // m/s

AngleGrid search_grid(const Radar& radar) {
  const VirtualArray array = virtual_array(radar);
  return {default_azimuths(array, kSearchStep), default_elevations(array, kSearchStep)};
}

Radar plane_radar(int columns, int rows) {
  std::vector<Vec3> receivers;
  for (int i = 0; i < columns * rows; ++i) receivers.emplace_back(0.0, i % columns * kHalf, i / columns * kHalf);
  return testing::radar_with({{0.1, 0.0, 1.0}}, receivers);
}

TEST(EstimateAngles, AWaveIsFoundBetweenTheStepsOfTheGrid) {
  const Radar radar = plane_radar(8, 6);
  for (const auto& [left, up] :
       {std::pair{0.123, -0.217}, {-0.81, 0.33}, {0.0, 0.0}, {0.5001, 0.6}, {0.96, -0.61}, {-1.31, -0.7}}) {
    for (const BeamMethod method : {BeamMethod::kBartlett, BeamMethod::kCapon}) {
      RangeDoppler map = testing::empty_map(radar);
      testing::add_wave(map, radar, direction(left, up), {2.0, 1.0}, 3, 2);
      EstimateOptions options;
      options.beams.method = method;
      const AngleEstimates found = estimate_angles(map, radar, {{3, 2}}, search_grid(radar), options);
      ASSERT_EQ(found.cell.size(), 1u);
      EXPECT_NEAR(found.azimuth[0], left, kFine);
      EXPECT_NEAR(found.elevation[0], up, kFine);
      EXPECT_NEAR(found.power[0], 5.0, kPower);
      EXPECT_EQ(found.velocity[0], map.velocity[3]);
      // From the middle between the transmitter and the mean receiver.
      const Vec3 middle(0.05, 0.25 * 7 * kHalf, 0.5 * (1.0 + 2.5 * kHalf));
      EXPECT_NEAR((found.points[0] - middle - map.range[2] * direction(left, up)).norm(), 0.0, kFine * map.range[2]);
    }
  }
}

// One of three transmitters stands higher, as on boards of known sensors: beams lie aslant to azimuth and elevation.
Radar aslant_radar() {
  return testing::radar_with({{0, 0, 0}, {0, 4.0 * kHalf, kHalf}, {0, 8.0 * kHalf, 0}}, testing::line(4, Vec3(0, kHalf, 0)));
}

AngleEstimates peaks_of_wave(const Radar& radar, double left, double up, const EstimateOptions& options = {}) {
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(left, up), 1.0, 3, 2);
  return estimate_angles(map, radar, {{3, 2}}, search_grid(radar), options);
}

TEST(EstimateAngles, AWaveIsFoundByBeamsThatLieAslant) {
  const Radar radar = aslant_radar();
  for (int i = 0; i < 40; ++i) {
    const double left = 0.8 * std::sin(2.0 * i), up = 0.5 * std::sin(3.7 * i);
    const AngleEstimates found = peaks_of_wave(radar, left, up);
    ASSERT_EQ(found.cell.size(), 1u);
    EXPECT_NEAR(found.azimuth[0], left, kFine);
    EXPECT_NEAR(found.elevation[0], up, kFine);
    EXPECT_NEAR(found.power[0], 1.0, kPower);
  }
}

// Tops of the grid along one beam are one peak, side lobes and ambiguous directions are others.
TEST(EstimateAngles, ABeamThatLiesAslantHasOnePeak) {
  constexpr double kWithinABeam = 0.05;  // rad; beams are 0.15 wide and several times as long
  EstimateOptions options;
  options.max_peaks = 8;
  const Radar radar = aslant_radar();
  for (int i = 0; i < 40; ++i) {
    const AngleEstimates found = peaks_of_wave(radar, 0.9 * std::sin(2.0 * i), 0.5 * std::sin(3.7 * i), options);
    ASSERT_GT(found.cell.size(), 1u);
    for (size_t a = 1; a < found.cell.size(); ++a) {
      for (size_t b = 0; b < a; ++b) {
        const double apart = std::hypot(found.azimuth[a] - found.azimuth[b], found.elevation[a] - found.elevation[b]);
        EXPECT_GT(apart, kWithinABeam) << i;
      }
    }
  }
}

// Elements two wavelengths apart see the same wave from sines that lie half of one apart: 0 and +-1/2 within 45 degrees, of
// which the outer two have the inner one half way between them.
TEST(EstimateAngles, AmbiguousDirectionsAreNotOne) {
  const Radar radar = testing::radar_with({Vec3::Zero()}, testing::line(4, Vec3(0, 4.0 * kHalf, 0)));
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(0.0, 0.0), 1.0, 3, 2);
  EstimateOptions options;
  options.max_peaks = 3;
  AngleGrid grid{{}, {0.0}};
  for (int i = -40; i <= 40; ++i) grid.azimuth.push_back(i * kDegree);
  const AngleEstimates found = estimate_angles(map, radar, {{3, 2}}, grid, options);
  ASSERT_EQ(found.cell.size(), 3u);
  std::vector<double> sines;
  for (const double azimuth : found.azimuth) sines.push_back(std::sin(azimuth));
  std::ranges::sort(sines);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sines[k], 0.5 * (k - 1), kFine);
  for (const double power : found.power) EXPECT_NEAR(power, 1.0, kPower);
}

// The first side lobes of a line of 16 are alike, and have the main lobe between them.
TEST(EstimateAngles, SideLobesOnBothSidesAreFound) {
  // The closed form of beam power, sin^2(16 pi x) / (16 sin(pi x))^2 with x half of the sine, between its first two zeros.
  double highest = 0.0, place = 0.0;
  for (double x = 1.0 / 16.0 + 1e-6; x < 2.0 / 16.0; x += 1e-6) {
    const double power = std::pow(std::sin(16.0 * kPi * x) / (16.0 * std::sin(kPi * x)), 2);
    if (power > highest) highest = power, place = 2.0 * x;
  }
  const Radar radar = testing::line_radar(16);
  EstimateOptions options;
  options.max_peaks = 3;
  options.peak_range_db = 20.0;
  const AngleEstimates found = peaks_of_wave(radar, 0.0, 0.0, options);
  ASSERT_EQ(found.cell.size(), 3u);
  EXPECT_NEAR(found.azimuth[0], 0.0, kFine);
  for (const size_t lobe : {size_t{1}, size_t{2}}) {
    EXPECT_NEAR(std::abs(std::sin(found.azimuth[lobe])), place, kFine);
    EXPECT_NEAR(found.power[lobe], highest, kPower);
  }
  EXPECT_LT(found.azimuth[1] * found.azimuth[2], 0.0);
}

TEST(EstimateAngles, SeveralPeaksOfACellComeStrongestFirst) {
  const Radar radar = testing::line_radar(16);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(std::asin(-0.25), 0.0), 1.0, 0, 1);  // at nulls of each other
  testing::add_wave(map, radar, direction(std::asin(0.5), 0.0), 2.0, 0, 1);
  EstimateOptions options;
  options.max_peaks = 3;
  options.peak_range_db = 9.0;
  const AngleEstimates found = estimate_angles(map, radar, {{0, 0}, {0, 1}}, search_grid(radar), options);
  ASSERT_EQ(found.cell, (std::vector<int64_t>{1, 1}));  // nothing in the first cell; side lobes are 13 dB down
  EXPECT_NEAR(found.azimuth[0], std::asin(0.5), 0.5 * kDegree);
  EXPECT_NEAR(found.azimuth[1], std::asin(-0.25), 0.5 * kDegree);
  EXPECT_NEAR(found.power[0], 4.0, kBesideEachOther);
  EXPECT_NEAR(found.power[1], 1.0, kBesideEachOther);
}

// Sparse arrays have other directions in which nearly all elements agree. One of them may lie nearer to a direction of the
// grid than the wave does, whose power no other direction reaches.
TEST(EstimateAngles, AWaveIsToldFromDirectionsThatAreNearlyAmbiguous) {
  // Four receivers without a grid; a line of six whose second half stands higher.
  const std::vector<Vec3> scattered = {
      {0, 0, 0}, {0, 3.1 * kHalf, 5.3 * kHalf}, {0, 8.7 * kHalf, 1.9 * kHalf}, {0, 13.2 * kHalf, 9.4 * kHalf}};
  const std::vector<Vec3> two_steps = {{0, 0, 0}, {0, 2.0 * kHalf, 0}, {0, 4.0 * kHalf, 2.0 * kHalf}};
  for (const Radar& radar : {testing::radar_with({Vec3::Zero()}, scattered),
                             testing::radar_with(two_steps, testing::line(2, Vec3(0, kHalf, 0)))}) {
    for (int i = 0; i < 100; ++i) {
      const AngleEstimates found = peaks_of_wave(radar, 0.8 * std::sin(2.0 * i), 0.5 * std::sin(3.7 * i));
      ASSERT_EQ(found.cell.size(), 1u);
      EXPECT_NEAR(found.power[0], 1.0, kPower) << i;
    }
  }
}

TEST(EstimateAngles, FoldsAreTheVelocitiesWhoseSlotsAgree) {
  const Vec3 step(0, kHalf, 0);
  const Radar radar = testing::radar_with(testing::line(5, 4 * step), testing::line(4, step));
  const double span = 2.0 * radar.waveform.max_velocity(5);
  EstimateOptions options;
  options.folds = 2;
  for (int fold = -2; fold <= 2; ++fold) {
    RangeDoppler map = testing::empty_map(radar);
    testing::add_wave(map, radar, direction(0.3, 0.0), 1.0, 6, 0, true, fold);
    const AngleEstimates found = estimate_angles(map, radar, {{6, 0}}, search_grid(radar), options);
    EXPECT_NEAR(found.velocity[0], map.velocity[6] + fold * span, kRounding);
    EXPECT_NEAR(found.azimuth[0], 0.3, kFine);
    EXPECT_NEAR(found.power[0], 1.0, kPower);
  }
}

TEST(EstimateAngles, SlotsAreTurnedByVelocitiesBetweenTheCells) {
  const Vec3 step(0, kHalf, 0);
  const Radar radar = testing::radar_with(testing::line(5, 4 * step), testing::line(4, step));
  RangeDoppler map = testing::empty_map(radar);
  const double beside = 0.4 * (map.velocity[7] - map.velocity[6]);
  testing::add_wave(map, radar, direction(0.3, 0.0), 1.0, 6, 0, true, beside / (2.0 * radar.waveform.max_velocity(5)));
  for (const BeamMethod method : {BeamMethod::kBartlett, BeamMethod::kCapon}) {
    EstimateOptions options;
    options.beams.method = method;
    EXPECT_GT(std::abs(estimate_angles(map, radar, {{6, 0}}, search_grid(radar), options).azimuth[0] - 0.3), 100.0 * kFine);
    options.velocity = {map.velocity[6] + beside};
    const AngleEstimates found = estimate_angles(map, radar, {{6, 0}}, search_grid(radar), options);
    EXPECT_NEAR(found.azimuth[0], 0.3, kFine);
    EXPECT_EQ(found.velocity[0], options.velocity[0]);
  }
}

TEST(EstimateAngles, AnglesStayInTheGrid) {
  const Radar radar = testing::line_radar(4);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(0.5, 0.0), 1.0, 0, 0);
  const AngleEstimates found = estimate_angles(map, radar, {{0, 0}}, {{-0.2, 0.0, 0.2}, {0.1}});
  EXPECT_EQ(found.azimuth, std::vector<double>{0.2});
  EXPECT_EQ(found.elevation, std::vector<double>{0.1});
}

TEST(EstimateAngles, DoesNotDependOnTheNumberOfThreads) {
  const Radar radar = plane_radar(3, 3);
  RangeDoppler map = testing::empty_map(radar);
  for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::polar(1.0, 0.1 * static_cast<double>(i * i % 61));
  std::vector<Cell> cells;
  for (int64_t i = 0; i < 32; ++i) cells.push_back({i / 4, i % 4});
  test::same_on_any_threads([&] {
    const AngleEstimates found = estimate_angles(map, radar, cells, search_grid(radar));
    return std::pair(found.azimuth, found.power);
  });
}

// Bytes of memory that the process had in use at most, so far.
int64_t peak_memory() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return int64_t{usage.ru_maxrss} * 1024;
}

// An imaging radar of 48 x 48 antennas has 1.6 GB of such phases; copies of them would fill a common machine.
TEST(EstimateAngles, PhasesOfAllDirectionsAreKeptOnce) {
  if (test::kIsSanitized) GTEST_SKIP() << "a sanitizer keeps what was freed";
  const Radar radar = plane_radar(20, 20);
  RangeDoppler map = testing::empty_map(radar);
  testing::add_wave(map, radar, direction(0.2, 0.1), 1.0, 3, 2);
  const AngleGrid grid = search_grid(radar);
  const double phases = 16.0 * 400.0 * static_cast<double>(grid.azimuth.size() * grid.elevation.size());
  const int64_t before = peak_memory();
  EXPECT_EQ(estimate_angles(map, radar, {{3, 2}}, grid, {}).cell.size(), 1u);
  EXPECT_LT(static_cast<double>(peak_memory() - before), 1.4 * phases);
}

TEST(EstimateAngles, NoCellsGiveNoEstimates) {
  const Radar radar = testing::line_radar(3);
  EXPECT_TRUE(estimate_angles(testing::empty_map(radar), radar, {}, search_grid(radar)).cell.empty());
}

TEST(EstimateAngles, BadInputIsAnError) {
  const Vec3 step(0, kHalf, 0);
  const Radar radar = testing::radar_with(testing::line(3, 4 * step), testing::line(4, step));
  const RangeDoppler map = testing::empty_map(radar);
  const auto call = [&](EstimateOptions options, const RangeDoppler& from) {
    return estimate_angles(from, radar, {{0, 0}}, search_grid(radar), options);
  };
  EstimateOptions peaks, depth, folds, plain;
  peaks.max_peaks = 0;
  depth.peak_range_db = -1.0;
  folds.folds = 2;  // three transmitters tell one fold each way apart
  for (const EstimateOptions& bad : {peaks, depth, folds}) EXPECT_THROW(call(bad, map), std::invalid_argument);
  folds.folds = 1;
  EXPECT_NO_THROW(call(folds, map));
  EXPECT_THROW(call(folds, compensate_tdm(map, radar)), std::invalid_argument);
  folds.beams.compensate = false;
  EXPECT_THROW(call(folds, map), std::invalid_argument);
  EXPECT_THROW(estimate_angles(map, radar, {{0, 4}}, search_grid(radar)), std::out_of_range);
  Job job;
  job.cancel();
  EXPECT_THROW(estimate_angles(map, radar, {{0, 0}}, search_grid(radar), plain, &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_estimate_angles
