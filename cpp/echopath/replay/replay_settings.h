#pragma once
// Holds the settings of a replay.
#include "echopath/replay/posed/specular_slide.h"

namespace echopath {

struct ReplaySettings {
  double phase_tolerance = 1e-5;      // rad: aim for the interpolated phase, see Replayer::interpolated
  double amplitude_tolerance = 1e-4;  // aim for the interpolated amplitude, relative to the largest of the path
  SpecularPoints specular = SpecularPoints::kMaterial;  // where specular hits stand that are not replayed by images
  bool exact = false;                                   // evaluate in every chirp instead of interpolating
  bool per_sample = false;                              // for signals with the delay of every sample (per_sample.h)
};

}  // namespace echopath
