#include "echopath/label/objects/nearest_point.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "echopath/base/lanes/scalar_math.h"
#include "echopath/base/lanes/simd.h"
#include "echopath/base/packed.h"

namespace echopath {
namespace {

double distance_to_triangle(const Vec3& point, const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 normal = (b - a).cross(c - a).normalized();
  bool is_above = true;  // the foot of the perpendicular lies on the inner side of all three edges
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    is_above = is_above && normal.cross(to - from).dot(point - from) >= 0.0;
    least = std::min(least, distance_to_segment(point, from, to));
  }
  return is_above ? std::abs(normal.dot(point - a)) : least;
}

// Writes the squares of the distances of vertices, and the least of them.
ECHOPATH_INLINE void square_distances(const double* vertices, size_t count, VectorOf<double> from, double* squares,
                                      double* least) {
  ECHOPATH_SIDE_BY_SIDE
  for (size_t i = 0; i < count; ++i) {
    const double x = vertices[3 * i] - from.x, y = vertices[3 * i + 1] - from.y, z = vertices[3 * i + 2] - from.z;
    squares[i] = x * x + y * y + z * z;
  }
  constexpr size_t kAtOnce = 8;
  double of_lanes[kAtOnce];
  std::fill_n(of_lanes, kAtOnce, std::numeric_limits<double>::infinity());
  size_t i = 0;
  for (; i + kAtOnce <= count; i += kAtOnce) {
    for (size_t k = 0; k < kAtOnce; ++k) of_lanes[k] = ScalarMath::smaller(of_lanes[k], squares[i + k]);
  }
  for (; i < count; ++i) of_lanes[0] = ScalarMath::smaller(of_lanes[0], squares[i]);
  *least = *std::min_element(of_lanes, of_lanes + kAtOnce);
}

// Returns whether a point is nearer than `least` (m) to the box about a triangle, which most triangles need not be asked
// more about.
bool is_box_nearer(const Vec3& point, const std::array<Vec3, 3>& corners, double least) {
  const auto& [a, b, c] = corners;
  const Vec3 below = a.cwiseMin(b).cwiseMin(c) - point, above = point - a.cwiseMax(b).cwiseMax(c);
  return below.cwiseMax(above).cwiseMax(0.0).squaredNorm() < least * least;
}

ECHOPATH_INLINE void mark_below(const double* values, size_t count, double limit, uint8_t* is_below) {
  ECHOPATH_SIDE_BY_SIDE
  for (size_t i = 0; i < count; ++i) is_below[i] = values[i] <= limit ? 1 : 0;
}

double largest_stretch(const Mat3& linear) { return Eigen::JacobiSVD<Mat3>(linear).singularValues()[0]; }

}  // namespace

NearestPoints::NearestPoints(const Scene& scene, const PosedScene& pose, const EmbreeScene& geometry)
    : scene_(scene), geometry_(geometry), pose_(pose) {}

double NearestPoints::longest_edge(uint32_t mesh_id) const {
  const Node& node = scene_.node_of(mesh_id);
  if (node.deformation) return longest_edge_of(geometry_.vertices(mesh_id), node.mesh->triangles());
  return node.mesh->longest_edge() * largest_stretch(pose_.linear(mesh_id));
}

std::array<double, 2> NearestPoints::distances(const Points& points, std::span<const uint32_t> mesh_ids) const {
  std::vector<std::pair<double, uint32_t>> by_box;
  for (const uint32_t id : mesh_ids) by_box.emplace_back(geometry_.box(id).exteriorDistance(points[0]), id);
  std::ranges::sort(by_box);
  std::array<double, 2> least;
  least.fill(std::numeric_limits<double>::infinity());
  const double apart = (points[1] - points[0]).norm();
  for (const auto& [distance, id] : by_box) {
    if (distance < std::max(least[0], least[1] + apart)) look_at_mesh(points, id, least);
  }
  return least;
}

// No point of a triangle is farther from its next corner than its longest edge over the root of 3. The vertex that is
// nearest to the first point bounds both distances, before any triangle is looked at.
void NearestPoints::look_at_mesh(const Points& points, uint32_t mesh, std::array<double, 2>& least) const {
  const std::vector<Vec3>& vertices = geometry_.vertices(mesh);
  const double apart = (points[1] - points[0]).norm();
  std::vector<double> squares(vertices.size());
  double nearest_square = 0.0;
  run_simd<&square_distances>(vertices.front().data(), vertices.size(), unpacked(points[0]), squares.data(),
                              &nearest_square);
  const double nearest = std::sqrt(nearest_square);
  least[0] = std::min(least[0], nearest);
  least[1] = std::min(least[1], nearest + apart);
  const double reach = std::max(least[0], least[1] + apart) + longest_edge(mesh) / std::numbers::sqrt3;
  std::vector<uint8_t> is_near(vertices.size());
  run_simd<&mark_below>(static_cast<const double*>(squares.data()), squares.size(), reach * reach * (1.0 + 1e-9),
                        is_near.data());
  const std::vector<Triangle>& triangles = scene_.node_of(mesh).mesh->triangles();
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    if ((is_near[a] | is_near[b] | is_near[c]) == 0) continue;
    const std::array<Vec3, 3> corners = geometry_.corners(mesh, i);
    for (size_t k = 0; k < 2; ++k) {
      if (is_box_nearer(points[k], corners, least[k]))
        least[k] = std::min(least[k], distance_to_triangle(points[k], corners));
    }
  }
}

}  // namespace echopath
