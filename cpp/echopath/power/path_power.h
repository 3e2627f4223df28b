#pragma once
// The power of each path of a record.
#include <vector>

#include "echopath/base/job.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

// [P] W: |amplitude|^2 at the trace time for the first antennas of the radar that traced. In blocks: needs no more memory
// than the result. Raises Cancelled.
std::vector<double> path_power(const Paths& paths, Job* job = nullptr);

}  // namespace echopath
