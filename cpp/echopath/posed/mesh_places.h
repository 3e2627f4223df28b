#pragma once
// Says which meshes of a scene are posed, and where each stands among them.
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "echopath/scene/mesh/surface_patch.h"
#include "echopath/scene/scene.h"

namespace echopath {

// Where paths touch a few meshes of a large scene, only these are posed at the many nodes that such paths need.
struct MeshPlaces {
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> meshes;  // mesh IDs by place
  std::vector<uint32_t> place;   // by mesh ID, kNone where the mesh is not posed

  explicit MeshPlaces(size_t num_meshes) : place(num_meshes, kNone) {}
  bool has(uint32_t mesh_id) const { return place[mesh_id] != kNone; }
  // Gives a mesh the next place, unless it has one.
  void add(uint32_t mesh_id) {
    if (has(mesh_id)) return;
    place[mesh_id] = static_cast<uint32_t>(meshes.size());
    meshes.push_back(mesh_id);
  }
};

// Lists the nodes of a scene that place some meshes: those of the meshes and all above them.
class PlacingNodes {
 public:
  PlacingNodes(const Scene& scene, std::span<const uint32_t> meshes);
  // Returns world_from_mesh of each of the meshes at `time` (s), with the bits of world_from_nodes.
  std::vector<Transform> world_from_meshes(double time) const;

 private:
  struct Placing {
    int node, parent;  // the parent by its place in the list, -1: the world
  };
  const Scene& scene_;
  std::vector<Placing> nodes_;  // parents before their children
  std::vector<size_t> of_mesh_;
};

// Says what of a scene is posed: some of its meshes, and of those that deform only patches. The scene must outlive it.
struct MeshesToPose {
  // mesh_patches: one for each mesh of the scene. Raises invalid_argument where they are not as many.
  MeshesToPose(const Scene& scene, std::shared_ptr<const MeshPlaces> mesh_places, std::vector<SurfacePatch> mesh_patches);

  std::shared_ptr<const MeshPlaces> places;
  PlacingNodes nodes;                 // of the meshes by their places
  std::vector<SurfacePatch> patches;  // by mesh ID
};

}  // namespace echopath
