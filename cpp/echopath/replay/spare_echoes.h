#pragma once
// Echoes whose memory goes from block to block and from replay to replay (KeptMemory): a page that is touched for the
// first time costs as much as a path does.
#include <cstddef>
#include <span>

#include "echopath/signal/echoes/echoes.h"

namespace echopath {

// Echoes without group and with room for that many delays and amplitudes each, which are not set.
Echoes take_echoes(size_t num_values);
// Keeps the echoes at `places` (ascending) and drops all others, at all nodes.
void keep_echoes(std::span<const size_t> places, Echoes& echoes);
// Echoes that are done with.
void leave_echoes(std::span<Echoes> echoes);

}  // namespace echopath
