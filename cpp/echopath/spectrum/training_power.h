#pragma once
// What the training cells of every cell of a power map say.
#include <cstdint>
#include <vector>

#include "echopath/spectrum/cfar_window.h"

namespace echopath {

// A map of powers [V, R] and the window that slides over it; velocity is a circle.
class TrainingPower {
 public:
  // Both must outlive it; `power` holds num_velocities x num_ranges values.
  TrainingPower(const std::vector<double>& power, int64_t num_velocities, int64_t num_ranges, const CfarWindow& window);

  // Sums over each row of the map, which `sums` needs: call once for each velocity, in any order.
  void prepare_row(int64_t velocity);
  // sum [R] of the training cells of each cell of a row; only additions, so that a strong echo leaves no rounding behind.
  // All rows must be prepared.
  void sums(int64_t velocity, double* sum) const;

  // Whether at least `order` training cells are below `limit`, that is the order-th of them in ascending order.
  bool is_order_below(int64_t velocity, int64_t range, int64_t order, double limit) const;
  // The order-th training cell in ascending order, counted from 1.
  double ordered(int64_t velocity, int64_t range, int64_t order) const;

 private:
  template <class Visit>
  bool visit_spans(int64_t velocity, int64_t range, Visit visit) const;
  const double* row(int64_t velocity) const;
  double span_sum(int64_t velocity, CellSpan span) const;

  const std::vector<double>& power_;
  const int64_t num_velocities_, num_ranges_;
  const CfarWindow& window_;
  std::vector<double> inner_, outer_;  // [V, R] sums over the spans of a row
};

}  // namespace echopath
