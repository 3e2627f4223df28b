#pragma once
#include "echopath/trace/record/paths.h"

namespace echopath {

// Reads, on one thread, the data that matching must read of every path (mesh IDs and events), and returns a sum of it.
uint64_t read_hits(const Paths& paths);

}  // namespace echopath
