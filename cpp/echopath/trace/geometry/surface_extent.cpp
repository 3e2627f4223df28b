#include "echopath/trace/geometry/surface_extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echopath {
namespace {

const double kCosBend = std::sqrt(0.75);  // 30 degrees, the crease guard of smooth surfaces

// Looks down on the surface along one line from a point.
class SurfaceLine {
 public:
  SurfaceLine(const EmbreeScene& geometry, const RayHit& point, const Vec3& along, double gap, int64_t& num_queries)
      : geometry_(geometry), point_(point), along_(along), gap_(gap), num_queries_(num_queries) {}

  // Returns where something that rises from the surface stands on the line, or `reach` if nothing is nearer.
  double distance_to_wall(double reach) {
    RayHit met;
    ++num_queries_;
    const bool meets = geometry_.intersect_from_surface(above(0.0), along_, met) == EmbreeScene::Verdict::kHit;
    return meets ? std::min(met.distance, reach) : reach;
  }

  // Returns how far the triangle at that distance goes on along the line; it is negative where the surface is not there.
  double end_of_triangle_at(double distance) {
    RayHit met;
    ++num_queries_;
    const Vec3 from = above(distance);
    if (geometry_.intersect_from_surface(from, -point_.normal, met) != EmbreeScene::Verdict::kHit) return -1.0;
    const double cos_bend = std::min(1.0, point_.normal.dot(met.normal));
    if (cos_bend < kCosBend) return -1.0;
    // A surface that has turned by an angle has sunk by no more than the tangent of it per length.
    const double depth = met.distance - gap_, slope = std::sqrt(1.0 - cos_bend * cos_bend) / cos_bend;
    if (depth > gap_ + slope * distance) return -1.0;
    // The distance starts from the line itself, because the point that was met is known in single precision only.
    const Vec3 tangent = (along_ - along_.dot(met.normal) * met.normal).normalized();
    return distance + distance_to_rim(geometry_, met.hit, point_.position + distance * along_, tangent);
  }

 private:
  Vec3 above(double distance) const { return point_.position + distance * along_ + gap_ * point_.normal; }

  const EmbreeScene& geometry_;
  const RayHit& point_;
  const Vec3& along_;
  double gap_;
  int64_t& num_queries_;
};

}  // namespace

double distance_to_rim(const EmbreeScene& geometry, const Hit& hit, const Vec3& from, const Vec3& along) {
  const auto corners = geometry.corners(hit.mesh_id, hit.triangle_id);
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  double distance = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 outward = (corners[(k + 1) % 3] - corners[k]).cross(normal);
    const double speed = along.dot(outward);
    if (speed > 0) distance = std::min(distance, (corners[k] - from).dot(outward) / speed);
  }
  return std::max(distance, 0.0);
}

bool surface_reaches(const EmbreeScene& geometry, const RayHit& point, const Vec3& along, double distance, double gap,
                     int64_t& num_queries) {
  if (distance_to_rim(geometry, point.hit, point.position, along) >= distance) return true;
  return SurfaceLine(geometry, point, along, gap, num_queries).end_of_triangle_at(distance) >= 0;
}

SurfaceEnd find_surface_end(const EmbreeScene& geometry, const RayHit& point, const Vec3& along, double reach, double gap,
                            int64_t& num_queries) {
  double known = distance_to_rim(geometry, point.hit, point.position, along);  // the surface goes on so far
  SurfaceLine line(geometry, point, along, gap, num_queries);
  double beyond = line.distance_to_wall(reach);
  const bool is_wall = beyond < reach;
  if (is_wall && (known >= beyond || line.end_of_triangle_at(std::max(beyond - 2.0 * gap, 0.0)) >= 0)) return {beyond, true};
  const double step = 4.0 * geometry.lift();
  for (;;) {
    // A triangle right behind the rim may be narrower than the gap.
    double next = line.end_of_triangle_at(known + step);
    if (next < 0) next = line.end_of_triangle_at(known + gap);
    if (next < 0) return {known, false};
    known = std::max(next, known + step);
    if (known >= beyond) return {beyond, false};
    if (beyond - known < 4.0 * gap) continue;
    const double middle = 0.5 * (known + beyond), end = line.end_of_triangle_at(middle);
    if (end < 0) beyond = middle;
    else known = std::max(end, middle);
    if (known >= beyond) return {beyond, false};
  }
}

}  // namespace echopath
