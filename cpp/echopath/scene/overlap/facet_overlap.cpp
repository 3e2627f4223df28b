#include "echopath/scene/overlap/facet_overlap.h"

#include <cmath>

namespace echopath {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kMinCosine = 0.995;    // of 0.1 rad: creases as small as max_distance do not make a surface lie on itself
constexpr double kTouchingShare = 0.1;  // of the narrower triangle's height, because slivers overlap, too

struct Polygon {
  std::array<Vec3, 9> corners;  // more than the six of two triangles: signs within rounding may change more than twice
  size_t size = 0;
  void add(const Vec3& corner) { corners[size++] = corner; }
};

// Returns the height above the longest side, m.
double height_of(const Corners& corners) {
  const Vec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], bc = corners[2] - corners[1];
  return ab.cross(ac).norm() / std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()}));
}

// Returns the part of a polygon on the inner side of a line: outward . p <= reach.
Polygon clipped(const Polygon& polygon, const Vec2& outward, double reach) {
  Polygon kept;
  for (size_t k = 0; k < polygon.size; ++k) {
    const Vec3 &here = polygon.corners[k], &next = polygon.corners[(k + 1) % polygon.size];
    const double of_here = outward.dot(here.head<2>()) - reach, of_next = outward.dot(next.head<2>()) - reach;
    if (of_here <= 0.0) kept.add(here);
    if ((of_here <= 0.0) != (of_next <= 0.0)) kept.add(here + of_here / (of_here - of_next) * (next - here));
  }
  return kept;
}

double polygon_area(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t k = 2; k < polygon.size; ++k) {
    const Vec3 one = polygon.corners[k - 1] - polygon.corners[0], two = polygon.corners[k] - polygon.corners[0];
    twice += one.x() * two.y() - one.y() * two.x();
  }
  return 0.5 * std::abs(twice);
}

double largest_height(const Polygon& polygon) {
  double largest = 0.0;
  for (size_t k = 0; k < polygon.size; ++k) largest = std::max(largest, std::abs(polygon.corners[k].z()));
  return largest;
}

// Returns whether all three corners lie above, or all below, a plane by more than `distance`.
bool is_apart(const Corners& seen, double distance) {
  const auto [low, high] = std::minmax({seen[0].z(), seen[1].z(), seen[2].z()});
  return low > distance || high < -distance;
}

bool is_parallel(const Corners& seen) {
  const Vec3 normal = cross_of_sides(seen);
  return std::abs(normal.z()) > kMinCosine * normal.norm();
}

}  // namespace

FacetPlane::FacetPlane(const Corners& corners)
    : box_(box_about(corners)), origin_(corners[0]), across_((corners[1] - corners[0]).normalized()),
      normal_(cross_of_sides(corners).normalized()), height_(height_of(corners)) {
  up_ = normal_.cross(across_);
  for (size_t k = 0; k < 3; ++k) corners_[k] = seen(corners[k]);
  sides_ = sides_of(corners_);
}

Vec3 FacetPlane::seen(const Vec3& point) const {
  const Vec3 from_origin = point - origin_;
  return {across_.dot(from_origin), up_.dot(from_origin), normal_.dot(from_origin)};
}

std::array<FacetPlane::Side, 3> FacetPlane::sides_of(const Corners& seen) {
  std::array<Side, 3> sides;
  for (size_t k = 0; k < 3; ++k) {
    const Vec2 begin = seen[k].head<2>(), end = seen[(k + 1) % 3].head<2>(), opposite = seen[(k + 2) % 3].head<2>();
    Vec2 outward = Vec2(end.y() - begin.y(), begin.x() - end.x()).normalized();
    if (outward.dot(opposite - begin) > 0.0) outward = -outward;
    sides[k] = {outward, std::max(outward.dot(begin), outward.dot(end))};
  }
  return sides;
}

bool FacetPlane::may_meet(const Box& box, double distance) const {
  const Vec3 gap = (box.min() - box_.max()).cwiseMax(box_.min() - box.max());
  if (gap.maxCoeff() > distance) return false;
  const double reach = 0.5 * normal_.cwiseAbs().dot(box.sizes());
  return std::abs(normal_.dot(box.center() - origin_)) <= reach + distance;
}

std::optional<FacetOverlap> FacetPlane::overlap(const Corners& other, double max_distance) const {
  const Corners laid = {seen(other[0]), seen(other[1]), seen(other[2])};
  if (is_apart(laid, max_distance) || !is_parallel(laid)) return std::nullopt;
  const double touching = std::min(max_distance, kTouchingShare * std::min(height_, height_of(laid)));
  const auto parts = [touching](const Side& side, const Corners& corners) {
    double nearest = side.outward.dot(corners[0].head<2>());
    for (size_t k = 1; k < 3; ++k) nearest = std::min(nearest, side.outward.dot(corners[k].head<2>()));
    return side.reach - nearest <= touching;
  };
  for (const Side& side : sides_) {
    if (parts(side, laid)) return std::nullopt;
  }
  for (const Side& side : sides_of(laid)) {
    if (parts(side, corners_)) return std::nullopt;
  }
  Polygon common;
  for (const Vec3& corner : laid) common.add(corner);
  for (const Side& side : sides_) common = clipped(common, side.outward, side.reach);
  const FacetOverlap found{polygon_area(common), largest_height(common)};
  return found.distance <= max_distance ? std::optional(found) : std::nullopt;
}

}  // namespace echopath
