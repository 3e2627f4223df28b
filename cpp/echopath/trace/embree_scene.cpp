#include "echopath/trace/embree_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>

#include "echopath/base/simd.h"
#include "echopath/scene/smooth.h"

namespace echopath {
namespace {

// A hit is confirmed when the rebuilt point lies this near the ray: 1 mm plus 1e-5 of the distance.
constexpr double kFalseHitAbsolute = 1e-3;  // m
constexpr double kFalseHitRelative = 1e-5;
// What a ray in single precision explains of that distance, a few units. More is due to (u, v): on a triangle 10 m long and 1 mm
// high they are off by up to a millimetre.
constexpr double kRoundedAbsolute = 1e-6;  // m
constexpr double kRoundedRelative = 5e-7;
constexpr double kSmoothGrazing = 0.02;  // cosine of incidence below which the facet's own normal serves
// Of PosedMeshes::mean_cover, with a tree per mesh: loose heaps of triangles over each other would cost queries 1.5 times the time
// at 2, 4 times at 10; separate objects cost -15 to +10 %.
constexpr double kMostCover = 1.5;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Embree picks the best instruction set, too, unless another one is asked for (base/simd.h).
const char* device_options() {
#if defined(ECHOPATH_THREAD_SANITIZER)
  return "threads=1";  // what TBB's workers do in libraries that are not instrumented would look like races
#elif defined(ECHOPATH_X86_KERNELS)
  const char* asked = std::getenv("ECHOPATH_INSTRUCTION_SET");
  if (!asked || !*asked || instruction_set() == InstructionSet::kAvx512) return nullptr;
  return instruction_set() == InstructionSet::kAvx2 ? "isa=avx2" : "isa=sse2";
#else
  return nullptr;
#endif
}

bool keep_building(void* job, double) { return job == nullptr || !static_cast<Job*>(job)->cancelled(); }

template <class Vector>
void set_ray(RTCRay& ray, const Vector& from, const Vector& direction, float far) {
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

// What is the same for all rays. Lanes that are not in use hold numbers, too, and an empty interval: without AVX-512 Embree
// looks at them whatever `valid` says.
void begin_packet(RTCRay16& rays) {
  for (int lane = 0; lane < kPacketSize; ++lane) {
    rays.org_x[lane] = rays.org_y[lane] = rays.org_z[lane] = 0.0f;
    rays.dir_x[lane] = rays.dir_y[lane] = rays.dir_z[lane] = 0.0f;
    rays.tnear[lane] = 0.0f;
    rays.tfar[lane] = -1.0f;
    rays.time[lane] = 0.0f;
    rays.mask[lane] = 0xFFFFFFFFu;
    rays.id[lane] = 0;
    rays.flags[lane] = 0;
  }
}

template <class Vector>
void set_ray(RTCRay16& rays, int lane, const Vector& from, const Vector& direction, float far) {
  rays.org_x[lane] = static_cast<float>(from.x());
  rays.org_y[lane] = static_cast<float>(from.y());
  rays.org_z[lane] = static_cast<float>(from.z());
  rays.dir_x[lane] = static_cast<float>(direction.x());
  rays.dir_y[lane] = static_cast<float>(direction.y());
  rays.dir_z[lane] = static_cast<float>(direction.z());
  rays.tfar[lane] = far;
}

#if RTC_VERSION_MAJOR >= 4
void embree_intersect(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }

void embree_intersect(RTCScene scene, const int* valid, RTCRayHit16& queries) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &queries, &arguments);
}

void embree_occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }

void embree_occluded(RTCScene scene, const int* valid, RTCRay16& rays) { rtcOccluded16(valid, scene, &rays); }
#else
void embree_intersect(RTCScene scene, RTCRayHit& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
}

void embree_intersect(RTCScene scene, const int* valid, RTCRayHit16& queries) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &queries);
}

void embree_occluded(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}

void embree_occluded(RTCScene scene, const int* valid, RTCRay16& rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid, scene, &context, &rays);
}
#endif

