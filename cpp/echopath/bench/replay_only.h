#pragma once
// Replay without the synthesis of its echoes.
#include "echopath/sim/replay_stream.h"

namespace echopath {

// Replays all paths at every chirp and for every channel to the echoes that synthesis takes, to see what that costs alone.
// Returns the number of path-chirps, static paths once. Raises what ReplayStream does.
int64_t replay_only(const Paths& paths, const Radar& radar, const ReplaySettings& settings, Job* job = nullptr);

}  // namespace echopath
