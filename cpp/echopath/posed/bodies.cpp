#include "echopath/posed/bodies.h"

namespace echopath {

std::vector<Body> bodies_of(const Scene& scene, const PosedScene& pose) {
  std::vector<Body> bodies;
  std::vector<int> index(scene.nodes().size(), -1);  // into bodies, by node
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    const int object = scene.meshes()[id].object;
    int& at = index[object];
    if (at < 0) {
      at = static_cast<int>(bodies.size());
      bodies.push_back({object, {}, {}});
    }
    Body& body = bodies[at];
    body.meshes.push_back(id);
    const Mat3& linear = pose.linear(id);
    const Vec3& translation = pose.world_translation(id);
    for (const Vec3& vertex : pose.local_vertices(id)) body.box.extend(Vec3(linear * vertex + translation));
  }
  return bodies;
}

}  // namespace echopath
