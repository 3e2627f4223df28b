#include "echopath/trace/launch/launch_lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echopath {

LaunchLattice::LaunchLattice(const LaunchDomain& domain, int64_t num_points, const std::vector<Eigen::Vector2d>& shifts)
    : domain_(domain), first_{0} {
  end_of_batch_.assign(shifts.size(), 0);
  if (num_points <= 0) return;
  const auto wanted = static_cast<double>(num_points), spare = static_cast<double>(shifts.size() - 1);
  // The number of points in the domain jumps by one as the cell shrinks, so bisection finds where it is right. It differs
  // from the mean by no more than the cells along the rim.
  const double length = domain.is_disc() ? 1.0 : std::sqrt(domain.half.maxCoeff() / domain.half.minCoeff());
  const double margin = std::sqrt(wanted) * std::max(1.0, length) + 2.0 + spare;
  double low = std::max(0.25, wanted - margin), high = wanted + margin;
  for (int i = 0; i < 100; ++i) {
    const double middle = i == 0 ? wanted : 0.5 * (low + high);
    fill(domain.area() / middle, shifts);
    if (size() == num_points) return;
    (size() < num_points ? low : high) = middle;
  }
}

void LaunchLattice::fill(double cell_area, const std::vector<Eigen::Vector2d>& shifts) {
  cell_area_ = cell_area;
  rows_.clear();
  first_.assign(1, 0);
  end_of_batch_.clear();
  for (const Eigen::Vector2d& shift : shifts) {
    add_rows(cell_area * static_cast<double>(shifts.size()), shift);
    end_of_batch_.push_back(size());
  }
}

// Adds the rows of one batch, whose points have cells of that area.
void LaunchLattice::add_rows(double cell_area, const Eigen::Vector2d& shift) {
  constexpr double kPhi = std::numbers::phi, kConjugate = 1.0 - std::numbers::phi;
  const double scale = std::sqrt(cell_area / std::sqrt(5.0));  // the lattice itself has cells of sqrt(5)
  step_ = scale * Eigen::Vector2d(1.0, 1.0);
  const Eigen::Vector2d across = scale * Eigen::Vector2d(kPhi, kConjugate);
  const Eigen::Vector2d origin = shift[0] * step_ + shift[1] * across;
  const double spacing = cell_area / step_.norm();  // of the rows
  const double radius = domain_.is_disc() ? 1.0 : domain_.half.norm();
  const auto reach = static_cast<int64_t>(radius / spacing) + 2;
  for (int64_t n = -reach; n <= reach; ++n) {
    const Eigen::Vector2d base = origin + static_cast<double>(n) * across;
    double begin, end;
    if (!find_row(base, begin, end)) continue;
    const double first = std::ceil(begin), last = std::floor(end);
    if (last < first) continue;
    rows_.push_back(base + first * step_);
    first_.push_back(first_.back() + static_cast<int64_t>(last - first) + 1);
  }
}

// Finds where the row through `base` enters and leaves the domain, in steps. Returns false where it misses the domain.
bool LaunchLattice::find_row(const Eigen::Vector2d& base, double& begin, double& end) const {
  if (!domain_.is_disc()) {
    const Eigen::Array2d one = (-domain_.half - base).array() / step_.array(),
                         other = (domain_.half - base).array() / step_.array();
    begin = one.min(other).maxCoeff();
    end = one.max(other).minCoeff();
    return begin <= end;
  }
  const double middle = -base.dot(step_) / step_.squaredNorm();  // where the row is nearest to the centre
  const double miss = (base + middle * step_).squaredNorm();
  if (miss >= 1.0) return false;
  const double half = std::sqrt((1.0 - miss) / step_.squaredNorm());
  begin = middle - half;
  end = middle + half;
  return true;
}

size_t LaunchLattice::row_of(int64_t index) const {
  return static_cast<size_t>(std::ranges::upper_bound(first_, index) - first_.begin()) - 1;
}

Eigen::Vector2d LaunchLattice::point(int64_t index) const {
  const size_t row = row_of(index);
  return rows_[row] + static_cast<double>(index - first_[row]) * step_;
}

void LaunchLattice::points(int64_t first, int64_t count, double* x, double* y) const {
  for (size_t row = row_of(first); count > 0; ++row) {
    const int64_t num_here = std::min(count, first_[row + 1] - first);
    for (int64_t i = 0; i < num_here; ++i) {
      const auto steps = static_cast<double>(first - first_[row] + i);
      x[i] = rows_[row][0] + steps * step_[0];
      y[i] = rows_[row][1] + steps * step_[1];
    }
    first += num_here;
    count -= num_here;
    x += num_here;
    y += num_here;
  }
}

int LaunchLattice::batch_of(int64_t index) const {
  return static_cast<int>(std::ranges::upper_bound(end_of_batch_, index) - end_of_batch_.begin());
}

}  // namespace echopath
