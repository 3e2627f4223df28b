#include "echopath/posed/object_sizes.h"

#include <algorithm>

namespace echopath {

std::vector<ObjectSize> object_sizes(const Scene& scene, const std::vector<Body>& bodies) {
  std::vector<ObjectSize> sizes;
  for (const Body& body : bodies) {
    const Vec3 sides = body.box.sizes();
    const auto is_closed = [&](uint32_t id) { return scene.node_of(id).mesh->is_closed(); };
    sizes.push_back({body.node, sides.minCoeff(), sides.maxCoeff(), std::ranges::all_of(body.meshes, is_closed)});
  }
  return sizes;
}

}  // namespace echopath
