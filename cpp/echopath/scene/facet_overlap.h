#pragma once
// Where one triangle lies on another. Internal to the module.
#include <optional>

#include "echopath/scene/box_tree.h"

namespace echopath {

// What two triangles have in common.
struct FacetOverlap {
  double area = 0.0;      // m^2
  double distance = 0.0;  // m, largest between the two there
};

// A triangle that others are laid on: its plane and, within it, its edges.
class FacetPlane {
 public:
  // corners in m, of a triangle with an area.
  explicit FacetPlane(const Corners& corners);

  // Whether a point of the box may lie within `distance` m of the triangle. Takes too much, never too little.
  bool may_meet(const Box& box, double distance) const;

  // The overlap with another triangle that is nowhere further than `max_distance` m from this one where it lies over it,
  // and turned by less than 0.1 rad, or by so much less than half a turn. Empty where they merely touch: where a shift
  // within the plane by max_distance, or by a tenth of the narrower one's height, parts them.
  std::optional<FacetOverlap> overlap(const Corners& other, double max_distance) const;

 private:
  using Vec2 = Eigen::Vector2d;
  struct Side {  // of a triangle seen along the normal
    Vec2 outward;  // unit
    double reach;  // m, of the triangle that way
  };
  Vec3 seen(const Vec3& point) const;  // across, across and above the plane, m
  static std::array<Side, 3> sides_of(const std::array<Vec3, 3>& corners);

  Box box_;
  Vec3 origin_, across_, up_, normal_;
  double height_;  // m, above its longest side
  std::array<Vec3, 3> corners_;  // seen
  std::array<Side, 3> sides_;
};

}  // namespace echopath
