#pragma once
// Tells what a plane mirror makes of points and directions.
#include "echopath/base/geometry.h"

namespace echopath {

// Returns a direction of travel as it is behind a mirror with this unit normal; the same turns it back.
inline Vec3 mirrored(const Vec3& direction, const Vec3& normal) { return direction - 2.0 * normal.dot(direction) * normal; }

struct Plane {
  Vec3 point, normal;  // any point of it, m; unit

  double height(const Vec3& of) const { return normal.dot(of - point); }  // m, on the side of the normal
  Vec3 image(const Vec3& of) const { return of - 2.0 * height(of) * normal; }
  Vec3 mirrored(const Vec3& direction) const { return echopath::mirrored(direction, normal); }
};

}  // namespace echopath
