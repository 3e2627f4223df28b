#pragma once
// Which points of reflection get rays of their own, and how many.
#include <map>
#include <string>
#include <vector>

#include "echopath/sim/find_glints.h"
#include "echopath/trace/launch_focus.h"

namespace echopath {

// Sets foci about the glints of each stratum that its rays would be too far apart for, and takes their rays from its share in
// `guide.shares`, which counts in rays: half of it at most, by the part of the stratum's field that the foci hold, so that what is
// no point of reflection, such as an edge, keeps what it needs. Among foci, rays go by the number of Fresnel zones and by
// the root of the glint's power. strata: those of the trace in which the glints were found; power: W, by name, of their echoes as
// far as they are known; glints: strongest first.
void set_foci(const std::vector<Stratum>& strata, const std::map<std::string, double>& power, const std::vector<Glint>& glints,
              LaunchGuide& guide);

}  // namespace echopath
