#pragma once
// Reflection of a plane wave at a flat half space, time factor e^{+jwt}.
#include <complex>

namespace echopath {

// relative permittivity eps' - j eps'' of a half space; cos_incidence in [0, 1] from the normal.
// Source: Fresnel; Re q > 0, Im q < 0 with q = sqrt(eps - sin^2).
std::complex<double> fresnel_te(std::complex<double> permittivity, double cos_incidence);  // E across the plane of incidence
std::complex<double> fresnel_tm(std::complex<double> permittivity, double cos_incidence);  // E in the plane of incidence

// Both at once.
struct FresnelModes {
  std::complex<double> te, tm;
};
FresnelModes fresnel_modes(std::complex<double> permittivity, double cos_incidence);

}  // namespace echopath
