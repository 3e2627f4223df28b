#pragma once
// Bounds how fast the motion of a mesh turns back and forth in a frame: nodes that follow it must be as dense.
#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Returns a bound in rad/s (Motion::turn_rate) of a mesh within `during`: the turns of the motions above it add up, and so
// does its deformation.
double turn_rate(const Scene& scene, uint32_t mesh_id, const TimeSpan& during);

// Returns the same bound for the radar; it is 0 where the radar has no motion.
double turn_rate(const Radar& radar, const TimeSpan& during);

}  // namespace echopath
