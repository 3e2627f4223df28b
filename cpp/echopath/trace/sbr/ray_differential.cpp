#include "echopath/trace/sbr/ray_differential.h"

#include <cmath>

namespace echopath {

RayDifferential RayDifferential::from_point(const Vec3& direction) {
  RayDifferential rays;
  rays.turn[0] = direction.unitOrthogonal();
  rays.turn[1] = direction.cross(rays.turn[0]);
  return rays;
}

double RayDifferential::area(const Vec3& direction, double distance) const {
  const Vec3 first = point[0] + distance * turn[0], second = point[1] + distance * turn[1];
  return first.cross(second).dot(direction);
}

int RayDifferential::num_caustics(const Vec3& direction, double distance) const {
  // area(s) = c + b s + a s^2. The sign at the start is that just behind it, because a source has area 0.
  const double c = point[0].cross(point[1]).dot(direction);
  const double b = (point[0].cross(turn[1]) + turn[0].cross(point[1])).dot(direction);
  const double a = turn[0].cross(turn[1]).dot(direction);
  const double discriminant = b * b - 4.0 * a * c;
  if (discriminant <= 0) return 0;
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  int count = 0;
  for (const double root : {a != 0 ? q / a : -1.0, q != 0 ? c / q : -1.0}) count += root > 0 && root < distance ? 1 : 0;
  return count;
}

void RayDifferential::transfer(const Vec3& direction, double distance, const Vec3& normal) {
  for (int a = 0; a < 2; ++a) {
    const Vec3 moved = point[a] + distance * turn[a];
    point[a] = moved - direction * (moved.dot(normal) / direction.dot(normal));
  }
}

void RayDifferential::reflect(const Vec3& direction, const Vec3& normal, const Mat3& curvature) {
  for (int a = 0; a < 2; ++a) {
    const Vec3 normal_turn = curvature * point[a];
    turn[a] -= 2.0 * ((turn[a].dot(normal) + direction.dot(normal_turn)) * normal + direction.dot(normal) * normal_turn);
  }
}

}  // namespace echopath
