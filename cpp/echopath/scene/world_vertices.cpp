#include <optional>
#include <utility>

#include "echopath/scene/chained_transforms.h"
#include "echopath/scene/scene.h"

namespace echopath {
namespace {

std::vector<Vec3> transformed(const Transform& transform, std::vector<Vec3> points) {
  for (Vec3& point : points) point = transform * point;
  return points;
}

}  // namespace

Transform Scene::local_transform(int index, double time) const {
  const Node& node = at(index);
  return moved(node.placement, takes_part(index) ? node.motion.get() : nullptr, time);
}

std::vector<Transform> world_from_nodes(const Scene& scene, double time) {
  const std::vector<Node>& nodes = scene.nodes();
  return chained_transforms(nodes.size(), [&](size_t i) { return scene.local_transform(static_cast<int>(i), time); },
                            [&](size_t i) { return nodes[i].parent; });
}

std::vector<Vec3> world_vertices(const Scene& scene, uint32_t mesh_id, double time) {
  const Node& node = scene.node_of(mesh_id);
  Transform world_from_mesh = Transform::Identity();
  for (int i = scene.meshes()[mesh_id].node; i >= 0; i = scene.nodes()[i].parent) {
    const Node& above = scene.nodes()[i];
    world_from_mesh = moved(above.placement, above.motion.get(), time) * world_from_mesh;
  }
  if (!node.deformation) return transformed(world_from_mesh, node.mesh->vertices());
  std::vector<Vec3> vertices;
  node.deformation->at(time, node.mesh->original_vertex(), vertices);
  return transformed(world_from_mesh, std::move(vertices));
}

// Moments are about a vertex of the surface: about the origin of the world those of a body far away would round more.
Vec3 surface_centroid(const Scene& scene, std::span<const uint32_t> mesh_ids, double time) {
  std::optional<Vec3> origin;
  Vec3 moment = Vec3::Zero();
  double twice_area = 0.0;
  for (const uint32_t mesh_id : mesh_ids) {
    const std::vector<Vec3> vertices = world_vertices(scene, mesh_id, time);
    if (!origin) origin = vertices.front();
    for (const Triangle& triangle : scene.node_of(mesh_id).mesh->triangles()) {
      const double twice = cross_of_sides(vertices, triangle).norm();
      for (const uint32_t corner : triangle) moment += twice / 3.0 * (vertices[corner] - *origin);
      twice_area += twice;
    }
  }
  return origin.value_or(Vec3::Zero()) + moment / twice_area;
}

}  // namespace echopath
