#include "echopath/radar/noise_power.h"

#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {

double noise_power(const Radar& radar) {
  const double noise_factor = std::pow(10.0, radar.noise_figure_db / 10.0);
  const double complex_power = kBoltzmann * kReferenceTemperature * noise_factor * radar.waveform.sampling_rate;
  const double averaged = radar.multiplexing == Multiplexing::kBpm ? radar.num_slots() : 1.0;
  return (radar.waveform.real ? 0.5 * complex_power : complex_power) / averaged;
}

double noise_power_in_cell(const Radar& radar) {
  const ChirpSequence& waveform = radar.waveform;
  const double scale = waveform.real ? 2.0 : 1.0;
  return scale * noise_power(radar) / (static_cast<double>(waveform.num_samples) * waveform.num_chirps);
}

}  // namespace echopath
