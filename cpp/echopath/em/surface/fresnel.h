#pragma once
// Computes the reflection of a plane wave at a flat half space, with the time factor e^{+jwt}.
#include <complex>

namespace echopath {

// `permittivity` is the relative one, eps' - j eps'', of the half space; cos_incidence in [0, 1] is taken from the normal.
// Source: Fresnel; Re q > 0, Im q < 0 with q = sqrt(eps - sin^2).
std::complex<double> fresnel_te(std::complex<double> permittivity, double cos_incidence);  // E across the plane of incidence
std::complex<double> fresnel_tm(std::complex<double> permittivity, double cos_incidence);  // E in the plane of incidence

// Returns q = sqrt(eps - sin^2), the cosine of the wave in the half space times the refractive index.
std::complex<double> transmitted_cosine(std::complex<double> permittivity, double cos_incidence);

// Computes both modes at once.
struct FresnelModes {
  std::complex<double> te, tm;
};
FresnelModes fresnel_modes(std::complex<double> permittivity, double cos_incidence);

}  // namespace echopath
