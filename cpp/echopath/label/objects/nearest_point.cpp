#include "echopath/label/objects/nearest_point.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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

double longest_edge_of(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  double longest = 0.0;
  for (const auto& [a, b, c] : triangles) {
    longest = std::max({longest, (vertices[a] - vertices[b]).squaredNorm(), (vertices[b] - vertices[c]).squaredNorm(),
                        (vertices[c] - vertices[a]).squaredNorm()});
  }
  return std::sqrt(longest);
}

ECHOPATH_INLINE void square_distances(const double* vertices, size_t count, VectorOf<double> from, double* squares) {
  ECHOPATH_SIDE_BY_SIDE
  for (size_t i = 0; i < count; ++i) {
    const double x = vertices[3 * i] - from.x, y = vertices[3 * i + 1] - from.y, z = vertices[3 * i + 2] - from.z;
    squares[i] = x * x + y * y + z * z;
  }
}

ECHOPATH_INLINE void mark_below(const double* values, size_t count, double limit, uint8_t* is_below) {
  ECHOPATH_SIDE_BY_SIDE
  for (size_t i = 0; i < count; ++i) is_below[i] = values[i] <= limit ? 1 : 0;
}

double largest_stretch(const Mat3& linear) { return Eigen::JacobiSVD<Mat3>(linear).singularValues()[0]; }

}  // namespace

NearestPoints::NearestPoints(const Scene& scene, const PosedScene& pose, const EmbreeScene& geometry,
                             std::span<const uint32_t> mesh_ids)
    : scene_(scene), geometry_(geometry), pose_(pose) {
  for (const uint32_t id : mesh_ids) {
    const Node& node = scene.node_of(id);
    if (node.deformation) of_deformed_.try_emplace(id);
    else of_meshes_.try_emplace(node.mesh.get());
  }
}

double NearestPoints::longest_edge(uint32_t mesh_id) const {
  const Node& node = scene_.node_of(mesh_id);
  const std::vector<Triangle>& triangles = node.mesh->triangles();
  if (node.deformation) {
    return of_deformed_.at(mesh_id).get([&] { return longest_edge_of(geometry_.vertices(mesh_id), triangles); });
  }
  const double at_rest =
      of_meshes_.at(node.mesh.get()).get([&] { return longest_edge_of(node.mesh->vertices(), triangles); });
  return at_rest * largest_stretch(pose_.linear(mesh_id));
}

std::array<double, 2> NearestPoints::distances(const Points& points, std::span<const uint32_t> mesh_ids) const {
  std::vector<std::pair<double, uint32_t>> by_box;
  for (const uint32_t id : mesh_ids) by_box.emplace_back(geometry_.box(id).exteriorDistance(points[0]), id);
  std::sort(by_box.begin(), by_box.end());
  std::array<double, 2> least;
  least.fill(std::numeric_limits<double>::infinity());
  const double apart = (points[1] - points[0]).norm();
  for (const auto& [distance, id] : by_box) {
    if (distance < std::max(least[0], least[1] + apart)) look_at_mesh(points, id, least);
  }
  return least;
}

// No point of a triangle is farther from its next corner than its longest edge over the root of 3.
void NearestPoints::look_at_mesh(const Points& points, uint32_t mesh, std::array<double, 2>& least) const {
  const std::vector<Vec3>& vertices = geometry_.vertices(mesh);
  std::vector<double> squares(vertices.size());
  const VectorOf<double> from = unpacked(points[0]);
  run_simd<&square_distances>(vertices.front().data(), vertices.size(), from, squares.data());
  const Vec3& nearest = vertices[static_cast<size_t>(std::min_element(squares.begin(), squares.end()) - squares.begin())];
  for (size_t k = 0; k < 2; ++k) least[k] = std::min(least[k], (nearest - points[k]).norm());
  const double reach =
      std::max(least[0], least[1] + (points[1] - points[0]).norm()) + longest_edge(mesh) / std::numbers::sqrt3;
  std::vector<uint8_t> is_near(vertices.size());
  run_simd<&mark_below>(static_cast<const double*>(squares.data()), squares.size(), reach * reach * (1.0 + 1e-9),
                        is_near.data());
  const std::vector<Triangle>& triangles = scene_.node_of(mesh).mesh->triangles();
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    if ((is_near[a] | is_near[b] | is_near[c]) == 0) continue;
    const std::array<Vec3, 3> corners = geometry_.corners(mesh, i);
    for (size_t k = 0; k < 2; ++k) least[k] = std::min(least[k], distance_to_triangle(points[k], corners));
  }
}

}  // namespace echopath
