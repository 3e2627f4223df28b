#pragma once
// Gives the principal axes of a symmetric matrix of two rows.
#include <Eigen/Core>

namespace echopath {

// Holds eigenvalues, ascending, and unit eigenvectors as columns in the same order.
struct PrincipalAxes {
  Eigen::Vector2d values;
  Eigen::Matrix2d axes;
};

// Reads the lower triangle alone. The values have the unit of the matrix. A multiple of the unit matrix has the axes x
// and y.
PrincipalAxes principal_axes(const Eigen::Matrix2d& symmetric);

}  // namespace echopath
