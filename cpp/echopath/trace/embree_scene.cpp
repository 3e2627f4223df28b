#include "echopath/trace/embree_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "echopath/scene/smooth.h"

namespace echopath {
namespace {

// A hit is confirmed when the rebuilt point lies this near the ray: 1 mm plus 1e-5 of the distance.
constexpr double kFalseHitAbsolute = 1e-3;  // m
constexpr double kFalseHitRelative = 1e-5;
constexpr double kSmoothGrazing = 0.02;  // cosine of incidence below which the facet's own normal serves
constexpr float kInfinity = std::numeric_limits<float>::infinity();

bool keep_building(void* job, double) { return job == nullptr || !static_cast<Job*>(job)->cancelled(); }

void set_ray(RTCRay& ray, const Vec3& from, const Vec3& direction, float far) {
  ray.org_x = static_cast<float>(from.x());
  ray.org_y = static_cast<float>(from.y());
  ray.org_z = static_cast<float>(from.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = 0.0f;
  ray.tfar = far;
  ray.time = 0.0f;
  ray.mask = 0xFFFFFFFFu;
  ray.id = 0;
  ray.flags = 0;
}

void embree_intersect(RTCScene scene, RTCRayHit& query) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
#endif
}

void embree_occluded(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace

struct EmbreeScene::Device {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  double lift = 0.0;  // m

  ~Device() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  void check(const char* what) const {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_CANCELLED) throw Cancelled();
    if (code != RTC_ERROR_NONE) throw DeviceError(std::string("Embree: ") + what + " failed, code " + std::to_string(code));
  }
  void add_mesh(unsigned mesh_id, const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);
};

void EmbreeScene::Device::add_mesh(unsigned mesh_id, const std::vector<Vec3>& vertices,
                                   const std::vector<Triangle>& triangles) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                             3 * sizeof(float), vertices.size()));
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(uint32_t), triangles.size()));
  if (!points || !indices) {
    rtcReleaseGeometry(geometry);
    throw DeviceError("Embree: out of memory for " + std::to_string(triangles.size()) + " triangles");
  }
  for (size_t i = 0; i < vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) points[3 * i + axis] = static_cast<float>(vertices[i][axis]);
  }
  for (size_t i = 0; i < triangles.size(); ++i) std::copy(triangles[i].begin(), triangles[i].end(), indices + 3 * i);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, mesh_id);
  rtcReleaseGeometry(geometry);
}

EmbreeScene::EmbreeScene(const Scene& scene, const Pose& pose, const Vec3& origin, Job* job)
    : device_(std::make_unique<Device>()), scene_(&scene) {
  device_->device = rtcNewDevice(nullptr);
  if (!device_->device) throw DeviceError("Embree: no device could be made");
  device_->scene = rtcNewScene(device_->device);
  rtcSetSceneFlags(device_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(device_->scene, RTC_BUILD_QUALITY_MEDIUM);
  rtcSetSceneProgressMonitorFunction(device_->scene, keep_building, job);

  double largest = 1.0;
  const auto num_meshes = static_cast<uint32_t>(scene.meshes().size());
  vertices_.resize(num_meshes);
  for (uint32_t mesh_id = 0; mesh_id < num_meshes; ++mesh_id) {
    std::vector<Vec3>& vertices = vertices_[mesh_id];
    vertices = pose.world_vertices(mesh_id);
    for (Vec3& vertex : vertices) {
      vertex -= origin;
      largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
    }
    const Node& node = scene.node_of(mesh_id);
    device_->add_mesh(mesh_id, vertices, node.mesh->triangles());
    normals_.push_back(node.smooth ? pose.world_normals(mesh_id) : std::vector<Vec3>());
  }
  device_->lift = 4.0 * 0x1.0p-24 * largest;
  reach_ = 2.0 * largest;
  rtcCommitScene(device_->scene);
  if (job) job->throw_if_cancelled();
  device_->check("building the scene");
}

EmbreeScene::~EmbreeScene() = default;

std::array<Vec3, 3> EmbreeScene::corners(uint32_t mesh_id, uint32_t triangle_id) const {
  const Triangle& triangle = scene_->node_of(mesh_id).mesh->triangles()[triangle_id];
  const std::vector<Vec3>& vertices = vertices_[mesh_id];
  return {vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]};
}

