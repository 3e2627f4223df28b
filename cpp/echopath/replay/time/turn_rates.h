#pragma once
// How fast what a mesh does in a frame comes and goes: what follows it must look that often.
#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Bound in rad/s (Motion::turn_rate) of a mesh within `during`: turns of the motions above it add up, and so does its deformation.
double turn_rate(const Scene& scene, uint32_t mesh_id, const TimeSpan& during);

// Likewise of the radar; 0 where it has no motion.
double turn_rate(const Radar& radar, const TimeSpan& during);

}  // namespace echopath
