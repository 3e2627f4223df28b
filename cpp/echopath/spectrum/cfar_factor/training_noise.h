#pragma once
// Models the joint distribution of the noise in the training cells of a CFAR window.
#include <Eigen/Core>
#include <vector>

#include "echopath/spectrum/cfar_factor/cfar_factor.h"

namespace echopath {

// Noise in the cells of the window's rectangle [rows, columns] is velocity_factor G range_factor^T, where G holds white
// circular Gaussian numbers of unit power: as many as the windowed transforms have degrees of freedom there, however fine
// the cells.
class TrainingNoise {
 public:
  enum class Rows { kAll, kEven, kOdd };

  explicit TrainingNoise(const CfarDesign& design);

  // Returns B for a cell `column` cells from the rectangle's left end (reach_range: in its middle), where the sum of
  // training powers is g^H B g and g holds the entries of G row by row. The window is symmetric in velocity: B does not mix
  // the numbers of even and of odd patterns of its rows, and the cell under test has only the even ones.
  Eigen::MatrixXd quadratic_form(int column, Rows rows = Rows::kAll) const;
  Eigen::VectorXd cell(int column) const;  // unit f of the even ones: the cell under test is f^T g
  // Returns B for the sum over a half of the training cells of a cell in the middle (CfarWindow::half_of).
  Eigen::MatrixXd form_of_half(int half) const;
  // Returns B for the sum of the powers of some cells of the rectangle, given by row * num_columns + column. Costs their
  // number times the square of the degrees of freedom.
  Eigen::MatrixXd form_of_cells(const std::vector<int>& cells) const;

  // [rows, degrees of freedom], even ones first
  const Eigen::MatrixXd& velocity_factor() const { return velocity_factor_; }
  const Eigen::MatrixXd& range_factor() const { return range_factor_; }  // [columns, degrees of freedom]

 private:
  Eigen::MatrixXd of(const Eigen::MatrixXd& form, Rows rows) const;

  CfarWindow cells_;
  Eigen::Index num_even_ = 0;
  Eigen::MatrixXd velocity_factor_, range_factor_;
  Eigen::MatrixXd inner_rows_, outer_rows_;  // sums of f f^T over rows within guard_velocity, and beyond
};

// Returns the correlation of noise in cells `lag` apart, [num_lags], for a windowed transform of n samples padded to n
// zero_pad. It is real but for the phase of the window's centre, which a phase per cell takes up.
std::vector<double> noise_correlation(const std::vector<double>& samples, int zero_pad, int num_lags);

}  // namespace echopath
