#include "echopath/signal/kernels/carrier.h"

#include "echopath/radar/radar.h"
#include "echopath/signal/echoes/echoes.h"
#include "echopath/signal/kernels/kernels.h"

namespace echopath {
namespace {

constexpr uint32_t kGroupZero[Carriers::kCapacity] = {};

}  // namespace

CarrierModel::CarrierModel(const ChirpSequence& waveform, int reference_sample)
    : sense(waveform.falls() ? -1.0 : 1.0), start_frequency(sense * waveform.start_frequency),
      slope(sense * waveform.slope()), window_centre(waveform.window_centre()),
      sample_interval(1.0 / waveform.sampling_rate), reference_offset(reference_sample - 0.5 * (waveform.num_samples - 1)),
      highest_frequency(waveform.real ? 0.5 : 1.0) {
  using Real = long double;
  const Real swept = Real{waveform.bandwidth} * (waveform.num_samples - 1) / (2 * Real(waveform.num_samples));
  const Real centre = Real{sense} * (Real{waveform.start_frequency} + swept);
  centre_frequency = static_cast<double>(centre);
  centre_frequency_rest = static_cast<double>(centre - Real{centre_frequency});
}

void evaluate_carriers(const CarrierModel& model, const Echoes& echoes, int chirp, int64_t begin, int count, Carriers& out) {
  EchoStates states;
  evaluate_states(echoes, chirp, begin, count, states);
  out.count = count;
  out.group = echoes.group.empty() ? kGroupZero : echoes.group.data() + begin;
  signal_kernels().modulate(model, states, count, out);
}

}  // namespace echopath
