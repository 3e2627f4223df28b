#include "echopath/signal/echoes/echo_states.h"

#include <algorithm>

#include "echopath/base/lanes/lanes.h"
#include "echopath/signal/echoes/echoes.h"
#include "echopath/signal/kernels/kernels.h"

namespace echopath {
namespace {

// Holds the values at the nodes that some chirps share; echo p of node k stands at p + k * stride.
struct Nodes {
  const double *delay, *amplitude;  // amplitudes: re, im interleaved
  int64_t stride;
  const double *value, *slope;  // weights [chirp, order]
  int order;
};

// Evaluates kLanes echoes from p on, at kChirps chirps for which the nodes are read once; the sums stay in the registers.
template <int kLanes, int kChirps>
ECHOPATH_INLINE void interpolate_some(const Nodes& nodes, int p, EchoStates* states) {
  using Vec = Lanes<double, kLanes>;
  Vec lags[kChirps] = {}, rates[kChirps] = {}, low[kChirps] = {}, high[kChirps] = {};
  for (int k = 0; k < nodes.order; ++k) {
    const double* from = nodes.amplitude + 2 * (p + k * nodes.stride);
    const Vec delay = load_lanes<kLanes>(nodes.delay + p + k * nodes.stride);
    const Vec first = load_lanes<kLanes>(from), second = load_lanes<kLanes>(from + kLanes);
    for (int c = 0; c < kChirps; ++c) {
      const double value = nodes.value[c * nodes.order + k];
      lags[c] += value * delay;
      rates[c] += nodes.slope[c * nodes.order + k] * delay;
      low[c] += value * first;
      high[c] += value * second;
    }
  }
  for (int c = 0; c < kChirps; ++c) {
    store_lanes(states[c].delay + p, lags[c]);
    store_lanes(states[c].rate + p, rates[c]);
    store_lanes(states[c].amplitude + 2 * p, low[c]);
    store_lanes(states[c].amplitude + 2 * p + kLanes, high[c]);
  }
}

template <int kLanes, int kChirps>
ECHOPATH_INLINE void interpolate(Nodes nodes, int count, EchoStates* states) {
  int p = 0;
  for (; p + kLanes <= count; p += kLanes) interpolate_some<kLanes, kChirps>(nodes, p, states);
  for (; p < count; ++p) interpolate_some<1, kChirps>(nodes, p, states);
}

void copy_nodes(const Nodes& nodes, int count, EchoStates& state) {
  std::copy_n(nodes.delay, count, state.delay);
  std::copy_n(nodes.delay + nodes.stride, count, state.rate);
  std::copy_n(nodes.amplitude, 2 * count, state.amplitude);
}

template <int kChirps>
void interpolate_at(const Nodes& nodes, int count, EchoStates* states) {
  run_simd_lanes<interpolate<8, kChirps>, interpolate<4, kChirps>>(nodes, count, states);
}

// Returns how many chirps from `chirp` on share its nodes, up to `most`.
int chirps_that_share_nodes(const TimeSampling& sampling, int chirp, int most) {
  int count = 1;
  while (count < most && sampling.first_row[chirp + count] == sampling.first_row[chirp]) ++count;
  return count;
}

ECHOPATH_INLINE void add_derivatives(const double* delay, double second, double third, int count,
                                     EchoDerivatives* derivatives) {
  for (int p = 0; p < count; ++p) {
    derivatives->second[p] += second * delay[p];
    derivatives->third[p] += third * delay[p];
  }
}

}  // namespace

void evaluate_states(const Echoes& echoes, int chirp, int num_chirps, int64_t begin, int count, EchoStates* states) {
  const TimeSampling& sampling = echoes.sampling;
  const int end = chirp + num_chirps, at_once = num_simd_lanes() / 2;  // chirps, as there are registers for
  while (chirp < end) {
    const size_t row = static_cast<size_t>(chirp) * sampling.order;
    const int64_t first = int64_t{sampling.first_row[chirp]} * echoes.num_echoes + begin;
    const Nodes nodes{echoes.delay.data() + first, reinterpret_cast<const double*>(echoes.amplitude.data() + first),
                      echoes.num_echoes,           sampling.value.data() + row,
                      sampling.slope.data() + row, sampling.order};
    const int shared = chirps_that_share_nodes(sampling, chirp, std::min(at_once, end - chirp));
    if (sampling.rows == TimeSampling::Rows::kDerivatives) copy_nodes(nodes, count, *states);
    else if (shared == 4) interpolate_at<4>(nodes, count, states);
    else if (shared > 1) interpolate_at<2>(nodes, count, states);
    else interpolate_at<1>(nodes, count, states);
    const int done = shared == 3 ? 2 : shared;
    for (int i = 0; sampling.rows == TimeSampling::Rows::kLogarithms && i < done; ++i)
      signal_kernels().undo_logarithms(states[i].amplitude, count);
    chirp += done;
    states += done;
  }
}

void evaluate_states(const Echoes& echoes, int chirp, int64_t begin, int count, EchoStates& states,
                     EchoDerivatives* derivatives) {
  evaluate_states(echoes, chirp, 1, begin, count, &states);
  if (!derivatives) return;
  std::fill_n(derivatives->second, count, 0.0);
  std::fill_n(derivatives->third, count, 0.0);
  const TimeSampling& sampling = echoes.sampling;
  if (sampling.second_derivative.empty()) return;
  const size_t row = static_cast<size_t>(chirp) * sampling.order;
  const double* delay = echoes.delay.data() + int64_t{sampling.first_row[chirp]} * echoes.num_echoes + begin;
  for (int k = 0; k < sampling.order; ++k) {
    run_simd<add_derivatives>(delay + k * echoes.num_echoes, sampling.second_derivative[row + k],
                              sampling.third_derivative[row + k], count, derivatives);
  }
}

}  // namespace echopath
