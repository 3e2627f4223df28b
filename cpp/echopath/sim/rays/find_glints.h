#pragma once
// Finds points of reflection (glints) that the rays of a trace may be too far apart for.
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"

namespace echopath {

// Describes a direction of launch about which the path length is stationary.
struct Glint {
  int stratum = 0;                  // index into frame.strata; for a focus, the stratum that it is in
  Vec3 direction;                   // unit, world axes
  double power = 0.0;               // W, by stationary phase
  double narrow = 0.0, wide = 0.0;  // rad, half widths of the Fresnel zone, where the phase turns by half a cycle
  bool is_chain = false;            // of paths over several surfaces (chain_glints.h)
  double blur = 0.0;                // rad, by how much the direction may be off
};

// Finds the points where one-bounce paths, over any number of flagged mirrors before and behind, are stationary
// (reflection_point.h), and those where paths over several surfaces are (chain_glints.h). Only those count beside which the
// record has such a path, since they are seen. Facets of a curved body are taken as the curved surface that they stand for.
// Returns each point once, strongest first, and at most kMaxGlints of a stratum. Raises Cancelled.
std::vector<Glint> find_glints(const Paths& paths, Job* job = nullptr);
inline constexpr size_t kMaxGlints = 64;

}  // namespace echopath
