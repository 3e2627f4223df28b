#include "echopath/trace/embree/embree_scene.h"

#include <cmath>

#include "echopath/scene/smooth/smooth.h"
#include "echopath/trace/embree/embree_device.h"
#include "echopath/trace/embree/embree_trees.h"

namespace echopath {
namespace {

// A hit is confirmed when the rebuilt point lies this near the ray: 1 mm plus 1e-5 of the distance.
constexpr double kFalseHitAbsolute = 1e-3;  // m
constexpr double kFalseHitRelative = 1e-5;
constexpr double kSmoothGrazing = 0.02;  // cosine of incidence below which the facet's own normal serves

// Meets the plane of a triangle in double precision and sets (u, v) of the point of the triangle next to there, each rounded
// once.
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

// Returns whether a ray has a direction: it has none between points at one place, as an antenna on a surface and its image
// there. Embree ends the program over numbers that are not finite.
bool is_ray(const Vec3& from, const Vec3& direction) {
  const double square = direction.squaredNorm();
  return from.allFinite() && square > 0.0 && square < 2.0;
}

Box world_box(const Scene& scene, const PosedScene& pose) {
  Box box;
  for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) {
    for (const Vec3& vertex : pose.world_vertices(mesh_id)) box.extend(vertex);
  }
  return box;
}

Vec3 origin_in(const Box& box, const Vec3& near, bool is_rounded) {
  if (box.isEmpty()) return near;
  const Vec3 nearest = near.cwiseMax(box.min()).cwiseMin(box.max());
  const double length = box.sizes().maxCoeff();
  if (!is_rounded || length <= 0.0) return nearest;
  const double step = std::exp2(std::floor(std::log2(length)) - 3.0);
  return (nearest / step).array().round().matrix() * step;
}

}  // namespace

EmbreeScene::EmbreeScene() { forget(); }

EmbreeScene::EmbreeScene(const Scene& scene, const PosedScene& pose, const Vec3& origin, Job* job) : EmbreeScene() {
  update(scene, pose, origin, job);
}

EmbreeScene::~EmbreeScene() = default;

void EmbreeScene::forget() {
  surfaces_.clear();
  trees_ = std::make_unique<Trees>();
  device_ = std::make_unique<Device>();
  queries_ = device_.get();
  meshes_ = {};
}

void EmbreeScene::update(const Scene& scene, const PosedScene& pose, const Vec3& origin, Job* job) {
  bring_to(scene, pose, [&](const Box&) { return origin; }, Upkeep::kTimes, job);
}

void EmbreeScene::update(const Scene& part, const PosedScene& pose, const RayRounding& of_all, Job* job) {
  update(part, pose, of_all.origin, job);
  lift_ = of_all.lift;
  reach_ = of_all.reach;
}

void EmbreeScene::update(const Scene& scene, const PosedScene& pose, const Vec3& near, Upkeep upkeep, Job* job) {
  bring_to(scene, pose, [&](const Box& box) {
    return origin_in(box, near, upkeep != Upkeep::kTimes || scene.is_anything_moving());
  }, upkeep, job);
}

void EmbreeScene::bring_to(const Scene& scene, const PosedScene& pose, const EmbreeMeshes::OriginRule& origin, Upkeep upkeep,
                           Job* job) try {
  const std::vector<uint32_t> changed = meshes_.update(scene, pose, origin);
  surfaces_.resize(meshes_.size());
  for (const uint32_t mesh_id : changed) {
    const std::vector<Vec3>& normals = meshes_.normals(mesh_id);
    surfaces_[mesh_id] = {meshes_.triangles(mesh_id).data(), meshes_.vertices(mesh_id).data(),
                          normals.empty() ? nullptr : normals.data()};
  }
  has_sheets_ = false;
  for (uint32_t mesh_id = 0; mesh_id < meshes_.size(); ++mesh_id) has_sheets_ = has_sheets_ || meshes_.is_sheet(mesh_id);
  const EmbreeMeshes::Extent extent = meshes_.extent();
  double largest = std::max(1.0, extent.largest_coordinate);
  if (upkeep == Upkeep::kEdits) largest = std::exp2(std::ceil(std::log2(largest)));
  lift_ = 4.0 * 0x1.0p-24 * largest;
  reach_ = 4.0 * largest;
  trees_->update(meshes_, {extent, upkeep == Upkeep::kEdits}, changed, *device_, job);
} catch (...) {
  forget();
  throw;
}

