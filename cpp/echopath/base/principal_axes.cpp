#include "echopath/base/principal_axes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace echopath {

// Two rows are tridiagonal as they are. Eigen's `compute` would bring them to that form first, which changes no bit of
// them and takes the compiler 5 s for each file that calls it.
PrincipalAxes principal_axes(const Eigen::Matrix2d& symmetric) {
  const Eigen::Vector2d diagonal = symmetric.diagonal();
  const double beside = symmetric(1, 0);
  const double largest = std::max({std::abs(diagonal[0]), std::abs(diagonal[1]), std::abs(beside)});
  const double scale = largest == 0.0 ? 1.0 : largest;  // squares of tiny or huge values would leave the range of numbers
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeFromTridiagonal(diagonal / scale, Eigen::Matrix<double, 1, 1>(beside / scale));
  return {solver.eigenvalues() * scale, solver.eigenvectors()};
}

}  // namespace echopath
