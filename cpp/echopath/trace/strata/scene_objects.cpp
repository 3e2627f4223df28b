#include "echopath/trace/strata/scene_objects.h"

#include <algorithm>
#include <cmath>

namespace echopath {

std::vector<SceneObject> objects_of(const Scene& scene) {
  std::vector<SceneObject> objects;
  std::vector<int> place(scene.nodes().size(), -1);  // among the objects, by node
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    if (scene.node_of(id).material->mirror) continue;
    const int node = scene.meshes()[id].object;
    int& index = place[static_cast<size_t>(node)];
    if (index < 0) {
      index = static_cast<int>(objects.size());
      objects.push_back({node, {}});
    }
    objects[static_cast<size_t>(index)].mesh_ids.push_back(id);
  }
  return objects;
}

Sphere bounding_sphere(const VerticesOf& vertices_of, const std::vector<uint32_t>& mesh_ids) {
  Eigen::AlignedBox3d box;
  for (const uint32_t id : mesh_ids) {
    for (const Vec3& vertex : vertices_of(id)) box.extend(vertex);
  }
  const Vec3 centre = box.center();
  double square = 0.0;  // m^2, of the radius
  for (const uint32_t id : mesh_ids) {
    for (const Vec3& vertex : vertices_of(id)) square = std::max(square, (vertex - centre).squaredNorm());
  }
  return {centre, std::sqrt(square)};
}

}  // namespace echopath
