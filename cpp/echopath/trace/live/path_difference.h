#pragma once
// Leaves out of two records the paths that both have.
#include "echopath/trace/live/scene_changes.h"

namespace echopath {

// Leaves out of `before` and `after` the paths that have the same echoes in both scenes: those whose hits and columns are the
// same, which meet no changed mesh, and whose stratum has not changed. Paths are compared by 64 bits that hang on all of
// these. Raises Cancelled.
void leave_out_common(Paths& before, Paths& after, const ChangedMeshes& changed, Job* job = nullptr);

}  // namespace echopath
