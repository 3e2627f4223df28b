#pragma once
// The joint distribution of the noise in the training cells of a CFAR window.
#include <Eigen/Core>
#include <vector>

#include "echopath/spectrum/cfar_factor.h"

namespace echopath {

// Noise in the cells of the window's rectangle [rows, columns] is velocity_factor G range_factor^T with G white circular
// Gaussian numbers of unit power: as many as the windowed transforms have degrees of freedom there, however fine the cells.
class TrainingNoise {
 public:
  enum class Rows { kAll, kEven, kOdd };

  explicit TrainingNoise(const CfarDesign& design);

  // For a cell `column` cells from the rectangle's left end (reach_range: in its middle):
  // B with sum of training powers = g^H B g, g the entries of G row by row. The window is symmetric in velocity: numbers of
  // even and of odd patterns of its rows are not mixed by B, and the cell under test has only the even ones.
  Eigen::MatrixXd quadratic_form(int column, Rows rows = Rows::kAll) const;
  Eigen::VectorXd cell(int column) const;  // f of unit length, of the even ones: the cell under test is f^T g

  // [rows, degrees of freedom], even ones first
  const Eigen::MatrixXd& velocity_factor() const { return velocity_factor_; }
  const Eigen::MatrixXd& range_factor() const { return range_factor_; }        // [columns, degrees of freedom]

 private:
  Eigen::MatrixXd of(const Eigen::MatrixXd& form, Rows rows) const;

  CfarWindow cells_;
  Eigen::Index num_even_ = 0;
  Eigen::MatrixXd velocity_factor_, range_factor_;
  Eigen::MatrixXd inner_rows_, outer_rows_;  // sum of f f^T over rows within guard_velocity, and beyond
};

// Correlation of noise in cells `lag` apart, [num_lags], of a windowed transform of n samples padded to n zero_pad: real
// but for the phase of the window's centre, which a phase per cell takes up.
std::vector<double> noise_correlation(const std::vector<double>& samples, int zero_pad, int num_lags);

}  // namespace echopath
