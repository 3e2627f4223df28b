#pragma once
// Describes how the rays around one ray spread: derivatives of its point and direction by the launch direction (Igehy 1999,
// "Tracing ray differentials"). They give the tube's area, its caustics and its footprint behind curved mirrors.
#include "echopath/base/geometry.h"

namespace echopath {

struct RayDifferential {
  Vec3 point[2] = {Vec3::Zero(), Vec3::Zero()};  // dP per rad of launch axis
  Vec3 turn[2] = {Vec3::Zero(), Vec3::Zero()};   // dD per rad

  // Returns the differential of a ray of a point source along the unit vector `direction`.
  static RayDifferential from_point(const Vec3& direction);
  // Returns the signed area of the tube across `direction` per sr after `distance` (m) from here.
  double area(const Vec3& direction, double distance) const;
  // Returns how often in (0, distance) the tube's area passes through zero: each caustic turns the phase by +90 deg
  // (e^{+jwt}).
  int num_caustics(const Vec3& direction, double distance) const;
  // Carries the differential to the surface with unit `normal` at `distance` along `direction`.
  void transfer(const Vec3& direction, double distance, const Vec3& normal);
  // Mirrors it at a surface whose normal turns by `curvature` (on the side of `normal`, which faces the ray).
  void reflect(const Vec3& direction, const Vec3& normal, const Mat3& curvature);
};

}  // namespace echopath
