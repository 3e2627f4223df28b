#include "echopath/replay/time/chirp_derivatives.h"

#include <algorithm>
#include <vector>

#include "echopath/base/lanes/lanes.h"

namespace echopath {
namespace {

// The sums are written in vectors, because compilers round sums of plain numbers as they see fit: the rates of an echo would
// depend on its place among the others.
constexpr size_t kLeast = 8;

// Computes kVectors sums that stay in registers.
template <size_t kVectors>
ECHOPATH_INLINE void sum_some(const double* values, const double* weights, size_t order, size_t stride,
                              double* __restrict sum) {
  Lanes<double, kLeast> some[kVectors] = {};
  for (size_t k = 0; k < order; ++k) {
    const double* row = values + k * stride;
    for (size_t i = 0; i < kVectors; ++i) some[i] += weights[k] * load_lanes<kLeast>(row + i * kLeast);
  }
  for (size_t i = 0; i < kVectors; ++i) store_lanes(sum + i * kLeast, some[i]);
}

// Computes sum [count] = weights [order] times values [order, count], for count >= kLeast. The last vector overlaps the one
// before.
ECHOPATH_INLINE void weighted_sum(const double* values, const double* weights, size_t order, size_t count,
                                  double* __restrict sum) {
  constexpr size_t kVectors = 4, kTogether = kVectors * kLeast;
  size_t i = 0;
  for (; i + kTogether <= count; i += kTogether) sum_some<kVectors>(values + i, weights, order, count, sum + i);
  for (; i + kLeast <= count; i += kLeast) sum_some<1>(values + i, weights, order, count, sum + i);
  if (i < count) sum_some<1>(values + count - kLeast, weights, order, count, sum + count - kLeast);
}

// Returns the values [num_rows, count] in rows of kLeast, with zeros behind them.
std::vector<double> widened(const double* values, size_t num_rows, size_t count) {
  std::vector<double> wide(num_rows * kLeast);
  for (size_t row = 0; row < num_rows; ++row) std::copy_n(values + row * count, count, wide.data() + row * kLeast);
  return wide;
}

}  // namespace

void fill_derivatives(const TimeSampling& from, const double* delay, Echoes& echoes) {
  const auto count = static_cast<size_t>(echoes.num_echoes), stride = static_cast<size_t>(echoes.sampling.order);
  const auto order = static_cast<size_t>(from.order);
  const bool are_few = count < kLeast;
  const std::vector<double> wide =
      are_few ? widened(delay, static_cast<size_t>(from.num_rows), count) : std::vector<double>();
  const size_t width = are_few ? kLeast : count;
  double few[kLeast];
  const std::vector<double>* const weights[] = {&from.slope, &from.second_derivative, &from.third_derivative};
  for (size_t chirp = 0; chirp < from.first_row.size(); ++chirp) {
    const double* nodes = (are_few ? wide.data() : delay) + static_cast<size_t>(from.first_row[chirp]) * width;
    for (size_t d = 1; d < stride; ++d) {
      double* to = echoes.delay.data() + (chirp * stride + d) * count;
      run_simd<weighted_sum>(nodes, weights[d - 1]->data() + chirp * order, order, width, are_few ? few : to);
      if (are_few) std::copy_n(few, count, to);
    }
  }
}

}  // namespace echopath
