#include "echopath/scene/smooth/reflection_point.h"

#include <Eigen/LU>
#include <algorithm>

#include "echopath/base/principal_axes.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath {
namespace {

constexpr double kOutside = 0.02;  // of an edge
constexpr double kLost = 1.0;      // of an edge: iterations that stray this far are given up
constexpr int kSteps = 8;
constexpr double kArrived = 1e-4;  // of an edge

// Holds the gradient and the Hessian of the path length in the tangent plane at a point of the surface.
struct PathLength {
  std::array<Vec3, 2> tangents;
  Eigen::Vector2d gradient;
  Eigen::Matrix2d hessian;
};

PathLength path_length_at(const SmoothPoint& at, const Vec3& first, const Vec3& second) {
  const Vec3 lines[2] = {first - at.position, second - at.position};
  PathLength path_length{{at.normal.unitOrthogonal(), {}}, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()};
  path_length.tangents[1] = at.normal.cross(path_length.tangents[0]);
  for (const Vec3& line : lines) {
    const double distance = line.norm();
    const Vec3 direction = line / distance;
    for (int i = 0; i < 2; ++i) {
      const Vec3& along = path_length.tangents[i];
      path_length.gradient[i] -= direction.dot(along);
      for (int j = 0; j < 2; ++j) {
        const Vec3& other = path_length.tangents[j];
        path_length.hessian(i, j) += ((i == j) - direction.dot(along) * direction.dot(other)) / distance +
                                     direction.dot(at.normal) * along.dot(at.curvature * other);
      }
    }
  }
  return path_length;
}

bool is_inside(double u, double v, double margin) { return u >= -margin && v >= -margin && u + v <= 1.0 + margin; }

SmoothPoint point_at(const ReflectingTriangle& triangle, double u, double v) {
  if (!triangle.is_flat()) return smooth_point(triangle.corners, triangle.normals, u, v);
  const auto& [a, b, c] = triangle.corners;
  return {a + u * (b - a) + v * (c - a), triangle.facet_normal, Mat3::Zero(), 1.0};
}

// Returns (u, v) of the one reflection point of a plane, by the image of one end.
Eigen::Vector2d on_plane(const ReflectingTriangle& triangle, const Vec3& first, const Vec3& second) {
  const auto& [a, b, c] = triangle.corners;
  const double here = triangle.facet_normal.dot(first - a), there = triangle.facet_normal.dot(second - a);
  const Vec3 foot_of_first = first - here * triangle.facet_normal, foot_of_second = second - there * triangle.facet_normal;
  const Vec3 point = foot_of_first + here / (here + there) * (foot_of_second - foot_of_first);
  return edge_coordinates(b - a, c - a, triangle.facet_normal, point - a);
}

// Returns (u, v) of a reflection point of a curved triangle, found by Newton's method from its centre.
std::optional<Eigen::Vector2d> on_curve(const ReflectingTriangle& triangle, const Vec3& first, const Vec3& second) {
  const auto& [a, b, c] = triangle.corners;
  Eigen::Vector2d place(1.0 / 3.0, 1.0 / 3.0);
  for (int step = 0; step < kSteps; ++step) {
    const SmoothPoint at = point_at(triangle, place[0], place[1]);
    const PathLength path_length = path_length_at(at, first, second);
    const Eigen::Vector2d away = -path_length.hessian.inverse() * path_length.gradient;
    const Vec3 step_there = away[0] * path_length.tangents[0] + away[1] * path_length.tangents[1];
    const Eigen::Vector2d moved = edge_coordinates(b - a, c - a, at.normal, step_there);
    place += moved;
    if (!is_inside(place[0], place[1], kLost)) return std::nullopt;
    if (moved.cwiseAbs().maxCoeff() < kArrived) return place;
  }
  return std::nullopt;
}

}  // namespace

ReflectingTriangle reflecting_triangle(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals) {
  ReflectingTriangle out{corners, normals, (corners[0] + corners[1] + corners[2]) / 3.0,
                         cross_of_sides(corners).normalized()};
  if (!is_smooth_facet(out.facet_normal, normals)) out.normals.fill(out.facet_normal);
  for (size_t i = 0; i < 3; ++i) {
    out.radius = std::max(out.radius, (corners[i] - out.centre).norm());
    out.turn = std::max(out.turn, (out.normals[i] - out.facet_normal).norm());
  }
  constexpr double kPlane = 1e-6;
  if (out.turn < kPlane) out.turn = 0.0;
  return out;
}

std::optional<ReflectionPoint> find_reflection(const ReflectingTriangle& triangle, const Vec3& first, const Vec3& second) {
  if (!faces_both(triangle.centre, triangle.facet_normal, first, second)) return std::nullopt;
  const Vec3 to_first = first - triangle.centre, to_second = second - triangle.centre;
  // Where the path length is stationary, the sum of the unit vectors to both ends lies along the normal. Over the triangle
  // these vectors turn by no more than its radius over their distances, and the normal turns by no more than `turn`.
  const double near = to_first.norm() - triangle.radius, far = to_second.norm() - triangle.radius;
  if (near > 0.0 && far > 0.0) {
    const double reach = 2.0 * triangle.turn + triangle.radius * (1.0 / near + 1.0 / far);
    const Vec3 sum = to_first.normalized() + to_second.normalized();
    if ((sum - sum.dot(triangle.facet_normal) * triangle.facet_normal).squaredNorm() > reach * reach) return std::nullopt;
  }
  const std::optional<Eigen::Vector2d> place =
      triangle.is_flat() ? std::optional(on_plane(triangle, first, second)) : on_curve(triangle, first, second);
  if (!place || !is_inside((*place)[0], (*place)[1], kOutside)) return std::nullopt;
  const SmoothPoint at = point_at(triangle, (*place)[0], (*place)[1]);
  const PathLength path_length = path_length_at(at, first, second);
  const PrincipalAxes principal = principal_axes(path_length.hessian);
  ReflectionPoint found{at.position, {}, {principal.values[0], principal.values[1]}};
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d axis = principal.axes.col(i);
    found.axes[i] = axis[0] * path_length.tangents[0] + axis[1] * path_length.tangents[1];
  }
  return found;
}

}  // namespace echopath
