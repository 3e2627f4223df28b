#include "echopath/spectrum/cfar/moving_sums.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "echopath/base/lanes/simd.h"

namespace echopath {
namespace {

// Adds values[i] + ... + values[i + width - 1] to sum[i] for i in [0, num_sums), by doubling: `level` [count], which holds
// the values at first, holds sums of 1, 2, 4, ... numbers in turn.
ECHOPATH_INLINE void add_levels(double* level, int64_t count, int64_t width, int64_t num_sums, double* sum) {
  int64_t done = 0;
  for (int64_t size = 1; size <= width; size *= 2) {
    if (width & size) {
      for (int64_t i = 0; i < num_sums; ++i) sum[i] += level[i + done];
      done += size;
    }
    const int64_t next = count - 2 * size + 1;
    for (int64_t i = 0; i < next; ++i) level[i] += level[i + size];
  }
}

ECHOPATH_INLINE void add(const double* values, int64_t count, double* sum) {
  for (int64_t i = 0; i < count; ++i) sum[i] += values[i];
}

}  // namespace

void moving_sums(const double* values, int64_t count, int64_t width, double* sum) {
  if (width == 0 || width > count) return;
  const int64_t num_sums = count - width + 1;
  std::vector<double> level(values, values + count);
  std::fill(sum, sum + num_sums, 0.0);
  run_simd<add_levels>(level.data(), count, width, num_sums, sum);
}

void add_row(const double* values, int64_t count, double* sum) { run_simd<add>(values, count, sum); }

double span_sum(const double* row, CellSpan span) {
  return std::accumulate(row + span.first, row + span.first + span.count, 0.0);
}

}  // namespace echopath
