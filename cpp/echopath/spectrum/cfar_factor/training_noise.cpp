#include "echopath/spectrum/cfar_factor/training_noise.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdlib>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

using Eigen::MatrixXd;

constexpr double kNegligible = 1e-6;  // of the largest row sum: degrees of freedom with less power change nothing

// Returns the correlation matrix of `num_cells` neighbours.
MatrixXd correlation_of(const std::vector<double>& samples, int zero_pad, int num_cells) {
  const std::vector<double> correlation = noise_correlation(samples, zero_pad, num_cells);
  MatrixXd matrix(num_cells, num_cells);
  for (int i = 0; i < num_cells; ++i) {
    for (int j = 0; j < num_cells; ++j) matrix(i, j) = correlation[std::abs(i - j)];
  }
  return matrix;
}

// Returns F with F F^T = a correlation matrix, within the space that orthonormal columns span.
MatrixXd factor_of(const MatrixXd& correlation, const MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(columns.transpose() * correlation * columns);
  const Eigen::VectorXd& values = solver.eigenvalues();
  Eigen::Index first = 0;
  while (first < values.size() && values[first] <= kNegligible * correlation.cwiseAbs().rowwise().sum().maxCoeff()) ++first;
  const Eigen::Index rank = values.size() - first;
  return columns * solver.eigenvectors().rightCols(rank) * values.tail(rank).cwiseSqrt().asDiagonal();
}

// Returns orthonormal columns of an odd number of cells that are even (sign 1) or odd (-1) about the middle.
MatrixXd symmetric_columns(int num_cells, double sign) {
  const int middle = num_cells / 2;
  MatrixXd columns = MatrixXd::Zero(num_cells, sign > 0.0 ? middle + 1 : middle);
  for (int k = 1; k <= middle; ++k) {
    columns(middle + k, k - 1) = std::sqrt(0.5);
    columns(middle - k, k - 1) = sign * std::sqrt(0.5);
  }
  if (sign > 0.0) columns(middle, middle) = 1.0;
  return columns;
}

// Returns the sum of f f^T over rows [first, first + count) of a factor.
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
  const MatrixXd along_velocity =
      correlation_of(window_samples(noise.window.velocity, noise.num_chirps), noise.zero_pad, rows);
  const MatrixXd even = factor_of(along_velocity, symmetric_columns(rows, 1.0));
  const MatrixXd odd = factor_of(along_velocity, symmetric_columns(rows, -1.0));
  num_even_ = even.cols();
  velocity_factor_.resize(rows, even.cols() + odd.cols());
  velocity_factor_ << even, odd;
  range_factor_ = factor_of(correlation_of(window_samples(noise.window.range, noise.num_samples), noise.zero_pad, columns),
                            MatrixXd::Identity(columns, columns));
  inner_rows_ = form_of(velocity_factor_, {cells_.training_velocity, 2 * cells_.guard_velocity + 1});
  outer_rows_ = form_of(velocity_factor_, {0, rows}) - inner_rows_;
}

MatrixXd TrainingNoise::of(const MatrixXd& form, Rows rows) const {
  if (rows == Rows::kAll) return form;
  return rows == Rows::kEven ? form.topLeftCorner(num_even_, num_even_)
                             : form.bottomRightCorner(form.rows() - num_even_, form.cols() - num_even_);
}

MatrixXd TrainingNoise::quadratic_form(int column, Rows rows) const {
  const auto [left, right] = inner_spans(cells_, column, cells_.num_columns());
  const MatrixXd inner = form_of(range_factor_, left) + form_of(range_factor_, right);
  const MatrixXd whole = form_of(range_factor_, {0, cells_.num_columns()});
  return kronecker(of(inner_rows_, rows), inner) + kronecker(of(outer_rows_, rows), whole);
}

MatrixXd TrainingNoise::form_of_half(int half) const {
  const int rows = cells_.num_rows(), columns = cells_.num_columns();
  if (cells_.training_range == 0) {
    const CellSpan side{half == 0 ? 0 : rows - cells_.training_velocity, cells_.training_velocity};
    return kronecker(form_of(velocity_factor_, side), form_of(range_factor_, {0, columns}));
  }
  const auto side = [&](int count) { return form_of(range_factor_, {half == 0 ? 0 : columns - count, count}); };
  return kronecker(inner_rows_, side(cells_.training_range)) + kronecker(outer_rows_, side(cells_.reach_range()));
}

MatrixXd TrainingNoise::form_of_cells(const std::vector<int>& cells) const {
  MatrixXd factors(std::ssize(cells), velocity_factor_.cols() * range_factor_.cols());
  for (Eigen::Index i = 0; i < factors.rows(); ++i) {
    const int row = cells[i] / cells_.num_columns(), column = cells[i] % cells_.num_columns();
    factors.row(i) = kronecker(velocity_factor_.row(row), range_factor_.row(column));
  }
  return factors.transpose() * factors;
}

Eigen::VectorXd TrainingNoise::cell(int column) const {
  return kronecker(velocity_factor_.row(cells_.reach_velocity()).head(num_even_), range_factor_.row(column)).transpose();
}

}  // namespace echopath
