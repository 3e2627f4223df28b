#pragma once
// Defines the physical constants in SI units and the conventions of the whole program.
//
// The conventions have their only home here:
//  * time factor e^{+jwt}: a wave that travelled L carries e^{-jkL};
//  * |amplitude|^2 of a path is the power in W at the receiver's port, without e^{-jkL}: the phase comes from the delay;
//  * IF signal: mixer s_tx conj(s_rx), so a delay tau gives a beat frequency slope * tau, negative where chirps fall;
//  * speed v = dR/dt, receding positive;
//  * barycentric p = (1-u-v) v0 + u v1 + v v2;
//  * cubes are ordered [tx, rx, chirp, sample].
#include <numbers>

namespace echopath {

inline constexpr double kSpeedOfLight = 299792458.0;             // m/s, exact
inline constexpr double kBoltzmann = 1.380649e-23;               // J/K, exact since 2019
inline constexpr double kReferenceTemperature = 290.0;           // K, IEEE noise figure
inline constexpr double kVacuumPermittivity = 8.8541878128e-12;  // F/m, CODATA 2018
inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;

}  // namespace echopath
