#pragma once
#include "echopath/trace/record/paths.h"

namespace echopath {

// Reads, on one thread, what matching reads at least of every path, and returns a sum of it: mesh IDs and events.
uint64_t read_hits(const Paths& paths);

}  // namespace echopath
