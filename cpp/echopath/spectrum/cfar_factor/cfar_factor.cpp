#include "echopath/spectrum/cfar_factor/cfar_factor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/cfar_factor/training_draws.h"
#include "echopath/spectrum/cfar_factor/training_noise.h"

namespace echopath {
namespace {

constexpr int kMaxChannels = 4096;
constexpr Eigen::Index kFewDegrees = 400;  // of freedom: up to these the factors of every column are computed
constexpr int kMaxCells = 2000;            // of a window, counted without padding: beyond, a step takes too long to cancel
constexpr int kManyDraws = 8192, kFewDraws = 512;
constexpr int64_t kMostChosenFrom = 128;  // training cells of an ordered statistic; of more, all are tilted alike
constexpr int kPilotShare = 8;            // of the draws, that find where the others are to come from

// Returns the log of the probability that a sum of n unit exponential powers exceeds x: e^-x sum_{k < n} x^k / k!
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

// Returns -d log_tail / dx, which is density / tail.
double hazard(int n, double x) { return std::exp((n - 1) * std::log(x) - std::lgamma(n) - x - log_tail(n, x)); }

// Returns the x > 0 where a decreasing function falls through `value`, by secants of logarithms, in which it is nearly
// straight.
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
    // By the Illinois rule an end that stays twice counts half, so that both ends close in.
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

// Holds the form of the training cells in a basis in which it is tridiagonal and the cell under test is the first vector; a
// sum of the two forms then stays tridiagonal.
struct TridiagonalForm {
  Eigen::VectorXd diagonal, beside;

  TridiagonalForm(Eigen::MatrixXd form, const Eigen::VectorXd& cell) {
    Eigen::VectorXd mirror = cell;  // Householder: turns the cell into -+ the first vector
    mirror[0] += std::copysign(1.0, cell[0]);
    mirror.normalize();
    form -= 2.0 * mirror * (mirror.transpose() * form).eval();
    form -= 2.0 * (form * mirror).eval() * mirror.transpose();
    const Eigen::Tridiagonalization<Eigen::MatrixXd> solver(form);
    diagonal = solver.diagonal();
    beside = solver.subDiagonal();
  }

  // Returns the eigenvalues, ascending, of weight times the power of the cell - alpha times the sum of training powers. The
  // solver takes what is far below 1 for nothing and does not end where entries are far above it.
  std::vector<double> eigenvalues(double weight, double alpha) const {
    Eigen::VectorXd middle = -alpha * diagonal;
    middle[0] += weight;
    const double scale = middle.cwiseAbs().maxCoeff();
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(middle / scale, -alpha / scale * beside, Eigen::EigenvaluesOnly);
    const Eigen::VectorXd values = scale * solver.eigenvalues();
    return {values.begin(), values.end()};
  }
};

// Holds the joint form of the training cells and the cell under test, for a cell at `column`.
struct ColumnForm {
  TridiagonalForm even;
  std::vector<double> odd;  // eigenvalues of the part that the cell under test has no share in

