#pragma once
// Replays paths without the synthesis of their echoes.
#include "echopath/sim/stream/replay_stream.h"

namespace echopath {

// Replays all paths at every chirp and for every channel to the echoes that synthesis takes, to see what that costs alone.
// Returns the number of path-chirps of all channels, in which static paths count once. Raises what ReplayStream does.
int64_t replay_only(const Paths& paths, const Radar& radar, const ReplaySettings& settings, Job* job);

}  // namespace echopath
