#pragma once
// Checks echoes before they are added to a signal.
#include "echopath/signal/echoes/echoes.h"

namespace echopath {

// Raises invalid_argument on wrong shapes, groups that are not below `num_groups`, or values that are not finite, for frames
// of `num_chirps` chirps.
void require_echoes(const Echoes& block, int num_chirps, int num_groups);

}  // namespace echopath
