#pragma once
// Cuts the paths that are to be replayed into blocks, and tells which blocks are replayed at the same time.
#include <cstdint>
#include <span>
#include <vector>

namespace echopath {

// Describes paths that are replayed at the same nodes.
struct PathsInFlight {
  int64_t num_paths;
  int64_t num_channels, num_rows;  // of the echoes of each path: its rows are the values at its nodes
};

// Names the paths [begin, end) of one of several lists.
struct BlockInFlight {
  size_t list;
  int64_t begin, end;
};

using Flight = std::vector<BlockInFlight>;
constexpr int64_t kBlocksInFlight = 32;  // at most; fixed: results must not depend on the number of threads

// Returns the blocks of all lists, in their order, flight by flight. What is in flight at a time is bounded whatever the
// number of paths, channels and rows. Lists share flights, and where all of them leave the last one part empty, blocks are
// smaller for it: a thread finds work also where paths are few, as those of a family of echoes are.
std::vector<Flight> plan_flights(std::span<const PathsInFlight> lists);

}  // namespace echopath
