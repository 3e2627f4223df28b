#pragma once
// Evaluates the two halves of the training cells of every cell of a power map.
#include <array>
#include <cstdint>
#include <vector>

#include "echopath/spectrum/cfar_factor/cfar_window.h"

namespace echopath {

// Slides the halves of a window (CfarWindow::half_of) over a map of powers [V, R], whose velocity axis wraps around. At the
// ends of the range axis, where cells of one side are missing, halves of the same number are made of what is there, in the
// order of ranges.
class TrainingHalves {
 public:
  // Both must outlive it; `power` holds num_velocities x num_ranges values.
  TrainingHalves(const std::vector<double>& power, int64_t num_velocities, int64_t num_ranges, const CfarWindow& window);

  // Prepares the sums over a row of the map that `sums` needs. Call it once for each velocity, in any order.
  void prepare_row(int64_t velocity);
  // Writes the sums [R] of both halves of the training cells of each cell of a row. All rows must be prepared.
  void sums(int64_t velocity, const std::array<double*, 2>& sum) const;

 private:
  // Returns the training cells of both halves in a row within guard_velocity, each in two spans, or in a row beyond.
  std::array<std::array<CellSpan, 2>, 2> inner_halves(int64_t range) const;
  std::array<CellSpan, 2> outer_halves(int64_t range) const;
  bool is_split_in_range() const { return window_.training_range > 0; }

  const std::vector<double>& power_;
  const int64_t num_velocities_, num_ranges_;
  const CfarWindow& window_;
  std::array<std::vector<double>, 2> inner_, outer_;  // by half: [V, R] sums over the spans of a row
};

}  // namespace echopath
