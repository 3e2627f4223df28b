#pragma once
// Sorts paths by the time grid at whose nodes they are replayed.
#include <cstdint>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/replay/time/path_grids.h"

namespace echopath {

// Returns, for each grid, the indices of the paths that begin with it (PathGrids), in their order. Raises Cancelled when the
// job is cancelled.
std::vector<std::vector<int64_t>> paths_by_grid(const PathGrids& grids, int64_t num_paths, Job* job);

}  // namespace echopath
