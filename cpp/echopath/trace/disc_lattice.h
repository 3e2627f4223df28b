#pragma once
// Low-discrepancy points in the unit disc: a shifted algebraic lattice.
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace echopath {

// The lattice {(m + n phi, m + n phi')} of the golden ratio phi and its conjugate (Frolov 1976): no line of it is parallel to
// an edge of small slope, its cells are nearly square, and unlike a spiral it looks the same everywhere. `shift` [2] in
// [0, 1) moves it within its cell (Cranley and Patterson 1976). The cell is chosen so that exactly num_points fall into the
// disc; its area then differs a little from pi / num_points. Neighbours in order are neighbours in the disc.
class DiscLattice {
 public:
  DiscLattice(int64_t num_points, const Eigen::Vector2d& shift);
  int64_t size() const { return first_.back(); }
  double cell_area() const { return cell_area_; }  // what one point stands for
  Eigen::Vector2d point(int64_t index) const;  // index in [0, size())

 private:
  void fill(double cell_area, const Eigen::Vector2d& shift);

  double cell_area_ = 0.0;
  Eigen::Vector2d step_ = Eigen::Vector2d::Zero();  // along a row
  std::vector<Eigen::Vector2d> rows_;               // first point of each row
  std::vector<int64_t> first_;  // [rows + 1] index of the first point of each row
};

}  // namespace echopath
