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

Vec3 surface_centroid(const Scene& scene, std::span<const uint32_t> mesh_ids, double time) {
  Vec3 moment = Vec3::Zero();
  double twice_area = 0.0;
  for (const uint32_t mesh_id : mesh_ids) {
    const std::vector<Vec3> vertices = world_vertices(scene, mesh_id, time);
    for (const Triangle& triangle : scene.node_of(mesh_id).mesh->triangles()) {
      const double twice = cross_of_sides(vertices, triangle).norm();
      moment += twice / 3.0 * (vertices[triangle[0]] + vertices[triangle[1]] + vertices[triangle[2]]);
      twice_area += twice;
    }
  }
  return moment / twice_area;
}

}  // namespace echopath
