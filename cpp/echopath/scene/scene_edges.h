#pragma once
// Finds the sharp edges of all meshes of a scene, with the seams between meshes that keep their places to each other.
#include <span>
#include <vector>

#include "echopath/scene/edges/sharp_edges.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Returns whether the edges of a mesh make echoes: those of conductors, or of surfaces that reflect like conductors. Flagged
// mirrors, which stand for planes without end, and meshes that deform or change their scale have none.
bool has_echoing_edges(const Scene& scene, uint32_t mesh_id);

// Meshes whose edges make echoes and that stay where they are to each other are one surface where they touch: sides of
// theirs that lie on each other (to 1e-6 of the extent) are no rims, and an edge between two meshes is one of the mesh with
// the lower ID. The scene must outlive it.
class SceneEdges {
 public:
  explicit SceneEdges(const Scene& scene);
  SceneEdges(SceneEdges&&) = default;
  SceneEdges(const SceneEdges&) = delete;
  // Returns the edges of a mesh in its own frame, ascending as find_sharp_edges has them; none where they make no echoes.
  std::span<const SharpEdge> of(uint32_t mesh_id) const { return edges_[mesh_id]; }
  // Returns the meshes whose edges and seams connect them with this one: the body that they are parts of, named by its
  // lowest ID.
  uint32_t body_of(uint32_t mesh_id) const { return body_[mesh_id]; }

 private:
  std::vector<std::vector<SharpEdge>> own_;        // by mesh ID: those that differ from the mesh's own
  std::vector<std::span<const SharpEdge>> edges_;  // by mesh ID
  std::vector<uint32_t> body_;                     // by mesh ID
};

}  // namespace echopath
