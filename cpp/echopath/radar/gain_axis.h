#pragma once
// Interpolates along one axis of a table of gains. Internal to the module.
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace echopath {

// Divides an axis into cells between neighbouring samples. In each the interpolant is a cubic with the values of its samples
// and slopes of parabolas through three samples; at an end of the axis it becomes the parabola through the last three.
class GainAxis {
 public:
  struct Cell {
    double begin, step;               // rad
    std::array<int, 4> index;         // of the samples before, at both ends and behind
    std::array<double, 4> slopes[2];  // weights of these in the slopes at both ends, times the step

    // Returns the weights of the four samples at an angle of the cell.
    std::array<double, 4> weights(double angle) const {
      const double t = (angle - begin) / step, s = 1.0 - t;
      std::array<double, 4> weight;
      for (size_t i = 0; i < 4; ++i) weight[i] = t * s * (s * slopes[0][i] - t * slopes[1][i]);
      weight[1] += s * s * (1.0 + 2.0 * t);
      weight[2] += t * t * (3.0 - 2.0 * t);
      return weight;
    }
  };

  GainAxis() = default;
  // angles: [N] rad, ascending, N >= 2
  // period: samples of a ring, of which the first follows the last one after a turn; 0: the axis is open
  GainAxis(const std::vector<double>& angles, int period);

  const std::vector<Cell>& cells() const { return cells_; }
  // Returns the number of the cell with an angle of the axis. Samples are mostly even, so that it is where it would be if
  // they were, or next to it.
  size_t cell_at(double angle) const {
    const double along = (angle - cells_.front().begin) * cells_per_radian_, last = static_cast<double>(cells_.size() - 1);
    auto number = static_cast<size_t>(std::clamp(along, 0.0, last));
    while (number > 0 && angle < cells_[number].begin) --number;
    while (number + 1 < cells_.size() && angle >= cells_[number + 1].begin) ++number;
    return number;
  }

 private:
  std::vector<Cell> cells_;
  double cells_per_radian_ = 0.0;
};

}  // namespace echopath
