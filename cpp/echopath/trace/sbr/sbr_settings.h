#pragma once
// Holds the settings of a trace that every ray follows.
#include <cstdint>

#include "echopath/base/geometry.h"

namespace echopath {

struct SbrSettings {
  int max_bounces = 4;
  uint64_t seed = 0;
  double frequency = 77e9;          // Hz
  Vec3 transmitter = Vec3::Zero();  // relative to the trace origin, as the receiver
  Vec3 receiver = Vec3::Zero();
  bool is_polarized = false;          // follow field vectors (PolarizationModel::kJones)
  bool finds_edges = false;           // note which planes light which (edges/lit_planes.h)
  Vec3 polarization = Vec3::UnitZ();  // transmit polarisation, unit, world axes
  // This is the probability that a ray is mirrored where a surface both mirrors and scatters. 0 splits rays at the first
  // hits of a coherent ray (goes_both_ways) and stands for the surface's specular share elsewhere. The expected echo is the
  // same for any value.
  double specular_probability = 0.0;
  bool operator==(const SbrSettings&) const = default;
};

}  // namespace echopath
