#pragma once
// Tells where the hits of a record are at any time.
#include <vector>

#include "echopath/trace/record/paths.h"

namespace echopath {

class Job;

// Returns the points [H, 3] of all hits in the world at a time in s, in m; each goes with its triangle. Raises Cancelled
// when the job is cancelled.
std::vector<double> hit_points(const Paths& paths, double time, Job* job = nullptr);

}  // namespace echopath
