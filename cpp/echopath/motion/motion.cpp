#include "echopath/motion/motion.h"

#include <cmath>

#include "echopath/base/errors.h"

namespace echopath {

LinearMotion::LinearMotion(const Vec3& velocity, const Vec3& angular_velocity)
    : velocity_(velocity), angular_velocity_(angular_velocity) {
  require(velocity.allFinite(), "velocity", "must be finite", velocity.transpose());
  require(angular_velocity.allFinite(), "angular_velocity", "must be finite", angular_velocity.transpose());
}

Transform LinearMotion::at(double time) const {
  require(std::isfinite(time), "time", "must be finite", time);
  Transform transform = Transform::Identity();
  transform.translation() = velocity_ * time;
  const double rate = angular_velocity_.norm();
  if (rate > 0.0) transform.linear() = Eigen::AngleAxisd(rate * time, angular_velocity_ / rate).toRotationMatrix();
  return transform;
}

bool LinearMotion::rests() const { return velocity_ == Vec3::Zero() && angular_velocity_ == Vec3::Zero(); }

double LinearMotion::turn_rate(const TimeSpan&) const { return angular_velocity_.norm(); }

Transform moved(const Transform& placement, const Motion* motion, double time) {
  if (!motion) return placement;
  const Transform step = motion->at(time);
  Transform transform = Transform::Identity();
  transform.linear() = step.linear() * placement.linear();
  transform.translation() = placement.translation() + step.translation();
  return transform;
}

}  // namespace echopath
