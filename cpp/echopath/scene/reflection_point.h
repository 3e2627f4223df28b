#pragma once
// Where a triangle of a surface mirrors one point into another.
#include <array>
#include <optional>

#include "echopath/base/geometry.h"

namespace echopath {

// A triangle as the waves see it: with the normals of its corners where it is a part of a curved surface.
struct ReflectingTriangle {
  std::array<Vec3, 3> corners;  // m
  std::array<Vec3, 3> normals;  // unit; those of the facet where it is flat
  Vec3 centre, facet_normal;
  double radius = 0.0;          // m, of the corners about the centre
  double turn = 0.0;            // largest |corner normal - facet normal|

  bool is_flat() const { return turn == 0.0; }
};

// normals: unit, of the corners of the curved surface (scene/smooth.h); of no interest beyond its crease guard.
ReflectingTriangle reflecting_triangle(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals);

struct ReflectionPoint {
  Vec3 position;
  // m^-1 along two axes of the surface at right angles, unit: second derivatives of the length of the way.
  std::array<Vec3, 2> axes;
  std::array<double, 2> bends;
};

// Where the way from `first` over the triangle to `second` is stationary, both on one side of it. A point counts up to a fiftieth
// of an edge outside of the triangle, so that none falls between two.
std::optional<ReflectionPoint> find_reflection(const ReflectingTriangle& triangle, const Vec3& first, const Vec3& second);

}  // namespace echopath
