#include "echopath/trace/scene_objects.h"

#include <algorithm>
#include <cmath>

namespace echopath {

std::vector<SceneObject> objects_of(const Scene& scene) {
  std::vector<SceneObject> objects;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) {
    if (scene.node_of(id).material->mirror) continue;
    const int node = scene.meshes()[id].object;
    const auto is_its = [&](const SceneObject& object) { return object.node == node; };
    const auto found = std::find_if(objects.begin(), objects.end(), is_its);
    if (found == objects.end()) {
      objects.push_back({node, {id}});
    } else {
      found->mesh_ids.push_back(id);
    }
  }
  return objects;
}

Sphere bounding_sphere(const VerticesOf& vertices_of, const std::vector<uint32_t>& mesh_ids) {
  Eigen::AlignedBox3d box;
  for (const uint32_t id : mesh_ids) {
    for (const Vec3& vertex : vertices_of(id)) box.extend(vertex);
  }
  Sphere sphere{box.center(), 0.0};
  for (const uint32_t id : mesh_ids) {
    for (const Vec3& vertex : vertices_of(id)) sphere.radius = std::max(sphere.radius, (vertex - sphere.centre).norm());
  }
  return sphere;
}

Stratum cone_around(const Sphere& sphere, const Vec3& apex, std::string name) {
  const Vec3 line = sphere.centre - apex;
  const double distance = line.norm();
  const double sine = std::min(1.0, sphere.radius / distance);
  Stratum stratum;
  stratum.axis = line / distance;
  // Without cancellation.
  stratum.versine = std::min(2.0, sine * sine / (1.0 + std::sqrt(1.0 - sine * sine)) * kConeMargin);
  stratum.name = std::move(name);
  return stratum;
}

}  // namespace echopath
