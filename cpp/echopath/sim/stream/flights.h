#pragma once
// Cuts the paths that are to be replayed into blocks, and tells which blocks are in flight together: replayed at the same
// time, on all threads.
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
constexpr int64_t kMostBlocksOfFlight = 32;  // fixed: results must not depend on the number of threads

// Returns the blocks of all lists, in their order, flight by flight. The number of values in flight is bounded whatever the
// number of paths, and that of channels and rows, unless a single path for each block has more. Lists share flights, so that
// threads find work also where lists are short, as those of a family of echoes are.
std::vector<Flight> plan_flights(std::span<const PathsInFlight> lists);

}  // namespace echopath
