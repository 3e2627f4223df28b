#pragma once
// Where the motions of a scene change from one cubic to the next.
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Times (s, ascending) between which all motions of scene and radar are analytic: breakpoints and knots of splines. A
// polynomial across a knot, where a third derivative jumps, converges with the cube of its order; between knots geometrically.
std::vector<double> motion_knots(const Scene& scene, const Radar& radar);

// Where they are not smooth: the breakpoints alone.
std::vector<double> motion_breakpoints(const Scene& scene, const Radar& radar);

}  // namespace echopath
