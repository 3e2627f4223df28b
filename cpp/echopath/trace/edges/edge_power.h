#pragma once
// Estimates without rays what sharp edges carry, to tell whether a trace should look for them.
#include "echopath/radar/radar.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Returns the power in W that the strongest sharp edge of the scene sends from the first transmitter to the first receiver,
// at a time (s), were nothing in the way: that of its first-order field about the point nearest to the radar, over what
// keeps the phase there. 0 where no edge is in the pattern. It misses echoes over mirrors. Raises invalid_argument when a
// motion is not defined at the time.
double strongest_edge(const Scene& scene, const Radar& radar, double time);

}  // namespace echopath
