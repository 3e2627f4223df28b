#include "echopath/trace/launch_cones.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/simd.h"

namespace echopath {
namespace {

constexpr double kRounding = 1e-9;  // rad: cones that nearly meet are taken to meet

double half_angle(const Stratum& stratum) { return 2.0 * std::asin(std::sqrt(0.5 * std::min(2.0, stratum.versine))); }

bool can_meet(const Stratum& a, const Stratum& b) {
  if (a.num_rays == 0 || b.num_rays == 0) return false;
  const double apart = 2.0 * std::asin(std::min(1.0, 0.5 * (a.axis - b.axis).norm()));
  return apart <= half_angle(a) + half_angle(b) + kRounding;
}

ECHOPATH_INLINE void direct_lanes(const ConeFrame* frame, const LaneValues* x, const LaneValues* y, LaneRange lanes,
                                  LaneVectors* directions) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = lanes.begin; lane < lanes.end; ++lane) directions->set(lane, frame->direction((*x)[lane], (*y)[lane]));
}

// `part`: of the rays toward directions in the cone.
ECHOPATH_INLINE void add_densities(const LaunchCone* cone, double part, const LaneVectors* directions, LaneRange lanes,
                                   LaneValues* densities) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = lanes.begin; lane < lanes.end; ++lane) (*densities)[lane] += cone->toward(directions->at(lane), part);
}

}  // namespace

ConeFrame::ConeFrame(const Stratum& stratum)
    : axis_(unpacked(stratum.axis)), first_(unpacked(stratum.axis.unitOrthogonal())), second_(cross(axis_, first_)),
      versine_(stratum.versine) {}

LaunchCones::LaunchCones(const std::vector<Stratum>& strata) : meeting_(strata.size()) {
  for (size_t k = 0; k < strata.size(); ++k) {
    const Stratum& stratum = strata[k];
    frames_.emplace_back(stratum);
    const double density = stratum.num_rays > 0 ? stratum.ray_density : 0.0;
    cones_.push_back({unpacked(stratum.axis), 2.0 * stratum.versine, density, k + 1 < strata.size()});
    for (size_t other = 0; other < strata.size(); ++other) {
      if (other != k && can_meet(stratum, strata[other])) meeting_[k].push_back(static_cast<int>(other));
    }
  }
}

double LaunchCones::density(const Vec3& direction, double aimed_share) const {
  double sum = 0.0;
  for (const LaunchCone& cone : cones_) sum += cone.toward(unpacked(direction), cone.part(aimed_share));
  return sum;
}

double LaunchCones::density_of_ray(const Vec3& direction, int own, double aimed_share) const {
  const auto k = static_cast<size_t>(own);
  double sum = cones_[k].part(aimed_share);
  for (const int other : meeting_[k]) {
    const LaunchCone& cone = cones_[static_cast<size_t>(other)];
    sum += cone.toward(unpacked(direction), cone.part(aimed_share));
  }
  return sum;
}

void LaunchCones::launch(int stratum, const LaneValues& x, const LaneValues& y, LaneRange lanes, LaneVectors& directions,
                         LaneValues& densities) const {
  const auto k = static_cast<size_t>(stratum);
  run_simd<&direct_lanes>(&frames_[k], &x, &y, lanes, &directions);
  for (int lane = lanes.begin; lane < lanes.end; ++lane) densities[lane] = cones_[k].part(1.0);
  for (const int other : meeting_[k]) {
    const LaunchCone& cone = cones_[static_cast<size_t>(other)];
    run_simd<&add_densities>(&cone, cone.part(1.0), &directions, lanes, &densities);
  }
}

}  // namespace echopath
