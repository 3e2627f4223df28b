#pragma once
// Measures where one triangle lies on another. Internal to the module.
#include <optional>

#include "echopath/base/box_tree.h"
#include "echopath/base/geometry.h"

namespace echopath {

using Corners = std::array<Vec3, 3>;

// Describes the region where two triangles overlap.
struct FacetOverlap {
  double area = 0.0;      // m^2
  double distance = 0.0;  // m, largest between the two triangles there
};

// Holds the plane of a triangle and the edges within it; other triangles are compared with them.
class FacetPlane {
 public:
  // `corners` are in m, of a triangle with an area.
  explicit FacetPlane(const Corners& corners);

  // Returns whether a point of the box may lie within `distance` m of the triangle: at times too often, never too seldom.
  bool may_meet(const Box& box, double distance) const;

  // Returns the overlap with another triangle whose plane differs by less than 0.1 rad, facing the same or the opposite way,
  // and which, where the two overlap, is nowhere further than `max_distance` m from this one. Returns nothing where they
  // merely touch: where a shift within the plane by max_distance, or by a tenth of the narrower one's height, separates
  // them.
  std::optional<FacetOverlap> overlap(const Corners& other, double max_distance) const;

 private:
  using Vec2 = Eigen::Vector2d;
  struct Side {    // an edge, seen along the normal
    Vec2 outward;  // unit
    double reach;  // m, extent of the triangle that way
  };
  Vec3 seen(const Vec3& point) const;  // coordinates along across_, up_ and normal_, m
  static std::array<Side, 3> sides_of(const std::array<Vec3, 3>& corners);

  Box box_;
  Vec3 origin_, across_, up_, normal_;
  double height_;                // m, of the corner above the longest side
  std::array<Vec3, 3> corners_;  // in the coordinates of seen()
  std::array<Side, 3> sides_;
};

}  // namespace echopath
