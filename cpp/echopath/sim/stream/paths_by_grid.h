#pragma once
// Sorts paths by the time grid at whose nodes they are replayed.
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/replay/time/path_grids.h"

namespace echopath {

using PathsByGrid = std::vector<std::vector<int64_t>>;  // indices, by GridIndex::place

// Returns one without paths.
inline PathsByGrid no_paths_by_grid(const TimeGrids& grids) { return PathsByGrid(GridIndex::count(grids.cuts().size())); }

// Returns, for each grid, the paths that begin with it (PathGrids), in their order: of all paths, of which there are
// num_paths, or of some. Raises Cancelled when the job is cancelled.
PathsByGrid paths_by_grid(const PathGrids& grids, int64_t num_paths, Job* job);
PathsByGrid paths_by_grid(const PathGrids& grids, std::span<const int64_t> paths, Job* job);

}  // namespace echopath
