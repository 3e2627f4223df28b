#include "echopath/scene/mesh_traits.h"

#include <unordered_map>

namespace echopath {

MeshTraits mesh_traits(const Scene& scene) {
  MeshTraits traits;
  std::unordered_map<const Material*, uint32_t> index;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    const auto [known, is_new] = index.emplace(node.material.get(), static_cast<uint32_t>(traits.materials.size()));
    if (is_new) traits.materials.push_back(node.material);
    traits.material.push_back(known->second);
    traits.smooth.push_back(node.smooth ? 1 : 0);
    traits.moving.push_back(scene.is_moving(id) ? 1 : 0);
    traits.deforming.push_back(node.deformation ? 1 : 0);
  }
  return traits;
}

}  // namespace echopath
