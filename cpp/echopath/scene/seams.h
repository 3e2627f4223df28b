#pragma once
// Finds what the seams between meshes that touch make of their sharp edges. Internal to the module (scene_edges.h).
#include <utility>
#include <vector>

#include "echopath/scene/edges/sharp_edges.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Returns the node that moves a mesh, -1 where there is none or all motions rest, and the place of the mesh in the frame of
// all that this node moves.
std::pair<int, Transform> place_in_group(const Scene& scene, uint32_t mesh_id);

// Holds what seams make of the edges of a scene.
struct SeamedEdges {
  explicit SeamedEdges(const Scene& scene);

  std::vector<std::vector<SharpEdge>> edges;  // by mesh ID: those that differ from the mesh's own
  std::vector<bool> is_changed;               // by mesh ID: whether they do
  std::vector<uint32_t> body;                 // by mesh ID
};

}  // namespace echopath
