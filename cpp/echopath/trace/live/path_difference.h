#pragma once
// Leaves out of two records the paths that both have, and out of a record what its paths do not need.
#include "echopath/trace/live/scene_changes.h"

namespace echopath {

// Says what the paths of two records can have in common.
struct CommonParts {
  SceneChanges meshes;
  std::vector<int> stratum_before;  // by stratum after; -1: it has changed
};

// Leaves out of `before` and `after` the paths that have the same echoes in both scenes: those whose hits and columns are
// the same but for the numbers of meshes and strata, which meet no changed mesh, and whose stratum has not changed. Paths
// are compared by 64 bits that depend on all of these. Raises Cancelled.
void leave_out_common(Paths& before, Paths& after, const CommonParts& common, Job* job = nullptr);

// Returns the same paths with the hits that they use, in a scene with the meshes that they meet. Their echoes are the same,
// but mesh IDs are not: posing a few meshes costs less than posing a city.
Paths with_own_meshes(const Paths& paths, Job* job);

}  // namespace echopath
