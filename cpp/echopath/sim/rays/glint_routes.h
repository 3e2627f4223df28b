#pragma once
// Sorts paths by the route that they ran: over flagged mirrors to one surface and, over others, to the receiver.
#include <vector>

#include "echopath/base/plane.h"
#include "echopath/posed/posed_scene.h"
#include "echopath/record/paths.h"

namespace echopath {

// Holds a path of a route and its direction of launch.
struct SeenPath {
  Vec3 direction;  // unit, in the world
  int64_t path;
  double amplitude = 0.0;  // sqrt(W), without a filter: what one launch cell sends
};

// Describes a route by its mesh, the planes of the mirrors before it, and both antennas as that mesh sees them.
struct GlintRoute {
  uint32_t mesh;
  uint16_t stratum;
  std::vector<SeenPath> seen;
  std::vector<Plane> before;
  Vec3 first, second;  // m
};

// Returns the routes of all coherent paths that rays found from the transmitter on and that have one hit beside those on
// flagged mirrors. `pose` is that of the trace. Raises Cancelled when the job is cancelled.
std::vector<GlintRoute> glint_routes(const Paths& paths, const PosedScene& pose, Job* job);

// Returns the sizes of the amplitudes [indices] of paths from where the rays start to where they connect, the mean positions
// of the antennas, without the filter of a launch cell, in sqrt(W). Raises Cancelled likewise.
std::vector<double> unfiltered_amplitudes(const Paths& paths, const std::vector<int64_t>& indices, Job* job);

}  // namespace echopath
