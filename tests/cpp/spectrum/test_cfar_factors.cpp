// Factors of CFAR against closed forms and exact probabilities of correlated Gaussian cells.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <chrono>
#include <cmath>
#include <thread>

#include "echopath/spectrum/cfar/cfar.h"
#include "training_cells.h"

namespace echopath::test_cfar_factors {
namespace {

using testing::design_of;
using testing::Place;
using Complex = std::complex<double>;

constexpr double kExact = 1e-3;  // phases of the windows' centres: Hamming's end sample is not 0

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

// Returns the probability that a unit exponential power exceeds t times the smaller of two sums of n such powers (Gandhi,
// Kassam, IEEE Trans. AES-24 (1988) 427), and with `is_greatest` the greater: both together are those of one sum twice.
double halves_rate(double t, int n, bool is_greatest) {
  double smallest = 0.0;
  for (int k = 0; k < n; ++k) {
    const double log_choose = std::lgamma(n + k) - std::lgamma(k + 1) - std::lgamma(n);
    smallest += 2.0 * std::exp(log_choose - (n + k) * std::log(2.0 + t));
  }
  return is_greatest ? 2.0 * std::pow(1.0 + t, -n) - smallest : smallest;
}

TEST(Cfar, HalvesOfIndependentCellsHaveTheirPublishedRates) {
  // Three standard errors, as of the ordered statistic.
  for (const auto& [rate, draws_error] : {std::pair{1e-3, 0.02}, std::pair{1e-6, 0.06}}) {
    for (const CfarMethod method : {CfarMethod::kGreatestOf, CfarMethod::kSmallestOf}) {
      CfarDesign design = design_of(WindowKind::kRect, 1, {1, 1, 2, 4}, rate);
      design.method = method;
      const int n = 3 * 4 + 4 * 5;  // 3 rows of 4 cells beside the guard, 4 rows of 5
      EXPECT_EQ(design.cells.num_in_half(), n);
      const CfarFactors factors = cfar_factors(design);
      const bool is_greatest = method == CfarMethod::kGreatestOf;
      EXPECT_NEAR(halves_rate(factors.factor.back() / n, n, is_greatest) / rate, 1.0, draws_error) << rate << is_greatest;
      // The mean difference of two means of n unit exponential powers, nearly Gaussian, is 2 / sqrt(pi n).
      const double expected = 1.0 + (is_greatest ? 1.0 : -1.0) / std::sqrt(kPi * n);
      EXPECT_NEAR(factors.statistic, expected, 0.005);
    }
  }
}

// Returns the false-alarm probability of the order-th of n independent cells (Rohling 1983).
double ordered_rate(double factor, int64_t n, int64_t order) {
  double probability = 1.0;
  for (int64_t i = 0; i < order; ++i) probability *= static_cast<double>(n - i) / (static_cast<double>(n - i) + factor);
  return probability;
}

// Up to 9 % found of ordered statistics at the lower rate, 3 % of halves; with draws that know no groups of cells there were
// up to 70 times the false alarms.
TEST(Cfar, FewCellsAtLowRatesHaveTheirClosedForms) {
  constexpr double kDrawsError = 0.12;
  for (const double rate : {1e-3, 1e-9}) {
    for (const int n : {1, 4, 8, 16}) {  // cells of a half
      CfarDesign design = design_of(WindowKind::kRect, 1, {0, 1, 0, n}, rate);
      for (const CfarMethod method : {CfarMethod::kSmallestOf, CfarMethod::kGreatestOf}) {
        design.method = method;
        const double found = halves_rate(cfar_factors(design).factor.back() / n, n, method == CfarMethod::kGreatestOf);
        EXPECT_NEAR(found / rate, 1.0, 0.5 * kDrawsError) << rate << ", " << n;
      }
      design.method = CfarMethod::kOrderedStatistic;
      for (const double rank : {0.25, 0.75}) {
        design.rank = rank;
        const double found = ordered_rate(cfar_factors(design).factor.back(), 2 * n, design.order());
        EXPECT_NEAR(found / rate, 1.0, kDrawsError) << rate << ", " << design.order() << " of " << 2 * n;
      }
    }
  }
}

// Factors are so large here that eigenvalues of the two forms together, which differ by as much, were not found.
TEST(Cfar, SmallestWindowsHaveTheTextbookFactor) {
  for (const double rate : {1e-3, 1e-6, 1e-12}) {
    for (const CfarWindow& cells : {CfarWindow{0, 1, 0, 1}, CfarWindow{1, 0, 2, 0}, CfarWindow{0, 1, 0, 2}}) {
      const auto n = static_cast<double>(cells.num_training());
      for (const double factor : cfar_factors(design_of(WindowKind::kRect, 1, cells, rate)).factor)
        EXPECT_NEAR(factor / (n * (std::pow(rate, -1.0 / n) - 1.0)), 1.0, 1e-7) << rate << ", " << n;
    }
  }
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
  const auto cells = testing::training_cells(design.cells, range, noise.num_samples * noise.zero_pad);
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
  const Eigen::LDLT<Eigen::MatrixXcd> factors(covariance);  // a root sooner than by eigenvectors
  const Eigen::VectorXd scales = factors.vectorD().real().cwiseMax(0.0).cwiseSqrt();
  const Eigen::MatrixXcd root =
      factors.transpositionsP().transpose() * (Eigen::MatrixXcd(factors.matrixL()) * scales.asDiagonal());
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
  const Case cases[] = {{WindowKind::kHann, 1, {2, 2, 2, 3}},    {WindowKind::kChebyshev, 1, {4, 4, 1, 3}},
                        {WindowKind::kTaylor, 1, {4, 4, 1, 3}},  {WindowKind::kRect, 2, {2, 2, 3, 4}},
                        {WindowKind::kHamming, 2, {4, 4, 1, 5}}, {WindowKind::kBlackmanHarris, 1, {0, 4, 0, 8}}};
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

// How soon they hear it, `echopath bench hard` measures: no clock decides here.
TEST(Cfar, TheLargestWindowsHearACancellation) {
  for (const CfarMethod method : {CfarMethod::kCellAveraging, CfarMethod::kOrderedStatistic}) {
    CfarDesign design = design_of(WindowKind::kHann, 1, {2, 2, 12, 31}, 1e-6);
    design.method = method;
    Job job;
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));  // a small part of the work
      job.cancel();
    });
    EXPECT_THROW(cfar_factors(design, &job), Cancelled);
    other.join();
  }
}

TEST(Cfar, CorrelatedTrainingCellsNeedAHigherFactor) {
  const CfarWindow cells{2, 2, 2, 3};
  const double hann = cfar_factors(design_of(WindowKind::kHann, 1, cells, 1e-6)).factor.back();
  const double rect = cfar_factors(design_of(WindowKind::kRect, 1, cells, 1e-6)).factor.back();
  EXPECT_GT(hann, 1.1 * rect);
}

}  // namespace
}  // namespace echopath::test_cfar_factors
