#pragma once
// What counts as an object of a scene, and the ball that holds one.
#include <functional>
#include <vector>

#include "echopath/scene/scene.h"

namespace echopath {

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;  // m

  bool holds(const Vec3& point) const { return (centre - point).norm() <= radius; }
};

// A child of the scene's root with the meshes below it that are not flagged mirrors; never without one.
struct SceneObject {
  int node = 0;  // index into Scene::nodes()
  std::vector<uint32_t> mesh_ids;
};

// In the order of their first mesh.
std::vector<SceneObject> objects_of(const Scene& scene);

// Vertices of a mesh in the axes of the caller.
using VerticesOf = std::function<const std::vector<Vec3>&(uint32_t mesh_id)>;

// About the centre of the box of the vertices.
Sphere bounding_sphere(const VerticesOf& vertices_of, const std::vector<uint32_t>& mesh_ids);

}  // namespace echopath
