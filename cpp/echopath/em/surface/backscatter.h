#pragma once
// Tells what a rough surface sends back to a radar.
#include "echopath/em/material.h"

namespace echopath {

// Returns the radar cross section per area, co-polar in either polarisation, of what a surface scatters back diffusely:
// 4 pi times the share of the incident power, cos_incidence |facet|^2 S^2, that goes back per solid angle. `frequency` is in
// Hz.
double backscatter_coefficient(const Material& material, double frequency, double cos_incidence);

}  // namespace echopath
