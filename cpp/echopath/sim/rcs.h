#pragma once
// Radar cross sections: what a target alone returns to antennas far away.
#include <span>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/em/footprint.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Unit or any other length; both point from the target to the antenna.
struct RcsDirections {
  Vec3 incidence = Vec3::UnitX();    // toward the transmitter
  Vec3 observation = Vec3::UnitX();  // toward the receiver; equal to `incidence`: monostatic
};

struct RcsSettings {
  double frequency = 77e9;             // Hz
  Vec3 polarization = Vec3::UnitZ();   // of both antennas, world axes; its part across the line of sight counts
  int64_t num_rays = 1 << 17;          // per pair of directions
  int max_bounces = 4;                 // 1 to 64
  uint64_t seed = 1;
  Footprint footprint = Footprint::kSecondOrder;

  // Raises invalid_argument naming the field, the rule and the value.
  void validate() const;
};

// Coherent echoes add as fields, |sum a|^2; diffuse ones, whose phases are random, as powers, sum |a|^2: their mean
// over realisations of the roughness. Both in m^2. Two orders of a diffuse multi-bounce path count as independent.
struct RadarCrossSection {
  double coherent = 0.0, diffuse = 0.0;
  double total() const { return coherent + diffuse; }
};

// sigma = |sum a e^{-jkL}|^2 (4 pi)^3 R^4 / (Q^2 lambda^2) for each pair, of the scene at time 0, from isotropic
// antennas at a distance R at which the wave fronts are flat over the scene's bounding sphere to 1e-3 rad and their
// amplitude to 1e-4. Each pair costs a trace of its own.
// Raises invalid_argument for bad settings, a zero direction, one along the polarization, a scene without meshes, or
// one with mirrors: they stand for planes without end, which have no cross section.
std::vector<RadarCrossSection> rcs(const Scene& scene, std::span<const RcsDirections> directions,
                                   const RcsSettings& settings, Job* job = nullptr);

}  // namespace echopath
