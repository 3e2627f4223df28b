#pragma once
// Names the vectors, matrices and transforms that every module uses.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>

namespace echopath {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;
using Box = Eigen::AlignedBox3d;  // with sides along the axes
// A transform T turns p_inner into p_outer = T * p_inner; its name reads from right to left, as in world_from_node.
using Transform = Eigen::Affine3d;

// Unit vectors and quaternions that are given may be off by what single precision or six written digits leave; one farther
// off is a mistake, such as another convention or angles.
constexpr double kUnitTolerance = 1e-6;

// Points and normals that are the same have the same component along this direction, and others seldom do by chance: things
// made by people lie along their axes.
inline const Vec3 kSortingDirection{0.7193, 0.5271, 0.4526};

// Returns the cross product of two sides of a triangle: it points along the normal that follows from the winding, and is
// twice as long as the area.
inline Vec3 cross_of_sides(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }
inline Vec3 cross_of_sides(const std::array<Vec3, 3>& corners) { return cross_of_sides(corners[0], corners[1], corners[2]); }

// Returns the box about some points.
inline Box box_about(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  return box;
}

// Returns the unit vector of the part of a vector across a unit vector; zero where it lies along that.
inline Vec3 unit_part_across(const Vec3& vector, const Vec3& unit) {
  const Vec3 part = vector - unit.dot(vector) * unit;
  return part.squaredNorm() > 1e-18 ? Vec3(part.normalized()) : Vec3(Vec3::Zero());
}

// Returns the point of the segment between two points, which may be one, that is nearest to another point.
inline Vec3 nearest_of_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double square = along.squaredNorm(), at = square > 0 ? std::clamp(along.dot(point - from) / square, 0.0, 1.0) : 0.0;
  return from + at * along;
}

inline double distance_to_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  return (nearest_of_segment(point, from, to) - point).norm();
}

}  // namespace echopath
