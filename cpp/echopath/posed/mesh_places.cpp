#include "echopath/posed/mesh_places.h"

#include <utility>

#include "echopath/base/errors.h"
#include "echopath/scene/chained_transforms.h"

namespace echopath {

PlacingNodes::PlacingNodes(const Scene& scene, std::span<const uint32_t> meshes) : scene_(scene) {
  std::vector<int> place(scene.nodes().size(), -1);
  for (const uint32_t mesh : meshes) {
    for (int node = scene.meshes()[mesh].node; node >= 0; node = scene.nodes()[node].parent) place[node] = 0;
  }
  for (size_t node = 0; node < place.size(); ++node) {
    if (place[node] < 0) continue;
    const int parent = scene.nodes()[node].parent;
    place[node] = static_cast<int>(nodes_.size());
    nodes_.push_back({static_cast<int>(node), parent < 0 ? -1 : place[parent]});
  }
  for (const uint32_t mesh : meshes) of_mesh_.push_back(static_cast<size_t>(place[scene.meshes()[mesh].node]));
}

std::vector<Transform> PlacingNodes::world_from_meshes(double time) const {
  const std::vector<Transform> world = chained_transforms(nodes_.size(), [&](size_t i) {
    return scene_.local_transform(nodes_[i].node, time);
  }, [&](size_t i) { return nodes_[i].parent; });
  std::vector<Transform> of_meshes;
  of_meshes.reserve(of_mesh_.size());
  for (const size_t node : of_mesh_) of_meshes.push_back(world[node]);
  return of_meshes;
}

MeshesToPose::MeshesToPose(const Scene& scene, std::shared_ptr<const MeshPlaces> mesh_places,
                           std::vector<SurfacePatch> mesh_patches)
    : places(std::move(mesh_places)), nodes(scene, places->meshes), patches(std::move(mesh_patches)) {
  require(patches.size() == scene.meshes().size(), "mesh_patches", "must be one for each mesh of the scene", patches.size());
}

}  // namespace echopath
