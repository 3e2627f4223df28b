#include "echopath/trace/launch/launch_directions.h"

#include "echopath/base/lanes/simd.h"

namespace echopath {
namespace {

ECHOPATH_INLINE void direct_into_cone(const StratumFrame* frame, const LaneValues* x, const LaneValues* y, LaneRange lanes,
                                      LaneVectors* directions) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = lanes.begin; lane < lanes.end; ++lane) directions->set(lane, frame->in_cone((*x)[lane], (*y)[lane]));
}

ECHOPATH_INLINE void direct_into_strip(const StratumFrame* frame, const LaneValues* x, const LaneValues* y, LaneRange lanes,
                                       LaneVectors* directions) {
  ECHOPATH_SIDE_BY_SIDE
  for (int lane = lanes.begin; lane < lanes.end; ++lane) directions->set(lane, frame->in_strip((*x)[lane], (*y)[lane]));
}

}  // namespace

LaunchDomain domain_of(const Stratum& stratum) {
  if (!stratum.is_strip()) return {};
  return {Eigen::Vector2d(stratum.half_azimuth, 0.5 * (stratum.high - stratum.low))};
}

StratumFrame::StratumFrame(const Stratum& stratum)
    : axis_(unpacked(stratum.axis)),
      first_(unpacked(stratum.is_strip() ? stratum.across : Vec3(stratum.axis.unitOrthogonal()))),
      second_(cross(axis_, first_)), size_(stratum.is_strip() ? 0.5 * (stratum.low + stratum.high) : stratum.versine),
      is_strip_(stratum.is_strip()) {}

Vec3 LaunchDirections::direction(int stratum, const Eigen::Vector2d& point) const {
  const StratumFrame& frame = frames_[stratum];
  return packed(frame.is_strip() ? frame.in_strip(point.x(), point.y()) : frame.in_cone(point.x(), point.y()));
}

void LaunchDirections::launch(int stratum, const LaneValues& x, const LaneValues& y, LaneRange lanes,
                              LaneVectors& directions) const {
  const StratumFrame& frame = frames_[stratum];
  if (frame.is_strip()) run_simd<&direct_into_strip>(&frame, &x, &y, lanes, &directions);
  else run_simd<&direct_into_cone>(&frame, &x, &y, lanes, &directions);
}

}  // namespace echopath
