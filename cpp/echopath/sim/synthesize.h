#pragma once
// Computes the IF cube of the whole signal from paths, streaming blocks of paths through replay and signal.
#include "echopath/sim/stream/cube_pass.h"

namespace echopath {

// Returns the signal of all paths. Peak memory grows with neither paths x chirps nor paths x channels. The result has the
// same bits for any number of threads. Raises invalid_argument for a bad radar or motion; raises Cancelled.
Cube synthesize(const Paths& paths, const Radar& radar, const CubeSettings& settings = {}, Job* job = nullptr);

}  // namespace echopath