Vec3 EmbreeScene::origin_near(const Scene& scene, const PosedScene& pose, const Vec3& near, bool near_moves) {
  return origin_in(world_box(scene, pose), near, near_moves || scene.is_anything_moving());
}

// Names the triangle that Embree means.
Hit EmbreeScene::named(uint32_t geometry_id, uint32_t triangle_id, float u, float v) const {
  const std::vector<const TriangleName*>& names = trees_->names();
  if (names.empty() || !names[geometry_id]) return {geometry_id, triangle_id, u, v};
  const TriangleName& name = names[geometry_id][triangle_id];
  return {name.mesh_id, name.triangle_id, u, v};
}

EmbreeScene::Verdict EmbreeScene::intersect(const Vec3& from, const Vec3& direction, RayHit& out) const {
  return intersect(from, {moved_up(from, direction), 0.0}, direction, Sees::kOpaque, out);
}

EmbreeScene::Verdict EmbreeScene::intersect_from_surface(const Vec3& from, const Vec3& direction, RayHit& out, Sees sees,
                                                         double begin) const {
  const double moved = way_up(unpacked(from), unpacked(direction), reach_);
  return intersect(from, {from + moved * direction, std::max(0.0, begin - moved)}, direction, sees, out);
}

// Embree's distances are those of single precision, as far off as points that are confirmed.
EmbreeScene::Verdict EmbreeScene::intersect_near(const Vec3& from, const Vec3& direction, double reach, RayHit& out,
                                                 Sees sees) const {
  const double spare = 4.0 * (kFalseHitAbsolute + kFalseHitRelative * reach + lift_);
  return intersect(from, {from, 0.0, reach + spare}, direction, sees, out);
}

EmbreeScene::Verdict EmbreeScene::intersect(const Vec3& from, const RayStart& start, const Vec3& direction, Sees sees,
                                            RayHit& out) const {
  if (!is_ray(start.at, direction)) return Verdict::kMiss;
  RTCRayHit query;
  set_ray(query.ray, unpacked(start.at), unpacked(direction), static_cast<float>(start.end));
  query.ray.tnear = static_cast<float>(start.begin);
  query.ray.mask = static_cast<uint32_t>(sees);
  forget_hit(query.hit);
  queries_->intersect(query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return Verdict::kMiss;
  out.hit = named(query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v);
  out.reported = double{query.ray.tfar} + direction.dot(start.at - from);
  return confirm(from, direction, out);
}

// Rebuilds in double precision the hit that Embree reports in `out.hit`.
EmbreeScene::Verdict EmbreeScene::confirm(const Vec3& from, const Vec3& direction, RayHit& out) const {
  const auto triangle = corners(out.hit.mesh_id, out.hit.triangle_id);
  const auto& [a, b, c] = triangle;
  const Facet facet{unpacked(a), unpacked(b - a), unpacked(c - a)};
  const auto lies_on_ray = [&](double absolute, double relative) {
    const FacetPoint point = point_of(facet, out.hit.u, out.hit.v, unpacked(from), unpacked(direction));
    out.position = packed(point.position);
    out.distance = point.distance;
    return point.lies_on_ray(absolute, relative);
  };
  if (!lies_on_ray(kRoundedAbsolute, kRoundedRelative)) {
    meet_again(from, direction, triangle, out.hit);
    if (!lies_on_ray(kFalseHitAbsolute, kFalseHitRelative)) return Verdict::kFalseHit;
  }
  out.normal = packed(unit_normal(facet));
  out.is_smooth = false;
  out.stretch = 1.0;
  if (surfaces_[out.hit.mesh_id].normals) curve(triangle, direction, out);
  if (out.normal.dot(direction) > 0) {
    out.normal = -out.normal;
    if (out.is_smooth) out.curvature = -out.curvature;
  }
  return Verdict::kHit;
}

// Moves the hit to the curved surface, unless a crease or a grazing ray forbids it. The position stays where the surface
// lies behind the facet (concave), because rays that leave it would meet the facet.
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
  const SegmentRay line = ray_between(from, to);
  if (line.far <= 0) return false;
  RTCRay ray;
  set_ray(ray, line.from, line.direction, static_cast<float>(line.far));
  queries_->occluded(ray);
  return ray.tfar < 0;
}

}  // namespace echopath