void forget_hit(RTCHit& hit) {
  hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

void forget_hits(RTCHit16& hits) {
  for (int lane = 0; lane < kPacketSize; ++lane) {
    hits.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    hits.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
}

// Meets the plane of a triangle in double; (u, v) of the point of the triangle next to there, each rounded once.
void meet_again(const Vec3& from, const Vec3& direction, const std::array<Vec3, 3>& corners, Hit& hit) {
  const Vec3 along_u = corners[1] - corners[0], along_v = corners[2] - corners[0], normal = along_u.cross(along_v);
  const double slope = normal.dot(direction), size = normal.squaredNorm();
  if (slope == 0) return;
  const Vec3 point = from + normal.dot(corners[0] - from) / slope * direction - corners[0];
  const double u = std::max(0.0, point.cross(along_v).dot(normal) / size);
  const double v = std::max(0.0, along_u.cross(point).dot(normal) / size);
  const double sum = std::max(1.0, u + v);
  hit.u = static_cast<float>(u / sum);
  hit.v = static_cast<float>(v / sum);
}

bool any_moves(const Scene& scene) {
  for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) {
    if (scene.is_moving(mesh_id)) return true;
  }
  return false;
}

Eigen::AlignedBox3d world_box(const Scene& scene, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) {
    for (const Vec3& vertex : pose.world_vertices(mesh_id)) box.extend(vertex);
  }
  return box;
}

// -1 for each lane of a packet that is in use.
struct alignas(64) Lanes {
  std::array<int, kPacketSize> valid{};
};

}  // namespace

struct EmbreeScene::Device {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  bool has_tree_per_mesh = false;
  std::vector<bool> has_mesh;  // by mesh ID

  Device() : device(rtcNewDevice(device_options())) {
    if (!device) throw DeviceError("Embree: no device could be made");
  }
  ~Device() {
    if (scene) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  void check(const char* what) const {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_CANCELLED) throw Cancelled();
    if (code != RTC_ERROR_NONE) throw DeviceError(std::string("Embree: ") + what + " failed, code " + std::to_string(code));
  }
  void start_scene(size_t num_meshes, bool tree_per_mesh);
  void set_mesh(unsigned mesh_id, const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);
  void build(Job* job);
  void ask(const QueryLog::Ray& ray, bool is_shadow) const;
  void ask(const QueryLog::Ray* rays, int count, bool is_shadow) const;
};

