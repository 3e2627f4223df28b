#include "echopath/trace/strata/scene_objects.h"

#include <algorithm>
#include <cmath>

namespace echopath {

std::vector<SceneObject> objects_of(const Scene& scene) {
  MeshesByNode found;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    if (!scene.node_of(id).material->mirror) found.add(scene.meshes()[id].object, id);
  }
  return found.found();
}

int64_t count_objects(const Scene& scene) {
  std::vector<bool> is_object(scene.nodes().size());
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    if (!scene.node_of(id).material->mirror) is_object[static_cast<size_t>(scene.meshes()[id].object)] = true;
  }
  return std::ranges::count(is_object, true);
}

std::vector<SceneObject> parts_of(const Scene& scene, const SceneObject& object) {
  MeshesByNode found;
  for (const uint32_t id : object.mesh_ids) {
    int node = scene.meshes()[id].node;
    const auto parent = [&] { return scene.nodes()[node].parent; };
    while (node != object.node && parent() != object.node) node = parent();
    found.add(node, id);
  }
  return found.found();
}

Sphere bounding_sphere(const VerticesOf& vertices_of, const std::vector<uint32_t>& mesh_ids) {
  Box box;
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
