#pragma once
// Names for the small linear algebra that every module uses.
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace echopath {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;
// p_outer = T * p_inner; read names right to left: world_from_node.
using Transform = Eigen::Affine3d;

}  // namespace echopath
