#pragma once
// Computes the power of each path of a record.
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/record/paths.h"

namespace echopath {

// Returns |amplitude|^2 [P] in W at the trace time for the first antennas of the radar that traced. It works in blocks and
// needs no more memory than the result. Raises Cancelled.
std::vector<double> path_power(const Paths& paths, Job* job = nullptr);
// Returns that of `some` paths (indices) for a radar of one channel (one_channel in radar.h).
std::vector<double> path_power(const Paths& paths, std::span<const int64_t> some, const Radar& channel, Job* job = nullptr);

}  // namespace echopath
