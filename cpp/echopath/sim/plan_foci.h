#pragma once
// Which points of reflection get rays of their own, and how many.
#include <vector>

#include "echopath/sim/find_glints.h"
#include "echopath/trace/launch/launch_focus.h"

namespace echopath {

// The echo of a stratum as far as it is known.
struct KnownEcho {
  double power = 0.0;  // W
  double high = 0.0;   // W, end of its interval
};

// Sets foci about the glints of each stratum that its rays would be too far apart for, and takes their rays from its share in
// `guide.shares`, which counts in rays: half of it at most, by the part of the stratum's field that the foci hold, so that what is
// no point of reflection, such as an edge, keeps what it needs. Among foci, rays go by the number of Fresnel zones and by
// the root of the glint's power. frame: of the trace in which the glints were found; echoes: by index of its strata, of those
// that are no foci; glints: strongest first.
void set_foci(const TraceFrame& frame, const std::vector<KnownEcho>& echoes, const std::vector<Glint>& glints, LaunchGuide& guide);

}  // namespace echopath
