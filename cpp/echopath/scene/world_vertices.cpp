#include <utility>

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

// Parents come before their children, so one pass in order is enough.
std::vector<Transform> world_from_nodes(const Scene& scene, double time) {
  std::vector<Transform> result;
  result.reserve(scene.nodes().size());
  for (int index = 0; index < static_cast<int>(scene.nodes().size()); ++index) {
    const int parent = scene.nodes()[static_cast<size_t>(index)].parent;
    const Transform local = scene.local_transform(index, time);
    result.push_back(parent < 0 ? local : result[static_cast<size_t>(parent)] * local);
  }
  return result;
}

std::vector<Vec3> world_vertices(const Scene& scene, uint32_t mesh_id, double time) {
  const Node& node = scene.node_of(mesh_id);
  Transform world_from_mesh = Transform::Identity();
  for (int i = scene.meshes()[mesh_id].node; i >= 0; i = scene.nodes()[static_cast<size_t>(i)].parent) {
    const Node& above = scene.nodes()[static_cast<size_t>(i)];
    world_from_mesh = moved(above.placement, above.motion.get(), time) * world_from_mesh;
  }
  if (!node.deformation) return transformed(world_from_mesh, node.mesh->vertices());
  std::vector<Vec3> vertices;
  node.deformation->at(time, node.mesh->original_vertex(), vertices);
  return transformed(world_from_mesh, std::move(vertices));
}

}  // namespace echopath
