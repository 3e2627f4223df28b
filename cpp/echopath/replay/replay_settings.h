#pragma once
// Holds the settings of a replay.
#include <algorithm>

#include "echopath/replay/posed/specular_slide.h"

namespace echopath {

struct ReplaySettings {
  double phase_tolerance = 1e-5;                        // rad: aim for the interpolated phase, see Replayer::interpolated
  SpecularPoints specular = SpecularPoints::kMaterial;  // where specular hits stand that are not replayed by images
  bool exact = false;                                   // evaluate in every chirp instead of interpolating
  bool per_sample = false;                              // for signals with the delay of every sample (per_sample.h)

  // Returns the aim for the interpolated amplitude, relative to the largest of the path. It is wider than that of the phase,
  // as amplitudes between nodes err by far less than their tails say.
  double amplitude_tolerance() const { return std::min(1e-4, 10.0 * phase_tolerance); }
};

}  // namespace echopath
