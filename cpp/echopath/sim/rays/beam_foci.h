#pragma once
// Puts rays where narrow beams of antennas send and hear.
#include "echopath/record/paths.h"
#include "echopath/trace/launch/launch_focus.h"

namespace echopath {

// Holds a cone of directions in world axes.
struct BeamCone {
  Vec3 axis = Vec3::UnitX();  // unit
  double versine = 2.0;
};

// Returns the cone about the middle of the beams that holds kBeamPart of the integral over the sphere of the mean gain of
// the transmitters times that of the receivers: the whole sphere where they have no beam.
BeamCone two_way_beam(const Radar& radar, const Transform& world_from_radar);
inline constexpr double kBeamPart = 0.99;

// Sets foci about the beam into the strata of a trace: of rays that are spread over a ground or over the field of view few
// meet what a narrow beam lights.
class BeamFoci {
 public:
  // Keeps a reference to the paths of the trace.
  explicit BeamFoci(const Paths& paths);
  // Returns whether a stratum is much wider than the beam and looks into it.
  bool fits(const Stratum& stratum) const;
  // Gives the focus of each stratum that it fits half of the rays that the stratum has in the guide.
  void set(LaunchGuide& guide) const;

 private:
  const Paths& paths_;
  const BeamCone beam_;
  LaunchFocus focus_;
};

}  // namespace echopath
