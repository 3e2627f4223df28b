#include "echopath/trace/embree/embree_meshes.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "echopath/base/range_of_coordinates.h"

namespace echopath {

bool EmbreeMeshes::Source::is_of(const Scene& scene, const PosedScene& pose, uint32_t mesh_id) const {
  const Node& node = scene.node_of(mesh_id);
  return mesh == node.mesh && deformation == node.deformation && (!moves(deformation) || time == pose.time()) &&
         translation == pose.world_translation(mesh_id) && linear == pose.linear(mesh_id) && smooth == node.smooth &&
         is_sheet == node.material->is_sheet() && object == scene.meshes()[mesh_id].object &&
         is_moving == scene.is_moving(mesh_id);
}

EmbreeMeshes::Source EmbreeMeshes::source_of(const Scene& scene, const PosedScene& pose, uint32_t mesh_id) {
  const Node& node = scene.node_of(mesh_id);
  Source source;
  source.mesh = node.mesh;
  source.deformation = node.deformation;
  source.time = pose.time();
  source.linear = pose.linear(mesh_id);
  source.translation = pose.world_translation(mesh_id);
  source.smooth = node.smooth;
  source.is_moving = scene.is_moving(mesh_id);
  source.is_sheet = node.material->is_sheet();
  source.object = scene.meshes()[mesh_id].object;
  return source;
}

std::vector<uint32_t> EmbreeMeshes::take_sources(const Scene& scene, const PosedScene& pose) {
  if (meshes_.size() != scene.meshes().size()) meshes_.clear();
  meshes_.resize(scene.meshes().size());
  world_boxes_.resize(meshes_.size());
  std::vector<uint32_t> changed;
  for (uint32_t mesh_id = 0; mesh_id < size(); ++mesh_id) {
    if (meshes_[mesh_id].source.is_of(scene, pose, mesh_id)) continue;
    meshes_[mesh_id].source = source_of(scene, pose, mesh_id);
    changed.push_back(mesh_id);
  }
  return changed;
}

void EmbreeMeshes::place_in_world(const PosedScene& pose, uint32_t mesh_id) {
  Posed& posed = meshes_[mesh_id];
  posed.width = std::make_unique<Lazy<double>>();
  posed.vertices = pose.world_vertices(mesh_id);
  world_boxes_[mesh_id] = box_about(posed.vertices);
  posed.normals = posed.source.smooth ? pose.world_normals(mesh_id) : std::vector<Vec3>();
}

void EmbreeMeshes::count_from_origin(const Scene& scene, uint32_t mesh_id) {
  for (Vec3& vertex : meshes_[mesh_id].vertices) {
    vertex -= origin_;
    if (is_in_range(vertex)) continue;
    require_in_range(vertex, "scene", "from the radar, vertices of mesh '" + scene.node_of(mesh_id).name + "'");
  }
}

std::vector<uint32_t> EmbreeMeshes::update(const Scene& scene, const PosedScene& pose, const OriginRule& origin) {
  std::vector<uint32_t> changed = take_sources(scene, pose);
  for (const uint32_t mesh_id : changed) place_in_world(pose, mesh_id);
  Box all;
  for (const Box& box : world_boxes_) all.extend(box);
  const Vec3 next = origin(all);
  require_in_range(next, "scene", "what is next to the radar");
  if (next != origin_) {
    origin_ = next;
    std::vector<uint32_t> whole(meshes_.size()), others;
    std::iota(whole.begin(), whole.end(), 0u);
    std::set_difference(whole.begin(), whole.end(), changed.begin(), changed.end(), std::back_inserter(others));
    for (const uint32_t mesh_id : others) place_in_world(pose, mesh_id);
    changed = std::move(whole);
  }
  for (const uint32_t mesh_id : changed) count_from_origin(scene, mesh_id);
  return changed;
}

const Mat3* EmbreeMeshes::rigid_pose(uint32_t mesh_id) const {
  const Source& source = meshes_[mesh_id].source;
  return source.deformation ? nullptr : &source.linear;
}

Box EmbreeMeshes::box(uint32_t mesh_id) const {
  const Box& box = world_boxes_[mesh_id];
  return box.isEmpty() ? box : Box(box.min() - origin_, box.max() - origin_);
}

EmbreeMeshes::Extent EmbreeMeshes::extent() const {
  Extent extent;
  double volumes = 0.0;
  for (uint32_t mesh_id = 0; mesh_id < size(); ++mesh_id) {
    extent.is_anything_moving = extent.is_anything_moving || is_moving(mesh_id);
    const Box own = box(mesh_id);
    if (own.isEmpty()) continue;
    extent.box.extend(own);
    volumes += own.volume();
  }
  if (extent.box.isEmpty()) return extent;
  extent.largest_coordinate = std::max(extent.box.min().cwiseAbs().maxCoeff(), extent.box.max().cwiseAbs().maxCoeff());
  extent.mean_cover = volumes > 0.0 ? volumes / extent.box.volume() : 0.0;
  return extent;
}

}  // namespace echopath
