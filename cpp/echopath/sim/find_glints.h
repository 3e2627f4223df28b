#pragma once
// Points of reflection that the rays of a trace may be too far apart for.
#include <vector>

#include "echopath/base/job.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

// A direction of launch about which the length of a way is stationary.
struct Glint {
  int stratum = 0;        // index into frame.strata; in place of a focus, the stratum that it is in
  Vec3 direction;         // unit, world axes
  double power = 0.0;     // W, by stationary phase
  double narrow = 0.0, wide = 0.0;  // rad: within so much of it, across and along, the phase turns by half a cycle
};

// The points where one-bounce paths, over any number of flagged mirrors before and behind, are stationary (reflection_point.h).
// Only those count beside which the record has such a path, since they are seen. Facets of a curved body are taken as the curved
// surface that they stand for. Strongest first, one for each point, and at most kMostGlints of a stratum. Raises Cancelled.
std::vector<Glint> find_glints(const Paths& paths, Job* job = nullptr);
inline constexpr size_t kMostGlints = 64;

}  // namespace echopath
