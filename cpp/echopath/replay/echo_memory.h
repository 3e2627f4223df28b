#pragma once
// Passes the memory of echoes on from block to block and from replay to replay (KeptMemory): to touch a page of memory for
// the first time costs as much time as to evaluate a path.
#include <cstddef>
#include <span>

#include "echopath/signal/echoes/echoes.h"

namespace echopath {

// Returns echoes without groups, with `num_values` delays and as many amplitudes, whose values are not set.
Echoes take_echoes(size_t num_values);
// Keeps the echoes at `places` (ascending) and drops all others, at all nodes.
void keep_echoes(std::span<const size_t> places, Echoes& echoes);
// Leaves the memory of echoes that are no longer needed to later calls of take_echoes.
void leave_echoes(std::span<Echoes> echoes);

}  // namespace echopath
