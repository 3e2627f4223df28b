#include "echopath/spectrum/cfar_factor.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/base/random.h"
#include "echopath/spectrum/training_noise.h"

namespace echopath {
namespace {

constexpr int kMaxChannels = 4096;
constexpr int kManyDraws = 8192, kFewDraws = 512, kDrawsPerTask = 16;
constexpr uint64_t kSeed = 1;

// log of the probability that a sum of n unit exponential powers exceeds x: e^-x sum_{k < n} x^k / k!
double log_tail(int n, double x) {
  double term = 1.0, sum = 1.0, scale = 0.0;
  for (int k = 1; k < n; ++k) {
    term *= x / k;
    sum += term;
    if (sum < 1e200) continue;  // far from overflow
    scale += std::log(sum);
    term /= sum;
    sum = 1.0;
  }
  return std::log(sum) + scale - x;
}

// -d log_tail / dx, which is density / tail
double hazard(int n, double x) {
  return std::exp((n - 1) * std::log(x) - std::lgamma(n) - x - log_tail(n, x));
}

// The x > 0 where a decreasing function falls through `value`; secants of logarithms, in which it is nearly straight.
double solve_decreasing(const std::function<double(double)>& function, double value) {
  const auto excess = [&](double log_x) { return std::log(std::max(function(std::exp(log_x)), 1e-300) / value); };
  double low = -30.0, high = 0.0, at_low = excess(low), at_high = excess(high);
  while (at_high > 0.0) {
    low = high;
    at_low = at_high;
    at_high = excess(high += 1.0);
  }
  for (int side = 0, round = 0; round < 200 && high - low > 1e-13; ++round) {
    const double x = (low * at_high - high * at_low) / (at_high - at_low), at = excess(x);
    if (at == 0.0 || x <= low || x >= high) return std::exp(x);
    // Illinois: an end that stays twice counts half, so that both ends close in.
    if (at > 0.0) {
      low = x;
      at_low = at;
      if (side == 1) at_high *= 0.5;
    } else {
      high = x;
      at_high = at;
      if (side == -1) at_low *= 0.5;
    }
    side = at > 0.0 ? 1 : -1;
  }
  return std::exp(0.5 * (low + high));
}

std::vector<double> eigenvalues_of(const Eigen::MatrixXd& form) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(form, Eigen::EigenvaluesOnly);
  std::vector<double> values;
  for (const double value : solver.eigenvalues()) values.push_back(std::max(value, 0.0));
  return values;
}

// Multiplier of the sum of training powers with the eigenvalues given.
double sum_multiplier(const std::vector<double>& eigenvalues, double rate, int num_channels) {
  return solve_decreasing([&](double alpha) { return false_alarm_probability(alpha, eigenvalues, num_channels); }, rate);
}

// One draw of the training cells: statistic and logarithm of its weight.
struct Draw {
  double statistic = 0.0, log_weight = 0.0;
};

// Draws training cells from their distribution tilted by e^{-tilt times the sum of their powers}. That is Gaussian again, of
// covariance (1 + tilt B)^-1; weights e^{tilt sum} times the mean of the tilt undo it exactly.
class TiltedDraws {
 public:
  TiltedDraws(const CfarDesign& design, const TrainingNoise& noise, const Eigen::MatrixXd& form,
              const std::vector<double>& eigenvalues, double tilt)
      : design_(design), noise_(noise), tilt_(tilt),
        root_(Eigen::LLT<Eigen::MatrixXd>(Eigen::MatrixXd::Identity(form.rows(), form.rows()) + tilt * form)) {
    for (const double value : eigenvalues) log_mean_ -= design.noise.num_channels * std::log1p(tilt * value);
  }

  std::vector<Draw> draw(int count, Job* job) const {
    std::vector<Draw> draws(count);
    parallel_for((count + kDrawsPerTask - 1) / kDrawsPerTask, [&](int64_t task) {
      if (job) job->throw_if_cancelled();
      const int64_t end = std::min<int64_t>(count, (task + 1) * kDrawsPerTask);
      for (int64_t i = task * kDrawsPerTask; i < end; ++i) draws[i] = one(i);
    });
    return draws;
  }

