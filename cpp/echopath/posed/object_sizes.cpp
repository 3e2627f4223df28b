#include "echopath/posed/object_sizes.h"

#include <Eigen/Geometry>

#include "echopath/posed/posed_scene.h"

namespace echopath {

std::vector<ObjectSize> object_sizes(const Scene& scene, double time) {
  const PosedScene pose(scene, time);
  std::vector<ObjectSize> sizes;
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<int> index(scene.nodes().size(), -1);  // into sizes, by node
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const int object = scene.meshes()[id].object;
    int& at = index[static_cast<size_t>(object)];
    if (at < 0) {
      at = static_cast<int>(sizes.size());
      sizes.push_back({object});
      boxes.emplace_back();
    }
    const auto k = static_cast<size_t>(at);
    const Mat3& linear = pose.linear(id);
    const Vec3& translation = pose.world_translation(id);
    for (const Vec3& vertex : pose.local_vertices(id)) boxes[k].extend(Vec3(linear * vertex + translation));
    sizes[k].is_closed = sizes[k].is_closed && scene.node_of(id).mesh->is_closed();
  }
  for (size_t k = 0; k < sizes.size(); ++k) {
    sizes[k].shortest = boxes[k].sizes().minCoeff();
    sizes[k].longest = boxes[k].sizes().maxCoeff();
  }
  return sizes;
}

}  // namespace echopath