Vec3 EmbreeScene::origin_near(const Scene& scene, const Pose& pose, const Vec3& near) {
  Eigen::AlignedBox3d box;
  for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) {
    for (const Vec3& vertex : pose.world_vertices(mesh_id)) box.extend(vertex);
  }
  return box.isEmpty() ? near : Vec3(near.cwiseMax(box.min()).cwiseMin(box.max()));
}

Vec3 EmbreeScene::moved_up(const Vec3& from, const Vec3& direction) const {
  const double distance = -from.dot(direction);  // to the point of the ray next to the origin
  return distance > 2.0 * reach_ ? Vec3(from + (distance - 2.0 * reach_) * direction) : from;
}

EmbreeScene::Verdict EmbreeScene::intersect(const Vec3& from, const Vec3& direction, RayHit& out) const {
  RTCRayHit query;
  set_ray(query.ray, moved_up(from, direction), direction, kInfinity);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree_intersect(device_->scene, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Verdict::kMiss;

  out.hit = {query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v};
  const auto [a, b, c] = corners(out.hit.mesh_id, out.hit.triangle_id);
  const double u = out.hit.u, v = out.hit.v;
  out.position = a + u * (b - a) + v * (c - a);
  out.distance = direction.dot(out.position - from);
  const double miss = (from + out.distance * direction - out.position).norm();
  if (out.distance <= 0 || miss > kFalseHitAbsolute + kFalseHitRelative * out.distance) return Verdict::kFalseHit;
  out.normal = (b - a).cross(c - a).normalized();
  out.is_smooth = false;
  if (!normals_[out.hit.mesh_id].empty()) curve({a, b, c}, direction, out);
  if (out.normal.dot(direction) > 0) {
    out.normal = -out.normal;
    out.curvature = -out.curvature;
  }
  return Verdict::kHit;
}

// Moves the hit to the curved surface, unless a crease or a grazing ray forbids it. Where that lies behind the facet
// (concave), rays that leave it would meet the facet: there the position stays.
void EmbreeScene::curve(const std::array<Vec3, 3>& corners, const Vec3& direction, RayHit& hit) const {
  const Triangle& triangle = scene_->node_of(hit.hit.mesh_id).mesh->triangles()[hit.hit.triangle_id];
  const std::vector<Vec3>& of_vertices = normals_[hit.hit.mesh_id];
  const std::array<Vec3, 3> normals = {of_vertices[triangle[0]], of_vertices[triangle[1]], of_vertices[triangle[2]]};
  if (!is_smooth_facet(hit.normal, normals)) return;
  const SmoothPoint smooth = smooth_point(corners, normals, hit.hit.u, hit.hit.v);
  if (std::abs(smooth.normal.dot(direction)) < kSmoothGrazing) return;
  hit.is_smooth = true;
  hit.stretch = smooth.stretch * std::abs(smooth.normal.dot(direction)) / std::abs(hit.normal.dot(direction));
  const double out_of_facet = hit.normal.dot(smooth.position - hit.position);
  if (out_of_facet * hit.normal.dot(direction) <= 0) hit.position = smooth.position;
  hit.normal = smooth.normal;
  hit.curvature = smooth.curvature;
}

bool EmbreeScene::occluded(const Vec3& from, const Vec3& to) const {
  const Vec3 segment = to - from;
  const double length = segment.norm();
  if (length <= 2.0 * device_->lift) return false;
  RTCRay ray;
  const Vec3 direction = segment / length, start = moved_up(from, direction);
  const double rest = length - direction.dot(start - from);
  set_ray(ray, start, direction, static_cast<float>(rest * (1.0 - 1e-6)));
  embree_occluded(device_->scene, ray);
  return ray.tfar < 0;  // Embree marks an occluded ray with -infinity
}

Vec3 EmbreeScene::lifted(const Vec3& point, const Vec3& normal) const { return point + device_->lift * normal; }

}  // namespace echopath
