#pragma once
// Decides which points of reflection get rays of their own, and how many.
#include <vector>

#include "echopath/sim/rays/find_glints.h"
#include "echopath/trace/launch/launch_focus.h"

namespace echopath {

// Holds what is known of the echo of a stratum.
struct KnownEcho {
  double power = 0.0;  // W
  double high = 0.0;   // W, end of its interval
};

// Returns the rays of a stratum rounded to six significant bits. Pilots on machines with other instructions differ in their
// last bits, and one ray more would give all rays of its stratum other places, and rough surfaces other speckle: rounded,
// the shares hardly ever differ. `up` of a step is added before the rest is cut off: 0.5 rounds to the nearest, 0 down.
double rounded_rays(double rays, double up = 0.5);

// Sets foci about the glints of each stratum that its rays would be too far apart for, and takes their rays from its share
// in `guide.shares`, which counts in rays. Foci about glints of one bounce get at most half of it, by the part of the
// stratum's field that they hold, so that echoes without a point of reflection, such as those of edges, keep what they need.
// Among these foci, rays go by the number of Fresnel zones and by the root of the glint's power. Those about glints of paths
// over several surfaces get as many rays as resolve them, beside the others at most a quarter of the share. All are
// rounded_rays. `frame` is that of the trace in which the glints were found; `echoes` are by index of its strata, of those
// that are no foci; `glints` come strongest first.
void set_foci(const TraceFrame& frame, const std::vector<KnownEcho>& echoes, const std::vector<Glint>& glints,
              LaunchGuide& guide);

}  // namespace echopath
