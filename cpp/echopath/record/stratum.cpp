#include "echopath/record/stratum.h"

#include <cmath>

#include "echopath/base/constants.h"

namespace echopath {

double Stratum::solid_angle() const { return is_strip() ? 2.0 * half_azimuth * (high - low) : kTwoPi * versine; }

bool Stratum::contains(const Vec3& direction) const {
  if (!is_strip()) return 0.5 * (direction - axis).squaredNorm() <= versine;
  const double height = direction.dot(axis.cross(across));
  return height >= low && height <= high && std::abs(std::atan2(direction.dot(across), direction.dot(axis))) <= half_azimuth;
}

double versine_of(double half_angle) {
  const double sine = std::sin(0.5 * half_angle);
  return 2.0 * sine * sine;
}

double half_angle_of(double versine) { return 2.0 * std::asin(std::sqrt(0.5 * versine)); }

RayShares shares_of(const std::vector<Stratum>& strata) {
  RayShares shares;
  for (const Stratum& stratum : strata) {
    const Stratum& owner = stratum.is_focus() ? strata[stratum.focus_of] : stratum;
    shares[owner.name] += static_cast<double>(stratum.num_rays);
  }
  return shares;
}

}  // namespace echopath
