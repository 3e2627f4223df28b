#include "echopath/signal/echo_states.h"

#include <algorithm>

#include "echopath/base/simd.h"
#include "echopath/signal/echoes.h"

namespace echopath {
namespace {

// Values at the nodes of one chirp; echo p of node k stands at p + k * stride.
struct Nodes {
  const double *delay, *amplitude;  // amplitudes: re, im interleaved
  int64_t stride;
  const double *value, *slope;      // weights [order]
  int order;
};

// Of kLanes echoes from p on; sums stay in the registers.
template <int kLanes>
ECHOPATH_INLINE void interpolate_some(const Nodes& nodes, int p, EchoStates* states) {
  typedef double Lanes __attribute__((vector_size(8 * kLanes), aligned(8), may_alias));
  const double *delay = nodes.delay + p, *amplitude = nodes.amplitude + 2 * p;
  const auto at = [](const double* from) { return *reinterpret_cast<const Lanes*>(from); };
  Lanes lags = nodes.value[0] * at(delay), rates = nodes.slope[0] * at(delay);
  Lanes low = nodes.value[0] * at(amplitude), high = nodes.value[0] * at(amplitude + kLanes);
  for (int k = 1; k < nodes.order; ++k) {
    delay += nodes.stride;
    amplitude += 2 * nodes.stride;
    lags += nodes.value[k] * at(delay);
    rates += nodes.slope[k] * at(delay);
    low += nodes.value[k] * at(amplitude);
    high += nodes.value[k] * at(amplitude + kLanes);
  }
  const auto store = [](double* to, Lanes lanes) { *reinterpret_cast<Lanes*>(to) = lanes; };
  store(states->delay + p, lags);
  store(states->rate + p, rates);
  store(states->amplitude + 2 * p, low);
  store(states->amplitude + 2 * p + kLanes, high);
}

template <int kLanes>
ECHOPATH_INLINE void interpolate(Nodes nodes, int count, EchoStates* states) {
  int p = 0;
  for (; p + kLanes <= count; p += kLanes) interpolate_some<kLanes>(nodes, p, states);
  for (; p < count; ++p) interpolate_some<1>(nodes, p, states);
}

ECHOPATH_INLINE void add_bends(const double* delay, double bend, double twist, int count, EchoBends* bends) {
  for (int p = 0; p < count; ++p) {
    bends->bend[p] += bend * delay[p];
    bends->twist[p] += twist * delay[p];
  }
}

}  // namespace

void evaluate_states(const Echoes& echoes, int chirp, int64_t begin, int count, EchoStates& states, EchoBends* bends) {
  const TimeSampling& sampling = echoes.sampling;
  const size_t row = static_cast<size_t>(chirp) * sampling.order;
  if (bends) {
    std::fill_n(bends->bend, count, 0.0);
    std::fill_n(bends->twist, count, 0.0);
  }
  const int64_t first = int64_t{sampling.first_node[chirp]} * echoes.num_echoes + begin;
  const Nodes nodes{echoes.delay.data() + first, reinterpret_cast<const double*>(echoes.amplitude.data() + first), echoes.num_echoes,
                    sampling.value.data() + row, sampling.slope.data() + row, sampling.order};
  if (instruction_set() == InstructionSet::kAvx512) run_simd<interpolate<8>>(nodes, count, &states);
  else run_simd<interpolate<4>>(nodes, count, &states);
  if (!bends || sampling.bend.empty()) return;
  for (int k = 0; k < sampling.order; ++k) {
    run_simd<add_bends>(nodes.delay + k * nodes.stride, sampling.bend[row + k], sampling.twist[row + k], count, bends);
  }
}

}  // namespace echopath
