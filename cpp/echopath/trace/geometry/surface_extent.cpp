#include "echopath/trace/geometry/surface_extent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

const double kCosBend = std::sqrt(0.75), kTanBend = 1.0 / std::sqrt(3.0);  // 30 degrees, the crease guard of smooth surfaces
constexpr double kSameAngle = 3.5e-3;  // rad (0.2 degrees): planes and angles of corners that differ by less are the same

}  // namespace

TriangleRim::TriangleRim(const EmbreeScene& geometry, const Hit& hit)
    : corners_(geometry.corners(hit.mesh_id, hit.triangle_id)) {
  const Vec3 normal = cross_of_sides(corners_);
  for (size_t k = 0; k < 3; ++k) outward_[k] = (corners_[(k + 1) % 3] - corners_[k]).cross(normal);
}

double TriangleRim::distance(const Vec3& from, const Vec3& along) const {
  double distance = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < 3; ++k) {
    const double speed = along.dot(outward_[k]);
    if (speed > 0) distance = std::min(distance, (corners_[k] - from).dot(outward_[k]) / speed);
  }
  return std::max(distance, 0.0);
}

bool TriangleRim::is_beyond(const Vec3& from, double squared) const {
  for (size_t k = 0; k < 3; ++k) {
    const double inside = (corners_[k] - from).dot(outward_[k]);
    if (!(inside > 0.0 && inside * inside >= squared * outward_[k].squaredNorm())) return false;
  }
  return true;
}

// Returns whether what rises from the surface ends it without an edge. Images in both planes of a corner add up to the whole
// field where its angle is 180 degrees over a whole number; at others the edge between them scatters (Sommerfeld 1896).
bool SurfaceAround::is_wall(const RayHit& met) const {
  if (extent_ == Extent::kBent) return true;
  if (next_ && std::abs(next_->normal.dot(met.normal)) > 1.0 - 0.5 * kSameAngle * kSameAngle &&
      std::abs(next_->height(met.position)) <= gap_)
    return true;
  const double angle = std::acos(std::clamp(-point_.normal.dot(met.normal), -1.0, 1.0));
  return std::ranges::any_of(std::array{2.0, 3.0, 4.0}, [&](double n) { return std::abs(angle - kPi / n) < kSameAngle; });
}

double SurfaceAround::open_foot_of(const Plane& plane, const Vec3& along, double reach) const {
  const double nearing = -plane.normal.dot(along), foot = plane.height(point_.position) / nearing;
  if (nearing == 0.0 || !(foot > 0.0 && foot < reach)) return reach;
  for (const double height : {gap_, crack_}) {
    if (height < gap_) break;  // the first look has seen as much
    RayHit met;
    ++num_queries_;
    const Vec3 from = point_.position + height * point_.normal;
    if (geometry_.intersect_near(from, along, reach, met, Sees::kAll) != EmbreeScene::Verdict::kHit) continue;
    if (std::abs(plane.height(met.position)) <= gap_) return is_wall(met) ? reach : foot;
  }
  return reach;
}

// Returns where something that rises from the surface stands in the way; no wall, at `reach`, if nothing is nearer.
SurfaceEnd SurfaceAround::nearest_wall(const Vec3& along, double reach) const {
  const SurfaceEnd wall = wall_at_height(gap_, along, reach);
  return wall.is_wall || crack_ <= gap_ ? wall : wall_at_height(crack_, along, reach);
}

SurfaceEnd SurfaceAround::wall_at_height(double height, const Vec3& along, double reach) const {
  RayHit met;
  ++num_queries_;
  const Vec3 from = point_.position + height * point_.normal;
  const bool meets = geometry_.intersect_near(from, along, reach, met, Sees::kAll) == EmbreeScene::Verdict::kHit;
  if (!meets || !is_wall(met) || met.distance >= reach) return {reach};
  return {met.distance, true, met.normal};
}

bool SurfaceAround::wall_rises(const Vec3& along, double distance, double height) const {
  RayHit met;
  ++num_queries_;
  const Vec3 from = point_.position + height * point_.normal;
  if (geometry_.intersect_near(from, along, distance + height, met, Sees::kAll) != EmbreeScene::Verdict::kHit) return false;
  if (met.distance > distance + height) return false;
  // What stands behind a low wall is not that wall, however high.
  const double aside = (from + met.distance * along - above(along, distance)).dot(met.normal);
  return std::abs(met.distance - distance) <= gap_ || std::abs(aside) <= gap_;
}

bool SurfaceAround::is_in_plane(const Hit& hit) const {
  return std::ranges::all_of(geometry_.corners(hit.mesh_id, hit.triangle_id), [&](const Vec3& corner) {
    return std::abs((corner - point_.position).dot(point_.normal)) <= gap_;
  });
}

// Returns how far the triangle at that distance goes on; it is negative where the surface is not there.
double SurfaceAround::end_of_triangle_at(const Vec3& along, double distance) const {
  RayHit met;
  ++num_queries_;
  const Vec3 from = above(along, distance);
  const double sinks = extent_ == Extent::kPlane ? 0.0 : kTanBend * distance;  // m, at most
  const double reach = 2.0 * gap_ + sinks;                                     // where the surface may lie below (depth)
  if (geometry_.intersect_near(from, -point_.normal, reach, met, sees_) != EmbreeScene::Verdict::kHit) return -1.0;
  const double cos_bend = std::min(1.0, point_.normal.dot(met.normal));
  if (cos_bend < kCosBend || (extent_ == Extent::kPlane && !is_in_plane(met.hit))) return -1.0;
  // A surface that has turned by an angle has sunk by no more than the tangent of it per length.
  const double depth = met.distance - gap_, slope = std::sqrt(1.0 - cos_bend * cos_bend) / cos_bend;
  if (depth > gap_ + slope * distance) return -1.0;
  // The distance starts from the line itself, because the point that was met is known in single precision only.
  const Vec3 tangent = (along - along.dot(met.normal) * met.normal).normalized();
  return distance + TriangleRim(geometry_, met.hit).distance(point_.position + distance * along, tangent);
}

SurfaceEnd SurfaceAround::find_end(const Vec3& along, double reach) const {
  const SurfaceEnd wall = nearest_wall(along, reach);
  const auto reaches_wall = [&] {
    return distance_to_rim(along) >= wall.distance || is_at(along, std::max(wall.distance - 2.0 * gap_, 0.0));
  };
  if (wall.is_wall && reaches_wall()) return wall;
  const double end = end_before(wall.distance, along);
  const double across = (wall.distance - end) * std::abs(along.dot(wall.wall));  // m, of the crack before the wall
  if (wall.is_wall && across <= crack_) return wall;
  return {end};
}

// Returns where the surface ends; no farther than `beyond`.
double SurfaceAround::end_before(double beyond, const Vec3& along) const {
  double known = distance_to_rim(along);  // the surface goes on so far
  const double step = 4.0 * geometry_.lift();
  for (;;) {
    // A triangle right behind the rim may be narrower than the gap.
    double next = end_of_triangle_at(along, known + step);
    if (next < 0) next = end_of_triangle_at(along, known + gap_);
    if (next < 0) return known;
    known = std::max(next, known + step);
    if (known >= beyond) return beyond;
    if (beyond - known < 4.0 * gap_) continue;
    // A leap no longer than the way so far overlooks no gap that is wider than it, behind which another body may stand.
    const double middle = std::min(0.5 * (known + beyond), 2.0 * known), end = end_of_triangle_at(along, middle);
    if (end < 0) beyond = middle;
    else known = std::max(end, middle);
    if (known >= beyond) return beyond;
  }
}

}  // namespace echopath
