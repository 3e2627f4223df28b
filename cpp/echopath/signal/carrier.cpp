#include "echopath/signal/carrier.h"

#include <cmath>

#include "echopath/signal/phasor.h"

namespace echopath {
namespace {

constexpr uint32_t kGroupZero[Carriers::kCapacity] = {};

ECHOPATH_SIMD void modulate(const CarrierModel& model, const EchoStates& states, int count, Carriers& out) {
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
  EchoStates states;
  evaluate_states(echoes, chirp, begin, count, states);
  out.count = count;
  out.group = echoes.group.empty() ? kGroupZero : echoes.group.data() + begin;
  modulate(model, states, count, out);
}

}  // namespace echopath
