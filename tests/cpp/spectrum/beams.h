#pragma once
// Settings, cells and tolerances of beams.
#include "echopath/spectrum/angle/beamform.h"
#include "plane_waves.h"

namespace echopath::testing {

inline constexpr double kRounding = 1e-12;       // of unit waves
inline constexpr double kSolved = 1e-9;          // relative: covariances are inverted
inline const double kHalf = 0.5 * wavelength();  // m

inline BeamformOptions capon(double loading, int velocities = 0, int ranges = 0) {
  BeamformOptions options;
  options.method = BeamMethod::kCapon;
  options.diagonal_loading = loading;
  options.velocity_neighbours = velocities;
  options.range_neighbours = ranges;
  return options;
}

inline double power_at(const BeamPower& beams, size_t elevation, size_t azimuth, size_t cell) {
  const size_t cells = beams.power.size() / (beams.azimuth.size() * beams.elevation.size());
  return beams.power[(elevation * beams.azimuth.size() + azimuth) * cells + cell];
}

}  // namespace echopath::testing
