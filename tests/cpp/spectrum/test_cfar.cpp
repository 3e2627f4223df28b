// CFAR against closed forms, exact probabilities of correlated Gaussian cells, and slow loops over all cells.
#include <gtest/gtest.h>
#include <pthread.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <random>
#include <thread>

#include "cpp/support/expect_error.h"
#include "cpp/support/sanitized.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/cfar/cfar.h"
#include "plane_waves.h"

namespace echopath::test_cfar {
namespace {

using testing::Complex;

constexpr double kRounding = 1e-9;  // of a probability, from factors solved to 1e-13
constexpr double kExact = 1e-3;     // phases of the windows' centres: Hamming's end sample is not 0

CfarDesign design_of(WindowKind kind, int zero_pad, CfarWindow cells, double rate, int num_channels = 1) {
  CfarDesign design;
  design.false_alarm_rate = rate;
  design.cells = cells;
  design.noise = {Window{kind, 80.0}, 64, 128, zero_pad, num_channels};
  return design;
}

TEST(Cfar, CellAveragingOfIndependentCellsHasTheTextbookFactor) {
  for (const double rate : {1e-2, 1e-4, 1e-6}) {
    const CfarFactors factors = cfar_factors(design_of(WindowKind::kRect, 1, {1, 1, 2, 4}, rate));
    const double n = 7 * 11 - 9;
    for (const double factor : factors.factor) EXPECT_NEAR(factor, n * (std::pow(rate, -1.0 / n) - 1.0), 1e-8 * factor);
    EXPECT_EQ(factors.statistic, 1.0);
  }
}

// P(S > alpha T), S and T sums of n and m unit exponential powers: integral of the density of T times the tail of S.
double integrated(double alpha, int n, double m) {
  const int steps = 4000;
  const double end = m + 12.0 * std::sqrt(m) + 40.0;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) * end / steps, x = alpha * t;
    double tail = 0.0;
    for (int k = 0; k < n; ++k) tail += std::exp(k * std::log(x) - std::lgamma(k + 1.0) - x);
    sum += tail * std::exp((m - 1.0) * std::log(t) - t - std::lgamma(m)) * end / steps;
  }
  return sum;
}

TEST(Cfar, SeveralChannelsHaveTheBetaDistribution) {
  for (const int n : {2, 3, 12}) {
    const double alpha = 2.2 / 50.0;
    EXPECT_NEAR(false_alarm_probability(alpha, std::vector<double>(50, 1.0), n) / integrated(alpha, n, 50.0 * n), 1.0, 1e-7)
        << n;
  }
}

TEST(Cfar, ManyChannelsNeitherOverflowNorUnderflow) {
  // The sum of 1000 powers against the mean of 100 such: 1 + 4.7 sigma, sigma^2 = (1 + 1/100) / 1000, and skewness.
  const double alpha = (1.0 + 4.7 * std::sqrt(1.01 / 1000.0)) / 100.0;
  const double probability = false_alarm_probability(alpha, std::vector<double>(100, 1.0), 1000);
  EXPECT_NEAR(probability / integrated(alpha, 1000, 1e5), 1.0, 1e-6);
}

TEST(Cfar, OrderedStatisticOfIndependentCellsHasRohlingsProduct) {
  // Three standard errors: eight sets of draws scatter by 0.6 % at 1e-3 and by 2 % at 1e-6.
  for (const auto& [rate, draws_error] : {std::pair{1e-3, 0.02}, std::pair{1e-6, 0.06}}) {
    CfarDesign design = design_of(WindowKind::kRect, 1, {1, 1, 2, 4}, rate);
    design.method = CfarMethod::kOrderedStatistic;
    const double factor = cfar_factors(design).factor.back();
    double probability = 1.0;
    for (int i = 0; i < design.order(); ++i) probability *= (68.0 - i) / (68.0 - i + factor);
    EXPECT_NEAR(probability / rate, 1.0, draws_error) << rate;
  }
}

struct Place {
  int velocity, range;
};

// Training cells of (0, range) from the words of the header, cell by cell.
std::vector<Place> training_cells(const CfarWindow& w, int range, int num_ranges) {
  std::vector<Place> cells;
  const int reach = w.reach_range(), middle = std::clamp(range, reach, num_ranges - 1 - reach);
  for (int v = -w.reach_velocity(); v <= w.reach_velocity(); ++v) {
    if (std::abs(v) > w.guard_velocity) {
      for (int r = middle - reach; r <= middle + reach; ++r) cells.push_back({v, r});
      continue;
    }
    int left = 0;
    for (int r = range - w.guard_range - 1; r >= 0 && left < w.training_range; --r, ++left) cells.push_back({v, r});
    int right = 0;
    for (int r = range + w.guard_range + 1; r < num_ranges && right < 2 * w.training_range - left; ++r, ++right) {
      cells.push_back({v, r});
    }
    for (int r = range - w.guard_range - 1 - left; left + right < 2 * w.training_range; --r, ++left) cells.push_back({v, r});
  }
  return cells;
}

