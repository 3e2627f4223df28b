#pragma once
// Finds where the motions of a scene change from one cubic to the next.
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Returns the times (s, ascending) between which all motions of scene and radar are analytic within `during`: breakpoints
// and knots of splines. Across a knot, where a third derivative jumps, the error of a polynomial falls with the cube of its
// order; between knots it falls geometrically.
std::vector<double> motion_knots(const Scene& scene, const Radar& radar, const TimeSpan& during = {});

// Returns the times where motions are not smooth: the breakpoints alone.
std::vector<double> motion_breakpoints(const Scene& scene, const Radar& radar, const TimeSpan& during = {});

}  // namespace echopath
