#include "echopath/replay/posed/touched_meshes.h"

#include <algorithm>

namespace echopath {
namespace {

// To pose a mesh takes as long as to look at the hits of so many paths.
constexpr int64_t kPathsOfPose = 500;

bool stands_still(const Scene& scene) {
  return std::ranges::none_of(scene.nodes(), [](const Node& node) { return node.motion || node.deformation; });
}

// Collects meshes, and of those that deform the triangles that are hit.
class TouchedMeshes {
 public:
  explicit TouchedMeshes(const Scene& scene)
      : scene_(scene), kind_(scene.meshes().size()), is_hit_(scene.meshes().size()),
        places_(std::make_shared<MeshPlaces>(scene.meshes().size())) {}

  void add(const Hit& hit) {
    if (kind_[hit.mesh_id] == kRigid) return;
    if (kind_[hit.mesh_id] == kNew) add_mesh(hit.mesh_id);
    if (kind_[hit.mesh_id] == kDeforms) is_hit_[hit.mesh_id][hit.triangle_id] = 1;
  }

  MeshesToPose take() {
    std::vector<SurfacePatch> patches(is_hit_.size());
    for (uint32_t id = 0; id < is_hit_.size(); ++id) {
      const Node& node = scene_.node_of(id);
      if (kind_[id] == kDeforms) patches[id] = make_patch(*node.mesh, is_hit_[id], node.smooth);
    }
    return {scene_, std::move(places_), std::move(patches)};
  }

 private:
  enum Kind : uint8_t { kNew, kRigid, kDeforms };

  void add_mesh(uint32_t mesh_id) {
    places_->add(mesh_id);
    const Node& node = scene_.node_of(mesh_id);
    kind_[mesh_id] = node.deformation ? kDeforms : kRigid;
    if (node.deformation) is_hit_[mesh_id].assign(node.mesh->triangles().size(), 0);
  }

  const Scene& scene_;
  std::vector<Kind> kind_;                    // [mesh ID]
  std::vector<std::vector<uint8_t>> is_hit_;  // [mesh ID][F], empty where the mesh is not touched or does not deform
  std::shared_ptr<MeshPlaces> places_;
};

}  // namespace

MeshesToPose touched_meshes(const Paths& paths) {
  const auto num_meshes = static_cast<int64_t>(paths.scene->meshes().size());
  if (paths.num_paths() > kPathsOfPose * num_meshes && stands_still(*paths.scene)) return whole_meshes(*paths.scene);
  TouchedMeshes touched(*paths.scene);
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    const Hit* hits = paths.hits_of(path);
    for (int k = 0; k < paths.num_bounces[path]; ++k) touched.add(hits[k]);
  }
  for (const Pass& pass : paths.passes) touched.add(pass.hit);
  return touched.take();
}

MeshesToPose whole_meshes(const Scene& scene) {
  auto places = std::make_shared<MeshPlaces>(scene.meshes().size());
  std::vector<SurfacePatch> patches(scene.meshes().size());
  for (uint32_t id = 0; id < patches.size(); ++id) {
    places->add(id);
    const Node& node = scene.node_of(id);
    if (!node.deformation) continue;
    patches[id] = make_patch(*node.mesh, std::vector<uint8_t>(node.mesh->triangles().size(), 1), node.smooth);
  }
  return {scene, std::move(places), std::move(patches)};
}

}  // namespace echopath
