#include "echopath/replay/factors/radio_constants.h"

#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {

double RadioConstants::coherent_scale() const { return std::sqrt(transmit_power) / (4.0 * kPi); }

double RadioConstants::diffuse_scale() const { return std::sqrt(transmit_power / kPi) * wavelength / (4.0 * kPi); }

RadioConstants radio_constants(const Paths& paths, const Radar& radar) {
  RadioConstants radio;
  radio.transmit_power = radar.transmit_power;
  radio.wavelength = kSpeedOfLight / radar.waveform.start_frequency;
  radio.wavenumber = kTwoPi / radio.wavelength;
  radio.footprint = paths.frame.footprint;
  radio.spread = footprint_spread(paths.frame.sampler);
  return radio;
}

}  // namespace echopath
