#include "echopath/spectrum/cfar/training_draws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int kDrawsPerTask = 16;
constexpr uint64_t kSeed = 1;

}  // namespace

TrainingDraws::TrainingDraws(const CfarDesign& design, const TrainingNoise& noise, const Eigen::MatrixXd& form,
                             const std::vector<double>& eigenvalues, double tilt)
    : design_(design), noise_(noise), tilt_(tilt),
      root_(Eigen::LLT<Eigen::MatrixXd>(Eigen::MatrixXd::Identity(form.rows(), form.rows()) + tilt * form)) {
  for (const double value : eigenvalues) log_mean_ -= design.noise.num_channels * std::log1p(tilt * value);
}

std::vector<TrainingDraw> TrainingDraws::draw(int count, Job* job) const {
  std::vector<TrainingDraw> draws(count);
  parallel_for_chunks(count, kDrawsPerTask, [&](int64_t begin, int64_t end) {
    if (job) job->throw_if_cancelled();
    for (int64_t i = begin; i < end; ++i) draws[i] = one(i);
  });
  return draws;
}

// The columns are the real and imaginary parts of every channel.
Eigen::MatrixXd TrainingDraws::white_numbers(int64_t index) const {
  Eigen::MatrixXd numbers(root_.rows(), 2 * design_.noise.num_channels);
  for (Eigen::Index c = 0; c < numbers.cols(); c += 2) {
    for (Eigen::Index i = 0; i < numbers.rows(); ++i) {
      const auto [u, v] = uniform2(kSeed, Stream::kTraining, static_cast<uint64_t>(index),
                                   static_cast<uint32_t>(c / 2 * numbers.rows() + i));
      const double radius = std::sqrt(-std::log1p(-u));  // parts of variance 1/2
      numbers(i, c) = radius * std::cos(kTwoPi * v);
      numbers(i, c + 1) = radius * std::sin(kTwoPi * v);
    }
  }
  return numbers;
}

TrainingDraw TrainingDraws::one(int64_t index) const {
  Eigen::MatrixXd numbers = white_numbers(index);
  root_.matrixU().solveInPlace(numbers);
  const Eigen::MatrixXd &left = noise_.velocity_factor(), &right = noise_.range_factor();
  RowMatrix power = RowMatrix::Zero(left.rows(), right.rows());
  for (Eigen::Index c = 0; c < numbers.cols(); ++c) {
    const Eigen::Map<const RowMatrix> field(numbers.col(c).data(), left.cols(), right.cols());
    power += (left * field * right.transpose()).cwiseAbs2();
  }
  return summed_up(power);
}

TrainingDraw TrainingDraws::summed_up(const RowMatrix& power) const {
  const CfarWindow& cells = design_.cells;
  std::vector<double> training;
  double sum = 0.0;
  std::array<double, 2> half_means{};
  for (int row = -cells.reach_velocity(); row <= cells.reach_velocity(); ++row) {
    for (int column = -cells.reach_range(); column <= cells.reach_range(); ++column) {
      if (std::abs(row) <= cells.guard_velocity && std::abs(column) <= cells.guard_range) continue;
      const double value = power(row + cells.reach_velocity(), column + cells.reach_range());
      training.push_back(value);
      sum += value;
      if (const auto half = cells.half_of(row, column))
        half_means[*half] += value / static_cast<double>(cells.num_in_half());
    }
  }
  const auto [least, greatest] = std::ranges::minmax(half_means);
  const double statistic = design_.method == CfarMethod::kGreatestOf   ? greatest
                           : design_.method == CfarMethod::kSmallestOf ? least
                                                                       : ordered(std::move(training));
  return {statistic, tilt_ * sum + log_mean_};
}

double TrainingDraws::ordered(std::vector<double> training) const {
  const auto place = training.begin() + (design_.order() - 1);
  std::nth_element(training.begin(), place, training.end());
  return *place;
}

}  // namespace echopath
