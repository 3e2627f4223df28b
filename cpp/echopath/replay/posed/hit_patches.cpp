#include "echopath/replay/posed/hit_patches.h"

#include <algorithm>

namespace echopath {

std::vector<SurfacePatch> hit_patches(const Paths& paths) {
  const auto num_meshes = static_cast<uint32_t>(paths.scene->meshes().size());
  std::vector<std::vector<uint8_t>> is_hit(num_meshes);  // [F] of deforming meshes
  for (uint32_t id = 0; id < num_meshes; ++id) {
    const Node& node = paths.scene->node_of(id);
    if (node.deformation) is_hit[id].assign(node.mesh->triangles().size(), 0);
  }
  std::vector<SurfacePatch> patches(num_meshes);
  if (std::ranges::all_of(is_hit, [](const auto& triangles) { return triangles.empty(); })) return patches;
  for (int64_t path = 0; path < paths.num_paths(); ++path) {
    const Hit* hits = paths.hits_of(path);
    for (int k = 0; k < paths.num_bounces[path]; ++k) {
      if (!is_hit[hits[k].mesh_id].empty()) is_hit[hits[k].mesh_id][hits[k].triangle_id] = 1;
    }
  }
  for (const Pass& pass : paths.passes) {
    if (!is_hit[pass.hit.mesh_id].empty()) is_hit[pass.hit.mesh_id][pass.hit.triangle_id] = 1;
  }
  for (uint32_t id = 0; id < num_meshes; ++id) {
    const Node& node = paths.scene->node_of(id);
    if (node.deformation) patches[id] = make_patch(*node.mesh, is_hit[id], node.smooth);
  }
  return patches;
}

std::vector<SurfacePatch> whole_patches(const Scene& scene) {
  std::vector<SurfacePatch> patches(scene.meshes().size());
  for (uint32_t id = 0; id < patches.size(); ++id) {
    const Node& node = scene.node_of(id);
    if (!node.deformation) continue;
    patches[id] = make_patch(*node.mesh, std::vector<uint8_t>(node.mesh->triangles().size(), 1), node.smooth);
  }
  return patches;
}

}  // namespace echopath
