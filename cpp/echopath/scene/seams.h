#pragma once
// Finds what the seams between meshes that touch make of their sharp edges. Internal to the module (scene_edges.h).
#include <vector>

#include "echopath/scene/edges/sharp_edges.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Holds what seams make of the edges of a scene.
struct SeamedEdges {
  explicit SeamedEdges(const Scene& scene);

  std::vector<std::vector<SharpEdge>> edges;  // by mesh ID: those that differ from the mesh's own
  std::vector<bool> is_changed;               // by mesh ID: whether they do
  std::vector<uint32_t> body;                 // by mesh ID
};

}  // namespace echopath
