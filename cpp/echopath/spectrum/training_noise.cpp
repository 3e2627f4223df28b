#include "echopath/spectrum/training_noise.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdlib>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

using Eigen::MatrixXd;

constexpr double kNegligible = 1e-6;  // of the largest eigenvalue: power of a degree of freedom that changes nothing

// F with F F^T = correlation matrix of `num_cells` neighbours.
MatrixXd factor_of(const std::vector<double>& samples, int zero_pad, int num_cells) {
  const std::vector<double> correlation = noise_correlation(samples, zero_pad, num_cells);
  MatrixXd matrix(num_cells, num_cells);
  for (int i = 0; i < num_cells; ++i) {
    for (int j = 0; j < num_cells; ++j) matrix(i, j) = correlation[std::abs(i - j)];
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  const Eigen::VectorXd& values = solver.eigenvalues();
  Eigen::Index first = 0;
  while (values[first] <= kNegligible * values[num_cells - 1]) ++first;
  const Eigen::Index rank = num_cells - first;
  return solver.eigenvectors().rightCols(rank) * values.tail(rank).cwiseSqrt().asDiagonal();
}

// sum of f f^T over rows [first, first + count) of a factor
MatrixXd form_of(const MatrixXd& factor, CellSpan rows) {
  const auto block = factor.middleRows(rows.first, rows.count);
  return block.transpose() * block;
}

MatrixXd kronecker(const MatrixXd& a, const MatrixXd& b) {
  MatrixXd product(a.rows() * b.rows(), a.cols() * b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      product.block(i * b.rows(), j * b.cols(), b.rows(), b.cols()) = a(i, j) * b;
    }
  }
  return product;
}

}  // namespace

std::vector<double> noise_correlation(const std::vector<double>& samples, int zero_pad, int num_lags) {
  const int n = static_cast<int>(samples.size());
  double power = 0.0, middle = 0.0;
  for (int i = 0; i < n; ++i) power += samples[i] * samples[i];
  for (int i = 0; i < n; ++i) middle += i * samples[i] * samples[i] / power;
  std::vector<double> correlation(num_lags);
  for (int lag = 0; lag < num_lags; ++lag) {
    for (int i = 0; i < n; ++i) {
      const double turns = (i - middle) * lag / (static_cast<double>(n) * zero_pad);
      correlation[lag] += samples[i] * samples[i] / power * std::cos(kTwoPi * turns);
    }
  }
  return correlation;
}

TrainingNoise::TrainingNoise(const CfarDesign& design) : cells_(design.cells) {
  const MapNoise& noise = design.noise;
  const int rows = cells_.num_rows(), columns = cells_.num_columns();
  velocity_factor_ = factor_of(window_samples(noise.window, noise.num_chirps), noise.zero_pad, rows);
  range_factor_ = factor_of(window_samples(noise.window, noise.num_samples), noise.zero_pad, columns);
  inner_rows_ = form_of(velocity_factor_, {cells_.training_velocity, 2 * cells_.guard_velocity + 1});
  outer_rows_ = form_of(velocity_factor_, {0, rows}) - inner_rows_;
}

MatrixXd TrainingNoise::quadratic_form(int column) const {
  const auto [left, right] = inner_spans(cells_, column, cells_.num_columns());
  const MatrixXd inner = form_of(range_factor_, left) + form_of(range_factor_, right);
  return kronecker(inner_rows_, inner) + kronecker(outer_rows_, form_of(range_factor_, {0, cells_.num_columns()}));
}

Eigen::VectorXd TrainingNoise::cell(int column) const {
  return kronecker(velocity_factor_.row(cells_.reach_velocity()), range_factor_.row(column)).transpose();
}

}  // namespace echopath
