#pragma once
// Computes the exact echo of a perfectly conducting sphere, the reference for all that ray optics says about curved metal.

namespace echopath {

enum class ScatteringPlane {
  kE,  // the scattering plane holds the electric field: V-polarised radar, receiver above or below
  kH,  // it is perpendicular to the electric field
};

// Returns the radar cross section in m^2 in the far field, for a co-polarised receiver, by the Mie series.
//   radius > 0 m, frequency > 0 Hz; ka = 2 pi radius frequency / c at most 1e6.
//   bistatic_angle: rad in [0, pi] between the directions to transmitter and receiver; 0 is monostatic, where both
//   planes agree.
// Raises invalid_argument. Source: G. Mie 1908; Harrington, Time-Harmonic Electromagnetic Fields, 1961, section 6-9.
// Time grows as ka. Relative error below 1e-9 where |sigma| is not in a deep null.
double mie_rcs(double radius, double frequency, double bistatic_angle, ScatteringPlane plane);

}  // namespace echopath
