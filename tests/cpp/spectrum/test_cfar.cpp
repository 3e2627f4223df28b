// CFAR of maps against slow loops over all cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "cpp/support/any_threads.h"
#include "cpp/support/expect_error.h"
#include "echopath/spectrum/cfar/cfar.h"
#include "plane_waves.h"
#include "training_cells.h"

namespace echopath::test_cfar {
namespace {

using testing::Complex;
using testing::design_of;
using testing::Place;
using testing::training_cells;

TEST(Cfar, EachCellHasAsManyTrainingCellsInsideTheMapAndBeyondTheGuard) {
  for (const CfarWindow& w : {CfarWindow{1, 2, 2, 3}, CfarWindow{0, 0, 1, 0}, CfarWindow{0, 3, 0, 2}}) {
    const int num_ranges = w.num_columns() + 2;
    for (int r = 0; r < num_ranges; ++r) {
      int64_t inner = 0;
      for (const CellSpan& span : inner_spans(w, r, num_ranges)) {
        inner += span.count;
        EXPECT_GE(span.first, 0);
        EXPECT_LE(span.first + span.count, num_ranges);
        if (span.count == 0) continue;
        EXPECT_TRUE(span.first + span.count <= r - w.guard_range || span.first > r + w.guard_range);
      }
      EXPECT_EQ(inner, 2 * w.training_range);
      const CellSpan outer = outer_span(w, r, num_ranges);
      EXPECT_TRUE(outer.first >= 0 && outer.count == w.num_columns() && outer.first + outer.count <= num_ranges);
    }
  }
}

// Powers over twelve decades.
RangeDoppler random_map(const Radar& radar, unsigned seed) {
  RangeDoppler map = testing::empty_map(radar);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (Complex& value : map.values) value = Complex(normal(random), normal(random));
  for (size_t i = 5; i < map.values.size(); i += 37) map.values[i] *= 1e6;
  return map;
}

Radar radar_of(int num_rx = 2) { return testing::line_radar(num_rx, 16, 40); }

CfarOptions small_options(CfarMethod method) {
  CfarOptions options;
  options.method = method;
  options.false_alarm_rate = 0.05;
  options.guard_velocity = options.guard_range = 1;
  options.training_velocity = 2;
  options.training_range = 4;
  return options;
}

constexpr CfarMethod kMethods[] = {CfarMethod::kCellAveraging, CfarMethod::kOrderedStatistic, CfarMethod::kGreatestOf,
                                   CfarMethod::kSmallestOf};

struct Training {
  Place place;
  double power;
};

double mean_of(const std::vector<double>& powers) {
  return std::accumulate(powers.begin(), powers.end(), 0.0) / static_cast<double>(powers.size());
}

// Means over the first and the last training cells of each row, in the order of ranges, of as many as make equal halves;
// over the rows on each side where there are no training cells along range.
std::array<double, 2> half_means(const CfarDesign& design, const std::vector<Training>& training) {
  std::vector<double> halves[2];
  for (int row = -design.cells.reach_velocity(); row <= design.cells.reach_velocity(); ++row) {
    std::map<int, double> by_range;
    for (const Training& one : training) {
      if (one.place.velocity == row) by_range[one.place.range] = one.power;
    }
    const size_t in_half = by_range.size() / 2;
    size_t number = 0;
    for (const auto& [range, power] : by_range) {
      const bool is_first = design.cells.training_range > 0 ? number < in_half : row < 0;
      const bool is_middle = design.cells.training_range > 0 && by_range.size() % 2 == 1 && number == in_half;
      if (!is_middle) halves[is_first ? 0 : 1].push_back(power);
      ++number;
    }
  }
  return {mean_of(halves[0]), mean_of(halves[1])};
}

double slow_statistic(const CfarDesign& design, const std::vector<Training>& training) {
  const auto [least, greatest] = std::ranges::minmax(half_means(design, training));
  if (design.method == CfarMethod::kGreatestOf) return greatest;
  if (design.method == CfarMethod::kSmallestOf) return least;
  std::vector<double> powers;
  for (const Training& one : training) powers.push_back(one.power);
  std::ranges::sort(powers);
  return design.method == CfarMethod::kCellAveraging ? mean_of(powers) : powers[design.order() - 1];
}

// (velocity, range) and noise of the cells that a loop over all cells and their training cells finds.
void expect_slow_detections(const CfarResult& result) {
  const CfarDesign& design = result.design;
  const int num_velocities = static_cast<int>(result.num_velocities), num_ranges = static_cast<int>(result.num_ranges);
  size_t found = 0;
  for (int v = 0; v < num_velocities; ++v) {
    for (int r = 0; r < num_ranges; ++r) {
      std::vector<Training> training;
      for (const Place& place : training_cells(design.cells, r, num_ranges)) {
        const int row = (place.velocity + v + num_velocities) % num_velocities;
        training.push_back({place, result.power[row * num_ranges + place.range]});
      }
      const double statistic = slow_statistic(design, training);
      const double factor = result.factors.factor[std::min({r, num_ranges - 1 - r, design.cells.reach_range()})];
      if (result.power[v * num_ranges + r] <= factor * statistic) continue;
      ASSERT_LT(found, result.cells.size());
      EXPECT_EQ(result.cells[found], (std::array<int64_t, 2>{v, r}));
      EXPECT_NEAR(result.noise[found] * result.factors.statistic / statistic, 1.0, 1e-12);
      ++found;
    }
  }
  EXPECT_EQ(found, result.cells.size());
  EXPECT_GT(found, 10u);
}

TEST(Cfar, FindsWhatALoopOverAllTrainingCellsFinds) {
  const Radar radar = radar_of();
  for (const CfarMethod method : kMethods) {
    CfarOptions options = small_options(method);
    expect_slow_detections(cfar(random_map(radar, 1), radar, options));
    options.guard_range = options.training_range = 0;
    expect_slow_detections(cfar(random_map(radar, 1), radar, options));
    options = small_options(method);
    options.guard_velocity = options.training_velocity = 0;
    expect_slow_detections(cfar(random_map(radar, 1), radar, options));
  }
}

// A map whose ranges are 1, 2, 4 or 8 times as large finds the same as the map without: such factors leave no rounding.
TEST(Cfar, NoiseOfAKnownShapeIsComparedAsIfItWereAlikeAtAllRanges) {
  const Radar radar = radar_of();
  const RangeDoppler map = random_map(radar, 3);
  RangeDoppler shaped = map;
  std::vector<double> noise_shape(map.range.size());
  for (size_t r = 0; r < noise_shape.size(); ++r) noise_shape[r] = std::exp2(2.0 * static_cast<double>(r * r % 4));
  for (size_t i = 0; i < map.values.size(); ++i) shaped.values[i] *= std::sqrt(noise_shape[i % noise_shape.size()]);
  for (const CfarMethod method : kMethods) {
    CfarOptions options = small_options(method);
    const CfarResult wanted = cfar(map, radar, options);
    EXPECT_NE(cfar(shaped, radar, options).cells, wanted.cells);
    options.noise_shape = noise_shape;
    const CfarResult found = cfar(shaped, radar, options);
    ASSERT_EQ(found.cells, wanted.cells);
    for (size_t i = 0; i < found.cells.size(); ++i) {
      const auto [v, r] = found.cells[i];
      EXPECT_EQ(found.noise[i], wanted.noise[i] * noise_shape[r]);
      EXPECT_EQ(found.power[v * found.num_ranges + r], wanted.power[v * found.num_ranges + r] * noise_shape[r]);
    }
  }
}

TEST(Cfar, VelocityIsACircle) {
  const Radar radar = radar_of(1);
  const RangeDoppler map = random_map(radar, 2);
  RangeDoppler turned = map;
  const int64_t by = 5 * static_cast<int64_t>(map.range.size());
  std::rotate(turned.values.begin(), turned.values.begin() + by, turned.values.end());
  for (const CfarMethod method : kMethods) {
    auto cells = cfar(map, radar, small_options(method)).cells;
    for (auto& cell : cells) cell[0] = (cell[0] - 5 + 16) % 16;
    std::sort(cells.begin(), cells.end());
    EXPECT_EQ(cells, cfar(turned, radar, small_options(method)).cells);
  }
}

TEST(Cfar, PowerIsTheMeanOverChannels) {
  const Radar radar = radar_of(2);
  const RangeDoppler map = random_map(radar, 3);
  const CfarResult result = cfar(map, radar, small_options(CfarMethod::kCellAveraging));
  for (size_t i = 0; i < result.power.size(); ++i) {
    EXPECT_DOUBLE_EQ(result.power[i], (std::norm(map.values[i]) + std::norm(map.values[i + result.power.size()])) / 2.0);
  }
}

TEST(Cfar, DoesNotDependOnTheNumberOfThreads) {
  const Radar radar = radar_of();
  CfarDesign design = design_of(WindowKind::kHann, 1, {2, 2, 1, 1}, 1e-4, 2);
  design.method = CfarMethod::kOrderedStatistic;
  test::same_on_any_threads([&] {
    const CfarResult found = cfar(random_map(radar, 4), radar, small_options(CfarMethod::kOrderedStatistic));
    return std::tuple(found.cells, found.noise, cfar_factors(design).factor);
  });
}

TEST(Cfar, DefaultsFollowTheWindowAndFitTheMap) {
  Radar radar = radar_of(1);
  RangeDoppler map = testing::empty_map(radar);
  map.window = Window{WindowKind::kHann};
  EXPECT_EQ(cfar_design(map, radar, {}).cells, (CfarWindow{2, 2, 4, 8}));
  map.window = Window{WindowKind::kRect};
  EXPECT_EQ(cfar_design(map, radar, {}).cells, (CfarWindow{1, 1, 4, 8}));
  radar = testing::line_radar(1, 1, 40);
  EXPECT_EQ(cfar_design(testing::empty_map(radar), radar, {}).cells, (CfarWindow{0, 1, 0, 8}));
  radar = testing::line_radar(1, 8, 40);
  EXPECT_EQ(cfar_design(testing::empty_map(radar), radar, {}).cells, (CfarWindow{1, 1, 2, 8}));
}

TEST(Cfar, AMapOfZerosHasNoDetectionsAndOneEchoInItHasOne) {
  const Radar radar = radar_of(1);
  RangeDoppler map = testing::empty_map(radar);
  EXPECT_TRUE(cfar(map, radar).cells.empty());
  map.values[3 * 40 + 7] = 1.0;
  const CfarResult result = cfar(map, radar);
  ASSERT_EQ(result.cells.size(), 1u);
  EXPECT_EQ(result.cells[0], (std::array<int64_t, 2>{3, 7}));
  EXPECT_EQ(result.noise[0], 0.0);
}

TEST(Cfar, BadInputNamesTheArgument) {
  const Radar radar = radar_of(1);
  RangeDoppler map = testing::empty_map(radar);
  const auto with = [](auto change) {
    CfarOptions options = small_options(CfarMethod::kCellAveraging);
    change(options);
    return options;
  };
  const std::pair<const char*, CfarOptions> cases[] = {
      {"false_alarm_rate", with([](CfarOptions& o) { o.false_alarm_rate = 0.0; })},
      {"false_alarm_rate", with([](CfarOptions& o) { o.false_alarm_rate = std::nan(""); })},
      {"rank", with([](CfarOptions& o) { o.rank = 1.1; })},
      {"guard_velocity", with([](CfarOptions& o) { o.guard_velocity = 0; })},
      {"guard_range", with([](CfarOptions& o) { o.guard_range = 0; })},
      {"guard_range", with([](CfarOptions& o) { o.guard_range = -1; })},
      {"training_velocity", with([](CfarOptions& o) { o.training_velocity = 7; })},
      {"training_range", with([](CfarOptions& o) { o.training_range = o.training_velocity = 0; })},
      {"noise_shape", with([](CfarOptions& o) { o.noise_shape = {1.0}; })},
      {"noise_shape",
       with([](CfarOptions& o) { o.noise_shape = std::vector<double>(39, 1.0), o.noise_shape.push_back(0.0); })}};
  for (const auto& [name, options] : cases) {
    test::expect_error<std::invalid_argument>([&] { cfar(map, radar, options); }, {name});
  }
  test::expect_error<std::invalid_argument>([&] { cfar(map, radar_of(2), {}); }, {"spectrum"});
  map.window = Window{WindowKind::kHann};
  test::expect_error<std::invalid_argument>([&] { cfar(map, radar, small_options(CfarMethod::kCellAveraging)); },
                                            {"guard_velocity"});
  test::expect_error<std::invalid_argument>([&] { cfar_factors(design_of(WindowKind::kHann, 1, {2, 2, 20, 30}, 1e-3)); },
                                            {"training_range", "2000", "2925"});
  Job job;
  job.cancel();
  EXPECT_THROW(cfar(map, radar, {}, &job), Cancelled);
}

}  // namespace
}  // namespace echopath::test_cfar
