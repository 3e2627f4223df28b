#pragma once
// Spreads low-discrepancy points over a disc or a rectangle: a shifted algebraic lattice.
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "echopath/trace/launch/launch_points.h"

namespace echopath {

// Uses the lattice {(m + n phi, m + n phi')} of the golden ratio phi and its conjugate (Frolov 1976): no line of it is
// parallel to an edge of small slope, its cells are nearly square, and unlike a spiral it looks the same everywhere. `shift`
// [2] in [0, 1) moves it within its cell (Cranley and Patterson 1976). The cell is chosen so that exactly num_points fall
// into the domain; its area then differs a little from the domain's over num_points. Neighbours in order are neighbours in
// the domain. Several shifts give as many independent batches, one after the other. Their lattices have one and the same
// wider cell, so that each batch stands for the domain in the same way and their sizes differ by a few points.
class LaunchLattice : public LaunchPoints {
 public:
  LaunchLattice(const LaunchDomain& domain, int64_t num_points, const std::vector<Eigen::Vector2d>& shifts);
  int64_t size() const override { return first_.back(); }
  double cell_area() const override { return cell_area_; }
  Eigen::Vector2d point(int64_t index) const override;
  void points(int64_t first, int64_t count, double* x, double* y) const override;
  int batch_of(int64_t index) const override;

 private:
  size_t row_of(int64_t index) const;
  void fill(double cell_area, const std::vector<Eigen::Vector2d>& shifts);
  void add_rows(double cell_area, const Eigen::Vector2d& shift);
  bool find_row(const Eigen::Vector2d& base, double& begin, double& end) const;

  LaunchDomain domain_;
  double cell_area_ = 0.0;
  Eigen::Vector2d step_ = Eigen::Vector2d::Zero();  // along a row
  std::vector<Eigen::Vector2d> rows_;               // first point of each row
  std::vector<int64_t> first_;                      // [rows + 1] index of the first point of each row
  std::vector<int64_t> end_of_batch_;               // [batches] index behind the last point of each
};

}  // namespace echopath