// One tree over all triangles, or (`tree_per_mesh`) one for each mesh and one over those: then a mesh that moves costs a new tree
// of its own and the upper one. Both are functions of the triangles alone, however often they were built before.
void EmbreeScene::Device::start_scene(size_t num_meshes, bool tree_per_mesh) {
  if (scene) rtcReleaseScene(scene);
  scene = rtcNewScene(device);
  has_tree_per_mesh = tree_per_mesh;
  has_mesh.assign(num_meshes, false);
  rtcSetSceneFlags(scene, tree_per_mesh ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, tree_per_mesh ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
}

void EmbreeScene::Device::set_mesh(unsigned mesh_id, const std::vector<Vec3>& vertices,
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
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitGeometry(geometry);
  if (has_mesh[mesh_id]) rtcDetachGeometry(scene, mesh_id);
  rtcAttachGeometryByID(scene, geometry, mesh_id);
  has_mesh[mesh_id] = true;
  rtcReleaseGeometry(geometry);
}

void EmbreeScene::Device::build(Job* job) {
  rtcSetSceneProgressMonitorFunction(scene, keep_building, job);
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  if (job) job->throw_if_cancelled();
  check("building the scene");
}

EmbreeScene::EmbreeScene(const Scene& scene, const Pose& pose, const Vec3& origin, Job* job)
    : device_(std::make_unique<Device>()) {
  update(scene, pose, origin, job);
}

void EmbreeScene::update(const Scene& scene, const Pose& pose, const Vec3& origin, Job* job) {
  std::vector<uint32_t> changed = meshes_.update(scene, pose, origin);
  const bool tree_per_mesh = any_moves(scene) && meshes_.mean_cover() <= kMostCover;
  if (!device_->scene || device_->has_mesh.size() != meshes_.size() || tree_per_mesh != device_->has_tree_per_mesh) {
    device_->start_scene(meshes_.size(), tree_per_mesh);
    changed.resize(meshes_.size());
    std::iota(changed.begin(), changed.end(), 0u);
  }
  surfaces_.resize(meshes_.size());
  for (const uint32_t mesh_id : changed) {
    const std::vector<Vec3>& normals = meshes_.normals(mesh_id);
    surfaces_[mesh_id] = {meshes_.triangles(mesh_id).data(), meshes_.vertices(mesh_id).data(),
                          normals.empty() ? nullptr : normals.data()};
    device_->set_mesh(mesh_id, meshes_.vertices(mesh_id), meshes_.triangles(mesh_id));
  }
  const double largest = std::max(1.0, meshes_.largest_coordinate());
  lift_ = 4.0 * 0x1.0p-24 * largest;
  reach_ = 2.0 * largest;
  if (!changed.empty() || meshes_.size() == 0) device_->build(job);
}

EmbreeScene::~EmbreeScene() = default;

Vec3 EmbreeScene::origin_near(const Scene& scene, const Pose& pose, const Vec3& near, bool near_moves) {
  const Eigen::AlignedBox3d box = world_box(scene, pose);
  if (box.isEmpty()) return near;
  const Vec3 nearest = near.cwiseMax(box.min()).cwiseMin(box.max());
  const double length = box.sizes().maxCoeff();
  if (!(near_moves || any_moves(scene)) || length <= 0.0) return nearest;
  const double step = std::exp2(std::floor(std::log2(length)) - 3.0);
  return (nearest / step).array().round().matrix() * step;
}

EmbreeScene::Verdict EmbreeScene::intersect(const Vec3& from, const Vec3& direction, RayHit& out) const {
  RTCRayHit query;
  const Vec3 start = moved_up(from, direction);
  set_ray(query.ray, start, direction, kInfinity);
  forget_hit(query.hit);
  if (log_) {
    log_->calls.push_back({QueryLog::Kind::kClosest, 1});
    log_->add(start, direction, kInfinity);
  }
  embree_intersect(device_->scene, query);
  out.hit = {query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v};
  return confirm(from, direction, out);
}

void EmbreeScene::intersect(const Vec3& from, const Vec3* directions, int count, Verdict* verdicts, RayHit* hits) const {
  alignas(64) RTCRayHit16 queries;
  Lanes lanes;
  std::fill_n(lanes.valid.begin(), count, -1);
  begin_packet(queries.ray);
  forget_hits(queries.hit);
  const bool is_near = from.norm() <= 2.0 * reach_;  // then no ray has to be moved up
  if (log_) log_->calls.push_back({QueryLog::Kind::kClosestPacket, static_cast<uint8_t>(count)});
  for (int lane = 0; lane < count; ++lane) {
    const Vec3 start = is_near ? from : moved_up(from, directions[lane]);
    set_ray(queries.ray, lane, start, directions[lane], kInfinity);
    if (log_) log_->add(start, directions[lane], kInfinity);
  }
  embree_intersect(device_->scene, lanes.valid.data(), queries);
  const RTCHit16& met = queries.hit;
  for (int lane = 0; lane < count; ++lane) hits[lane].hit = {met.geomID[lane], met.primID[lane], met.u[lane], met.v[lane]};
  ask_for_corners(hits, count);
  for (int lane = 0; lane < count; ++lane) verdicts[lane] = confirm(from, directions[lane], hits[lane]);
}

// Has the corners of all triangles that were met come from memory at the same time.
void EmbreeScene::ask_for_corners(const RayHit* hits, int count) const {
  for (int k = 0; k < count; ++k) {
    const Hit& hit = hits[k].hit;
    if (hit.mesh_id != RTC_INVALID_GEOMETRY_ID) __builtin_prefetch(surfaces_[hit.mesh_id].triangles + hit.triangle_id);
  }
  for (int k = 0; k < count; ++k) {
    const Hit& hit = hits[k].hit;
    if (hit.mesh_id == RTC_INVALID_GEOMETRY_ID) continue;
    const Surface& surface = surfaces_[hit.mesh_id];
    for (const uint32_t vertex : surface.triangles[hit.triangle_id]) __builtin_prefetch(surface.vertices + vertex);
  }
}

// Rebuilds in double what Embree reports, the `hit.hit` of a ray.
EmbreeScene::Verdict EmbreeScene::confirm(const Vec3& from, const Vec3& direction, RayHit& out) const {
  if (out.hit.mesh_id == RTC_INVALID_GEOMETRY_ID) return Verdict::kMiss;
  const auto triangle = corners(out.hit.mesh_id, out.hit.triangle_id);
  const auto& [a, b, c] = triangle;
  const auto misses = [&](double absolute, double relative) {
    out.position = a + double{out.hit.u} * (b - a) + double{out.hit.v} * (c - a);
    out.distance = direction.dot(out.position - from);
    const double allowed = absolute + relative * out.distance;
    return out.distance <= 0 || (from + out.distance * direction - out.position).squaredNorm() > allowed * allowed;
  };
  if (misses(kRoundedAbsolute, kRoundedRelative)) {
    meet_again(from, direction, triangle, out.hit);
    if (misses(kFalseHitAbsolute, kFalseHitRelative)) return Verdict::kFalseHit;
  }
  out.normal = (b - a).cross(c - a).normalized();
  out.is_smooth = false;
  out.stretch = 1.0;
  if (surfaces_[out.hit.mesh_id].normals) curve(triangle, direction, out);
  if (out.normal.dot(direction) > 0) {
    out.normal = -out.normal;
    if (out.is_smooth) out.curvature = -out.curvature;
  }
  return Verdict::kHit;
}

// Moves the hit to the curved surface, unless a crease or a grazing ray forbids it. Where that lies behind the facet
// (concave), rays that leave it would meet the facet: there the position stays.
void EmbreeScene::curve(const std::array<Vec3, 3>& corners, const Vec3& direction, RayHit& hit) const {
  const Surface& surface = surfaces_[hit.hit.mesh_id];
  const Triangle& triangle = surface.triangles[hit.hit.triangle_id];
  const std::array<Vec3, 3> normals = {surface.normals[triangle[0]], surface.normals[triangle[1]],
                                       surface.normals[triangle[2]]};
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

// Embree marks an occluded ray with a far end of -infinity.
bool EmbreeScene::occluded(const Vec3& from, const Vec3& to) const {
  const Line line = line_between(from, to);
  if (line.far <= 0) return false;
  RTCRay ray;
  set_ray(ray, line.from, line.direction, line.far);
  if (log_) {
    log_->calls.push_back({QueryLog::Kind::kShadow, 1});
    log_->add(line.from, line.direction, line.far);
  }
  embree_occluded(device_->scene, ray);
  return ray.tfar < 0;
}

void EmbreeScene::occluded(const Segment* segments, size_t count, uint8_t* blocked) const {
  if (count == 1) {  // a packet of one would be slower
    *blocked = occluded(segments->from, segments->to);
    return;
  }
  alignas(64) RTCRay16 rays;
  for (size_t begin = 0; begin < count; begin += kPacketSize) {
    const size_t num_lanes = std::min<size_t>(kPacketSize, count - begin);
    Lanes lanes;
    begin_packet(rays);
    if (log_) log_->calls.push_back({QueryLog::Kind::kShadowPacket, static_cast<uint8_t>(num_lanes)});
    for (size_t k = 0; k < num_lanes; ++k) {
      const Line line = line_between(segments[begin + k].from, segments[begin + k].to);
      set_ray(rays, static_cast<int>(k), line.from, line.direction, line.far);
      lanes.valid[k] = line.far > 0 ? -1 : 0;
      if (log_) log_->add(line.from, line.direction, line.far);
    }
    embree_occluded(device_->scene, lanes.valid.data(), rays);
    for (size_t k = 0; k < num_lanes; ++k) blocked[begin + k] = rays.tfar[k] < 0;
  }
}

void EmbreeScene::ask_again(const QueryLog& log, QueryLog::Mark begin, QueryLog::Mark end, bool one_by_one) const {
  const QueryLog::Ray* rays = log.rays.data() + begin.ray;
  for (size_t i = begin.call; i < end.call; ++i) {
    const auto [kind, count] = log.calls[i];
    const bool is_shadow = kind == QueryLog::Kind::kShadow || kind == QueryLog::Kind::kShadowPacket;
    const bool is_single = kind == QueryLog::Kind::kClosest || kind == QueryLog::Kind::kShadow;
    if (one_by_one || is_single) {
      for (int k = 0; k < count; ++k) device_->ask(rays[k], is_shadow);
    } else {
      device_->ask(rays, count, is_shadow);
    }
    rays += count;
  }
}

void EmbreeScene::Device::ask(const QueryLog::Ray& ray, bool is_shadow) const {
  RTCRayHit query;
  set_ray(query.ray, ray.from, ray.direction, ray.far);
  if (is_shadow) return embree_occluded(scene, query.ray);
  forget_hit(query.hit);
  embree_intersect(scene, query);
}

void EmbreeScene::Device::ask(const QueryLog::Ray* rays, int count, bool is_shadow) const {
  alignas(64) RTCRayHit16 queries;
  Lanes lanes;
  begin_packet(queries.ray);
  if (!is_shadow) forget_hits(queries.hit);
  for (int lane = 0; lane < count; ++lane) {
    set_ray(queries.ray, lane, rays[lane].from, rays[lane].direction, rays[lane].far);
    lanes.valid[static_cast<size_t>(lane)] = rays[lane].far > 0 ? -1 : 0;
  }
  if (is_shadow) embree_occluded(scene, lanes.valid.data(), queries.ray);
  else embree_intersect(scene, lanes.valid.data(), queries);
}

}  // namespace echopath
