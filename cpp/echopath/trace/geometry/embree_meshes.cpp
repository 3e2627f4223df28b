#include "echopath/trace/geometry/embree_meshes.h"

#include <algorithm>
#include <utility>

#include "echopath/base/range_of_coordinates.h"

namespace echopath {

bool EmbreeMeshes::Source::is_same(const Source& other) const {
  return mesh == other.mesh && deformation == other.deformation && time == other.time && smooth == other.smooth &&
         object == other.object && linear == other.linear && translation == other.translation;
}

EmbreeMeshes::Source EmbreeMeshes::source_of(const Scene& scene, const PosedScene& pose, uint32_t mesh_id) {
  const Node& node = scene.node_of(mesh_id);
  const double time = node.deformation ? pose.time() : 0.0;
  return {node.mesh,
          node.deformation,
          time,
          pose.linear(mesh_id),
          pose.world_translation(mesh_id),
          node.smooth,
          scene.meshes()[mesh_id].object};
}

void EmbreeMeshes::place(Posed& posed, const PosedScene& pose, uint32_t mesh_id, const std::string& name) const {
  posed.vertices = pose.world_vertices(mesh_id);
  posed.box.setEmpty();
  for (Vec3& vertex : posed.vertices) {
    vertex -= origin_;
    if (!is_in_range(vertex)) require_in_range(vertex, "scene", "from the radar, vertices of mesh '" + name + "'");
    posed.box.extend(vertex);
  }
  posed.normals = posed.source.smooth ? pose.world_normals(mesh_id) : std::vector<Vec3>();
}

std::vector<uint32_t> EmbreeMeshes::update(const Scene& scene, const PosedScene& pose, const Vec3& origin) {
  require_in_range(origin, "scene", "what is next to the radar");
  if (origin != origin_ || meshes_.size() != scene.meshes().size()) meshes_.clear();
  origin_ = origin;
  meshes_.resize(scene.meshes().size());
  std::vector<uint32_t> changed;
  for (uint32_t mesh_id = 0; mesh_id < size(); ++mesh_id) {
    Posed& posed = meshes_[mesh_id];
    Source source = source_of(scene, pose, mesh_id);
    if (source.is_same(posed.source)) continue;
    posed.source = std::move(source);
    place(posed, pose, mesh_id, scene.node_of(mesh_id).name);
    changed.push_back(mesh_id);
  }
  return changed;
}

bool EmbreeMeshes::is_current(const Scene& scene, const PosedScene& pose) const {
  if (meshes_.size() != scene.meshes().size()) return false;
  for (uint32_t mesh_id = 0; mesh_id < size(); ++mesh_id) {
    if (!source_of(scene, pose, mesh_id).is_same(meshes_[mesh_id].source)) return false;
  }
  return true;
}

Eigen::AlignedBox3d EmbreeMeshes::box() const {
  Eigen::AlignedBox3d whole;
  for (const Posed& posed : meshes_) whole.extend(posed.box);
  return whole;
}

double EmbreeMeshes::largest_coordinate() const {
  double largest = 0.0;
  for (const Posed& posed : meshes_) {
    if (posed.box.isEmpty()) continue;
    largest = std::max({largest, posed.box.min().cwiseAbs().maxCoeff(), posed.box.max().cwiseAbs().maxCoeff()});
  }
  return largest;
}

double EmbreeMeshes::mean_cover() const {
  double volumes = 0.0;
  for (const Posed& posed : meshes_) {
    if (!posed.box.isEmpty()) volumes += posed.box.volume();
  }
  return volumes > 0.0 ? volumes / box().volume() : 0.0;
}

}  // namespace echopath
