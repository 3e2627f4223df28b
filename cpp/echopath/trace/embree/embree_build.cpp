// Builds Embree's scene and keeps it up to date.
#include <algorithm>
#include <string>

#include "echopath/base/errors.h"
#include "echopath/base/threads/one_thread.h"
#include "echopath/trace/embree/embree_device.h"

namespace echopath {
namespace {

constexpr size_t kMostWithoutTree = 4;  // triangles of a mesh that Embree puts into the upper tree themselves
constexpr size_t kFewToGrow = 20000;    // triangles whose trees one thread grows in 4 ms

bool keep_building(void* job, double) { return job == nullptr || !static_cast<Job*>(job)->cancelled(); }

float* vertices_of(RTCGeometry geometry) {
  return static_cast<float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
}

float* write(const Vec3& vertex, float* out) {
  for (int axis = 0; axis < 3; ++axis) *out++ = static_cast<float>(vertex[axis]);
  return out;
}

void write_vertices(RTCGeometry geometry, const std::vector<Vec3>& vertices) {
  float* out = vertices_of(geometry);
  for (const Vec3& vertex : vertices) out = write(vertex, out);
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
}

// The tree follows from the directions of the edges alone, so the origin is that of least rounding.
void write_shape(RTCGeometry geometry, const Mesh& mesh, const TreeShape& shape) {
  const Mat3 rotation = shape.rotation();
  float* out = vertices_of(geometry);
  for (const Vec3& vertex : mesh.vertices()) out = write(rotation * (vertex - mesh.vertices().front()), out);
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
}

TreeShape shape_of(const EmbreeMeshes& meshes, uint32_t mesh_id) {
  if (meshes.triangles(mesh_id).size() <= kMostWithoutTree) return {};
  const Mat3* linear = meshes.rigid_pose(mesh_id);
  return linear ? shape_of_rigid(meshes.mesh(mesh_id), *linear, meshes.vertices(mesh_id))
                : shape_of_deformed(meshes.mesh(mesh_id), meshes.vertices(mesh_id));
}

}  // namespace

void EmbreeScene::Device::check(const char* what) const {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_CANCELLED) throw Cancelled();
  if (code != RTC_ERROR_NONE) throw DeviceError(std::string("Embree: ") + what + " failed, code " + std::to_string(code));
}

void EmbreeScene::Device::start_scene(size_t num_ids, bool tree_per_mesh) {
  if (scene) rtcReleaseScene(scene);
  scene = rtcNewScene(device);
  has_tree_per_mesh = tree_per_mesh;
  trees_.assign(num_ids, {});
  to_fit_.clear();
  num_to_grow_ = 0;
  rtcSetSceneFlags(scene, tree_per_mesh ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, tree_per_mesh ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
}

// Shares the triangles where they are given; they must outlive the geometry.
RTCGeometry EmbreeScene::Device::new_geometry(size_t num_vertices, size_t num_triangles, const Triangle* shared) const {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), num_vertices);
  if (shared) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, shared, 0, sizeof(Triangle),
                               num_triangles);
  } else {
    rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), num_triangles);
  }
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    rtcReleaseGeometry(geometry);
    throw DeviceError("Embree: out of memory for " + std::to_string(num_triangles) + " triangles");
  }
  return geometry;
}

void EmbreeScene::Device::attach(uint32_t id, RTCGeometry geometry) {
  remove(id);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
  trees_[id].geometry = geometry;
}

void EmbreeScene::Device::remove(uint32_t id) {
  if (trees_[id].geometry) rtcDetachGeometry(scene, id);
  trees_[id] = {};
}

void EmbreeScene::Device::set_mesh(uint32_t mesh_id, const EmbreeMeshes& meshes) {
  const std::vector<Triangle>& triangles = meshes.triangles(mesh_id);
  Tree& tree = trees_[mesh_id];
  const bool is_new = !has_tree_per_mesh || tree.triangles != triangles.data();
  if (is_new) attach(mesh_id, new_geometry(meshes.vertices(mesh_id).size(), triangles.size(), triangles.data()));
  tree.triangles = triangles.data();
  const TreeShape shape = has_tree_per_mesh ? shape_of(meshes, mesh_id) : TreeShape{};
  const bool grows = is_new || shape.is_present || shape != tree.shape;
  tree.shape = shape;
  if (grows && !shape.is_present) {
    write_shape(tree.geometry, meshes.mesh(mesh_id), shape);
    to_fit_.push_back(mesh_id);
  } else {
    write_vertices(tree.geometry, meshes.vertices(mesh_id));
  }
  if (grows) num_to_grow_ += triangles.size();
  if (grows && !is_new) rtcUpdateGeometryBuffer(tree.geometry, RTC_BUFFER_TYPE_INDEX, 0);  // Embree grows it anew
  rtcSetGeometryBuildQuality(tree.geometry, has_tree_per_mesh ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
  rtcSetGeometryMask(tree.geometry, meshes.mask_of(mesh_id));
  rtcCommitGeometry(tree.geometry);
}

void EmbreeScene::Device::set_cluster(uint32_t id, const EmbreeMeshes& meshes, const std::vector<uint32_t>& mesh_ids) {
  size_t num_vertices = 0, num_triangles = 0;
  for (const uint32_t mesh_id : mesh_ids) {
    num_vertices += meshes.vertices(mesh_id).size();
    num_triangles += meshes.triangles(mesh_id).size();
  }
  RTCGeometry geometry = new_geometry(num_vertices, num_triangles, nullptr);
  float* vertices = vertices_of(geometry);
  auto* corner = static_cast<uint32_t*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
  uint32_t first = 0;
  for (const uint32_t mesh_id : mesh_ids) {
    for (const Vec3& vertex : meshes.vertices(mesh_id)) vertices = write(vertex, vertices);
    for (const Triangle& triangle : meshes.triangles(mesh_id)) {
      for (const uint32_t vertex : triangle) *corner++ = first + vertex;
    }
    first += static_cast<uint32_t>(meshes.vertices(mesh_id).size());
  }
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
  rtcSetGeometryMask(geometry, static_cast<uint32_t>(Sees::kOpaque));
  rtcCommitGeometry(geometry);
  attach(id, geometry);
  num_to_grow_ += num_triangles;
}

void EmbreeScene::Device::commit(Job* job) {
  rtcSetSceneProgressMonitorFunction(scene, keep_building, job);
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  if (job) job->throw_if_cancelled();
  check("building the scene");
}

// Threads put the trees of the meshes in any order below the upper one, on which it depends which of two coincident
// triangles is met. So these grow on all threads, where there is much to grow, but the upper tree of the last commit on
// one.
void EmbreeScene::Device::build(const EmbreeMeshes& meshes, Job* job) {
  if (!has_tree_per_mesh) return commit(job);
  if (!to_fit_.empty() || num_to_grow_ > kFewToGrow) {
    commit(job);
    touch_any();
  }
  for (const uint32_t mesh_id : to_fit_) {
    write_vertices(trees_[mesh_id].geometry, meshes.vertices(mesh_id));
    rtcCommitGeometry(trees_[mesh_id].geometry);
  }
  to_fit_.clear();
  num_to_grow_ = 0;
  run_on_one_thread([&] { commit(job); });
}

// Has the next commit make the upper tree, though nothing else may be new.
void EmbreeScene::Device::touch_any() {
  const auto found = std::ranges::find_if(trees_, [](const Tree& tree) { return tree.geometry != nullptr; });
  if (to_fit_.empty() && found != trees_.end()) rtcCommitGeometry(found->geometry);
}

}  // namespace echopath
