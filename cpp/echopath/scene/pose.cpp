#include <utility>

#include "echopath/scene/scene.h"
#include "echopath/scene/smooth.h"
#include "echopath/scene/surface_patch.h"

namespace echopath {
namespace {

// Parents come before their children, so one pass in order is enough.
std::vector<Transform> world_from_nodes(const Scene& scene, double time) {
  std::vector<Transform> result;
  result.reserve(scene.nodes().size());
  for (const Node& node : scene.nodes()) {
    const Transform local = moved(node.placement, node.motion.get(), time);
    result.push_back(node.parent < 0 ? local : result[static_cast<size_t>(node.parent)] * local);
  }
  return result;
}

std::vector<Vec3> transformed(const Transform& transform, std::vector<Vec3> points) {
  for (Vec3& point : points) point = transform * point;
  return points;
}

// Returns unit vertex normals [V] in the mesh's frame.
std::vector<Vec3> deformed_normals(const Node& node, double time) {
  const SurfacePatch patch = make_patch(*node.mesh, std::vector<uint8_t>(node.mesh->triangles().size(), 1), true);
  std::vector<Vec3> vertices, normals;
  node.deformation->at(time, patch.original_vertex, vertices);
  const std::vector<Vec3> of_patch = vertex_normals(vertices, patch.triangles);
  for (const uint32_t place : patch.place) normals.push_back(of_patch[place]);
  return normals;
}

}  // namespace

std::vector<Transform> world_from_meshes(const Scene& scene, double time) {
  const std::vector<Transform> world_from_node = world_from_nodes(scene, time);
  std::vector<Transform> result;
  result.reserve(scene.meshes().size());
  for (const SceneMesh& mesh : scene.meshes()) result.push_back(world_from_node[static_cast<size_t>(mesh.node)]);
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

Pose::Pose(const Scene& scene, double time)
    : scene_(&scene), time_(time), world_from_mesh_(world_from_meshes(scene, time)), deformed_(scene.meshes().size()) {
  for (size_t i = 0; i < deformed_.size(); ++i) {
    const Node& node = scene.node_of(static_cast<uint32_t>(i));
    if (node.deformation) node.deformation->at(time, node.mesh->original_vertex(), deformed_[i]);
  }
}

const std::vector<Vec3>& Pose::local_vertices(uint32_t mesh_id) const {
  const std::vector<Vec3>& deformed = deformed_[mesh_id];
  return deformed.empty() ? scene_->node_of(mesh_id).mesh->vertices() : deformed;
}

std::vector<Vec3> Pose::world_vertices(uint32_t mesh_id) const {
  return transformed(world_from_mesh_[mesh_id], local_vertices(mesh_id));
}

std::vector<Vec3> Pose::world_normals(uint32_t mesh_id) const {
  const Node& node = scene_->node_of(mesh_id);
  std::vector<Vec3> normals = node.deformation ? deformed_normals(node, time_) : vertex_normals(*node.mesh);
  const Mat3 to_world = cofactor_matrix(world_from_mesh_[mesh_id].linear());
  for (Vec3& normal : normals) normal = (to_world * normal).stableNormalized();
  return normals;
}

std::array<Vec3, 3> Pose::world_triangle(uint32_t mesh_id, uint32_t triangle_id) const {
  const Transform& world_from_mesh = world_from_mesh_[mesh_id];
  const std::vector<Vec3>& vertices = local_vertices(mesh_id);
  const Triangle& triangle = scene_->node_of(mesh_id).mesh->triangles()[triangle_id];
  return {world_from_mesh * vertices[triangle[0]], world_from_mesh * vertices[triangle[1]],
          world_from_mesh * vertices[triangle[2]]};
}

}  // namespace echopath
