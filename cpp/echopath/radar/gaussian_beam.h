#pragma once
// Makes the pattern of an antenna whose beam is known by its widths alone.
#include <optional>

#include "echopath/radar/gain_table.h"

namespace echopath {

// Returns a beam toward +x whose gain falls as 2^{-(2 angle/width)^2} in azimuth and likewise in elevation, to half the peak
// at half a width. It has no gain behind, nor beyond 2.6 widths, where it is 81 dB below the peak.
//
// azimuth, elevation: rad, widths at half the power, from 1e-6 to pi
// peak_gain: linear; nothing for that of an antenna without losses, which is the most
// Raises invalid_argument naming the argument.
GainTable gaussian_beam(double azimuth, double elevation, std::optional<double> peak_gain);

}  // namespace echopath
