#pragma once
// Computes the solid angle of a triangle. Source: van Oosterom and Strackee 1983.
#include <array>
#include <cmath>

#include "echopath/base/geometry.h"

namespace echopath {

// Returns the solid angle of a triangle in sr, seen from `eye`: positive where its normal, which follows from the winding,
// points away from the eye, so that a closed surface with normals outward fills 4 pi from within.
inline double solid_angle(const std::array<Vec3, 3>& corners, const Vec3& eye) {
  const Vec3 a = corners[0] - eye, b = corners[1] - eye, c = corners[2] - eye;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace echopath
