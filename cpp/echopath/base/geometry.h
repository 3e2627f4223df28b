#pragma once
// Names the vectors, matrices and transforms that every module uses.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>

namespace echopath {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;
// A transform T turns p_inner into p_outer = T * p_inner; its name reads from right to left, as in world_from_node.
using Transform = Eigen::Affine3d;

// Unit vectors and quaternions that are given may be off by what single precision or six written digits leave; one farther
// off is a mistake, such as another convention or angles.
constexpr double kUnitTolerance = 1e-6;

// Points and normals that are the same have the same component along this direction, and others seldom do by chance: things
// made by people lie along their axes.
inline const Vec3 kSortingDirection{0.7193, 0.5271, 0.4526};

// Returns the distance from a point to the segment between two others, which may be one.
inline double distance_to_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double square = along.squaredNorm(), at = square > 0 ? std::clamp(along.dot(point - from) / square, 0.0, 1.0) : 0.0;
  return (from + at * along - point).norm();
}

}  // namespace echopath
