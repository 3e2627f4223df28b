#include "echopath/trace/launch_cones.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

constexpr double kRounding = 1e-9;  // rad: cones that nearly meet are taken to meet

double half_angle(const Stratum& stratum) { return 2.0 * std::asin(std::sqrt(0.5 * std::min(2.0, stratum.versine))); }

bool can_meet(const Stratum& a, const Stratum& b) {
  if (a.num_rays == 0 || b.num_rays == 0) return false;
  const double apart = 2.0 * std::asin(std::min(1.0, 0.5 * (a.axis - b.axis).norm()));
  return apart <= half_angle(a) + half_angle(b) + kRounding;
}

}  // namespace

ConeFrame::ConeFrame(const Stratum& stratum)
    : axis_(stratum.axis), first_(axis_.unitOrthogonal()), second_(axis_.cross(first_)), versine_(stratum.versine) {}

// In a Lambert projection the versine is proportional to the squared radius: sine / radius = sqrt(V (2 - versine)).
Vec3 ConeFrame::direction(const Eigen::Vector2d& point) const {
  const double here = versine_ * std::min(1.0, point.squaredNorm());
  const double scale = std::sqrt(versine_ * (2.0 - here));
  return ((1.0 - here) * axis_ + scale * point[0] * first_ + scale * point[1] * second_).normalized();
}

LaunchCones::LaunchCones(const std::vector<Stratum>& strata) : meeting_(strata.size()) {
  for (size_t k = 0; k < strata.size(); ++k) {
    const Stratum& stratum = strata[k];
    frames_.emplace_back(stratum);
    const double density = stratum.num_rays > 0 ? stratum.ray_density : 0.0;
    cones_.push_back({stratum.axis, 2.0 * stratum.versine, density, k + 1 < strata.size()});
    for (size_t other = 0; other < strata.size(); ++other) {
      if (other != k && can_meet(stratum, strata[other])) meeting_[k].push_back(static_cast<int>(other));
    }
  }
}

double LaunchCones::density(const Vec3& direction, double aimed_share) const {
  double sum = 0.0;
  for (const Cone& cone : cones_) sum += cone.part_toward(direction, aimed_share);
  return sum;
}

double LaunchCones::density_of_ray(const Vec3& direction, int own, double aimed_share) const {
  const auto k = static_cast<size_t>(own);
  double sum = cones_[k].part(aimed_share);
  for (const int other : meeting_[k]) sum += cones_[static_cast<size_t>(other)].part_toward(direction, aimed_share);
  return sum;
}

}  // namespace echopath
