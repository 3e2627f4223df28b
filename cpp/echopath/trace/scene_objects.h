#pragma once
// What counts as an object of a scene (PHYSICS 1.2), and the cone of directions that holds one.
#include <functional>
#include <string>
#include <vector>

#include "echopath/scene/scene.h"
#include "echopath/trace/paths.h"

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

// In the order of their first mesh. Those whose bounding sphere holds an antenna surround it, as walls and grounds do:
// they are objects to nobody.
std::vector<SceneObject> objects_of(const Scene& scene);

// Vertices of a mesh in the axes of the caller.
using VerticesOf = std::function<const std::vector<Vec3>&(uint32_t mesh_id)>;

// About the centre of the box of the vertices.
Sphere bounding_sphere(const VerticesOf& vertices_of, const std::vector<uint32_t>& mesh_ids);

// From `apex` outside of the sphere; without rays.
Stratum cone_around(const Sphere& sphere, const Vec3& apex, std::string name);

// Of versines, relative: a little wider than exact, so that single precision loses no edge.
inline constexpr double kConeMargin = 1.0 + 1e-4;

// Makes a cone no wider than the vertices need, as `image` shows them to `apex`: a long object seen end-on fills little of
// its bounding sphere. image: a function (const Vec3&) -> Vec3
template <class Image>
void tighten(Stratum& cone, const VerticesOf& vertices_of, const std::vector<uint32_t>& mesh_ids, const Vec3& apex,
             const Image& image) {
  double widest = 0.0;
  for (const uint32_t id : mesh_ids) {
    for (const Vec3& vertex : vertices_of(id)) {
      const Vec3 toward = (image(vertex) - apex).normalized();
      widest = std::max(widest, 0.5 * (toward - cone.axis).squaredNorm());
    }
  }
  cone.versine = std::min(cone.versine, widest * kConeMargin);
}

}  // namespace echopath