  // Raises Cancelled between the steps, each of which takes some tenths of a second for the largest windows.
  ColumnForm(const TrainingNoise& noise, int column, Job* job)
      : even(noise.quadratic_form(column, TrainingNoise::Rows::kEven), noise.cell(column)) {
    if (job) job->throw_if_cancelled();
    const Eigen::MatrixXd form = noise.quadratic_form(column, TrainingNoise::Rows::kOdd);
    if (form.rows() == 0) return;
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(form, Eigen::EigenvaluesOnly).eigenvalues();
    for (const double value : values) odd.push_back(std::max(value, 0.0));
    if (job) job->throw_if_cancelled();
  }
};

// Returns the eigenvalues of the covariance of the training cells.
std::vector<double> covariance_eigenvalues(const ColumnForm& form) {
  std::vector<double> values = form.even.eigenvalues(0.0, 1.0);
  for (double& value : values) value = std::max(-value, 0.0);
  values.insert(values.end(), form.odd.begin(), form.odd.end());
  return values;
}

// Returns the multiplier of the sum of training powers for a cell that is independent of them.
double alone_multiplier(const std::vector<double>& eigenvalues, const CfarDesign& design) {
  return solve_decreasing([&](double alpha) {
    return false_alarm_probability(alpha, eigenvalues, design.noise.num_channels);
  }, design.false_alarm_rate);
}

// Returns the same for a cell that is correlated with them: the probability that an indefinite form of Gaussian numbers is
// positive follows from its eigenvalues, of which one is positive (Turin 1960).
double coupled_multiplier(const ColumnForm& form, const CfarDesign& design, Job* job) {
  return solve_decreasing([&](double alpha) {
    if (job) job->throw_if_cancelled();
    std::vector<double> values = form.even.eigenvalues(1.0, alpha);
    const double positive = values.back();
    values.pop_back();
    for (double& value : values) value = std::max(-value, 0.0);
    for (const double value : form.odd) values.push_back(alpha * value);
    return false_alarm_probability(1.0 / positive, values, design.noise.num_channels);
  }, design.false_alarm_rate);
}

// Returns the columns whose factors are computed, ascending and with 0 and the middle. A small window has all of them; a
// large one has those within twice the guard cells of the end, where training cells change sides, then twice as far each
// time.
std::vector<int> computed_columns(const CfarWindow& cells, Eigen::Index num_degrees) {
  const int last = cells.reach_range(), dense = num_degrees <= kFewDegrees ? last : 2 * cells.guard_range;
  std::vector<int> columns;
  const auto following = [&](int column) { return column < dense ? column + 1 : std::max(2 * column, 1); };
  for (int column = 0; column < last; column = following(column)) columns.push_back(column);
  columns.push_back(last);
  return columns;
}

// Returns values [last column + 1] on straight lines between the columns.
std::vector<double> interpolated(const std::vector<int>& columns, const std::vector<double>& values) {
  std::vector<double> all = {values.front()};
  for (size_t k = 1; k < columns.size(); ++k) {
    const int first = columns[k - 1], count = columns[k] - first;
    for (int i = 1; i <= count; ++i) all.push_back(std::lerp(values[k - 1], values[k], static_cast<double>(i) / count));
  }
  return all;
}

// Returns the factors of cell averaging, [reach_range + 1].
std::vector<double> averaging_factors(const CfarDesign& design, const TrainingNoise& noise, Job* job) {
  const std::vector<int> columns =
      computed_columns(design.cells, noise.velocity_factor().cols() * noise.range_factor().cols());
  std::vector<double> factors(columns.size());
  parallel_for(std::ssize(columns), [&](int64_t i) {
    if (job) job->throw_if_cancelled();
    const double multiplier = coupled_multiplier(ColumnForm(noise, columns[i], job), design, job);
    factors[i] = static_cast<double>(design.cells.num_training()) * multiplier;
  });
  return interpolated(columns, factors);
}

// Returns the quantile of the mean power of `num_channels` channels that the order statistic estimates.
double expected_quantile(const CfarDesign& design) {
  const int channels = design.noise.num_channels;
  const double above = 1.0 - static_cast<double>(design.order()) / (static_cast<double>(design.cells.num_training()) + 1.0);
  return solve_decreasing([&](double x) { return std::exp(log_tail(channels, x)); }, above) / channels;
}

double mean_statistic(const std::vector<TrainingDraw>& draws) {
  double sum = 0.0;
  for (const TrainingDraw& draw : draws) sum += draw.statistic;
  return sum / static_cast<double>(draws.size());
}

// Returns the tilt of a sum over cells that falls as the probability of a false alarm does, of a cell beyond alpha times the
// statistic, where false alarms are likeliest: at the mean s of the cells at which s times that probability is the greatest.
// The mean of d free cells has the density s^(d n) e^(-d s) for n channels. `over_mean` is what the statistic is over the
// mean.
double tilt_of(double num_cells, double free_cells, double alpha, double over_mean, int num_channels) {
  const double steepness = alpha * over_mean;
  const double mean = solve_decreasing([&](double s) {
    return free_cells * num_channels / (s * (free_cells + steepness * hazard(num_channels, steepness * s)));
  }, 1.0);
  return steepness * hazard(num_channels, steepness * mean) / num_cells;
}

// Finds the factor of a statistic other than the mean for a cell in the middle that is independent of the training cells.
class DrawnFactor {
 public:
  DrawnFactor(const CfarDesign& design, const TrainingNoise& noise)
      : design_(design), noise_(noise),
        cells_are_chosen_(design.method == CfarMethod::kOrderedStatistic && design.cells.num_training() <= kMostChosenFrom) {
    if (design.method == CfarMethod::kOrderedStatistic) {
      groups_ = {{training_cells(design.cells), noise.quadratic_form(design.cells.reach_range())}};
      return;
    }
    const auto [first, second] = halves_of_training_cells(design.cells);
    groups_ = {{first, noise.form_of_half(0)}, {second, noise.form_of_half(1)}};
    if (design.method == CfarMethod::kSmallestOf) return;
    groups_[0].cells.insert(groups_[0].cells.end(), second.begin(), second.end());
    groups_[0].form += groups_[1].form;
    groups_.pop_back();
  }

  // Few draws find where false alarms happen, from a first guess on; the last ones come from there.
  double factor(double guess, Job* job) {
    for (const int share : {kPilotShare, 1}) guess = factor_of(draws_at(guess, share, job));
    return guess;
  }

