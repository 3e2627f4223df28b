#include "echopath/signal/echo_states.h"

#include <algorithm>

#include "echopath/base/simd.h"
#include "echopath/signal/echoes.h"

namespace echopath {
namespace {

ECHOPATH_INLINE void set_states(const double* delay, const double* amplitude, double value, double slope, int count,
                                EchoStates* states) {
  for (int p = 0; p < count; ++p) {
    states->delay[p] = value * delay[p];
    states->rate[p] = slope * delay[p];
  }
  for (int p = 0; p < 2 * count; ++p) states->amplitude[p] = value * amplitude[p];
}

ECHOPATH_INLINE void add_states(const double* delay, const double* amplitude, double value, double slope, int count,
                                EchoStates* states) {
  for (int p = 0; p < count; ++p) {
    states->delay[p] += value * delay[p];
    states->rate[p] += slope * delay[p];
  }
  for (int p = 0; p < 2 * count; ++p) states->amplitude[p] += value * amplitude[p];
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
  for (int k = 0; k < sampling.order; ++k) {
    const int64_t at = (int64_t{sampling.first_node[chirp]} + k) * echoes.num_echoes + begin;
    const double* delay = echoes.delay.data() + at;
    const double* amplitude = reinterpret_cast<const double*>(echoes.amplitude.data() + at);
    const double value = sampling.value[row + k], slope = sampling.slope[row + k];
    if (k == 0) {
      run_simd<set_states>(delay, amplitude, value, slope, count, &states);
    } else {
      run_simd<add_states>(delay, amplitude, value, slope, count, &states);
    }
    if (bends && !sampling.bend.empty()) run_simd<add_bends>(delay, sampling.bend[row + k], sampling.twist[row + k], count, bends);
  }
}

}  // namespace echopath
