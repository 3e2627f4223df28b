#include <utility>

#include "echopath/scene/scene.h"

namespace echopath {
namespace {

Transform parent_from_node(const Node& node, double time) {
  if (!node.motion) return node.placement;
  const Transform motion = node.motion->at(time);
  Transform transform = Transform::Identity();
  transform.linear() = motion.linear() * node.placement.linear();
  transform.translation() = node.placement.translation() + motion.translation();
  return transform;
}

// Parents come before their children, so one pass in order is enough.
std::vector<Transform> world_from_nodes(const Scene& scene, double time) {
  std::vector<Transform> result;
  result.reserve(scene.nodes().size());
  for (const Node& node : scene.nodes()) {
    const Transform local = parent_from_node(node, time);
    result.push_back(node.parent < 0 ? local : result[static_cast<size_t>(node.parent)] * local);
  }
  return result;
}

std::vector<Vec3> transformed(const Transform& transform, std::vector<Vec3> points) {
  for (Vec3& point : points) point = transform * point;
  return points;
}

}  // namespace

std::vector<Vec3> world_vertices(const Scene& scene, uint32_t mesh_id, double time) {
  const Node& node = scene.node_of(mesh_id);
  Transform world_from_mesh = Transform::Identity();
  for (int i = scene.meshes()[mesh_id].node; i >= 0; i = scene.nodes()[static_cast<size_t>(i)].parent) {
    world_from_mesh = parent_from_node(scene.nodes()[static_cast<size_t>(i)], time) * world_from_mesh;
  }
  if (!node.sequence) return transformed(world_from_mesh, node.mesh->vertices());
  std::vector<Vec3> vertices;
  node.sequence->at(time, node.mesh->original_vertex(), vertices);
  return transformed(world_from_mesh, std::move(vertices));
}

Pose::Pose(const Scene& scene, double time) : scene_(&scene), time_(time) {
  const std::vector<Transform> world_from_node = world_from_nodes(scene, time);
  const size_t num_meshes = scene.meshes().size();
  world_from_mesh_.reserve(num_meshes);
  deformed_.resize(num_meshes);
  for (size_t i = 0; i < num_meshes; ++i) {
    world_from_mesh_.push_back(world_from_node[static_cast<size_t>(scene.meshes()[i].node)]);
    const Node& node = scene.node_of(static_cast<uint32_t>(i));
    if (node.sequence) node.sequence->at(time, node.mesh->original_vertex(), deformed_[i]);
  }
}

const std::vector<Vec3>& Pose::local_vertices(uint32_t mesh_id) const {
  const std::vector<Vec3>& deformed = deformed_[mesh_id];
  return deformed.empty() ? scene_->node_of(mesh_id).mesh->vertices() : deformed;
}

std::vector<Vec3> Pose::world_vertices(uint32_t mesh_id) const {
  return transformed(world_from_mesh_[mesh_id], local_vertices(mesh_id));
}

std::array<Vec3, 3> Pose::world_triangle(uint32_t mesh_id, uint32_t triangle_id) const {
  const Transform& world_from_mesh = world_from_mesh_[mesh_id];
  const std::vector<Vec3>& vertices = local_vertices(mesh_id);
  const Triangle& triangle = scene_->node_of(mesh_id).mesh->triangles()[triangle_id];
  return {world_from_mesh * vertices[triangle[0]], world_from_mesh * vertices[triangle[1]],
          world_from_mesh * vertices[triangle[2]]};
}

}  // namespace echopath
