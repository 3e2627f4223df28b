#include "echopath/replay/chirp_derivatives.h"

#include <algorithm>

#include "echopath/base/simd.h"

namespace echopath {
namespace {

// kCount sums that stay in registers.
template <size_t kCount>
ECHOPATH_INLINE void sum_some(const double* values, const double* weights, size_t order, size_t stride, double* __restrict sum) {
  double some[kCount] = {};
  for (size_t k = 0; k < order; ++k) {
    for (size_t i = 0; i < kCount; ++i) some[i] += weights[k] * values[k * stride + i];
  }
  for (size_t i = 0; i < kCount; ++i) sum[i] = some[i];
}

// sum [count] = weights [order] times values [order, count].
ECHOPATH_INLINE void weighted_sum(const double* values, const double* weights, size_t order, size_t count, double* __restrict sum) {
  constexpr size_t kTogether = 32, kRest = 8;
  size_t i = 0;
  for (; i + kTogether <= count; i += kTogether) sum_some<kTogether>(values + i, weights, order, count, sum + i);
  for (; i + kRest <= count; i += kRest) sum_some<kRest>(values + i, weights, order, count, sum + i);
  for (; i < count; ++i) sum_some<1>(values + i, weights, order, count, sum + i);
}

}  // namespace

void fill_derivatives(const TimeSampling& from, const double* delay, Echoes& echoes) {
  const auto count = static_cast<size_t>(echoes.num_echoes), stride = static_cast<size_t>(echoes.sampling.order);
  const auto order = static_cast<size_t>(from.order);
  const std::vector<double>* const weights[] = {&from.slope, &from.bend, &from.twist};
  for (size_t chirp = 0; chirp < from.first_node.size(); ++chirp) {
    const double* nodes = delay + static_cast<size_t>(from.first_node[chirp]) * count;
    for (size_t d = 1; d < stride; ++d) {
      double* to = echoes.delay.data() + (chirp * stride + d) * count;
      run_simd<weighted_sum>(nodes, weights[d - 1]->data() + chirp * order, order, count, to);
    }
  }
}

}  // namespace echopath
