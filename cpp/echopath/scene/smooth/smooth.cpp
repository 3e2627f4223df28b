#include "echopath/scene/smooth/smooth.h"

#include <algorithm>

namespace echopath {

std::vector<Vec3> vertex_normals(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                 const Creases& creases) {
  std::vector<Vec3> normals = sums_of_weighted_normals(vertices, triangles);
  for (size_t i = 0; i < creases.vertices.size(); ++i) {
    Vec3& normal = normals[creases.vertices[i]];
    normal.setZero();
    for (size_t k = creases.first[i]; k < creases.first[i + 1]; ++k) {
      const auto [triangle, corner] = creases.corners[k];
      normal += weighted_normal(vertices, triangles[triangle], corner);
    }
  }
  for (Vec3& normal : normals) normal.stableNormalize();
  return normals;
}

std::vector<Vec3> vertex_normals(const Mesh& mesh) {
  const std::vector<Vec3>& vertices = mesh.surface().vertices();
  const std::vector<Triangle>& triangles = mesh.surface().triangles();
  std::vector<Vec3> normals = vertex_normals(vertices, triangles, find_creases(vertices, triangles));
  if (!mesh.whole()) return normals;
  std::vector<Vec3> of_part;
  for (const uint32_t vertex : mesh.whole_vertex()) of_part.push_back(normals[vertex]);
  return of_part;
}

Mat3 cofactor_matrix(const Mat3& world_from_mesh) {
  return world_from_mesh.inverse().transpose() * world_from_mesh.determinant();
}

bool is_smooth_facet(const Vec3& facet_normal, const std::array<Vec3, 3>& normals) {
  return std::ranges::all_of(normals, [&](const Vec3& n) { return n.dot(facet_normal) >= kCreaseCosine; });
}

SmoothPoint smooth_point(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals, double u, double v) {
  const std::array<double, 3> weights = {1.0 - u - v, u, v};
  Vec3 flat = Vec3::Zero(), sum = Vec3::Zero();
  for (size_t i = 0; i < 3; ++i) {
    flat += weights[i] * corners[i];
    sum += weights[i] * normals[i];
  }
  const double length = sum.norm();
  SmoothPoint point;
  point.normal = sum / length;
  point.position = flat;
  for (size_t i = 0; i < 3; ++i) point.position += 0.5 * weights[i] * (corners[i] - flat).dot(normals[i]) * normals[i];

  const Vec3 side_u = corners[1] - corners[0], side_v = corners[2] - corners[0];
  std::array<double, 3> lift;
  for (size_t i = 0; i < 3; ++i) lift[i] = (corners[i] - flat).dot(normals[i]);
  Vec3 along_u = side_u + 0.5 * (lift[1] * normals[1] - lift[0] * normals[0]);
  Vec3 along_v = side_v + 0.5 * (lift[2] * normals[2] - lift[0] * normals[0]);
  for (size_t i = 0; i < 3; ++i) {
    along_u -= 0.5 * weights[i] * side_u.dot(normals[i]) * normals[i];
    along_v -= 0.5 * weights[i] * side_v.dot(normals[i]) * normals[i];
  }
  point.stretch = along_u.cross(along_v).norm() / side_u.cross(side_v).norm();

  const auto tangential = [&](const Vec3& x) -> Vec3 { return x - point.normal.dot(x) * point.normal; };
  const Vec3 edge_u = tangential(corners[1] - corners[0]), edge_v = tangential(corners[2] - corners[0]);
  const Vec3 turn_u = tangential(normals[1] - normals[0]) / length, turn_v = tangential(normals[2] - normals[0]) / length;
  // The dual vectors of the edges lie in the tangent plane.
  const double uu = edge_u.squaredNorm(), uv = edge_u.dot(edge_v), vv = edge_v.squaredNorm();
  const double det = uu * vv - uv * uv;
  const Vec3 dual_u = (vv * edge_u - uv * edge_v) / det, dual_v = (uu * edge_v - uv * edge_u) / det;
  const Mat3 turning = turn_u * dual_u.transpose() + turn_v * dual_v.transpose();
  point.curvature = 0.5 * (turning + turning.transpose());
  return point;
}

Eigen::Vector2d edge_coordinates(const Vec3& edge_u, const Vec3& edge_v, const Vec3& normal, const Vec3& tangent) {
  const Vec3 u = edge_u - normal.dot(edge_u) * normal, v = edge_v - normal.dot(edge_v) * normal;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double along_u = u.dot(tangent), along_v = v.dot(tangent);
  return Eigen::Vector2d(vv * along_u - uv * along_v, uu * along_v - uv * along_u) / (uu * vv - uv * uv);
}

}  // namespace echopath
