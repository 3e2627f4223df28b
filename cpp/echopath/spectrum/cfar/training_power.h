#pragma once
// Evaluates the training cells of every cell of a power map.
#include <cstdint>
#include <vector>

#include "echopath/spectrum/cfar_factor/cfar_window.h"

namespace echopath {

// Slides a window over a map of powers [V, R], whose velocity axis wraps around.
class TrainingPower {
 public:
  // Both must outlive it; `power` holds num_velocities x num_ranges values.
  TrainingPower(const std::vector<double>& power, int64_t num_velocities, int64_t num_ranges, const CfarWindow& window);

  // Prepares the sums over a row of the map that `sums` needs. Call it once for each velocity, in any order.
  void prepare_row(int64_t velocity);
  // Writes the sum [R] of the training cells of each cell of a row. It only adds, so that a strong echo leaves no rounding
  // behind. All rows must be prepared.
  void sums(int64_t velocity, double* sum) const;

  // Returns whether at least `order` training cells are below `limit`, that is, whether the order-th in ascending order is.
  bool is_order_below(int64_t velocity, int64_t range, int64_t order, double limit) const;
  // Returns the order-th training cell in ascending order, counted from 1.
  double ordered(int64_t velocity, int64_t range, int64_t order) const;

 private:
  template <class Visit>
  bool visit_spans(int64_t velocity, int64_t range, Visit visit) const;
  const double* row(int64_t velocity) const;

  const std::vector<double>& power_;
  const int64_t num_velocities_, num_ranges_;
  const CfarWindow& window_;
  std::vector<double> inner_, outer_;  // [V, R] sums over the spans of a row
};

}  // namespace echopath
