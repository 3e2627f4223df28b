#pragma once
// Traces a scene and keeps of its faint paths only some, while the record is made.
#include "echopath/trace/trace.h"

namespace echopath {

// Returns what `thinned` (power/faint_paths.h) leaves of a trace; what it leaves out takes no memory.
Paths thinned_trace(const SceneSnapshot& scene, const Radar& radar, const TraceSettings& settings, Job* job,
                    KeptGeometry* kept, FittedStrata* fitted = nullptr);

}  // namespace echopath