  // Returns the statistic for noise of unit mean power: the mean, or the quantile that an ordered one estimates.
  double statistic(Job* job) const {
    if (design_.method == CfarMethod::kOrderedStatistic) return expected_quantile(design_);
    std::vector<TiltedGroup> untilted = {groups_.front()};
    untilted.front().tilt = 0.0;
    return mean_statistic(draws_of_groups(design_, noise_, untilted, count(2), job)) / num_channels();
  }

 private:
  int num_channels() const { return design_.noise.num_channels; }
  int count(int share) const { return std::max(kFewDraws, kManyDraws / num_channels() / share); }

  // Returns draws from where false alarms of a factor happen.
  std::vector<TrainingDraw> draws_at(double factor, int share, Job* job) {
    if (cells_are_chosen_) {
      // Low cells lie all over what is below the ordered statistic.
      const double over_mean = (num_channels() + 1.0) / num_channels(), order = static_cast<double>(design_.order());
      return draws_of_chosen_cells(design_, noise_, tilt_of(order, order, factor, over_mean, num_channels()), count(share),
                                   job);
    }
    const double over_mean = design_.method == CfarMethod::kOrderedStatistic ? expected_quantile(design_) : 1.0;
    for (TiltedGroup& group : groups_) {
      const double free_cells = std::pow(group.form.trace(), 2) / group.form.squaredNorm();
      group.tilt = tilt_of(static_cast<double>(group.cells.size()), free_cells, factor, over_mean, num_channels());
    }
    return draws_of_groups(design_, noise_, groups_, count(share), job);
  }

  double factor_of(const std::vector<TrainingDraw>& draws) const {
    return solve_decreasing([&](double alpha) {
      double sum = 0.0;
      for (const TrainingDraw& one : draws)
        sum += std::exp(one.log_weight + log_tail(num_channels(), alpha * one.statistic));
      return sum / static_cast<double>(draws.size());
    }, design_.false_alarm_rate);
  }

  const CfarDesign& design_;
  const TrainingNoise& noise_;
  const bool cells_are_chosen_;
  std::vector<TiltedGroup> groups_;
};

void require_guard(int guard, int training, int lobe, const char* name) {
  require(training == 0 || guard >= lobe, name, "must cover the main lobe of the window, " + std::to_string(lobe) + " cells",
          guard);
}

}  // namespace

int64_t CfarDesign::order() const {
  const int64_t count = cells.num_training();
  return std::clamp<int64_t>(std::llround(rank * static_cast<double>(count)), 1, count);
}

void CfarDesign::validate() const {
  require(false_alarm_rate >= kLeastRate && false_alarm_rate <= 0.5, "false_alarm_rate", "must be in [1e-15, 0.5]",
          false_alarm_rate);
  require(rank > 0.0 && rank <= 1.0, "rank", "must be above 0 and at most 1", rank);
  require(noise.num_channels >= 1 && noise.num_channels <= kMaxChannels, "spectrum", "must have 1 to 4096 channels",
          noise.num_channels);
  const int zero_pad = noise.zero_pad;
  cells.validate(int64_t{noise.num_chirps} * zero_pad, int64_t{noise.num_samples} * zero_pad);
  const int64_t num_cells = int64_t{cells.num_rows()} * cells.num_columns() / (zero_pad * zero_pad);
  require(num_cells <= kMaxCells, "training_range",
          "guard and training cells about one under test must be at most 2000 of an unpadded map, with training_velocity",
          num_cells);
  require_guard(cells.guard_velocity, cells.training_velocity,
                main_lobe_cells(noise.window.velocity, noise.num_chirps, zero_pad), "guard_velocity");
  require_guard(cells.guard_range, cells.training_range, main_lobe_cells(noise.window.range, noise.num_samples, zero_pad),
                "guard_range");
}

double false_alarm_probability(double alpha, const std::vector<double>& eigenvalues, int num_channels) {
  // e^{-s T} has the mean prod (1 + s e)^-n. The terms of the tail's sum are its Taylor coefficients a_k at s = alpha in
  // -alpha, which are all positive: k a_k = n sum_m p_m a_{k-m} with power sums p_m of q = alpha e / (1 + alpha e).
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
  CfarFactors result{averaging_factors(design, noise, job)};
  if (design.method == CfarMethod::kCellAveraging) return result;
  const double number = static_cast<double>(design.cells.num_training());
  const double of_mean =
      number * alone_multiplier(covariance_eigenvalues(ColumnForm(noise, design.cells.reach_range(), job)), design);
  DrawnFactor drawn(design, noise);
  const double of_statistic = drawn.factor(of_mean, job);
  for (double& factor : result.factor) factor *= of_statistic / of_mean;
  result.statistic = drawn.statistic(job);
  return result;
}

}  // namespace echopath
