#include "echopath/label/cells/cell_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>
#include <stdexcept>

namespace echopath::test_cell_errors {
namespace {

using Complex = std::complex<double>;

constexpr int kBatches = 8;
constexpr size_t kDraws = 20'000;  // cells with the same truth: independent draws of the batches
// Of means over the draws, relative: three times 1/sqrt(kDraws), and what first order leaves out with eight batches.
constexpr double kMeanError = 0.03;
// Standard errors are of first order and from eight batches: mean of their squares against the spread, relative.
constexpr double kVarianceError = 0.15;
constexpr double kRounding = 1e-12;

// What one part is made of in each cell.
struct Truth {
  Complex field;         // coherent, sqrt(W)
  double noise = 0.0;    // sqrt(W), deviation of the field that one batch finds
  double diffuse = 0.0;  // W
};

// Sums of batches [B, draws] as they are defined, one channel.
struct Sums {
  std::vector<double> cross, coherent, diffuse;
  BatchPowers view() const { return {cross, coherent, diffuse}; }
};

Complex gaussian(std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, std::sqrt(0.5));
  const double real = normal(random);
  return {real, normal(random)};
}

Sums draw(const Truth& truth, std::mt19937_64& random) {
  const std::vector<double> zeros(kBatches * kDraws);
  Sums sums{zeros, zeros, zeros};
  for (size_t i = 0; i < kDraws; ++i) {
    std::vector<Complex> fields;
    Complex mean;
    for (int b = 0; b < kBatches; ++b) {
      fields.push_back(truth.field + truth.noise * gaussian(random));
      mean += fields.back() / static_cast<double>(kBatches);
    }
    for (size_t b = 0; b < kBatches; ++b) {
      sums.cross[b * kDraws + i] = (std::conj(mean) * fields[b]).real();
      sums.coherent[b * kDraws + i] = std::norm(fields[b]);
      sums.diffuse[b * kDraws + i] = truth.diffuse * std::norm(gaussian(random));
    }
  }
  return sums;
}

double mean_of(const std::vector<double>& values, size_t part) {
  double sum = 0.0;
  for (size_t i = 0; i < kDraws; ++i) sum += values[part * kDraws + i];
  return sum / kDraws;
}

double mean_square_of(const std::vector<double>& values, size_t part, double about) {
  double sum = 0.0;
  for (size_t i = 0; i < kDraws; ++i) sum += std::pow(values[part * kDraws + i] - about, 2);
  return sum / kDraws;
}

// The spread of `values` over the draws is what `errors` say.
void expect_spread(const std::vector<double>& values, const std::vector<double>& errors, size_t part) {
  const double spread = mean_square_of(values, part, mean_of(values, part));
  EXPECT_NEAR(mean_square_of(errors, part, 0.0) / spread, 1.0, kVarianceError) << part;
}

ShareErrors errors_of(const std::vector<Truth>& truths, const std::vector<int16_t>& dominant) {
  std::mt19937_64 random(11);
  std::vector<Sums> sums;
  for (const Truth& truth : truths) sums.push_back(draw(truth, random));
  std::vector<BatchPowers> parts;
  for (const Sums& sum : sums) parts.push_back(sum.view());
  return share_errors(parts, kBatches, dominant);
}

TEST(CellErrors, PowerHasNoBiasAndItsErrorIsItsSpread) {
  const std::vector<Truth> truths{{{3.0, 1.0}, 0.5, 0.0}, {{0.0, 0.0}, 0.0, 4.0}, {{2.0, 0.0}, 1.0, 3.0}};
  const ShareErrors errors = errors_of(truths, std::vector<int16_t>(kDraws, 0));
  for (size_t k = 0; k < truths.size(); ++k) {
    const double power = std::norm(truths[k].field) + truths[k].diffuse;
    EXPECT_NEAR(mean_of(errors.power, k) / power, 1.0, kMeanError) << k;
    expect_spread(errors.power, errors.power_error, k);
  }
}

TEST(CellErrors, ErrorOfASharesIsItsSpread) {
  const std::vector<Truth> truths{{{3.0, 1.0}, 0.4, 0.0}, {{0.0, 0.0}, 0.0, 1.0}, {{2.0, 0.0}, 0.5, 1.0}};
  const ShareErrors errors = errors_of(truths, std::vector<int16_t>(kDraws, 0));
  for (size_t k = 0; k < truths.size(); ++k) expect_spread(errors.share, errors.share_error, k);
}

TEST(CellErrors, PartsThatVaryTogetherHaveASureShare) {
  std::mt19937_64 random(5);
  const Sums one = draw({{}, 0.0, 1.0}, random);
  Sums three = one;
  for (double& value : three.diffuse) value *= 3.0;
  const ShareErrors errors = share_errors({one.view(), three.view()}, kBatches, std::vector<int16_t>(kDraws, 1));
  for (size_t i = 0; i < kDraws; ++i) {
    ASSERT_NEAR(errors.share[i], 0.25, kRounding);
    ASSERT_NEAR(errors.share_error[i], 0.0, kRounding);
    ASSERT_GT(errors.power_error[i], 0.0);
    ASSERT_TRUE(errors.certain[i]);
  }
}

TEST(CellErrors, NoiseAloneIsNotTakenForPower) {
  const ShareErrors errors = errors_of({{{}, 1.0, 0.0}, {{1.0, 0.0}, 0.0, 0.0}}, std::vector<int16_t>(kDraws, 0));
  // Estimates below zero are cut off: what is left is a fraction of the noise of the mean, 1/kBatches.
  EXPECT_LT(mean_of(errors.power, 0), 0.5 / kBatches);
  EXPECT_NEAR(mean_of(errors.power_error, 0), 1.0 / kBatches, 0.5 / kBatches);
}

// Fields 1 and -1 of two batches cancel: their variance is 2, and that of the square of their mean, freed of bias, is
// 2^2 / 2.
TEST(CellErrors, OfFieldsThatCancelTheNoiseIsThatOfSecondOrder) {
  const std::vector<double> none{0.0, 0.0}, ones{1.0, 1.0}, fours{4.0, 4.0};
  const ShareErrors errors = share_errors({{none, ones, none}, {none, none, fours}}, 2, std::vector<int16_t>{1});
  EXPECT_EQ(errors.power, (std::vector<double>{0.0, 4.0}));
  EXPECT_NEAR(errors.power_error[0], std::sqrt(2.0), kRounding);
  EXPECT_EQ(errors.power_error[1], 0.0);
  for (const double error : errors.share_error) EXPECT_NEAR(error, std::sqrt(2.0) / 4.0, kRounding);
}

TEST(CellErrors, OnlyALeadOfTwoStandardErrorsIsCertain) {
  const ShareErrors even = errors_of({{{}, 0.0, 1.0}, {{}, 0.0, 1.0}}, std::vector<int16_t>(kDraws, 0));
  const ShareErrors clear = errors_of({{{}, 0.0, 20.0}, {{}, 0.0, 1.0}}, std::vector<int16_t>(kDraws, 0));
  const ShareErrors wrong = errors_of({{{}, 0.0, 20.0}, {{}, 0.0, 1.0}}, std::vector<int16_t>(kDraws, 1));
  const auto share_of_certain = [](const ShareErrors& errors) {
    double sum = 0.0;
    for (const uint8_t certain : errors.certain) sum += certain;
    return sum / kDraws;
  };
  EXPECT_LT(share_of_certain(even), 0.1);  // 2.3 % one-sided for known errors, more for those of eight batches
  EXPECT_GT(share_of_certain(clear), 0.99);
  EXPECT_EQ(share_of_certain(wrong), 0.0);
}

TEST(CellErrors, OfTwoSharesEachHasTheSameErrorAndTheirDifferenceTwiceThat) {
  const ShareErrors errors = errors_of({{{1.0, 0.0}, 0.8, 0.2}, {{0.5, 0.0}, 0.6, 0.1}}, std::vector<int16_t>(kDraws, 0));
  int64_t num_certain = 0;
  for (size_t i = 0; i < kDraws; ++i) {
    const double share = errors.share[i], error = errors.share_error[i];
    ASSERT_NEAR(errors.share_error[kDraws + i], error, kRounding);
    const double excess = (2.0 * share - 1.0) - 2.0 * (2.0 * error);
    if (std::abs(excess) < 1e-9) continue;  // rounding decides
    ASSERT_EQ(errors.certain[i] != 0, excess > 0.0) << i;
    num_certain += errors.certain[i];
  }
  EXPECT_GT(num_certain, kDraws / 10);
  EXPECT_LT(num_certain, 9 * kDraws / 10);
}

TEST(CellErrors, CellsWithoutLabelOrPowerAreNotCertain) {
  const std::vector<double> none(2 * 2, 0.0), some{1.0, 0.0, 1.0, 0.0};
  const ShareErrors errors = share_errors({{some, some, none}, {none, none, none}}, 2, std::vector<int16_t>{-1, 0});
  EXPECT_EQ(errors.certain, (std::vector<uint8_t>{0, 0}));
  EXPECT_EQ(errors.share, (std::vector<double>{1.0, 0.0, 0.0, 0.0}));
}

TEST(CellErrors, CancelledJobStops) {
  const std::vector<double> values(2 * 3, 1.0);
  Job job;
  job.cancel();
  EXPECT_THROW(share_errors({{values, values, values}}, 2, std::vector<int16_t>(3, 0), &job), Cancelled);
}

TEST(CellErrors, OneBatchTellsNothing) {
  const std::vector<double> values(3, 1.0);
  EXPECT_THROW(share_errors({{values, values, values}}, 1, std::vector<int16_t>(3, 0)), std::invalid_argument);
  EXPECT_THROW(share_errors({{values, values, values}}, 2, std::vector<int16_t>(3, 0)), std::invalid_argument);
  EXPECT_THROW(share_errors({}, 2, std::vector<int16_t>(3, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_cell_errors
