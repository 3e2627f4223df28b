#pragma once
// Tells which meshes of a scene differ from those of another one, for rays and for the signal.
#include <vector>

#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

// Holds which meshes differ. Both scenes must have the same meshes by ID.
using ChangedMeshes = std::vector<bool>;  // by mesh ID

// Returns whether the scenes have the same nodes by index, and the same of them have meshes that take part.
bool has_same_tree(const Scene& before, const Scene& after);

// Returns the meshes of which anything differs that rays or echoes hang on: shape, material, place, or a motion of their own
// or of a node above. Where `time_moved` (the scenes are looked at in different times), all that move differ.
ChangedMeshes changed_meshes(const Scene& before, const Scene& after, bool time_moved);

// Returns the boxes of the meshes, a little larger than they are, relative to the origin of the geometry.
std::vector<Eigen::AlignedBox3d> boxes_of(const EmbreeScene& geometry, uint32_t num_meshes);

}  // namespace echopath
