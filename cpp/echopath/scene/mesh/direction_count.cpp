#include "echopath/scene/mesh/direction_count.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {
namespace {

constexpr int kDirections = 1000;

// Returns the direction that is next to an angle in rad from the pole, or one before or behind it.
int next_direction(double angle) {
  const double z = std::cos(std::clamp(angle, 0.0, kPi));
  return static_cast<int>(std::floor(0.5 * kDirections * (1.0 - z)));
}

}  // namespace

DirectionCount::DirectionCount() : is_met_(kDirections) {
  const double turn = kPi * (3.0 - std::sqrt(5.0));
  for (int k = 0; k < kDirections; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / kDirections, aside = std::sqrt(1.0 - z * z);
    directions_.emplace_back(aside * std::cos(k * turn), aside * std::sin(k * turn), z);
  }
}

// Only directions between the heights of a cone around the triangle are looked at.
void DirectionCount::add(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 to_a = a.normalized(), to_b = b.normalized(), to_c = c.normalized();
  const Vec3 ab = to_a.cross(to_b), bc = to_b.cross(to_c), ca = to_c.cross(to_a);
  const double side = to_a.dot(bc);
  const Vec3 axis = (to_a + to_b + to_c).normalized();
  const double cosine = std::min({1.0, axis.dot(to_a), axis.dot(to_b), axis.dot(to_c)});
  const double radius = cosine > 0.0 ? std::acos(cosine) : kPi;  // a wider cone may not hold the arcs
  const double angle = std::acos(std::clamp(axis.z(), -1.0, 1.0));
  const int last = std::min(next_direction(angle + radius) + 1, kDirections);
  for (int k = std::max(0, next_direction(angle - radius)); k < last; ++k) {
    const Vec3& direction = directions_[k];
    const bool is_inside =
        side * direction.dot(ab) > 0.0 && side * direction.dot(bc) > 0.0 && side * direction.dot(ca) > 0.0;
    if (is_met_[k] || !is_inside) continue;
    is_met_[k] = true;
    ++num_met_;
  }
}

}  // namespace echopath
