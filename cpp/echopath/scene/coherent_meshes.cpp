#include "echopath/scene/coherent_meshes.h"

#include "echopath/em/surface/coherent_share.h"

namespace echopath {

std::vector<uint32_t> coherent_meshes(const Scene& scene, double wavelength, double least_share, bool without_planes) {
  std::vector<uint32_t> found;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const Node& node = scene.node_of(id);
    const bool is_asked = !node.material->mirror && !(without_planes && node.mesh->is_flat());
    if (is_asked && coherent_share(*node.material, wavelength) >= least_share) found.push_back(id);
  }
  return found;
}

}  // namespace echopath
