#pragma once
// Tells how much of what a surface reflects keeps its phase.
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/em/material.h"

namespace echopath {

// Returns the share of the reflected power at normal incidence that keeps its phase (Ament for a roughness height);
// `wavelength` is in m.
inline double coherent_share(const Material& material, double wavelength) {
  if (material.scattering) return 1.0 - *material.scattering * *material.scattering;
  const double phase = 4.0 * kPi * material.roughness_height / wavelength;
  return std::exp(-phase * phase);
}

}  // namespace echopath
