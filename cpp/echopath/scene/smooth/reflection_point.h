#pragma once
// Finds the point of a triangle where a wave from one point is reflected to another.
#include <array>
#include <optional>

#include "echopath/base/geometry.h"

namespace echopath {

// Describes a reflecting triangle, with the vertex normals of the curved surface that it may be a part of.
struct ReflectingTriangle {
  std::array<Vec3, 3> corners;  // m
  std::array<Vec3, 3> normals;  // unit; all equal to facet_normal where it is flat
  Vec3 centre, facet_normal;
  double radius = 0.0;  // m, largest distance of a corner from the centre
  double turn = 0.0;    // largest |corner normal - facet normal|

  bool is_flat() const { return turn == 0.0; }
};

// `normals` are the unit vertex normals of the curved surface (scene/smooth/smooth.h). Where they fail its crease guard, the
// triangle is flat.
ReflectingTriangle reflecting_triangle(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals);

// Returns whether both ends lie on one side of the plane through a point: what stands there can reflect from one to the
// other. The normal may have any length.
inline bool faces_both(const Vec3& point, const Vec3& normal, const Vec3& first, const Vec3& second) {
  return normal.dot(first - point) * normal.dot(second - point) > 0.0;
}

struct ReflectionPoint {
  Vec3 position;
  // These are the principal axes of the path length at the point, unit vectors in the tangent plane, and its second
  // derivatives along them, 1/m.
  std::array<Vec3, 2> axes;
  std::array<double, 2> second_derivatives;
};

// Finds the point where the path length from `first` over the triangle to `second` is stationary; both ends must lie on one
// side of the triangle. Points up to a fiftieth of an edge outside count, so that none is lost between two triangles.
std::optional<ReflectionPoint> find_reflection(const ReflectingTriangle& triangle, const Vec3& first, const Vec3& second);

}  // namespace echopath
