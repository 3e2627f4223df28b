#pragma once
// Tells which paths share a random phase.
#include "echopath/record/paths.h"

namespace echopath {

// Returns whether two diffuse paths share a random phase: they run over the same diffuse hits, in the same or the reversed
// order. A ray records the paths over one hit one after the other, and selections keep their order.
bool shares_phase(const Paths& paths, int64_t first, int64_t second);

}  // namespace echopath