 private:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // Columns: real and imaginary parts of every channel.
  Eigen::MatrixXd white_numbers(int64_t index) const {
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

  Draw one(int64_t index) const {
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

  Draw summed_up(const RowMatrix& power) const {
    const CfarWindow& cells = design_.cells;
    std::vector<double> training;
    for (int row = 0; row < cells.num_rows(); ++row) {
      const bool beyond = std::abs(row - cells.reach_velocity()) > cells.guard_velocity;
      for (int column = 0; column < cells.num_columns(); ++column) {
        if (beyond || std::abs(column - cells.reach_range()) > cells.guard_range) training.push_back(power(row, column));
      }
    }
    double sum = 0.0;
    for (const double value : training) sum += value;
    const auto place = training.begin() + (design_.order() - 1);
    std::nth_element(training.begin(), place, training.end());
    return {*place, tilt_ * sum + log_mean_};
  }

  const CfarDesign& design_;
  const TrainingNoise& noise_;
  const double tilt_;
  const Eigen::LLT<Eigen::MatrixXd> root_;
  double log_mean_ = 0.0;
};

// Of the ordered statistic of a cell in the middle, from the multiplier of the sum.
double ordered_multiplier(const CfarDesign& design, const TrainingNoise& noise, double of_sum, Job* job) {
  const int channels = design.noise.num_channels;
  const double threshold = of_sum * static_cast<double>(design.cells.num_training()) * channels;
  const Eigen::MatrixXd form = noise.quadratic_form(design.cells.reach_range());
  const TiltedDraws source(design, noise, form, eigenvalues_of(form), hazard(channels, threshold) * of_sum);
  const int count = std::max(kFewDraws, kManyDraws / channels);
  const std::vector<Draw> draws = source.draw(count, job);
  return solve_decreasing([&](double alpha) {
    double sum = 0.0;
    for (const Draw& draw : draws) sum += std::exp(draw.log_weight + log_tail(channels, alpha * draw.statistic));
    return sum / count;
  }, design.false_alarm_rate);
}

// Eigenvalues of c c^T - alpha diag(values), ascending: roots of 1 = sum c_i^2 / (x + alpha value_i), one above each
// -alpha value_i and below the next. values descending, squares c_i^2 of sum 1.
std::vector<double> coupled_eigenvalues(double alpha, const std::vector<double>& values,
                                        const std::vector<double>& squares) {
  const size_t count = values.size();
  std::vector<double> roots(count);
  for (size_t k = 0; k < count; ++k) {
    double low = -alpha * values[k], high = k + 1 < count ? -alpha * values[k + 1] : 1.0;
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (low + high);
      double sum = 0.0;
      for (size_t i = 0; i < count; ++i) sum += squares[i] / (middle + alpha * values[i]);
      (sum > 1.0 ? low : high) = middle;
    }
    roots[k] = 0.5 * (low + high);
  }
  return roots;
}

// Multiplier of the sum of training powers for a cell that is correlated with them: the probability that an
// indefinite form of Gaussian numbers is positive, by its eigenvalues, of which one is positive (Turin 1960).
double coupled_multiplier(const CfarDesign& design, const TrainingNoise& noise, int column) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(-noise.quadratic_form(column));
  const Eigen::VectorXd coupling = solver.eigenvectors().transpose() * noise.cell(column);
  std::vector<double> values, squares;
  for (Eigen::Index i = 0; i < coupling.size(); ++i) {
    values.push_back(std::max(-solver.eigenvalues()[i], 0.0));
    squares.push_back(coupling[i] * coupling[i]);
  }
  return solve_decreasing([&](double alpha) {
    std::vector<double> negative = coupled_eigenvalues(alpha, values, squares);
    const double positive = negative.back();
    negative.pop_back();
    for (double& value : negative) value = std::abs(value);
    return false_alarm_probability(1.0 / positive, negative, design.noise.num_channels);
  }, design.false_alarm_rate);
}

// Multipliers of the sum of training powers, by distance from the end of the range axis.
struct SumMultipliers {
  double alone = 0.0;           // in the middle, for a cell that is independent of the training cells
  std::vector<double> coupled;  // [reach_range + 1] with the correlation that is left
};

SumMultipliers sum_multipliers(const CfarDesign& design, const TrainingNoise& noise, Job* job) {
  constexpr double kNoMatter = 1e-4;  // of a multiplier: a hundredth of that in the rate and a little more
  const int reach = design.cells.reach_range(), channels = design.noise.num_channels;
  const auto alone = [&](int column) {
    return sum_multiplier(eigenvalues_of(noise.quadratic_form(column)), design.false_alarm_rate, channels);
  };
  SumMultipliers result{alone(reach), std::vector<double>(reach + 1)};
  const double coupled = result.coupled[reach] = coupled_multiplier(design, noise, reach);
  const bool matters = std::abs(coupled - result.alone) > kNoMatter * result.alone;
  parallel_for(reach, [&](int64_t column) {
    if (job) job->throw_if_cancelled();
    const int at = static_cast<int>(column);
    result.coupled[column] = matters ? coupled_multiplier(design, noise, at) : alone(at);
  });
  return result;
}

// Of the mean of `count` independent cells of unit power, its quantile that order statistics estimate.
double expected_statistic(const CfarDesign& design) {
  if (design.method == CfarMethod::kCellAveraging) return 1.0;
  const int channels = design.noise.num_channels;
  const double above = 1.0 - static_cast<double>(design.order()) / (static_cast<double>(design.cells.num_training()) + 1.0);
  const double sum = solve_decreasing([&](double x) { return std::exp(log_tail(channels, x)); }, above);
  return sum / channels;
}

void require_guard(int guard, int training, int lobe, const char* name) {
  require(training == 0 || guard >= lobe, name,
          "must cover the main lobe of the window, " + std::to_string(lobe) + " cells", guard);
}

}  // namespace

