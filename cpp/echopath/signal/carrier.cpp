#include "echopath/signal/carrier.h"

#include <cmath>

#include "echopath/signal/phasor.h"

namespace echopath {
namespace {

constexpr uint32_t kGroupZero[Carriers::kCapacity] = {};

// Delays, their rates and amplitudes of a block at one chirp.
struct States {
  alignas(64) double delay[Carriers::kCapacity];              // s
  alignas(64) double rate[Carriers::kCapacity];               // s/s
  alignas(64) double amplitude[2 * Carriers::kCapacity];      // re, im interleaved
};

ECHOPATH_SIMD void set_states(const double* delay, const double* amplitude, double value, double slope, int count,
                              States& states) {
  for (int p = 0; p < count; ++p) {
    states.delay[p] = value * delay[p];
    states.rate[p] = slope * delay[p];
  }
  for (int p = 0; p < 2 * count; ++p) states.amplitude[p] = value * amplitude[p];
}

ECHOPATH_SIMD void add_states(const double* delay, const double* amplitude, double value, double slope, int count,
                              States& states) {
  for (int p = 0; p < count; ++p) {
    states.delay[p] += value * delay[p];
    states.rate[p] += slope * delay[p];
  }
  for (int p = 0; p < 2 * count; ++p) states.amplitude[p] += value * amplitude[p];
}

void evaluate_states(const Echoes& echoes, int chirp, int64_t begin, int count, States& states) {
  const TimeSampling& sampling = echoes.sampling;
  const double* value = &sampling.value[static_cast<size_t>(chirp) * sampling.order];
  const double* slope = &sampling.slope[static_cast<size_t>(chirp) * sampling.order];
  for (int k = 0; k < sampling.order; ++k) {
    const int64_t at = (int64_t{sampling.first_node[chirp]} + k) * echoes.num_echoes + begin;
    const double* amplitude = reinterpret_cast<const double*>(echoes.amplitude.data() + at);
    (k == 0 ? set_states : add_states)(echoes.delay.data() + at, amplitude, value[k], slope[k], count, states);
  }
}

ECHOPATH_SIMD void modulate(const CarrierModel& model, const States& states, int count, Carriers& out) {
  const double f0 = model.start_frequency, slope = model.slope, centre = model.window_centre;
  for (int p = 0; p < count; ++p) {
    const double tau = states.delay[p];
    const double swept = slope * tau;
    const double beat = swept + (f0 + slope * centre - swept) * states.rate[p];
    const double frequency = beat * model.sample_interval;
    // The carrier turns 1e4 to 1e6 times: one fused operation removes the whole turns before anything is rounded.
    const double turns = round_to_integer(f0 * tau);
    const double cycles =
        std::fma(f0, tau, -turns) + swept * (centre - 0.5 * tau) + frequency * model.reference_offset;
    const Phasor phasor = phasor_of_cycles(cycles);
    const double ar = states.amplitude[2 * p], ai = states.amplitude[2 * p + 1];
    const bool kept = (frequency >= 0.0) & (frequency < model.highest_frequency);
    out.frequency[p] = kept ? frequency : 0.0;
    out.re[p] = kept ? ar * phasor.re + ai * phasor.im : 0.0;
    out.im[p] = kept ? ar * phasor.im - ai * phasor.re : 0.0;
  }
}

}  // namespace

CarrierModel::CarrierModel(const ChirpSequence& waveform, int reference_sample)
    : start_frequency(waveform.start_frequency),
      slope(waveform.slope()),
      window_centre(waveform.window_centre()),
      sample_interval(1.0 / waveform.sampling_rate),
      reference_offset(reference_sample - 0.5 * (waveform.num_samples - 1)),
      highest_frequency(waveform.real ? 0.5 : 1.0) {}

void evaluate_carriers(const CarrierModel& model, const Echoes& echoes, int chirp, int64_t begin, int count,
                       Carriers& out) {
  States states;
  evaluate_states(echoes, chirp, begin, count, states);
  out.count = count;
  out.group = echoes.group.empty() ? kGroupZero : echoes.group.data() + begin;
  modulate(model, states, count, out);
}

}  // namespace echopath