// E z_a conj z_b of one axis for cells `lag` apart
Complex correlation(const std::vector<double>& samples, int size, int lag) {
  Complex sum;
  double power = 0.0;
  for (size_t i = 0; i < samples.size(); ++i) {
    sum += samples[i] * samples[i] * std::polar(1.0, -kTwoPi * static_cast<double>(i) * lag / size);
    power += samples[i] * samples[i];
  }
  return sum / power;
}

// Correlations of cells -most to most apart, each summed once.
std::vector<std::complex<double>> correlations(const std::vector<double>& samples, int zero_pad, int most) {
  std::vector<std::complex<double>> found;
  for (int lag = -most; lag <= most; ++lag) {
    found.push_back(correlation(samples, static_cast<int>(samples.size()) * zero_pad, lag));
  }
  return found;
}

// Probability that |z_0|^2 > alpha sum |z_i|^2 for jointly Gaussian cells: with the eigenvalues of this indefinite form, one
// of them positive, it is prod 1 / (1 + |negative| / positive) (Turin 1960).
double exact_rate(const CfarDesign& design, int range, double factor) {
  const MapNoise& noise = design.noise;
  const auto cells = training_cells(design.cells, range, noise.num_samples * noise.zero_pad);
  std::vector<Place> all = {{0, range}};
  all.insert(all.end(), cells.begin(), cells.end());
  const int rows = design.cells.num_rows(), columns = design.cells.num_columns();
  const auto along_velocity = correlations(window_samples(noise.window.velocity, noise.num_chirps), noise.zero_pad, rows);
  const auto along_range = correlations(window_samples(noise.window.range, noise.num_samples), noise.zero_pad, columns);
  const Eigen::Index n = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXcd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      covariance(i, j) = along_velocity.at(static_cast<size_t>(rows + all[i].velocity - all[j].velocity)) *
                         along_range.at(static_cast<size_t>(columns + all[i].range - all[j].range));
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(covariance);
  const Eigen::MatrixXcd root = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  Eigen::VectorXd form = Eigen::VectorXd::Constant(n, -factor / static_cast<double>(cells.size()));
  form[0] = 1.0;
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd>(root.adjoint() * form.asDiagonal() * root, Eigen::EigenvaluesOnly)
          .eigenvalues();
  double probability = 1.0;
  for (Eigen::Index i = 0; i + 1 < n; ++i) probability /= 1.0 + std::abs(values[i]) / values[n - 1];
  return probability;
}

TEST(Cfar, CellAveragingIsExactForWindowedAndPaddedNoise) {
  struct Case {
    WindowKind kind;
    int zero_pad;
    CfarWindow cells;
  };
  const Case cases[] = {{WindowKind::kHann, 1, {2, 2, 2, 3}},
                        {WindowKind::kChebyshev, 1, {4, 4, 1, 3}},
                        {WindowKind::kRect, 2, {2, 2, 3, 4}},
                        {WindowKind::kHamming, 2, {4, 4, 1, 5}},
                        {WindowKind::kBlackmanHarris, 1, {0, 4, 0, 8}}};
  for (const Case& c : cases) {
    for (const double rate : {1e-3, 1e-6}) {
      const CfarDesign design = design_of(c.kind, c.zero_pad, c.cells, rate);
      const CfarFactors factors = cfar_factors(design);
      for (const int range : {0, 3, c.cells.reach_range()}) {
        const double factor = factors.factor[range];
        EXPECT_NEAR(exact_rate(design, range, factor) / rate, 1.0, kExact)
            << static_cast<int>(c.kind) << " " << rate << " at " << range;
      }
    }
  }
}

TEST(Cfar, LargeWindowsAreExactBetweenTheColumnsComputedToo) {
  constexpr double kBetween = 2e-3;  // of the rate: straight lines where factors have all but come to that of the middle
  const CfarDesign design = design_of(WindowKind::kHann, 1, {2, 2, 3, 20}, 1e-6);
  const CfarFactors factors = cfar_factors(design);
  ASSERT_EQ(factors.factor.size(), 23u);
  for (const int range : {0, 6, 21}) {
    EXPECT_NEAR(exact_rate(design, range, factors.factor[range]) / design.false_alarm_rate, 1.0, kBetween) << range;
  }
}

