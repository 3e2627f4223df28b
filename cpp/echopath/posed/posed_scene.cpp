#include "echopath/posed/posed_scene.h"

#include "echopath/base/errors.h"
#include "echopath/base/range_of_coordinates.h"
#include "echopath/base/text/streamed.h"
#include "echopath/scene/smooth/kept_normals.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath {
namespace {

// Returns the unit vertex normals [V] of a deforming mesh, in its frame.
std::vector<Vec3> whole_deformed_normals(const Node& node, double time) {
  const SurfacePatch patch = make_patch(*node.mesh, std::vector<uint8_t>(node.mesh->triangles().size(), 1), true);
  std::vector<Vec3> vertices, normals;
  node.deformation->at(time, patch.original_vertex, vertices);
  const std::vector<Vec3> of_patch = vertex_normals(vertices, patch.triangles, patch.creases);
  for (const uint32_t place : patch.place) normals.push_back(of_patch[place]);
  return normals;
}

}  // namespace

PosedScene::PosedScene(const Scene& scene, double time) : scene_(&scene), time_(time) {
  place_meshes();
  for (uint32_t id = 0; id < num_meshes(); ++id) {
    const Node& node = scene.node_of(id);
    if (node.deformation) node.deformation->at(time, node.mesh->original_vertex(), deformed_[id]);
  }
}

PosedScene::PosedScene(const Scene& scene, const Radar& radar, const MeshesToPose& meshes, const Vec3& origin, double time)
    : PosedScene(scene, radar, origin, time) {
  add(meshes.places, meshes.nodes, meshes.patches);
}

PosedScene::PosedScene(const Scene& scene, const Radar& radar, const Vec3& origin, double time)
    : scene_(&scene), time_(time), is_in_patches_(true), origin_(origin),
      places_(std::make_shared<const MeshPlaces>(scene.meshes().size())) {
  require_time(time_, "time");
  const Transform world_from_radar = radar.world_from_radar(time);
  transmitters = posed_antennas(radar.transmitters, world_from_radar, origin);
  receivers = posed_antennas(radar.receivers, world_from_radar, origin);
}

void PosedScene::add(const std::shared_ptr<const MeshPlaces>& places, const PlacingNodes& nodes,
                     const std::vector<SurfacePatch>& patches) {
  const std::vector<Transform> world_from_meshes = nodes.world_from_meshes(time_);
  const size_t first = linear_.size(), count = places->meshes.size();
  places_ = places;
  deformed_.resize(count);
  deformed_normals_.resize(count);
  for (size_t place = first; place < count; ++place) {
    const uint32_t id = places->meshes[place];
    this->place(id, world_from_meshes[place - first]);
    deform(id, patches[id]);
  }
}

void PosedScene::deform(uint32_t mesh_id, const SurfacePatch& patch) {
  const Node& node = scene_->node_of(mesh_id);
  if (!node.deformation) return;
  std::vector<Vec3>& vertices = deformed_[at(mesh_id)];
  node.deformation->at(time_, patch.original_vertex, vertices);
  if (node.smooth) deformed_normals_[at(mesh_id)] = vertex_normals(vertices, patch.triangles, patch.creases);
}

void PosedScene::place_meshes() {
  require_time(time_, "time");
  const std::vector<Transform> world_from_node = world_from_nodes(*scene_, time_);
  const size_t count = scene_->meshes().size();
  linear_.reserve(count);
  normal_matrix_.reserve(count);
  world_translation_.reserve(count);
  for (uint32_t id = 0; id < num_meshes(); ++id) {
    place(id, world_from_node[scene_->meshes()[id].node]);
  }
  deformed_.resize(linear_.size());
  deformed_normals_.resize(linear_.size());
}

void PosedScene::place(uint32_t mesh_id, const Transform& world_from_mesh) {
  const std::string& name = scene_->node_of(mesh_id).name;
  if (!world_from_mesh.linear().allFinite()) {
    require(false, "scene", "the motions of mesh '" + name + "' must turn it by finite angles",
            streamed("one that is not finite at ", time_, " s"));
  }
  if (!is_in_range(world_from_mesh.translation())) {
    require_in_range(world_from_mesh.translation(), "scene", "the place of mesh '" + name + "'");
  }
  linear_.push_back(world_from_mesh.linear());
  normal_matrix_.push_back(cofactor_matrix(world_from_mesh.linear()));
  world_translation_.push_back(world_from_mesh.translation());
}

const std::vector<Vec3>& PosedScene::local_vertices(uint32_t mesh_id) const {
  const Node& node = scene_->node_of(mesh_id);
  return node.deformation ? deformed_[at(mesh_id)] : node.mesh->vertices();
}

void PosedScene::require_whole(uint32_t mesh_id) const {
  require(!is_in_patches_ || !scene_->node_of(mesh_id).deformation, "mesh_id", "must be posed as a whole", mesh_id);
}

std::vector<Vec3> PosedScene::world_vertices(uint32_t mesh_id) const {
  require_whole(mesh_id);
  std::vector<Vec3> vertices = local_vertices(mesh_id);
  for (Vec3& vertex : vertices) vertex = in_world(mesh_id, vertex);
  return vertices;
}

std::vector<Vec3> PosedScene::world_normals(uint32_t mesh_id) const {
  const Node& node = scene_->node_of(mesh_id);
  std::vector<Vec3> normals = node.deformation ? whole_deformed_normals(node, time_) : *kept_vertex_normals(node.mesh);
  for (Vec3& normal : normals) normal = (normal_matrix(mesh_id) * normal).stableNormalized();
  return normals;
}

std::array<Vec3, 3> PosedScene::world_triangle(uint32_t mesh_id, uint32_t triangle_id) const {
  require_whole(mesh_id);
  const std::vector<Vec3>& vertices = local_vertices(mesh_id);
  const Triangle& triangle = scene_->node_of(mesh_id).mesh->triangles()[triangle_id];
  return {in_world(mesh_id, vertices[triangle[0]]), in_world(mesh_id, vertices[triangle[1]]),
          in_world(mesh_id, vertices[triangle[2]])};
}

}  // namespace echopath
