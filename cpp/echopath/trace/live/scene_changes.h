#pragma once
// Tells which meshes of a scene differ from those of another one, for rays and for the signal.
#include <vector>

#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

// Holds which meshes differ.
using ChangedMeshes = std::vector<bool>;  // by mesh ID

// Meshes of two scenes are the same by the full names of their nodes, whatever their IDs.
struct SceneChanges {
  std::vector<uint32_t> id_after;     // by ID before; kNoMesh: gone
  std::vector<uint32_t> id_before;    // by ID after; kNoMesh: new
  ChangedMeshes of_before, of_after;  // those that differ, are gone or are new
  bool has_same_ids = true;           // of all that both have
  bool has_same_order = true;         // of the IDs of all that both have

  void mark(uint32_t id_of_after);  // as one that differs
};

// Returns the meshes of which anything differs that rays or echoes depend on: shape, material, place, or a motion of their
// own or of a node above. Where `time_moved` (the scenes are looked at in different times), all that move differ.
SceneChanges changes_between(const Scene& before, const Scene& after, bool time_moved);

// Returns the boxes of the meshes, a little larger than they are, relative to the origin of the geometry.
std::vector<Box> boxes_of(const EmbreeScene& geometry, uint32_t num_meshes);

}  // namespace echopath
