#include "echopath/motion/motion.h"

namespace echopath {

Transform moved(const Transform& placement, const Motion* motion, double time) {
  if (!motion) return placement;
  const Transform step = motion->at(time);
  Transform transform = Transform::Identity();
  transform.linear() = step.linear() * placement.linear();
  transform.translation() = placement.translation() + step.translation();
  return transform;
}

}  // namespace echopath