int64_t CfarDesign::order() const {
  const int64_t count = cells.num_training();
  return std::clamp<int64_t>(std::llround(rank * static_cast<double>(count)), 1, count);
}

void CfarDesign::validate() const {
  require(false_alarm_rate >= 1e-15 && false_alarm_rate <= 0.5, "false_alarm_rate", "must be in [1e-15, 0.5]",
          false_alarm_rate);
  require(rank > 0.0 && rank <= 1.0, "rank", "must be above 0 and at most 1", rank);
  require(noise.num_channels >= 1 && noise.num_channels <= kMaxChannels, "spectrum", "must have 1 to 4096 channels",
          noise.num_channels);
  const int zero_pad = noise.zero_pad;
  cells.validate(int64_t{noise.num_chirps} * zero_pad, int64_t{noise.num_samples} * zero_pad);
  require_guard(cells.guard_velocity, cells.training_velocity, main_lobe_cells(noise.window, noise.num_chirps, zero_pad),
                "guard_velocity");
  require_guard(cells.guard_range, cells.training_range, main_lobe_cells(noise.window, noise.num_samples, zero_pad),
                "guard_range");
}

double false_alarm_probability(double alpha, const std::vector<double>& eigenvalues, int num_channels) {
  // e^{-s T} has the mean prod (1 + s e)^-n; the terms of the tail's sum are its Taylor coefficients a_k at s = alpha
  // in -alpha, all positive: k a_k = n sum_m p_m a_{k-m} with power sums p_m of q = alpha e / (1 + alpha e).
  double log_first = 0.0;
  std::vector<double> ratio(eigenvalues.size());
  for (size_t i = 0; i < eigenvalues.size(); ++i) {
    log_first -= num_channels * std::log1p(alpha * eigenvalues[i]);
    ratio[i] = alpha * eigenvalues[i] / (1.0 + alpha * eigenvalues[i]);
  }
  std::vector<double> power(ratio.size(), 1.0), power_sum, term = {1.0};
  double sum = 1.0, log_scale = log_first;
  for (int k = 1; k < num_channels; ++k) {
    double of_power = 0.0, next = 0.0;
    for (size_t i = 0; i < ratio.size(); ++i) of_power += power[i] *= ratio[i];
    power_sum.push_back(of_power);
    for (int m = 1; m <= k; ++m) next += power_sum[m - 1] * term[k - m];
    term.push_back(next * num_channels / k);
    sum += term.back();
    if (sum < 1e200) continue;  // far from overflow
    log_scale += std::log(sum);
    for (double& value : term) value /= sum;
    sum = 1.0;
  }
  return std::exp(log_scale + std::log(sum));
}

CfarFactors cfar_factors(const CfarDesign& design, Job* job) {
  design.validate();
  const TrainingNoise noise(design);
  const SumMultipliers of_sum = sum_multipliers(design, noise, job);
  const double alone = design.method == CfarMethod::kCellAveraging
                           ? static_cast<double>(design.cells.num_training()) * of_sum.alone
                           : ordered_multiplier(design, noise, of_sum.alone, job);
  CfarFactors result{{}, expected_statistic(design)};
  for (const double multiplier : of_sum.coupled) result.factor.push_back(alone * multiplier / of_sum.alone);
  return result;
}

}  // namespace echopath