TEST(Cfar, TheLargestWindowsHearACancellation) {
  if (test::kIsSanitized) GTEST_SKIP() << "a bound of processor time, of code at full speed";
  constexpr double kSoon = 1.0;  // s of this thread's processor time, which other work does not lengthen: half of one
  CfarDesign design = design_of(WindowKind::kHann, 1, {2, 2, 12, 31}, 1e-6);
  clockid_t own_clock;
  ASSERT_EQ(pthread_getcpuclockid(pthread_self(), &own_clock), 0);
  const auto processor_time = [own_clock] {
    timespec now;
    clock_gettime(own_clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  for (const CfarMethod method : {CfarMethod::kCellAveraging, CfarMethod::kOrderedStatistic}) {
    design.method = method;
    Job job;
    double cancelled = 0.0;
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      cancelled = processor_time();
      job.cancel();
    });
    EXPECT_THROW(cfar_factors(design, &job), Cancelled);
    const double thrown = processor_time();
    other.join();
    EXPECT_LT(thrown - cancelled, kSoon);
  }
}

TEST(Cfar, CorrelatedTrainingCellsNeedAHigherFactor) {
  const CfarWindow cells{2, 2, 2, 3};
  const double hann = cfar_factors(design_of(WindowKind::kHann, 1, cells, 1e-6)).factor.back();
  const double rect = cfar_factors(design_of(WindowKind::kRect, 1, cells, 1e-6)).factor.back();
  EXPECT_GT(hann, 1.1 * rect);
}

TEST(Cfar, EachCellHasAsManyTrainingCellsInsideTheMapAndBeyondTheGuard) {
  for (const CfarWindow& w : {CfarWindow{1, 2, 2, 3}, CfarWindow{0, 0, 1, 0}, CfarWindow{0, 3, 0, 2}}) {
    const int num_ranges = w.num_columns() + 2;
    for (int r = 0; r < num_ranges; ++r) {
      int64_t inner = 0;
      for (const CellSpan& span : inner_spans(w, r, num_ranges)) {
        inner += span.count;
        if (span.count == 0) continue;
        EXPECT_GE(span.first, 0);
        EXPECT_LE(span.first + span.count, num_ranges);
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

// (velocity, range) and noise of the cells that a loop over all cells and their training cells finds.
void expect_slow_detections(const CfarResult& result) {
  const CfarDesign& design = result.design;
  const int num_velocities = static_cast<int>(result.num_velocities), num_ranges = static_cast<int>(result.num_ranges);
  size_t found = 0;
  for (int v = 0; v < num_velocities; ++v) {
    for (int r = 0; r < num_ranges; ++r) {
      std::vector<double> training;
      for (const Place& place : training_cells(design.cells, r, num_ranges)) {
        training.push_back(result.power[(place.velocity + v + num_velocities) % num_velocities * num_ranges + place.range]);
      }
      std::sort(training.begin(), training.end());
      double statistic = training[design.order() - 1];
      if (design.method == CfarMethod::kCellAveraging) {
        statistic = 0.0;
        for (const double value : training) statistic += value / static_cast<double>(training.size());
      }
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
  for (const CfarMethod method : {CfarMethod::kCellAveraging, CfarMethod::kOrderedStatistic}) {
    expect_slow_detections(cfar(random_map(radar, 1), radar, small_options(method)));
  }
}

TEST(Cfar, VelocityIsACircle) {
  const Radar radar = radar_of(1);
  const RangeDoppler map = random_map(radar, 2);
  RangeDoppler turned = map;
  const int64_t by = 5 * static_cast<int64_t>(map.range.size());
  std::rotate(turned.values.begin(), turned.values.begin() + by, turned.values.end());
  for (const CfarMethod method : {CfarMethod::kCellAveraging, CfarMethod::kOrderedStatistic}) {
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
  CfarDesign design = design_of(WindowKind::kHann, 1, {2, 2, 2, 3}, 1e-4, 2);
  design.method = CfarMethod::kOrderedStatistic;
  set_num_threads(1);
  const CfarResult one = cfar(random_map(radar, 4), radar, small_options(CfarMethod::kOrderedStatistic));
  const CfarFactors factors = cfar_factors(design);
  set_num_threads(4);
  const CfarResult four = cfar(random_map(radar, 4), radar, small_options(CfarMethod::kOrderedStatistic));
  EXPECT_EQ(factors.factor, cfar_factors(design).factor);
  set_num_threads(0);
  EXPECT_EQ(one.cells, four.cells);
  EXPECT_EQ(one.noise, four.noise);
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
      {"training_range", with([](CfarOptions& o) { o.training_range = o.training_velocity = 0; })}};
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
