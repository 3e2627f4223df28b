#include "echopath/trace/disc_lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echopath {

DiscLattice::DiscLattice(int64_t num_points, const Eigen::Vector2d& shift) : first_{0} {
  if (num_points <= 0) return;
  constexpr double kPhi = std::numbers::phi, kConjugate = 1.0 - std::numbers::phi;
  // The cell has area sqrt(5) scale^2.
  const double scale = std::sqrt(std::numbers::pi / (std::sqrt(5.0) * static_cast<double>(num_points)));
  step_ = scale * Eigen::Vector2d(1.0, 1.0);
  const Eigen::Vector2d across = scale * Eigen::Vector2d(kPhi, kConjugate);
  const Eigen::Vector2d origin = shift[0] * step_ + shift[1] * across;
  const double spacing = scale * std::sqrt(2.5);  // of the rows: cell area / |step|
  const auto reach = static_cast<int64_t>(1.0 / spacing) + 2;
  for (int64_t n = -reach; n <= reach; ++n) {
    const Eigen::Vector2d base = origin + static_cast<double>(n) * across;
    const double middle = -base.dot(step_) / step_.squaredNorm();  // in steps, where the row is nearest to the centre
    const double miss = (base + middle * step_).squaredNorm();
    if (miss >= 1.0) continue;
    const double half = std::sqrt((1.0 - miss) / step_.squaredNorm());
    const double low = std::ceil(middle - half), high = std::floor(middle + half);
    if (high < low) continue;
    rows_.push_back(base + low * step_);
    first_.push_back(first_.back() + static_cast<int64_t>(high - low) + 1);
  }
}

Eigen::Vector2d DiscLattice::point(int64_t index) const {
  const auto row = static_cast<size_t>(std::upper_bound(first_.begin(), first_.end(), index) - first_.begin()) - 1;
  return rows_[row] + static_cast<double>(index - first_[row]) * step_;
}

}  // namespace echopath
