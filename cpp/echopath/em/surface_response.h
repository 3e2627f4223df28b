#pragma once
// What a material makes of a wave at one hit: reflection coefficient and the split into coherent and diffuse power.
#include <complex>

#include "echopath/em/material.h"

namespace echopath {

enum class PolarizationMode { kTe, kTm };

struct SurfaceResponse {
  std::complex<double> gamma;  // field reflection coefficient; |gamma|^2 of the power is reflected in all
  double coherent = 1.0;       // s: field share of the specular part, s^2 + S^2 = 1
  double diffuse = 0.0;        // S: square root of the diffuse share of power
};

// Ament 1953: coherent field factor s = exp(-2 (k sigma_h cos)^2). wavenumber [rad/m], roughness_height [m] rms.
double ament_factor(double wavenumber, double roughness_height, double cos_incidence);

// frequency [Hz]; cos_incidence in [0, 1]. A conductor reflects with -1 in both modes (scalar convention), a constant
// reflectivity rho with -sqrt(rho).
SurfaceResponse respond(const Material& material, double frequency, double cos_incidence, PolarizationMode mode);

}  // namespace echopath
