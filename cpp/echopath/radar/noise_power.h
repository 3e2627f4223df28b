#pragma once
// Computes the power of the receiver's thermal noise.
#include "echopath/radar/radar.h"

namespace echopath {

// Returns the noise power of one IF sample in W: k T0 F fs for complex samples, half of it for real ones (single-sideband
// noise figure, no image). A BPM code that is undone averages over its slots.
double noise_power(const Radar& radar);

// Returns the noise power in W in the range-Doppler cell that all samples of a frame make with even weights, to compare with
// the received power of an echo there: the power of a sample over their number, twice as much for real samples, whose maps
// hold half of their power.
double noise_power_in_cell(const Radar& radar);

}  // namespace echopath
